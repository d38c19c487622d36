//! Plays jumps by climbers on the skin as it moves.

use clamber_climber::{Climber, ClimberInput, ClimberMode, ClimberState, ContactQuery, StepRules};
use clamber_surface::mesh::Rig;
use clamber_surface::rig::{Palette, Playback, Pose};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

use super::{Aim, ClimbGraph, Footing, LONGEST_FLIGHT};
use crate::NavigationError;
use crate::clips::TICK;
use crate::graph::Spot;

/// A climber stands for this many ticks before it jumps, and has to be at rest for as many at the end.
const SETTLE_TICKS: u32 = 6;

/// The longest time from a take-off until the climber is at rest, as a multiple of the expected flight time. The time
/// of [`PULL_UPS`] is added.
const LATEST_REST_FACTOR: f64 = 1.5;
/// Number of pull-ups over a ledge for which a jump has time.
const PULL_UPS: f64 = 2.0;

/// Progress is reported once in this many ticks.
const TICKS_PER_REPORT: u32 = 32;

/// The landing of a jump that was played.
#[derive(Clone, Copy, Debug)]
pub(super) struct Played {
    pub(super) patch: u32,
    pub(super) footing: Footing,
    pub(super) seconds: f32,
    pub(super) costs: f32,
}

/// When and where jumps begin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    /// The clip that plays; `None` for the creature at rest.
    pub(super) clip: Option<usize>,
    /// Time of the take-off in the clip, seconds.
    pub(super) begins: f64,
    /// Offset of the take-off from its patch, radii, along two horizontal axes.
    pub(super) off: [f64; 2],
}

impl Moment {
    /// A jump on the creature at rest, from its exact place.
    pub(super) const AT_REST: Self = Self {
        clip: None,
        begins: 0.0,
        off: [0.0; 2],
    };
}

/// The creature, with the memory that playing jumps needs.
pub(super) struct Theatre<'a> {
    graph: &'a ClimbGraph,
    rig: &'a Rig,
    surface: SkinnedSurface,
    rest: Pose,
    pose: Pose,
    palette: Palette,
}

/// A climber that plays a jump.
struct Jumper {
    climber: Climber,
    ends: [u32; 2],
    /// The jump's aim; `None` before the take-off, and if the jump cannot be aimed.
    aim: Option<Aim>,
    /// Stamina spent since the take-off.
    spent: f64,
    /// True once the climber has been in the air.
    flies: bool,
    /// Number of ticks for which it has been at rest.
    rests: u32,
    /// The result; `None` while the jump is played, `Some(None)` if it did not land.
    ended: Option<Option<Played>>,
}

/// The creature's obstacle id while jumps are played.
const CREATURE_ID: ObstacleId = ObstacleId(0);

impl<'a> Theatre<'a> {
    pub(super) fn new(graph: &'a ClimbGraph, rig: &'a Rig) -> Result<Self, NavigationError> {
        let pose = rig.skeleton.rest_pose();
        Ok(Self {
            graph,
            rig,
            surface: SkinnedSurface::new(rig.collider.clone()),
            palette: rig.skeleton.palette(&pose)?,
            rest: pose.clone(),
            pose,
        })
    }

    /// The skin at rest.
    pub(super) fn at_rest(&mut self) -> Result<&SkinnedSurface, NavigationError> {
        self.show(None, 0.0, false)?;
        Ok(&self.surface)
    }

    /// Length of a clip at its rate, seconds.
    pub(super) fn seconds(&self, clip: usize) -> f64 {
        self.rig.clips[clip].duration() / self.graph.config.clip_rate
    }

    /// Poses the skin at a time of a clip, or at rest for `None`. With `moves` the skin moves there from its last pose;
    /// without, it has no motion.
    fn show(
        &mut self,
        clip: Option<usize>,
        seconds: f64,
        moves: bool,
    ) -> Result<(), NavigationError> {
        let rig = self.rig;
        if let Some(index) = clip {
            let clip = &rig.clips[index];
            let playback = if self.graph.clips.clips[index].loops {
                Playback::Loop
            } else {
                Playback::Clamp
            };
            // Clips do not move all joints.
            self.pose.clone_from(&self.rest);
            clip.sample_into(
                seconds * self.graph.config.clip_rate,
                playback,
                &mut self.pose,
            )?;
            rig.skeleton.palette_into(&self.pose, &mut self.palette)?;
        }
        if moves {
            self.surface
                .advance(&self.palette, self.graph.config.world_from_model)?;
        } else {
            self.surface
                .teleport(&self.palette, self.graph.config.world_from_model)?;
        }
        Ok(())
    }

    /// Plays jumps, and returns where each came to rest; `None` for a jump that did not land.
    pub(super) fn play(
        &mut self,
        ends: &[[u32; 2]],
        when: Moment,
        tell: &mut dyn FnMut() -> Result<(), NavigationError>,
    ) -> Result<Vec<Option<Played>>, NavigationError> {
        let Moment { clip, begins, off } = when;
        let graph = self.graph;
        let config = graph.config.climber;
        let up = config.up();
        let along = up.any_orthonormal_vector();
        let off = (along * off[0] + up.cross(along) * off[1]) * config.body.radius;
        let first = begins - f64::from(SETTLE_TICKS) * TICK;
        self.show(clip, first - TICK, false)?;
        let seat = |surface: &SkinnedSurface, patch: u32| {
            Spot::of(surface, &graph.patches[patch as usize]).seat
        };
        let before: Vec<DVec3> = ends
            .iter()
            .map(|[from, _]| seat(&self.surface, *from))
            .collect();
        self.show(clip, first, true)?;
        let mut jumpers = Vec::with_capacity(ends.len());
        for (ends, before) in ends.iter().zip(before) {
            let here = seat(&self.surface, ends[0]);
            let mut climber = Climber::new(config, here + off)?;
            let still = *climber.state();
            climber.restore(ClimberState {
                velocity: (here - before) / TICK,
                ..still
            })?;
            jumpers.push(Jumper {
                climber,
                ends: *ends,
                aim: None,
                spent: 0.0,
                flies: false,
                rests: 0,
                ended: None,
            });
        }
        let grips =
            |query: &ContactQuery<'_>| query.usual().with_grip(graph.config.can_grip(&query.tag()));
        let rules = StepRules::by(&grips);
        let mut tick: u32 = 1;
        while jumpers.iter().any(|jumper| jumper.ended.is_none()) {
            if tick.is_multiple_of(TICKS_PER_REPORT) {
                tell()?;
            }
            self.show(clip, first + f64::from(tick) * TICK, true)?;
            let around: [(ObstacleId, &dyn Obstacle); 1] = [(CREATURE_ID, &self.surface)];
            for jumper in jumpers.iter_mut().filter(|jumper| jumper.ended.is_none()) {
                let after = tick.checked_sub(SETTLE_TICKS);
                jumper.step(graph, &around, &self.surface, after, &rules)?;
            }
            tick += 1;
        }
        Ok(jumpers
            .into_iter()
            .map(|jumper| jumper.ended.flatten())
            .collect())
    }
}

impl Jumper {
    /// One tick of the jump. `after` is the number of ticks since the take-off, `None` before it.
    fn step(
        &mut self,
        graph: &ClimbGraph,
        around: &[(ObstacleId, &dyn Obstacle)],
        surface: &SkinnedSurface,
        after: Option<u32>,
        rules: &StepRules<'_>,
    ) -> Result<(), NavigationError> {
        let config = &graph.config.climber;
        let seconds = after.map(|after| f64::from(after) * TICK);
        let seat = |patch: u32| Spot::of(surface, &graph.patches[patch as usize]).seat;
        if after == Some(0) && self.climber.state().mode == ClimberMode::Standing {
            self.aim = Aim::at(config, seat(self.ends[0]), seat(self.ends[1]));
        }
        let input = match (seconds, self.aim) {
            (None, _) => ClimberInput::IDLE,
            (Some(seconds), Some(aim)) => aim.input(config, seconds),
            (Some(_), None) => {
                self.ended = Some(None);
                return Ok(());
            }
        };
        let had = self.climber.state().stamina;
        self.climber.step_with(&input, around, rules, TICK)?;
        let state = self.climber.state();
        let (Some(seconds), Some(aim)) = (seconds, self.aim) else {
            return Ok(());
        };
        self.spent += (had - state.stamina).max(0.0);
        let footing = match state.mode {
            ClimberMode::Standing => Some(Footing::Stands),
            ClimberMode::Holding => Some(Footing::Holds),
            _ => None,
        };
        self.flies |= footing.is_none();
        self.rests = if footing.is_some() && self.flies {
            self.rests + 1
        } else {
            0
        };
        if self.rests >= SETTLE_TICKS {
            let support = state.support.and_then(|support| {
                let material = support.attachment.material;
                let weights = material.coordinates.map(|weight| weight as f32);
                graph.patch_of(material.triangle()?, weights)
            });
            self.ended = Some(support.zip(footing).map(|(patch, footing)| Played {
                patch: patch as u32,
                footing,
                seconds: seconds as f32,
                costs: self.spent as f32,
            }));
            return Ok(());
        }
        let pulls = config
            .ledge
            .map_or(0.0, |ledge| PULL_UPS * ledge.pull_up_time);
        let latest = (LATEST_REST_FACTOR * aim.seconds + pulls).min(2.0 * LONGEST_FLIGHT);
        if seconds > latest || state.mode == ClimberMode::Tumbling {
            self.ended = Some(None);
        }
        Ok(())
    }
}
