//! Which seats are near each other.

use std::collections::BTreeMap;

use glam::{DVec3, IVec3};

use crate::patches::Patch;

/// For each patch, the patches whose seats a ball gets to straight.
#[derive(Clone, Debug, Default)]
pub(crate) struct Links {
    /// The links of patch p are `start[p]..start[p + 1]`.
    start: Vec<u32>,
    to: Vec<u32>,
    /// Length of each link, metres.
    length: Vec<f32>,
}

impl Links {
    /// Links seats that are at most `longest` metres apart.
    ///
    /// The balls at both ends are free of skin and overlap, if `longest` is less than their diameter. So no skin crosses the
    /// way between them.
    pub(super) fn new(patches: &[Patch], longest: f64) -> Self {
        let cell = |seat: DVec3| (seat / longest).floor().as_ivec3();
        let mut cells: BTreeMap<[i32; 3], Vec<u32>> = BTreeMap::new();
        for (index, patch) in patches.iter().enumerate() {
            if let Some(seat) = patch.seat {
                let here = cells.entry(cell(seat).to_array()).or_default();
                here.push(index as u32);
            }
        }
        let mut links = Self {
            start: vec![0],
            ..Self::default()
        };
        let mut near: Vec<(u32, f32)> = Vec::new();
        for (index, patch) in patches.iter().enumerate() {
            near.clear();
            if let Some(seat) = patch.seat {
                let middle = cell(seat);
                for beside in around() {
                    let there = cells.get(&(middle + beside).to_array());
                    for other in there.into_iter().flatten() {
                        let beyond = patches[*other as usize].seat;
                        let apart = beyond.map_or(f64::INFINITY, |beyond| beyond.distance(seat));
                        if apart <= longest && *other as usize != index {
                            near.push((*other, apart as f32));
                        }
                    }
                }
            }
            near.sort_unstable_by_key(|(other, _)| *other);
            links.to.extend(near.iter().map(|(other, _)| *other));
            links.length.extend(near.iter().map(|(_, length)| *length));
            links.start.push(links.to.len() as u32);
        }
        links
    }

    /// The patches beside a patch, in ascending order, with the lengths of the ways to them, metres.
    pub(crate) fn of(&self, patch: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.start[patch] as usize..self.start[patch + 1] as usize;
        let to = self.to[range.clone()].iter().map(|to| *to as usize);
        to.zip(self.length[range].iter().map(|length| f64::from(*length)))
    }
}

fn around() -> impl Iterator<Item = IVec3> {
    (-1..=1).flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |z| IVec3::new(x, y, z))))
}
