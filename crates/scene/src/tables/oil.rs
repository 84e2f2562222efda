//! Oils as tables of a scene have them: viscosity, or a class of ISO 3448 with a temperature.

use contact::film::walther;
use input::{Problems, Quantity, Temperature, VISCOSITY};

/// What is known of the lubricant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Oil {
    /// Viscosity ratio kappa, dimensionless.
    Ratio(f64),
    /// Kinematic viscosity at the temperature of the contacts, m2/s.
    Viscosity(f64),
    /// A class of ISO 3448 at a temperature.
    Class {
        /// Kinematic viscosity at 40 degC, m2/s.
        at_40: f64,
        /// At 100 degC, m2/s; None at 40 degC, where it is not needed.
        at_100: Option<f64>,
        /// Temperature of the contacts, K.
        temperature: f64,
    },
}

impl Oil {
    /// Kinematic viscosity at the temperature of the contacts, m2/s; None where only the ratio is known.
    pub fn viscosity(&self) -> Option<f64> {
        match *self {
            Oil::Ratio(_) => None,
            Oil::Viscosity(viscosity) => Some(viscosity),
            Oil::Class {
                at_40,
                at_100,
                temperature,
            } => Some(at_100.map_or(at_40, |at_100| walther(at_40, at_100, temperature))),
        }
    }
}

/// Viscosity classes of ISO 3448:1992 and their mid-point viscosities at 40 degC, mm2/s.
const CLASSES: [[f64; 2]; 20] = [
    [2.0, 2.2],
    [3.0, 3.2],
    [5.0, 4.6],
    [7.0, 6.8],
    [10.0, 10.0],
    [15.0, 15.0],
    [22.0, 22.0],
    [32.0, 32.0],
    [46.0, 46.0],
    [68.0, 68.0],
    [100.0, 100.0],
    [150.0, 150.0],
    [220.0, 220.0],
    [320.0, 320.0],
    [460.0, 460.0],
    [680.0, 680.0],
    [1000.0, 1000.0],
    [1500.0, 1500.0],
    [2200.0, 2200.0],
    [3200.0, 3200.0],
];

/// Oils are liquid and bearing steel keeps its hardness between these, degC.
const PLAUSIBLE_CELSIUS: std::ops::RangeInclusive<f64> = -60.0..=300.0;
/// Below 2 mm2/s the equation of Walther needs further terms (ASTM D341), m2/s.
const MIN_WALTHER: f64 = 2e-6;
/// The keys of a class in some table.
pub(super) struct ClassKeys<'a> {
    /// Name of the table.
    pub table: &'static str,
    /// `viscosity_class`.
    pub class: Option<f64>,
    /// `viscosity_at_100`.
    pub at_100: Option<&'a Quantity<VISCOSITY>>,
    /// Key of the temperature: `temperature`, or what stands for it.
    pub temperature_key: &'static str,
    /// Its value.
    pub temperature: Option<&'a Temperature>,
}

impl ClassKeys<'_> {
    /// Reports keys that do nothing without a class.
    pub fn check_idle(&self, problems: &mut Problems) {
        let table = self.table;
        for (key, is_given) in [
            (self.temperature_key, self.temperature.is_some()),
            ("viscosity_at_100", self.at_100.is_some()),
        ] {
            if is_given && self.class.is_none() {
                problems.add(format!(
                    "{table}.{key} does nothing without {table}.viscosity_class; add the class, or remove it"
                ));
            }
        }
    }

    /// An oil by its class and temperature.
    pub fn oil(&self, class: f64, problems: &mut Problems) -> Option<Oil> {
        let (table, key) = (self.table, self.temperature_key);
        let Some([_, at_40]) = CLASSES.iter().find(|[name, _]| *name == class) else {
            let names: Vec<String> = CLASSES.iter().map(|[name, _]| name.to_string()).collect();
            problems.require(
                false,
                &format!("{table}.viscosity_class"),
                class,
                format!("expected a class of ISO 3448: {}", names.join(", ")),
            );
            return None;
        };
        let at_40 = at_40 * 1e-6;
        let Some(temperature) = self.temperature else {
            problems.add(format!(
                "{table}.viscosity_class is {class}, the viscosity at 40 degC; add {table}.{key} of the oil in \
                 the contacts, or give {table}.viscosity at that temperature"
            ));
            return None;
        };
        problems.require(
            PLAUSIBLE_CELSIUS.contains(&temperature.celsius()),
            &format!("{table}.{key}"),
            temperature,
            "expected -60 degC to 300 degC of an oil by its class",
        );
        if let Some(at_100) = self.at_100 {
            problems.require(
                (MIN_WALTHER..at_40).contains(&at_100.si()),
                &format!("{table}.viscosity_at_100"),
                at_100,
                format!(
                    "expected 2 mm2/s to less than the {} mm2/s at 40 degC",
                    1e6 * at_40
                ),
            );
        } else if (temperature.celsius() - 40.0).abs() > 1e-9 {
            problems.add(format!(
                "{table}.{key} is {temperature}; how an oil thins from 40 degC takes a second viscosity: add \
                 {table}.viscosity_at_100 from its data sheet, or give {table}.viscosity at that temperature"
            ));
            return None;
        }
        Some(Oil::Class {
            at_40,
            at_100: self.at_100.map(Quantity::si),
            temperature: temperature.kelvin(),
        })
    }
}
