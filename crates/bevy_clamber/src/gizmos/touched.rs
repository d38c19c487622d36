use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::*;
use bevy_gizmos::config::GizmoConfigStore;
use clamber_surface::surface::SkinnedSurface;

use super::SurfaceGizmos;
use crate::PosedSurface;

/// Per surface and cluster: whether a query reached it before the last tick posed the surface.
#[derive(Resource, Debug, Default)]
pub(super) struct TouchedClusters(EntityHashMap<Vec<bool>>);

impl TouchedClusters {
    /// Per cluster of a surface, in the order of [`SkinnedSurface::clusters`]: whether a query reached it in the
    /// current or previous pose.
    pub(super) fn of(
        &self,
        entity: Entity,
        surface: &SkinnedSurface,
    ) -> impl Iterator<Item = bool> {
        let noted = self.0.get(&entity).map_or(&[][..], Vec::as_slice);
        let clusters = surface.clusters().enumerate();
        clusters.map(|(index, cluster)| {
            cluster.touched || noted.get(index).copied().unwrap_or_default()
        })
    }
}

/// Runs in each tick before surfaces are posed, since posing clears the touched clusters.
pub(super) fn note_touched(
    surfaces: Query<(Entity, &PosedSurface)>,
    config: Res<GizmoConfigStore>,
    mut touched: ResMut<TouchedClusters>,
) {
    let touched = &mut touched.0;
    let wanted = config.get_config::<SurfaceGizmos>();
    if wanted.is_none_or(|(all, show)| !all.enabled || !(show.clusters || show.contacts)) {
        touched.clear();
        return;
    }
    touched.retain(|entity, _| surfaces.contains(*entity));
    for (entity, surface) in &surfaces {
        let clusters = touched.entry(entity).or_default();
        clusters.clear();
        clusters.extend(surface.clusters().map(|cluster| cluster.touched));
    }
}
