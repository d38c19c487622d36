use dashu::rational::Relaxed;

use super::number::{
    Exact, between, between_triangle_and_segment, exact, from_triangle, length_sq, number, plus,
};
use crate::MovingPair;

/// A [`MovingPair`] in exact arithmetic, less the radius.
#[derive(Clone, Debug)]
pub struct ExactPair {
    /// Of the triangle, at both times.
    pub corners: [[Exact; 3]; 2],
    /// Of the core, at both times.
    pub ends: [[Exact; 2]; 2],
}

impl ExactPair {
    /// From the triangle's nearest point to the core's, at a time.
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

    /// True if they are at most so far apart at a time.
    pub fn is_within(&self, time: f64, distance: &Relaxed) -> bool {
        length_sq(&self.apart(&number(time))) <= distance * distance
    }
}

impl From<&MovingPair> for ExactPair {
    /// # Panics
    /// If a coordinate is not finite.
    fn from(pair: &MovingPair) -> Self {
        let [ends, motions] = pair.ends().map(|points| points.map(exact));
        let later = [0, 1].map(|k| plus(&ends[k], &motions[k]));
        Self {
            corners: pair.corners.map(|corners| corners.map(exact)),
            ends: [ends, later],
        }
    }
}
