//! Free balls and a free cage through the whole program: tables that agree, the same bits after a resume, figures.

use crate::resume::resumed;
use crate::util::lockstep::{assert_same_run, copy};
use crate::util::tables::Table;
use crate::util::{Dir, RIGID, assert_close, assert_within, with_line};

/// Balls between rigid rings under preload and a radial force: each has a slip and a power of its own. A cage with
/// little clearance meets them and its land.
const FREE: &str = "[balls]\nmotion = \"free\"\n\n[effects.traction]\nlaw = \"coulomb\"\nfriction = 0.07\n\n\
                    [effects.ball_drag]\ncoefficient = 0.5\ndensity = \"20 kg/m3\"\n\n\
                    [cage]\nmotion = \"free\"\nbore_diameter = \"62 mm\"\noutside_diameter = \"68.2 mm\"\n\
                    width = \"14 mm\"\nmass = \"12 g\"\npocket_clearance = \"0.2 um\"\n\
                    pocket_stiffness = \"2e8 N/m^1.5\"\nguidance = \"outer_land\"\nguidance_clearance = \"0.1 um\"\n\
                    friction = 0.1\nrestitution = 0.6\n\n\
                    [speed]\ninner = \"6000 rpm\"\n\n[dynamic]\nduration = \"0.3 ms\"\nstep = \"10 us\"";

fn whole() -> Dir {
    let dir = Dir::with_scene(&with_line("[static]", "[static]", FREE));
    dir.run("whole", &RIGID);
    dir
}

/// Wrong: tables would tell of another friction than acts: power of the balls against that of the bearing, its sum over
/// time against the ledger, orbits against the cage.
#[test]
fn tables_of_free_balls_agree() {
    let dir = whole();
    let [balls, shaft, energy] =
        ["balls", "shaft", "energy"].map(|name| Table::read(&dir, &format!("whole/{name}.csv")));
    let sides = ["inner", "outer"].map(|side| balls.column(&format!("{side}_friction_power_w")));
    let (orbits, steps) = (balls.column("orbit_rad_per_s"), balls.column("step"));
    let (powers, cage) = (
        shaft.column("friction_power_w"),
        shaft.column("cage_speed_rad_per_s"),
    );
    let losses = energy.column("friction_loss_j");
    let mut heat = 0.0;
    for (row, &step) in shaft.column("step").iter().enumerate() {
        let of_step: Vec<usize> = (0..steps.len()).filter(|&i| steps[i] == step).collect();
        let power: f64 = of_step.iter().map(|&i| sides[0][i] + sides[1][i]).sum();
        let orbit = of_step.iter().map(|&i| orbits[i]).sum::<f64>() / of_step.len() as f64;
        assert_close("orbit", cage[row], orbit, 1e-12);
        heat += 10e-6 * power;
        if row > 0 {
            assert_close("power", powers[row], power, 1e-12);
            assert_close("heat", losses[row], heat, 1e-9);
        }
    }
    assert!(heat > 0.0);
    // Rolling at the free contact angle, 14.93 deg: (1 - D cos(a)/d_m)/2 of the inner ring's speed, four digits; the
    // balls at theirs.
    let inner = 6000.0 * std::f64::consts::PI / 30.0;
    let rolling = shaft.column("kinematic_cage_speed_rad_per_s")[0];
    assert_close("rolling", rolling / inner, 0.4331, 2e-4);
    assert_close("cage", cage[0], rolling, 0.01);
}

/// Wrong: equilibria of free balls through a point at which nothing turns would have tables of two widths, and end
/// there. Balls that stand have no speed and no friction; to both sides of it all is mirrored.
#[test]
fn equilibria_of_free_balls_pass_a_standstill() {
    let free =
        "[balls]\nmotion = \"free\"\n\n[effects.traction]\nlaw = \"coulomb\"\nfriction = 0.07\n\n[speed]\n";
    let swept = "inner = \"3000 rpm\"\n\n[sweep]\nkey = \"speed.inner\"\n\
                 values = [\"-3000 rpm\", \"0 rpm\", \"3000 rpm\"]";
    let in_time = "inner = { times = [\"0 s\", \"2 ms\"], values = [\"-3000 rpm\", \"3000 rpm\"] }\n\n\
                   [quasi_static]\nduration = \"2 ms\"\nstep = \"1 ms\"";
    for analysis in [swept, in_time] {
        let dir = Dir::with_scene(&with_line("[static]", "[static]", &format!("{free}{analysis}")));
        dir.run("out", &RIGID);
        let [balls, shaft] = ["balls", "shaft"].map(|name| Table::read(&dir, &format!("out/{name}.csv")));
        let (orbits, torques) = (
            balls.column("orbit_rad_per_s"),
            shaft.column("friction_torque_n_m"),
        );
        let per_step = orbits.len() / 3;
        assert!(orbits[per_step..2 * per_step].iter().all(|orbit| *orbit == 0.0));
        assert_eq!(torques[1], 0.0);
        assert!(torques[2] > 0.0);
        assert_close("torque", torques[0], -torques[2], 1e-6);
        assert_close("orbit", orbits[0], -orbits[2 * per_step], 1e-2);
    }
}

/// Wrong: forces of the cage would stand in one table and not in the other, or its energy in none.
#[test]
fn tables_of_a_cage_agree() {
    let dir = whole();
    let [balls, cage, energy] =
        ["balls", "cage", "energy"].map(|name| Table::read(&dir, &format!("whole/{name}.csv")));
    let [rolling, axial] = ["rolling", "axial"].map(|way| balls.column(&format!("pocket_{way}_n")));
    let steps = balls.column("step");
    let (largest, speed) = (
        cage.column("largest_pocket_force_n"),
        cage.column("speed_rad_per_s"),
    );
    for (row, &step) in cage.column("step").iter().enumerate() {
        let of_step = (0..steps.len()).filter(|&i| steps[i] == step);
        let expected = of_step.map(|i| rolling[i].hypot(axial[i])).fold(0.0, f64::max);
        assert_close("pocket", largest[row], expected, 1e-12);
        let turning = 0.5 * energy.column("kinetic_cage_j")[row];
        assert!(turning > 0.0 && speed[row] > 200.0, "{turning} {}", speed[row]);
    }
    assert!(largest.iter().any(|force| *force > 0.0));
    let loss = energy.column("cage_friction_loss_j");
    assert!(loss.windows(2).all(|pair| pair[1] >= pair[0]) && loss[loss.len() - 1] > 0.0);
}

/// Wrong: an equilibrium of rolling balls would show other friction than it balances, or a speed of kinematic balls.
#[test]
fn an_equilibrium_has_rolling_balls_and_their_torque() {
    let (balls, _) = FREE.split_once("[cage]").unwrap();
    let turning = format!("{balls}[speed]\ninner = \"6000 rpm\"\n\n[static]");
    let dir = Dir::with_scene(&with_line("[static]", "[static]", &turning));
    dir.run("rest", &RIGID);
    let shaft = Table::read(&dir, "rest/shaft.csv");
    let torque = shaft.column("friction_torque_n_m")[0];
    let drag = 0.5 * 20.0 * 0.5 * std::f64::consts::FRAC_PI_4 * 9e-3f64.powi(2);
    let balls = Table::read(&dir, "rest/balls.csv");
    let orbits = balls.column("orbit_rad_per_s");
    // The drag's moment about the axis is what the rings' torques leave.
    let dragging: f64 = orbits
        .iter()
        .map(|w| drag * w.powi(2) * 32.512e-3f64.powi(3))
        .sum();
    let outer = shaft.column("outer_friction_torque_n_m")[0];
    assert!(torque > 0.0 && outer < 0.0, "{torque} {outer}");
    assert_close("moment", torque + outer, dragging, 1e-3);
    // Power of the drive goes to friction and to the drag of balls on their pitch circle.
    let dragged: f64 = orbits.iter().map(|w| drag * (w * 32.512e-3).powi(3)).sum();
    let drive = torque * 6000.0 * std::f64::consts::PI / 30.0;
    assert_close(
        "power",
        shaft.column("friction_power_w")[0] + dragged,
        drive,
        1e-3,
    );
    let head = std::fs::read_to_string(dir.path("rest/balls.csv")).unwrap();
    assert!(
        !head.lines().next().unwrap().ends_with("spin_rad_per_s"),
        "a spin of kinematic balls"
    );
}

/// Wrong: a run that is cut would go on with other balls than it had.
#[test]
fn free_balls_continue_bit_for_bit() {
    let dir = whole();
    copy(&dir, "whole", "cut");
    std::fs::remove_file(dir.path("cut/summary.json")).unwrap();
    resumed(&dir, &["cut", "--step", "11", "--threads", "2"]);
    assert_same_run(&dir, "whole", "cut");
}

/// Wrong: what friction does would stand in tables alone.
#[test]
fn free_balls_have_figures() {
    let dir = whole();
    let outcome = dir.raceway(&["plot", "whole"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    for name in [
        "ball_slip",
        "ball_spin",
        "traction",
        "friction_power",
        "friction_power_of_all",
        "pv",
        "pv_of_all",
        "power_by_source",
        "friction_torque",
        "friction_power_sum",
        "cage_speed",
        "cage_orbit",
        "cage_turning",
        "cage_forces",
    ] {
        assert!(dir.path(&format!("whole/figures/{name}.svg")).exists(), "{name}");
    }
}

/// Largest p |s| over the ellipse of a contact on a grid of 200 x 800 places, from the numbers of a row of balls.csv.
fn pv_of_row(cell: &dyn Fn(&str) -> f64, side: &str, ring_speed: f64) -> f64 {
    let (sign, groove) = if side == "inner" {
        (-1.0, 4.65e-3)
    } else {
        (1.0, 4.75e-3)
    };
    let own = |name: &str| cell(&format!("{side}_{name}"));
    let (sin_a, cos_a) = own("contact_angle_rad").sin_cos();
    let (sin, cos) = cell("azimuth_rad").sin_cos();
    let [n_r, n_z] = [sign * cos_a, sign * sin_a];
    let [x, y, z] = ["x", "y", "z"].map(|axis| cell(&format!("omega_{axis}_rad_per_s")));
    // The ball's turning less the ring's about t = e_psi and q = n x t = (-n_z, 0, n_r).
    let (w_r, w_t) = (x * cos + y * sin, y * cos - x * sin);
    let w_q = -n_z * w_r + n_r * (z - ring_speed);
    let (a, b) = (own("semi_axis_groove_m"), own("semi_axis_rolling_m"));
    let radius = 2.0 * groove * 4.5e-3 / (groove + 4.5e-3);
    let (slip, spin) = (
        ["rolling", "lateral"].map(|way| own(&format!("slip_{way}_m_per_s"))),
        own("spin_rad_per_s"),
    );
    let mut largest = 0.0f64;
    for i in -100..=100 {
        for j in -400..=400 {
            let (u, v) = (f64::from(i) / 100.0, f64::from(j) / 400.0);
            let depth = -(a * v).powi(2) / (2.0 * radius);
            let s_t = slip[0] - spin * a * v + w_q * depth;
            let s_q = slip[1] + spin * b * u - w_t * depth;
            let pressure = (1.0 - u * u - v * v).max(0.0).sqrt();
            largest = largest.max(pressure * s_t.hypot(s_q));
        }
    }
    largest * own("peak_pressure_pa")
}

/// Wrong: the figure for scuffing would not be the largest pressure times sliding speed of the contact in its row, at
/// rest or in motion. 0.3 % by the grid of the program; the ring of a shaft that moves turns a little otherwise.
#[test]
fn pv_is_the_largest_pressure_times_sliding_speed() {
    let dir = whole();
    let (balls, _) = FREE.split_once("[cage]").unwrap();
    let turning = format!("{balls}[speed]\ninner = \"6000 rpm\"\n\n[static]");
    dir.write("scene.toml", with_line("[static]", "[static]", &turning));
    dir.run("rest", &RIGID);
    for (name, step) in [("rest", 0), ("whole", 30)] {
        let table = Table::read(&dir, &format!("{name}/balls.csv")).step(step);
        for ball in [0, 5, 9] {
            let cell = |column: &str| table.column(column)[ball];
            for (side, speed) in [("inner", 6000.0 * std::f64::consts::PI / 30.0), ("outer", 0.0)] {
                let found = cell(&format!("{side}_pv_w_per_m2"));
                assert_close("pv", found, pv_of_row(&cell, side, speed), 4e-3);
                // No less than the mean of the friction power over the ellipse.
                let [a, b] = ["groove", "rolling"].map(|way| cell(&format!("{side}_semi_axis_{way}_m")));
                let power = cell(&format!("{side}_friction_power_w"));
                assert!(0.07 * found * std::f64::consts::PI * a * b > power);
            }
        }
    }
    let first = Table::read(&dir, "whole/balls.csv").step(0);
    assert_eq!(first.column("inner_pv_w_per_m2"), vec![0.0; 18], "no slip yet");
}

/// A probe of each contact of the inner ring, and one of the outer ring at ball 0.
fn probes() -> String {
    let inner: String = (0..18)
        .map(|ball| format!("[probes.contact.i{ball}]\nball = {ball}\nring = \"inner\"\n\n"))
        .collect();
    format!("{inner}[probes.contact.o0]\nball = 0\nring = \"outer\"\n\n")
}

fn vector(table: &Table, name: &str, unit: &str, row: usize) -> [f64; 3] {
    ["x", "y", "z"].map(|axis| table.column(&format!("{name}_{axis}_{unit}"))[row])
}

/// Wrong: probes of contacts would miss tractions, their moments or their place. Both contacts of a ball that rolls
/// steadily make its centripetal force and overcome its drag; about its centre their moments turn its angular momentum,
/// J w_c e_z x w. About the axis all inner contacts together are the friction torque.
#[test]
fn contact_probes_carry_traction_and_its_moments() {
    let (balls, _) = FREE.split_once("[cage]").unwrap();
    let turning = format!("{balls}{}[speed]\ninner = \"10000 rpm\"\n\n[static]", probes());
    let dir = Dir::with_scene(&with_line("[static]", "[static]", &turning));
    dir.run("rest", &RIGID);
    let [probes, balls, shaft] =
        ["probes", "balls", "shaft"].map(|name| Table::read(&dir, &format!("rest/{name}.csv")));
    let ball = |name: &str| balls.column(name)[0];
    let (mass, r) = (7800.0 * std::f64::consts::PI / 6.0 * 9e-3f64.powi(3), 4.5e-3);
    let (w_c, psi) = (ball("orbit_rad_per_s"), ball("azimuth_rad"));
    // Half the pitch circle of the balls that just touch, and how far the ball is from there.
    let [out, height] = {
        let (offset, reach) = (4.65e-3 - r, 4.75e-3 - r);
        let (inner, outer) = (56.01e-3 / 2.0 + 4.65e-3, 74.037e-3 / 2.0 - 4.75e-3);
        let alpha = f64::acos((inner - outer) / (offset + reach));
        [
            outer + reach * alpha.cos() + ball("displacement_radial_m"),
            reach * alpha.sin() + ball("displacement_axial_m"),
        ]
    };
    let (inner, outer) = (
        vector(&probes, "i0_force", "n", 0),
        vector(&probes, "o0_force", "n", 0),
    );
    let drag = 0.5 * 20.0 * 0.5 * std::f64::consts::FRAC_PI_4 * 9e-3f64.powi(2) * (w_c * out).powi(2);
    let inwards = mass * w_c * w_c * out;
    let expected = [
        -inwards * psi.cos() - drag * psi.sin(),
        -inwards * psi.sin() + drag * psi.cos(),
        0.0,
    ];
    let force = ball("outer_force_n");
    for i in 0..3 {
        assert_within("force", inner[i] + outer[i], expected[i], 1e-7 * force);
    }
    let moments = [
        vector(&probes, "i0_moment", "n_m", 0),
        vector(&probes, "o0_moment", "n_m", 0),
    ];
    let centre = [out * psi.cos(), out * psi.sin(), height];
    let sum = [0, 1, 2].map(|i| inner[i] + outer[i]);
    let of_sum = cross(centre, sum);
    let inertia = 0.4 * mass * r * r;
    let turns = cross(
        [0.0, 0.0, w_c],
        ["x", "y", "z"].map(|axis| ball(&format!("omega_{axis}_rad_per_s"))),
    );
    for i in 0..3 {
        let about_centre = moments[0][i] + moments[1][i] - of_sum[i];
        assert_within("moment", about_centre, inertia * turns[i], 1e-7 * force * r);
    }
    assert!(
        inertia * turns[0].hypot(turns[1]) > 1e-4 * force * r,
        "there is a moment"
    );
    let torque: f64 = (0..18)
        .map(|i| vector(&probes, &format!("i{i}_moment"), "n_m", 0)[2])
        .sum();
    assert_close("torque", torque, shaft.column("friction_torque_n_m")[0], 1e-9);
}

/// Wrong: probes of a motion would have other tractions than its torque. The directions of a row are those of the end
/// of its step, the torque is that of its middle.
#[test]
fn contact_probes_of_a_motion_have_its_friction_torque() {
    let scene = FREE.replace("[speed]", &format!("{}[speed]", probes()));
    let dir = Dir::with_scene(&with_line("[static]", "[static]", &scene));
    dir.run("moving", &RIGID);
    let [probes, shaft] = ["probes", "shaft"].map(|name| Table::read(&dir, &format!("moving/{name}.csv")));
    let torques = shaft.column("friction_torque_n_m");
    for row in [10, 20, 30] {
        let sum: f64 = (0..18)
            .map(|i| vector(&probes, &format!("i{i}_moment"), "n_m", row)[2])
            .sum();
        assert_close("torque", sum, torques[row], 1e-2);
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Wrong: balls that just touch, to the round-off of their places, would be asked to roll under friction that cannot
/// move them: the equilibrium of a bearing from a catalogue would fail, by the luck of its dimensions.
#[test]
fn bearings_of_a_catalogue_roll() {
    for designation in ["7208", "7306", "7010B"] {
        let dir = Dir::empty();
        let name = format!("{designation}.toml");
        assert_eq!(dir.raceway(&["init", designation, "--out", &name]).code, Some(0));
        let rigid: Vec<String> = dir
            .text(&name)
            .lines()
            .map(|line| match line.starts_with("mesh = ") {
                true => "flexible = false".to_owned(),
                false => line.to_owned(),
            })
            .collect();
        let free = "[balls]\nmotion = \"free\"\n\n[effects.traction]\nlaw = \"coulomb\"\nfriction = 0.06\n\n\
                    [speed]\ninner = \"3000 rpm\"\n\n[static]";
        dir.write(&name, rigid.join("\n").replace("[static]", free));
        let outcome = dir.raceway(&["run", &name, "--out", "rolling"]);
        assert_eq!(outcome.code, Some(0), "{designation}: {}", outcome.stderr);
        let shaft = Table::read(&dir, "rolling/shaft.csv");
        assert!(shaft.column("friction_torque_n_m")[0] > 0.0);
    }
}
