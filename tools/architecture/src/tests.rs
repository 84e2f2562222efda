//! The checker on small source trees.

use std::path::Path;

use tempfile::TempDir;

use crate::check;
use crate::imports::{self, Imports};
use crate::numbers::{Measured, Program};
use crate::rules::Rules;
use crate::workspace::Workspace;

/// A workspace with the given crates and files.
fn tree(crates: &[(&str, &str)], files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |path: &str, text: &str| {
        let path = folder.path().join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    let members: Vec<String> = crates
        .iter()
        .map(|(name, _)| format!("\"crates/{name}\""))
        .collect();
    write(
        "Cargo.toml",
        &format!("[workspace]\nmembers = [{}]\n", members.join(", ")),
    );
    for (name, dependencies) in crates {
        let text = format!("[package]\nname = \"raceway-{name}\"\n[dependencies]\n{dependencies}");
        write(&format!("crates/{name}/Cargo.toml"), &text);
    }
    for (path, text) in files {
        write(path, text);
    }
    folder
}

/// A crate `a` with the given files in `src`.
fn crate_a(files: &[(&str, &str)]) -> TempDir {
    let files: Vec<(String, &str)> = files
        .iter()
        .map(|(path, text)| (format!("crates/a/src/{path}"), *text))
        .collect();
    let files: Vec<(&str, &str)> = files.iter().map(|(path, text)| (path.as_str(), *text)).collect();
    tree(&[("a", "")], &files)
}

fn read(folder: &TempDir) -> (Workspace, Imports) {
    let workspace = Workspace::read(folder.path()).unwrap();
    let imports = imports::resolve(&workspace).unwrap();
    (workspace, imports)
}

/// Imports as `FROM:LINE -> TO` with paths in `crates`.
fn import_lines(folder: &TempDir) -> Vec<String> {
    let (_, found) = read(folder);
    let name = |file: usize| {
        let path = found.files[file].path.strip_prefix("crates").unwrap();
        path.display().to_string().replace("/src/", "/")
    };
    let imports = found.imports.iter();
    imports
        .map(|import| format!("{}:{} -> {}", name(import.from), import.line, name(import.to)))
        .collect()
}

fn measured(folder: &TempDir, rules: &str) -> Measured {
    let rules: Rules = toml::from_str(&format!("start = \"x\"\n{rules}")).unwrap();
    let (workspace, imports) = read(folder);
    let program = Program::new(&workspace, &imports);
    program.measure(&rules.numbers[0], &rules).unwrap()
}

fn number(measure: &str, more: &str) -> String {
    format!("[[number]]\nname = \"n\"\nmeasure = \"{measure}\"\nat_start = 0\nreach = \"0\"\n{more}\n")
}

fn places(measured: &Measured) -> Vec<String> {
    measured.places.iter().map(ToString::to_string).collect()
}

/// A circle over three files would be overlooked, or a file outside it would count.
#[test]
fn a_circle_is_found() {
    let folder = crate_a(&[
        ("lib.rs", "mod x;\nmod y;\nmod z;\nmod w;\n"),
        ("x.rs", "use crate::y::Y;\npub struct X(Y);\n"),
        ("y.rs", "use crate::z::Z;\npub struct Y(Z);\n"),
        ("z.rs", "pub struct Z(Box<crate::x::X>);\n"),
        ("w.rs", "use crate::x::X;\npub struct W(X);\n"),
    ]);
    let found = measured(&folder, &number("files-in-circles", ""));
    assert_eq!(found.value, 3);
    assert_eq!(
        places(&found)[2],
        "crates/a/src/z.rs:1: imports crates/a/src/x.rs, in a circle of 3 files"
    );
    assert_eq!(measured(&folder, &number("largest-circle", "")).value, 3);
}

/// An import through a re-export would be one of the file that passes it on.
#[test]
fn a_re_export_is_resolved() {
    let folder = crate_a(&[
        ("lib.rs", "mod motion;\nmod user;\npub use motion::Thing;\n"),
        ("motion/mod.rs", "mod state;\npub use state::State as Thing;\n"),
        ("motion/state.rs", "pub struct State;\n"),
        ("user.rs", "\nuse crate::Thing;\npub fn f(_: Thing) {}\n"),
    ]);
    assert_eq!(import_lines(&folder), ["a/user.rs:2 -> a/motion/state.rs"]);
}

/// A star that passes on names would hide who imports what.
#[test]
fn stars_are_followed() {
    let folder = crate_a(&[
        ("lib.rs", "mod all;\nmod part;\nmod user;\n"),
        ("all.rs", "pub use crate::part::*;\n"),
        ("part.rs", "pub struct Part;\n"),
        ("user.rs", "use crate::all::*;\npub fn f() -> Part { todo!() }\n"),
    ]);
    assert_eq!(import_lines(&folder), ["a/user.rs:2 -> a/part.rs"]);
}

/// Paths that start at a parent, at the module itself, or at an imported module would lead nowhere.
#[test]
fn relative_paths_are_resolved() {
    let folder = crate_a(&[
        ("lib.rs", "mod b;\nmod c;\npub const N: usize = 3;\n"),
        (
            "b/mod.rs",
            "pub mod d;\npub mod e;\npub fn f() { self::e::g() }\n",
        ),
        ("b/d.rs", "pub fn g() -> usize { super::super::N }\n"),
        ("b/e.rs", "pub fn g() { super::d::g(); }\n"),
        ("c.rs", "use super::b;\npub fn g() { b::d::g(); b::f() }\n"),
    ]);
    assert_eq!(
        import_lines(&folder),
        [
            "a/b/mod.rs:3 -> a/b/e.rs",
            "a/b/d.rs:1 -> a/lib.rs",
            "a/b/e.rs:1 -> a/b/d.rs",
            "a/c.rs:2 -> a/b/mod.rs",
            "a/c.rs:2 -> a/b/d.rs",
        ]
    );
}

/// Inline modules would break the count of `super`, and their imports would be lost.
#[test]
fn inline_modules_are_seen() {
    let folder = crate_a(&[
        (
            "lib.rs",
            "mod x { pub mod y { pub fn f() { super::super::b::g() } }\n pub mod z; }\nmod b;\n",
        ),
        ("x/z.rs", "pub fn f() { crate::b::g() }\n"),
        ("b.rs", "pub fn g() {}\n"),
    ]);
    assert_eq!(
        import_lines(&folder),
        ["a/lib.rs:1 -> a/b.rs", "a/x/z.rs:1 -> a/b.rs"]
    );
}

/// Paths in the arguments of a macro would not count.
#[test]
fn macros_are_searched() {
    let folder = crate_a(&[
        ("lib.rs", "mod b;\nmod c;\n"),
        ("b.rs", "pub const N: usize = 3;\n"),
        (
            "c.rs",
            "pub fn f() -> String {\n    format!(\"{}\", crate::b::N)\n}\n",
        ),
    ]);
    assert_eq!(import_lines(&folder), ["a/c.rs:2 -> a/b.rs"]);
}

/// What tests import would make circles in the program.
#[test]
fn imports_of_tests_do_not_count() {
    let folder = crate_a(&[
        ("lib.rs", "mod b;\nmod c;\n#[cfg(test)]\nmod tests;\n"),
        (
            "b.rs",
            "pub struct B;\n#[cfg(test)]\nmod tests {\n    use crate::c::C;\n    fn f(_: C) {}\n}\n",
        ),
        ("c.rs", "pub struct C;\n#[cfg(test)]\nuse crate::b::B;\n"),
        ("tests.rs", "use crate::b::B;\n"),
    ]);
    assert_eq!(import_lines(&folder), Vec::<String>::new());
    assert_eq!(measured(&folder, &number("code-lines", "")).value, 4);
}

/// A path into another crate would stop at its root instead of the file that defines the item.
#[test]
fn paths_into_other_crates_are_resolved() {
    let folder = tree(
        &[("a", "b = \"1\"\n"), ("b", "c = \"1\"\n"), ("c", "")],
        &[
            ("crates/a/src/lib.rs", "use b::Deep;\npub fn f(_: Deep) {}\n"),
            ("crates/b/src/lib.rs", "pub use c::inner::Deep;\n"),
            ("crates/c/src/lib.rs", "pub mod inner;\n"),
            ("crates/c/src/inner.rs", "pub struct Deep;\n"),
        ],
    );
    assert_eq!(
        import_lines(&folder),
        ["a/lib.rs:1 -> c/inner.rs", "b/lib.rs:1 -> c/inner.rs"]
    );
    let rules = "[[crate]]\nname = \"a\"\nuses = [\"b\"]\n[[crate]]\nname = \"b\"\nuses = [\"c\"]\n";
    let found = measured(
        &folder,
        &format!("{rules}{}", number("imports-of-other-crates", "")),
    );
    assert_eq!(
        places(&found),
        ["crates/a/src/lib.rs:1: imports crates/c/src/inner.rs, but a may not use c"]
    );
}

/// An import from a higher layer would pass, or be told without its line.
#[test]
fn an_import_against_the_layers_is_told_with_its_line() {
    let folder = crate_a(&[
        ("lib.rs", "mod low;\nmod high;\npub use high::High;\n"),
        ("low.rs", "\n\nuse crate::High;\npub struct Low(Box<High>);\n"),
        (
            "high/mod.rs",
            "mod base;\nuse crate::low::Low;\npub struct High(Low);\n",
        ),
        ("high/base.rs", "use crate::low::Low;\npub struct Base(Low);\n"),
    ]);
    let layers = |layers: &str| {
        let rules = format!("[[crate]]\nname = \"a\"\nuses = []\nlayers = {layers}\n");
        places(&measured(
            &folder,
            &format!("{rules}{}", number("imports-against-layers", "")),
        ))
    };
    let low = "crates/a/src/low.rs:3: imports crates/a/src/high/mod.rs, layer 1 imports from layer 2";
    assert_eq!(layers("[[\"low\"], [\"high\"]]"), [low]);
    assert_eq!(layers("[[\"low\", \"high\"]]"), Vec::<String>::new());
    let base = "crates/a/src/high/base.rs:1: imports crates/a/src/low.rs, layer 1 imports from layer 2";
    let low = low
        .replace("layer 1", "layer 2")
        .replace("from layer 2", "from layer 3");
    assert_eq!(
        layers("[[\"high::base\"], [\"low\"], [\"high\"]]"),
        [low.as_str(), base]
    );
}

/// A module that nobody put into a layer would be free of the order.
#[test]
fn a_module_without_layer_is_told() {
    let folder = crate_a(&[("lib.rs", "mod b;\nmod c;\n"), ("b.rs", ""), ("c.rs", "")]);
    let rules = "[[crate]]\nname = \"a\"\nuses = []\nlayers = [[\"b\"]]\n";
    let found = measured(&folder, &format!("{rules}{}", number("files-without-layer", "")));
    assert_eq!(
        places(&found),
        ["crates/a/src/c.rs: module c is in no layer of a"]
    );
}

/// Words in comments and tests would be violations, or words in code would not.
#[test]
fn words_count_in_code_alone() {
    let text =
        "//! faer\n/// faer\npub fn f() { /* faer */ }\nuse faer::Mat; // faer\n#[cfg(test)]\nuse faer::R;\n";
    let folder = crate_a(&[("lib.rs", text)]);
    let rule = "[[word]]\nrule = \"no faer\"\npattern = '\\bfaer\\b'\nnot = [\"a\"]\n";
    let rules: Rules = toml::from_str(&format!("start = \"x\"\n{rule}")).unwrap();
    let (workspace, imports) = read(&folder);
    let proper = Program::new(&workspace, &imports).proper();
    let found = check::words(&workspace, &rules, &proper).unwrap();
    let found: Vec<String> = found.iter().map(ToString::to_string).collect();
    assert_eq!(found, ["crates/a/src/lib.rs:4: use faer::Mat;  <- no faer"]);
}

/// `only` would bind before its crate exists, or spare benchmarks.
#[test]
fn only_holds_once_its_crate_exists() {
    let rule = "[[word]]\nrule = \"only b\"\npattern = 'toml::'\nonly = [\"b\"]\n";
    let rules: Rules = toml::from_str(&format!("start = \"x\"\n{rule}")).unwrap();
    let files = [
        ("crates/a/src/lib.rs", ""),
        ("crates/a/benches/x.rs", "use toml::Table;\n"),
        ("crates/b/src/lib.rs", "use toml::Table;\n"),
    ];
    let count = |crates: &[(&str, &str)]| {
        let folder = tree(crates, &files);
        let (workspace, imports) = read(&folder);
        let proper = Program::new(&workspace, &imports).proper();
        check::words(&workspace, &rules, &proper).unwrap().len()
    };
    assert_eq!(count(&[("a", "")]), 0);
    assert_eq!(count(&[("a", ""), ("b", "")]), 1);
}

/// A dependency that is not allowed would pass, or one of tests would not.
#[test]
fn dependencies_are_those_allowed() {
    let rule = "[[crate]]\nname = \"a\"\nuses = [\"b\"]\nlibraries = [\"rayon\"]\n[[crate]]\nname = \"b\"\nuses = []\n";
    let rules: Rules = toml::from_str(&format!("start = \"x\"\n{rule}")).unwrap();
    let dependencies = "b = \"1\"\nrayon = \"1\"\nfaer = \"1\"\n[dev-dependencies]\ndivan = \"1\"\n\
        [target.'cfg(unix)'.dependencies]\nmpi = \"1\"\n";
    let folder = tree(
        &[("a", dependencies), ("b", "any = \"1\"\na = \"1\"\n")],
        &[("crates/a/src/lib.rs", ""), ("crates/b/src/lib.rs", "")],
    );
    let found = check::dependencies(&read(&folder).0, &rules);
    let found: Vec<String> = found.iter().map(ToString::to_string).collect();
    assert_eq!(
        found,
        [
            "crates/a/Cargo.toml: depends on faer; allowed are rayon",
            "crates/a/Cargo.toml: depends on mpi; allowed are rayon",
            "crates/b/Cargo.toml: depends on a; allowed are ",
        ]
    );
}

/// A long file of tests would pass, or files within the limit would be told with it.
#[test]
fn long_files_are_told() {
    let folder = crate_a(&[("lib.rs", ""), ("tests.rs", &"\n".repeat(501))]);
    let found = measured(&folder, &number("longest-file", ""));
    assert_eq!(found.value, 501);
    let over: Vec<String> = found
        .over(500, folder.path())
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(over, ["crates/a/src/tests.rs: 501 lines"]);
    assert!(found.over(501, folder.path()).is_empty());
}

/// Lengths of functions, types of one name, and matches would be counted wrongly.
#[test]
fn code_is_measured() {
    let folder = crate_a(&[
        (
            "lib.rs",
            "mod b;\npub struct Part;\n\n/// Long.\npub fn f() {\n    g();\n}\n\nfn g() {}\n",
        ),
        (
            "b.rs",
            "pub enum Part {}\nimpl Part {\n    fn h(\n    ) {\n    }\n}\nfn i() { unreachable!(\"no\") }\n",
        ),
    ]);
    assert_eq!(measured(&folder, &number("longest-function", "")).value, 3);
    assert_eq!(measured(&folder, &number("median-function", "")).value, 3);
    assert_eq!(measured(&folder, &number("code-lines", "")).value, 13);
    let shared = measured(&folder, &number("shared-type-names", ""));
    assert_eq!(
        places(&shared),
        ["crates/a/src/b.rs:1: Part, also crates/a/src/lib.rs:2"]
    );
    let matches = measured(
        &folder,
        &number("matches", "patterns = ['\\bunreachable!', '\\bPart\\b']"),
    );
    assert_eq!(matches.value, 4);
    let both = measured(
        &folder,
        &number(
            "files-with-matches",
            "patterns = ['\\bunreachable!', '\\bPart\\b']",
        ),
    );
    assert_eq!(both.value, 1);
}

/// A list that names a module which has gone would go on counting it.
#[test]
fn lists_name_modules_that_exist() {
    let folder = crate_a(&[
        ("lib.rs", "mod b;\n"),
        ("b/mod.rs", "mod c;\n"),
        ("b/c.rs", "\n\n"),
    ]);
    let list = |list: &str| number("lines-of-modules", &format!("modules = [{list}]"));
    assert_eq!(measured(&folder, &list("\"a::b\"")).value, 3);
    let rules = format!("start = \"x\"\n{}", list("\"a::gone\""));
    let rules: Rules = toml::from_str(&rules).unwrap();
    let (workspace, imports) = read(&folder);
    let error = Program::new(&workspace, &imports)
        .measure(&rules.numbers[0], &rules)
        .err()
        .unwrap();
    assert_eq!(
        error.to_string(),
        "\"n\" counts module a::gone, but there is none; say in rules.toml where it went, or that it is gone"
    );
}

/// A misspelt key of the rules would leave a number without its limit.
#[test]
fn the_rules_of_the_project_are_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("rules.toml");
    let rules = Rules::read(&path).unwrap();
    assert!(rules.crates.iter().all(|rule| {
        let lower = |name: &String| {
            let place = |name: &str| rules.crates.iter().position(|rule| rule.name == name);
            place(name) < place(&rule.name)
        };
        rule.uses.iter().all(lower)
    }));
    let wrong = number("code-lines", "mots = 3");
    assert!(toml::from_str::<Rules>(&format!("start = \"x\"\n{wrong}")).is_err());
}
