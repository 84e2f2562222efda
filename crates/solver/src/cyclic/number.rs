//! Entries of the factors: one real or complex number per harmonic, in the registers of the processor.

use pulp::Simd;

/// Right-hand sides are always complex.
#[derive(Clone, Copy)]
pub(super) struct Complex<S: Simd> {
    pub(super) re: S::f64s,
    pub(super) im: S::f64s,
}

impl<S: Simd> Complex<S> {
    #[inline(always)]
    pub(super) fn zero(simd: S) -> Self {
        let zero = simd.splat_f64s(0.0);
        Complex { re: zero, im: zero }
    }

    #[inline(always)]
    pub(super) fn minus(self, simd: S, other: Self) -> Self {
        Complex {
            re: simd.sub_f64s(self.re, other.re),
            im: simd.sub_f64s(self.im, other.im),
        }
    }

    #[inline(always)]
    pub(super) fn scaled(self, simd: S, factor: S::f64s) -> Self {
        Complex {
            re: simd.mul_f64s(self.re, factor),
            im: simd.mul_f64s(self.im, factor),
        }
    }
}

/// An entry of a factor. In memory an entry is `PARTS` vectors of all lanes.
pub(super) trait Number<S: Simd>: Copy {
    /// Vectors per entry: 1 real, 2 complex.
    const PARTS: usize;

    fn zero(simd: S) -> Self;
    /// `parts[i]` is the vector of part i.
    fn load(parts: [S::f64s; 2]) -> Self;
    /// Its parts; a real number has only the first.
    fn parts(self) -> [S::f64s; 2];
    /// `self - other`.
    fn minus(self, simd: S, other: Self) -> Self;
    /// `self` times the real `factor`.
    fn scaled(self, simd: S, factor: S::f64s) -> Self;
    /// `self + a conj(b)`.
    fn plus_product(self, simd: S, a: Self, b: Self) -> Self;
    /// `sum + self x`.
    fn times(self, simd: S, x: Complex<S>, sum: Complex<S>) -> Complex<S>;
    /// `sum + conj(self) x`.
    fn conj_times(self, simd: S, x: Complex<S>, sum: Complex<S>) -> Complex<S>;
}

/// Kind of entries, for choosing a kernel without naming the processor.
pub(super) trait Form: Send + Sync {
    /// Its entries.
    type Number<S: Simd>: Number<S>;
    /// Vectors per entry.
    const PARTS: usize;
}

/// Sections that are their own mirror images: real symmetric harmonics.
pub(super) struct Real;
/// All others: Hermitian harmonics.
pub(super) struct Hermitian;

impl Form for Real {
    type Number<S: Simd> = RealNumber<S>;
    const PARTS: usize = 1;
}

impl Form for Hermitian {
    type Number<S: Simd> = Complex<S>;
    const PARTS: usize = 2;
}

/// A real entry.
#[derive(Clone, Copy)]
pub(super) struct RealNumber<S: Simd>(S::f64s);

impl<S: Simd> Number<S> for RealNumber<S> {
    const PARTS: usize = 1;

    #[inline(always)]
    fn zero(simd: S) -> Self {
        RealNumber(simd.splat_f64s(0.0))
    }

    #[inline(always)]
    fn load(parts: [S::f64s; 2]) -> Self {
        RealNumber(parts[0])
    }

    #[inline(always)]
    fn parts(self) -> [S::f64s; 2] {
        [self.0, self.0]
    }

    #[inline(always)]
    fn minus(self, simd: S, other: Self) -> Self {
        RealNumber(simd.sub_f64s(self.0, other.0))
    }

    #[inline(always)]
    fn scaled(self, simd: S, factor: S::f64s) -> Self {
        RealNumber(simd.mul_f64s(self.0, factor))
    }

    #[inline(always)]
    fn plus_product(self, simd: S, a: Self, b: Self) -> Self {
        RealNumber(simd.mul_add_e_f64s(a.0, b.0, self.0))
    }

    #[inline(always)]
    fn times(self, simd: S, x: Complex<S>, sum: Complex<S>) -> Complex<S> {
        Complex {
            re: simd.mul_add_e_f64s(self.0, x.re, sum.re),
            im: simd.mul_add_e_f64s(self.0, x.im, sum.im),
        }
    }

    #[inline(always)]
    fn conj_times(self, simd: S, x: Complex<S>, sum: Complex<S>) -> Complex<S> {
        self.times(simd, x, sum)
    }
}

impl<S: Simd> Number<S> for Complex<S> {
    const PARTS: usize = 2;

    #[inline(always)]
    fn zero(simd: S) -> Self {
        Complex::zero(simd)
    }

    #[inline(always)]
    fn load(parts: [S::f64s; 2]) -> Self {
        Complex {
            re: parts[0],
            im: parts[1],
        }
    }

    #[inline(always)]
    fn parts(self) -> [S::f64s; 2] {
        [self.re, self.im]
    }

    #[inline(always)]
    fn minus(self, simd: S, other: Self) -> Self {
        Complex::minus(self, simd, other)
    }

    #[inline(always)]
    fn scaled(self, simd: S, factor: S::f64s) -> Self {
        Complex::scaled(self, simd, factor)
    }

    #[inline(always)]
    fn plus_product(self, simd: S, a: Self, b: Self) -> Self {
        b.conj_times(simd, a, self)
    }

    #[inline(always)]
    fn times(self, simd: S, x: Complex<S>, sum: Complex<S>) -> Complex<S> {
        let re = simd.mul_add_e_f64s(self.re, x.re, sum.re);
        let im = simd.mul_add_e_f64s(self.re, x.im, sum.im);
        Complex {
            re: simd.negate_mul_add_e_f64s(self.im, x.im, re),
            im: simd.mul_add_e_f64s(self.im, x.re, im),
        }
    }

    #[inline(always)]
    fn conj_times(self, simd: S, x: Complex<S>, sum: Complex<S>) -> Complex<S> {
        let re = simd.mul_add_e_f64s(self.re, x.re, sum.re);
        let im = simd.mul_add_e_f64s(self.re, x.im, sum.im);
        Complex {
            re: simd.mul_add_e_f64s(self.im, x.im, re),
            im: simd.negate_mul_add_e_f64s(self.im, x.re, im),
        }
    }
}
