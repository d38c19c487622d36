//! An obstacle of the game's own: triangles in f64, tested one by one.
//!
//! The obstacle has no f32, so differences between moving frames are the climber's own rounding: at most a micrometre.
//! Corners move on straight lines over a tick, as the corners of a skin do.

use clamber_surface::geometry::{MovingCapsule, TriangleContact};
use clamber_world::{
    Contact, MaterialPoint, Obstacle, PointMotion, SurfaceKind, SurfaceTag, SweepContact,
    TargetMotion, WorldCapsule,
};
use glam::{DMat3, DQuat, DVec3};

/// The corners' positions at a time, relative to the scene.
pub(crate) type Corners = Box<dyn Fn(f64) -> Vec<DVec3>>;

/// Moving triangles.
pub(crate) struct Own {
    corners: Corners,
    triangles: Vec<[u32; 3]>,
    /// The tag of all triangles.
    pub(crate) tag: SurfaceTag,
    /// Largest distance before contact at which a sweep may stop, metres: a hundredth of the allowed difference between
    /// frames.
    tolerance: f64,
    before: Vec<DVec3>,
    now: Vec<DVec3>,
    /// Displacement of the first corner over the tick.
    went: DVec3,
    /// Bounding box of each triangle over the tick, relative to `went`.
    boxes: Vec<[DVec3; 2]>,
}

impl Own {
    pub(crate) fn new(
        corners: Corners,
        triangles: Vec<[u32; 3]>,
        kind: SurfaceKind,
        scale: f64,
    ) -> Self {
        Self {
            corners,
            triangles,
            tag: SurfaceTag::new(kind),
            tolerance: 1e-8 * scale,
            before: Vec::new(),
            now: Vec::new(),
            went: DVec3::ZERO,
            boxes: Vec::new(),
        }
    }

    /// Moves the corners to their positions at a time. `world` maps points of the scene to the world.
    pub(crate) fn advance(&mut self, time: f64, world: impl Fn(DVec3) -> DVec3) {
        let corners = (self.corners)(time).into_iter().map(world);
        self.before = core::mem::replace(&mut self.now, corners.collect());
        if self.before.is_empty() {
            self.before.clone_from(&self.now);
        }
        self.went = self.now[0] - self.before[0];
        let went = self.went;
        let ways = self.triangles.iter().map(|triangle| {
            let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
            for corner in triangle {
                let (then, now) = (self.before[*corner as usize], self.now[*corner as usize]);
                for point in [then + went, now] {
                    bounds = [bounds[0].min(point), bounds[1].max(point)];
                }
            }
            bounds
        });
        self.boxes = ways.collect();
    }

    fn of(&self, triangle: usize, places: &[DVec3]) -> [DVec3; 3] {
        self.triangles[triangle].map(|corner| places[corner as usize])
    }

    /// Triangles that may be within `reach` of the points' bounding box, relative to their final positions.
    fn near(&self, points: &[DVec3], reach: f64) -> impl Iterator<Item = usize> {
        let low = points.iter().copied().reduce(DVec3::min);
        let high = points.iter().copied().reduce(DVec3::max);
        let low = low.unwrap_or(DVec3::NAN) - reach;
        let high = high.unwrap_or(DVec3::NAN) + reach;
        let boxes = self.boxes.iter().enumerate();
        boxes
            .filter(move |(_, [from, to])| from.cmple(high).all() && to.cmpge(low).all())
            .map(|(triangle, _)| triangle)
    }

    fn contact(&self, triangle: usize, touch: &TriangleContact) -> Contact {
        Contact {
            point: touch.point,
            normal: touch.normal.unwrap_or(touch.separation_normal),
            distance: touch.distance,
            material: MaterialPoint {
                key: triangle as u64,
                coordinates: touch.barycentric.to_array(),
            },
            tag: self.tag,
        }
    }

    /// The first contact with triangles that move from `before` to their current positions. Among contacts at the same
    /// time, the nearest, then the one with the smallest index. Only contacts that `counts` accepts are considered.
    fn first(
        &self,
        path: &MovingCapsule,
        target: TargetMotion,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        let (before, went) = match target {
            TargetMotion::Still => (&self.now, DVec3::ZERO),
            TargetMotion::Moving => (&self.before, self.went),
        };
        let [a, b] = path.start.map(|end| end + went);
        let ends = [a, b, path.end[0], path.end[1]];
        let mut first: Option<SweepContact> = None;
        // The tolerance, plus the rounding of the boxes.
        let reach = path.radius + self.tolerance * 4.0;
        for triangle in self.near(&ends, reach) {
            let limit = first.map_or(1.0, |first| first.fraction);
            let corners = [self.of(triangle, before), self.of(triangle, &self.now)];
            let Some(touch) = path.cast_at_triangle(corners, self.tolerance, limit) else {
                continue;
            };
            let sooner = first.is_none_or(|first| {
                (touch.fraction, touch.distance) < (first.fraction, first.contact.distance)
            });
            let sweep = SweepContact {
                fraction: touch.fraction,
                contact: self.contact(triangle, &touch),
                separation_normal: touch.separation_normal,
                started_inside: touch.started_inside,
            };
            if sooner && counts(&sweep) {
                first = Some(sweep);
            }
        }
        first
    }

    /// Two edges and the frame that they define; no frame if the triangle has collapsed.
    fn frame([a, b, c]: [DVec3; 3]) -> ([DVec3; 2], Option<DQuat>) {
        let edges = [b - a, c - a];
        let normal = edges[0].cross(edges[1]).try_normalize();
        let along = edges[0].try_normalize();
        let frame = normal.zip(along).map(|(normal, along)| {
            DQuat::from_mat3(&DMat3::from_cols(along, normal, along.cross(normal))).normalize()
        });
        (edges, frame)
    }
}

/// Principal stretches between two pairs of edges: square roots of the eigenvalues of one pair's metric relative to the
/// other's.
fn stretches([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> [f64; 2] {
    let (p, q, r) = (a.length_squared(), a.dot(b), b.length_squared());
    let (x, y, z) = (c.length_squared(), c.dot(d), d.length_squared());
    let area = p * r - q * q;
    if area <= 0.0 {
        return [1.0; 2];
    }
    let half = (r * x - 2.0 * q * y + p * z) / area * 0.5;
    let product = ((x * z - y * y) / area).max(0.0);
    let apart = libm::sqrt((half * half - product).max(0.0));
    [half + apart, half - apart].map(|square| libm::sqrt(square.max(0.0)))
}

fn path(capsule: &WorldCapsule, displacements: [DVec3; 2]) -> MovingCapsule {
    MovingCapsule {
        start: capsule.ends,
        end: capsule.with_ends_moved(displacements).ends,
        radius: capsule.radius,
    }
}

impl Obstacle for Own {
    fn bounds(&self) -> Option<(DVec3, f64)> {
        let places = self.before.iter().chain(&self.now);
        let center = places.clone().sum::<DVec3>() / (self.now.len() * 2) as f64;
        let radius = places
            .map(|place| place.distance(center))
            .fold(0.0, f64::max);
        Some((center, radius * (1.0 + 1e-9)))
    }

    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        let along = direction.try_normalize()?;
        let mut first: Option<Contact> = None;
        for triangle in 0..self.triangles.len() {
            // Möller and Trumbore 1997, from both sides.
            let [a, b, c] = self.of(triangle, &self.now);
            let (u, v) = (b - a, c - a);
            let across = along.cross(v);
            let volume = u.dot(across);
            let from = origin - a;
            let second = from.dot(across) / volume;
            let third = along.dot(from.cross(u)) / volume;
            let distance = v.dot(from.cross(u)) / volume;
            let inside = second >= 0.0 && third >= 0.0 && second + third <= 1.0;
            let limit = first.map_or(max_distance, |first| first.distance);
            let sooner = first.is_none() || distance < limit;
            if inside && (0.0..=limit).contains(&distance) && sooner {
                first = Some(Contact {
                    point: origin + along * distance,
                    normal: u.cross(v).normalize_or(-along),
                    distance,
                    material: MaterialPoint {
                        key: triangle as u64,
                        coordinates: [1.0 - second - third, second, third],
                    },
                    tag: self.tag,
                });
            }
        }
        first
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        let ball = MovingCapsule::ball(point, DVec3::ZERO, 0.0);
        let mut best: Option<Contact> = None;
        for triangle in 0..self.triangles.len() {
            let touch = ball.nearest_of_triangle(self.of(triangle, &self.now))?;
            let nearer = best.is_none_or(|best| touch.distance < best.distance);
            if nearer && touch.distance <= max_distance {
                best = Some(self.contact(triangle, &touch));
            }
        }
        best
    }

    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        let path = path(capsule, [DVec3::ZERO; 2]);
        for triangle in self.near(&capsule.ends, capsule.radius) {
            let touch = path.nearest_of_triangle(self.of(triangle, &self.now));
            if let Some(touch) = touch.filter(|touch| touch.distance <= capsule.radius) {
                contacts.push(self.contact(triangle, &touch));
            }
        }
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        self.first(&path(capsule, displacements), target, &mut |_| true)
    }

    fn cast_capsule_where(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        self.first(&path(capsule, displacements), target, counts)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let triangle = usize::try_from(point.key).ok()?;
        if triangle >= self.triangles.len() || dt <= 0.0 {
            return None;
        }
        let (then, now) = (
            self.of(triangle, &self.before),
            self.of(triangle, &self.now),
        );
        let [a, b, c] = point.coordinates;
        let at = |corners: [DVec3; 3]| corners[0] * a + corners[1] * b + corners[2] * c;
        let (edges_then, frame_then) = Self::frame(then);
        let (edges, frame) = Self::frame(now);
        let turn = frame.zip(frame_then);
        let stretches = stretches(edges_then, edges);
        let (position, previous_position) = (at(now), at(then));
        Some(PointMotion {
            position,
            previous_position,
            velocity: (position - previous_position) / dt,
            was_teleported: position == previous_position,
            frame,
            turn: turn.map_or(DQuat::IDENTITY, |(now, then)| {
                (now * then.conjugate()).normalize()
            }),
            area_ratio: stretches[0] * stretches[1],
            stretches,
        })
    }
}
