//! How a column is shown: its unit for a reader, and the factor from SI.

use figure::{Axis, DataPoint};

/// A unit that axes show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisUnit {
    /// Its sign.
    pub sign: &'static str,
    /// What an SI value is multiplied with.
    pub factor: f64,
}

/// Micrometre.
pub const MICROMETRE: AxisUnit = AxisUnit {
    sign: "µm",
    factor: 1e6,
};
/// Millimetre.
pub const MILLIMETRE: AxisUnit = AxisUnit {
    sign: "mm",
    factor: 1e3,
};
/// Degree.
pub const DEGREE: AxisUnit = AxisUnit {
    sign: "deg",
    factor: 180.0 / std::f64::consts::PI,
};
/// Newton.
pub const NEWTON: AxisUnit = AxisUnit {
    sign: "N",
    factor: 1.0,
};
/// Megapascal.
pub const MEGAPASCAL: AxisUnit = AxisUnit {
    sign: "MPa",
    factor: 1e-6,
};
/// Gigapascal.
pub const GIGAPASCAL: AxisUnit = AxisUnit {
    sign: "GPa",
    factor: 1e-9,
};
/// Millisecond.
pub const MILLISECOND: AxisUnit = AxisUnit {
    sign: "ms",
    factor: 1e3,
};
/// Milliradian.
pub const MILLIRADIAN: AxisUnit = AxisUnit {
    sign: "mrad",
    factor: 1e3,
};
/// Millijoule.
pub const MILLIJOULE: AxisUnit = AxisUnit {
    sign: "mJ",
    factor: 1e3,
};

/// Millimetre per second.
pub const MILLIMETRE_PER_SECOND: AxisUnit = AxisUnit {
    sign: "mm/s",
    factor: 1e3,
};
/// Revolutions per minute.
pub const RPM: AxisUnit = AxisUnit {
    sign: "rpm",
    factor: 30.0 / std::f64::consts::PI,
};
/// Watt.
pub const WATT: AxisUnit = AxisUnit {
    sign: "W",
    factor: 1.0,
};
/// Megawatt per square metre: gigapascal times millimetre per second.
pub const MEGAWATT_PER_SQUARE_METRE: AxisUnit = AxisUnit {
    sign: "MW/m²",
    factor: 1e-6,
};
/// A number without unit.
pub const ONE: AxisUnit = AxisUnit {
    sign: "1",
    factor: 1.0,
};
/// Micrometre per metre.
pub const MICROSTRAIN: AxisUnit = AxisUnit {
    sign: "µm/m",
    factor: 1e6,
};
/// Newton metre.
pub const NEWTON_METRE: AxisUnit = AxisUnit {
    sign: "N m",
    factor: 1.0,
};

/// Endings of column names, longer ones before those that they end with, and the units that show them.
const ENDINGS: [(&str, AxisUnit); 15] = [
    ("_rad_per_s", RPM),
    (
        "_n_s_per_m",
        AxisUnit {
            sign: "N s/mm",
            factor: 1e-3,
        },
    ),
    (
        "_m_per_s2",
        AxisUnit {
            sign: "m/s²",
            factor: 1.0,
        },
    ),
    (
        "_m_per_s",
        AxisUnit {
            sign: "m/s",
            factor: 1.0,
        },
    ),
    (
        "_kg_per_m3",
        AxisUnit {
            sign: "kg/m³",
            factor: 1.0,
        },
    ),
    (
        "_per_k",
        AxisUnit {
            sign: "1/K",
            factor: 1.0,
        },
    ),
    (
        "_k",
        AxisUnit {
            sign: "K",
            factor: 1.0,
        },
    ),
    ("_n_m", NEWTON_METRE),
    ("_rad", DEGREE),
    ("_pa", MEGAPASCAL),
    (
        "_kg",
        AxisUnit {
            sign: "kg",
            factor: 1.0,
        },
    ),
    ("_n", NEWTON),
    ("_m", MICROMETRE),
    ("_s", MILLISECOND),
    ("_strain", MICROSTRAIN),
];

/// Name without its ending, and the unit; a number without unit has no ending.
pub fn split(column: &str) -> (&str, AxisUnit) {
    ENDINGS
        .iter()
        .find_map(|(ending, unit)| Some((column.strip_suffix(ending)?, *unit)))
        .unwrap_or((column, ONE))
}

impl AxisUnit {
    /// A linear axis of a quantity in this unit.
    pub fn axis(self, name: impl Into<String>) -> Axis {
        Axis::linear(name, self.sign)
    }

    /// Values in this unit.
    pub fn of(self, values: &[f64]) -> Vec<f64> {
        values.iter().map(|v| v * self.factor).collect()
    }
}

/// The azimuth of a whole turn.
pub fn azimuth_axis() -> Axis {
    DEGREE
        .axis("azimuth")
        .ticks_every(45.0)
        .tight()
        .including(0.0)
        .including(360.0)
}

/// Points from two columns of equal length.
pub fn points(x: &[f64], y: &[f64]) -> Vec<DataPoint> {
    x.iter().zip(y).map(|(&x, &y)| DataPoint::new(x, y)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: an axis would show a quantity in another unit than it says.
    #[test]
    fn the_ending_of_a_column_is_its_unit() {
        assert_eq!(split("inner_force_n").1.sign, "N");
        assert_eq!(
            split("p_moment_x_n_m"),
            (
                "p_moment_x",
                AxisUnit {
                    sign: "N m",
                    factor: 1.0
                }
            )
        );
        assert_eq!(split("speed.inner_rad_per_s").1.sign, "rpm");
        assert_eq!(split("time_s").1, MILLISECOND);
        assert_eq!(
            split("bearing.balls"),
            (
                "bearing.balls",
                AxisUnit {
                    sign: "1",
                    factor: 1.0
                }
            )
        );
        let spin = split("spin_rad_per_s").1.factor * std::f64::consts::TAU;
        assert!((spin - 60.0).abs() < 1e-12, "{spin}");
    }
}
