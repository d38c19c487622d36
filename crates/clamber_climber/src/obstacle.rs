//! A climber as an obstacle to other climbers.

use clamber_world::{
    CharacterBody, Contact, Continuity, MaterialPoint, Obstacle, ObstacleId, Others, PointMotion,
    SurfaceTag, SweepContact, TargetMotion, WorldCapsule,
};
use glam::DVec3;

use crate::Climber;
use crate::step::CONTINUOUS_GAP;

/// Maximum number of steps of a sweep. Capsules that pass each other take a few, capsules that just graze a few dozen.
const MAX_SWEEP_STEPS: u32 = 64;

/// Distance between the axes of two bodies, as a fraction of their radii, below which they are at one place, and do not
/// stop each other.
pub(crate) const SAME_PLACE: f64 = 1e-7;

/// Cosine from up of a contact normal, below which the contact is on a climber's side: 60 degrees, where no climber
/// stands.
const SIDE_COSINE: f64 = 0.5;

/// A climber as an obstacle to other climbers, for one tick: a solid capsule that is where its support carries it.
///
/// Make the obstacles of all climbers before any of them is stepped, and give each climber the obstacles of the others
/// ([`ClimberGroup`](crate::ClimberGroup) does). Then the results do not depend on the order, or the threads, in which
/// they are stepped.
///
/// Climbers stand on each other. They stop, push or pass each other ([`Others`](crate::Others)), and never crush each
/// other. The climber's own movement in this tick is unknown when its obstacle is made. So the obstacle makes this
/// movement one tick later, and does not push by itself: with [`Others::Push`](crate::Others::Push), the two bodies
/// overlap, and each moves apart from the other when it is stepped.
///
/// The obstacle's velocity is the velocity of the climber's support, plus the climber's own velocity as far as that
/// moves away from the contact. So a climber that follows another one keeps pace, two climbers that fall together meet
/// at their relative speed, and two that run into each other stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClimberObstacle {
    /// The capsule at the tick's end, in world space.
    now: WorldCapsule,
    /// Displacement of the capsule over the tick, metres.
    way: DVec3,
    /// True if the support was teleported, or the body does not move.
    placed: bool,
    /// The capsule after the climber's own last tick, in world space.
    before: WorldCapsule,
    /// Unit vector that points up for the climber.
    up: DVec3,
    /// Velocity of the climber's support, or of its frame in the air, metres a second.
    base: DVec3,
    /// The climber's own velocity, relative to `base`, metres a second.
    own: DVec3,
    /// Mass, kg.
    mass: f64,
    /// The climber's own velocity in its last tick, relative to its support, metres a second.
    walk: DVec3,
    /// Whether the climber blocks, pushes or passes others.
    others: Others,
    /// The lowest of the climbers that this one stands on or holds, directly or through others.
    carried_by: Option<ObstacleId>,
}

/// The nearest points of two capsules' axes.
pub(crate) struct Apart {
    /// Unit vector from this body's axis to the other's; where the axes meet, a vector perpendicular to this body's
    /// axis.
    pub(crate) away: DVec3,
    /// Distance between the axes, metres.
    pub(crate) distance: f64,
    /// The nearest point on this body's axis.
    on_axis: DVec3,
    /// The nearest point on the other's axis, as a share of its length from its first end.
    on_other: f64,
}

impl ClimberObstacle {
    /// The obstacle of a climber for the next tick of `dt` seconds. Call it before the climber is stepped, when
    /// `obstacles` are in their state at the tick's end. Only the climber's support is queried. If that is another
    /// climber, make the other's obstacle first and include it in `obstacles`.
    pub fn new(climber: &Climber, obstacles: &[(ObstacleId, &dyn Obstacle)], dt: f64) -> Self {
        let id = climber.state().support.map(|on| on.attachment.obstacle);
        let on = obstacles.iter().find(|(other, _)| Some(*other) == id);
        Self::on(climber, on.map(|(_, obstacle)| *obstacle), dt)
    }

    /// The obstacle of a climber on its support; `None` if it has no support, or the support is gone.
    pub(crate) fn on(climber: &Climber, support: Option<&dyn Obstacle>, dt: f64) -> Self {
        let (state, config) = (climber.state(), climber.config());
        let begin = state.position - state.own_way;
        let own = state.velocity - state.base_velocity;
        let mut attachment = state.support.map(|support| support.attachment);
        let slack = CONTINUOUS_GAP * config.body.radius;
        let followed = support.and_then(|obstacle| {
            let attachment = attachment.as_mut()?;
            let followed = attachment.follow(obstacle, dt, slack)?;
            let carried = followed.motion.is_finite();
            carried.then(|| (attachment.position(), followed))
        });
        let carried_by = support.zip(attachment).and_then(|(below, attachment)| {
            let below = below.character()?;
            Some(below.carried_by.unwrap_or(attachment.obstacle))
        });
        let body = climber.body();
        let to = |position: DVec3| body.moved(position - state.position);
        match followed {
            Some((position, followed)) => {
                let placed = followed.continuity == Continuity::Teleported;
                let begin = if placed { position } else { begin };
                Self {
                    now: to(position),
                    way: position - begin,
                    placed: placed || position == begin,
                    before: body,
                    up: config.up(),
                    base: followed.motion.velocity,
                    own: followed.motion.turn * own,
                    mass: config.body.mass,
                    walk: own,
                    others: config.body.others,
                    carried_by,
                }
            }
            None => {
                let position = state.position + state.own_displacement(config, dt);
                Self {
                    now: to(position),
                    way: position - begin,
                    placed: position == begin,
                    before: body,
                    up: config.up(),
                    base: state.base_velocity,
                    own: own + state.fall(config) * dt,
                    mass: config.body.mass,
                    walk: own,
                    others: config.body.others,
                    carried_by,
                }
            }
        }
    }

    /// The obstacle of a climber that falls although it has a support.
    pub(crate) fn falling(climber: &Climber, dt: f64) -> Self {
        let (state, gravity) = (climber.state(), climber.config().gravity);
        let position = state.position + (state.velocity + gravity * (0.5 * dt)) * dt;
        let begin = state.position - state.own_way;
        let body = climber.body();
        Self {
            now: body.moved(position - state.position),
            way: position - begin,
            placed: position == begin,
            own: state.velocity - state.base_velocity + gravity * dt,
            ..Self::on(climber, None, dt)
        }
    }

    /// Centre and radius of a ball around the body in the whole tick.
    pub(crate) fn ball(&self) -> (DVec3, f64) {
        let (middle, radius) = self.now.bounding_ball();
        (middle - self.way * 0.5, radius + self.way.length() * 0.5)
    }

    fn contact(&self, apart: &Apart) -> Contact {
        let point = apart.on_axis + apart.away * self.now.radius;
        Contact {
            point,
            normal: apart.away,
            distance: apart.distance - self.now.radius,
            material: self.material(apart),
            tag: SurfaceTag::default(),
        }
    }

    /// The material point of a contact: on the ball about one end of the axis. The key is the index of this end, and
    /// the coordinates are relative to it, in radii. So a climber that stands on another one's head stays there when
    /// the other crouches, stands up, or is resized.
    fn material(&self, apart: &Apart) -> MaterialPoint {
        let [low, high] = self.now.ends.map(|end| end.distance_squared(apart.on_axis));
        let is_above = apart.away.dot(self.up) > 0.0;
        let key = u64::from(high < low || high == low && is_above);
        let end = self.now.ends[key as usize];
        let from_end = apart.on_axis - end + apart.away * self.now.radius;
        MaterialPoint {
            key,
            coordinates: (from_end / self.now.radius).to_array(),
        }
    }

    /// The part of the climber's own velocity with which its surface moves away from a contact at `point`: above, its
    /// fall; on its sides, the level part away from the contact. With all of its velocity, two climbers that run into
    /// each other would swap velocities, as balls do, and a climber on top of another would feel each of its steps.
    fn receding(&self, point: DVec3) -> DVec3 {
        let out = (point - self.now.nearest_on_axis(point)).normalize_or_zero();
        let (rise, high) = (self.own.dot(self.up), out.dot(self.up));
        let fall = if high > 0.0 { rise.min(0.0) } else { 0.0 };
        let side = if high < SIDE_COSINE {
            (out - self.up * high).normalize_or_zero()
        } else {
            DVec3::ZERO
        };
        self.up * fall + side * self.own.dot(side).min(0.0)
    }

    /// The first contact of a capsule whose ends move by `ways`, with this body at rest at its position at the tick's
    /// end.
    fn meet(&self, capsule: &WorldCapsule, ways: [DVec3; 2]) -> Option<SweepContact> {
        let sum = self.now.radius + capsule.radius;
        if !capsule.is_valid() || !ways.iter().all(|way| way.is_finite()) {
            return None;
        }
        let mut time = 0.0;
        for step in 0..=MAX_SWEEP_STEPS {
            let moved = capsule.with_ends_moved(ways.map(|way| way * time));
            let apart = between(&self.now, &moved);
            let gap = apart.distance - sum;
            if apart.distance <= SAME_PLACE * sum {
                // The two bodies have no direction of separation in common.
                return None;
            }
            let there = ways[0].lerp(ways[1], apart.on_other);
            let is_near = gap <= capsule.sweep_tolerance();
            let touches = gap <= 0.0 || is_near && apart.away.dot(there) < 0.0;
            // The plane between both bodies separates them until one end of the capsule reaches it.
            let gets_there = |(end, way): (DVec3, DVec3)| {
                let closing = -apart.away.dot(way);
                let left = apart.away.dot(end - apart.on_axis) - sum;
                (closing > 0.0).then(|| left.max(gap) / closing)
            };
            let ends = moved.ends.into_iter().zip(ways).filter_map(gets_there);
            let next = time + ends.fold(f64::INFINITY, f64::min);
            if !touches && next > 1.0 {
                return None;
            }
            // At the last step a contact is reported rather than missed, so that no contact is late.
            if touches || step == MAX_SWEEP_STEPS {
                return Some(SweepContact {
                    fraction: time,
                    contact: self.contact(&apart),
                    separation_normal: apart.away,
                    started_inside: step == 0 && gap <= 0.0,
                });
            }
            time = next;
        }
        None
    }
}

/// The nearest points of two capsules' axes (Ericson 2005, *Real-Time Collision Detection*, 5.1.9).
pub(crate) fn between(body: &WorldCapsule, other: &WorldCapsule) -> Apart {
    let ([a, b], [c, d]) = (body.ends, other.ends);
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, vv, uv) = (u.length_squared(), v.length_squared(), u.dot(v));
    let share = |x: f64, y: f64| {
        if y > 0.0 {
            (x / y).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    let crossed = uu * vv - uv * uv;
    let first = share(uv * v.dot(w) - vv * u.dot(w), crossed);
    let on_other = share(v.dot(w + u * first), vv);
    let first = share(u.dot(v * on_other - w), uu);
    let on_axis = a + u * first;
    let between = c + v * on_other - on_axis;
    let away = between.try_normalize().unwrap_or_else(|| {
        let aside = u.cross(v);
        aside
            .try_normalize()
            .unwrap_or(u.any_orthogonal_vector().normalize_or(DVec3::X))
    });
    Apart {
        away,
        distance: between.length(),
        on_axis,
        on_other,
    }
}

impl Obstacle for ClimberObstacle {
    fn bounds(&self) -> Option<(DVec3, f64)> {
        Some(self.ball())
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        let contact = self.contact(&between(&self.now, &WorldCapsule::ball(point, 0.0)));
        let is_within = max_distance >= 0.0 && contact.distance <= max_distance;
        is_within.then_some(contact)
    }

    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        let apart = between(&self.now, capsule);
        let contact = self.contact(&apart);
        let is_elsewhere = apart.distance > SAME_PLACE * (self.now.radius + capsule.radius);
        if capsule.is_valid() && is_elsewhere && contact.distance <= capsule.radius {
            contacts.push(contact);
        }
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        if target == TargetMotion::Still {
            return self.meet(capsule, displacements);
        }
        // Swept in the frame of this body, in which it is at rest at its final position.
        let ways = displacements.map(|way| way - self.way);
        let mut hit = self.meet(&capsule.moved(self.way), ways)?;
        hit.contact.point -= self.way * (1.0 - hit.fraction);
        Some(hit)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let end = self.now.ends.get(usize::try_from(point.key).ok()?)?;
        let position = *end + DVec3::from_array(point.coordinates) * self.now.radius;
        let usable = dt > 0.0 && position.is_finite();
        usable.then(|| PointMotion {
            velocity: self.base + self.receding(position),
            was_teleported: self.placed,
            ..PointMotion::translated(position - self.way, position, dt)
        })
    }

    fn character(&self) -> Option<CharacterBody> {
        // A body that was teleported counts as having been there before.
        let capsule = if self.placed { self.now } else { self.before };
        Some(CharacterBody {
            capsule,
            way: self.now.ends[0] - capsule.ends[0],
            mass: self.mass,
            own_velocity: self.walk,
            others: self.others,
            carried_by: self.carried_by,
        })
    }
}

#[cfg(test)]
mod tests;
