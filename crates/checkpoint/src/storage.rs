//! How arrays are stored: the choices a scene has.

/// Floating-point format of stress and von Mises stress. Everything a restart needs is always `f64`.
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

/// The choices together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Storage {
    /// Format of the stress arrays.
    pub stress: Precision,
    /// Compression of the arrays over points.
    pub compression: Compression,
}
