//! What stands in the place of the words in capitals: the folder of inputs and results in which commands are run.

use std::sync::OnceLock;

use crate::gauges::gauges_beside_balls;
use crate::remarks::SECTION;
use crate::util::{Dir, Files, SCENE, with_line};

/// A command as a page has it, and what stands for its words: [`world`] has these files.
pub struct Filled {
    /// The command of the page.
    pub command: &'static str,
    /// Words of it, and what is run in their place; the rest is run as it is written.
    pub words: &'static [(&'static str, &'static str)],
}

const fn filled(command: &'static str, words: &'static [(&'static str, &'static str)]) -> Filled {
    Filled { command, words }
}

const ON_RUN: &[(&str, &str)] = &[("DIR", "done")];
const ON_SCENE: &[(&str, &str)] = &[("SCENE", "scene.toml")];

/// Every command with words that a reader fills in. One of another text is another command.
pub const FILLED: &[Filled] = &[
    filled("raceway run SCENE", ON_SCENE),
    filled("raceway check SCENE", ON_SCENE),
    filled(
        "raceway stiffness SCENE --out DIR",
        &[("SCENE", "scene.toml"), ("DIR", "slopes")],
    ),
    filled(
        "raceway mesh SCENE",
        &[("SCENE", "sections.toml --set outer.flexible=false")],
    ),
    filled(
        "raceway mesh scenes/7010c_1800rpm_coarse.toml",
        &[("coarse.toml", "coarse.toml --force")],
    ),
    filled("raceway prices SCENE", &[("SCENE", "rigid.toml")]),
    filled("raceway heat SCENE", ON_SCENE),
    filled("raceway life --rating SCENE", ON_SCENE),
    filled(
        "raceway life --stress SCENE",
        &[("SCENE", "scene.toml --set effects.fit.inner.interference='10 um'")],
    ),
    filled(
        "raceway life --spectrum FILE.toml",
        &[("FILE.toml", "spectrum.toml")],
    ),
    filled(
        "raceway study STUDY",
        &[("STUDY", "study.toml --out grid --point 1")],
    ),
    filled("raceway info PATH", &[("PATH", "done")]),
    filled("raceway info DIR --verify", ON_RUN),
    filled(
        "raceway resume DIR",
        &[("DIR", "done --set dynamic.duration='11 ms'")],
    ),
    filled("raceway cycles DIR", ON_RUN),
    filled(
        "raceway cycles DIR --from 0.1 --to 0.177",
        &[("DIR", "done"), ("0.1 ", "0.001 "), ("0.177", "0.009")],
    ),
    filled("raceway export DIR --to csv", ON_RUN),
    filled("raceway plot DIR", ON_RUN),
    filled("raceway report DIR", ON_RUN),
    filled("raceway life DIR", ON_RUN),
    filled("raceway pack DIR", ON_RUN),
    filled("raceway help scene KEY", &[("KEY", "contact_angle")]),
    filled(
        "raceway spectrum DIR --probe NAME --orders shaft",
        &[("DIR", "done"), ("NAME", "z_m")],
    ),
    filled(
        "raceway spectrum DIR --probe NAME --wav --csv",
        &[("DIR", "done"), ("NAME", "z_m")],
    ),
    filled(
        "raceway spectrum DIR --probe NAME [--envelope LOW..HIGH",
        &[
            ("DIR", "done"),
            ("NAME", "x_m"),
            ("[--envelope", "--envelope"),
            ("LOW..HIGH", "2000..8000"),
        ],
    ),
    filled(
        "raceway load-matrix SCENE --out DIR [--ring outer] [--time S]",
        &[
            ("SCENE", "scene.toml"),
            ("DIR", "matrix"),
            ("[--ring outer]", "--ring outer"),
            (" [--time S]", ""),
        ],
    ),
    filled(
        "raceway ball-loads RUN --matrix DIR/load_matrix.json",
        &[("RUN", "rest"), ("DIR", "matrix")],
    ),
    filled(
        "raceway stiffness SCENE --out DIR [--ripple N] [--time SECONDS] [--set PATH=VALUE]",
        &[
            ("SCENE", "scene.toml"),
            ("DIR", "stiffness"),
            ("[--ripple N]", "--ripple 2"),
            ("[--time SECONDS] ", ""),
            ("[--set PATH=VALUE]", "--set effects.axial_force.value='1 kN'"),
        ],
    ),
    filled(
        "raceway campbell SCENE --speeds 0..40000:2000 --out DIR [--number N] [--set PATH=VALUE]",
        &[
            ("SCENE", "scene.toml"),
            ("DIR", "campbell"),
            ("2000 ", "20000 "),
            ("[--number N]", "--number 4"),
            ("[--set PATH=VALUE]", "--set effects.axial_force.value='1 kN'"),
        ],
    ),
    filled(
        "raceway stiffness scenes/7010c_preload_sweep.toml --out DIR",
        &[("DIR", "sweep --set sweep.values='[\"1 kN\", \"2 kN\"]'")],
    ),
];

/// The scene of the tests with all that a command here asks of a scene.
fn scene() -> String {
    let expansion = "density = \"7800 kg/m3\"\nexpansion = \"11.5e-6 /K\"\n";
    let shaft = "load_point = \"0 mm\"\nmass = \"2 kg\"\ntransverse_inertia = \"2e-3 kg m2\"\n\
                 polar_inertia = \"1e-3 kg m2\"\n";
    let heat = "[heat]\nambient = \"20 degC\"\nspeed = \"3000 rpm\"\ntorque = \"0.05 N m\"\n\
                conductance.inner_ambient = \"0.4 W/K\"\nconductance.outer_ambient = \"2 W/K\"\n";
    let life = "[life]\ncontact_angle = \"15 deg\"\nspeed = \"1800 rpm\"\n";
    SCENE
        .replace("density = \"7800 kg/m3\"\n", expansion)
        .replace("load_point = \"0 mm\"\n", shaft)
        .replace(
            "tilt_x = \"locked\"\ntilt_y = \"locked\"",
            "tilt_x = \"free\"\ntilt_y = \"free\"",
        )
        .replace("support = \"clamped\"", "support = \"mean_motion\"")
        .replace(
            "[static]",
            &format!("{heat}\n{life}\n{}\n[static]", gauges_beside_balls()),
        )
}

/// A motion of 10 ms with a node, a tachometer and life.
const MOTION: &str = "[dynamic]\nduration = \"10 ms\"\nstep = \"20 us\"\noutput_every = 250\n\n\
                      [speed]\ninner = \"1800 rpm\"\n\n[probes.tachometer.shaft]\nring = \"inner\"\n\n\
                      [probes.node.p]\nring = \"outer\"\nazimuth = \"0 deg\"\ngroove_angle = \"15 deg\"\n\n\
                      [life]\ncontact_angle = \"15 deg\"\n";

/// The scene of the study.
const PULSE: &str = "[dynamic]\nduration = \"0.2 ms\"\nstep = \"4 us\"\noutput_every = 1000";

const SPECTRUM: &str = "[[conditions]]\nresults = \"done\"\nshare = 0.7\n\n\
                        [[conditions]]\nresults = \"rest\"\nshare = 0.3\n";

/// A folder with scenes, meshes, and results of a motion (`done`) and of a scene at rest (`rest`); made once.
pub fn world() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = Dir::with_meshes();
        // A run goes on only beside its own scene.
        dir.write("motion.toml", with_line("[static]", "[static]", MOTION));
        let outcome = dir.raceway(&["run", "motion.toml", "--out", "done"]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        dir.write("scene.toml", scene());
        dir.run("rest", &[]);
        for results in ["done", "rest"] {
            let outcome = dir.raceway(&["life", results]);
            assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        }
        dir.write("spectrum.toml", SPECTRUM);
        let rigid = SCENE.replace("mesh_unit = \"mm\"", "flexible = false");
        dir.write(
            "rigid.toml",
            rigid.replace("mode = \"patch\"", "mode = \"rigid\""),
        );
        let sections = with_line("[outer]", "[outer]", SECTION);
        dir.write("sections.toml", sections.replace("inner.msh", "made_inner.msh"));
        dir.write("pulse.toml", with_line("[static]", "[static]", PULSE));
        let study = include_str!("../fixtures/study.toml");
        dir.write("study.toml", study.replace("scene.toml", "pulse.toml"));
        dir.snapshot()
    }))
}
