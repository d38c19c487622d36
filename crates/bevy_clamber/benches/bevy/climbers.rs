//! Climbers on the walking giant, by `ClimberPlugin` and by the core alone. Both must be in the same state after each
//! tick, to the bit.

use std::error::Error;
use std::time::Instant;

use bevy_app::{FixedPostUpdate, PostUpdate};
use bevy_clamber::clamber_climber::{
    Climber as Character, ClimberConfig, ClimberGroup, ClimberInput as Input, ClimberMode,
    ClimberState as State, StaminaConfig, StepRules,
};
use bevy_clamber::clamber_surface::geometry::Similarity;
use bevy_clamber::clamber_surface::mesh::{SurfaceKind, SurfaceTag, TriangleId};
use bevy_clamber::clamber_surface::rig::{Palette, Pose};
use bevy_clamber::clamber_surface::surface::{Anchor, SkinnedSurface};
use bevy_clamber::clamber_world::{Obstacle, ObstacleId};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_transform::components::Transform;
use clamber_scenes::Creature;
use clamber_scenes::measure::{Bound, Cells, quantile};

use super::{RATE, common, pass_frame, time, walk};
use crate::giants::{Giants, on_one_thread};

/// Distance from its seat at which a climber is put back, metres: it fell, or has gone far enough.
const AWAY: f64 = 6.0;

/// Ticks at the start that are not timed.
const SETTLE: usize = 4;

/// Smallest share of all climbers' ticks that they must spend on the giant, not falling.
const LEAST_BUSY: f64 = 0.7;

/// One climber, twice.
struct Twins {
    core: Character,
    bevy: Entity,
    seat: Anchor,
    input: Input,
}

/// Median time of a tick in which there is nothing to do, microseconds: what Bevy's schedule costs.
pub(crate) fn nothing(ticks: usize) -> f64 {
    let app = common::app_with(RATE, (ClamberPlugins::default(), ClimberPlugin::default()));
    let mut app = on_one_thread(app);
    let mut times: Vec<f64> = (0..ticks)
        .map(|_| {
            pass_frame(&mut app);
            time(&mut app, FixedPostUpdate)
        })
        .collect();
    quantile(&mut times, 0.5)
}

/// Adds rows for `count` climbers, half of whom climb about.
pub(crate) fn measure(
    creature: &Creature,
    count: usize,
    bound: Bound,
    ticks: usize,
    cells: &mut Cells,
) -> Result<(), Box<dyn Error>> {
    let poses = walk(creature, SETTLE + ticks)?;
    let app = common::app_with(RATE, (ClamberPlugins::default(), ClimberPlugin::default()));
    let app = on_one_thread(app);
    let mut giants = Giants::new(app, creature, 1, PoseTiming::EachTick);
    let giant = giants.surfaces[0];
    let fur = ColliderTag(SurfaceTag::new(SurfaceKind::Fur));
    giants.app.world_mut().entity_mut(giant).insert(fur);
    common::wait(&mut giants.app, giant);
    let mut surface = SkinnedSurface::new(giants.mesh());
    let mut palette = Palette::default();
    let mut group = ClimberGroup::default();
    creature
        .rig
        .skeleton
        .palette_into(&poses[0], &mut palette)?;
    surface.teleport(&palette, Similarity::IDENTITY)?;
    let mut climbers = spawn(&mut giants, &surface, count)?;
    let (mut core, mut bevy, mut frames) = (Vec::new(), Vec::new(), Vec::new());
    let mut busy = 0;
    for (tick, pose) in poses.iter().enumerate() {
        if tick == SETTLE {
            // Until now the surfaces came to the same pose, on which nobody stood.
            [&mut core, &mut bevy, &mut frames]
                .into_iter()
                .for_each(Vec::clear);
            busy = 0;
        }
        if tick >= SETTLE {
            sit(&mut climbers, &mut giants, &surface)?;
        }
        giants.pose(pose);
        pass_frame(&mut giants.app);
        // They take turns at being first, since the second finds warm caches.
        if tick.is_multiple_of(2) {
            bevy.push(time(&mut giants.app, FixedPostUpdate));
        }
        let start = Instant::now();
        step(
            &mut climbers,
            creature,
            pose,
            &mut palette,
            (giant, &mut surface),
            &mut group,
        )?;
        core.push(start.elapsed().as_secs_f64() * 1e6);
        if !tick.is_multiple_of(2) {
            bevy.push(time(&mut giants.app, FixedPostUpdate));
        }
        frames.push(time(&mut giants.app, PostUpdate));
        for (number, twins) in climbers.iter().enumerate() {
            let state = giants.app.world().get::<ClimberState>(twins.bevy);
            let state = state.ok_or("a climber is gone")?.0;
            if state != *twins.core.state() {
                let core = twins.core.state();
                return Err(
                    format!("tick {tick}, climber {number}: {state:?} is not {core:?}").into(),
                );
            }
            busy += usize::from(state.mode != ClimberMode::Falling);
        }
    }
    if (busy as f64) < LEAST_BUSY * (ticks * count) as f64 {
        return Err("too many climbers fall".into());
    }
    let name = |rest: &str| format!("{count} climbers: {rest}");
    let (core, bevy) = (quantile(&mut core, 0.5), quantile(&mut bevy, 0.5));
    cells.value(&name("the core's tick, us"), core);
    cells.value(&name("a tick in Bevy, us"), bevy);
    cells.push(&name("Bevy / core"), bevy / core, bound);
    cells.value(&name("all of PostUpdate, us"), quantile(&mut frames, 0.5));
    Ok(())
}

/// Climbers that never tire, spread evenly over the triangles.
fn spawn(
    giants: &mut Giants,
    surface: &SkinnedSurface,
    count: usize,
) -> Result<Vec<Twins>, Box<dyn Error>> {
    let mut config = ClimberConfig::colossus_climber();
    if let Some(stamina) = &mut config.stamina {
        *stamina = StaminaConfig {
            hold_drain: 0.0,
            shake_drain: 0.0,
            ..*stamina
        };
    }
    let triangles = surface.mesh().triangles().len();
    let spawn = |index: usize| -> Result<Twins, Box<dyn Error>> {
        let triangle = TriangleId(((index * 2 + 1) * triangles / (2 * count)) as u32);
        let walk = Vec3::Y * (index % 2) as f32;
        let steered = ClimberInput {
            walk,
            grip: true,
            ..ClimberInput::default()
        };
        // Its seat is far away, so that it is put there before the first tick.
        let core = Character::new(config, DVec3::Y * 1e4)?;
        let climber = (
            Climber { config },
            ClimberState(*core.state()),
            steered,
            Transform::IDENTITY,
        );
        Ok(Twins {
            core,
            bevy: giants.app.world_mut().spawn(climber).id(),
            seat: surface.anchor(triangle, [0.5, 0.25, 0.25])?,
            input: Input {
                walk: walk.as_dvec3(),
                grip: true,
                ..Input::default()
            },
        })
    };
    (0..count).map(spawn).collect()
}

/// Puts climbers that fell or went far back, just above their seats.
fn sit(
    climbers: &mut [Twins],
    giants: &mut Giants,
    surface: &SkinnedSurface,
) -> Result<(), Box<dyn Error>> {
    for twins in climbers {
        let motion = surface.in_model().motion(&twins.seat, 1.0 / RATE)?;
        let above = motion.normal.as_dvec3().normalize() * (twins.core.config().body.radius * 1.01);
        let position = motion.position.as_dvec3() + above;
        let state = *twins.core.state();
        if state.position.distance(position) > AWAY {
            let state = State {
                position,
                velocity: motion.velocity.as_dvec3(),
                mode: ClimberMode::Falling,
                support: None,
                support_velocity: None,
                hit_points: 1.0,
                ..state
            };
            twins.core.restore(state)?;
            let world = giants.app.world_mut();
            world.entity_mut(twins.bevy).insert(ClimberState(state));
        }
    }
    Ok(())
}

/// A tick of the core alone.
fn step(
    climbers: &mut [Twins],
    creature: &Creature,
    pose: &Pose,
    palette: &mut Palette,
    (giant, surface): (Entity, &mut SkinnedSurface),
    group: &mut ClimberGroup,
) -> Result<(), Box<dyn Error>> {
    creature.rig.skeleton.palette_into(pose, palette)?;
    surface.advance(palette, Similarity::IDENTITY)?;
    let giant = (ObstacleId(giant.to_bits()), &*surface as &dyn Obstacle);
    let cores = climbers.iter();
    let cores = cores.map(|twins| (ObstacleId(twins.bevy.to_bits()), &twins.core));
    group.update(cores, &[giant], 1.0 / RATE);
    for twins in climbers {
        let id = ObstacleId(twins.bevy.to_bits());
        let obstacles: Vec<_> = [giant].into_iter().chain(group.others(id)).collect();
        let rules = StepRules {
            id: Some(id),
            ..StepRules::default()
        };
        twins
            .core
            .step_with(&twins.input, &obstacles, &rules, 1.0 / RATE)?;
    }
    Ok(())
}
