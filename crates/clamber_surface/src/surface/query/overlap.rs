use super::closest::{check, within_reach};
use super::hit::Nearest;
use super::{SkinnedSurface, SurfaceError, SurfaceHit};
use crate::geometry::Sphere;
use crate::geometry::triangle::closest_point;
use crate::mesh::TriangleId;

impl SkinnedSurface {
    /// Every triangle within the sphere, each with its own point closest to the sphere's centre,
    /// by ascending triangle id. `hits` is cleared first and keeps its memory.
    ///
    /// # Errors
    /// [`SurfaceError::Point`] if the sphere's centre is not finite, [`SurfaceError::Query`] if its
    /// radius (may be infinite) is negative or NaN; `hits` is unchanged then.
    pub fn overlap_sphere(
        &self,
        sphere: &Sphere,
        hits: &mut Vec<SurfaceHit>,
    ) -> Result<(), SurfaceError> {
        check(sphere.center, sphere.radius)?;
        hits.clear();
        self.visit_overlaps(sphere, |hit| hits.push(hit))?;
        hits.sort_unstable_by_key(|hit| hit.triangle);
        Ok(())
    }

    /// [`SkinnedSurface::overlap_sphere`] for callers with a place of their own for the hits, which
    /// come in no promised order.
    ///
    /// # Errors
    /// As [`SkinnedSurface::overlap_sphere`]; nothing is visited then.
    pub fn visit_overlaps(
        &self,
        sphere: &Sphere,
        visit: impl FnMut(SurfaceHit),
    ) -> Result<(), SurfaceError> {
        let radius = check(sphere.center, sphere.radius)?;
        let center = sphere.center;
        let near = self.triangles_near(move |part| within_reach(part, center, radius));
        self.touching(near, sphere, radius).for_each(visit);
        Ok(())
    }

    /// [`SkinnedSurface::overlap_sphere`] over all triangles: slow and plain, for tests.
    ///
    /// # Errors
    /// As [`SkinnedSurface::overlap_sphere`].
    pub fn overlap_sphere_reference(
        &self,
        sphere: &Sphere,
        hits: &mut Vec<SurfaceHit>,
    ) -> Result<(), SurfaceError> {
        let radius = check(sphere.center, sphere.radius)?;
        hits.clear();
        hits.extend(self.touching(self.all_triangles(), sphere, radius));
        Ok(())
    }

    fn touching(
        &self,
        triangles: impl Iterator<Item = TriangleId>,
        sphere: &Sphere,
        radius: f64,
    ) -> impl Iterator<Item = SurfaceHit> {
        triangles.filter_map(move |triangle| {
            let found = closest_point(self.corners(triangle), sphere.center);
            let nearest = Nearest { triangle, found };
            (found.distance <= radius).then(|| self.hit(nearest, sphere.center))?
        })
    }
}
