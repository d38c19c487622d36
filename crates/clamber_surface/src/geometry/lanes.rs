//! The same source for scalar and SIMD arithmetic in f64.
//!
//! A geometric test that is written over [`Lanes`] runs on one `f64`, and is then its own readable reference, or on a
//! SIMD register, with one triangle per lane. The trait has only operations that IEEE 754 rounds correctly, so every
//! lane has the bits of the scalar run at every SIMD level. SIMD levels differ in minimum, maximum, clamp, sums across
//! lanes and fused products, so the trait has none of these.
//!
//! Everything is `inline(always)`, since SIMD instructions are emitted only within the function that enables them
//! (fearless_simd, MANUAL_INLINING.md). A closure that is not inlined would leave that function. The package's
//! `build.rs` tells why this does not hold for builds without optimisation.

use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

use fearless_simd::{ExtractToken, Select, Simd, SimdBase, SimdFloat, SimdMask};

/// One f64, or a SIMD register of f64.
pub(crate) trait Lanes:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The result of a comparison: a truth value per lane.
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask>;

    /// `value` in every lane; `self` only determines the number of lanes.
    fn splat(self, value: f64) -> Self;
    fn sqrt(self) -> Self;
    /// False where either number is NaN, like all comparisons here.
    fn less(self, other: Self) -> Self::Mask;
    fn at_most(self, other: Self) -> Self::Mask;
    fn equals(self, other: Self) -> Self::Mask;
    fn select(mask: Self::Mask, if_true: Self, if_false: Self) -> Self;
    /// True if the mask is set in any lane.
    fn any(mask: Self::Mask) -> bool;

    /// The larger number, by comparison; `self` where either is NaN.
    #[cfg_attr(not(unoptimized), inline(always))]
    fn or_larger(self, other: Self) -> Self {
        Self::select(self.less(other), other, self)
    }

    /// The smaller number, by comparison; `self` where either is NaN.
    #[cfg_attr(not(unoptimized), inline(always))]
    fn or_smaller(self, other: Self) -> Self {
        Self::select(other.less(self), other, self)
    }

    /// Clamps to 0..=1 like [`f64::clamp`]: keeps NaN and -0.
    #[cfg_attr(not(unoptimized), inline(always))]
    fn clamp_to_unit(self) -> Self {
        let (zero, one) = (self.splat(0.0), self.splat(1.0));
        let raised = Self::select(self.less(zero), zero, self);
        Self::select(one.less(raised), one, raised)
    }
}

impl Lanes for f64 {
    type Mask = bool;

    #[cfg_attr(not(unoptimized), inline(always))]
    fn splat(self, value: f64) -> Self {
        value
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn less(self, other: Self) -> bool {
        self < other
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn at_most(self, other: Self) -> bool {
        self <= other
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn equals(self, other: Self) -> bool {
        self == other
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn select(mask: bool, if_true: Self, if_false: Self) -> Self {
        if mask { if_true } else { if_false }
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn any(mask: bool) -> bool {
        mask
    }
}

/// A SIMD register of the level's native width.
#[derive(Clone, Copy)]
pub(crate) struct Wide<S: Simd>(pub(crate) S::f64s);

impl<S: Simd> Add for Wide<S> {
    type Output = Self;

    #[cfg_attr(not(unoptimized), inline(always))]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl<S: Simd> Sub for Wide<S> {
    type Output = Self;

    #[cfg_attr(not(unoptimized), inline(always))]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl<S: Simd> Mul for Wide<S> {
    type Output = Self;

    #[cfg_attr(not(unoptimized), inline(always))]
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl<S: Simd> Div for Wide<S> {
    type Output = Self;

    #[cfg_attr(not(unoptimized), inline(always))]
    fn div(self, other: Self) -> Self {
        Self(self.0 / other.0)
    }
}

impl<S: Simd> Neg for Wide<S> {
    type Output = Self;

    #[cfg_attr(not(unoptimized), inline(always))]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<S: Simd> Lanes for Wide<S> {
    type Mask = S::mask64s;

    #[cfg_attr(not(unoptimized), inline(always))]
    fn splat(self, value: f64) -> Self {
        Self(S::f64s::splat(self.0.token(), value))
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn less(self, other: Self) -> S::mask64s {
        self.0.simd_lt(other.0)
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn at_most(self, other: Self) -> S::mask64s {
        self.0.simd_le(other.0)
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn equals(self, other: Self) -> S::mask64s {
        self.0.simd_eq(other.0)
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn select(mask: S::mask64s, if_true: Self, if_false: Self) -> Self {
        Self(mask.select(if_true.0, if_false.0))
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn any(mask: S::mask64s) -> bool {
        mask.any_true()
    }
}
