//! Hanging from a ledge, and going along it: over steps, across gaps and around corners.

use clamber_mover::{Ledge, LedgeHold};
use glam::DVec3;

use super::super::carrying::Carried;
use super::super::moving::Intent;
use super::super::{NextMode, Tick};
use crate::config::LedgeConfig;

/// Share of its way along the ledge below which a climber looks for a wall that stands forward. A wall that stands
/// forward by a twentieth of the radius hinders it that much at once. With a smaller share, the ball would creep ever
/// more slowly, and rounding would decide when it is blocked.
const HINDERED_WAY_SHARE: f64 = 0.9;

/// Share of its way along the ledge below which a climber is blocked, and looks for an inner corner.
const BLOCKED_WAY_SHARE: f64 = 0.4;

/// Distance along the ledge in which a blocked climber looks for a wall that stands forward, as a fraction of the
/// radius: the ball is at most a radius away from the corner, and the hands go a hand's width beyond it.
const FORWARD_WALL_SEARCH: f64 = 1.3;

/// Smallest reach of the hands for the next hold, as a fraction of the radius: past the edge of a step, where a hand
/// does not lie flat.
const HAND_OVER: f64 = 0.5;

/// Largest distance from the corner of a climber that goes around it, in radii. A climber that is farther away is kept
/// off by an obstacle, such as a lower wall beside the corner, and would hang far beside its hands.
const MAX_CORNER_DISTANCE: f64 = 1.05;

/// Distance, as a fraction of the radius, by which a wall has to be nearer than the climber's wall to stand forward.
const LEAST_FORWARD_DISTANCE: f64 = 0.02;

/// Cosine of the smallest angle by which the facing turns where a ledge turns, a hundredth of a degree: less is
/// rounding.
const LEAST_TURN_COSINE: f64 = 1.0 - 1e-8;

/// Distance, as a fraction of the radius, above which hands that are ahead have gone ahead of the body, across a gap or
/// past a step.
const HANDS_AHEAD_DISTANCE: f64 = 0.15;

/// Largest distance, as a fraction of the radius, by which hands ahead of the body go back. Hands that would have to go
/// back farther stay.
const MAX_HANDS_BACK: f64 = 0.1;

/// Error of its distance from the wall, as a fraction of the radius, that a climber keeps while it follows its hands:
/// hands on an edge are not always equally far beyond it.
const KEPT_WALL_ERROR: f64 = 0.12;

/// Error of its distance from the wall, as a fraction of the radius, with which a climber may rest at a ledge's end.
const REST_WALL_ERROR: f64 = 0.3;

/// Largest factor on the speed along the ledge at which a climber that is far from its place is drawn there.
const MAX_DRAW_FACTOR: f64 = 3.0;

/// The ledge that the hands go on to, and the displacement of the body in this tick.
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
            // At a ledge's end the climber rests where it is. If it were drawn into place, it would find that the ledge
            // goes on.
            let way = if step == DVec3::ZERO {
                way
            } else {
                self.without_ahead(way, REST_WALL_ERROR)
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
        let around = if goes_on && !returns && made < HINDERED_WAY_SHARE {
            self.way_around(
                carried.motion.position,
                moved.position,
                step,
                made < BLOCKED_WAY_SHARE,
            )
        } else {
            None
        };
        if let Some(ledge) = around.or(next.ledge) {
            self.hold_ledge(&ledge, moved.position, step);
        }
        NextMode::Stay
    }

    /// The climber's next movement along its ledge; `None` if it hangs still, or the ledge ends.
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
        let way = self.without_ahead(place - from, KEPT_WALL_ERROR);
        let follows = Next {
            ledge: None,
            way: step + self.beside(ahead, way, most),
        };
        if left > step.length().max(HANDS_AHEAD_DISTANCE * radius) {
            // The hands are there already.
            return Some(follows);
        }
        let returns = self.state.ledge_hanging.returns;
        let hung = if returns {
            // The climber is still above the edge.
            let way = place - from;
            from + way - ahead * way.dot(ahead)
        } else {
            from
        };
        let hold = self.ledge_hold(carried.motion.position, self.state.heading);
        let ledge = self.next_ledge(&hold, config, hung, step)?;
        let back = (hold.held - ledge.touch.contact.point).dot(ahead);
        if left > step.length() && back > MAX_HANDS_BACK * radius && !returns {
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

    /// A displacement without its component towards the wall or away from it, up to `share` of the radius.
    fn without_ahead(&self, way: DVec3, share: f64) -> DVec3 {
        let heading = self.state.heading;
        let most = share * self.config.body.radius;
        way - heading * way.dot(heading).clamp(-most, most)
    }

    /// The part of a displacement that is not along the ledge, limited to the distance that arms make in a tick. A
    /// climber that is far from its place, since it has just caught the ledge, is drawn there faster.
    fn beside(&self, ahead: DVec3, way: DVec3, most: f64) -> DVec3 {
        let beside = way - ahead * way.dot(ahead);
        let far = beside.length() / (HAND_OVER * self.config.body.radius);
        beside.clamp_length_max(most * far.clamp(1.0, MAX_DRAW_FACTOR))
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
        let within = libm::hypot(MAX_CORNER_DISTANCE * radius, step.length());
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

    /// The ledge of the wall that blocks the climber's way along its ledge: of a wall that stands forward, or of the
    /// other wall in an inner corner.
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
        let least = (held - position).dot(heading) - LEAST_FORWARD_DISTANCE * radius;
        let judge = self.judge;
        let stands_forward = |ledge: &Ledge| {
            let ahead = (ledge.touch.contact.point - position).dot(heading);
            ahead < least && judge.rule_of(&ledge.touch).hang
        };
        let way = aside * (FORWARD_WALL_SEARCH * radius);
        let ledge = self
            .mover
            .ledge_beside(&hold, position, way, stands_forward)
            .or_else(|| {
                is_blocked.then(|| self.mover.ledge_in_corner(&hold, position, aside))?
            })?;
        self.can_hang_from(&ledge.touch).then_some(ledge)
    }

    /// The place where the climber hangs from a ledge. Its distance is measured from the wall: hands on a corner are
    /// not always equally far beyond the edge.
    pub(super) fn place_below(&self, ledge: &Ledge, config: &LedgeConfig) -> DVec3 {
        let up = self.config.up();
        let place = ledge.wall - ledge.facing * self.config.body.radius;
        let rises = (ledge.touch.contact.point - place).dot(up) - config.drop;
        place + up * rises
    }

    /// Puts the climber's hands on the next ledge, and turns it to the ledge's wall. The input then leads on as it did
    /// before.
    fn hold_ledge(&mut self, ledge: &Ledge, position: DVec3, step: DVec3) {
        let velocity = self.state.velocity;
        self.attach(&ledge.touch, position);
        let turns = self.state.heading.dot(ledge.facing) < LEAST_TURN_COSINE;
        if turns && self.state.ledge_hanging.right == DVec3::ZERO {
            let side = self.state.heading.cross(self.config.up());
            let stick = self.stick().normalize_or_zero();
            self.state.ledge_hanging.right = stick * step.dot(side).signum();
        }
        self.face(ledge.facing);
        self.state.velocity = velocity;
    }
}
