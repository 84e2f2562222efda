"""Prints the numbers of docs/paper.md from the runs of scripts/paper-figures; needs Python alone.

    python3 scripts/paper_numbers.py results/paper
"""

import csv
import json
import math
import sys
from pathlib import Path


def table(path):
    """Columns of numbers of a table of a run."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def rows_where(columns, name, value):
    return [i for i, x in enumerate(columns[name]) if x == value]


def rms(values):
    return math.sqrt(sum(x * x for x in values) / len(values))


def about_mean(values):
    mean = sum(values) / len(values)
    return [x - mean for x in values]


def smooth(values, width):
    """Mean over a window, at the ends over what there is of it."""
    half = width // 2
    windows = (values[max(0, i - half):i + half + 1] for i in range(len(values)))
    return [sum(w) / len(w) for w in windows]


def pulses(values, width):
    """How often a history, smoothed over a window, falls by a sixth of its range: one pulse of pressure each, however loaded."""
    values = smooth(values, width)
    level = max(values) - (max(values) - min(values)) / 6.0
    below = [x < level for x in values]
    return sum(1 for a, b in zip(below, below[1:]) if b and not a)


def local_maxima(values, width):
    """Places of maxima of the smoothed curve that stand out from it by 1 % on both sides."""
    curve = smooth(values, width)
    found = []
    for i in range(width, len(curve) - width):
        window = curve[i - width:i + width + 1]
        if curve[i] == max(window) and (not found or i - found[-1] > width):
            found.append(i)
    return found


def motion(folder):
    balls = table(folder / "balls.csv")
    rows = rows_where(balls, "ball", 0.0)
    azimuth = [math.degrees(balls["azimuth_rad"][i]) % 360.0 for i in rows]
    per_passing = round(len(rows) / 18)
    print("Fig. 4, force of ball 0 over a revolution, 1800 rpm, 2 kN preload, 1 kN radial")
    for side in ("inner", "outer"):
        force = [balls[f"{side}_force_n"][i] for i in rows]
        curve = smooth(force, per_passing // 4)
        top, bottom = curve.index(max(curve)), curve.index(min(curve))
        maxima = [f"{azimuth[i]:.0f} deg {curve[i]:.0f} N" for i in local_maxima(force, per_passing)]
        ripple = max(abs(a - b) for a, b in zip(force, curve))
        print(f"  {side}: largest {curve[top]:.1f} N at {azimuth[top]:.0f} deg, smallest {curve[bottom]:.1f} N at "
              f"{azimuth[bottom]:.0f} deg; start {force[0]:.1f} N, never below {min(force):.1f} N")
        print(f"    inner maxima of the curve: {', '.join(maxima) or 'none'}; departure from a mean over a quarter of "
              f"a ball spacing: {ripple:.2f} N")
    probes = table(folder / "probes.csv")
    print("Figs. 5 to 7, stress of the points P_o2 and P_i2, 0.1 mm below the raceway")
    for name in ("p_o2", "p_i2"):
        normal = probes[f"{name}_stress_dd_pa"]
        mises = probes[f"{name}_von_mises_pa"]
        shear = probes[f"{name}_stress_td_pa"]
        print(f"  {name}: {pulses(normal, per_passing // 10)} pulses; normal stress down to {min(normal) / 1e6:.0f} MPa, "
              f"von Mises up to {max(mises) / 1e6:.0f} MPa, orthogonal shear {min(shear) / 1e6:.0f} to {max(shear) / 1e6:.0f} MPa")
    print("Fig. 8, displacements in mm: RMS of the value from the just-touching state, RMS about the mean, mean, half range")
    histories = {
        "ball radial": [balls["displacement_radial_m"][i] for i in rows],
        "ball axial": [balls["displacement_axial_m"][i] for i in rows],
        "node P_i2 radial, in the ring": probes["n_i2_displacement_r_m"],
        "shaft x": table(folder / "shaft.csv")["x_m"],
        "shaft z": table(folder / "shaft.csv")["z_m"],
    }
    for name, values in histories.items():
        values = [1e3 * x for x in values]
        print(f"  {name}: {rms(values):.3e}, {rms(about_mean(values)):.3e}, {sum(values) / len(values):.3e}, "
              f"{0.5 * (max(values) - min(values)):.3e}")
    energy = table(folder / "energy.csv")
    print(f"  ledger: largest defect {max(abs(d) for d in energy['defect_j']):.1e} J of {max(energy['total_j']):.3e} J")


def sweep(folder, column, title):
    balls, shaft = table(folder / "balls.csv"), table(folder / "shaft.csv")
    print(title)
    for step, value in enumerate(shaft[column]):
        rows = rows_where(balls, "step", float(step))
        parts = []
        for side in ("inner", "outer"):
            angles = [math.degrees(balls[f"{side}_contact_angle_rad"][i]) for i in rows
                      if balls[f"{side}_force_n"][i] > 0.0]
            mean = sum(angles) / len(angles)
            parts.append(f"{side} angle {mean:.2f} ({min(angles):.2f} to {max(angles):.2f}) deg")
        force = [balls["inner_force_n"][i] for i in rows]
        pressure = max(balls["inner_peak_pressure_pa"][i] for i in rows)
        print(f"  {value / 1e3:.2f} kN: x {1e6 * shaft['x_m'][step]:.2f} um, z {1e6 * shaft['z_m'][step]:.2f} um; "
              f"force {min(force):.0f} to {max(force):.0f} N, {1e-9 * pressure:.2f} GPa; {'; '.join(parts)}")
    for warning in json.loads((folder / "summary.json").read_text()).get("warnings", []):
        print(f"  warning: {warning}")


def profiles(folder):
    """Largest von Mises stress of every profile of a sweep, and where it is."""
    print("Fig. 11, 10 kN preload, tilt free: largest von Mises stress 0.1 mm below the raceways, and its groove angle")
    largest = {}
    with open(folder / "profiles.csv", newline="") as file:
        for row in csv.DictReader(file):
            key = (row["profile"], int(row["step"]))
            found = (float(row["von_mises_pa"]), math.degrees(float(row["groove_angle_rad"])))
            largest[key] = max(largest.get(key, (0.0, 0.0)), found)
    for (profile, step), (stress, angle) in sorted(largest.items()):
        print(f"  {profile}, point {step} of the sweep: {stress / 1e6:.0f} MPa at {angle:.1f} deg")


def main():
    folder = Path(sys.argv[1])
    motion(folder / "motion")
    for tilt, ending in (("free", ""), ("locked", "_locked")):
        sweep(folder / f"preload{ending}", "effects.axial_force.value_n", f"Fig. 9, preload, tilt {tilt}")
        sweep(folder / f"radial{ending}", "effects.radial_force.value_n", f"Fig. 9, radial force, 2 kN preload, tilt {tilt}")
        sweep(folder / f"radial_10kn{ending}", "effects.radial_force.value_n", f"Figs. 10 to 12, 10 kN preload, tilt {tilt}")
    profiles(folder / "radial_10kn")


if __name__ == "__main__":
    main()
