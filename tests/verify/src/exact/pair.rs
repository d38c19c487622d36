use dashu_ratio::Relaxed;

use super::arithmetic::{
    Exact, between, between_triangle_and_segment, exact, from_triangle, length_sq, number, plus,
};
use crate::MovingPair;

/// A [`MovingPair`] in exact arithmetic, without its radius.
#[derive(Clone, Debug)]
pub struct ExactPair {
    /// Corners of the triangle, at time 0 and at time 1.
    pub corners: [[Exact; 3]; 2],
    /// Ends of the core, at time 0 and at time 1. The two ends of a sphere's core are equal.
    pub ends: [[Exact; 2]; 2],
}

impl ExactPair {
    /// The vector from the triangle's nearest point to the core's nearest point, at a time: 0 at the start of the
    /// motion, 1 at its end. Zero if they intersect.
    pub fn apart(&self, time: &Relaxed) -> Exact {
        let [from, to] = &self.corners;
        let corners = [0, 1, 2].map(|k| between(&from[k], &to[k], time));
        let [from, to] = &self.ends;
        let ends = [0, 1].map(|k| between(&from[k], &to[k], time));
        if ends[0] == ends[1] {
            from_triangle(&ends[0], &corners)
        } else {
            between_triangle_and_segment(&corners, [&ends[0], &ends[1]])
        }
    }

    /// True if triangle and core are at most `distance` apart at a time.
    ///
    /// # Panics
    /// If the time is not finite.
    pub fn is_within(&self, time: f64, distance: &Relaxed) -> bool {
        length_sq(&self.apart(&number(time))) <= distance * distance
    }
}

impl From<&MovingPair> for ExactPair {
    /// # Panics
    /// If a coordinate is not finite.
    fn from(pair: &MovingPair) -> Self {
        let [ends, motions] = [pair.ends, pair.motions].map(|points| points.map(exact));
        let later = [0, 1].map(|k| plus(&ends[k], &motions[k]));
        Self {
            corners: pair.corners.map(|corners| corners.map(exact)),
            ends: [ends, later],
        }
    }
}
