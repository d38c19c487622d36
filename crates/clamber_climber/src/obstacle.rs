//! A climber as an obstacle to other climbers.

use clamber_world::{
    Contact, MaterialPoint, Obstacle, PointMotion, SurfaceTag, SweepContact, TargetMotion,
    WorldCapsule,
};
use glam::DVec3;

use crate::Climber;

/// Most steps of a sweep. Capsules that pass each other take a few, capsules that just graze a few dozen.
const STEPS: u32 = 64;

/// A climber as an obstacle to other climbers: for one tick, a solid capsule that keeps its velocity.
///
/// Make the obstacles of all climbers before any of them is stepped, and give each climber those of the others. Then
/// the results do not depend on the order, or the threads, in which they are stepped. Climbers stop each other but do
/// not push each other: the obstacle moves, but reports a velocity of zero.
///
/// ```
/// use clamber_climber::{Climber, ClimberObstacle, ClimberConfig, ClimberInput};
/// use clamber_world::{Obstacle, ObstacleId};
/// use glam::DVec3;
///
/// let dt = 1.0 / 60.0;
/// let at = |x| Climber::new(ClimberConfig::walker(), DVec3::new(x, 0.0, 0.0));
/// let mut climbers = [at(0.0)?, at(3.0)?];
///
/// let bodies: Vec<ClimberObstacle> = climbers.iter().map(|climber| ClimberObstacle::new(climber, dt)).collect();
/// for (index, climber) in climbers.iter_mut().enumerate() {
///     let others = bodies.iter().enumerate().filter(|(other, _)| *other != index);
///     let obstacles: Vec<(ObstacleId, &dyn Obstacle)> =
///         others.map(|(other, body)| (ObstacleId(100 + other as u64), body as &dyn Obstacle)).collect();
///     climber.step(&ClimberInput::default(), &obstacles, dt)?;
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClimberObstacle {
    /// The capsule at the tick's end if the climber keeps its velocity, in world space.
    now: WorldCapsule,
    /// Its displacement over the tick, metres.
    way: DVec3,
}

/// The nearest points of two capsules' axes.
struct Apart {
    /// Unit vector from this body's axis to the other's; where the axes meet, a vector perpendicular to this body's
    /// axis.
    away: DVec3,
    /// Distance between the axes, metres.
    distance: f64,
    /// The nearest point on this body's axis.
    on_axis: DVec3,
    /// The nearest point on the other's axis, as a share of its length from its first end.
    on_other: f64,
}

impl ClimberObstacle {
    /// The obstacle of a climber for the next tick of `dt` seconds; call it before the climber is stepped.
    pub fn new(climber: &Climber, dt: f64) -> Self {
        let way = climber.state().velocity * dt;
        Self {
            now: climber.body().moved(way),
            way,
        }
    }

    fn contact(&self, apart: &Apart) -> Contact {
        let point = apart.on_axis + apart.away * self.now.radius;
        Contact {
            point,
            normal: apart.away,
            distance: apart.distance - self.now.radius,
            material: MaterialPoint {
                key: 0,
                coordinates: (point - self.now.ends[0]).to_array(),
            },
            tag: SurfaceTag::default(),
        }
    }

    /// The first contact of a capsule whose ends move by `ways`, with this body at rest at its position at the tick's
    /// end.
    fn meet(&self, capsule: &WorldCapsule, ways: [DVec3; 2]) -> Option<SweepContact> {
        let sum = self.now.radius + capsule.radius;
        if !capsule.is_valid() || !ways.iter().all(|way| way.is_finite()) {
            return None;
        }
        let mut time = 0.0;
        for step in 0..=STEPS {
            let moved = capsule.with_ends_moved(ways.map(|way| way * time));
            let apart = between(&self.now, &moved);
            let gap = apart.distance - sum;
            let there = ways[0].lerp(ways[1], apart.on_other);
            let is_near = gap <= capsule.sweep_tolerance();
            let touches = gap <= 0.0 || is_near && apart.away.dot(there) < 0.0;
            // The plane between both separates them until one end of the capsule reaches it.
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
            if touches || step == STEPS {
                return Some(SweepContact {
                    time,
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
fn between(body: &WorldCapsule, other: &WorldCapsule) -> Apart {
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
    fn is_character(&self, _: &MaterialPoint) -> bool {
        true
    }

    fn bounds(&self) -> Option<(DVec3, f64)> {
        let (middle, radius) = self.now.bounding_ball();
        Some((middle - self.way * 0.5, radius + self.way.length() * 0.5))
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        let contact = self.contact(&between(&self.now, &WorldCapsule::ball(point, 0.0)));
        let is_within = max_distance >= 0.0 && contact.distance <= max_distance;
        is_within.then_some(contact)
    }

    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        let contact = self.contact(&between(&self.now, capsule));
        if capsule.is_valid() && contact.distance <= capsule.radius {
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
        // In the frame of this body, which is then at rest at its final position.
        let ways = displacements.map(|way| way - self.way);
        let mut hit = self.meet(&capsule.moved(self.way), ways)?;
        hit.contact.point -= self.way * (1.0 - hit.time);
        Some(hit)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let position = self.now.ends[0] + DVec3::from_array(point.coordinates);
        let usable = dt > 0.0 && position.is_finite();
        usable.then(|| PointMotion {
            // Otherwise two climbers that run into each other would swap their velocities, as balls do.
            velocity: DVec3::ZERO,
            placed: self.way == DVec3::ZERO,
            ..PointMotion::translated(position - self.way, position, dt)
        })
    }
}

#[cfg(test)]
mod tests;
