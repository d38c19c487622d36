//! Methods of keeping a sphere out of a moving limb.

use std::error::Error;
use std::sync::Arc;

use clamber_peers::mean_push_out;
use clamber_surface::geometry::{Capsule, Similarity};
use clamber_surface::mesh::ColliderMesh;
use clamber_surface::rig::Palette;
use clamber_surface::surface::{Anchor, CastOptions, SkinnedSurface, SurfaceError, SurfaceHit};
use clamber_world::{Contact, Obstacle};
use glam::{DVec3, Vec3};

use super::climbers::{Stance, Walker};
use super::limb::Course;

/// Number of sweeps, or of rounds over speculative planes, in a tick.
const ROUNDS: usize = 8;

/// Tolerance of a sweep, metres. After a contact, the sphere is moved away by this distance.
const TOLERANCE: f64 = 1e-4;

/// Options of a sweep.
const SWEEP: CastOptions = CastOptions::MOVING.with_tolerance(TOLERANCE);

/// A method of resolving the collisions of a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Method {
    /// The mean of all push-outs, at `steps` poses within the tick. The thesis's method has one step.
    PushOut { steps: u32 },
    /// A plane for each triangle that is near at the start of the tick; the plane moves with its contact point. Then a
    /// push-out.
    Speculative,
    /// Sweeps against the moving skin, with a plane for each contact; the plane moves with the skin. Then a push-out.
    Sweep,
    /// A whole climber instead of the test sphere. Its ball has the same radius.
    Climber(Stance),
}

/// Methods for spheres.
pub(crate) const SPHERES: [(Method, &str); 6] = [
    (Method::PushOut { steps: 1 }, "averaged push-out"),
    (Method::PushOut { steps: 2 }, "2 sub-steps"),
    (Method::PushOut { steps: 4 }, "4 sub-steps"),
    (Method::PushOut { steps: 8 }, "8 sub-steps"),
    (Method::Speculative, "speculative contacts"),
    (Method::Sweep, "sweeps"),
];

/// Climbers in the way of a swinging limb.
pub(crate) const STRUCK: [(Method, &str); 2] = [
    (Method::Climber(Stance::InAir), "climber, in the air"),
    (Method::Climber(Stance::OnGround), "climber, standing"),
];

/// Climbers on a heaving limb.
pub(crate) const RIDING: [(Method, &str); 2] = [
    (Method::Climber(Stance::OnLimb), "climber, standing"),
    (Method::Climber(Stance::Holding), "climber, holding"),
];

/// A sphere or a climber beside a limb.
pub(crate) struct Body {
    pub(crate) center: DVec3,
    radius: f64,
    /// The material point that the sphere rests on; `None` if it does not ride.
    anchor: Option<Anchor>,
    method: Method,
    walker: Option<Walker>,
    surface: SkinnedSurface,
    /// The limb a tick ago, for speculative contacts.
    before: SkinnedSurface,
    contacts: Vec<Contact>,
    hits: Vec<SurfaceHit>,
}

impl Body {
    pub(crate) fn new(
        mesh: &Arc<ColliderMesh>,
        method: Method,
        course: &Course,
        center: DVec3,
        radius: f64,
    ) -> Result<Self, Box<dyn Error>> {
        let walker = match method {
            Method::Climber(stance) => Some(Walker::new(stance, center)?),
            _ => None,
        };
        let mut body = Self {
            center,
            radius,
            anchor: None,
            method,
            walker,
            surface: SkinnedSurface::new(Arc::clone(mesh)),
            before: SkinnedSurface::new(Arc::clone(mesh)),
            contacts: Vec::new(),
            hits: Vec::new(),
        };
        let palette = course.palette(0.0);
        body.surface.teleport(&palette, Similarity::IDENTITY)?;
        body.before.teleport(&palette, Similarity::IDENTITY)?;
        Ok(body)
    }

    /// Radius of the ball that no skin may enter: a sphere's own radius, or a climber's radius less its contact margin.
    pub(crate) fn core(&self) -> f64 {
        self.walker.as_ref().map_or(self.radius, |walker| {
            let body = &walker.climber.config().body;
            body.radius - body.margin
        })
    }

    /// Lets the body rest from now on: a sphere on the nearest skin, a climber in its stance.
    pub(crate) fn rest(&mut self, dt: f64) -> Result<(), Box<dyn Error>> {
        if let Some(walker) = &mut self.walker {
            walker.settle(&self.surface, dt)?;
            self.center = walker.climber.state().position;
            return Ok(());
        }
        let space = self.surface.in_model();
        let hit = space.closest_point(self.center.as_vec3(), f32::INFINITY);
        let hit = hit.ok_or("no skin for a sphere to rest on")?;
        self.anchor = Some(self.surface.anchor_at(&hit)?);
        Ok(())
    }

    /// Runs the tick that starts at `time`.
    pub(crate) fn tick(
        &mut self,
        course: &Course,
        time: f64,
        dt: f64,
    ) -> Result<(), Box<dyn Error>> {
        match self.method {
            Method::PushOut { steps } => {
                let step = dt / f64::from(steps);
                for k in 1..=steps {
                    let palette = course.palette(time + step * f64::from(k));
                    self.pose(&palette)?;
                    self.center += self.carried(step)?;
                    self.push_out();
                }
            }
            Method::Speculative | Method::Sweep => {
                self.pose(&course.palette(time + dt))?;
                let wanted = self.carried(dt)?;
                let motion = if self.method == Method::Sweep {
                    self.sweep(wanted)?
                } else {
                    self.look_ahead(wanted)?
                };
                self.center += motion;
                self.push_out();
            }
            Method::Climber(_) => {
                self.pose(&course.palette(time + dt))?;
                if let Some(walker) = &mut self.walker {
                    walker.tick(&self.surface, dt)?;
                    self.center = walker.climber.state().position;
                }
            }
        }
        Ok(())
    }

    fn pose(&mut self, palette: &Palette) -> Result<(), SurfaceError> {
        self.surface.advance(palette, Similarity::IDENTITY)
    }

    /// The displacement by which the anchor's motion carries the sphere, rotation included.
    fn carried(&self, dt: f64) -> Result<DVec3, SurfaceError> {
        let Some(anchor) = &self.anchor else {
            return Ok(DVec3::ZERO);
        };
        let motion = self.surface.in_model().motion(anchor, dt)?;
        let (now, before) = (
            motion.position.as_dvec3(),
            motion.previous_position.as_dvec3(),
        );
        let spin = motion.angular_velocity.as_dvec3() * dt;
        let angle = spin.length();
        let arm = self.center - before;
        let turned = if angle > 0.0 {
            clamber_surface::geometry::rotation_from_axis_angle(spin / angle, angle) * arm
        } else {
            arm
        };
        Ok(now + turned - self.center)
    }

    fn push_out(&mut self) {
        self.contacts.clear();
        self.surface
            .overlap_sphere(self.center, self.radius, &mut self.contacts);
        let contacts = self.contacts.iter();
        let contacts =
            contacts.map(|contact| (contact.separation_normal(self.center), contact.distance));
        self.center += mean_push_out(contacts, self.radius);
    }

    /// The wanted motion, corrected to stay in front of the planes of all triangles that the sphere may reach.
    fn look_ahead(&mut self, wanted: DVec3) -> Result<DVec3, Box<dyn Error>> {
        // No skin reaches the sphere from farther away than the limb's fastest point moves.
        let reach = self.ball(self.radius + self.fastest() + wanted.length())?;
        self.before
            .in_model()
            .overlap_capsule(&reach, &mut self.hits);
        let mut planes = Vec::with_capacity(self.hits.len());
        for hit in &self.hits {
            let anchor = self.surface.anchor_at(hit)?;
            let motion = self.surface.in_model().motion(&anchor, 1.0)?;
            let away = (self.center - hit.point.as_dvec3()).normalize_or(hit.normal.as_dvec3());
            // A sphere behind the skin gets no plane: the plane would keep the sphere inside.
            if away.dot(hit.normal.as_dvec3()) > 0.0 {
                let gap = hit.distance - self.radius;
                planes.push((away, motion.velocity.as_dvec3().dot(away) - gap));
            }
        }
        let mut motion = wanted;
        for _ in 0..ROUNDS {
            for (away, least) in &planes {
                motion += *away * (least - motion.dot(*away)).max(0.0);
            }
        }
        Ok(motion)
    }

    /// A ball around the sphere's centre.
    fn ball(&self, radius: f64) -> Result<Capsule, &'static str> {
        Capsule::ball(self.center.as_vec3(), radius as f32).ok_or("a sphere is out of bounds")
    }

    /// The largest displacement of a point of the limb in this tick.
    fn fastest(&self) -> f64 {
        let space = self.surface.in_model();
        let mut fastest = 0.0_f64;
        // The limb is straight and rigid, so one of its ends moves fastest.
        for vertex in [0, self.surface.mesh().positions().len() - 1] {
            let vertex = clamber_surface::mesh::VertexId(vertex as u32);
            let ends = (space.position(vertex), space.previous_position(vertex));
            if let (Some(now), Some(before)) = ends {
                fastest = fastest.max(f64::from(now.distance(before)));
            }
        }
        fastest
    }

    /// The wanted motion, corrected until sweeps find no closing contact or the rounds are used up.
    fn sweep(&self, wanted: DVec3) -> Result<DVec3, Box<dyn Error>> {
        let space = self.surface.in_model();
        let ball = self.ball(self.radius)?;
        let mut motion = wanted;
        for _ in 0..ROUNDS {
            if !motion.as_vec3().is_finite() {
                return Err("a sphere's motion is out of bounds".into());
            }
            let Some(hit) = space.cast_capsule(&ball, [motion.as_vec3(); 2], &SWEEP) else {
                break;
            };
            let anchor = self.surface.anchor_at(&hit)?;
            let way: Vec3 = self.surface.in_model().motion(&anchor, 1.0)?.velocity;
            let normal = hit.separation_normal.as_dvec3();
            let closing = (way.as_dvec3() - motion).dot(normal);
            if closing <= 0.0 {
                break;
            }
            // From the contact on, the sphere moves with the skin. The correction is spread over the tick, so that the
            // motion stays linear.
            motion += normal * (closing * (1.0 - hit.fraction) + TOLERANCE);
        }
        Ok(motion)
    }

    /// Ends a tick that ends at `time`: the current limb becomes the limb a tick ago.
    pub(crate) fn end(&mut self, course: &Course, time: f64) -> Result<(), SurfaceError> {
        if self.method == Method::Speculative {
            self.before
                .advance(&course.palette(time), Similarity::IDENTITY)?;
        }
        Ok(())
    }
}
