use std::error::Error;
use std::sync::Arc;

use clamber_surface::geometry::{Ray, Sphere};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::Palette;
use glam::{DVec3, Vec3};

/// The peer has no such query.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unsupported;

/// What a peer answers, if it can.
pub type Answer<T> = Result<T, Unsupported>;

/// Where a ray meets the skin first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// From the ray's origin.
    pub distance: f32,
    /// Which triangle of the collider it meets.
    pub triangle: TriangleId,
}

/// The point of the skin nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// In world space.
    pub point: Vec3,
    /// As the peer has it, or from `point`.
    pub distance: f32,
}

/// One way of answering queries on an animated skin. All is in world space, whose origin is the model's moved by
/// the place of [`Peer::update`].
pub trait Peer {
    /// Takes a pose, and moves the model's origin to `place`: skins and refits, for most peers.
    ///
    /// # Errors
    /// If the palette is of another skeleton, or nothing that the peer can take.
    fn update(&mut self, palette: &Palette, place: DVec3) -> Result<(), Box<dyn Error>>;

    /// The first triangle along a ray, from either side.
    ///
    /// # Errors
    /// [`Unsupported`], as for the other queries.
    fn cast_ray(&mut self, ray: &Ray, max_distance: f32) -> Answer<Option<RayHit>>;

    /// How many triangles are within a sphere.
    ///
    /// # Errors
    /// As [`Peer::cast_ray`].
    fn overlap_sphere(&mut self, sphere: &Sphere) -> Answer<usize>;

    /// The point nearest to one, if it is within a distance.
    ///
    /// # Errors
    /// As [`Peer::cast_ray`].
    fn closest_point(&mut self, point: Vec3, max_distance: f32) -> Answer<Option<Nearest>>;

    /// The share of its motion that a sphere makes before it touches the skin, which stands still.
    ///
    /// # Errors
    /// As [`Peer::cast_ray`].
    fn cast_sphere(&mut self, sphere: &Sphere, motion: Vec3) -> Answer<Option<f32>>;

    /// Where a point of the skin is, and how far it has come since the pose before.
    fn motion(&mut self, triangle: TriangleId, barycentric: [f32; 3]) -> (Vec3, Vec3);

    /// All bytes that it needs, what it skins from included, where making it took `from_heap` from the heap.
    fn bytes(&self, from_heap: usize) -> usize;
}

/// How a peer is made.
pub type Make = fn(&Arc<ColliderMesh>) -> Result<Box<dyn Peer>, Box<dyn Error>>;

/// A peer's name in tables, and how to make it.
#[derive(Clone, Copy)]
pub struct Entry {
    /// In tables.
    pub name: &'static str,
    /// Of a collider, at rest.
    pub make: Make,
}
