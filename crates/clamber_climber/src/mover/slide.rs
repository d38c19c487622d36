//! How a body gets from where it was a tick ago to where it wants to be, among things that move.
//!
//! The body's hard core, its capsule without the skin width, is swept over the tick against everything on
//! its own way. What it meets becomes a plane: beyond it the body may not be at the tick's end, where the
//! material point that was met will be then. Of the displacements above all planes together the one nearest
//! to what is wanted is taken, and swept again, until nothing is in the way. Then whatever overlaps the body,
//! skin width and all, at the tick's end adds its planes, the deepest first: each is tested anew after every
//! push, so that the edges within flat ground, which lie deeper only until the ground has pushed, give none.
//! What is near but clear is among them, for a push may lead into it.
//!
//! A plane says where the body may end, not how fast it may go, so that what is pushed aside, carried, or
//! slides does so within the same tick: a plane's velocity is in where its point ends. (Contact planes
//! solved together: Jolt's CharacterVirtual, box3d's mover, avian's velocity projection. Those ask for
//! planes near the start, with a margin, of things that stand.)

use clamber_world::WorldCapsule;
use glam::DVec3;

use super::{Touch, World};
use crate::planes::{Above, Plane, nearest_above};

/// Most rounds of one movement, each a sweep, a look at what overlaps, or both. Two or three do for corners; what is left
/// after eight stands where it met.
const ROUNDS: u32 = 8;

/// Most planes that the overlaps of one round add.
const PUSHES: usize = 16;

/// Overlap that counts as none, metres: above the rounding of f32 coordinates of a creature, far below what
/// is seen.
const TOUCH: f64 = 1e-5;

/// How far around the body is looked for what a push may lead it into, as a share of the skin width; who is pushed farther
/// is swept again. More than the half by which one who walks is pressed onto the ground, or the last digit would decide
/// which of the two it is; less than the whole, by which the core is clear of what touches the skin.
const NEAR: f64 = 0.75;

/// Where a body is to go.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path {
    /// Ends of the body's axis from its position.
    pub(crate) axis: [DVec3; 2],
    pub(crate) radius: f64,
    pub(crate) skin: f64,
    /// Position a tick ago, and the one that is wanted.
    pub(crate) start: DVec3,
    pub(crate) target: DVec3,
    /// Up, and the cosine of the steepest slope: what is steeper is a wall. For those who walk.
    pub(crate) walkable: Option<(DVec3, f64)>,
    /// What it hangs from.
    pub(crate) arm: Option<Arm>,
    /// False to take what is there already as found: no sweep. For those who were put elsewhere.
    pub(crate) swept: bool,
}

/// It may be no farther than this from there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arm {
    pub(crate) pivot: DVec3,
    pub(crate) length: f64,
}

/// Where a body went.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moved {
    pub(crate) position: DVec3,
    /// How much room is missing between planes, metres.
    pub(crate) missed: f64,
    /// How deep the hard core is in something, metres.
    pub(crate) penetration: f64,
    pub(crate) rounds: u32,
    /// Nothing is on the way.
    pub(crate) is_clear: bool,
}

impl Path {
    fn capsule(&self, position: DVec3) -> WorldCapsule {
        WorldCapsule {
            ends: self.axis.map(|end| position + end),
            radius: self.radius,
        }
    }

    fn core(&self, position: DVec3) -> WorldCapsule {
        self.capsule(position).with_radius(self.radius - self.skin)
    }
}

impl World<'_> {
    /// Moves a body; what it touches in the end, or was kept from entering, is in [`World::touched`].
    pub(crate) fn slide(&mut self, path: &Path) -> Moved {
        self.scratch.planes.clear();
        self.scratch.uprights.clear();
        self.scratch.touched.clear();
        let mut moved = Moved {
            position: path.target,
            missed: 0.0,
            penetration: 0.0,
            rounds: 0,
            is_clear: true,
        };
        self.keep_arm(path, &mut moved);
        let near = path.skin * NEAR;
        let mut swept = path.swept;
        // To there nothing was on the way.
        let mut free: Option<DVec3> = None;
        loop {
            moved.rounds += 1;
            if free.is_none_or(|free| moved.position.distance(free) > near) {
                free = None;
                if swept && let Some(inside) = self.meet(path, &mut moved) {
                    if inside {
                        // What it is in already shows the way out, and would hide all else. Whatever else it is in is to
                        // be seen from here, not from beyond where that alone would push it.
                        swept = false;
                    } else if moved.rounds < ROUNDS {
                        continue;
                    } else {
                        moved.is_clear = false;
                        self.stop(path, &mut moved);
                    }
                }
            }
            let before = moved.position;
            let from = *free.get_or_insert(before);
            let pushes = self.push_out(path, &mut moved);
            // One push leads straight off what it touches. Of two, each takes the other's touch elsewhere: there it is
            // looked for anew, unless there is no room to find.
            let is_settled = pushes < 2 || moved.position.distance(before) <= TOUCH;
            let is_there = is_settled || moved.missed > TOUCH;
            let is_near = moved.position.distance(from) <= near;
            if is_there && is_near || moved.rounds >= ROUNDS {
                return moved;
            }
        }
    }

    /// What the last movement touched or was kept from entering, in that order; some perhaps more than once.
    pub(crate) fn touched(&self) -> &[Touch] {
        &self.scratch.touched
    }

    /// Sweeps to where the body is to be, and keeps clear of the first thing that it meets: whether the
    /// body was inside it from the start.
    fn meet(&mut self, path: &Path, moved: &mut Moved) -> Option<bool> {
        let displacement = moved.position - path.start;
        let (touch, hit) = self.sweep(&path.core(path.start), displacement)?;
        let at = path.start + displacement * hit.time;
        let end = self
            .motion(touch.obstacle, &touch.contact.material)
            .map_or(touch.contact.point, |motion| motion.position);
        let on_axis = path.core(at).nearest_on_axis(touch.contact.point) - at;
        let offset = touch.away.dot(end - path.start - on_axis) + path.radius;
        if !(hit.started_inside && self.is_sunk(&touch)) {
            self.add_plane(path, touch, offset, moved.position);
        }
        if !hit.started_inside {
            self.solve(path, moved);
        }
        Some(hit.started_inside)
    }

    /// Stands where it met something, and goes with that for the rest of the tick.
    fn stop(&mut self, path: &Path, moved: &mut Moved) {
        let displacement = moved.position - path.start;
        if let Some((touch, hit)) = self.sweep(&path.core(path.start), displacement) {
            let end = self.motion(touch.obstacle, &touch.contact.material);
            let carried = end.map_or(DVec3::ZERO, |motion| motion.position - touch.contact.point);
            moved.position = path.start + displacement * hit.time + carried;
        }
    }

    /// Out of everything that overlaps the body where it is: by how many pushes.
    fn push_out(&mut self, path: &Path, moved: &mut Moved) -> usize {
        let found = moved.position;
        let near = path.radius + path.skin * NEAR;
        self.touching(&path.capsule(found).with_radius(near));
        let mut touches = std::mem::take(&mut self.scratch.touches);
        let mut pushes = 0;
        while pushes < PUSHES {
            let capsule = path.capsule(moved.position);
            let mut worst: Option<(f64, Touch)> = None;
            for touch in &touches {
                let now = again(touch, &capsule, moved.position - found);
                let depth = path.radius - now.contact.distance;
                if depth > worst.map_or(TOUCH, |(deepest, _)| deepest) {
                    worst = Some((depth, now));
                }
            }
            let Some((depth, touch)) = worst else {
                break;
            };
            let offset = touch.away.dot(moved.position - path.start) + depth;
            self.add_plane(path, touch, offset, moved.position);
            pushes += 1;
            let before = moved.position;
            self.solve(path, moved);
            if moved.position == before {
                break;
            }
        }
        let capsule = path.capsule(moved.position);
        let overlap = touches.iter().map(|touch| {
            let now = again(touch, &capsule, moved.position - found);
            path.radius - now.contact.distance
        });
        moved.penetration = (overlap.fold(0.0, f64::max) - path.skin).max(0.0);
        std::mem::swap(&mut self.scratch.touches, &mut touches);
        pushes
    }

    /// `position` is where the body would be without the plane.
    fn add_plane(&mut self, path: &Path, touch: Touch, offset: f64, position: DVec3) {
        let scratch = &mut *self.scratch;
        scratch.touched.push(touch);
        scratch.planes.push(Plane {
            normal: touch.away,
            offset,
        });
        if let Some((up, least_cosine)) = path.walkable {
            let rise = touch.away.dot(up);
            let level = (touch.away - up * rise).normalize_or_zero();
            let lean = touch.away.dot(level);
            // Too steep to stand on, and no ceiling: as steep as can be.
            if rise > LEVEL && rise < least_cosine && lean > 0.0 {
                let displacement = position - path.start;
                let into = offset - touch.away.dot(displacement);
                scratch.uprights.push(Plane {
                    normal: level,
                    offset: level.dot(displacement) + into / lean,
                });
            }
        }
    }

    fn solve(&mut self, path: &Path, moved: &mut Moved) {
        let wanted = path.target - path.start;
        let scratch = &mut *self.scratch;
        let count = scratch.planes.len();
        scratch.planes.extend_from_slice(&scratch.uprights);
        let mut above = self.nearest_above(wanted);
        self.scratch.planes.truncate(count);
        if above.missed > TOUCH && !self.scratch.uprights.is_empty() {
            // Steep slopes on all sides: they hold it up, as they do who falls between them.
            above = self.nearest_above(wanted);
        }
        moved.position = path.start + above.point;
        moved.missed = above.missed;
        self.keep_arm(path, moved);
    }

    /// The displacement nearest to what is wanted above all planes, if it is not far off; else that above all planes
    /// lowered by as little as it takes.
    ///
    /// Walls that are all but opposite meet somewhere, many times as far away as they overlap: no body slips out there
    /// within a tick, and whatever is on the way is in its way. They crush it.
    fn nearest_above(&mut self, wanted: DVec3) -> Above {
        let planes = &mut self.scratch.planes;
        let above = nearest_above(wanted, planes);
        let gaps = planes
            .iter()
            .map(|plane| plane.offset - plane.normal.dot(wanted));
        let gap = gaps.fold(0.0, f64::max);
        let farthest = wanted.length() + FARTHEST * gap;
        let is_near = |above: &Above| above.point.length() <= farthest;
        if is_near(&above) {
            return above;
        }
        let (mut too_little, mut enough) = (0.0, gap);
        for _ in 0..HALVINGS {
            let relief = (too_little + enough) * 0.5;
            if is_near(&lowered(wanted, planes, relief)) {
                enough = relief;
            } else {
                too_little = relief;
            }
        }
        let above = lowered(wanted, planes, enough);
        Above {
            missed: above.missed + enough,
            ..above
        }
    }

    /// A body at the end of a taut arm stays there: planes that touch the ball of its reach where it is. Walls are harder
    /// than arms: where both leave no room, the arm gives way.
    fn keep_arm(&mut self, path: &Path, moved: &mut Moved) {
        let Some(arm) = path.arm else {
            return;
        };
        let count = self.scratch.planes.len();
        let without = *moved;
        for _ in 0..4 {
            let reach = moved.position - arm.pivot;
            if reach.length() <= arm.length * (1.0 + 1e-9) {
                break;
            }
            let inward = -reach.normalize_or(DVec3::Y);
            self.scratch.planes.push(Plane {
                normal: inward,
                offset: inward.dot(arm.pivot - path.start) - arm.length,
            });
            let above = self.nearest_above(path.target - path.start);
            if above.missed > without.missed + TOUCH {
                *moved = without;
                break;
            }
            moved.position = path.start + above.point;
            moved.missed = above.missed;
        }
        self.scratch.planes.truncate(count);
    }
}

/// Above planes that all are lowered by a length.
fn lowered(wanted: DVec3, planes: &mut [Plane], by: f64) -> Above {
    planes.iter_mut().for_each(|plane| plane.offset -= by);
    let above = nearest_above(wanted, planes);
    planes.iter_mut().for_each(|plane| plane.offset += by);
    above
}

/// A push that leads farther than what is wanted, and this many times the deepest overlap, is none: walls that differ by
/// less than 29 degrees from opposite are no wedge to slip out of. More throws who is crushed by a few centimetres by
/// metres, through what is there; less holds on to who could slip out.
const FARTHEST: f64 = 4.0;

/// To a thousandth of the overlap.
const HALVINGS: u32 = 10;

/// Slopes steeper than this are walls already: sine of the angle from the vertical.
const LEVEL: f64 = 1e-3;

/// A contact as it is seen from a body that has been pushed since.
fn again(touch: &Touch, capsule: &WorldCapsule, pushed: DVec3) -> Touch {
    let mut now = *touch;
    let apart = capsule.nearest_on_axis(touch.contact.point) - touch.contact.point;
    if touch.contact.distance > 0.0 && apart.dot(touch.away) > 0.0 {
        now.contact.distance = apart.length();
        now.away = apart.normalize_or(touch.away);
    } else {
        // Once through, the other side is no way out: back the way it came.
        now.contact.distance += touch.away.dot(pushed);
    }
    now
}
