//! PhysX's triangle mesh.
//!
//! The mesh's tree is not quantised, because PhysX cannot refit a quantised one: `refitBVH` would print an error at
//! each call, and leave the tree as it was cooked. Cleaning, which includes welding, is off, so that vertices keep
//! their indices.

use std::error::Error;
use std::ptr::{NonNull, null_mut};
use std::sync::OnceLock;

use clamber_surface::mesh::TriangleId;
use glam::Vec3;
use physx_sys::{
    PxBVH34MidphaseDesc, PxCookingParams, PxCookingParams_new, PxMeshMidPhase,
    PxMeshPreprocessingFlags, PxMidphaseDesc_setToDefault_mut, PxTolerancesScale, PxTriangleMesh,
    PxTriangleMesh_getNbTriangles, PxTriangleMesh_getNbVertices, PxTriangleMesh_getTrianglesRemap,
    PxTriangleMesh_getVerticesForModification_mut, PxTriangleMesh_refitBVH_mut,
    PxTriangleMesh_release_mut, PxTriangleMeshDesc_new, phys_PxCreateTriangleMesh,
    phys_PxGetStandaloneInsertionCallback, physx_create_foundation,
};

/// A cooked mesh, which is released when dropped.
pub(super) struct Mesh(NonNull<PxTriangleMesh>);

impl Mesh {
    /// Cooks a mesh. Every index of a triangle must be the index of a position.
    pub(super) fn new(positions: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, Box<dyn Error>> {
        start()?;
        let mesh = Self(cook(positions, triangles)?);
        // SAFETY: the mesh lives.
        let (vertices, faces) = unsafe {
            (
                PxTriangleMesh_getNbVertices(mesh.as_ptr()),
                PxTriangleMesh_getNbTriangles(mesh.as_ptr()),
            )
        };
        if (vertices as usize, faces as usize) != (positions.len(), triangles.len()) {
            return Err("PhysX dropped vertices or triangles of the mesh".into());
        }
        Ok(mesh)
    }

    pub(super) fn as_ptr(&self) -> *mut PxTriangleMesh {
        self.0.as_ptr()
    }

    /// Sets new positions of the same vertices, and refits the tree.
    pub(super) fn refit(&mut self, positions: &[Vec3]) -> Result<(), Box<dyn Error>> {
        // SAFETY: the mesh lives until drop, here and below. Its vertices are PhysX's own, three f32 each like ours.
        let vertices = unsafe {
            let first = PxTriangleMesh_getVerticesForModification_mut(self.as_ptr()).cast::<Vec3>();
            let count = PxTriangleMesh_getNbVertices(self.as_ptr());
            if first.is_null() || count as usize != positions.len() {
                return Err("the number of positions is not that of PhysX's vertices".into());
            }
            std::slice::from_raw_parts_mut(first, positions.len())
        };
        vertices.copy_from_slice(positions);
        // SAFETY: because of `&mut self` no query runs at the same time.
        unsafe { PxTriangleMesh_refitBVH_mut(self.as_ptr()) };
        Ok(())
    }

    /// The collider's triangle for the face index of a query: cooking sorts the triangles by the tree.
    pub(super) fn triangle(&self, face: u32) -> TriangleId {
        // SAFETY: the table has an entry for each triangle, and lives as long as the mesh.
        let table = unsafe {
            let first = PxTriangleMesh_getTrianglesRemap(self.as_ptr());
            let count = PxTriangleMesh_getNbTriangles(self.as_ptr());
            std::slice::from_raw_parts(first, count as usize)
        };
        TriangleId(table[face as usize])
    }
}

impl Drop for Mesh {
    fn drop(&mut self) {
        // SAFETY: made by `cook`, and released only here.
        unsafe { PxTriangleMesh_release_mut(self.as_ptr()) }
    }
}

/// Starts PhysX's foundation, once in a process. It allocates with the C library, and prints errors to stdout.
fn start() -> Result<(), Box<dyn Error>> {
    static STARTED: OnceLock<bool> = OnceLock::new();
    // SAFETY: called once, and no other code here makes a foundation.
    let started = STARTED.get_or_init(|| unsafe { !physx_create_foundation().is_null() });
    started
        .then_some(())
        .ok_or_else(|| "PhysX failed to start".into())
}

/// A mesh with a tree that can be refitted.
fn cook(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
) -> Result<NonNull<PxTriangleMesh>, Box<dyn Error>> {
    let params = cooking()?;
    // SAFETY: the function only sets the fields.
    let mut desc = unsafe { PxTriangleMeshDesc_new() };
    desc.points.stride = size_of::<Vec3>() as u32;
    desc.points.count = u32::try_from(positions.len())?;
    desc.points.data = positions.as_ptr().cast();
    desc.triangles.stride = size_of::<[u32; 3]>() as u32;
    desc.triangles.count = u32::try_from(triangles.len())?;
    desc.triangles.data = triangles.as_ptr().cast();
    // SAFETY: both slices are read by the counts and strides above, and copied. Every index is the index of a vertex,
    // as `ColliderMesh` checks. The callback is PhysX's own. The result code is not requested.
    let mesh = unsafe {
        phys_PxCreateTriangleMesh(
            &raw const params,
            &raw const desc,
            phys_PxGetStandaloneInsertionCallback(),
            null_mut(),
        )
    };
    NonNull::new(mesh).ok_or_else(|| "PhysX rejected the mesh".into())
}

fn cooking() -> Result<PxCookingParams, Box<dyn Error>> {
    // PhysX's own defaults, for metres.
    let scale = PxTolerancesScale {
        length: 1.0,
        speed: 10.0,
    };
    // SAFETY: the function only sets the fields, from the scale.
    let mut params = unsafe { PxCookingParams_new(&raw const scale) };
    // Active edges are for contacts, which are not used here.
    params.meshPreprocessParams = PxMeshPreprocessingFlags::DisableCleanMesh
        | PxMeshPreprocessingFlags::DisableActiveEdgesPrecompute;
    let midphase = &raw mut params.midphaseDesc;
    // SAFETY: PhysX's own function sets the kind of tree. The settings of the kinds are a union, which is the first
    // field, and that function has just filled the variant that is written to here.
    unsafe {
        PxMidphaseDesc_setToDefault_mut(midphase, PxMeshMidPhase::Bvh34);
        (*midphase.cast::<PxBVH34MidphaseDesc>()).quantized = false;
    }
    Ok(params)
}
