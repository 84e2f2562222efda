//! `[materials.rings]` and `[materials.balls]`: linear elastic, isotropic, by numbers or by name.
//!
//! ```toml
#![doc = include_str!("example_materials.toml")]
//! ```
//!
//! | name | Young's modulus | Poisson's ratio | density | expansion | source |
//! |---|---|---|---|---|---|
//! | bearing steel, 100Cr6, 52100, GCr15, SUJ2 | 207 GPa | 0.3 | 7800 kg/m3 | 12e-6 /K | Harris, 4th ed.; SKF |
//! | silicon nitride, Si3N4 | 310 GPa | 0.26 | 3200 kg/m3 | 3e-6 /K | SKF, Super-precision bearings; ratio of Harris |
//! | M50 | 214 GPa | 0.3 | 7870 kg/m3 | - | data sheet AISI M50 VIM-VAR of BTI Metals; ratio of steel |
//! | 440C | 200 GPa | 0.28 | 7700 kg/m3 | 10e-6 /K | makeitfrom.com, AISI 440C |
//!
//! A yield strength is never that of a name. At room temperature. Harris: Rolling Bearing Analysis. Sheets of one grade
//! differ by some per cent; forces in a bearing follow E* to the power 1/2 at most. Numbers of the maker are better
//! than a name.

use std::fmt;

use input::{DENSITY, Expansion, Problems, Quantity, STRESS};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Visitor};

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the tables [materials.rings] and [materials.balls]"
)]
pub struct RawMaterials {
    rings: RawMaterial,
    balls: RawMaterial,
}

/// As typed: a name, or a table of numbers.
#[derive(Debug)]
pub enum RawMaterial {
    /// By its name.
    Named(&'static NamedMaterial),
    /// By its numbers.
    Numbers(RawNumbers),
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table with young_modulus, poisson_ratio, density"
)]
pub struct RawNumbers {
    young_modulus: Quantity<STRESS>,
    poisson_ratio: f64,
    density: Quantity<DENSITY>,
    expansion: Option<Expansion>,
    yield_strength: Option<Quantity<STRESS>>,
}

/// What the bodies are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Materials {
    /// Both rings.
    pub rings: MaterialProperties,
    /// All balls.
    pub balls: MaterialProperties,
}

/// A linear elastic, isotropic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialProperties {
    /// Young's modulus E, Pa.
    pub young_modulus: f64,
    /// Poisson's ratio nu, dimensionless, 0 to 0.49.
    pub poisson_ratio: f64,
    /// Density rho, kg/m3.
    pub density: f64,
    /// Thermal expansion alpha, 1/K; None: not given.
    pub expansion: Option<f64>,
    /// Yield strength, Pa; None: not given, and nothing is compared with it.
    pub yield_strength: Option<f64>,
}

impl Materials {
    /// Whether the thermal expansion of rings and balls is given.
    pub fn has_expansion(&self) -> [bool; 2] {
        [self.rings, self.balls].map(|material| material.expansion.is_some())
    }
}

/// A material that a scene may name.
#[derive(Debug)]
pub struct NamedMaterial {
    /// The first is that of messages.
    names: &'static [&'static str],
    material: MaterialProperties,
    source: &'static str,
}

/// All of them; the table of the module has the sources.
static NAMED: [NamedMaterial; 4] = [
    NamedMaterial {
        names: &["bearing steel", "100Cr6", "52100", "GCr15", "SUJ2"],
        material: MaterialProperties {
            young_modulus: 207e9,
            poisson_ratio: 0.3,
            density: 7800.0,
            expansion: Some(12e-6),
            yield_strength: None,
        },
        source: "Harris, Rolling Bearing Analysis",
    },
    NamedMaterial {
        names: &["silicon nitride", "Si3N4"],
        material: MaterialProperties {
            young_modulus: 310e9,
            poisson_ratio: 0.26,
            density: 3200.0,
            expansion: Some(3e-6),
            yield_strength: None,
        },
        source: "SKF, Super-precision bearings; Harris",
    },
    NamedMaterial {
        names: &["M50"],
        material: MaterialProperties {
            young_modulus: 214e9,
            poisson_ratio: 0.3,
            density: 7870.0,
            expansion: None,
            yield_strength: None,
        },
        source: "data sheet of AISI M50 VIM-VAR, BTI Metals",
    },
    NamedMaterial {
        names: &["440C"],
        material: MaterialProperties {
            young_modulus: 200e9,
            poisson_ratio: 0.28,
            density: 7700.0,
            expansion: Some(10e-6),
            yield_strength: None,
        },
        source: "makeitfrom.com, AISI 440C",
    },
];

/// Softer or stiffer than any solid: a slip of the unit, Pa.
const PLAUSIBLE_MODULUS: std::ops::RangeInclusive<f64> = 1e3..=1e13;
/// Lighter or heavier than any solid: a slip of the unit, kg/m3.
const PLAUSIBLE_DENSITY: std::ops::RangeInclusive<f64> = 1.0..=1e5;
/// Displacement elements lock when the material is nearly incompressible.
const MAX_POISSON_RATIO: f64 = 0.49;

impl RawMaterials {
    /// Checks both materials; `None` when there are problems.
    /// `assumed` is told the numbers of names.
    pub fn check(&self, problems: &mut Problems, assumed: &mut Vec<String>) -> Option<Materials> {
        let before = problems.len();
        let rings = self.rings.check("materials.rings", problems, assumed);
        let balls = self.balls.check("materials.balls", problems, assumed);
        (problems.len() == before).then_some(Materials { rings, balls })
    }
}

impl RawMaterial {
    /// Checks the material of a table; `assumed` is told the numbers of names.
    pub fn check(
        &self,
        table: &str,
        problems: &mut Problems,
        assumed: &mut Vec<String>,
    ) -> MaterialProperties {
        let named = match self {
            RawMaterial::Named(named) => named,
            RawMaterial::Numbers(numbers) => return numbers.check(table, problems),
        };
        let m = named.material;
        let expansion = m
            .expansion
            .map_or(String::new(), |alpha| format!(", expansion {alpha:e} /K"));
        assumed.push(format!(
            "{table} is {}: Young's modulus {} GPa, Poisson's ratio {}, density {} kg/m3{expansion} ({})",
            named.names[0],
            1e-9 * m.young_modulus,
            m.poisson_ratio,
            m.density,
            named.source
        ));
        m
    }

    fn expected() -> String {
        let names: Vec<String> = NAMED
            .iter()
            .map(|named| format!("{:?}", named.names[0]))
            .collect();
        format!(
            "{}, or a table with young_modulus, poisson_ratio and density",
            names.join(", ")
        )
    }
}

impl<'de> Deserialize<'de> for RawMaterial {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct MaterialVisitor;

        impl<'de> Visitor<'de> for MaterialVisitor {
            type Value = RawMaterial;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(&RawMaterial::expected())
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
                let is_meant =
                    |named: &&NamedMaterial| named.names.iter().any(|name| name.eq_ignore_ascii_case(text));
                let named = NAMED.iter().find(is_meant);
                named.map(RawMaterial::Named).ok_or_else(|| {
                    let meant = meant(text).map_or(String::new(), |name| format!("did you mean {name:?}? "));
                    E::custom(format!(
                        "{text:?} is no material with a name here; {meant}expected {}",
                        RawMaterial::expected()
                    ))
                })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                RawNumbers::deserialize(MapAccessDeserializer::new(map)).map(RawMaterial::Numbers)
            }
        }

        deserializer.deserialize_any(MaterialVisitor)
    }
}

/// The named material that other words for it mean.
fn meant(text: &str) -> Option<&'static str> {
    const WORDS: [(&str, &str); 6] = [
        ("440", "440C"),
        ("m50", "M50"),
        ("52100", "bearing steel"),
        ("steel", "bearing steel"),
        ("ceramic", "silicon nitride"),
        ("nitride", "silicon nitride"),
    ];
    let text = text.to_lowercase();
    let found = WORDS.iter().find(|(word, _)| text.contains(word));
    found.map(|(_, name)| *name)
}

impl RawNumbers {
    fn check(&self, table: &str, problems: &mut Problems) -> MaterialProperties {
        let (modulus, nu, density) = (self.young_modulus.si(), self.poisson_ratio, self.density.si());
        let key = format!("{table}.young_modulus");
        problems.require(
            PLAUSIBLE_MODULUS.contains(&modulus),
            &key,
            &self.young_modulus,
            "expected 1 kPa to 10 TPa",
        );
        let key = format!("{table}.poisson_ratio");
        if nu > MAX_POISSON_RATIO && nu < 0.5 {
            problems.require(
                false,
                &key,
                nu,
                "displacement elements lock above 0.49, such a material needs a mixed formulation",
            );
        } else {
            problems.require(
                (0.0..0.5).contains(&nu),
                &key,
                nu,
                "expected 0 to 0.49, steel has 0.3",
            );
        }
        let key = format!("{table}.density");
        problems.require(
            PLAUSIBLE_DENSITY.contains(&density),
            &key,
            &self.density,
            "expected 1 kg/m3 to 1e5 kg/m3, steel has 7800 kg/m3",
        );
        if let Some(expansion) = &self.expansion {
            expansion.check(&format!("{table}.expansion"), problems);
        }
        if let Some(strength) = &self.yield_strength {
            problems.require_positive(strength, &format!("{table}.yield_strength"), "a strength");
        }
        MaterialProperties {
            young_modulus: modulus,
            poisson_ratio: nu,
            density,
            expansion: self.expansion.as_ref().map(Expansion::per_kelvin),
            yield_strength: self.yield_strength.as_ref().map(Quantity::si),
        }
    }
}
