//! The kinds of quantity a scene can hold: names, dimensions, SI units, examples.

use super::unit::Dimension;

/// Exponents closer than this are equal: powers such as 10/9 are rounded, real ones differ by far more.
const EXPONENT_TOLERANCE: f64 = 1e-9;

/// Facts about one kind of quantity.
#[derive(Debug)]
pub struct Kind {
    /// With its article: `a length`.
    pub name: &'static str,
    /// Exponents of kg, m, s, rad.
    pub dimension: Dimension,
    /// SI unit as a scene would write it: `m`.
    pub si_unit: &'static str,
    /// As in a scene: `9 mm`.
    pub example: &'static str,
    /// Ending of a column's name in a table: `_m`.
    pub column_suffix: &'static str,
}

/// Index of lengths, SI unit m.
pub const LENGTH: usize = 0;
/// Index of angles, rad.
pub const ANGLE: usize = 1;
/// Index of forces, N.
pub const FORCE: usize = 2;
/// Index of moments, N m (energies have the same dimension).
pub const MOMENT: usize = 3;
/// Index of stresses, pressures and elastic moduli, Pa.
pub const STRESS: usize = 4;
/// Index of densities, kg/m3.
pub const DENSITY: usize = 5;
/// Index of accelerations, m/s2.
pub const ACCELERATION: usize = 6;
/// Index of Hertzian point-contact stiffnesses, N/m^1.5.
pub const HERTZ_STIFFNESS: usize = 7;
/// Index of times, s.
pub const TIME: usize = 8;
/// Index of angular speeds, rad/s.
pub const ANGULAR_SPEED: usize = 9;
/// Index of rates, 1/s (frequencies in Hz have the same dimension).
pub const RATE: usize = 10;
/// Index of viscous damping coefficients, N s/m.
pub const DAMPING: usize = 11;
/// Index of masses, kg.
pub const MASS: usize = 12;
/// Index of stiffnesses, N/m.
pub const STIFFNESS: usize = 13;
/// Index of speeds, m/s.
pub const SPEED: usize = 14;
/// Index of moments of inertia, kg m2.
pub const INERTIA: usize = 15;
/// Index of kinematic viscosities, m2/s.
pub const VISCOSITY: usize = 16;

/// Index of dynamic viscosities, Pa s.
pub const DYNAMIC_VISCOSITY: usize = 17;
/// Index of coefficients of growth with pressure, 1/Pa.
pub const PRESSURE_COEFFICIENT: usize = 18;

/// All kinds: those a scene uses first, at the index of their constant, then those only named in messages.
pub static KINDS: [Kind; 21] = [
    kind("a length", [0.0, 1.0, 0.0, 0.0], "m", "9 mm", "_m"),
    kind("an angle", [0.0, 0.0, 0.0, 1.0], "rad", "15 deg", "_rad"),
    kind("a force", [1.0, 1.0, -2.0, 0.0], "N", "2 kN", "_n"),
    kind("a moment", [1.0, 2.0, -2.0, 0.0], "N m", "3 N m", "_n_m"),
    kind("a stress", [1.0, -1.0, -2.0, 0.0], "Pa", "207 GPa", "_pa"),
    kind(
        "a density",
        [1.0, -3.0, 0.0, 0.0],
        "kg/m3",
        "7800 kg/m3",
        "_kg_per_m3",
    ),
    kind(
        "an acceleration",
        [0.0, 1.0, -2.0, 0.0],
        "m/s2",
        "9.81 m/s2",
        "_m_per_s2",
    ),
    kind(
        "a Hertz stiffness",
        [1.0, -0.5, -2.0, 0.0],
        "N/m^1.5",
        "9.31e5 N/mm^1.5",
        "_n_per_m1_5",
    ),
    kind("a time", [0.0, 0.0, 1.0, 0.0], "s", "10 us", "_s"),
    kind(
        "an angular speed",
        [0.0, 0.0, -1.0, 1.0],
        "rad/s",
        "1800 rpm",
        "_rad_per_s",
    ),
    kind("a rate", [0.0, 0.0, -1.0, 0.0], "1/s", "10 1/s", "_per_s"),
    kind(
        "a damping",
        [1.0, 0.0, -1.0, 0.0],
        "N s/m",
        "5e-2 N s/mm",
        "_n_s_per_m",
    ),
    kind("a mass", [1.0, 0.0, 0.0, 0.0], "kg", "0.25 kg", "_kg"),
    kind(
        "a stiffness",
        [1.0, 0.0, -2.0, 0.0],
        "N/m",
        "100 N/um",
        "_n_per_m",
    ),
    kind("a speed", [0.0, 1.0, -1.0, 0.0], "m/s", "3 m/s", "_m_per_s"),
    kind(
        "a moment of inertia",
        [1.0, 2.0, 0.0, 0.0],
        "kg m2",
        "2e-4 kg m2",
        "_kg_m2",
    ),
    kind(
        "a kinematic viscosity",
        [0.0, 2.0, -1.0, 0.0],
        "m2/s",
        "12 mm2/s",
        "_m2_per_s",
    ),
    kind(
        "a dynamic viscosity",
        [1.0, -1.0, -1.0, 0.0],
        "Pa s",
        "40 mPa s",
        "_pa_s",
    ),
    kind(
        "a pressure coefficient",
        [-1.0, 1.0, 2.0, 0.0],
        "1/Pa",
        "22 1/GPa",
        "_per_pa",
    ),
    kind("a power", [1.0, 2.0, -3.0, 0.0], "W", "5 W", "_w"),
    kind("a pure number", [0.0, 0.0, 0.0, 0.0], "", "2", ""),
];

const fn kind(
    name: &'static str,
    dimension: Dimension,
    si_unit: &'static str,
    example: &'static str,
    column_suffix: &'static str,
) -> Kind {
    Kind {
        name,
        dimension,
        si_unit,
        example,
        column_suffix,
    }
}

/// Prefixes for display, powers of ten.
const DISPLAY_PREFIXES: [(&str, i32); 7] = [
    ("G", 9),
    ("M", 6),
    ("k", 3),
    ("", 0),
    ("m", -3),
    ("u", -6),
    ("n", -9),
];

impl Kind {
    /// What a message says is expected: `a length such as "9 mm"`.
    pub fn expected(&self) -> String {
        format!("{} such as \"{}\"", self.name, self.example)
    }

    /// The name without its article: `length`.
    pub fn noun(&self) -> &'static str {
        self.name.split_once(' ').map_or(self.name, |(_, noun)| noun)
    }

    /// The unit of the example: `mm`.
    pub fn example_unit(&self) -> &'static str {
        self.example.split_once(' ').map_or("", |(_, unit)| unit)
    }

    /// Writes an SI value so that reading it back gives the same double, with a prefix when the unit takes
    /// one.
    pub fn format_si(&self, si: f64) -> String {
        if si == 0.0 {
            return format!("0 {}", self.si_unit);
        }
        let scientific = format!("{si:e}");
        let one_symbol = matches!(self.si_unit, "m" | "rad" | "N" | "Pa" | "s" | "W");
        let Some((digits, exponent)) = scientific.split_once('e') else {
            return format!("{si} {}", self.si_unit);
        };
        let exponent: i32 = exponent.parse().unwrap_or(0);
        let prefix = DISPLAY_PREFIXES
            .iter()
            .find(|(_, p)| (*p..*p + 3).contains(&exponent));
        match prefix {
            Some((symbol, power)) if one_symbol => {
                format!(
                    "{} {symbol}{}",
                    shift_point(digits, exponent - power),
                    self.si_unit
                )
            }
            _ => format!("{si:?} {}", self.si_unit),
        }
    }
}

/// Moves the decimal point of `d.ddd` by `places` (0, 1 or 2) to the right.
fn shift_point(digits: &str, places: i32) -> String {
    let (sign, digits) = digits.strip_prefix('-').map_or(("", digits), |d| ("-", d));
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let places = usize::try_from(places).unwrap_or(0);
    let fraction = format!("{fraction:0<places$}");
    let (moved, rest) = fraction.split_at(places);
    let point = if rest.is_empty() { "" } else { "." };
    format!("{sign}{whole}{moved}{point}{rest}")
}

/// Whether all exponents agree.
pub fn same_dimension(a: Dimension, b: Dimension) -> bool {
    a.iter().zip(b).all(|(x, y)| (x - y).abs() < EXPONENT_TOLERANCE)
}

/// The kind with this dimension, when it has a name.
pub fn kind_of_dimension(dimension: Dimension) -> Option<&'static Kind> {
    KINDS.iter().find(|k| same_dimension(k.dimension, dimension))
}

/// What `found` is where `wanted` was: its name, and for revolutions typed in Hz why that is not enough.
pub fn describe_instead_of(found: Dimension, wanted: &Kind) -> String {
    let name = describe(found);
    let is_rate_of_turning = same_dimension(found, KINDS[RATE].dimension)
        && same_dimension(wanted.dimension, KINDS[ANGULAR_SPEED].dimension);
    let is_weight = same_dimension(found, KINDS[MASS].dimension)
        && same_dimension(wanted.dimension, KINDS[FORCE].dimension);
    if is_weight {
        format!("{name}, forces have N, kgf or lbf")
    } else if is_rate_of_turning {
        format!("{name}, which does not say whether it counts revolutions or radians")
    } else {
        name
    }
}

/// `a force`, or the base units of a dimension without a name.
fn describe(dimension: Dimension) -> String {
    if let Some(kind) = kind_of_dimension(dimension) {
        return kind.name.to_string();
    }
    let factors = ["kg", "m", "s", "rad"].iter().zip(dimension);
    let units: Vec<String> = factors
        .filter(|(_, power)| power.abs() > EXPONENT_TOLERANCE)
        .map(|(unit, power)| {
            if power == 1.0 {
                unit.to_string()
            } else {
                format!("{unit}^{power}")
            }
        })
        .collect();
    format!("a quantity in {}", units.join(" "))
}
