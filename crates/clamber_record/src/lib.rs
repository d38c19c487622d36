//! Records a climber and the creature under it, tick by tick, and replays them bit for bit.
//!
//! A recording is an [MCAP](https://mcap.dev) file of protobuf messages, in chunks and with an index. Foxglove
//! and Rerun open it directly. Its properties, in order of priority:
//!
//! 1. It is exact: it holds each tick's input, every bit of the climber's state, and fingerprints of the
//!    palette and of the rest of the scene. So a [`replay()`] finds the first tick that differs.
//! 2. The same run gives the same bytes: times follow from tick numbers, not from a clock.
//! 3. After a crash it is readable up to the last whole chunk. Damage is detected, and nothing is read from
//!    there on.
//! 4. It is cheap: data that only people look at (joints, skin, triangles that queries touched) is recorded
//!    less often; see [`RecordOptions`].
//!
//! ```
//! use clamber_climber::ClimberInput;
//! use clamber_record::{RecordOptions, Recorder, Recording, RecordingInfo, Replayed, TickView};
//! use clamber_record::{creature_fingerprint, palette_fingerprint, replay};
//! # use clamber_climber::{Climber, ClimberConfig};
//! # use clamber_surface::geometry::{Affine, Similarity};
//! # use clamber_surface::mesh::{BuildOptions, ColliderMesh, Influence, MeshSource};
//! # use clamber_surface::rig::{Joint, JointId, Palette, Skeleton, Transform};
//! # use clamber_surface::surface::SkinnedSurface;
//! # use clamber_world::{Obstacle, ObstacleId};
//! # use glam::{DVec3, Vec3};
//!
//! // The scene is a rising slab on one joint, and a climber that lands on it, walks and jumps.
//! # let joint = Joint {
//! #     name: "slab".into(),
//! #     parent: None,
//! #     rest: Transform::IDENTITY,
//! #     inverse_bind: Affine::IDENTITY,
//! # };
//! # let skeleton = Skeleton::new(vec![joint])?;
//! # let positions = [(-9.0, -9.0), (-9.0, 9.0), (9.0, 9.0), (9.0, -9.0)];
//! # let source = MeshSource {
//! #     positions: &positions.map(|(x, z)| Vec3::new(x, 0.0, z)),
//! #     triangles: &[[0, 1, 2], [0, 2, 3]],
//! #     influences: &[Influence { joint: JointId(0), weight: 1.0 }; 4],
//! #     joint_count: 1,
//! #     ..MeshSource::default()
//! # };
//! # let (mesh, _) = ColliderMesh::build(&source, &BuildOptions::default())?;
//! # let mesh = std::sync::Arc::new(mesh);
//! let dt = 1.0 / 60.0;
//! # struct Scene { skeleton: Skeleton, surface: SkinnedSurface, climber: Climber, palette: Palette }
//! # let start = || -> Result<Scene, Box<dyn std::error::Error>> {
//! #     let climber = Climber::new(ClimberConfig::default(), DVec3::new(0.0, 2.0, 0.0))?;
//! #     let surface = SkinnedSurface::new(mesh.clone());
//! #     Ok(Scene { skeleton: skeleton.clone(), surface, climber, palette: Palette::default() })
//! # };
//! # let step = |scene: &mut Scene, tick: u64, input: &ClimberInput| {
//! #     let mut pose = scene.skeleton.rest_pose();
//! #     pose.transforms[0].translation.y = 0.01 * tick as f32;
//! #     scene.palette = scene.skeleton.palette(&pose)?;
//! #     scene.surface.advance(&scene.palette, Similarity::from_translation(DVec3::ZERO))?;
//! #     let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &scene.surface)];
//! #     let report = scene.climber.step(input, &obstacles, dt)?;
//! #     Ok::<_, Box<dyn std::error::Error>>(report)
//! # };
//!
//! let info = RecordingInfo {
//!     creature: "slab".into(),
//!     creature_fingerprint: creature_fingerprint(&skeleton, &[], &mesh),
//!     tick_seconds: dt,
//!     climber: ClimberConfig::default(),
//!     settings: Default::default(),
//!     version: RecordingInfo::VERSION.into(),
//! };
//! let mut recorder = Recorder::new(Vec::new(), &info, &skeleton, RecordOptions::default())?;
//! let mut scene = start()?;
//! for tick in 1..=90 {
//!     let input = ClimberInput { walk: DVec3::X, jump: tick == 60, ..Default::default() };
//!     let report = step(&mut scene, tick, &input)?;
//!     recorder.tick(&TickView {
//!         tick,
//!         input: &input,
//!         state: scene.climber.state(),
//!         report: &report,
//!         surface: &scene.surface,
//!         palette: &scene.palette,
//!         scene_fingerprint: 0,
//!     })?;
//! }
//! let file = recorder.finish()?;
//!
//! let recording = Recording::from_bytes(file)?;
//! assert_eq!(recording.info(), &info);
//! let mut scene = start()?;
//! let ticks = replay(recording.ticks(), |recorded| {
//!     step(&mut scene, recorded.tick, &recorded.input)?;
//!     Ok::<_, Box<dyn std::error::Error>>(Replayed {
//!         state: *scene.climber.state(),
//!         palette_fingerprint: palette_fingerprint(&scene.palette),
//!         scene_fingerprint: None,
//!     })
//! })?;
//! assert_eq!(ticks, 90);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! It is not for streaming: there is no server. It is not for archives either: another version of this crate
//! may refuse a recording ([`RecordingInfo::version`] is the version that wrote it), and another build of the
//! scene may replay with different bits.

mod config;
mod error;
mod file;
mod fingerprint;
mod info;
mod messages;
mod recorder;
mod recording;
mod replay;
mod taken;
pub mod topics;
mod views;
mod writing;

pub use error::RecordError;
pub use fingerprint::{creature_fingerprint, palette_fingerprint};
pub use info::RecordingInfo;
pub use recorder::{RecordOptions, Recorder, TickView};
pub use recording::{Ending, RecordedSnapshot, RecordedTick, Recording};
pub use replay::{Difference, ReplayError, Replayed, replay};
