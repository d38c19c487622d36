//! The script of a climber on its way from the ground to the creature's weak points and its top.
//!
//! It reads the climber's place and mode, and remembers the target of the climb. After a fall it starts again from the
//! ground.

use clamber_climber::{Climber, ClimberInput, ClimberMode};
use clamber_surface::mesh::{SurfaceKind, SurfaceTag, TriangleId, VertexId};
use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use super::fencer::Fencer;
use super::goals::Goals;
use super::performer::Sight;
use super::scene::CREATURE;
use super::{BattleError, Performer, outcrop};
use crate::Creature;
use crate::tour::{Ascent, Ways};

/// How far ahead on its way up it aims, metres: farther than the width of creases that its ball does not enter. If it
/// has come no nearer to the top for `PATIENCE` seconds, it aims `FAR_AHEAD` for as long, and so on in turn.
const AHEAD: f64 = 1.2;
const FAR_AHEAD: f64 = 4.0;
const PATIENCE: f64 = 2.0;

/// Seconds for which a creature has to look calm until it is taken for calm.
const SURE: f64 = 0.5;

/// It jumps within this distance of the outcrop's wall and of its foothold, metres.
const JUMP: f64 = 0.9;

/// Distance that it keeps from its foothold while the creature is not calm, metres, and the tolerance of that distance.
const SAFE: f64 = 11.0;
const SWAY: f64 = 0.2;

/// It counts as blocked if it wants to walk but moves more slowly than `KEPT`, metres a second, for `PUZZLED` seconds.
const KEPT: f64 = 0.5;
const PUZZLED: f64 = 0.3;

/// Least time between two jumps, seconds.
const BETWEEN_JUMPS: f64 = 1.2;

/// Jumps for a foothold before it gives the foothold up, and the distance of the next foothold from those given up,
/// metres.
const TRIES: u32 = 3;
const ELSEWHERE: f64 = 1.5;

/// In the choice of a foothold, a metre of height costs as much as so many metres of distance.
const HEIGHT_COUNTS: f64 = 5.0;

/// It lets go after so many seconds of hanging from a creature that keeps still.
const STUCK: f64 = 2.5;

/// Seconds from the beginning of an attack until it runs away.
const REACTION: f64 = 0.3;

/// Where it can stand it rests until it has this much stamina, and until the creature is calm.
const RESTED: f64 = 0.95;

/// With less stamina than `TIRED` it lets go and rests, if the slope is below `LEVEL`, radians.
const TIRED: f64 = 0.75;
const LEVEL: f64 = 0.6;

/// Largest shake in which it lets go to stand, metres a second squared.
const CALM: f64 = 3.0;

/// The script's plan and memory.
#[derive(Clone, Debug)]
pub(super) struct Pilot {
    goals: Goals,
    /// The goal that it goes for, by its index.
    goal: usize,
    fencer: Fencer,
    /// Since when the creature looks calm, seconds.
    calm: Option<f64>,
    /// The vertex where it means to get on, how often it has jumped for it, and the vertices where it could not get on.
    foothold: Option<VertexId>,
    tries: u32,
    given_up: Vec<VertexId>,
    /// The shortest way left to the top since it got on, in the units of the creature's file, and when, seconds.
    left: f32,
    since: f64,
    /// The triangle that it was on last, and the vertex where its way starts from there.
    entered: Option<(TriangleId, VertexId)>,
    /// Since when it hangs, seconds.
    hangs: Option<f64>,
    /// Since when it sees an attack, seconds.
    attacked: Option<f64>,
    /// When it last jumped, and when it was last not blocked, seconds.
    jumped: f64,
    free: f64,
    /// It has crossed the outcrop.
    crossed: bool,
    /// It has been on the creature since it was last on the ground.
    mounted: bool,
    /// It has been at the top since it got on.
    at_top: bool,
    /// When it first came to the top, seconds.
    arrived: Option<f64>,
}

impl Pilot {
    /// The script for a creature. [`BattleError::NoWay`] if no grippable skin leads from near the ground to the top.
    pub(super) fn new(performer: &Performer<'_>) -> Result<Self, BattleError> {
        let creature = performer.creature();
        let grips = Grips::of(creature);
        let ways = Ways::over(creature, |tag| grips.can(tag))?;
        let kind = performer.life().map(|life| &**life.kind());
        let goals = Goals::new(creature, kind, &ways);
        let goal = goals.top();
        if !goals.get(goal).ascent.leads_anywhere() {
            return Err(BattleError::NoWay {
                creature: creature.name.clone(),
            });
        }
        Ok(Self {
            goals,
            goal,
            fencer: Fencer::default(),
            calm: None,
            foothold: None,
            tries: 0,
            given_up: Vec::new(),
            left: f32::INFINITY,
            since: 0.0,
            entered: None,
            hangs: None,
            attacked: None,
            jumped: f64::NEG_INFINITY,
            free: 0.0,
            crossed: false,
            mounted: false,
            at_top: false,
            arrived: None,
        })
    }

    /// When it first came to the top, seconds; `None` if it has not.
    pub(super) fn arrived(&self) -> Option<f64> {
        self.arrived
    }

    /// It is put back to the start.
    pub(super) fn begin_again(&mut self) {
        self.fencer.begin_again();
        *self = Self {
            foothold: None,
            tries: 0,
            given_up: Vec::new(),
            left: f32::INFINITY,
            crossed: false,
            mounted: false,
            at_top: false,
            ..self.clone()
        };
    }

    /// The input of the tick that begins at `seconds`.
    pub(super) fn input(&mut self, performer: &Performer<'_>, seconds: f64) -> ClimberInput {
        let (climber, surface) = (performer.climber(), performer.surface());
        let sight = self.look(performer.sight(), seconds);
        let state = climber.state();
        self.choose(performer);
        self.attacked = self.attacked.or(Some(seconds)).filter(|_| sight.attacks);
        self.hangs = self.hangs.filter(|_| state.mode == ClimberMode::Hanging);
        let on_creature = state
            .support
            .filter(|support| support.attachment.obstacle == CREATURE)
            .and_then(|support| support.attachment.material.triangle());
        match (state.mode, on_creature) {
            (ClimberMode::Tumbling, _) => {
                self.free = seconds;
                ClimberInput::default()
            }
            (ClimberMode::LedgeHanging, _) => ClimberInput {
                climb: climber.config().up(),
                grip: true,
                ..ClimberInput::default()
            },
            (ClimberMode::Hanging, _) => {
                // It lets go where a bulge keeps it from pulling itself up, and grips again below.
                let hangs = *self.hangs.get_or_insert(seconds);
                let is_stuck = sight.is_calm && seconds - hangs > STUCK;
                ClimberInput {
                    grip: !is_stuck,
                    ..ClimberInput::default()
                }
            }
            (_, Some(triangle)) => {
                if !self.mounted {
                    self.given_up.clear();
                    self.at_top = false;
                    (self.mounted, self.left, self.since) = (true, f32::INFINITY, seconds);
                }
                let aim = self.goals.get(self.goal).aim;
                if let Some(stab) = self.fencer.stab(performer, aim) {
                    self.since = seconds;
                    return stab;
                }
                self.go_up(performer, triangle, sight, seconds)
            }
            _ => {
                let shot = self.crossed.then(|| self.fencer.shoot(performer, sight));
                match shot.flatten() {
                    Some(shot) => shot,
                    None => self.come(climber, surface, sight, seconds),
                }
            }
        }
    }

    /// A creature is calm once it has looked so for a while.
    fn look(&mut self, sight: Sight, seconds: f64) -> Sight {
        self.calm = sight.is_calm.then_some(self.calm.unwrap_or(seconds));
        Sight {
            is_calm: self.calm.is_some_and(|since| seconds - since >= SURE),
            ..sight
        }
    }

    /// Goes for another goal if the one that it goes for is reached: for the nearest by the way from where it is.
    fn choose(&mut self, performer: &Performer<'_>) {
        let open = self.goals.open(performer);
        if open.contains(&self.goal) {
            return;
        }
        let here = self.entered.map(|(_, here)| here);
        let left = |goal: &usize| {
            let ascent = &self.goals.get(*goal).ascent;
            here.map_or(f32::INFINITY, |here| ascent.left(here))
        };
        let nearest = open
            .iter()
            .copied()
            .min_by(|a, b| left(a).total_cmp(&left(b)));
        self.goal = nearest.unwrap_or(self.goals.top());
        (self.entered, self.foothold, self.at_top) = (None, None, false);
        self.left = f32::INFINITY;
    }

    fn ascent(&self) -> &Ascent {
        &self.goals.get(self.goal).ascent
    }

    /// The input on the creature.
    fn go_up(
        &mut self,
        performer: &Performer<'_>,
        triangle: TriangleId,
        sight: Sight,
        seconds: f64,
    ) -> ClimberInput {
        let (climber, surface) = (performer.climber(), performer.surface());
        let state = climber.state();
        let stands = state.mode == ClimberMode::Standing;
        let is_level = state
            .support
            .is_some_and(|support| slope(support.normal_in_world(), climber.config().up()) < LEVEL);
        let holds = |grip| ClimberInput {
            grip,
            ..ClimberInput::default()
        };
        if state.shake.length() > CALM || !sight.is_calm && (stands || self.at_top) {
            return holds(true);
        }
        let goal = self.goals.get(self.goal);
        if self.at_top && goal.aim.weak_point.is_none() {
            return holds(!stands && !is_level);
        }
        let least = if stands { RESTED } else { TIRED };
        if (stands || is_level) && sight.is_calm && state.stamina < least {
            self.since = seconds;
            return holds(false);
        }
        let Some(target) = self.follow(surface, triangle, state.position, seconds) else {
            return ClimberInput::default();
        };
        let toward = match self.fencer.miss(performer, self.goals.get(self.goal).aim) {
            // The blade has to come over the weak point.
            Some(miss) if self.at_top => miss,
            _ => place(surface, target) - state.position,
        };
        ClimberInput {
            climb: toward.normalize_or(climber.config().up()),
            walk: toward,
            grip: true,
            jump: stands && self.jumps(seconds - self.since > PATIENCE, seconds),
            ..ClimberInput::default()
        }
    }

    /// The vertex to climb towards, some way ahead on the way to the top, or farther ahead while it is stuck.
    fn follow(
        &mut self,
        surface: &SkinnedSurface,
        triangle: TriangleId,
        position: DVec3,
        seconds: f64,
    ) -> Option<VertexId> {
        // The nearest vertex with a way is looked for once on each triangle.
        let known = self.entered.filter(|(on, _)| *on == triangle);
        let here = match known {
            Some((_, here)) => here,
            None => self.enter(surface, triangle, position)?,
        };
        self.entered = Some((triangle, here));
        let left = self.ascent().left(here);
        if left < self.left {
            (self.left, self.since) = (left, seconds);
        }
        let stuck = (seconds - self.since).rem_euclid(2.0 * PATIENCE) > PATIENCE;
        let ahead = if stuck { FAR_AHEAD } else { AHEAD };
        // On the top it stays; to a weak point it goes back if it is thrown aside.
        let is_top = self.goals.get(self.goal).aim.weak_point.is_none();
        self.at_top &= is_top;
        if self.ascent().next(here).is_none() {
            self.at_top = true;
            if self.goals.get(self.goal).aim.weak_point.is_none() {
                self.arrived.get_or_insert(seconds);
            }
        }
        let mut target = here;
        while let Some(next) = self.ascent().next(target) {
            target = next;
            if place(surface, target).distance(position) > ahead {
                break;
            }
        }
        Some(target)
    }

    /// The vertex where its way starts: the corner of its triangle with the shortest way to the top, or else the
    /// nearest vertex with a way.
    fn enter(
        &self,
        surface: &SkinnedSurface,
        triangle: TriangleId,
        position: DVec3,
    ) -> Option<VertexId> {
        let corners = surface.mesh().triangles().get(triangle.index())?;
        let by_way = |a: &VertexId, b: &VertexId| {
            let [a, b] = [a, b].map(|vertex| self.ascent().left(*vertex));
            a.total_cmp(&b)
        };
        let leads_up = |vertex: &VertexId| self.ascent().left(*vertex).is_finite();
        let here = corners.iter().copied().filter(leads_up).min_by(by_way);
        here.or_else(|| nearest(surface, self.ascent().vertices(), position))
    }

    /// The input on the ground or in the air.
    fn come(
        &mut self,
        climber: &Climber,
        surface: &SkinnedSurface,
        sight: Sight,
        seconds: f64,
    ) -> ClimberInput {
        let state = climber.state();
        if self.mounted && state.mode == ClimberMode::Standing {
            (self.mounted, self.foothold, self.tries) = (false, None, 0);
        }
        let position = state.position;
        self.crossed |= position.x > outcrop::END;
        if self
            .attacked
            .is_some_and(|since| seconds - since >= REACTION)
        {
            self.free = seconds;
            let away = position - surface.world_from_model().translation;
            return ClimberInput {
                walk: away.with_y(0.0).normalize_or(DVec3::X),
                grip: true,
                ..ClimberInput::default()
            };
        }
        let (walk, near) = if self.crossed {
            self.foothold = self
                .foothold
                .or_else(|| self.find_foothold(surface, position));
            let Some(foot) = self.foothold else {
                // No foothold is left: try all of them again.
                self.given_up.clear();
                return ClimberInput::default();
            };
            let toward = (place(surface, foot) - position) * DVec3::new(1.0, 0.0, 1.0);
            let away = toward.length() - if sight.is_calm { 0.0 } else { SAFE };
            let ahead = if away.abs() > SWAY {
                away.signum()
            } else {
                0.0
            };
            let walk = toward.normalize_or_zero() * ahead;
            if walk == DVec3::ZERO || state.velocity.length() > KEPT {
                self.free = seconds;
            }
            (
                walk,
                toward.length() < JUMP || seconds - self.free > PUZZLED,
            )
        } else {
            let gap = outcrop::WALL - climber.config().body.radius - position.x;
            (DVec3::X, (0.0..JUMP).contains(&gap))
        };
        let jump = state.mode == ClimberMode::Standing && self.jumps(near, seconds);
        if jump && let Some(foothold) = self.foothold {
            self.tries += 1;
            if self.tries > TRIES {
                self.given_up.push(foothold);
                (self.foothold, self.tries) = (None, 0);
            }
        }
        ClimberInput {
            walk,
            jump,
            grip: true,
            ..ClimberInput::default()
        }
    }

    /// The foothold to get on at: low and near, and away from those given up.
    fn find_foothold(&self, surface: &SkinnedSurface, position: DVec3) -> Option<VertexId> {
        let cost = |vertex: &VertexId| {
            let way = place(surface, *vertex) - position;
            HEIGHT_COUNTS * way.y.max(0.0) + way.length()
        };
        let is_other = |vertex: &VertexId| {
            let here = place(surface, *vertex);
            let mut given_up = self.given_up.iter();
            given_up.all(|other| place(surface, *other).distance(here) > ELSEWHERE)
        };
        let feet = self.ascent().feet().iter().copied().filter(is_other);
        feet.min_by(|a, b| cost(a).total_cmp(&cost(b)))
    }

    /// True if it jumps now: `wanted`, and not too soon after the last jump.
    fn jumps(&mut self, wanted: bool, seconds: f64) -> bool {
        let jumps = wanted && seconds - self.jumped > BETWEEN_JUMPS;
        if jumps {
            self.jumped = seconds;
        }
        jumps
    }
}

/// Which skin of a creature can be gripped: fur and stone, or all of it if it has no fur.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grips {
    has_fur: bool,
}

impl Grips {
    pub(super) fn of(creature: &Creature) -> Self {
        let mut tags = creature.collider.tags().iter();
        Self {
            has_fur: tags.any(|tag| tag.kind == SurfaceKind::Fur),
        }
    }

    pub(super) fn can(self, tag: &SurfaceTag) -> bool {
        !self.has_fur || matches!(tag.kind, SurfaceKind::Fur | SurfaceKind::Stone)
    }
}

fn nearest(
    surface: &SkinnedSurface,
    vertices: impl Iterator<Item = VertexId>,
    to: DVec3,
) -> Option<VertexId> {
    let distance = |vertex: &VertexId| place(surface, *vertex).distance_squared(to);
    vertices.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

fn slope(normal: DVec3, up: DVec3) -> f64 {
    libm::acos(normal.dot(up).clamp(-1.0, 1.0))
}

fn place(surface: &SkinnedSurface, vertex: VertexId) -> DVec3 {
    let position = surface.in_model().position(vertex).unwrap_or_default();
    surface.world_from_model().transform_point_f32(position)
}
