use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_diagnostic::{Diagnostic, DiagnosticPath, Diagnostics, RegisterDiagnostic};
use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_platform::time::Instant;

use crate::needs::need_plugin;
use crate::{ClamberSystems, PosedSurface, SurfacePlugin};

/// Reports the work of surfaces in each tick to Bevy's diagnostics. Add it beside
/// [`ClamberPlugins`](crate::ClamberPlugins), with the same schedule.
///
/// | path | value |
/// |---|---|
/// | `clamber/surfaces` | entities with a [`PosedSurface`] |
/// | `clamber/clusters_touched` | clusters that queries reached, each once per pose |
/// | `clamber/vertices_skinned` | vertices skinned for queries, or ahead of them after a tick that reached nearly all |
/// | `clamber/triangles_tested` | exact triangle tests, after bounding boxes have ruled out the other triangles |
/// | `clamber/pose_time` | milliseconds from before to after [`ClamberSystems::Pose`], with the systems in between |
///
/// Each tick adds one measurement of each value. The counts are taken right before [`ClamberSystems::Pose`], as sums
/// over all surfaces and all queries since the measurement before; the time is taken right after it. Queries of the
/// pose that a frame draws, as for picking and anchors, do not count.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceDiagnosticsPlugin {
    schedule: InternedScheduleLabel,
}

impl SurfaceDiagnosticsPlugin {
    /// `clamber/surfaces`: entities with a [`PosedSurface`].
    pub const SURFACES: DiagnosticPath = DiagnosticPath::const_new("clamber/surfaces");
    /// `clamber/clusters_touched`: clusters that queries reached.
    pub const CLUSTERS_TOUCHED: DiagnosticPath =
        DiagnosticPath::const_new("clamber/clusters_touched");
    /// `clamber/vertices_skinned`: vertices that were skinned.
    pub const VERTICES_SKINNED: DiagnosticPath =
        DiagnosticPath::const_new("clamber/vertices_skinned");
    /// `clamber/triangles_tested`: exact triangle tests.
    pub const TRIANGLES_TESTED: DiagnosticPath =
        DiagnosticPath::const_new("clamber/triangles_tested");
    /// `clamber/pose_time`: duration of [`ClamberSystems::Pose`], milliseconds.
    pub const POSE_TIME: DiagnosticPath = DiagnosticPath::const_new("clamber/pose_time");

    /// For surfaces that are posed in this schedule of the fixed loop.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
        }
    }
}

impl Default for SurfaceDiagnosticsPlugin {
    fn default() -> Self {
        Self::in_schedule(FixedPostUpdate)
    }
}

impl Plugin for SurfaceDiagnosticsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<PoseStart>()
            .register_diagnostic(Diagnostic::new(Self::SURFACES))
            .register_diagnostic(Diagnostic::new(Self::CLUSTERS_TOUCHED))
            .register_diagnostic(Diagnostic::new(Self::VERTICES_SKINNED))
            .register_diagnostic(Diagnostic::new(Self::TRIANGLES_TESTED))
            .register_diagnostic(Diagnostic::new(Self::POSE_TIME).with_suffix("ms"))
            .add_systems(
                self.schedule,
                (
                    (measure_queries, start_clock)
                        .chain()
                        .before(ClamberSystems::Pose),
                    stop_clock.after(ClamberSystems::Pose),
                ),
            );
    }

    fn finish(&self, app: &mut App) {
        let me = "clamber's SurfaceDiagnosticsPlugin";
        need_plugin::<SurfacePlugin>(app, me, "ClamberPlugins");
    }
}

/// Time at which the current tick began to pose surfaces.
#[derive(Resource, Default)]
struct PoseStart(Option<Instant>);

/// Counts of the work of queries.
#[derive(Clone, Copy, Default)]
struct Counts {
    clusters_touched: u64,
    vertices_skinned: u64,
    triangles_tested: u64,
}

impl Counts {
    /// Counts since the surface was last posed anew.
    fn of(surface: &PosedSurface) -> Self {
        let counts = surface.diagnostics();
        Self {
            clusters_touched: counts.clusters_touched as u64,
            vertices_skinned: counts.vertices_skinned as u64,
            triangles_tested: counts.triangles_tested,
        }
    }

    fn add(&mut self, other: Self) {
        self.clusters_touched += other.clusters_touched;
        self.vertices_skinned += other.vertices_skinned;
        self.triangles_tested += other.triangles_tested;
    }

    /// Difference to earlier counts. It saturates at 0, since edits may reduce counts.
    fn since(self, before: Self) -> Self {
        let less = u64::saturating_sub;
        Self {
            clusters_touched: less(self.clusters_touched, before.clusters_touched),
            vertices_skinned: less(self.vertices_skinned, before.vertices_skinned),
            triangles_tested: less(self.triangles_tested, before.triangles_tested),
        }
    }
}

fn measure_queries(
    surfaces: Query<(Entity, &PosedSurface)>,
    mut earlier: Local<EntityHashMap<Counts>>,
    mut diagnostics: Diagnostics,
) {
    earlier.retain(|entity, _| surfaces.contains(*entity));
    let mut sum = Counts::default();
    for (entity, surface) in &surfaces {
        let counts = Counts::of(surface);
        let before = earlier.insert(entity, counts).unwrap_or_default();
        sum.add(if surface.is_posed_anew() {
            counts
        } else {
            counts.since(before)
        });
    }
    type Plugin = SurfaceDiagnosticsPlugin;
    diagnostics.add_measurement(&Plugin::SURFACES, || surfaces.iter().len() as f64);
    diagnostics.add_measurement(&Plugin::CLUSTERS_TOUCHED, || sum.clusters_touched as f64);
    diagnostics.add_measurement(&Plugin::VERTICES_SKINNED, || sum.vertices_skinned as f64);
    diagnostics.add_measurement(&Plugin::TRIANGLES_TESTED, || sum.triangles_tested as f64);
}

fn start_clock(mut start: ResMut<PoseStart>) {
    start.0 = Some(Instant::now());
}

fn stop_clock(start: Res<PoseStart>, mut diagnostics: Diagnostics) {
    if let Some(start) = start.0 {
        let path = &SurfaceDiagnosticsPlugin::POSE_TIME;
        diagnostics.add_measurement(path, || 1e3 * start.elapsed().as_secs_f64());
    }
}
