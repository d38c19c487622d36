//! PhysX 5.1: a triangle mesh without scene or actor, refitted each frame.

#![allow(unsafe_code, reason = "calls PhysX")]

mod mesh;

use std::error::Error;
use std::mem::MaybeUninit;
use std::ptr::null_mut;
use std::sync::Arc;

use clamber_surface::geometry::{Ray, Sphere};
use clamber_surface::mesh::ColliderMesh;
use clamber_surface::rig::Palette;
use glam::{DVec3, Vec3};
use physx_sys::{
    PxGeomRaycastHit, PxGeomSweepHit, PxGeometry, PxGeometryQuery_pointDistance,
    PxGeometryQuery_raycast, PxGeometryQuery_sweep, PxGeometryQueryFlags, PxHitFlags,
    PxMeshGeometryFlags, PxMeshQuery_findOverlapTriangleMesh, PxMeshScale, PxQuat,
    PxSphereGeometry_new, PxTransform, PxTriangleMeshGeometry, PxTriangleMeshGeometry_new, PxVec3,
};

use self::mesh::Mesh;
use crate::peer::{Answer, Entry, Nearest, Peer, RayHit};
use crate::skin::Skin;

/// The peer PhysX.
pub(crate) const ENTRIES: &[Entry] = &[Entry {
    name: "PhysX 5.1",
    make: |mesh| Ok(Box::new(PhysX::new(mesh)?)),
}];

/// The identity rotation.
const NO_ROTATION: PxQuat = PxQuat {
    x: 0.0,
    y: 0.0,
    z: 0.0,
    w: 1.0,
};

/// Flags of a query without a guard. A guard would save, set and restore the processor's rounding and flushing modes at
/// every query. Rust's modes are the modes that PhysX wants, except that subnormal numbers are not flushed.
const NO_GUARD: PxGeometryQueryFlags = PxGeometryQueryFlags::empty();

struct PhysX {
    mesh: Mesh,
    /// The geometry of `mesh`.
    geometry: PxTriangleMeshGeometry,
    /// Buffer for the triangles of an overlap; grows to the largest size needed.
    found: Vec<u32>,
    skin: Skin,
}

impl PhysX {
    fn new(mesh: &Arc<ColliderMesh>) -> Result<Self, Box<dyn Error>> {
        let skin = Skin::new(mesh);
        let mesh = Mesh::new(&skin.positions, &skin.triangles())?;
        let scale = PxMeshScale {
            scale: vector(Vec3::ONE),
            rotation: NO_ROTATION,
        };
        // SAFETY: the function only sets the fields: the pointer, and a copy of the scale.
        let geometry = unsafe {
            PxTriangleMeshGeometry_new(
                mesh.as_ptr(),
                &raw const scale,
                PxMeshGeometryFlags::DoubleSided,
            )
        };
        Ok(Self {
            mesh,
            geometry,
            found: vec![0; 256],
            skin,
        })
    }

    fn shape(&self) -> *const PxGeometry {
        (&raw const self.geometry).cast()
    }
}

fn vector(v: Vec3) -> PxVec3 {
    PxVec3 {
        x: v.x,
        y: v.y,
        z: v.z,
    }
}

fn at(position: Vec3) -> PxTransform {
    PxTransform {
        q: NO_ROTATION,
        p: vector(position),
    }
}

impl Peer for PhysX {
    fn update(&mut self, palette: &Palette, place: DVec3) -> Result<(), Box<dyn Error>> {
        self.skin.update(palette, place)?;
        self.mesh.refit(&self.skin.positions)
    }

    fn cast_ray(&mut self, ray: &Ray, max_distance: f32) -> Answer<Option<RayHit>> {
        let (origin, direction) = (vector(ray.origin()), vector(ray.direction()));
        let mesh = at(Vec3::ZERO);
        let mut hit = MaybeUninit::<PxGeomRaycastHit>::zeroed();
        // SAFETY: all pointers are to live values; the mesh lives until drop. Only `hit` is written to, which has room
        // for the one hit that is requested.
        let hits = unsafe {
            PxGeometryQuery_raycast(
                &raw const origin,
                &raw const direction,
                self.shape(),
                &raw const mesh,
                max_distance.min(f32::MAX),
                PxHitFlags::FaceIndex,
                1,
                hit.as_mut_ptr(),
                size_of::<PxGeomRaycastHit>() as u32,
                NO_GUARD,
                null_mut(),
            )
        };
        if hits == 0 {
            return Ok(None);
        }
        // SAFETY: the hit holds numbers and flags only, which are zero or written by PhysX.
        let hit = unsafe { hit.assume_init() };
        Ok(Some(RayHit {
            distance: hit.distance,
            triangle: self.mesh.triangle(hit.faceIndex),
        }))
    }

    fn overlap_sphere(&mut self, sphere: &Sphere) -> Answer<usize> {
        // SAFETY: the function only sets the fields.
        let ball = unsafe { PxSphereGeometry_new(sphere.radius) };
        let (center, mesh) = (at(sphere.center), at(Vec3::ZERO));
        loop {
            let mut overflow = false;
            // SAFETY: all pointers are to live values; the mesh lives until drop. Only `overflow` and `found` are
            // written to, and the length of `found` is passed.
            let count = unsafe {
                PxMeshQuery_findOverlapTriangleMesh(
                    (&raw const ball).cast(),
                    &raw const center,
                    &raw const self.geometry,
                    &raw const mesh,
                    self.found.as_mut_ptr(),
                    self.found.len() as u32,
                    0,
                    &raw mut overflow,
                    NO_GUARD,
                )
            };
            if !overflow {
                return Ok(count as usize);
            }
            self.found.resize(self.found.len() * 2, 0);
        }
    }

    /// PhysX takes no maximum distance: it finds the closest point at any distance.
    fn closest_point(&mut self, point: Vec3, max_distance: f32) -> Answer<Option<Nearest>> {
        let (from, mesh) = (vector(point), at(Vec3::ZERO));
        let mut nearest = vector(Vec3::NAN);
        // SAFETY: all pointers are to live values; the mesh lives until drop. Only `nearest` is written to; the
        // triangle is not requested.
        unsafe {
            PxGeometryQuery_pointDistance(
                &raw const from,
                self.shape(),
                &raw const mesh,
                &raw mut nearest,
                null_mut(),
                NO_GUARD,
            );
        }
        let nearest = Vec3::new(nearest.x, nearest.y, nearest.z);
        let distance = nearest.distance(point);
        Ok((distance <= max_distance).then_some(Nearest {
            point: nearest,
            distance,
        }))
    }

    fn cast_sphere(&mut self, sphere: &Sphere, motion: Vec3) -> Answer<Option<f32>> {
        let length = motion.length();
        // A sphere that does not move needs a direction as well.
        let direction = if length > 0.0 {
            motion / length
        } else {
            Vec3::X
        };
        let direction = vector(direction);
        // SAFETY: the function only sets the fields.
        let ball = unsafe { PxSphereGeometry_new(sphere.radius) };
        let (center, mesh) = (at(sphere.center), at(Vec3::ZERO));
        let mut hit = MaybeUninit::<PxGeomSweepHit>::zeroed();
        // SAFETY: all pointers are to live values; the mesh lives until drop. Only `hit` is written to.
        let found = unsafe {
            PxGeometryQuery_sweep(
                &raw const direction,
                length,
                (&raw const ball).cast(),
                &raw const center,
                self.shape(),
                &raw const mesh,
                hit.as_mut_ptr(),
                PxHitFlags::empty(),
                0.0,
                NO_GUARD,
                null_mut(),
            )
        };
        if !found {
            return Ok(None);
        }
        // SAFETY: the hit holds numbers and flags only, which are zero or written by PhysX.
        let hit = unsafe { hit.assume_init() };
        Ok(Some(if length > 0.0 {
            hit.distance / length
        } else {
            0.0
        }))
    }

    // PhysX allocates with the C library, so `bytes` includes all of its memory.
    fn skin(&self) -> Option<&Skin> {
        Some(&self.skin)
    }
}
