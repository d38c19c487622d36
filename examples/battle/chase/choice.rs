//! Chooses the direction from which the climber is seen best, by a score of some directions around it.

use clamber::prelude::*;
use clamber_scenes::battle::{Battle, CREATURE, TERRAIN};
use clamber_scenes::valley;
use glam::DVec3;

use super::face::Seen;
use super::skin::{KEPT, Skin};
use super::view::ABOVE_GROUND;

/// Number of directions around the climber at each height.
const AROUND: u32 = 16;
/// Heights of the directions above the horizon, radians.
const HEIGHTS: [f64; 5] = [-0.25, 0.1, 0.4, 0.75, 1.05];

/// Skin nearer to the eye than this counts against a direction, metres.
const ROOM: f64 = 4.0;

/// Difference by which another direction's score must be higher. With less, the camera goes to and fro.
const BETTER: f64 = 0.15;

/// Weight of a free view of the climber in the score.
const FREE: f64 = 3.0;
/// Weight of the eye's distance from the skin, up to [`ROOM`].
const NEAR: f64 = 0.8;
/// Weight of the cosine of the angle to the ideal direction, outside of stabs.
const IDEAL: f64 = 2.0;
/// Weight of the cosine of the angle to the eye's current direction.
const SHORT: f64 = 0.6;
/// Subtracted if the view of the climber is blocked half way to the new direction.
const BLOCKED: f64 = 0.8;
/// Subtracted if the eye would be too low above the ground.
const LOW: f64 = 1.0;
/// Weight of a free view of the face, in a stab.
const FACE: f64 = 1.5;
/// Weight of the cosine of the angle from the face's front, up to [`PROFILE`], in a stab.
const FRONT: f64 = 2.0;

/// Cosine of the angle from the face's front at which the face is seen well enough. This is hardly more than its
/// profile: from the front, the head hides a climber on the nape.
const PROFILE: f64 = 0.25;

/// Weight of the sine of the height angle in a stab, up to [`ENOUGH`]: from a low place, the head hides a climber on
/// its top.
const HIGH: f64 = 1.2;
/// Sine of the height angle above which more height does not raise the score.
const ENOUGH: f64 = 0.5;

/// Height of the climber's head above the centre of its ball, metres: in a stab, a free view of the head counts as
/// well.
const HEAD: f64 = 1.1;

/// Time after which a direction should still be free, seconds.
const SOON: f64 = 0.5;

/// Distance in front of the face's skin at which its sight line begins, metres.
const BEFORE_FACE: f64 = 0.5;

/// Height above the climber at which the camera looks while the climber is not on the creature, metres.
const LOOKS_UP: f64 = 1.7;

/// The surroundings of the climber in one tick.
pub(super) struct Scene<'a> {
    battle: &'a Battle<'a>,
    pub(super) skin: &'a Skin,
    pub(super) face: Option<Seen>,
    pub(super) climber: DVec3,
    /// The middle of the giant's joints.
    pub(super) giant: DVec3,
    /// The climber's position after [`SOON`], if it keeps its velocity.
    soon: DVec3,
    pub(super) up: DVec3,
    /// Height above the climber at which the camera looks, metres.
    pub(super) looks_up: f64,
    on_creature: bool,
}

/// The input of a choice of a direction.
pub(super) struct Choice {
    pub(super) pivot: DVec3,
    pub(super) distance: f64,
    /// Unit vectors from the pivot: to the eye now, and to the last chosen place of the eye.
    pub(super) away: DVec3,
    pub(super) wanted: DVec3,
    /// True if the face should be seen as well.
    pub(super) stab: bool,
}

impl<'a> Scene<'a> {
    pub(super) fn new(battle: &'a Battle<'a>, skin: &'a Skin, face: Option<Seen>) -> Self {
        let (config, state) = (battle.climber().config(), battle.climber().state());
        let on_creature = state
            .support
            .is_some_and(|support| support.attachment.obstacle == CREATURE);
        let way = state.velocity * SOON;
        let free = skin.free(state.position, way, way.length());
        let soon = state.position + way.clamp_length_max(0.9 * free);
        Self {
            battle,
            skin,
            face,
            climber: state.position,
            giant: giant(battle),
            soon,
            up: config.up(),
            looks_up: if on_creature { 0.0 } else { LOOKS_UP },
            on_creature,
        }
    }

    /// Length of a way from a place up to the first skin or ground, less a distance from it.
    pub(super) fn free(&self, from: DVec3, way: DVec3) -> f64 {
        let far = way.length();
        let Some(toward) = way.try_normalize() else {
            return far;
        };
        let skin = self.skin.free(from, toward, far);
        let skin = if skin < far {
            (skin - KEPT).max(0.5 * skin)
        } else {
            far
        };
        let ground = self.battle.touched(|obstacles| {
            let mut terrain = obstacles.iter().filter(|(id, _)| *id == TERRAIN);
            terrain.find_map(|(_, obstacle)| obstacle.cast_ray(from, toward, far))
        });
        ground.map_or(skin, |ground| skin.min(0.9 * ground.distance))
    }

    /// The direction from which the climber is best seen if the view is free: outward from its hold; or a mix of the
    /// direction of the eye and the direction from the giant to the climber.
    pub(super) fn ideal(&self, away: DVec3) -> DVec3 {
        let state = self.battle.climber().state();
        let level = |way: DVec3| way - self.up * way.dot(self.up);
        let root = self.battle.surface().world_from_model().translation;
        let outward = level(state.position - root).normalize_or_zero();
        let stays = level(away).normalize_or(DVec3::X);
        let out = state.support.map(|support| support.normal_in_world());
        let (side, height) = match out {
            Some(out) if state.mode.is_holding() && level(out).length() > 0.3 => (
                level(out).normalize_or(stays),
                0.35 + 0.5 * out.dot(self.up).max(-0.5),
            ),
            Some(_) if self.on_creature => (stays + outward * 0.3, 0.55),
            _ => (outward + stays * 0.5, 0.2),
        };
        (side.normalize_or(stays) + self.up * height).normalize_or(DVec3::X)
    }

    /// The best direction from the pivot to the eye: a unit vector.
    pub(super) fn choose(&self, choice: &Choice) -> DVec3 {
        let ideal = self.ideal(choice.away);
        let score = |toward: &DVec3| self.score(*toward, ideal, choice);
        let around = (0..AROUND).flat_map(|side| {
            let angle = f64::from(side) / f64::from(AROUND) * core::f64::consts::TAU;
            let (sin, cos) = libm::sincos(angle);
            HEIGHTS.map(|height| {
                let (up, level) = libm::sincos(height);
                DVec3::new(level * sin, up, level * cos)
            })
        });
        let all = around.chain([ideal]).map(|toward| (score(&toward), toward));
        let best = all.max_by(|a, b| a.0.total_cmp(&b.0));
        match best {
            Some((best, toward)) if best > score(&choice.wanted) + BETTER => toward,
            _ => choice.wanted,
        }
    }

    fn score(&self, toward: DVec3, ideal: DVec3, choice: &Choice) -> f64 {
        let eye = choice.pivot + toward * choice.distance;
        let sight = |from: DVec3, eye: DVec3| {
            let way = eye - from;
            self.free(from, way) / way.length().max(1e-9)
        };
        let room = self.skin.room(eye, ROOM) / ROOM;
        let low = valley::height(eye.x, eye.z) + ABOVE_GROUND > eye.y;
        let half_way = (choice.away + toward).normalize_or(self.up);
        let between = sight(self.climber, choice.pivot + half_way * choice.distance);
        let moved = self.soon - self.climber;
        let free = sight(self.climber, eye).min(sight(self.soon, eye + moved));
        let mut score = FREE * free + NEAR * room + SHORT * toward.dot(choice.away)
            - if between < 0.8 { BLOCKED } else { 0.0 }
            - if low { LOW } else { 0.0 };
        match self.face.filter(|_| choice.stab) {
            Some(face) => {
                let from = face.place + face.ahead * BEFORE_FACE;
                let front = (eye - from).normalize_or(face.ahead).dot(face.ahead);
                let is_seen = sight(from, eye) > 0.95;
                score += FACE * f64::from(u8::from(is_seen)) + FRONT * front.min(PROFILE);
                score += HIGH * toward.dot(self.up).min(ENOUGH);
                score += FREE * sight(self.climber + self.up * HEAD, eye);
            }
            None => score += IDEAL * toward.dot(ideal),
        }
        score
    }
}

fn giant(battle: &Battle<'_>) -> DVec3 {
    let palette = battle.palette();
    let joints = palette.matrices().len() as u32;
    let frames = (0..joints).filter_map(|joint| palette.model_from_joint(JointId(joint)));
    let sum: DVec3 = frames.map(|frame| frame.translation).sum();
    let middle = sum / f64::from(joints.max(1));
    battle.surface().world_from_model().transform_point(middle)
}
