//! Slips that people make, and what they are told.

use super::*;

/// A line of the example (by its start), what a person types instead, and what the message must say.
const SLIPS: [(&str, &str, &str); 57] = [
    (
        "ball_diameter",
        "ball_diameter = \"9,525 mm\"",
        "numbers have a decimal point, 9.525; expected a length such as",
    ),
    (
        "ball_diameter",
        "ball_diameter = 9,525",
        "test.toml:6:18: this is not TOML: ",
    ),
    (
        "ball_diameter",
        "ball_diameter = 9,525",
        "; numbers have a decimal point: 9.525",
    ),
    (
        "ball_diameter",
        "ball_diameter = \"11/32 in\"",
        "a fraction is written as a decimal number, 0.34375",
    ),
    (
        "ball_diameter",
        "dball_diameter = \"9 mm\"",
        "did you mean \"ball_diameter\"? valid keys are",
    ),
    (
        "value = \"1",
        "value = \"1 000 N\"",
        "digits stand together, 1000; expected a force such as \"2 kN\"",
    ),
    ("width", "width = 16 mm", "test.toml:14:9: this is not TOML: "),
    (
        "width",
        "width = 16 mm",
        "; quantities stand in quotes: width = \"16 mm\"",
    ),
    (
        "width",
        "width = \"16\"",
        "test.toml:14:9: bearing.width: \"16\" has no unit; expected a length such as",
    ),
    (
        "width",
        "width = 16",
        "16 is a number without a unit; expected a length such as \"9 mm\", in quotes",
    ),
    ("width", "width = \"16 mm", "; the quote at the end is missing"),
    ("width", "width = \"16 mm\";", "; a line ends without a sign"),
    (
        "width",
        "breadth = \"16 mm\"",
        "14:1: unknown key \"breadth\" in [bearing]; did you mean \"width\"?",
    ),
    (
        "y = \"3",
        "y = \"3 Nm\"",
        "has the unknown unit \"Nm\" (did you mean \"N m\"?)",
    ),
    (
        "value = \"1",
        "value = \"1 KN\"",
        "has the unknown unit \"KN\" (did you mean \"kN\"?)",
    ),
    (
        "value = \"1",
        "value = \"100 kg\"",
        "\"100 kg\" is a mass, forces have N, kgf or lbf; expected a force such as \"2 kN\"",
    ),
    (
        "value = \"1",
        "force = \"1 kN\"",
        "unknown key \"force\" in [effects.radial_force]; did you mean \"value\"?",
    ),
    (
        "direction = \"0",
        "direction = \"90 degrees\"",
        "unknown unit \"degrees\" (did you mean \"deg\"?)",
    ),
    (
        "x =",
        "x = \"12 micron\"",
        "unknown unit \"micron\" (did you mean \"um\"?); expected \"free\", \"locked\" or",
    ),
    (
        "young",
        "young_modulus = \"207000 MPA\"",
        "unknown unit \"MPA\" (did you mean \"MPa\"?)",
    ),
    (
        "young",
        "E = \"207 GPa\"",
        "unknown key \"E\" in [materials.rings]; did you mean \"young_modulus\"?",
    ),
    (
        "poisson",
        "poisson_ratio = \"0.3\"",
        "poisson_ratio: invalid type: string \"0.3\", expected a number",
    ),
    (
        "density",
        "density = \"7.8\"",
        "\"7.8\" has no unit; expected a density such as \"7800 kg/m3\"",
    ),
    ("z =", "z = free", "; words stand in quotes: z = \"free\""),
    (
        "z =",
        "z = \"fixed\"",
        "\"fixed\" is no state of a shaft motion; expected \"free\", \"locked\" or a length",
    ),
    (
        "tilt_x",
        "tilt_x = \"1 mm\"",
        "\"1 mm\" is a length; expected \"free\", \"locked\" or an angle",
    ),
    ("flexible", "flexible = True", "; write true"),
    (
        "flexible",
        "flexible = \"yes\"",
        "inner.flexible: invalid type: string \"yes\", expected true or false",
    ),
    (
        "support",
        "support = \"fixed\"",
        "inner.support is \"fixed\"; did you mean \"clamped\"?",
    ),
    (
        "mesh_unit",
        "mesh_unit = \"millimeter\"",
        "unknown unit \"millimeter\" (did you mean \"mm\"?)",
    ),
    (
        "element",
        "element = \"HEX8\"",
        "inner.section.element is \"HEX8\"; did you mean \"hex8\"?",
    ),
    (
        "sectors",
        "sectors = 100",
        "it must be a multiple of the 18 balls, such as 90 or 108",
    ),
    ("balls", "balls: 18", "; write balls = 18 instead of a colon"),
    ("balls", "balls = 18 // balls", "; comments begin with #"),
    (
        "balls",
        "Z = 18",
        "5:1: unknown key \"Z\" in [bearing]; did you mean \"balls\"?",
    ),
    (
        "balls",
        "number_of_balls = 18",
        "unknown key \"number_of_balls\" in [bearing]; did you mean \"balls\"?",
    ),
    (
        "bore_diameter",
        "d = \"50 mm\"",
        "unknown key \"d\" in [bearing]; did you mean \"bore_diameter\"?",
    ),
    (
        "first_ball",
        "clearance = \"10 um\"",
        "unknown key \"clearance\" in [bearing]; did you mean \"radial_clearance\"?",
    ),
    (
        "first_ball",
        "mesh = \"a.msh\"",
        "unknown key \"mesh\" in [bearing]; mesh belongs to [inner], [outer], [body]; valid",
    ),
    (
        "[materials.balls]",
        "[materials.rings]",
        "duplicate key; it stands in line 17 too",
    ),
    (
        "[effects.axial_force]",
        "[axial_force]",
        "unknown key \"axial_force\"; write [effects.axial_force]; valid keys are",
    ),
    (
        "title",
        "title = \u{201c}x\u{201d}",
        "; the quotes are those of a text program; write \"\"",
    ),
    (
        "title",
        "include \"types/7010c.toml\"",
        "2:9: this is not TOML: key with no value, expected `=`; a key and its value have = between: include = \"types",
    ),
    (
        "title",
        "import = \"types/7010c.toml\"",
        "2:1: unknown key \"import\"; did you mean \"include\"?",
    ),
    (
        "ball_diameter",
        "ball diameter = \"9 mm\"",
        "6:6: this is not TOML: key with no value, expected `=`; a key is one word: ball_diameter",
    ),
    (
        "ball_diameter",
        "ball_diameter = \"-9 mm\"",
        "bearing.ball_diameter is -9 mm; a diameter must be positive (line 6)",
    ),
    (
        "width",
        "width = \"0.63 inch\"",
        "unknown unit \"inch\" (did you mean \"in\"?); expected a length",
    ),
    (
        "first_ball",
        "contact_angle = \"40\"",
        "bearing.contact_angle: \"40\" has no unit; expected an angle such as \"15 deg\"",
    ),
    (
        "balls",
        "balls = 18.0",
        "bearing.balls: invalid type: floating point `18.0`, expected a whole number",
    ),
    (
        "mode",
        "mode = patch",
        "; words stand in quotes: mode = \"patch\"",
    ),
    (
        "value = \"1",
        "value = \"1,5 kN\"",
        "numbers have a decimal point, 1.5; expected a force such as \"2 kN\"",
    ),
    (
        "[contact]",
        "[Contact]",
        "unknown key \"Contact\"; did you mean \"contact\"?",
    ),
    (
        "value = \"1",
        "value = \"150 lb\"",
        "\"150 lb\" is a mass, forces have N, kgf or lbf; expected a force such as \"2 kN\"",
    ),
    (
        "value = \"1",
        "load = \"1 kN\"",
        "unknown key \"load\" in [effects.radial_force]; did you mean \"value\"?",
    ),
    (
        "[effects.radial_force]",
        "[effects.radial_load]",
        "unknown key \"radial_load\" in [effects]; did you mean \"radial_force\"? valid keys are",
    ),
    (
        "[effects.axial_force]",
        "[effects.thrust]",
        "unknown key \"thrust\" in [effects]; did you mean \"axial_force\"? valid keys are",
    ),
    (
        "bore_diameter",
        "bore_diameter = '1.5\"'",
        "\"1.5\\\"\" cannot be read: inches are written in letters, 1.5 in; expected a length",
    ),
];

/// Wrong: a person who makes one of these slips would not be told what to type.
#[test]
fn natural_slips_are_answered_with_what_to_type() {
    for (line, typed, part) in SLIPS {
        let message = message_of(&with_line(line, typed), &[]);
        assert!(message.contains(part), "{typed}: expected\n{part}\nin\n{message}");
        assert!(
            !message.contains("problems"),
            "{typed}: one slip is no list\n{message}"
        );
    }
}

/// Wrong: a person would mend one key after the other, each with a run of the program.
#[test]
fn all_that_is_missing_or_unknown_is_said_at_once() {
    let text = without_table("[shaft]");
    let text = text
        .replace("ball_diameter = \"9 mm\"", "")
        .replace("width = \"16 mm\"", "colour = \"red\"");
    let text = text
        .replacen("\"207 GPa\"", "\"207 GN\"", 1)
        .replace("\"patch\"", "\"patsch\"");
    let text = text
        .replace("balls = 18 ", "balls = \"18\" ")
        .replace("grading = 1.2", "grading = \"1.2\"");
    let text = text.replacen("poisson_ratio = 0.3", "", 1);
    let message = message_of(&text, &[]);
    let expected = [
        "scenes/test.toml has 9 problems:",
        "  the table [shaft] is missing",
        "  [bearing] has no key \"ball_diameter\", which is required (line 4)",
        "  [bearing] has no key \"width\", which is required (line 4)",
        "  bearing.balls: invalid type: string \"18\", expected a whole number (line 5)",
        "  unknown key \"colour\" in [bearing]; valid keys are \"balls\", \"ball_diameter\", ",
        "  [materials.rings] has no key \"poisson_ratio\", which is required (line 17)",
        "  materials.rings.young_modulus: \"207 GN\" is a force; expected a stress such as \"207 GPa\" (line 18)",
        "  contact.mode is \"patsch\"; did you mean \"patch\"? valid values are \"patch\", \
         \"facet\", \"rigid\" (line 30)",
        "  inner.section.grading: invalid type: string \"1.2\", expected a number (line 65)",
    ];
    let lines: Vec<&str> = message.lines().collect();
    assert_eq!(lines.len(), expected.len(), "{message}");
    for (line, expected) in lines.iter().zip(expected) {
        assert!(line.starts_with(expected), "expected\n{expected}\nin\n{message}");
    }
}

/// Wrong: a person would put in what was missing, and be told of the next thing only then.
#[test]
fn what_a_ring_and_a_scene_lack_is_said_at_once_too() {
    let message = message_of("", &[]);
    let expected = "scenes/test.toml has 5 problems:
  the table [bearing] is missing; \"raceway init\" writes a scene to start from
  the table [materials] is missing
  the table [contact] is missing
  the table [shaft] is missing
  the scene has no analysis; add one of the tables [static], [sweep], [quasi_static], [dynamic] and [modes]";
    assert_eq!(message, expected);
    let text = without_table("[sweep]") + "\n[static]\n[modes]\n";
    let message = message_of(&text, &[]);
    for part in [
        "[modes] has no key \"number\", which is required (line ",
        "  the scene has both [static] and [modes]; keep exactly one analysis",
    ] {
        assert!(message.contains(part), "{message}");
    }
    // A table that may be meant for the analysis is a slip of its own.
    let message = message_of(&(without_table("[sweep]") + "\n[statik]\n"), &[]);
    assert!(
        message.contains("unknown key \"statik\"; did you mean \"static\"?"),
        "{message}"
    );
    assert!(!message.contains("no analysis"), "{message}");
    let (head, tail) = EXAMPLE.split_once("mesh = ").unwrap();
    let (_, tail) = tail.split_once("[inner.section]").unwrap();
    let message = message_of(&format!("{head}\n[inner.section]{tail}"), &[]);
    let line = head.lines().position(|line| line.starts_with("[inner]")).unwrap() + 1;
    for part in [
        "inner.mesh is missing; a flexible ring needs a mesh file, or set inner.flexible = false",
        "inner.mesh_unit is missing; a flexible ring needs the unit of its mesh such as \"mm\", or set \
         inner.flexible = false",
        "inner.support is missing; a flexible ring needs to know how its bore is held, \"clamped\" or \
         \"mean_motion\", or \"body\" with a table [[body]], or set inner.flexible = false",
    ] {
        assert!(
            message.contains(&format!("  {part} (line {line})")),
            "{part}\n{message}"
        );
    }
}

/// Wrong: one wrong number of the bearing would be followed by shoulders of 0 m and by what is computed from it.
#[test]
fn a_wrong_bearing_is_one_problem() {
    let cases = [
        (
            "inner_curvature_ratio = 0.48",
            "bearing.inner_curvature_ratio is 0.48; expected more than 0.5 and at most 0.6; 0.515 to 0.53 is usual",
        ),
        (
            "inner_groove_radius = \"4.4 mm\"",
            "bearing.inner_groove_radius is 4.4 mm; it must be more than",
        ),
    ];
    for (typed, part) in cases {
        let message = message_of(&with_line("inner_groove_radius", typed), &[]);
        assert!(
            message.contains(part) && message.contains(" has a problem: "),
            "{message}"
        );
    }
}

/// Wrong: a table in the place of the title would be blamed for the tables that the scene lacks.
#[test]
fn tables_that_a_scene_lacks_are_not_keys_of_its_first_table() {
    let message = message_of("[title]\ntext = \"x\"\n", &[]);
    for part in [
        "title: invalid type: map, expected a string (line 1)",
        "the table [bearing] is missing; \"raceway init\" writes a scene to start from\n",
        "the table [shaft] is missing",
    ] {
        assert!(message.contains(part), "{message}");
    }
    assert!(!message.contains("[title] has no key"), "{message}");
}

/// Wrong: a text that is not a scene at all would keep the program busy, or end it without a word.
#[test]
fn a_text_with_many_errors_ends() {
    let many: String = (0..1000).map(|i| format!("key_{i} = {i}\n")).collect();
    let message = message_of(&many, &[]);
    assert!(message.contains("unknown key \"key_0\""), "{message}");
}
