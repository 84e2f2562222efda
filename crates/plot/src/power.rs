//! Where the power of friction goes: its sources over time, one above the other.
//!
//! Of a motion the sum is the growth of the losses in the ledger, energy.csv. The contacts of both rings share the
//! friction of the balls as their powers in balls.csv do. Equilibria over time have powers alone.

use figure::{Figure, Series};
use results::table::Table;

use super::quantity::{MILLISECOND, WATT};
use super::run::{Results, Steps};

/// Most intervals over which power is a mean: impacts of a cage last a step.
const MOST_INTERVALS: usize = 200;

/// Losses of the ledger besides the friction of the balls.
const SOURCES: [(&str, &[&str]); 5] = [
    ("drag of the balls", &["drag_loss_j"]),
    ("cage: friction", &["cage_friction_loss_j"]),
    ("cage: impacts", &["cage_impact_loss_j"]),
    ("cage: drag of the land", &["cage_drag_loss_j"]),
    ("damping", &["contact_loss_j", "rayleigh_loss_j"]),
];

const SIDES: [&str; 2] = ["inner", "outer"];

/// The figure of a run over time with free balls; none else.
pub fn figures(results: &Results) -> anyhow::Result<Vec<(String, Figure)>> {
    let (Some(balls), Some(energy), Steps::Times) = (&results.balls, &results.energy, &results.steps) else {
        return Ok(Vec::new());
    };
    if balls.find("inner_friction_power_w").is_none() || energy.n_rows() < 2 {
        return Ok(Vec::new());
    }
    let contacts = powers(balls, energy)?;
    let times = energy.column("time_s")?;
    let (times, parts, note) = match energy.find("friction_loss_j") {
        Some(friction) => {
            let intervals = Intervals::new(times);
            let parts = intervals.parts(energy, friction, &contacts);
            (intervals.middles(), parts, intervals.note())
        }
        None => {
            let note = "Friction of the contacts alone: equilibria have no ledger of losses.";
            let parts = named(contacts.map(|power| WATT.of(&power)));
            (times.to_vec(), parts, note.to_string())
        }
    };
    let parts: Vec<(String, Vec<f64>)> = parts
        .into_iter()
        .filter(|(_, power)| power.iter().any(|p| *p > 0.0))
        .collect();
    if parts.is_empty() {
        return Ok(Vec::new());
    }
    let axes = (
        MILLISECOND.axis("time").tight(),
        WATT.axis("power").including(0.0),
    );
    let figure = Figure::new("Power lost by source, one above the other", axes.0, axes.1).note(note);
    let figure = Series::stacked(&MILLISECOND.of(&times), &parts)
        .into_iter()
        .fold(figure, Figure::series);
    Ok(vec![("power_by_source".to_string(), figure)])
}

/// Friction power of all contacts with each ring, W, by row of the ledger.
fn powers(balls: &Table, energy: &Table) -> anyhow::Result<[Vec<f64>; 2]> {
    let (steps, rows) = (balls.column("step")?, energy.column("step")?);
    let mut sums = SIDES.map(|_| vec![0.0; rows.len()]);
    for (side, sum) in SIDES.iter().zip(&mut sums) {
        let power = balls.column(&format!("{side}_friction_power_w"))?;
        let mut row = 0;
        for (step, power) in steps.iter().zip(power) {
            while row + 1 < rows.len() && rows[row] < *step {
                row += 1;
            }
            sum[row] += power;
        }
    }
    Ok(sums)
}

fn named([inner, outer]: [Vec<f64>; 2]) -> Vec<(String, Vec<f64>)> {
    vec![
        ("traction, inner ring".into(), inner),
        ("traction, outer ring".into(), outer),
    ]
}

/// Intervals of rows.
struct Intervals<'t> {
    times: &'t [f64],
    /// First row and last row, which is the first of the next.
    ends: Vec<[usize; 2]>,
}

impl Intervals<'_> {
    /// As many as there may be, of nearly as many rows each; needs two times.
    fn new(times: &[f64]) -> Intervals<'_> {
        let last = times.len() - 1;
        let n = last.min(MOST_INTERVALS);
        let ends = (0..n).map(|i| [i * last / n, (i + 1) * last / n]).collect();
        Intervals { times, ends }
    }

    fn middles(&self) -> Vec<f64> {
        let middle = |[a, b]: &[usize; 2]| 0.5 * (self.times[*a] + self.times[*b]);
        self.ends.iter().map(middle).collect()
    }

    fn note(&self) -> String {
        let [a, b] = self.ends[0];
        // Three digits, without zeros at their end.
        let width: f64 = format!("{:.2e}", 1e3 * (self.times[b] - self.times[a]))
            .parse()
            .unwrap_or(f64::NAN);
        format!("Growth of the losses in the ledger, means over {width} ms.")
    }

    /// Mean growth of a sum of columns, W.
    fn growth(&self, columns: &[&[f64]]) -> Vec<f64> {
        let grown = |[a, b]: &[usize; 2]| {
            let energy: f64 = columns.iter().map(|column| column[*b] - column[*a]).sum();
            energy / (self.times[*b] - self.times[*a])
        };
        self.ends.iter().map(grown).collect()
    }

    /// All sources: the friction of the balls is shared as the powers of their contacts.
    fn parts(
        &self,
        energy: &Table,
        friction: &[f64],
        [inner, outer]: &[Vec<f64>; 2],
    ) -> Vec<(String, Vec<f64>)> {
        let share = |[a, b]: &[usize; 2]| {
            let sum = |power: &[f64]| power[a + 1..=*b].iter().sum::<f64>();
            let (inner, outer) = (sum(inner), sum(outer));
            if inner + outer > 0.0 {
                inner / (inner + outer)
            } else {
                0.5
            }
        };
        let shares: Vec<f64> = self.ends.iter().map(share).collect();
        let all = self.growth(&[friction]);
        let of_inner: Vec<f64> = all
            .iter()
            .zip(&shares)
            .map(|(power, share)| power * share)
            .collect();
        let of_outer = all
            .iter()
            .zip(&of_inner)
            .map(|(all, inner)| all - inner)
            .collect();
        let mut parts = named([of_inner, of_outer]);
        for (name, columns) in SOURCES {
            let found: Vec<&[f64]> = columns.iter().filter_map(|column| energy.find(column)).collect();
            parts.push((name.to_string(), self.growth(&found)));
        }
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: the areas would not be where the heat of the ledger comes from: their sum is the growth of all losses,
    /// and inner and outer contacts share friction as their powers do. Ten steps of 1 ms that lose 1, 2, 3 ... J.
    #[test]
    fn sources_add_up_to_the_growth_of_the_losses() {
        let dir = tempfile::tempdir().unwrap();
        let (mut energy, mut balls) = (
            String::from("step,time_s,friction_loss_j,drag_loss_j,contact_loss_j,rayleigh_loss_j\n"),
            String::from("step,time_s,ball,inner_friction_power_w,outer_friction_power_w\n"),
        );
        let (mut loss, mut drag) = (0.0, 0.0);
        for step in 0..=10 {
            loss += f64::from(step);
            drag += 0.5;
            energy += &format!(
                "{step},{},{loss},{drag},0.25,{}\n",
                1e-3 * f64::from(step),
                0.125 * f64::from(step)
            );
            for ball in 0..2 {
                balls += &format!("{step},{},{ball},3.0,1.0\n", 1e-3 * f64::from(step));
            }
        }
        std::fs::write(dir.path().join("energy.csv"), energy).unwrap();
        std::fs::write(dir.path().join("balls.csv"), balls).unwrap();
        let read = |name: &str| Table::read(dir.path(), name).unwrap().unwrap();
        let (energy, balls) = (read("energy.csv"), read("balls.csv"));
        let contacts = powers(&balls, &energy).unwrap();
        assert_eq!(contacts[0], [6.0; 11]);
        let intervals = Intervals::new(energy.column("time_s").unwrap());
        let friction = energy.column("friction_loss_j").unwrap();
        let parts = intervals.parts(&energy, friction, &contacts);
        for (i, step) in (1..=10).enumerate() {
            let near = |found: f64, expected: f64| {
                assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}")
            };
            near(parts[0].1[i], 0.75e3 * f64::from(step));
            near(parts[1].1[i], 0.25e3 * f64::from(step));
            let sum: f64 = parts.iter().map(|(_, power)| power[i]).sum();
            near(sum, 1e3 * (f64::from(step) + 0.5 + 0.125));
        }
        assert_eq!(
            intervals.note(),
            "Growth of the losses in the ledger, means over 1 ms."
        );
        // Many steps: fewer intervals, the same heat.
        let times: Vec<f64> = (0..=1003).map(|i| 1e-3 * f64::from(i)).collect();
        let many = Intervals::new(&times);
        let lost: Vec<f64> = times.iter().map(|t| t * t).collect();
        let width = |[a, b]: &[usize; 2]| times[*b] - times[*a];
        let heat: f64 = many
            .growth(&[&lost])
            .iter()
            .zip(&many.ends)
            .map(|(p, ends)| p * width(ends))
            .sum();
        assert_eq!(many.ends.len(), MOST_INTERVALS);
        assert!((heat / lost[1003] - 1.0).abs() < 1e-12, "{heat}");
    }
}
