//! A skin patch as a shape of rapier's.

use rapier3d::geometry::{Aabb, Shape, ShapeType, TypedShape};
use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::bounding_volume::BoundingSphere;
use rapier3d::parry::mass_properties::MassProperties;
use rapier3d::parry::partitioning::Bvh;
use rapier3d::parry::query::details::NormalConstraints;
use rapier3d::parry::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use rapier3d::parry::shape::{
    CompositeShape, CompositeShapeRef, FeatureId, Triangle, TrianglePseudoNormals,
    TypedCompositeShape,
};

/// The triangles of a patch, which move from tick to tick.
///
/// The shape works as parry's `TriMesh` does with the flag `FIX_INTERNAL_EDGES_TWO_SIDED`: contact normals stay within
/// the cones of a triangle and its neighbours, so that bodies do not catch on the edges between triangles. This holds
/// on either side, because mirrored joints turn triangles inside out. `TriMesh` looks up the edges in hash maps
/// whenever a vertex moves, which takes longer than all other work of a tick on a patch. Here, the edges are found once
/// per rebuild.
#[derive(Clone, Debug)]
pub(crate) struct PatchShape {
    vertices: Vec<Vector>,
    triangles: Vec<[u32; 3]>,
    /// For each triangle, the indices of its edges in `edge_normals`.
    edges: Vec<[u32; 3]>,
    /// For each triangle, its unit normal; zero if it has no area.
    normals: Vec<Vector>,
    /// For each edge, the sum of its triangles' normals.
    edge_normals: Vec<Vector>,
    bvh: Bvh,
}

impl PatchShape {
    /// A shape with these triangles, whose corners are indices into `vertices`.
    pub(crate) fn new(triangles: &[[u32; 3]], vertices: impl Iterator<Item = Vector>) -> Self {
        let triangles = triangles.to_vec();
        let (edges, edge_count) = shared_edges(&triangles);
        let mut shape = Self {
            vertices: vertices.collect(),
            normals: vec![Vector::ZERO; triangles.len()],
            edge_normals: vec![Vector::ZERO; edge_count],
            triangles,
            edges,
            bvh: Bvh::new(),
        };
        shape.set_bounds();
        shape.set_normals();
        shape
    }

    /// Moves the vertices.
    pub(super) fn place(&mut self, vertices: impl Iterator<Item = Vector>) {
        for (vertex, place) in self.vertices.iter_mut().zip(vertices) {
            *vertex = place;
        }
        self.set_bounds();
        self.set_normals();
    }

    /// Computes the tree's boxes after the vertices have changed. The first call inserts the triangles one by one,
    /// which is faster than building the tree for all of them at once. The tree is not as good, but a patch has few
    /// triangles, most of them near the body.
    fn set_bounds(&mut self) {
        for index in 0..self.triangles.len() {
            let bounds = self.triangle(index).local_aabb();
            self.bvh
                .insert_or_update_partially(bounds, index as u32, 0.0);
        }
        self.bvh.refit_without_opt();
    }

    /// Computes the normals after the vertices have changed.
    fn set_normals(&mut self) {
        self.edge_normals.fill(Vector::ZERO);
        for index in 0..self.triangles.len() {
            let normal = self.triangle(index).normal().unwrap_or(Vector::ZERO);
            self.normals[index] = normal;
            for edge in self.edges[index] {
                self.edge_normals[edge as usize] += normal;
            }
        }
    }

    fn triangle(&self, index: usize) -> Triangle {
        Triangle::from(self.triangles[index].map(|corner| self.vertices[corner as usize]))
    }

    /// The directions that contact normals of a triangle are kept to; `None` if it or the fold at one of its edges has
    /// no normal.
    fn normal_constraints(&self, index: usize) -> Option<TrianglePseudoNormals> {
        let face = self.normals[index];
        if face == Vector::ZERO {
            return None;
        }
        let [a, b, c] = self.edges[index].map(|edge| self.edge_normals[edge as usize]);
        Some(TrianglePseudoNormals {
            face,
            edges: [a.try_normalize()?, b.try_normalize()?, c.try_normalize()?],
            two_sided: true,
        })
    }
}

/// For each triangle the indices of its three edges, and the number of edges. Triangles with a common edge have the
/// same index there.
fn shared_edges(triangles: &[[u32; 3]]) -> (Vec<[u32; 3]>, usize) {
    let mut sides = Vec::with_capacity(3 * triangles.len());
    for (index, [a, b, c]) in triangles.iter().enumerate() {
        for (side, (from, to)) in [(*a, *b), (*b, *c), (*c, *a)].into_iter().enumerate() {
            sides.push((from.min(to), from.max(to), index as u32, side as u32));
        }
    }
    sides.sort_unstable();
    let mut edges = vec![[0; 3]; triangles.len()];
    let mut count = 0;
    for same in sides.chunk_by(|one, other| (one.0, one.1) == (other.0, other.1)) {
        for (_, _, index, side) in same {
            edges[*index as usize][*side as usize] = count as u32;
        }
        count += 1;
    }
    (edges, count)
}

impl CompositeShape for PatchShape {
    fn map_part_at(
        &self,
        part: u32,
        f: &mut dyn FnMut(Option<&Pose>, &dyn Shape, Option<&dyn NormalConstraints>),
    ) {
        self.map_untyped_part_at(part, f);
    }

    fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    fn is_deformable(&self) -> bool {
        true
    }
}

impl TypedCompositeShape for PatchShape {
    type PartShape = Triangle;
    type PartNormalConstraints = TrianglePseudoNormals;

    fn map_typed_part_at<T>(
        &self,
        part: u32,
        mut f: impl FnMut(Option<&Pose>, &Triangle, Option<&TrianglePseudoNormals>) -> T,
    ) -> Option<T> {
        let index = part as usize;
        (index < self.triangles.len()).then(|| {
            let normals = self.normal_constraints(index);
            f(None, &self.triangle(index), normals.as_ref())
        })
    }

    fn map_untyped_part_at<T>(
        &self,
        part: u32,
        mut f: impl FnMut(Option<&Pose>, &dyn Shape, Option<&dyn NormalConstraints>) -> T,
    ) -> Option<T> {
        self.map_typed_part_at(part, |pose, triangle, normals| {
            f(pose, triangle, normals.map(|normals| normals as _))
        })
    }
}

impl Shape for PatchShape {
    fn compute_local_aabb(&self) -> Aabb {
        self.bvh.root_aabb()
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        self.compute_local_aabb().bounding_sphere()
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    fn scale_dyn(&self, scale: Vector, _: u32) -> Option<Box<dyn Shape>> {
        let mut scaled = self.clone();
        scaled.place(self.vertices.iter().map(|vertex| vertex * scale));
        Some(Box::new(scaled))
    }

    fn mass_properties(&self, _: Real) -> MassProperties {
        MassProperties::default()
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> Real {
        0.0
    }

    fn ccd_angular_thickness(&self) -> Real {
        std::f32::consts::FRAC_PI_4
    }

    fn feature_normal_at_point(&self, part: u32, _: FeatureId, _: Vector) -> Option<Vector> {
        let normal = self.normals.get(part as usize)?;
        (*normal != Vector::ZERO).then_some(*normal)
    }

    fn as_composite_shape(&self) -> Option<&(dyn CompositeShape + Sync)> {
        Some(self)
    }
}

impl RayCast for PatchShape {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        max_time: Real,
        solid: bool,
    ) -> Option<RayIntersection> {
        let hit = CompositeShapeRef(self).cast_local_ray_and_get_normal(ray, max_time, solid);
        hit.map(|(part, hit)| hit.with_subshape(part))
    }
}

impl PointQuery for PatchShape {
    fn project_local_point(&self, point: Vector, solid: bool) -> PointProjection {
        let found = CompositeShapeRef(self).project_local_point(point, Real::MAX, solid);
        found.map_or(PointProjection::new(false, point), |(part, projection)| {
            projection.with_subshape(part)
        })
    }

    fn project_local_point_and_get_feature(&self, point: Vector) -> (PointProjection, FeatureId) {
        let found = CompositeShapeRef(self).project_local_point_and_get_feature(point, Real::MAX);
        found.map_or(
            (PointProjection::new(false, point), FeatureId::Unknown),
            |(part, projection, feature)| (projection.with_subshape(part), feature),
        )
    }
}

#[cfg(test)]
mod tests;
