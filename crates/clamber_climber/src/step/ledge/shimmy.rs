//! Hanging from a ledge, and going along it: over steps, across gaps and around corners.

use clamber_mover::{Ledge, LedgeHold};
use glam::DVec3;

use super::super::carrying::Carried;
use super::super::moving::Intent;
use super::super::{NextMode, Tick};
use crate::config::LedgeConfig;

/// A climber that makes less than this share of its way along the ledge looks for a wall that stands forward. It is
/// made less at once by one that stands forward by a twentieth of the radius; otherwise the ball would creep ever more
/// slowly, and rounding would decide when it is blocked.
const HINDERED: f64 = 0.9;

/// A climber that makes less than this share of its way along the ledge is blocked, and looks for an inner corner.
const STUCK: f64 = 0.4;

/// How far along the ledge a wall that stands forward is looked for by a climber that it blocks, as a share of the
/// radius: the ball is a radius away from the corner at most, and the hands go a hand's width beyond it.
const PAST: f64 = 1.3;

/// How far hands reach at least for the next hold, as a share of the radius: past the edge of a step, where a hand does
/// not lie flat.
const HAND_OVER: f64 = 0.5;

/// A climber that goes around a corner is within this multiple of its radius of the corner. Otherwise something keeps
/// it off, such as a lower wall beside the corner, and it would hang far beside its hands.
const NEARLY: f64 = 1.05;

/// A wall that is ahead by this share of the radius less than the one that the climber hangs at stands forward.
const FORWARD: f64 = 0.02;

/// Cosine of the angle by which the facing turns at least where a ledge turns, a hundredth of a degree: less is
/// rounding.
const TURNS: f64 = 1.0 - 1e-8;

/// Hands that are farther ahead than this share of the radius have gone ahead of the body, across a gap or past a step.
const AHEAD: f64 = 0.15;

/// Hands that are ahead of the body stay there rather than go back by more than this share of the radius.
const BACK: f64 = 0.1;

/// While it follows its hands, it keeps its distance from the wall where that is right within this share of the radius:
/// hands on an edge are not always as far beyond it.
const NEAR: f64 = 0.12;

/// At a ledge's end it rests at most this share of the radius nearer to the wall or farther from it than it would hang.
const RESTS: f64 = 0.3;

/// A climber that is far from its place is drawn there up to this many times as fast as it goes along the ledge.
const FASTER: f64 = 3.0;

/// Where hands go on to, and the displacement of the body in this tick.
struct Next {
    ledge: Option<Ledge>,
    way: DVec3,
}

impl Tick<'_> {
    /// Hangs still, or moves along the ledge.
    pub(super) fn shimmy(
        &mut self,
        carried: &Carried,
        config: &LedgeConfig,
        aside: DVec3,
    ) -> NextMode {
        let place = self.hanging_place(carried, config);
        let step = aside * (config.shimmy_speed * self.dt());
        let next = self.along_ledge(carried, config, place, step);
        let goes_on = next.is_some();
        let next = next.unwrap_or_else(|| {
            let way = self.way_to(place, carried.position);
            // At a ledge's end it rests where it is. Drawn into place, it would find that the ledge goes on.
            let way = if step == DVec3::ZERO {
                way
            } else {
                self.without_ahead(way, RESTS)
            };
            Next {
                ledge: None,
                way: self.drawn(way),
            }
        });
        let intent = if goes_on { Intent::Go } else { Intent::Stay };
        let moved = self.slide(&self.path(carried.position + next.way), intent);
        let rise = (moved.position - carried.position).dot(self.config.up());
        self.drawn_up += rise.max(0.0);
        if goes_on {
            let planned = step / self.dt();
            self.settle_by_arms(carried, moved.position, next.way.length(), planned);
        } else {
            self.settle(carried, moved.position, carried.velocity());
        }
        if self.is_pressed_off(place, &moved, config) {
            return self.be_torn_off(carried);
        }
        let left = self.way_to(place, moved.position);
        self.state.ledge_hanging.returns &= self.is_out_of_place(left);
        let returns = self.state.ledge_hanging.returns;
        if !returns && let Some(next) = self.stand_where_it_hangs() {
            return next;
        }
        let made = (moved.position - carried.position).dot(step);
        let made = made / step.length_squared();
        let around = if goes_on && !returns && made < HINDERED {
            self.way_around(carried.motion.position, moved.position, step, made < STUCK)
        } else {
            None
        };
        if let Some(ledge) = around.or(next.ledge) {
            self.hold_ledge(&ledge, moved.position, step);
        }
        NextMode::Stay
    }

    /// Where it goes along its ledge; `None` if it hangs still, or the ledge ends.
    fn along_ledge(
        &mut self,
        carried: &Carried,
        config: &LedgeConfig,
        place: DVec3,
        step: DVec3,
    ) -> Option<Next> {
        let from = carried.position;
        let ahead = step.try_normalize()?;
        let most = config.shimmy_speed * self.dt();
        let radius = self.config.body.radius;
        let left = (place - from).dot(ahead);
        let way = self.without_ahead(place - from, NEAR);
        let follows = Next {
            ledge: None,
            way: step + self.beside(ahead, way, most),
        };
        if left > step.length().max(AHEAD * radius) {
            // Its hands are there already.
            return Some(follows);
        }
        let returns = self.state.ledge_hanging.returns;
        let hung = if returns {
            // It is still above the edge.
            let way = place - from;
            from + way - ahead * way.dot(ahead)
        } else {
            from
        };
        let hold = self.ledge_hold(carried.motion.position, self.state.heading);
        let ledge = self.next_ledge(&hold, config, hung, step)?;
        let back = (hold.held - ledge.touch.contact.point).dot(ahead);
        if left > step.length() && back > BACK * radius && !returns {
            // Hands that went past a step do not go back to its near side.
            return Some(follows);
        }
        let next = self.place_below(&ledge, config);
        let way = if returns {
            let back = next - from;
            step + self.drawn(back - ahead * back.dot(ahead))
        } else {
            step + self.beside(ahead, next - from - step, most)
        };
        Some(Next {
            ledge: Some(ledge),
            way,
        })
    }

    /// A displacement without up to a share of the radius towards the wall or away from it.
    fn without_ahead(&self, way: DVec3, share: f64) -> DVec3 {
        let heading = self.state.heading;
        let most = share * self.config.body.radius;
        way - heading * way.dot(heading).clamp(-most, most)
    }

    /// The part of a displacement that is not along the ledge, limited to what arms make in a tick. A climber that is
    /// far from its place, since it has just caught the ledge, is drawn there faster.
    fn beside(&self, ahead: DVec3, way: DVec3, most: f64) -> DVec3 {
        let beside = way - ahead * way.dot(ahead);
        let far = beside.length() / (HAND_OVER * self.config.body.radius);
        beside.clamp_length_max(most * far.clamp(1.0, FASTER))
    }

    fn ledge_hold(&self, held: DVec3, facing: DVec3) -> LedgeHold {
        LedgeHold {
            body: self.body(),
            up: self.config.up(),
            facing,
            held,
            max_slope: self.config.ground.max_slope,
        }
    }

    /// The ledge after a step: straight ahead, or the next one aside, or around the corner.
    fn next_ledge(
        &mut self,
        hold: &LedgeHold,
        config: &LedgeConfig,
        from: DVec3,
        step: DVec3,
    ) -> Option<Ledge> {
        let (position, aside) = (from + step, step.normalize_or_zero());
        let radius = hold.body.radius;
        let reach = config.reach.max(HAND_OVER * radius);
        let within = libm::hypot(NEARLY * radius, step.length());
        let judge = self.judge;
        let hangs = |ledge: &Ledge| judge.rule_of(&ledge.touch).hang;
        let ledge = self
            .mover
            .ledge_ahead(hold, position)
            .filter(hangs)
            .or_else(|| {
                self.mover
                    .ledge_beside(hold, position, aside * reach, hangs)
            })
            .or_else(|| self.mover.ledge_around(hold, position, within))?;
        self.can_hang_from(&ledge.touch).then_some(ledge)
    }

    /// The ledge of the wall that blocks its way along the ledge: one that stands forward, or that of the other wall in
    /// an inner corner.
    fn way_around(
        &mut self,
        held: DVec3,
        position: DVec3,
        step: DVec3,
        is_blocked: bool,
    ) -> Option<Ledge> {
        let (heading, radius) = (self.state.heading, self.config.body.radius);
        let aside = step.try_normalize()?;
        let hold = self.ledge_hold(held, heading);
        let least = (held - position).dot(heading) - FORWARD * radius;
        let judge = self.judge;
        let stands_forward = |ledge: &Ledge| {
            let ahead = (ledge.touch.contact.point - position).dot(heading);
            ahead < least && judge.rule_of(&ledge.touch).hang
        };
        let way = aside * (PAST * radius);
        let ledge = self
            .mover
            .ledge_beside(&hold, position, way, stands_forward)
            .or_else(|| {
                is_blocked.then(|| self.mover.ledge_in_corner(&hold, position, aside))?
            })?;
        self.can_hang_from(&ledge.touch).then_some(ledge)
    }

    /// The place where it hangs from a ledge. Its distance is that from the wall: hands on a corner are not always as
    /// far beyond the edge.
    pub(super) fn place_below(&self, ledge: &Ledge, config: &LedgeConfig) -> DVec3 {
        let up = self.config.up();
        let place = ledge.wall - ledge.facing * self.config.body.radius;
        let rises = (ledge.touch.contact.point - place).dot(up) - config.drop;
        place + up * rises
    }

    /// Puts its hands on the next ledge, and turns to its wall. The input then leads on as it did before.
    fn hold_ledge(&mut self, ledge: &Ledge, position: DVec3, step: DVec3) {
        let velocity = self.state.velocity;
        self.attach(&ledge.touch, position);
        let turns = self.state.heading.dot(ledge.facing) < TURNS;
        if turns && self.state.ledge_hanging.right == DVec3::ZERO {
            let side = self.state.heading.cross(self.config.up());
            let stick = self.stick().normalize_or_zero();
            self.state.ledge_hanging.right = stick * step.dot(side).signum();
        }
        self.face(ledge.facing);
        self.state.velocity = velocity;
    }
}
