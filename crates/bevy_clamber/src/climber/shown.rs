//! How a climber is drawn between its last two ticks.
//!
//! A frame lies between two ticks, so a climber is drawn between its last two states. On skin, both are evaluated on
//! the skin as the frame draws it, which is ahead of the skin that ticks see: the climber is drawn where it belongs on
//! the skin, and not where the skin was. In the air, and on rigid bodies, they are positions in the world. A climber
//! that lands or leaves passes from one to the other: both states of that tick are taken relative to the skin. The
//! difference that is left where the two meet is an offset, which fades.

use clamber_climber::ClimberState;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Attachment, Obstacle};
use glam::DVec3;

/// How fast an offset fades, 1 a second: a tenth is left after 0.16 s.
const FADE: f64 = 25.0;

/// The most [`Shown::switches`] that are kept: without frames, nobody takes them.
const MOST: usize = 64;

/// Where a climber was in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spot {
    /// Position, in world space.
    position: DVec3,
    heading: DVec3,
    /// The same place relative to skin.
    on: Option<Attachment>,
    /// That skin supports it.
    is_supported: bool,
}

/// The last two ticks of a climber, as they are drawn.
#[derive(Clone, Debug)]
pub(super) struct Shown {
    before: Spot,
    now: Spot,
    /// Ticks since the last frame from which on the climber is drawn in another way.
    switches: Vec<Switch>,
    /// The rest of the difference between two ways to draw, metres and metres a second.
    offset: DVec3,
    fading: DVec3,
    /// A place on skin, and where the last frame drew it.
    held: Option<(Spot, DVec3)>,
    /// How far the support has carried the climber from the last frame to this one, metres.
    carried: DVec3,
}

/// A tick from which on a climber is drawn in another way: on skin instead of in the world, or the reverse.
#[derive(Clone, Copy, Debug)]
struct Switch {
    /// The climber at the beginning and at the end of the tick, to be drawn in the way before.
    before: [Spot; 2],
    /// The same, in the way from now on.
    after: [Spot; 2],
    /// Another tick has come since.
    is_over: bool,
}

impl Switch {
    /// The difference of both ways at a fraction of the tick, metres.
    fn difference<'a>(
        &self,
        fraction: f64,
        drawn: impl Fn(&Attachment) -> Option<&'a SkinnedSurface>,
    ) -> DVec3 {
        let fraction = if self.is_over { 1.0 } else { fraction };
        let at = |[from, to]: [Spot; 2]| from.draw(&drawn).0.lerp(to.draw(&drawn).0, fraction);
        at(self.before) - at(self.after)
    }
}

impl Spot {
    fn new(state: &ClimberState) -> Self {
        Self {
            position: state.position,
            heading: state.heading,
            on: None,
            is_supported: false,
        }
    }

    /// Position and heading on skin as it is drawn; those in the world if there is no skin.
    fn draw<'a>(
        &self,
        drawn: impl Fn(&Attachment) -> Option<&'a SkinnedSurface>,
    ) -> (DVec3, DVec3) {
        let on_skin = self.on.and_then(|on| {
            let motion = Obstacle::motion(drawn(&on)?, &on.material, 1.0)?;
            let frame = motion.frame.unwrap_or(on.frame);
            let turn = frame * on.frame.conjugate();
            Some((motion.position + frame * on.offset, turn * self.heading))
        });
        on_skin.unwrap_or((self.position, self.heading))
    }
}

impl Shown {
    /// A climber that has not moved yet.
    pub(super) fn new(state: &ClimberState) -> Self {
        let spot = Spot::new(state);
        Self {
            before: spot,
            now: spot,
            switches: Vec::new(),
            offset: DVec3::ZERO,
            fading: DVec3::ZERO,
            held: None,
            carried: DVec3::ZERO,
        }
    }

    /// How far the support has carried the climber from the last frame to this one, metres.
    pub(super) fn carried(&self) -> DVec3 {
        self.carried
    }

    /// Takes over a tick of `dt` seconds. `surface` gives the surface of an attachment, as the tick has posed it.
    pub(super) fn tick<'a>(
        &mut self,
        state: &ClimberState,
        surface: impl Fn(&Attachment) -> Option<&'a SkinnedSurface>,
        dt: f64,
    ) {
        let was = self.now;
        let mut now = Spot::new(state);
        let support = state.support.map(|support| support.attachment);
        now.on = support.filter(|on| surface(on).is_some());
        now.is_supported = now.on.is_some();
        let mut before = was;
        match (was.is_supported, now.on) {
            (false, Some(on)) => before.on = relative(&was, &on, surface(&on), dt, true),
            (false, None) => before.on = None,
            (true, None) => {
                let on = was.on.as_ref();
                now.on = on.and_then(|on| relative(&now, on, surface(on), dt, false));
            }
            (true, Some(_)) => {}
        }
        self.switches
            .iter_mut()
            .for_each(|switch| switch.is_over = true);
        if was.on != before.on && self.switches.len() < MOST {
            let on = was.on.as_ref();
            let as_before = Spot {
                on: on.and_then(|on| relative(&now, on, surface(on), dt, false)),
                ..now
            };
            self.switches.push(Switch {
                before: [was, as_before],
                after: [before, now],
                is_over: false,
            });
        }
        self.before = before;
        self.now = now;
    }

    /// Position and heading in a frame that lies at a fraction of a tick after the last tick, and `dt` seconds after
    /// the last frame. `base_velocity` is the velocity of the climber's support, if that is no skin. `drawn` gives
    /// the surface of an attachment, as the frame draws it.
    pub(super) fn draw<'a>(
        &mut self,
        fraction: f64,
        dt: f64,
        base_velocity: DVec3,
        drawn: impl Fn(&Attachment) -> Option<&'a SkinnedSurface>,
    ) -> (DVec3, DVec3) {
        self.carried = match &self.held {
            Some((spot, was)) => spot.draw(&drawn).0 - *was,
            None => base_velocity * dt,
        };
        let held = self.now.on.map(|_| (self.now, self.now.draw(&drawn).0));
        self.held = held;
        // Critically damped, in closed form: the offset begins to fade without a jerk.
        let pull = (self.fading + self.offset * FADE) * dt;
        let left = libm::exp(-FADE * dt);
        self.offset = (self.offset + pull) * left;
        self.fading = (self.fading - pull * FADE) * left;
        for switch in self.switches.drain(..) {
            self.offset += switch.difference(fraction, &drawn);
        }
        let (from, to) = (self.before.draw(&drawn), self.now.draw(&drawn));
        let position = from.0.lerp(to.0, fraction) + self.offset;
        (position, from.1.lerp(to.1, fraction))
    }
}

/// A spot relative to the skin that `on` is attached to: in its pose of a tick ago, or of now.
fn relative(
    spot: &Spot,
    on: &Attachment,
    surface: Option<&SkinnedSurface>,
    dt: f64,
    a_tick_ago: bool,
) -> Option<Attachment> {
    let motion = Obstacle::motion(surface?, &on.material, dt)?;
    let now = motion.frame.unwrap_or(on.frame);
    let (point, frame) = if a_tick_ago {
        (motion.previous_position, motion.turn.conjugate() * now)
    } else {
        (motion.position, now)
    };
    Some(Attachment {
        point,
        frame,
        offset: frame.conjugate() * (spot.position - point),
        ..*on
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_offset_fades_without_a_jerk() {
        for rate in [30.0, 60.0, 240.0] {
            let state = *clamber_climber::Climber::new(Default::default(), DVec3::ZERO)
                .unwrap()
                .state();
            let mut shown = Shown::new(&state);
            shown.offset = DVec3::X;
            let mut last = 1.0;
            let mut fastest = 0.0f64;
            for _ in 0..(0.4 * rate) as usize {
                let (position, _) = shown.draw(0.5, 1.0 / rate, DVec3::ZERO, |_| None);
                assert!(position.x < last && position.x >= 0.0, "{rate}: {position}");
                fastest = fastest.max((last - position.x) * rate);
                last = position.x;
            }
            // The steepest slope of (1 + 25 t) e^(-25 t) is 25 / e.
            assert!(
                fastest < 25.0 / 2.71 && last < 1e-3,
                "{rate}: {fastest} {last}"
            );
        }
    }
}
