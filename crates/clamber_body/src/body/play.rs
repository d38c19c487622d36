//! Chooses and plays the clips for the climber's state.

use clamber_animation::{AnimationError, AnimationEvent, Animator, Layer, PoseBuffers};
use clamber_climber::ClimberState;
use clamber_surface::rig::{Playback, Pose};

use super::stance::Stance;
use super::walk::Walk;
use crate::figure::STRIDES;
use crate::{BodyClip, Figure};

/// Length of a fade between the body's own clips, seconds.
const FADE_TIME: f64 = 0.22;

/// Name of the marker at which a jump leaves the ground.
const TAKE_OFF: &str = "take_off";

/// The layers below an overlay clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Base {
    /// Standing and locomotion, mixed.
    Walk,
    Loop(BodyClip),
    Once(BodyClip),
    /// The pull-up, at the time that its progress gives.
    Mantle,
}

/// A clip over the body's own clips, for weapons and gestures.
///
/// [`Layer::once`] plays the clip once, [`Layer::new`] in a loop:
///
/// ```
/// use clamber_animation::Layer;
/// use clamber_body::{OverlayClip, Body, Figure};
///
/// /// Draws a bow: the left hand follows the clip, and the right one holds on meanwhile.
/// fn draw(figure: &Figure, body: &mut Body) -> Result<(), Box<dyn std::error::Error>> {
///     let clip = figure.animations().find("draw").ok_or("no such clip")?;
///     let layer = Layer { mask: Some(figure.upper_body()), ..Layer::once(clip) };
///     body.set_overlay(figure, Some(OverlayClip { layer, hands: [true, false] }), 0.2)?;
///     Ok(()) // `overlay_mut` tells its time; then "aim", "loose", and `None`
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverlayClip {
    /// The clip, how it is blended in, and its mask of joints. [`Figure::upper_body`](crate::Figure::upper_body) is a
    /// mask of the joints above the hips.
    pub layer: Layer,
    /// True for each hand, left and right, that follows the clip. Such a hand is not kept out of walls. While the
    /// climber holds on, the hand leaves its hold once the other hand holds. The other hand keeps its hold as long as
    /// it reaches: climb at most 0.3 m/s meanwhile, or that hand has to move.
    pub hands: [bool; 2],
}

#[derive(Clone, Debug)]
pub(crate) struct Player {
    animator: Animator,
    base: Option<Base>,
    /// While an overlay clip plays, the hands that follow it.
    overlay: Option<[bool; 2]>,
    buffers: PoseBuffers,
    events: Vec<AnimationEvent>,
    gets_up: bool,
}

impl Player {
    pub(crate) fn new() -> Self {
        Self {
            animator: Animator::default(),
            base: None,
            overlay: None,
            buffers: PoseBuffers::default(),
            events: Vec::new(),
            gets_up: false,
        }
    }

    /// Forgets the current clips, so that the next frame begins without a fade.
    pub(crate) fn restart(&mut self) {
        self.base = None;
    }

    pub(crate) fn events(&self) -> &[AnimationEvent] {
        &self.events
    }

    pub(crate) fn overlay_mut(&mut self) -> Option<&mut Layer> {
        self.overlay?;
        self.animator.layers_mut().last_mut()
    }

    /// True for each hand, left and right, that follows the overlay clip instead of holding.
    pub(crate) fn busy_hands(&self) -> [bool; 2] {
        self.overlay.unwrap_or_default()
    }

    pub(crate) fn set_overlay(
        &mut self,
        figure: &Figure,
        clip: Option<OverlayClip>,
        fade: f64,
    ) -> Result<(), AnimationError> {
        let had = self.overlay.is_some();
        self.animator.change(figure.animations(), fade, |layers| {
            if had {
                layers.pop();
            }
            layers.extend(clip.map(|clip| clip.layer));
        })?;
        self.overlay = clip.map(|clip| clip.hands);
        Ok(())
    }

    /// Advances the clips by `dt` seconds and writes their pose. `before` is the last frame's stance.
    pub(crate) fn step(
        &mut self,
        figure: &Figure,
        state: &ClimberState,
        [before, stance]: [Stance; 2],
        walk: &Walk,
        pose: &mut Pose,
        dt: f64,
    ) -> Result<(), AnimationError> {
        let lay = matches!(before, Stance::Lie | Stance::Tumble);
        let stands = stance == Stance::Upright;
        self.gets_up = stands && (self.gets_up || lay) && walk.going < 0.3;
        let base = self.base_of(state, stance);
        // A body that crouches or is crushed while it gets up does not lie down again to get up.
        self.gets_up &= matches!(base, Base::Once(BodyClip::GetUp));
        self.change_to(figure, base)?;
        self.animator
            .set_scale(figure.leg_length() / super::walk::REFERENCE_LEG_LENGTH)?;
        let rate = self.animator.rate();
        match base {
            Base::Walk => drive(self.animator.layers_mut(), figure, walk, rate, dt)?,
            Base::Mantle => {
                let clip = figure
                    .animations()
                    .clip(figure.clips().get(BodyClip::Mantle))?;
                if let Some(layer) = self.animator.layers_mut().first_mut() {
                    layer.time = state.ledge_hanging.pull_up.clamp(0.0, 1.0) * clip.duration();
                }
            }
            Base::Loop(_) | Base::Once(_) => {}
        }
        self.events.clear();
        self.animator
            .advance(figure.animations(), dt, &mut self.events)?;
        let ended =
            |event: &AnimationEvent| matches!(event, AnimationEvent::Ended { layer: 0, .. });
        self.gets_up &= !self.events.iter().any(ended);
        self.animator
            .pose_into(figure.animations(), pose, &mut self.buffers)
    }

    fn base_of(&self, state: &ClimberState, stance: Stance) -> Base {
        let is_dead = state.hit_points <= 0.0;
        match stance {
            Stance::Upright | Stance::Lie if is_dead => Base::Once(BodyClip::Die),
            Stance::Upright if state.crushed => Base::Loop(BodyClip::Crushed),
            Stance::Upright if state.crouched => Base::Loop(BodyClip::Crouch),
            Stance::Upright if self.gets_up => Base::Once(BodyClip::GetUp),
            Stance::Upright => Base::Walk,
            Stance::Air if state.flying.jumping => Base::Once(BodyClip::Jump),
            Stance::Air => Base::Loop(BodyClip::Fall),
            Stance::Tumble => Base::Loop(BodyClip::Tumble),
            Stance::Lie => Base::Loop(BodyClip::Lie),
            Stance::Wall => Base::Loop(BodyClip::Climb),
            Stance::Hang => Base::Loop(BodyClip::Hang),
            Stance::Ledge if state.ledge_hanging.pull_up > 0.0 => Base::Mantle,
            Stance::Ledge => Base::Loop(BodyClip::Ledge),
        }
    }

    fn change_to(&mut self, figure: &Figure, base: Base) -> Result<(), AnimationError> {
        if self.base == Some(base) {
            return Ok(());
        }
        let fade = if self.base.is_some() { FADE_TIME } else { 0.0 };
        let clip = |clip: BodyClip| figure.clips().get(clip);
        let keeps = usize::from(self.overlay.is_some());
        let start = start_of(figure, base);
        self.animator.change(figure.animations(), fade, |layers| {
            let own = layers.len() - keeps;
            layers.drain(..own);
            let new: &[Layer] = match base {
                Base::Walk => {
                    let idle = Layer::new(clip(BodyClip::Idle));
                    let [a, b, c, d, e] = STRIDES.map(|stride| Layer {
                        weight: 0.0,
                        ..Layer::new(clip(stride))
                    });
                    &[idle, a, b, c, d, e]
                }
                Base::Loop(kind) => &[Layer::new(clip(kind))],
                Base::Once(kind) => &[Layer {
                    time: start,
                    ..Layer::once(clip(kind))
                }],
                Base::Mantle => &[Layer {
                    speed: 0.0,
                    ..Layer::once(clip(BodyClip::Mantle))
                }],
            };
            layers.splice(0..0, new.iter().copied());
        })?;
        self.base = Some(base);
        Ok(())
    }
}

/// Time at which a clip that is played once begins, seconds. A jump begins at its take-off, since the feet have left
/// the ground already.
fn start_of(figure: &Figure, base: Base) -> f64 {
    let Base::Once(BodyClip::Jump) = base else {
        return 0.0;
    };
    let clip = figure.animations().clip(figure.clips().get(BodyClip::Jump));
    let markers = clip.map_or(&[][..], |clip| clip.markers());
    let off = markers.iter().find(|marker| marker.name == TAKE_OFF);
    off.map_or(0.0, |marker| marker.time)
}

/// Sets weights and times of the locomotion clips. The times are those at the frame's beginning.
fn drive(
    layers: &mut [Layer],
    figure: &Figure,
    walk: &Walk,
    rate: f64,
    dt: f64,
) -> Result<(), AnimationError> {
    let strides = figure.gait().strides();
    let mut sum = 1.0 - walk.going;
    let was = walk.phase - walk.rate * dt;
    for (index, stride) in strides.iter().enumerate() {
        let Some(layer) = layers.get_mut(index + 1) else {
            break;
        };
        let duration = figure.animations().clip(layer.clip)?.duration();
        let wanted = walk.going * walk.shares[index];
        sum += wanted;
        // The mixer blends each layer over all layers below it.
        layer.weight = if wanted > 1e-6 {
            (wanted / sum).min(1.0)
        } else {
            0.0
        };
        layer.time = (was + stride.start).rem_euclid(1.0) * duration;
        layer.speed = walk.rate * duration / rate;
        layer.playback = Playback::Loop;
    }
    Ok(())
}
