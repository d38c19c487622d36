//! Moves a body from its position a tick ago to its wanted position, among obstacles that move.
//!
//! The body's core is swept over the tick against all moving obstacles. Each contact becomes a half-space in which the
//! body must end. Its plane goes through the touched material point's position at the tick's end. The displacement
//! inside all half-spaces that is nearest to the wanted displacement is taken and swept again, until no obstacle is in
//! the way. Then each contact that overlaps the whole body, margin included, at the tick's end adds its half-space, the
//! deepest first. All contacts are evaluated anew after every push, so that inner edges of flat ground, which are
//! deeper only until the ground has pushed, add no half-space. Contacts that are near but clear are evaluated as well,
//! since a push may lead into them.
//!
//! A half-space limits where the body may end, not how fast it may go. The end position of a touched point includes the
//! obstacle's velocity, so being pushed aside, being carried and sliding all happen within the same tick. (Contact
//! planes solved together: Jolt's CharacterVirtual, box3d's mover, avian's velocity projection. These methods collect
//! planes near the start, with a margin, from obstacles at rest.)

use clamber_world::SweepContact;
use glam::DVec3;

use crate::half_spaces::{MovePlane, Projection, project_where_it_pays};
use crate::mover::path_among;
use crate::{Begin, Moved, Mover, MoverContact, Path, Walking};

/// Maximum number of rounds of one movement, each with a sweep, an overlap query, or both. Corners take two or three
/// rounds. After the last round the body stops at the sweep's first contact.
const ROUNDS: u32 = 8;

/// Maximum number of half-spaces that the overlaps of one round add. Also the maximum for overlaps at the start, and
/// the number of contacts up to which a crushed body's other overlaps are listed as touched.
const PUSHES: usize = 16;

/// An overlap up to this fraction of the radius counts as none: more than the rounding of a creature's f32 coordinates,
/// far less than is visible.
pub(crate) const TOUCH: f64 = 2.5e-5;

/// Search distance around the body for contacts that a push may lead into, as a fraction of the margin. A body that is
/// pushed farther is swept again. More than 0.5, since a walking body is pressed onto the ground by half a margin;
/// otherwise rounding would decide whether ground contact is found. Less than 1, since the core of a touching body is a
/// whole margin away from the obstacle.
const NEAR: f64 = 0.75;

impl Mover<'_> {
    /// Moves a body along a path. [`Mover::touched`] then holds the contacts that the body touches at the end, and
    /// those that stopped it.
    ///
    /// If the path is not finite or its body is invalid ([`MoverBody::validate`](crate::MoverBody::validate)), the body
    /// stays at its start, and [`Moved::is_clear`] is false.
    pub fn slide(&mut self, path: &Path) -> Moved {
        let mut moved = self.find_way(path);
        if path.crushed && moved.rounds > 0 && path.begin == Begin::Start {
            self.come_out_slowly(path, &mut moved);
        }
        self.know_velocities();
        moved
    }

    /// Limits how far a crushed body is pushed in one tick.
    fn come_out_slowly(&mut self, path: &Path, moved: &mut Moved) {
        let aim = path.aim(moved);
        let push = moved.position - path.start - aim;
        let least = OUT * self.dt() * path.body.radius;
        if push.length() <= least {
            return;
        }
        let touched = self.memory.touched.iter().zip(&self.memory.half_spaces);
        let gaps = touched.map(|(touch, wall)| {
            // The offset of an overlap includes the body's depth; only the motion of its material counts as a push.
            let motion = self.path_of(touch);
            let offset = match motion.filter(|_| !touch.swept) {
                Some(motion) => {
                    let way = motion.position - motion.previous_position;
                    wall.offset.min(wall.normal.dot(way))
                }
                None => wall.offset,
            };
            offset - wall.normal.dot(aim)
        });
        let met = gaps.fold(0.0, f64::max);
        let most = STEEPEST_PUSH * met + least;
        if push.length() <= most {
            return;
        }
        moved.position = path.start + aim + push.normalize() * most;
        let overlaps = self.overlap(&path.body, moved.position, 0.0).iter();
        let depths = overlaps.map(|touch| path.body.radius - touch.contact.distance);
        let depth = depths.fold(0.0, f64::max);
        moved.missing_room = moved.missing_room.max(depth);
        moved.penetration = (depth - path.body.margin).max(0.0);
    }

    fn find_way(&mut self, path: &Path) -> Moved {
        self.memory.lacking = 0.0;
        self.memory.passed.clear();
        self.memory.half_spaces.clear();
        self.memory.walls.clear();
        self.memory.yielding_walls.clear();
        self.memory.characters_yield = false;
        self.memory.touched.clear();
        self.memory.velocities.clear();
        let mut moved = Moved {
            position: path.target,
            missing_room: 0.0,
            penetration: 0.0,
            rounds: 0,
            is_clear: true,
        };
        if !path.is_finite() {
            moved.position = path.start;
            moved.is_clear = false;
            return moved;
        }
        self.keep_arm(path, &mut moved);
        let near = path.body.margin * NEAR;
        let touch = TOUCH * path.body.radius;
        // The position up to which the way is known to be clear.
        let mut clear_to: Option<DVec3> = None;
        loop {
            moved.rounds += 1;
            if clear_to.is_none_or(|clear_to| moved.position.distance(clear_to) > near) {
                clear_to = None;
                if path.begin == Begin::Start && self.meet(path, &mut moved) {
                    if moved.rounds < ROUNDS {
                        continue;
                    }
                    moved.is_clear = false;
                    self.stop(path, &mut moved);
                }
            }
            let before = moved.position;
            let from = *clear_to.get_or_insert(before);
            let pushes = self.push_out(path, &mut moved);
            // A single push leads straight off its contact. Several pushes change each other's contacts, so the
            // contacts are searched anew, unless the body has no room.
            let is_settled = pushes < 2 || moved.position.distance(before) <= touch;
            let is_there = is_settled || moved.missing_room > touch;
            let is_near = moved.position.distance(from) <= near;
            if is_there && is_near || moved.rounds >= ROUNDS {
                return moved;
            }
        }
    }

    /// The contacts of the last movement, in the order in which they were found: those that the body touches at the
    /// end, and those that stopped it. A contact may be listed twice.
    pub fn touched(&self) -> &[MoverContact] {
        &self.memory.touched
    }

    /// Adds half-spaces for all obstacles that overlap the core at the start. The half-spaces move with the obstacles
    /// over the tick, so that the body gets no deeper.
    fn go_with_overlaps(&mut self, path: &Path, moved: &mut Moved) {
        let mut inside = std::mem::take(&mut self.memory.passed);
        inside.sort_unstable_by(MoverContact::order);
        inside.truncate(PUSHES);
        for (index, touch) in inside.iter().enumerate() {
            // The nearest contact of a face gives the body's depth; the others are inner edges of the face.
            let margin = path.body.margin;
            let continues =
                |nearer: &MoverContact| touch.continues(touch.contact.point, nearer, margin);
            let is_known = inside[..index].iter().any(continues);
            if is_known || Self::is_pressed_into(&path.body, touch) {
                continue;
            }
            let depth = path.body.radius - touch.contact.distance;
            if depth < self.characters().allowed(path, touch) {
                continue;
            }
            let motion = self.path_of(touch);
            let way = motion.map_or(DVec3::ZERO, |motion| {
                motion.position - motion.previous_position
            });
            self.add_half_space(path, *touch, touch.normal.dot(way), moved.position);
            self.know_velocity(motion.as_ref());
        }
        self.memory.passed = inside;
        self.solve(path, moved);
    }

    /// Sweeps to the wanted position and adds a half-space for the first contact. If the core started inside of
    /// obstacles, the first round adds half-spaces for these instead. False if no obstacle is in the way.
    fn meet(&mut self, path: &Path, moved: &mut Moved) -> bool {
        let way = moved.position - path.start;
        let hit = if moved.rounds == 1 {
            let hit = self.sweep_at_first(path, way);
            if !self.memory.passed.is_empty() {
                self.go_with_overlaps(path, moved);
                return true;
            }
            hit
        } else {
            self.sweep_from(path, way)
        };
        let Some(hit) = hit else {
            return false;
        };
        let touch = hit.contact;
        let motion = self.path_of(&touch);
        let end = motion.map_or(touch.contact.point, |motion| motion.position);
        let offset = self.characters().half_space_of_hit(path, &hit, way).offset;
        self.add_half_space(path, touch, offset, moved.position);
        self.know_velocity(motion.as_ref());
        self.solve(path, moved);
        if moved.missing_room > path.body.margin {
            // Every sweep would meet the contact that crushes the body, so later ones ignore it.
            let mut passed = touch;
            passed.contact.point = motion.map_or(end, |motion| motion.previous_position);
            self.memory.passed.push(passed);
        }
        true
    }

    /// The first contact along `way`. Contacts that the core starts inside of are ignored, and stored in `passed`.
    fn sweep_at_first(&mut self, path: &Path, way: DVec3) -> Option<SweepContact<MoverContact>> {
        let core = path.core();
        let mut inside = std::mem::take(&mut self.memory.passed);
        inside.clear();
        let characters = self.characters();
        let hit = self.sweep_where(&core, path.ways(way), |hit| {
            if hit.started_inside && hit.contact.is_finite() {
                inside.push(hit.contact);
            }
            !hit.started_inside && characters.stop(path, hit, way)
        });
        self.memory.passed = inside;
        hit
    }

    /// The first contact along `way`, except contacts that the core started inside of or is crushed by.
    fn sweep_from(&mut self, path: &Path, way: DVec3) -> Option<SweepContact<MoverContact>> {
        let core = path.core();
        let inside = std::mem::take(&mut self.memory.passed);
        let margin = path.body.margin;
        let (obstacles, dt) = (self.obstacles, self.dt());
        let characters = self.characters();
        let hit = self.sweep_past_overlaps(&core, path.ways(way), |hit| {
            if !characters.stop(path, hit, way) {
                return false;
            }
            let touch = &hit.contact;
            let mut of_its_face = inside
                .iter()
                .filter(|other| touch.is_on_face_of(other))
                .peekable();
            if of_its_face.peek().is_none() {
                return true;
            }
            let motion = path_among(obstacles, touch.obstacle, &touch.contact.material, dt);
            let start = motion.map_or(touch.contact.point, |motion| motion.previous_position);
            !of_its_face.any(|other| touch.continues(start, other, margin))
        });
        self.memory.passed = inside;
        hit
    }

    /// Stops the body at the sweep's first contact, and carries it along with the touched material for the rest of the
    /// tick.
    fn stop(&mut self, path: &Path, moved: &mut Moved) {
        let way = moved.position - path.start;
        if let Some(SweepContact {
            contact: touch,
            fraction,
            ..
        }) = self.sweep_from(path, way)
        {
            let end = self.path_of(&touch);
            let carried = end.map_or(DVec3::ZERO, |motion| motion.position - touch.contact.point);
            moved.position = path.start + way * fraction + carried;
        }
    }

    /// Pushes the body out of all obstacles that overlap it at its position. Returns the number of pushes.
    fn push_out(&mut self, path: &Path, moved: &mut Moved) -> usize {
        let body = &path.body;
        let found = moved.position;
        self.overlap(body, found, body.margin * NEAR);
        let touching = TOUCH * body.radius;
        let mut pushes = 0;
        while pushes < PUSHES {
            let capsule = body.at(moved.position);
            // The half-spaces are already relaxed by `missing_room`, so they allow this much more depth.
            let mut deepest = moved.missing_room + touching;
            let mut worst: Option<MoverContact> = None;
            let characters = self.characters();
            let way = moved.position - path.start;
            for touch in self.overlaps() {
                let now = touch.after_push(&capsule, moved.position - found);
                let depth = body.radius - now.contact.distance;
                let depth = characters.depth(path, &now, way, depth);
                if depth > deepest {
                    (deepest, worst) = (depth, Some(now));
                }
            }
            let Some(touch) = worst else {
                break;
            };
            self.keep_off(path, touch, moved.position);
            pushes += 1;
            let before = moved.position;
            self.solve(path, moved);
            if moved.position == before {
                break;
            }
        }
        if moved.missing_room > touching {
            self.touch_the_rest(path, moved, found);
        }
        let capsule = body.at(moved.position);
        let characters = self.characters();
        let way = moved.position - path.start;
        let depths = self.overlaps().iter().map(|touch| {
            let now = touch.after_push(&capsule, moved.position - found);
            characters.depth(path, &now, way, body.radius - now.contact.distance)
        });
        moved.penetration = (depths.fold(0.0, f64::max) - body.margin).max(0.0);
        pushes
    }

    /// Adds the contacts that overlap a crushed body no deeper than the others. They do not move the body, but count as
    /// touched.
    fn touch_the_rest(&mut self, path: &Path, moved: &Moved, found: DVec3) {
        let body = &path.body;
        let capsule = body.at(moved.position);
        for index in 0..self.overlaps().len() {
            let touch = self.overlaps()[index].after_push(&capsule, moved.position - found);
            let overlaps = body.radius - touch.contact.distance > TOUCH * body.radius;
            // One triangle of each face is enough.
            let is_known = self.touched().iter().any(|other| touch.pushes_like(other));
            if overlaps && !is_known && self.touched().len() < PUSHES {
                self.keep_off(path, touch, moved.position);
            }
        }
    }

    /// Adds a half-space that pushes a body at `position` out of a contact that overlaps it.
    fn keep_off(&mut self, path: &Path, touch: MoverContact, position: DVec3) {
        let depth = path.body.radius - touch.contact.distance;
        let offset = touch.normal.dot(position - path.start) + depth;
        self.add_half_space(path, touch, offset, position);
    }

    /// Adds a contact with its half-space. `position` is where the body would be without it.
    fn add_half_space(&mut self, path: &Path, touch: MoverContact, offset: f64, position: DVec3) {
        let half_space = MovePlane {
            normal: touch.normal,
            offset,
        };
        let wall = path.walking.and_then(|Walking { up, max_slope }| {
            let rise = touch.normal.dot(up);
            let level = (touch.normal - up * rise).normalize_or_zero();
            let lean = touch.normal.dot(level);
            let is_steep = rise < libm::cos(max_slope) && lean > 0.0;
            // A body does not walk up another character, however large that is.
            let is_no_step =
                || !self.is_step(&touch) || self.characters().has_beside(path, &touch, up);
            let is_wall = || is_steep || lean > FLUSH && is_no_step();
            // An upward face that is too steep to stand on, or that may not be stepped onto, counts as vertical.
            if !(rise > LEVEL && is_wall()) {
                return None;
            }
            let displacement = position - path.start;
            let into = offset - touch.normal.dot(displacement);
            Some(MovePlane {
                normal: level,
                offset: level.dot(displacement) + into / lean,
            })
        });
        self.add_contact(path, touch, half_space, wall);
    }

    fn solve(&mut self, path: &Path, moved: &mut Moved) {
        let margin = path.body.margin;
        // A crushed body stays crushed, however many half-spaces are added.
        if self.memory.lacking <= margin {
            let mut nearest = self.nearest_to_wanted(path);
            if nearest.missed > TOUCH * path.body.radius && self.leave_characters_out() {
                nearest = self.nearest_to_wanted(path);
            }
            (moved.position, moved.missing_room) = (path.start + nearest.point, nearest.missed);
            self.memory.lacking = nearest.missed;
        }
        if self.memory.lacking > margin {
            // The body stays where its frame carries it: its weight must not press it ever deeper, and walking must not
            // press it through a wall.
            let excess = self.memory.lacking - margin;
            let slip = SLIP * self.dt() * libm::sqrt(excess * margin);
            let nearest = self.nearest_displacement(path.frame, slip);
            (moved.position, moved.missing_room) = (path.start + nearest.point, nearest.missed);
        }
        self.keep_arm(path, moved);
    }

    fn nearest_to_wanted(&mut self, path: &Path) -> Projection {
        let wanted = path.target - path.start;
        let free = wanted.distance(path.frame);
        let memory = &mut *self.memory;
        let count = memory.half_spaces.len();
        memory.half_spaces.extend_from_slice(&memory.walls);
        memory.half_spaces.extend_from_slice(&memory.yielding_walls);
        let has_walls = memory.half_spaces.len() > count;
        let nearest = self.nearest_displacement(wanted, free);
        self.memory.half_spaces.truncate(count);
        if nearest.missed > TOUCH * path.body.radius && has_walls {
            // The walls leave no room: steep slopes on all sides hold the body up, as they do for a body that falls
            // between them.
            return self.nearest_displacement(wanted, free);
        }
        nearest
    }

    /// The displacement inside all half-spaces that is nearest to the wanted one, if it is near enough. For any gain of
    /// room the body moves up to `free` metres from the wanted displacement; beyond, each metre has to gain a quarter
    /// of a metre.
    ///
    /// Nearly opposite walls intersect many times as far away as they overlap. A body cannot slip out that far within a
    /// tick, so such walls crush it.
    fn nearest_displacement(&self, wanted: DVec3, free: f64) -> Projection {
        project_where_it_pays(wanted, &self.memory.half_spaces, free, STEEPEST_PUSH)
    }

    /// Keeps the body within the arm's reach, by half-spaces tangent to the ball of this reach where the body is. Walls
    /// take precedence: where walls and arm together leave no room, the arm gives way.
    fn keep_arm(&mut self, path: &Path, moved: &mut Moved) {
        let Some(arm) = path.arm else {
            return;
        };
        let count = self.memory.half_spaces.len();
        let without = *moved;
        for _ in 0..4 {
            let reach = moved.position - arm.pivot;
            if reach.length() <= arm.length * (1.0 + 1e-9) {
                break;
            }
            let inward = -reach.normalize_or(DVec3::Y);
            self.memory.half_spaces.push(MovePlane {
                normal: inward,
                offset: inward.dot(arm.pivot - path.start) - arm.length,
            });
            let aim = path.aim(moved);
            let nearest = self.nearest_displacement(aim, aim.distance(path.frame));
            if nearest.missed > without.missing_room + TOUCH * path.body.radius {
                *moved = without;
                break;
            }
            moved.position = path.start + nearest.point;
            moved.missing_room = nearest.missed;
        }
        self.memory.half_spaces.truncate(count);
    }
}

/// Maximum push, metres, per metre of room that it gains. Between walls within 29 degrees of opposite, a body does not
/// slip out, as if held by friction of 0.26. A larger value throws a body that is crushed by a few centimetres several
/// metres away, through obstacles in its way; a smaller one holds bodies that could slip out.
pub(crate) const STEEPEST_PUSH: f64 = 4.0;

/// Rate at which a crushed body slips to where there is more room, per second, however slowly the walls part there. The
/// speed is this rate times the geometric mean of the margin and of the missing room beyond the margin. A body that is
/// only just crushed does not slip, so that the threshold causes no jerk. The last of the missing room is gained in a
/// few ticks.
const SLIP: f64 = 60.0;

/// Maximum speed at which a crushed body leaves an overlap, radii a second: half a radius in a tick of 1/60 s.
const OUT: f64 = 30.0;

/// Slopes this close to vertical are walls already, and need no vertical wall: sine of the angle from the vertical.
const LEVEL: f64 = 1e-3;

/// A contact that may not be stepped onto becomes a wall only above this slope, as a sine. If nearly level ground
/// became a wall, it would push a body far aside. A ball rolls over edges up to a 400th of its radius unhindered.
const FLUSH: f64 = 0.07;
