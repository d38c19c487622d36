//! Peers in C++ (`cpp`), each behind a table of functions.

#![allow(unsafe_code, reason = "calls the C++ of this crate")]

use std::error::Error;
use std::ffi::{c_int, c_void};
use std::ptr::NonNull;
use std::sync::Arc;

use clamber_surface::geometry::{Ray, Sphere};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::Palette;
use glam::{DVec3, Vec3};

use crate::peer::{Answer, Entry, Nearest, Peer, RayHit, Unsupported};
use crate::skin::Skin;

/// The peers that this crate was built with, by its features.
pub(crate) const ENTRIES: &[Entry] = &[
    #[cfg(feature = "embree")]
    Entry {
        name: "Embree 3",
        make: |mesh| Native::make(mesh, &EMBREE),
    },
    #[cfg(feature = "embree")]
    Entry {
        name: "Embree 3 robust",
        make: |mesh| Native::make(mesh, &EMBREE_ROBUST),
    },
    #[cfg(feature = "bullet")]
    Entry {
        name: "Bullet 3",
        make: |mesh| Native::make(mesh, &BULLET),
    },
    #[cfg(feature = "fcl")]
    Entry {
        name: "FCL 0.7",
        make: |mesh| Native::make(mesh, &FCL),
    },
];

/// The functions of a peer, as declared and described in `cpp/peer.h`.
struct Functions {
    new: unsafe extern "C" fn(*const f32, u32, *const u32, u32) -> *mut c_void,
    free: unsafe extern "C" fn(*mut c_void),
    update: unsafe extern "C" fn(*mut c_void, *const f32),
    cast_ray:
        unsafe extern "C" fn(*mut c_void, *const f32, *const f32, f32, *mut f32, *mut u32) -> c_int,
    overlap_sphere: unsafe extern "C" fn(*mut c_void, *const f32, f32) -> i64,
    closest_point: unsafe extern "C" fn(*mut c_void, *const f32, f32, *mut f32) -> c_int,
    cast_sphere: unsafe extern "C" fn(*mut c_void, *const f32, f32, *const f32, *mut f32) -> c_int,
    hidden_bytes: unsafe extern "C" fn(*mut c_void) -> u64,
}

macro_rules! functions {
    ($table:ident: $new:ident $free:ident $update:ident $cast_ray:ident $overlap_sphere:ident
     $closest_point:ident $cast_sphere:ident $hidden_bytes:ident) => {
        unsafe extern "C" {
            fn $new(
                positions: *const f32,
                vertices: u32,
                triangles: *const u32,
                triangle_count: u32,
            ) -> *mut c_void;
            fn $free(peer: *mut c_void);
            fn $update(peer: *mut c_void, positions: *const f32);
            fn $cast_ray(
                peer: *mut c_void,
                origin: *const f32,
                direction: *const f32,
                max_distance: f32,
                distance: *mut f32,
                triangle: *mut u32,
            ) -> c_int;
            fn $overlap_sphere(peer: *mut c_void, center: *const f32, radius: f32) -> i64;
            fn $closest_point(
                peer: *mut c_void,
                point: *const f32,
                max_distance: f32,
                nearest: *mut f32,
            ) -> c_int;
            fn $cast_sphere(
                peer: *mut c_void,
                center: *const f32,
                radius: f32,
                motion: *const f32,
                time: *mut f32,
            ) -> c_int;
            fn $hidden_bytes(peer: *mut c_void) -> u64;
        }

        static $table: Functions = Functions {
            new: $new,
            free: $free,
            update: $update,
            cast_ray: $cast_ray,
            overlap_sphere: $overlap_sphere,
            closest_point: $closest_point,
            cast_sphere: $cast_sphere,
            hidden_bytes: $hidden_bytes,
        };
    };
}

#[cfg(feature = "embree")]
functions!(EMBREE: embree_new embree_free embree_update embree_cast_ray embree_overlap_sphere
           embree_closest_point embree_cast_sphere embree_hidden_bytes);
#[cfg(feature = "embree")]
functions!(EMBREE_ROBUST: embree_robust_new embree_robust_free embree_robust_update
           embree_robust_cast_ray embree_robust_overlap_sphere embree_robust_closest_point
           embree_robust_cast_sphere embree_robust_hidden_bytes);
#[cfg(feature = "bullet")]
functions!(BULLET: bullet_new bullet_free bullet_update bullet_cast_ray bullet_overlap_sphere
           bullet_closest_point bullet_cast_sphere bullet_hidden_bytes);
#[cfg(feature = "fcl")]
functions!(FCL: fcl_new fcl_free fcl_update fcl_cast_ray fcl_overlap_sphere fcl_closest_point
           fcl_cast_sphere fcl_hidden_bytes);

/// A peer in C++, and the skin whose positions it gets.
struct Native {
    functions: &'static Functions,
    /// Made by `functions.new`, and owned only by this value.
    peer: NonNull<c_void>,
    skin: Skin,
}

impl Native {
    fn make(
        mesh: &Arc<ColliderMesh>,
        functions: &'static Functions,
    ) -> Result<Box<dyn Peer>, Box<dyn Error>> {
        let skin = Skin::new(mesh);
        let triangles = skin.triangles();
        let vertices = u32::try_from(skin.positions.len())?;
        let triangle_count = u32::try_from(triangles.len())?;
        // SAFETY: both slices hold three numbers for each of the counted vertices and triangles, since a `Vec3` is
        // three f32 in a row. Every index is the index of a vertex, as `ColliderMesh` checks. C++ copies both.
        let peer = unsafe {
            (functions.new)(
                skin.positions.as_ptr().cast(),
                vertices,
                triangles.as_ptr().cast(),
                triangle_count,
            )
        };
        let peer = NonNull::new(peer).ok_or("the library rejected the mesh")?;
        Ok(Box::new(Self {
            functions,
            peer,
            skin,
        }))
    }
}

impl Drop for Native {
    fn drop(&mut self) {
        // SAFETY: made by `new` of the same table, and freed only here.
        unsafe { (self.functions.free)(self.peer.as_ptr()) }
    }
}

/// The return value of a query in C++ as an answer: found, not found, or no such query.
fn found(answer: c_int) -> Answer<bool> {
    match answer {
        1 => Ok(true),
        0 => Ok(false),
        _ => Err(Unsupported),
    }
}

impl Peer for Native {
    fn update(&mut self, palette: &Palette, place: DVec3) -> Result<(), Box<dyn Error>> {
        self.skin.update(palette, place)?;
        // SAFETY: `peer` lives until drop, here and below; there are as many positions as when it
        // was made. C++ copies them.
        unsafe { (self.functions.update)(self.peer.as_ptr(), self.skin.positions.as_ptr().cast()) };
        Ok(())
    }

    fn cast_ray(&mut self, ray: &Ray, max_distance: f32) -> Answer<Option<RayHit>> {
        let (origin, direction) = (ray.origin().to_array(), ray.direction().to_array());
        let (mut distance, mut triangle) = (0.0, 0);
        // SAFETY: the arrays have the three elements that are read. The two pointers are written to
        // during the call only.
        let answer = unsafe {
            (self.functions.cast_ray)(
                self.peer.as_ptr(),
                origin.as_ptr(),
                direction.as_ptr(),
                max_distance,
                &raw mut distance,
                &raw mut triangle,
            )
        };
        let triangle = TriangleId(triangle);
        Ok(found(answer)?.then_some(RayHit { distance, triangle }))
    }

    fn overlap_sphere(&mut self, sphere: &Sphere) -> Answer<usize> {
        let center = sphere.center.to_array();
        // SAFETY: three elements are read.
        let count = unsafe {
            (self.functions.overlap_sphere)(self.peer.as_ptr(), center.as_ptr(), sphere.radius)
        };
        usize::try_from(count).map_err(|_| Unsupported)
    }

    fn closest_point(&mut self, point: Vec3, max_distance: f32) -> Answer<Option<Nearest>> {
        let (from, mut nearest) = (point.to_array(), [0.0; 3]);
        // SAFETY: three elements are read and three written.
        let answer = unsafe {
            (self.functions.closest_point)(
                self.peer.as_ptr(),
                from.as_ptr(),
                max_distance,
                nearest.as_mut_ptr(),
            )
        };
        let nearest = Vec3::from_array(nearest);
        Ok(found(answer)?.then_some(Nearest {
            point: nearest,
            distance: nearest.distance(point),
        }))
    }

    fn cast_sphere(&mut self, sphere: &Sphere, motion: Vec3) -> Answer<Option<f32>> {
        let (center, motion) = (sphere.center.to_array(), motion.to_array());
        let mut time = 0.0;
        // SAFETY: three elements of each array are read. The pointer is written to during the call only.
        let answer = unsafe {
            (self.functions.cast_sphere)(
                self.peer.as_ptr(),
                center.as_ptr(),
                sphere.radius,
                motion.as_ptr(),
                &raw mut time,
            )
        };
        Ok(found(answer)?.then_some(time))
    }

    fn bytes(&self, from_heap: usize) -> usize {
        // SAFETY: the function only reads a number that the peer holds.
        let hidden = unsafe { (self.functions.hidden_bytes)(self.peer.as_ptr()) };
        from_heap + hidden as usize + self.skin.bytes_at_rest()
    }

    fn skin(&self) -> Option<&Skin> {
        Some(&self.skin)
    }
}
