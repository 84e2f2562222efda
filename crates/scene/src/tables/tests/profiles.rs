//! `[[profiles.*]]`, `[bearing.ball_diameters]` and `contact.edges`: what they read as, and what they refuse.

use super::*;

/// The example without given stiffnesses and spheres, with tables after its head.
fn with(tables: &str) -> String {
    let text = replace_line(EXAMPLE, "ball = \"sphere\"", "");
    text.replacen("[solver]", &format!("{tables}\n\n[solver]"), 1)
}

const SPALL: &str = "[[profiles.spall]]\nring = \"outer\"\nazimuth = \"30 deg\"\ngroove_angle = \"15 deg\"\n\
                     length = \"1 mm\"\nwidth = \"2 mm\"\ndepth = \"50 um\"\nedge = \"0.1 mm\"";

const DENT: &str = "[[profiles.dent]]\nring = \"inner\"\nazimuth = \"30 deg\"\ngroove_angle = \"15 deg\"\n\
                    diameter = \"0.3 mm\"\ndepth = \"10 um\"\nrim_height = \"1 um\"\nrim_width = \"0.1 mm\"";

const BALL_SPALL: &str = "[[profiles.spall]]\nball = 3\nlongitude = \"40 deg\"\nlatitude = \"-2 deg\"\n\
                          length = \"0.5 mm\"\nwidth = \"2 mm\"\ndepth = \"20 um\"";

/// Wrong: profiles of a ball would go to a ring, to another ball, or to other angles; or those of several kinds would
/// not add up.
#[test]
fn profiles_of_balls_read_as_their_documentation_says() {
    let more = "[[profiles.dent]]\nball = 3\nlongitude = \"1 deg\"\nlatitude = \"2 deg\"\ndiameter = \"0.3 mm\"\n\
                depth = \"10 um\"\n[[profiles.waviness]]\nball = 17\norder = 4\namplitude = \"0.1 um\"\n\
                [[profiles.random]]\nball = 3\norders = [2, 6]\namplitude = \"0.05 um\"\nslope = 1.0\nseed = 1";
    let found = parse(&with(&format!("{BALL_SPALL}\n{more}")), &[])
        .unwrap()
        .profiles;
    assert!(found.raceways.iter().all(|profiles| profiles.is_empty()));
    assert_eq!(found.balls.keys().collect::<Vec<_>>(), [&3, &17]);
    let worn = &found.balls[&3];
    let spall = worn.spalls[0];
    assert_eq!([spall.length, spall.width, spall.depth], [0.5e-3, 2e-3, 20e-6]);
    assert_eq!(
        [spall.azimuth, spall.groove_angle],
        [40f64, -2f64].map(f64::to_radians)
    );
    assert_eq!(
        [worn.dents[0].azimuth, worn.dents[0].groove_angle],
        [1f64, 2f64].map(f64::to_radians)
    );
    assert_eq!((worn.waves.len(), found.balls[&17].waves[0].order), (5, 4));
}

/// Wrong: a key of the documentation would be refused or read in another unit, or a scene without profiles have some.
#[test]
fn profiles_read_as_their_documentation_says() {
    assert_eq!(parse(EXAMPLE, &[]).unwrap().profiles, SurfaceProfiles::default());
    let waves =
        "[[profiles.waviness]]\nring = \"inner\"\norder = 19\namplitude = \"0.5 um\"\nphase = \"90 deg\"";
    let random = "[[profiles.random]]\nring = \"outer\"\norders = [2, 5]\n\
                  amplitude = \"0.05 um\"\nslope = 2.0\nseed = 1";
    let scene = parse(&with(&format!("{SPALL}\n{waves}\n{random}")), &[]).unwrap();
    let [inner, outer] = &scene.profiles.raceways;
    assert_eq!((inner.spalls.len(), inner.waves.len()), (0, 1));
    assert_eq!(inner.waves[0].order, 19);
    assert!((inner.waves[0].phase - 0.5 * std::f64::consts::PI).abs() < 1e-15);
    let spall = outer.spalls[0];
    assert_eq!([spall.length, spall.width, spall.depth], [1e-3, 2e-3, 50e-6]);
    assert_eq!(
        [spall.edge, spall.azimuth, spall.groove_angle],
        [0.1e-3, 30f64.to_radians(), 15f64.to_radians()]
    );
    let orders: Vec<usize> = outer.waves.iter().map(|wave| wave.order).collect();
    assert_eq!(orders, [2, 3, 4, 5]);
    assert!((outer.waves[2].amplitude - 0.05e-6 / 4.0).abs() < 1e-20);
    let dents = |text: &str| {
        parse(&with(text), &[]).unwrap().profiles.raceways[0]
            .dents
            .clone()
    };
    let dent = dents(DENT)[0];
    assert_eq!(
        [dent.diameter, dent.depth, dent.rim_height, dent.rim_width],
        [0.3e-3, 10e-6, 1e-6, 0.1e-3]
    );
    assert_eq!(
        [dent.azimuth, dent.groove_angle],
        [30f64.to_radians(), 15f64.to_radians()]
    );
    let bare = DENT.split("\nrim_height").next().unwrap();
    let found = dents(&format!("{DENT}\n{bare}"));
    assert_eq!(
        (found.len(), found[1].rim_height, found[1].rim_width),
        (2, 0.0, 0.0)
    );
    // Half-spaces are the default beside profiles.
    assert_eq!(scene.contact.ball, BallElasticity::HalfSpace);
    assert!(!scene.contact.edges);
}

/// Wrong: seeds would not reproduce surfaces, or all give one.
#[test]
fn seeds_make_surfaces_and_balls() {
    let random = |seed: i64| {
        let text = format!(
            "[[profiles.random]]\nring = \"outer\"\norders = [2, 9]\n\
             amplitude = \"0.05 um\"\nslope = 1.0\nseed = {seed}\n\
             [bearing.ball_diameters]\nspread = \"0.2 um\"\nseed = {seed}"
        );
        parse(&with(&text), &[]).unwrap().profiles
    };
    assert_eq!(random(1), random(1));
    assert_ne!(random(1), random(2));
    let oversizes = random(3).oversizes;
    assert_eq!(oversizes.len(), 18);
    let [low, high] = oversizes
        .iter()
        .fold([0.0f64; 2], |[a, b], x| [a.min(*x), b.max(*x)]);
    assert!(
        low >= -0.1e-6 && high <= 0.1e-6 && high - low > 0.12e-6,
        "{low} {high}"
    );
}

/// Wrong: a slip would make a surface that nobody asked for, or what is not there would be left out in silence.
#[test]
fn what_makes_no_sense_in_profiles_is_refused() {
    let spall = |line: &str, new: &str| replace_line(&with(SPALL), line, new);
    let dent = |line: &str, new: &str| replace_line(&with(DENT), line, new);
    let ball_spall = |line: &str, new: &str| replace_line(&with(BALL_SPALL), line, new);
    let waves = |keys: &str| with(&format!("[[profiles.waviness]]\nring = \"inner\"\n{keys}"));
    let balls = |keys: &str| with(&format!("[bearing.ball_diameters]\n{keys}"));
    for (text, part) in [
        (
            spall("length = \"1 mm\"", "length = \"0 mm\""),
            "profiles.spall 1: length is 0 mm; a length must be positive",
        ),
        (
            spall("length = \"1 mm\"", "length = \"1 m\""),
            "profiles.spall 1: length is 1 m; the track is only 175.96",
        ),
        (
            spall("length = \"1 mm\"", "length = \"1 um\""),
            "profiles.spall 1: length is 1 um; expected at least a thousandth of the ball diameter, 9 um",
        ),
        (
            spall("depth = ", "depth = \"5 mm\""),
            "profiles.spall 1: depth is 5 mm; expected at most the ball radius 4.5 mm",
        ),
        (
            spall("edge = ", "edge = \"0.6 mm\""),
            "profiles.spall 1: edge is 0.6 mm; the ramps lie within length and width: expected 0 to half of",
        ),
        (
            spall("groove_angle = ", "groove_angle = \"95 deg\""),
            "profiles.spall 1: groove_angle is 95 deg; expected -90 to 90 deg",
        ),
        (
            spall("ring = \"outer\"", "ring = \"ball\""),
            "profiles.spall[0].ring is \"ball\"; valid values are \"inner\", \"outer\"",
        ),
        (
            waves("order = 0\namplitude = \"1 um\""),
            "profiles.waviness 1: order is 0; expected a whole number from 1 to 20000",
        ),
        (
            waves("order = 3\namplitude = \"1 mm\""),
            "profiles.waviness 1: amplitude is 1 mm; expected more than 0 and at most 0.1 mm",
        ),
        (
            with(
                "[[profiles.random]]\nring = \"outer\"\norders = [9, 2]\namplitude = \"1 um\"\nslope = -1.0\nseed = 1",
            ),
            "profiles.random 1: orders is 9 to 2; expected the lower one first",
        ),
        (
            with(
                "[[profiles.random]]\nring = \"outer\"\norders = [2, 9]\namplitude = \"1 um\"\nslope = -1.0\nseed = 1",
            ),
            "profiles.random 1: slope is -1; expected 0 (all orders alike) to 10",
        ),
        (
            balls("spread = \"0.2 um\""),
            "bearing.ball_diameters.seed is missing; expected a whole number beside spread",
        ),
        (
            balls("seed = 1"),
            "bearing.ball_diameters needs one of spread, with a seed, and deviations",
        ),
        (
            balls("deviations = [\"1 um\", \"0 um\"]"),
            "bearing.ball_diameters.deviations is a list of 2; expected one for each of the 18 balls",
        ),
        (
            balls("spread = \"1 mm\"\nseed = 1"),
            "bearing.ball_diameters.spread is 1 mm; expected at most a thousandth of the ball diameter, 9 um",
        ),
        (
            with("[[profiles.dent]]\nring = \"outer\""),
            "[profiles.dent[0]] has no key \"diameter\", which is required",
        ),
        (
            dent("diameter = ", "diameter = \"0 mm\""),
            "profiles.dent 1: diameter is 0 mm; a diameter must be positive",
        ),
        (
            dent("diameter = ", "diameter = \"9 mm\""),
            "profiles.dent 1: diameter is 9 mm; expected a thousandth of the ball diameter, 9 um, to the whole of it, \
             9 mm, the rim included",
        ),
        (
            dent("depth = ", "depth = \"0.2 mm\""),
            "profiles.dent 1: depth is 0.2 mm; expected at most half the diameter, 150 um",
        ),
        (
            dent("depth = ", "depth = \"-1 um\""),
            "profiles.dent 1: depth is -1 um; a depth must be positive",
        ),
        (
            dent("groove_angle = ", "groove_angle = \"95 deg\""),
            "profiles.dent 1: groove_angle is 95 deg; expected -90 to 90 deg",
        ),
        (
            dent("rim_height = ", "rim_height = \"11 um\""),
            "profiles.dent 1: rim_height is 11 um; expected 0 to the depth",
        ),
        (
            dent("rim_width = ", "rim_width = \"1 mm\""),
            "profiles.dent 1: rim_width is 1 mm; expected a hundredth of the diameter, 3 um, to the whole of it",
        ),
        (
            dent("rim_width = ", ""),
            "profiles.dent 1: rim_width is missing; expected a length beside rim_height",
        ),
        (
            dent("rim_height = ", ""),
            "profiles.dent 1: rim_height is missing; expected a height beside rim_width",
        ),
        (
            dent("azimuth = ", ""),
            "profiles.dent 1: azimuth is missing; expected an angle beside ring",
        ),
        (
            dent("ring = ", "ball = 3"),
            "profiles.dent 1: azimuth stands beside ball; a place on a ball has longitude and latitude",
        ),
        (
            dent("ring = ", ""),
            "profiles.dent 1: ring or ball is missing; expected ring = \"inner\" or \"outer\", or ball = 0 and so on",
        ),
        (
            spall("ring = ", "ring = \"outer\"\nball = 3"),
            "profiles.spall 1: ring and ball are both given; expected one, a table of its own for each",
        ),
        (
            spall("edge = ", "edge = \"0.1 mm\"\nlongitude = \"5 deg\""),
            "profiles.spall 1: longitude stands beside ring; a place on a ring has azimuth and groove_angle",
        ),
        (
            with("[[profiles.waviness]]\norder = 3\namplitude = \"1 um\""),
            "profiles.waviness 1: ring or ball is missing",
        ),
        (
            ball_spall("ball = ", "ball = 18"),
            "profiles.spall 1: ball is 18; expected a whole number from 0 to 17",
        ),
        (
            ball_spall("ball = ", "ball = -1"),
            "profiles.spall 1: ball is -1; expected a whole number from 0 to 17",
        ),
        (
            ball_spall("latitude = ", ""),
            "profiles.spall 1: latitude is missing; expected an angle beside ball",
        ),
        (
            ball_spall("latitude = ", "latitude = \"79 deg\""),
            "profiles.spall 1: latitude is 79 deg; expected -80 to 80 deg, the width included: raceways never touch",
        ),
        (
            ball_spall("length = ", "length = \"29 mm\""),
            "profiles.spall 1: length is 29 mm; the track is only 28.2",
        ),
        (
            replace_line(&with(SPALL), "mode = \"patch\"", "mode = \"facet\""),
            "contact.mode is \"facet\"; profiles needs exact grooves, use \"patch\" or \"rigid\"",
        ),
        (
            replace_line(EXAMPLE, "edges = false", "edges = true"),
            "contact.ball is \"sphere\"; beside contact.edges both contacts of a ball are on their own",
        ),
    ] {
        let message = message_of(&text, &[]);
        assert!(message.contains(part), "{message}\nhas no\n{part}");
    }
}

/// Wrong: a bearing on real surfaces would have modes of one place of its rings.
#[test]
fn modes_on_real_surfaces_are_refused() {
    let (head, _) = EXAMPLE.split_once("[sweep]").unwrap();
    let text = replace_line(head, "ball = \"sphere\"", "");
    let text = replace_line(&text, "edges = false", "edges = true") + "\n[modes]\nnumber = 3\n";
    let message = message_of(&text, &[]);
    assert!(
        message.contains("contact.edges has no natural modes"),
        "{message}"
    );
}

/// Wrong: a table of measured heights would be read wrongly, or a broken one go unnoticed.
#[test]
fn tables_of_heights_are_read_and_checked() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let parse_with = |csv: &str| {
        std::fs::write(folder.path().join("roundness.csv"), csv).unwrap();
        let text = with("[[profiles.table]]\nring = \"outer\"\nfile = \"roundness.csv\"");
        Scene::parse(&text, &scene, &[], MeshFiles::MayBeMissing)
    };
    let missing = with("[[profiles.table]]\nring = \"outer\"\nfile = \"none.csv\"");
    let error = Scene::parse(&missing, &scene, &[], MeshFiles::MustExist).unwrap_err();
    assert!(
        error.to_string().contains("profiles.table 1: cannot read "),
        "{error}"
    );
    let good = "# measured\nazimuth_deg, groove_angle_deg, height_um\n180, -5, 1\n0, -5, 0.5\n\
                180, 20, 2\n0, 20, -0.25\n";
    let found = parse_with(good).unwrap().profiles;
    let table = &found.raceways[1].tables[0];
    assert_eq!(table.azimuths, [0.0, std::f64::consts::PI]);
    assert_eq!(table.angles, [(-5f64).to_radians(), 20f64.to_radians()]);
    assert_eq!(table.heights, [0.5e-6, -0.25e-6, 1e-6, 2e-6]);
    assert_eq!(found.from_files().count(), 8);
    let ball = with("[[profiles.table]]\nball = 2\nfile = \"roundness.csv\"");
    let parse_ball = |csv: &str| {
        std::fs::write(folder.path().join("roundness.csv"), csv).unwrap();
        Scene::parse(&ball, &scene, &[], MeshFiles::MayBeMissing)
    };
    let found = parse_ball("longitude_deg, latitude_deg, height_um\n0, 0, 1\n180, 0, 2\n")
        .unwrap()
        .profiles;
    assert_eq!(found.balls[&2].tables[0].heights, [1e-6, 2e-6]);
    assert_eq!(found.from_files().count(), 5);
    for (csv, part) in [
        (
            good,
            "line 1 is \"azimuth_deg,groove_angle_deg,height_um\"; expected the columns \
             longitude_deg,latitude_deg,height_um",
        ),
        (
            "longitude_deg,latitude_deg,height_um\n-1,0,1\n",
            "expected a longitude from 0 to below 360 deg, a latitude between -90 and 90 deg",
        ),
    ] {
        let message = parse_ball(csv).unwrap_err().to_string();
        assert!(message.contains(part), "{message}\nhas no\n{part}");
    }
    for (csv, part) in [
        (
            "a,b\n",
            "expected the columns azimuth_deg,groove_angle_deg,height_um",
        ),
        (
            "azimuth_deg,groove_angle_deg,height_um\n",
            "there is no line below the columns",
        ),
        (
            "azimuth_deg,groove_angle_deg,height_um\n0,0,x\n",
            "line 2 is \"0,0,x\"; expected three numbers",
        ),
        (
            "azimuth_deg,groove_angle_deg,height_um\n0,0,500\n",
            "expected an azimuth from 0 to below 360 deg",
        ),
        (
            "azimuth_deg,groove_angle_deg,height_um\n0,0,1\n0,0,2\n",
            "line 3 gives \"0,0,2\" again; expected each point once",
        ),
        (
            "azimuth_deg,groove_angle_deg,height_um\n0,0,1\n90,5,2\n",
            "the azimuth 90 deg has other groove angles than the first one; expected a full grid",
        ),
    ] {
        let message = parse_with(csv).unwrap_err().to_string();
        assert!(message.contains(part), "{message}\nhas no\n{part}");
    }
}

/// Wrong: profiles of a ball would turn about an axis that is not that of its motion.
#[test]
fn profiles_of_balls_need_a_motion_that_is_known() {
    let effect = "[effects.ball_centrifugal]\n[speed]\ninner = \"1800 rpm\"\nball_speeds = \"outer_control\"";
    let message = message_of(&with(&format!("{BALL_SPALL}\n{effect}")), &[]);
    let part = "speed.ball_speeds is \"outer_control\" beside profiles of a ball; a ball then rolls about an axis that";
    assert!(message.contains(part), "{message}");
    assert!(parse(&with(&format!("{SPALL}\n{effect}")), &[]).is_ok());
}
