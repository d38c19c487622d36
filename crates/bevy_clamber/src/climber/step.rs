//! The tick of all climbers.

use bevy_ecs::change_detection::{DetectChanges, Tick};
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_math::{Quat, Vec3};
use bevy_time::Time;
use bevy_transform::components::Transform;
use clamber_climber::{
    ClimberConfig, ClimberError, ClimberGroup, ContactQuery, CustomMode, StepReport, StepRules,
};
use clamber_surface::mesh::MeshId;
use clamber_world::{Attachment, MaterialPoint, ObstacleId};
use glam::{DMat3, DQuat, DVec3};

use super::component::{Climber, ClimberBody, ClimberFilter, ClimberState};
use super::events::{Told, tell_event};
use super::input::{ClimberInput, LatchedInput};
use super::obstacles::{Touchable, touched};
use super::rules::{AirVelocity, ClimberModes, ClimberRule, ClimberTouch, DefaultClimberRule};
use super::shown::Shown;
use crate::{PosedSurface, WorldOrigin};

/// Up to this number, one thread steps all climbers sooner than other threads wake up.
const FEW: usize = 4;

/// A climber that the app may have changed.
type Followed = (
    Entity,
    Ref<'static, Climber>,
    &'static Transform,
    Option<Ref<'static, ClimberState>>,
    Option<&'static mut ClimberBody>,
);

/// Makes the bodies of new climbers, and takes over what the app changed: states and transforms.
pub(super) fn follow_changes(
    mut climbers: Query<Followed>,
    origin: Res<WorldOrigin>,
    mut commands: Commands,
) {
    for (entity, climber, transform, state, body) in &mut climbers {
        let Some(mut body) = body else {
            if !climber.is_changed() && state.is_none() {
                // Refused and logged already.
                continue;
            }
            match new_body(&climber.config, transform, origin.0, state.as_deref()) {
                Ok(body) => {
                    let state = ClimberState(*body.climber.state());
                    commands.entity(entity).try_insert((body, state));
                }
                Err(error) => tracing::error!("no climber for {entity}: {error}"),
            }
            continue;
        };
        // A climber that is not stepped, because the app has taken its input away, tells nothing again.
        body.bypass_change_detection().report = StepReport::default();
        if state.is_none() {
            let state = ClimberState(*body.climber.state());
            commands.entity(entity).try_insert(state);
        }
        if let Some(state) = state
            && state.last_changed() != body.written
        {
            body.written = state.last_changed();
            let before = body.climber.state().position;
            match body.take_over(&state) {
                Ok(()) if state.position != before || body.is_drawn_near(transform, origin.0) => {
                    body.drawn = *transform;
                    body.origin = origin.0;
                }
                Ok(()) => {}
                Err(error) => tracing::error!("climber {entity} keeps its state: {error}"),
            }
        }
        if body.is_moved(transform, origin.0) {
            body.teleport(transform, origin.0);
        }
    }
}

fn new_body(
    config: &ClimberConfig,
    transform: &Transform,
    origin: DVec3,
    state: Option<&ClimberState>,
) -> Result<ClimberBody, ClimberError> {
    let position = origin + transform.translation.as_dvec3();
    let mut climber = clamber_climber::Climber::new(*config, position)?;
    let mut begin = *climber.state();
    begin.heading = level(transform.rotation, config.up(), begin.heading);
    climber.restore(state.map_or(begin, |state| state.0))?;
    Ok(ClimberBody {
        shown: Shown::new(climber.state()),
        climber,
        report: StepReport::default(),
        support_mesh: None,
        written: Tick::new(0),
        drawn: *transform,
        origin,
    })
}

/// The direction of a rotation's -Z, made level.
fn level(rotation: Quat, up: DVec3, otherwise: DVec3) -> DVec3 {
    let ahead = (rotation * Vec3::NEG_Z).as_dvec3();
    (ahead - up * ahead.dot(up)).normalize_or(otherwise)
}

impl ClimberBody {
    /// Goes on from a state that the app has written.
    fn take_over(&mut self, state: &ClimberState) -> Result<(), ClimberError> {
        if state.0 != *self.climber.state() {
            self.climber.restore(state.0)?;
            self.forget_motion();
        }
        Ok(())
    }

    /// True if the climber may have been drawn here, in its last tick or in the one before.
    fn is_drawn_near(&self, transform: &Transform, origin: DVec3) -> bool {
        let (state, config) = (self.climber.state(), self.climber.config());
        let apart = origin + transform.translation.as_dvec3() - state.position;
        apart.length() <= config.body.radius
    }

    /// The next frames do not draw how it got here.
    fn forget_motion(&mut self) {
        self.shown = Shown::new(self.climber.state());
        self.support_mesh = None;
    }

    /// Lets the climber fall from where the app has put its transform.
    fn teleport(&mut self, to: &Transform, origin: DVec3) {
        let was = *self.climber.state();
        let config = *self.climber.config();
        let position = origin + to.translation.as_dvec3();
        let Ok(new) = clamber_climber::Climber::new(config, position) else {
            return;
        };
        let begin = clamber_climber::ClimberState {
            heading: level(to.rotation, config.up(), was.heading),
            stamina: was.stamina,
            hit_points: was.hit_points,
            custom_slots: was.custom_slots,
            ..*new.state()
        };
        if self.climber.restore(begin).is_ok() {
            self.drawn = *to;
            self.origin = origin;
            self.forget_motion();
        }
    }
}

/// A climber that is stepped.
#[derive(QueryData)]
#[query_data(mutable)]
pub(super) struct Stepped {
    entity: Entity,
    climber: Ref<'static, Climber>,
    body: &'static mut ClimberBody,
    state: &'static mut ClimberState,
    input: &'static mut ClimberInput,
    latched: &'static mut LatchedInput,
    filter: Option<&'static ClimberFilter>,
    rule: Option<&'static ClimberRule>,
}

/// Steps all climbers.
pub(super) fn step_climbers(
    time: Res<Time>,
    touchable: Touchable<'_, '_>,
    default_rule: Option<Res<DefaultClimberRule>>,
    modes: Option<Res<ClimberModes>>,
    air: Res<AirVelocity>,
    mut climbers: Query<Stepped>,
    mut group: Local<ClimberGroup>,
) {
    let dt = time.delta_secs_f64();
    if dt <= 0.0 {
        return;
    }
    let all: Vec<(ObstacleId, &clamber_climber::Climber)> = climbers
        .iter()
        .map(|climber| (ObstacleId(climber.entity.to_bits()), &climber.body.climber))
        .collect();
    let count = all.len();
    // Their supports alone are asked, which no filter hides.
    touchable.around(Entity::PLACEHOLDER, None, None, None, |obstacles| {
        group.update(all.iter().copied(), obstacles, dt);
    });
    let group = &*group;
    let modes = modes.as_ref().map_or(&[][..], |modes| &modes.0[..]);
    let step = |mut stepped: SteppedItem<'_, '_>| {
        let entity = stepped.entity;
        let body = &mut *stepped.body;
        let (input, knockback) = stepped
            .latched
            .take(stepped.input.bypass_change_detection());
        let rule = stepped.rule.or(default_rule.as_ref().map(|rule| &rule.0));
        let decide = |query: &ContactQuery<'_>| match rule {
            None => query.usual(),
            Some(rule) => rule.decide(&ClimberTouch {
                climber: entity,
                entity: touchable.entity(query.id, Some(&query.contact.material)),
                query,
            }),
        };
        let modes: Vec<&dyn CustomMode> = modes.iter().map(|mode| &**mode as _).collect();
        let rules = StepRules {
            contact: rule.is_some().then_some(&decide),
            modes: &modes,
            id: Some(ObstacleId(entity.to_bits())),
            air_velocity: air.0,
            knockback,
        };
        let gone = body.lost_point(&touchable);
        body.forget_jump(&touchable);
        let climber = &mut body.climber;
        let wanted = &stepped.climber;
        let result = touchable.around(entity, stepped.filter, Some(group), gone, |obstacles| {
            if *climber.config() != wanted.config
                && let Err(error) = climber.try_resize_with(wanted.config, obstacles, &rules)
                && wanted.is_changed()
            {
                tell_refused(entity, &error);
            }
            climber.step_with(&input, obstacles, &rules, dt)
        });
        match result {
            Ok(report) => body.report = report,
            Err(error) => {
                tracing::warn!("climber {entity} stood still for a tick: {error}");
                body.report = StepReport::default();
            }
        }
        body.support_mesh = body.mesh_below(&touchable);
        let surface = |on: &Attachment| touchable.surface(on.obstacle).map(|surface| &**surface);
        body.shown.tick(body.climber.state(), surface, dt);
        let state = ClimberState(*body.climber.state());
        stepped.state.set_if_neq(state);
        body.written = stepped.state.last_changed();
    };
    if count <= FEW {
        climbers.iter_mut().for_each(step);
    } else {
        climbers.par_iter_mut().for_each(step);
    }
}

/// Tells of a configuration that is not taken over, or not yet.
fn tell_refused(entity: Entity, error: &ClimberError) {
    if matches!(error, ClimberError::NoRoom { .. }) {
        tracing::debug!("climber {entity} keeps its size until there is room");
    } else {
        tracing::error!("climber {entity} keeps its configuration: {error}");
    }
}

impl ClimberBody {
    /// The point of its support, if the surface there has another mesh than in the last tick.
    fn lost_point(&self, touchable: &Touchable<'_, '_>) -> Option<(ObstacleId, MaterialPoint)> {
        let support = self.climber.state().support?.attachment;
        let (id, mesh) = self.support_mesh?;
        let surface = touchable.surface(id)?;
        let is_another = id == support.obstacle && !surface.mesh().continues(mesh);
        is_another.then_some((id, support.material))
    }

    /// Forgets how fast its support was, if nobody knows how that got where it is: the climber would feel a jolt.
    fn forget_jump(&mut self, touchable: &Touchable<'_, '_>) {
        let state = *self.climber.state();
        let surface = state
            .support
            .and_then(|on| touchable.surface(on.attachment.obstacle));
        if surface.is_some_and(PosedSurface::has_jumped) && state.support_velocity.is_some() {
            // A state that only knows less is never refused.
            let _ = self.climber.restore(clamber_climber::ClimberState {
                support_velocity: None,
                ..state
            });
        }
    }

    fn mesh_below(&self, touchable: &Touchable<'_, '_>) -> Option<(ObstacleId, MeshId)> {
        let id = self.climber.state().support?.attachment.obstacle;
        Some((id, touchable.surface(id)?.mesh().id()))
    }
}

/// Tells what happened to the climbers, in the order of their entities.
pub(super) fn tell(
    climbers: Query<(Entity, &ClimberBody), With<Climber>>,
    touchable: Touchable<'_, '_>,
    origin: Res<WorldOrigin>,
    mut commands: Commands,
) {
    let mut eventful: Vec<_> = climbers
        .iter()
        .filter(|(_, body)| !body.report.events.is_empty())
        .collect();
    eventful.sort_unstable_by_key(|(entity, _)| *entity);
    for (entity, body) in eventful {
        let told = Told {
            entity,
            hit_points: body.climber.state().hit_points,
            origin: origin.0,
            touched: &|id| touchable.entity(id, touched(body.contacts(), id)),
            supports: &|from: &Attachment| touchable.entity(from.obstacle, Some(&from.material)),
        };
        for event in &body.report.events {
            tell_event(event, &told, &mut commands);
        }
    }
}

/// Pushes the bodies of physics engines that climbers have pushed.
#[cfg(any(feature = "avian", feature = "rapier"))]
pub(super) fn push(
    climbers: Query<(Entity, &ClimberBody), With<Climber>>,
    mut engines: super::obstacles::Pushes<'_, '_>,
) {
    let mut pushing: Vec<_> = climbers
        .iter()
        .filter(|(_, body)| !body.report.pushes.is_empty())
        .collect();
    pushing.sort_unstable_by_key(|(entity, _)| *entity);
    for (_, body) in pushing {
        for push in &body.report.pushes {
            engines.push(push);
        }
    }
}

/// The rotation whose -Z is a heading, and whose +Y is up.
pub(super) fn facing(heading: DVec3, up: DVec3) -> Option<DQuat> {
    let right = heading.cross(up).try_normalize()?;
    let back = right.cross(up);
    Some(DQuat::from_mat3(&DMat3::from_cols(right, up, back)).normalize())
}
