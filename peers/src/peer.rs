use std::error::Error;
use std::sync::Arc;

use clamber_surface::geometry::{Ray, Sphere};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::Palette;
use glam::{DVec3, Vec3};

use crate::skin::Skin;

/// Error: the peer has no such query.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unsupported;

/// The answer of a peer to a query that it may not support.
pub type Answer<T> = Result<T, Unsupported>;

/// A kind of query.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// [`Peer::cast_ray`].
    Ray,
    /// [`Peer::overlap_sphere`].
    Overlap,
    /// [`Peer::closest_point`].
    Closest,
    /// [`Peer::cast_sphere`].
    Cast,
}

impl Kind {
    /// All kinds, with their names in tables.
    pub const ALL: [(Self, &str); 4] = [
        (Self::Ray, "ray"),
        (Self::Overlap, "overlap"),
        (Self::Closest, "closest point"),
        (Self::Cast, "sphere cast"),
    ];
}

/// The first hit of a ray on the skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Distance from the ray's origin.
    pub distance: f32,
    /// The triangle of the collider that the ray hits.
    pub triangle: TriangleId,
}

/// The point of the skin closest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The closest point, in world space.
    pub point: Vec3,
    /// Distance of that point, as the peer returns it or computed from `point`.
    pub distance: f32,
}

/// One way of answering queries on an animated skin. All arguments and answers are in world space, which is model space
/// moved by the `place` of [`Peer::update`].
pub trait Peer {
    /// Takes a pose, and moves the model's origin to `place`. Most peers skin all vertices and refit.
    ///
    /// # Errors
    /// If the palette does not fit the collider, or the peer cannot take the positions.
    fn update(&mut self, palette: &Palette, place: DVec3) -> Result<(), Box<dyn Error>>;

    /// The first triangle along a ray, from either side.
    ///
    /// # Errors
    /// [`Unsupported`], as for the other queries.
    fn cast_ray(&mut self, ray: &Ray, max_distance: f32) -> Answer<Option<RayHit>>;

    /// Number of triangles that touch a sphere.
    ///
    /// # Errors
    /// As [`Peer::cast_ray`].
    fn overlap_sphere(&mut self, sphere: &Sphere) -> Answer<usize>;

    /// The point of the skin closest to a point, if it is within a distance.
    ///
    /// # Errors
    /// As [`Peer::cast_ray`].
    fn closest_point(&mut self, point: Vec3, max_distance: f32) -> Answer<Option<Nearest>>;

    /// The share of a sphere's motion, 0 to 1, before it touches the skin, which does not move. `None` if it does not
    /// touch the skin.
    ///
    /// # Errors
    /// As [`Peer::cast_ray`]; always for a peer without such a query.
    fn cast_sphere(&mut self, _sphere: &Sphere, _motion: Vec3) -> Answer<Option<f32>> {
        Err(Unsupported)
    }

    /// The positions that the peer gets in each pose; `None` for clamber, which skins by itself.
    fn skin(&self) -> Option<&Skin> {
        None
    }

    /// Position of a point of the skin, and its displacement since the last pose.
    fn motion(&mut self, triangle: TriangleId, barycentric: [f32; 3]) -> (Vec3, Vec3) {
        let skin = self.skin();
        skin.map_or((Vec3::NAN, Vec3::NAN), |skin| {
            skin.motion(triangle, barycentric)
        })
    }

    /// Memory of the peer in bytes, including the data that it skins from. `from_heap` is the heap memory that making
    /// the peer took, bytes.
    fn bytes(&self, from_heap: usize) -> usize {
        from_heap + self.skin().map_or(0, Skin::bytes_at_rest)
    }
}

/// A function that makes a peer.
pub type Make = fn(&Arc<ColliderMesh>) -> Result<Box<dyn Peer>, Box<dyn Error>>;

/// A peer's name in tables, and the function that makes it.
#[derive(Clone, Copy)]
pub struct Entry {
    /// The name in tables.
    pub name: &'static str,
    /// Makes the peer from a collider, at rest.
    pub make: Make,
}
