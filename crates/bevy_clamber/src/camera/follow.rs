//! Where a camera is in a frame.

use bevy_ecs::prelude::*;
use bevy_math::Vec2;
use bevy_time::Time;
use bevy_transform::components::Transform;
use clamber_world::WorldCapsule;
use glam::{DQuat, DVec3};

use super::component::{CameraState, ClimberCamera, ClimberCameraInput};
use crate::WorldOrigin;
use crate::climber::{ClimberBody, ClimberFilter, DrawnTouchable};

/// Time in which most of the way back is made when nothing is in the way any more, seconds.
const BACK: f64 = 0.2;

/// How far behind a fast climber it looks at most, as a share of its distance.
const LAG: f64 = 0.25;

/// Largest radius of the camera's ball, as a share of the radius of the climber's ball.
const LARGEST: f64 = 0.75;

/// A climber that is farther away than this many times the camera's distance was teleported.
const FAR: f64 = 3.0;

type Camera = (
    &'static ClimberCamera,
    &'static mut ClimberCameraInput,
    &'static mut CameraState,
    &'static mut Transform,
);

pub(super) fn follow(
    time: Res<Time>,
    origin: Res<WorldOrigin>,
    climbers: Query<(&ClimberBody, &Transform, Option<&ClimberFilter>)>,
    touchable: DrawnTouchable<'_, '_>,
    mut cameras: Query<Camera, Without<ClimberBody>>,
) {
    let dt = time.delta_secs_f64();
    for (camera, mut input, mut state, mut transform) in &mut cameras {
        let swing = std::mem::take(&mut input.bypass_change_detection().swing);
        let Ok((body, drawn, filter)) = climbers.get(camera.target) else {
            continue;
        };
        let body_place = origin.0 + drawn.translation.as_dvec3();
        let up = body.config().up();
        let upright = DQuat::from_rotation_arc(DVec3::Y, up);
        let target = body_place + up * f64::from(camera.height);
        if !state.is_placed {
            // Behind the climber.
            let ahead = upright.conjugate() * drawn.forward().as_vec3().as_dvec3();
            state.angles = Vec2::new(libm::atan2(ahead.x, -ahead.z) as f32, camera.level);
        }
        state.turn(camera, input.stick, swing, dt as f32);
        state.look_at(camera, target, body.carried(), dt);

        let body_radius = body.config().body.radius;
        let radius = f64::from(camera.radius).min(LARGEST * body_radius);
        let free = |radius: f64, from: DVec3, way: DVec3| {
            let ball = WorldCapsule::ball(from, radius);
            touchable.free_way(filter, &ball, way).unwrap_or(1.0)
        };
        // The body's own place is free. The point that it looks at may not be free: a larger ball goes there, so
        // that the camera's ball touches nothing where its way begins.
        let rise = state.pivot - body_place;
        let larger = 0.5 * (radius + body_radius);
        let pivot = body_place + rise * free(larger, body_place, rise);
        let [turn, tilt] = state.angles.to_array().map(f64::from);
        let rotation = upright * about(DVec3::Y, -turn) * about(DVec3::X, -tilt);
        let back = rotation * DVec3::Z * f64::from(camera.distance);
        let distance = back.length() * free(radius, pivot, back);
        if !state.is_placed || distance < state.distance {
            state.distance = distance;
        } else {
            let left = libm::exp(-dt / BACK);
            state.distance = distance + (state.distance - distance) * left;
        }
        state.is_placed = true;
        let place = pivot + back.normalize_or_zero() * state.distance;
        transform.set_if_neq(Transform {
            translation: (place - origin.0).as_vec3(),
            rotation: rotation.as_quat(),
            scale: transform.scale,
        });
    }
}

/// A rotation about a unit axis, radians.
fn about(axis: DVec3, angle: f64) -> DQuat {
    clamber_surface::geometry::rotation_from_axis_angle(axis, angle)
}

impl CameraState {
    /// Turns by the player's input.
    fn turn(&mut self, camera: &ClimberCamera, stick: Vec2, swing: Vec2, dt: f32) {
        let stick = if stick.is_finite() {
            stick.clamp_length_max(1.0)
        } else {
            Vec2::ZERO
        };
        let tilting = if stick.y.abs() < camera.tilt_from {
            0.0
        } else {
            -stick.y
        };
        let wanted = Vec2::new(stick.x, tilting) * camera.speed;
        let change = camera.speed.abs() * dt / camera.response.max(f32::MIN_POSITIVE);
        let change = (wanted - self.turning).clamp(-change, change);
        self.turning += change;
        self.angles += self.turning * dt;
        if swing.is_finite() {
            self.angles += swing * Vec2::new(1.0, -1.0);
        }
        if camera.centring > 0.0 && stick.length() <= 0.5 {
            let left = libm::expf(-3.0 * dt / camera.centring);
            self.angles.y = camera.level + (self.angles.y - camera.level) * left;
        }
        let [low, high] = camera.tilts;
        self.angles.y = self.angles.y.max(low).min(high);
        self.angles.x %= core::f32::consts::TAU;
    }

    /// Follows the climber: at once where it is carried, smoothly where it moves by itself.
    fn look_at(&mut self, camera: &ClimberCamera, target: DVec3, carried: DVec3, dt: f64) {
        self.pivot += carried;
        let apart = self.pivot - target;
        let far = FAR * f64::from(camera.distance.max(1.0));
        if !self.is_placed || !apart.is_finite() || apart.length() > far {
            self.pivot = target;
            return;
        }
        let smoothing = f64::from(camera.smoothing).max(f64::MIN_POSITIVE);
        let apart = apart.clamp_length_max(LAG * f64::from(camera.distance));
        self.pivot = target + apart * libm::exp(-dt / smoothing);
    }
}
