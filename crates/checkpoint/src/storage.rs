//! How arrays are stored: the choices a scene has.

/// Floating-point format of a field. Everything a restart needs is always `f64`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// Four bytes: rounding error 6e-8 of each value, half the size. The default.
    #[default]
    F32,
    /// Eight bytes: the values as computed.
    F64,
}

/// Compression of the large arrays. ParaView reads both without plug-ins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compression {
    /// As they are. The default: lossless compression of stress gains 10 to 20 % of the size and costs more time
    /// than a step.
    #[default]
    None,
    /// Shuffle, then deflate at a level from 1 (fast) to 9 (small); levels outside are clamped.
    Deflate(u8),
}

/// Largest error that stress may be stored with.
///
/// Values are rounded to the nearest multiple of a power of two, the largest that is at most twice the bound. What is
/// left of them has few digits, which shuffle and deflate, filters of every HDF5 library, make small. The rounding
/// is exact in f64, and in f32 up to 2^24 multiples: 17 GPa at 1 kPa. Beyond, and for what is not finite, the
/// format rounds as it does without a bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorBound {
    bound: f64,
}

impl ErrorBound {
    /// A bound, Pa; None unless it is a normal positive number.
    pub fn new(bound: f64) -> Option<ErrorBound> {
        (bound.is_normal() && bound > 0.0 && (2.0 * bound).is_finite()).then_some(ErrorBound { bound })
    }

    /// The bound, Pa.
    pub fn bound(self) -> f64 {
        self.bound
    }

    /// Distance of neighbouring values, Pa: the largest power of two that is at most twice the bound.
    pub fn step(self) -> f64 {
        const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
        f64::from_bits((2.0 * self.bound).to_bits() & EXPONENT)
    }

    /// The nearest multiples of the step, without negative zeros.
    pub(crate) fn round(self, values: &[f64]) -> Vec<f64> {
        // Added to a smaller number, its last binary digit is one step: the sum is rounded to it.
        let shift = self.step() * (3_u64 << 51) as f64;
        let most = 0.25 * shift;
        let round = |&value: &f64| match value.abs() < most {
            true => (value + shift) - shift,
            false => value,
        };
        values.iter().map(round).collect()
    }
}

/// The choices together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Storage {
    /// Format of the stress arrays.
    pub stress: Precision,
    /// Largest error of the stress arrays; None stores them as their format has them.
    pub stress_error: Option<ErrorBound>,
    /// Format of the displacement.
    pub displacement: Precision,
    /// Compression of the arrays over points.
    pub compression: Compression,
}

impl Default for Storage {
    fn default() -> Storage {
        Storage {
            stress: Precision::F32,
            stress_error: None,
            displacement: Precision::F64,
            compression: Compression::None,
        }
    }
}

impl Coding {
    /// The coding of a field that is known in a region alone.
    pub(crate) fn in_region(self) -> Coding {
        match self {
            Coding::Full(precision) | Coding::Packed(precision) => Coding::Region(precision, None),
            Coding::Rounded(precision, bound) => Coding::Region(precision, Some(bound)),
            Coding::MostlyZero | Coding::Region(..) => self,
        }
    }
}

impl Storage {
    /// How stress arrays are coded.
    pub(crate) fn stress_coding(&self) -> Coding {
        match self.stress_error {
            Some(bound) => Coding::Rounded(self.stress, bound),
            None => Coding::Full(self.stress),
        }
    }
}

/// How the values of one array are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Coding {
    /// Each as a number of this format.
    Full(Precision),
    /// Rounded to a bound of the error, in this format, and compressed.
    Rounded(Precision, ErrorBound),
    /// The same, and compressed whatever the run chose.
    Packed(Precision),
    /// In f64, of vectors of which most are zero: pieces of zeros are not in the file.
    MostlyZero,
    /// In this format, NaN outside a region: compressed, and pieces that lie outside are not in the file.
    Region(Precision, Option<ErrorBound>),
}
