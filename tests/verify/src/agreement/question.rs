use glam::Vec3;

/// A query of a posed surface with its arguments, in the surface's model space. Lengths are in model units and may be
/// infinite. Invalid arguments are allowed; the answer to them is empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Question {
    /// The first hit along a ray: at most one [`Found::Hit`](super::Found::Hit).
    CastRay(Line),
    /// Whether a ray hits the surface: one [`Found::Any`](super::Found::Any) if it does, otherwise no row.
    IntersectsRay(Line),
    /// All hits along a ray, by distance.
    CastRayAll(Line),
    /// The nearest point of the surface: at most one [`Found::Hit`](super::Found::Hit).
    ClosestPoint {
        /// The point.
        point: Vec3,
        /// Largest distance.
        max_distance: f32,
    },
    /// The point of the surface nearest to a capsule's segment: at most one [`Found::Hit`](super::Found::Hit).
    ClosestToCapsule {
        /// The capsule.
        shape: Shape,
        /// Largest distance from the capsule's outside.
        max_distance: f32,
    },
    /// All triangles that overlap a capsule, each with its point nearest to the segment, by id.
    OverlapCapsule {
        /// The capsule.
        shape: Shape,
    },
    /// The first contact of a moving capsule: at most one [`Found::Contact`](super::Found::Contact).
    CastCapsule {
        /// The capsule and its motion.
        cast: Cast,
        /// Which contacts count.
        among: Among,
    },
    /// The first contact of a moving capsule with every triangle, by time.
    CastCapsuleAll {
        /// The capsule and its motion.
        cast: Cast,
    },
    /// The triangles that touch a box now or did so a tick ago: one [`Found::Triangle`](super::Found::Triangle) each,
    /// by id.
    VisitBox {
        /// Corner of the box with the smallest coordinates.
        low: Vec3,
        /// Corner of the box with the largest coordinates.
        high: Vec3,
    },
}

/// A ray, and how far it goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Start of the ray.
    pub origin: Vec3,
    /// Direction of the ray, of any length.
    pub direction: Vec3,
    /// Largest distance of a hit.
    pub max_distance: f32,
}

/// A capsule; a ball if both ends are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Ends of the segment.
    pub ends: [Vec3; 2],
    /// Distance of the capsule's outside from the segment.
    pub radius: f32,
}

/// A moving capsule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cast {
    /// The capsule at time 0.
    pub shape: Shape,
    /// Displacement of each end from time 0 to time 1.
    pub displacements: [Vec3; 2],
    /// True if the surface moves meanwhile, from its last pose to its current one.
    pub moving: bool,
    /// Largest gap that counts as a contact; `None` for the query's default.
    pub tolerance: Option<f64>,
}

/// Which contacts of a cast count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Among {
    /// All of them.
    All,
    /// Contacts with triangles that the capsule does not overlap at the start.
    OutsideAtStart,
    /// Contacts with triangles whose id is a multiple of three.
    EveryThirdTriangle,
}

impl Question {
    /// The three questions about one ray: its first hit, whether it has a hit, and all its hits.
    pub fn along_ray(origin: Vec3, direction: Vec3, max_distance: f32) -> [Self; 3] {
        let line = Line {
            origin,
            direction,
            max_distance,
        };
        [
            Self::CastRay(line),
            Self::IntersectsRay(line),
            Self::CastRayAll(line),
        ]
    }
}

impl Shape {
    /// A ball.
    pub fn ball(center: Vec3, radius: f32) -> Self {
        Self {
            ends: [center; 2],
            radius,
        }
    }
}

impl Among {
    /// True if a contact counts.
    pub fn counts(self, triangle: u32, started_inside: bool) -> bool {
        match self {
            Self::All => true,
            Self::OutsideAtStart => !started_inside,
            Self::EveryThirdTriangle => triangle.is_multiple_of(3),
        }
    }
}
