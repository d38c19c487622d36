use core::ops::{Add, Mul, Sub};

use glam::DVec3;

use super::lanes::Lanes;

/// A vector in each lane, with the order of operations of glam's `DVec3`.
#[derive(Clone, Copy)]
pub(crate) struct Vector3<L> {
    pub(crate) x: L,
    pub(crate) y: L,
    pub(crate) z: L,
}

impl<L: Lanes> Vector3<L> {
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn dot(self, other: Self) -> L {
        (self.x * other.x) + (self.y * other.y) + (self.z * other.z)
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - other.y * self.z,
            y: self.z * other.x - other.z * self.x,
            z: self.x * other.y - other.x * self.y,
        }
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn length_squared(self) -> L {
        self.dot(self)
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn length(self) -> L {
        self.length_squared().sqrt()
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn select(mask: L::Mask, if_true: Self, if_false: Self) -> Self {
        Self {
            x: L::select(mask, if_true.x, if_false.x),
            y: L::select(mask, if_true.y, if_false.y),
            z: L::select(mask, if_true.z, if_false.z),
        }
    }

    /// True where `self` comes before `other` when x is compared first, then y, then z.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn precedes(self, other: Self) -> L::Mask {
        let by_z = self.z.less(other.z);
        let by_y = self.y.less(other.y) | (self.y.equals(other.y) & by_z);
        self.x.less(other.x) | (self.x.equals(other.x) & by_y)
    }
}

impl<L: Lanes> Add for Vector3<L> {
    type Output = Self;

    #[cfg_attr(not(unoptimized), inline(always))]
    fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }
}

impl<L: Lanes> Sub for Vector3<L> {
    type Output = Self;

    #[cfg_attr(not(unoptimized), inline(always))]
    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
        }
    }
}

impl<L: Lanes> Mul<L> for Vector3<L> {
    type Output = Self;

    #[cfg_attr(not(unoptimized), inline(always))]
    fn mul(self, factor: L) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
            z: self.z * factor,
        }
    }
}

impl From<DVec3> for Vector3<f64> {
    #[cfg_attr(not(unoptimized), inline(always))]
    fn from(v: DVec3) -> Self {
        Self {
            x: v.x,
            y: v.y,
            z: v.z,
        }
    }
}
