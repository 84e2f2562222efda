//! A list of one bearing is that bearing, and an offset presses those bearings alone that it names.

use crate::several::{flexible_pair, kind, pair, parts, succeeds, with_type};
use crate::util::assert_close;
use crate::util::tables::summary;

/// Wrong: a list of one bearing would give other numbers than the same bearing in one table.
#[test]
fn a_list_of_one_bearing_gives_the_same_bits() {
    let dir = with_type();
    let rest = parts()[1].clone();
    let one = "[[bearing]]\nname = \"front\"\nposition = \"0 mm\"\norientation = \"+z\"\ntype = \"types/kind.toml\"\n";
    dir.write(
        "list.toml",
        rest.replace("[shaft]", &format!("{one}\n[shaft]\nmodel = \"rigid\"")),
    );
    dir.write("single.toml", format!("{rest}\n{}", kind()));
    succeeds(&dir, &["run", "single.toml", "--out", "single"]);
    succeeds(&dir, &["run", "list.toml", "--out", "list"]);
    for table in ["balls.csv", "shaft.csv", "energy.csv"] {
        assert!(
            dir.text(&format!("single/{table}")) == dir.text(&format!("list/{table}")),
            "{table}"
        );
    }
}

/// Wrong: the same of elastic rings at rest and in motion.
#[test]
fn a_list_of_one_elastic_bearing_gives_the_same_bits() {
    const ONE: &str = "[[bearing]]\nname = \"front\"\nposition = \"0 mm\"\norientation = \"+z\"\n\
                       type = \"types/kind.toml\"\n\n[shaft]\nmodel = \"rigid\"";
    let dir = flexible_pair("[static]");
    let analyses = [
        ("rest", "[static]"),
        (
            "motion",
            "[dynamic]\nduration = \"0.2 ms\"\nstep = \"20 us\"\n\n[speed]\ninner = \"12000 rpm\"",
        ),
        (
            "rolling",
            "[dynamic]\nduration = \"0.1 ms\"\nstep = \"20 us\"\n\n[dynamic.start.rolling]\n\n[speed]\n\
             inner = \"12000 rpm\"",
        ),
    ];
    for (name, analysis) in analyses {
        let [kind, rest] = parts();
        let rest = rest
            .replace("[static]", analysis)
            .replace("\"2 kN\"", "\"0.4 kN\"");
        let kind = kind.replace("mesh = \"", "mesh = \"types/");
        dir.write("single.toml", format!("{rest}\n{kind}"));
        dir.write("list.toml", rest.replace("[shaft]", ONE));
        let [single, list] = ["single", "list"].map(|form| format!("{name}_{form}"));
        succeeds(&dir, &["run", "single.toml", "--out", &single]);
        succeeds(&dir, &["run", "list.toml", "--out", &list]);
        for table in ["balls.csv", "shaft.csv", "energy.csv"] {
            let same = dir.text(&format!("{single}/{table}")) == dir.text(&format!("{list}/{table}"));
            assert!(same, "{name}: {table}");
        }
    }
}

/// Wrong: the balls of a list would start at rest where they are to start on their orbits, or go round where not.
#[test]
fn a_list_starts_rolling_where_it_is_asked_to() {
    let motion = "[dynamic]\nduration = \"20 us\"\nstep = \"10 us\"\n\n[speed]\ninner = \"24000 rpm\"\n";
    let dir = pair(&format!("{motion}\n[dynamic.start.rolling]\n"));
    dir.write(
        "still.toml",
        dir.text("pair.toml").replace("[dynamic.start.rolling]", ""),
    );
    let kinetic = ["pair", "still"].map(|name| {
        succeeds(&dir, &["run", &format!("{name}.toml"), "--out", name]);
        ["front", "rear"].map(|bearing| {
            let text = dir.text(&format!("{name}/{bearing}/energy.csv"));
            let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
            let column = rows[0]
                .iter()
                .position(|name| *name == "kinetic_balls_j")
                .unwrap();
            rows[1][column].parse::<f64>().unwrap()
        })
    });
    let [rolling, still] = kinetic;
    assert_eq!(still, [0.0, 0.0]);
    assert!(rolling.iter().all(|energy| *energy > 1e-12), "{rolling:?}");
}

/// Wrong: a floating bearing beside a pair would be pressed by the offset of the pair, or the pair by another force.
#[test]
fn an_offset_presses_those_bearings_alone_that_it_names() {
    let dir = pair("[static]");
    let third = "[[bearing]]\nname = \"floating\"\nposition = \"190 mm\"\norientation = \"+z\"\n\
                 type = \"types/kind.toml\"\n\n[pairing]\nbearings = [\"front\", \"rear\"]\n";
    let unloaded = |text: String| {
        text.replace(
            "force = [\"300 N\", \"0 N\", \"200 N\"]",
            "force = [\"0 N\", \"0 N\", \"1 uN\"]",
        )
    };
    let text = unloaded(dir.text("pair.toml"));
    dir.write("two.toml", &text);
    dir.write("three.toml", text.replace("[pairing]\n", third));
    let forces = ["two", "three"].map(|name| {
        succeeds(&dir, &["run", &format!("{name}.toml"), "--out", name]);
        let found = summary(&dir, name);
        ["front", "floating"].map(|bearing| {
            let path = format!("/bearings/{bearing}/force_on_shaft_n/2");
            found.pointer(&path).map(|force| force.as_f64().unwrap())
        })
    });
    let [[two, none], [three, floating]] = forces;
    assert!(none.is_none() && two.unwrap().abs() > 100.0, "{forces:?}");
    assert!(floating.unwrap().abs() < 0.01 * two.unwrap().abs(), "{forces:?}");
    assert_close("front", three.unwrap(), two.unwrap(), 0.02);
}

/// Wrong: the unit of the largest ball force would stand below another column of the table of bearings.
#[test]
fn units_of_a_list_stand_below_their_headings() {
    let dir = pair("[static]");
    let said = succeeds(&dir, &["run", "pair.toml", "--out", "out"]).stdout;
    let end_of = |text: &str| said.lines().find_map(|line| Some(line.find(text)? + text.len()));
    let unit = end_of("  N   balls").expect("the line of units");
    assert_eq!(end_of("  largest ball"), Some(unit - "   balls".len()), "{said}");
}
