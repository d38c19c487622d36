//! Finds the seats that are near each other.

use std::collections::BTreeMap;

use glam::{DVec3, IVec3};

use super::pieces::Piece;

/// For each piece, the pieces to whose seats a ball gets on a straight way.
#[derive(Clone, Debug, Default)]
pub(crate) struct Links {
    /// The links of piece p are `start[p]..start[p + 1]`.
    start: Vec<u32>,
    to: Vec<u32>,
}

impl Links {
    /// Links seats that are at most `longest` metres apart.
    ///
    /// The balls at both ends are free of skin, and overlap if `longest` is less than their diameter. So no skin
    /// crosses the way between them.
    pub(super) fn new(pieces: &[Piece], longest: f64) -> Self {
        let cell = |seat: DVec3| (seat / longest).floor().as_ivec3();
        let mut cells: BTreeMap<[i32; 3], Vec<u32>> = BTreeMap::new();
        for (index, piece) in pieces.iter().enumerate() {
            if let Some(seat) = piece.seat {
                let here = cells.entry(cell(seat).to_array()).or_default();
                here.push(index as u32);
            }
        }
        let mut links = Self {
            start: vec![0],
            ..Self::default()
        };
        let mut near: Vec<u32> = Vec::new();
        for (index, piece) in pieces.iter().enumerate() {
            near.clear();
            if let Some(seat) = piece.seat {
                let middle = cell(seat);
                for beside in around() {
                    let there = cells.get(&(middle + beside).to_array());
                    for other in there.into_iter().flatten() {
                        let beyond = pieces[*other as usize].seat;
                        let apart = beyond.map_or(f64::INFINITY, |beyond| beyond.distance(seat));
                        if apart <= longest && *other as usize != index {
                            near.push(*other);
                        }
                    }
                }
            }
            near.sort_unstable();
            links.to.extend(&near);
            links.start.push(links.to.len() as u32);
        }
        links
    }

    /// The pieces beside a piece, in ascending order.
    pub(crate) fn of(&self, piece: usize) -> impl Iterator<Item = usize> + '_ {
        let range = self.start[piece] as usize..self.start[piece + 1] as usize;
        self.to[range].iter().map(|to| *to as usize)
    }
}

fn around() -> impl Iterator<Item = IVec3> {
    (-1..=1).flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |z| IVec3::new(x, y, z))))
}
