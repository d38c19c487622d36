//! Surveys the skin at rest: divides it into pieces, finds the climber's seat on each piece and the reach of its hands
//! there, and links seats that are near each other.

mod arms;
mod links;
mod pieces;
mod seat;
mod split;

use clamber_surface::mesh::{Rig, TriangleId};
use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use glam::DVec3;

use crate::progress::{Stage, Tell};
use crate::{GraphConfig, NavigationError};
pub(crate) use arms::REACH_PRECISION;
use links::Links;
use pieces::Division;
pub(crate) use pieces::{Bit, Piece};

/// Least height of the ball's middle above the ground, as a share of its radius.
const LOWEST_BALL: f64 = 0.98;

/// Largest gap between the ball and skin that still counts as touching, as a share of its radius. It is not 0 because
/// skin is rarely flat.
const TOUCHING_GAP: f64 = 0.3;
/// The same gap in a corner. It is smaller because hands let go of one side there.
const OFF_IN_CORNER: f64 = 0.1;

/// Two sides whose normals have a lower cosine than this meet in a corner.
const CORNER_COSINE: f64 = 0.7;

/// Two sides whose normals have a lower cosine than this are not linked: no input of a climber on one side pushes it
/// against the other.
const OPPOSITE_COSINE: f64 = -0.87;

/// The survey of the skin at rest, piece by piece.
#[derive(Clone, Debug)]
pub(crate) struct Survey {
    pub(crate) config: GraphConfig,
    /// The pieces, sorted by place.
    pub(crate) pieces: Vec<Piece>,
    /// The parts of triangles from which the pieces are made.
    pub(crate) bits: Vec<Bit>,
    pub(crate) links: Links,
    /// For each piece, how far a hand has to reach from the ball of its seat to a grip, metres; infinite if no grip is
    /// near.
    pub(crate) arms: Vec<f64>,
    /// The skin at rest.
    pub(crate) surface: SkinnedSurface,
    /// The part of the skin that can be gripped, at rest.
    holds: SkinnedSurface,
}

impl Survey {
    pub(crate) fn new(
        rig: &Rig,
        config: &GraphConfig,
        tell: &mut Tell<'_>,
    ) -> Result<Self, NavigationError> {
        config.check()?;
        let palette = rig.skeleton.palette(&rig.skeleton.rest_pose())?;
        let mut surface = SkinnedSurface::new(rig.collider.clone());
        surface.teleport(&palette, config.world_from_model)?;
        let mut holds = surface.clone();
        for (index, tag) in rig.collider.tags().iter().enumerate() {
            if !config.can_grip(tag) {
                holds.disable_triangle(TriangleId(index as u32))?;
            }
        }
        let mut plate_of = vec![NO_PLATE; rig.collider.triangles().len()];
        for (plate, triangles) in (0..).zip(&config.plates) {
            for triangle in triangles {
                let of = plate_of.get_mut(triangle.index());
                *of.ok_or(SurfaceError::Triangle(*triangle))? = plate;
            }
        }
        let plate = |triangle: TriangleId| plate_of[triangle.index()];
        let Division {
            mut pieces,
            bits,
            others,
        } = pieces::divide(&surface, config, &plate)?;
        let of = pieces.len();
        let lowest = config.ground + LOWEST_BALL * config.radius();
        let above = |seat: &DVec3| seat.dot(config.climber.up()) >= lowest;
        let find = |surface: &SkinnedSurface, piece: &Piece| {
            seat::seat(surface, piece.point, piece.normal, config.radius()).filter(above)
        };
        let mut arms = vec![f64::INFINITY; of];
        for (done, piece) in pieces.iter_mut().enumerate() {
            tell.at(Stage::Seats, done, of)?;
            settle(piece, &others[done], |bit| find(&surface, bit));
        }
        for (done, piece) in pieces.iter().enumerate() {
            tell.at(Stage::Arms, done, of)?;
            if let Some(seat) = piece.seat {
                arms[done] = arms::arm(&holds, seat, config);
            }
        }
        for (plate, triangles) in config.plates.iter().enumerate() {
            let bare = without(&surface, triangles)?;
            let held = without(&holds, triangles)?;
            for ((piece, arm), others) in pieces.iter_mut().zip(&mut arms).zip(&others) {
                if piece.seat.is_some() || !bare.is_enabled(piece.triangle) {
                    continue;
                }
                settle(piece, others, |bit| find(&bare, bit));
                if let Some(seat) = piece.seat {
                    piece.below = Some(plate as u16);
                    *arm = arms::arm(&held, seat, config);
                }
            }
        }
        Ok(Self {
            config: config.clone(),
            links: Links::new(&pieces, config.link()),
            pieces,
            bits,
            arms,
            surface,
            holds,
        })
    }

    /// How far a hand has to reach at most on the way between two pieces. Exceeds `enough` plus [`REACH_PRECISION`]
    /// only if the reach exceeds `enough`.
    pub(crate) fn arm_between(&self, ends: [usize; 2], enough: f64) -> f64 {
        let [Some(from), Some(to)] = ends.map(|piece| self.pieces[piece].seat) else {
            return f64::INFINITY;
        };
        let arms = ends.map(|piece| self.arms[piece]);
        let arm_at = |seat| arms::arm(&self.holds, seat, &self.config);
        arms::arm_between([from, to], arms, enough, &arm_at)
    }

    /// True if a climber can stand on a piece at rest. Pieces on edges, whose area is 0, are among them.
    pub(crate) fn can_stand(&self, piece: usize) -> bool {
        let piece = &self.pieces[piece];
        piece.seat.is_some() && self.slope(piece) <= self.config.climber.ground.max_slope
    }

    /// True if a climber can hold on and climb at a piece at rest, with arms of this reach.
    pub(crate) fn can_hold(&self, piece: usize, reach: f64) -> bool {
        let grip = self.config.climber.grip;
        grip.is_some_and(|grip| {
            self.arms[piece] <= reach && self.slope(&self.pieces[piece]) <= grip.max_overhang
        })
    }

    /// True if a climber can climb between two pieces, in either direction: along the skin, with a grip all the way. It
    /// must be able to hold on at both pieces.
    pub(crate) fn can_climb(&self, ends: [usize; 2]) -> bool {
        let reach = self.config.reach();
        self.is_along(ends) && self.arm_between(ends, reach) <= reach + REACH_PRECISION
    }

    /// True if the ball gets between two pieces along the skin: it does not rise off one piece where it does not touch
    /// the other yet. So no hand gets from a floor to the ceiling, except by the wall.
    fn is_along(&self, ends: [usize; 2]) -> bool {
        let [from, to] = ends.map(|piece| &self.pieces[piece]);
        let (Some(a), Some(b)) = (from.seat, to.seat) else {
            return false;
        };
        let (leaves, arrives) = ((b - a).dot(from.normal), (a - b).dot(to.normal));
        // At an outer edge, both seats are below the plane of the other piece.
        if leaves < 0.0 && arrives < 0.0 {
            return true;
        }
        let radius = self.config.radius();
        let cosine = from.normal.dot(to.normal);
        if cosine >= CORNER_COSINE {
            return leaves.abs().min(arrives.abs()) <= TOUCHING_GAP * radius;
        }
        if cosine < OPPOSITE_COSINE {
            return false;
        }
        // In a corner, the skin of one side extends to where the ball touches the other side.
        let most = OFF_IN_CORNER * radius;
        let goes_on = |seat: DVec3, side: &Piece| {
            let surface = self.surface.in_world();
            surface.intersects_ray(seat, -side.normal, (1.0 + TOUCHING_GAP) * radius)
        };
        leaves.abs() <= most && goes_on(b, from) || arrives.abs() <= most && goes_on(a, to)
    }

    /// True if the normals of two pieces differ by a corner's angle.
    pub(crate) fn bends(&self, ends: [usize; 2]) -> bool {
        let [from, to] = ends.map(|piece| self.pieces[piece].normal);
        from.dot(to) < CORNER_COSINE
    }

    /// True if two pieces between which a climber moves meet in an inner corner.
    pub(crate) fn is_corner(&self, ends: [usize; 2]) -> bool {
        let [from, to] = ends.map(|piece| &self.pieces[piece]);
        let between = to.point - from.point;
        self.bends(ends) && between.dot(from.normal) - between.dot(to.normal) > 0.0
    }

    /// Distance between the seats of two pieces, metres; infinite if one has no seat.
    pub(crate) fn apart(&self, ends: [usize; 2]) -> f64 {
        match ends.map(|piece| self.pieces[piece].seat) {
            [Some(a), Some(b)] => a.distance(b),
            _ => f64::INFINITY,
        }
    }

    /// True if a climber can walk between two pieces, in either direction. It must be able to stand on both pieces.
    pub(crate) fn can_walk(&self, ends: [usize; 2]) -> bool {
        let climber = &self.config.climber;
        let (Some(a), Some(b)) = (self.pieces[ends[0]].seat, self.pieces[ends[1]].seat) else {
            return false;
        };
        let rise = (b - a).dot(climber.up());
        let level = (b - a - climber.up() * rise).length();
        rise.abs() <= climber.ground.step_height + level * libm::tan(climber.ground.max_slope)
    }

    fn slope(&self, piece: &Piece) -> f64 {
        let cosine = piece.normal.dot(self.config.climber.up());
        libm::acos(cosine.clamp(-1.0, 1.0))
    }
}

/// The plate of a triangle that belongs to no plate.
const NO_PLATE: u32 = u32::MAX;

/// Finds the seat of a piece: on its own bit, or on one of its other bits.
fn settle(piece: &mut Piece, others: &[Piece], find: impl Fn(&Piece) -> Option<DVec3>) {
    piece.seat = find(piece);
    for other in others {
        if piece.seat.is_some() {
            return;
        }
        if let Some(seat) = find(other) {
            *piece = Piece {
                seat: Some(seat),
                ..*other
            };
        }
    }
}

/// A copy of a surface without some triangles.
fn without(
    surface: &SkinnedSurface,
    triangles: &[TriangleId],
) -> Result<SkinnedSurface, NavigationError> {
    let mut bare = surface.clone();
    for triangle in triangles {
        bare.disable_triangle(*triangle)?;
    }
    Ok(bare)
}
