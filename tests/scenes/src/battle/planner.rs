//! A climber that plans its way to the creature's weak points, and wounds it there.

use std::sync::Arc;

use clamber_climber::{ClimberInput, ClimberMode};
use clamber_navigation::{Bot, BotConfig, ClimbGraph, Danger, Forecast, Goal, View};
use glam::DVec3;

use super::crossing::Crossing;
use super::eyes::Eyes;
use super::fencer::Fencer;
use super::performer::Sight;
use super::scene::CREATURE;
use super::{BattleError, Performer};

/// How far above a weak point what covers it may be, and how far from it a climber goes to wound it, metres on a creature
/// that is as tall as the giant, `TALL` metres; on a smaller one less.
const COVER: f64 = 1.2;
const BESIDE: f64 = 0.5;
const TALL: f64 = 41.0;

/// What can be reached this far below the highest place counts as the top, as a share of the height of all that can be
/// reached.
const TOP: f64 = 0.03;

/// Seconds for which a creature has to look calm until it is taken for calm.
const SURE: f64 = 0.5;

/// It moves up to its goal's weak point in a shake up to this, metres a second squared.
const STEADY: f64 = 6.0;

/// What to strike.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Aim {
    /// The weak point, by its index; `None` for the creature's top.
    pub(super) weak_point: Option<usize>,
    /// The plate over the weak point, by its index.
    pub(super) plate: Option<usize>,
}

/// A goal: what to strike, and the ways there.
#[derive(Clone, Debug)]
struct Target {
    aim: Aim,
    goal: Goal,
}

/// The planner's plan and memory.
#[derive(Clone, Debug)]
pub(super) struct Planner {
    bot: Bot,
    targets: Vec<Target>,
    at: usize,
    forecast: Forecast,
    fencer: Fencer,
    crossing: Crossing,
    calm: Option<f64>,
    eyes: Eyes,
    /// The highest weak point at rest.
    highest: Option<usize>,
    arrived: Option<f64>,
}

impl Planner {
    /// A planner for a creature. [`BattleError::NoWay`] if no weak point and no top can be reached.
    pub(super) fn new(
        performer: &Performer<'_>,
        graph: Arc<ClimbGraph>,
    ) -> Result<Self, BattleError> {
        let targets = targets(performer, &graph);
        let leads = |target: &Target| {
            let mut entries = graph.entries().iter();
            entries.any(|entry| target.goal.least_seconds_from(entry.patch).is_finite())
        };
        let mut targets: Vec<Target> = targets.into_iter().filter(leads).collect();
        if targets.is_empty() {
            targets.push(top(&graph));
        }
        if !targets.iter().any(leads) {
            return Err(BattleError::NoWay {
                creature: performer.creature().name.clone(),
            });
        }
        let forecast = Forecast::still()
            .then(&graph, "idle", 0.0, 4.5)
            .then(&graph, "shake", 0.0, 4.5);
        Ok(Self {
            bot: Bot::new(graph, BotConfig::default()),
            targets,
            at: 0,
            forecast,
            fencer: Fencer::default(),
            crossing: Crossing::default(),
            calm: None,
            eyes: Eyes::new(performer),
            highest: highest(performer),
            arrived: None,
        })
    }

    /// When it first came to the highest weak point, seconds; `None` if it has not.
    pub(super) fn arrived(&self) -> Option<f64> {
        self.arrived
    }

    /// The bot, and its goal.
    pub(super) fn bot(&self) -> (&Bot, &Goal) {
        (&self.bot, &self.targets[self.at].goal)
    }

    /// It is put back to the start.
    pub(super) fn begin_again(&mut self) {
        self.bot.forget();
        self.fencer.begin_again();
        self.crossing = Crossing::default();
    }

    /// The input of the tick that begins at `seconds`.
    pub(super) fn input(&mut self, performer: &Performer<'_>, seconds: f64) -> ClimberInput {
        let sight = self.look(performer.sight(), seconds);
        self.choose(performer);
        let shake_ahead = self.eyes.shake_ahead(performer);
        let climber = performer.climber();
        let state = climber.state();
        let target = &self.targets[self.at];
        let view = View {
            seconds,
            climber,
            creature: CREATURE,
            surface: performer.surface(),
            goal: &target.goal,
            forecast: &self.forecast,
            danger: match sight {
                Sight { attacks: true, .. } => Danger::Attacks,
                Sight { stays: true, .. } => Danger::None,
                _ => Danger::Moves,
            },
            shake_ahead,
        };
        let is_on_it = state
            .support
            .is_some_and(|support| support.attachment.obstacle == CREATURE);
        if !is_on_it {
            if let Some(input) = self.crossing.input(climber, seconds, sight.attacks) {
                return input;
            }
            if state.mode == ClimberMode::Standing
                && let Some(shot) = self.fencer.shoot(performer, sight)
            {
                return shot;
            }
            return self.bot.input(&view);
        }
        if let Some(stab) = self.fencer.stab(performer, target.aim) {
            return stab;
        }
        let is_there = self.bot.is_there(&view);
        if self.bot.wants_rest(&view) || !is_there {
            return self.bot.input(&view);
        }
        if target.aim.weak_point == self.highest {
            self.arrived.get_or_insert(seconds);
        }
        let hold = ClimberInput {
            grip: true,
            ..ClimberInput::IDLE
        };
        let is_open = target.aim.weak_point.is_some_and(|weak_point| {
            performer
                .life()
                .is_some_and(|life| life.is_open(weak_point))
        });
        if !is_open || state.shake.length() > STEADY {
            return hold;
        }
        match self.fencer.miss(performer, target.aim) {
            Some(miss) => ClimberInput {
                climb: miss.normalize_or_zero(),
                walk: miss,
                ..hold
            },
            None => self.bot.input(&view),
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
        let open = self.open(performer);
        if open.contains(&self.at) || open.is_empty() {
            return;
        }
        let support = performer.climber().state().support;
        let here = support.and_then(|support| {
            let material = support.attachment.material;
            let weights = material.coordinates.map(|weight| weight as f32);
            self.bot.graph().patch_near(material.triangle()?, weights)
        });
        let left = |target: &usize| {
            let goal = &self.targets[*target].goal;
            here.map_or(0.0, |here| goal.least_seconds_from(here))
        };
        let nearest = open
            .iter()
            .copied()
            .min_by(|a, b| left(a).total_cmp(&left(b)));
        self.at = nearest.unwrap_or(0);
        self.bot.forget();
    }

    /// The targets that there are now: open weak points without a cover, and plates that cover one. If there are none,
    /// those that are going to be open.
    fn open(&self, performer: &Performer<'_>) -> Vec<usize> {
        let Some(life) = performer.life() else {
            return vec![0];
        };
        let is_whole = |plate: usize| life.state().plate(plate) > 0;
        let is_covered = |weak_point: usize| {
            let covers = self.targets.iter().map(|target| target.aim);
            let mut covers = covers.filter(|aim| aim.weak_point == Some(weak_point));
            covers.any(|aim| aim.plate.is_some_and(is_whole))
        };
        let is_left = |aim: Aim| {
            aim.weak_point.is_some_and(|weak_point| {
                let left = life.state().hit_points().get(weak_point);
                left.is_some_and(|left| *left > 0.0)
            })
        };
        let is_next = |aim: Aim| match (aim.weak_point, aim.plate) {
            (Some(_), Some(plate)) => is_whole(plate),
            (Some(weak_point), None) => !is_covered(weak_point),
            _ => false,
        };
        let all = 0..self.targets.len();
        let next: Vec<usize> = all
            .filter(|index| {
                let aim = self.targets[*index].aim;
                is_left(aim) && is_next(aim)
            })
            .collect();
        let is_open = |index: &usize| {
            let weak_point = self.targets[*index].aim.weak_point;
            weak_point.is_some_and(|weak_point| life.is_open(weak_point))
        };
        let open: Vec<usize> = next.iter().copied().filter(is_open).collect();
        if open.is_empty() { next } else { open }
    }
}

/// The highest weak point at rest.
fn highest(performer: &Performer<'_>) -> Option<usize> {
    let kind = performer.life()?.kind();
    let places = (0..kind.weak_points().len()).map(|index| (place(performer, index).y, index));
    let highest = places.max_by(|a, b| a.0.total_cmp(&b.0));
    highest.map(|(_, index)| index)
}

/// Where a weak point is at rest, in the units of the creature's file.
fn place(performer: &Performer<'_>, weak_point: usize) -> DVec3 {
    let Some(life) = performer.life() else {
        return DVec3::ZERO;
    };
    let kind = life.kind();
    let point = &kind.weak_points()[weak_point];
    let palette = kind.skeleton().palette(&kind.skeleton().rest_pose());
    let palette = palette.unwrap_or_default();
    let frame = palette.model_from_joint(point.joint);
    frame.map_or(DVec3::ZERO, |frame| {
        frame.transform_point3(point.position.as_dvec3())
    })
}

/// The highest places that can be reached, for a creature without weak points.
fn top(graph: &ClimbGraph) -> Target {
    let reached = graph.reachable();
    let height = |patch: &usize| graph.patches()[*patch].seat.y;
    let there: Vec<usize> = (0..reached.len()).filter(|patch| reached[*patch]).collect();
    let low = there.iter().map(height).fold(f64::INFINITY, f64::min);
    let high = there.iter().map(height).fold(f64::NEG_INFINITY, f64::max);
    let is_high = |patch: &usize| height(patch) >= high - TOP * (high - low);
    let high: Vec<usize> = there.into_iter().filter(is_high).collect();
    Target {
        aim: Aim::default(),
        goal: graph.goal(&high),
    }
}

fn targets(performer: &Performer<'_>, graph: &ClimbGraph) -> Vec<Target> {
    let Some(life) = performer.life() else {
        return Vec::new();
    };
    let (kind, scale) = (life.kind(), life.scale());
    let size = life.height() / TALL;
    let mut targets = Vec::new();
    for (index, point) in kind.weak_points().iter().enumerate() {
        let place = place(performer, index) * scale;
        let over = graph.patches_near(place, COVER * size);
        for plate in 0..kind.plates().len() {
            let is_on = |patch: &usize| {
                let triangle = graph.patches()[*patch].triangle;
                kind.plates()[plate].triangles.contains(&triangle)
            };
            let on: Vec<usize> = over.iter().copied().filter(is_on).collect();
            if !on.is_empty() {
                targets.push(Target {
                    aim: Aim {
                        weak_point: Some(index),
                        plate: Some(plate),
                    },
                    goal: graph.goal(&on),
                });
            }
        }
        let reach = f64::from(point.radius) * scale + BESIDE * size;
        let is_skin = |patch: &usize| {
            let triangle = graph.patches()[*patch].triangle;
            let mut plates = kind.plates().iter();
            !plates.any(|plate| plate.triangles.contains(&triangle))
        };
        let beside = graph.patches_near(place, reach);
        let beside: Vec<usize> = beside.into_iter().filter(is_skin).collect();
        targets.push(Target {
            aim: Aim {
                weak_point: Some(index),
                plate: None,
            },
            goal: graph.goal(&beside),
        });
    }
    targets
}
