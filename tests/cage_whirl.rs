//! When a cage that its balls guide whirls: the statements of Nogi, Maniwa and Matsuoka, J. Tribol. 140 (2018) 011101,
//! in the conditions of docs/traction.md. Minutes; `scripts/test-slow cage_whirl` runs them, `scripts/cage-whirl` more.

use crate::util::Dir;
use crate::util::delivered::delivered;
use crate::util::tables::Table;

/// Force in a pocket above which a cage whirls, N: calm ones stay below 5, whirls come to hundreds.
const WHIRLS: f64 = 60.0;

/// A run of the 7010C on rigid rings with 20 N across.
struct Case {
    /// Thrust, N.
    thrust: f64,
    /// Speed of the turning ring, rpm.
    speed: f64,
    /// The ring that turns.
    ring: &'static str,
    /// Friction of the cage.
    friction: f64,
    restitution: f64,
    /// Duration, ms.
    duration: f64,
    /// More keys.
    more: Vec<String>,
}

/// Traction that grows with slip up to 2 m/s, as in thick oil.
const THICK_OIL: &str =
    "effects.traction={law=\"curve\",at_rest=0.0,most=0.07,slip_of_most=\"2 m/s\",at_large=0.05}";

impl Case {
    fn new(thrust: f64, speed: f64, friction: f64, duration: f64) -> Case {
        Case {
            thrust,
            speed,
            ring: "inner",
            friction,
            restitution: 0.6,
            duration,
            more: Vec::new(),
        }
    }

    fn with_weight(mut self) -> Case {
        let gravity = "effects.gravity={acceleration=\"9.81 m/s2\",direction=[0.0,-1.0,0.0]}";
        self.more.push(gravity.to_string());
        self
    }

    fn in_thick_oil(mut self) -> Case {
        self.more.push(THICK_OIL.to_string());
        self
    }

    /// One pocket stands off its place, um, and pushes the cage once.
    fn pushed_by(mut self, offset: f64) -> Case {
        let others = ",\"0 um\"".repeat(17);
        self.more
            .push(format!("cage.pocket_offsets=[\"{offset} um\"{others}]"));
        self
    }

    /// The table of the cage.
    fn run(&self, dir: &Dir) -> Table {
        let other = if self.ring == "inner" { "outer" } else { "inner" };
        let mut sets = vec![
            "inner.flexible=false".to_string(),
            "outer.flexible=false".to_string(),
            format!("effects.axial_force.value={} N", self.thrust),
            "effects.radial_force.value=20 N".to_string(),
            format!("speed={{{}=\"{} rpm\",{other}=\"0 rpm\"}}", self.ring, self.speed),
            format!(
                "cage={{motion=\"free\",bore_diameter=\"62 mm\",outside_diameter=\"68.2 mm\",width=\"14 mm\",\
                 density=\"1400 kg/m3\",pocket_clearance=\"0.3 mm\",pocket_stiffness=\"2e8 N/m^1.5\",friction={},\
                 restitution={}}}",
                self.friction, self.restitution
            ),
            format!("dynamic.duration={} ms", self.duration),
            "dynamic.output_every=1000000".to_string(),
        ];
        sets.extend(self.more.clone());
        let sets = sets.iter().flat_map(|set| ["--set", set]);
        let first = ["run", "scenes/7010c_start_up.toml", "--out", "out", "--quiet"];
        let _ = std::fs::remove_dir_all(dir.path("out"));
        // A cage that whirls may end its run: it leaves its balls.
        let run = dir.raceway(&first.into_iter().chain(sets).collect::<Vec<_>>());
        assert!(dir.path("out/cage.csv").exists(), "{}", run.stderr);
        Table::read(dir, "out/cage.csv")
    }

    fn whirls(&self, dir: &Dir) -> bool {
        let largest = largest_force(&self.run(dir));
        println!(
            "{} N, {} rpm, {} turns, friction {}: {largest:.1} N",
            self.thrust, self.speed, self.ring, self.friction
        );
        largest > WHIRLS
    }
}

fn largest_force(table: &Table) -> f64 {
    let forces = table.column("largest_pocket_force_n");
    forces.into_iter().fold(0.0, f64::max)
}

/// Mean speed of the cage's centre round the middle of its path, rad/s, in the last fifth of a run.
fn whirl_rate(table: &Table) -> f64 {
    let [time, x, y] = ["time_s", "x_m", "y_m"].map(|name| table.column(name));
    let first = 4 * time.len() / 5;
    let middle = [&x, &y].map(|values| values[first..].iter().sum::<f64>() / (time.len() - first) as f64);
    let angle = |i: usize| (y[i] - middle[1]).atan2(x[i] - middle[0]);
    let turned = |i: usize| {
        let change = angle(i) - angle(i - 1);
        change.sin().atan2(change.cos())
    };
    (first + 1..time.len()).map(turned).sum::<f64>() / (time[time.len() - 1] - time[first])
}

/// Wrong: friction would not drive a whirl, or drive one where it is small, or the whirl would have the wrong sense.
#[test]
#[ignore = "some minutes; scripts/test-slow runs it"]
fn friction_ends_in_whirl_with_the_cage_if_the_inner_ring_turns_and_against_it_if_the_outer_does() {
    let dir = delivered();
    for (ring, sense) in [("inner", 1.0), ("outer", -1.0)] {
        let case = |friction: f64| Case {
            ring,
            ..Case::new(1000.0, 10_000.0, friction, 60.0).with_weight()
        };
        assert!(!case(0.4).whirls(&dir));
        let table = case(0.6).run(&dir);
        assert!(largest_force(&table) > WHIRLS);
        let rate = sense * whirl_rate(&table);
        println!("{ring} ring turns: {rate:.0} rad/s in its sense");
        assert!(rate > 10_000.0, "{ring}: {rate}");
    }
}

/// Wrong: raceways that slide less under a high load would not let the cage whirl sooner.
#[test]
#[ignore = "some minutes; scripts/test-slow runs it"]
fn whirl_comes_sooner_with_high_load() {
    let dir = delivered();
    let case = |thrust| {
        Case::new(thrust, 10_000.0, 0.5, 40.0)
            .with_weight()
            .in_thick_oil()
    };
    assert!(!case(500.0).whirls(&dir));
    assert!(case(5000.0).whirls(&dir));
}

/// Wrong: raceways that slide less at a low speed would not let the cage whirl sooner. Without weight, with impacts
/// that lose nothing, and the same push at both speeds: three pushes that differ by a few per cent of the clearance.
#[test]
#[ignore = "some minutes; scripts/test-slow runs it"]
fn whirl_comes_sooner_with_low_speed() {
    let dir = delivered();
    for offset in [155.0, 160.0, 165.0] {
        let case = |speed| Case {
            restitution: 1.0,
            ..Case::new(1000.0, speed, 0.3, 120.0)
                .in_thick_oil()
                .pushed_by(offset)
        };
        assert!(case(3000.0).whirls(&dir), "{offset}");
        assert!(!case(10_000.0).whirls(&dir), "{offset}");
    }
}
