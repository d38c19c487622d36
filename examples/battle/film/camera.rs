//! The cameras of a film.

use clamber::geometry::rotation_from_axis_angle;
use clamber::glam::DVec3;
use clamber::prelude::*;
use clamber::render::Camera;
use clamber_scenes::battle::{Battle, TICK};
use clamber_scenes::picture::orbit;
use clamber_scenes::valley;

use crate::options::CameraKind;

/// Rate of the orbiting camera's turn, radians a second.
const ORBIT: f64 = 0.08;

/// Distances of a close camera from the climber and, at least, from the skin, metres.
const CLOSE: [f64; 2] = [2.4, 0.3];

/// The same of a chasing camera: visible fur reaches 0.8 m beyond the skin of a giant of 40 m.
const CHASE: [f64; 2] = [7.5, 1.4];

/// Half-lives of changes of their direction from the climber, and of their position, seconds.
const HALF_LIVES: [f64; 2] = [0.6, 0.12];

/// A climber that moves farther than this in a tick was teleported, metres; the camera follows at once.
const PUT: f64 = 8.0;

/// A camera, and its memory of earlier ticks.
pub(super) struct Views {
    kind: CameraKind,
    /// A copy of the creature's skin: its queries do not change the battle's own measurements.
    skin: Option<SkinnedSurface>,
    /// Unit vector from the climber to the eye.
    away: DVec3,
    eye: DVec3,
    climber: DVec3,
}

impl Views {
    pub(super) fn new(kind: CameraKind) -> Self {
        Self {
            kind,
            skin: None,
            away: DVec3::X,
            eye: DVec3::ZERO,
            climber: DVec3::INFINITY,
        }
    }

    /// The camera after another tick.
    pub(super) fn follow(&mut self, battle: &Battle<'_>) -> Camera {
        let mut skin = self.skin.take().unwrap_or_else(|| battle.surface().clone());
        // If the pose is refused, the last one stays.
        let _ = skin.teleport(battle.palette(), *battle.surface().world_from_model());
        let camera = match self.kind {
            CameraKind::Orbit => {
                let heading = 0.6 + ORBIT * TICK * battle.tick() as f64;
                orbit(battle, battle.height, heading)
            }
            CameraKind::Close => self.chase(battle, &skin, CLOSE),
            CameraKind::Chase => self.chase(battle, &skin, CHASE),
        };
        self.skin = Some(skin);
        camera
    }

    /// A camera that follows the climber. It turns towards the direction with the best view, comes nearer where skin is
    /// in the way, and keeps a distance from all skin.
    fn chase(
        &mut self,
        battle: &Battle<'_>,
        skin: &SkinnedSurface,
        [far, kept]: [f64; 2],
    ) -> Camera {
        let climber = battle.climber().state().position;
        let target = climber + DVec3::Y * 0.5;
        let is_new = self.climber.distance(climber) >= PUT;
        self.climber = climber;
        let ideal = outward(battle, self.away);
        let free = |away: DVec3| {
            let hit = skin.cast_ray(target, away, far + kept);
            hit.map_or(far, |hit| (hit.distance - kept).max(0.5 * hit.distance))
        };
        let last = self.away;
        let score = |away: &DVec3| free(*away) / far + 0.5 * away.dot(ideal) + 0.2 * away.dot(last);
        // Eight directions around the climber, at three heights.
        let around = (0..24u32).map(|index| {
            let turn = f64::from(index % 8) * core::f64::consts::FRAC_PI_4;
            let level = rotation_from_axis_angle(DVec3::Y, turn) * ideal;
            (level + DVec3::Y * (0.5 * f64::from(index / 8))).normalize()
        });
        let best = around.max_by(|a, b| score(a).total_cmp(&score(b)));
        let part = |half: f64| {
            if is_new {
                1.0
            } else {
                1.0 - libm::exp2(-TICK / half)
            }
        };
        let [turns, moves] = HALF_LIVES.map(part);
        self.away = last.lerp(best.unwrap_or(ideal), turns).normalize_or(ideal);
        let wanted = keep_out(skin, target + self.away * free(self.away), kept);
        let eye = keep_out(skin, self.eye.lerp(wanted, moves), kept);
        self.eye = eye.with_y(eye.y.max(valley::height(eye.x, eye.z) + 0.5));
        Camera::new(self.eye, target)
    }
}

/// The level direction outward from the skin that the climber holds, or from the creature.
fn outward(battle: &Battle<'_>, away: DVec3) -> DVec3 {
    let state = battle.climber().state();
    let root = battle.surface().world_from_model().translation;
    let out = match state.support {
        Some(support) if state.mode.is_holding() => support.normal_in_world(),
        _ => (state.position - root).normalize_or_zero() + away * 0.5,
    };
    (out + away * 0.01).with_y(0.0).normalize_or(DVec3::X)
}

/// The place moved away from the skin, up to a distance.
fn keep_out(skin: &SkinnedSurface, place: DVec3, kept: f64) -> DVec3 {
    let near = skin.in_world().closest_point(place, kept);
    near.map_or(place, |near| {
        let way = (place - near.point).normalize_or(near.normal);
        let is_outside = way.dot(near.normal) >= 0.0;
        let out = if is_outside { way } else { near.normal };
        near.point + out * kept
    })
}
