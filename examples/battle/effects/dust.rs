//! Dust where the giant strikes the ground, and the ring of a blow that spreads from there.
//!
//! A clip's marker `impact` gives the time at which a foot, a knee or a hand strikes. Among the joints near the ground,
//! the one that came down fastest is taken as the joint that struck. The ring grows beyond the limb by a share of the
//! creature's height, or up to a climber that the blow knocks down.

use clamber::prelude::*;
use clamber::render::Overlay;
use clamber_colossus::CreatureEvent;
use clamber_fight::ArenaEvent;
use clamber_scenes::battle::{Battle, TICK};
use clamber_scenes::valley;
use glam::DVec3;

use super::{View, glow};
use crate::colors::{ORANGE, WHITE, seen_through};

/// Time for which a ring grows, seconds.
const RING_LASTS: f64 = 0.9;
/// Time for which dust rises, seconds.
const DUST_LASTS: f64 = 1.8;

/// Number of ticks over which the fall of a joint is measured.
const FALL: usize = 12;

/// Largest height above the ground of a joint that strikes it, as a share of the creature's height.
const LOW: f64 = 0.1;
/// Largest distance between such a joint and its sole, as a share of the creature's height.
const AT_SOLE: f64 = 0.12;

/// Distance that the ring of a blow spreads beyond the limb, as a share of the creature's height.
const BLOW: f64 = 0.2;
/// The same for an impact that is not a blow, such as a fall.
const FALLS: f64 = 0.1;
/// The same for the dust of a step.
const STEP: f64 = 0.05;

/// A climber that falls within this time after a blow counts as knocked down by it, seconds.
const KNOCKS: f64 = 0.5;
/// Largest distance of such a climber from the blow, as a share of the creature's height.
const KNOCKS_AT: f64 = 0.5;

/// Number of puffs of dust of an impact.
const PUFFS: u32 = 22;
/// Number of puffs of dust of a step.
const STEP_PUFFS: u32 = 9;

/// Radius of a puff at its beginning and at its end, as shares of the creature's height.
const PUFF: [f64; 2] = [0.012, 0.05];
/// Height to which puffs rise, as a share of the creature's height.
const RISES: f64 = 0.05;

/// Colour of dust, linear red, green and blue.
const DUST: [f32; 3] = [0.50, 0.43, 0.31];

/// Number of corners of a ring.
const SIDES: u32 = 72;

/// Impacts of the last seconds.
#[derive(Debug)]
pub(super) struct Dust {
    height: f64,
    impacts: Vec<Impact>,
    /// Positions of all joints in the last ticks; the current tick is last.
    joints: Vec<Vec<DVec3>>,
    was_down: bool,
}

#[derive(Clone, Copy, Debug)]
struct Impact {
    place: DVec3,
    /// First and last radius of the ring, metres.
    radii: [f64; 2],
    /// False for a step.
    has_ring: bool,
    seconds: f64,
    /// Position of the climber that it knocked down.
    struck: Option<DVec3>,
}

impl Dust {
    pub(super) fn new(height: f64) -> Self {
        Self {
            height,
            impacts: Vec::new(),
            joints: Vec::new(),
            was_down: false,
        }
    }

    pub(super) fn watch(&mut self, battle: &Battle<'_>) {
        for impact in &mut self.impacts {
            impact.seconds += TICK;
        }
        self.impacts.retain(|impact| impact.seconds < DUST_LASTS);
        let (Some(arena), Some(life)) = (battle.arena(), battle.life()) else {
            return;
        };
        let root = battle.surface().world_from_model();
        let joints = battle.palette().matrices().len() as u32;
        let frames =
            (0..joints).filter_map(|joint| battle.palette().model_from_joint(JointId(joint)));
        let places = frames.map(|frame| root.transform_point(frame.translation));
        self.joints.push(places.collect());
        if self.joints.len() > FALL {
            self.joints.remove(0);
        }
        for event in arena.events() {
            let ArenaEvent::Creature { event, .. } = event else {
                continue;
            };
            match event {
                CreatureEvent::Marker { name } if name == "impact" => {
                    let is_blow = life.attack().is_some();
                    let beyond = if is_blow { BLOW } else { FALLS };
                    if let Some((place, size)) = self.struck_ground(life) {
                        self.strike(place, [size, size + beyond * self.height], true);
                    }
                }
                CreatureEvent::Plant { leg, .. } => {
                    if let Some((place, size)) = life.sole(*leg).map(center) {
                        self.strike(place, [size, size + STEP * self.height], false);
                    }
                }
                _ => {}
            }
        }
        self.knock_down(battle, arena.events());
    }

    fn strike(&mut self, place: DVec3, radii: [f64; 2], has_ring: bool) {
        self.impacts.push(Impact {
            place: on_ground(place),
            radii,
            has_ring,
            seconds: 0.0,
            struck: None,
        });
    }

    /// The place of the joint that came down fastest, or of its sole, and the limb's radius there.
    fn struck_ground(&self, life: &clamber_colossus::Creature) -> Option<(DVec3, f64)> {
        let (first, last) = (self.joints.first()?, self.joints.last()?);
        let low = |place: &DVec3| place.y - on_ground(*place).y < LOW * self.height;
        let falls = first.iter().zip(last).filter(|(_, now)| low(now));
        let fastest = falls.max_by(|a, b| {
            let [a, b] = [a, b].map(|(before, now)| before.y - now.y);
            a.total_cmp(&b)
        });
        let (_, place) = fastest?;
        let soles = (0..).map_while(|leg| life.sole(leg)).map(center);
        let sole = soles.min_by(|a, b| {
            let [a, b] = [a, b].map(|(sole, _)| sole.distance_squared(*place));
            a.total_cmp(&b)
        });
        let sole = sole.filter(|(sole, _)| sole.distance(*place) < AT_SOLE * self.height);
        Some(sole.unwrap_or((*place, 0.05 * self.height)))
    }

    /// Assigns a knock-down of the climber to the last blow.
    fn knock_down(&mut self, battle: &Battle<'_>, events: &[ArenaEvent]) {
        let state = battle.climber().state();
        let is_down = state.mode == ClimberMode::Tumbling;
        let is_struck = events
            .iter()
            .any(|event| matches!(event, ArenaEvent::Struck { .. }));
        if is_struck || is_down && !self.was_down {
            let far = KNOCKS_AT * self.height;
            let place = state.position;
            let near = |impact: &&mut Impact| {
                impact.has_ring && impact.seconds < KNOCKS && impact.place.distance(place) < far
            };
            if let Some(impact) = self.impacts.iter_mut().rev().find(near) {
                impact.struck = Some(place);
                let distance = (place - impact.place).with_y(0.0).length();
                impact.radii[1] = impact.radii[1].max(distance);
            }
        }
        self.was_down = is_down;
    }

    pub(super) fn draw(&self, over: &mut Overlay, view: &View) {
        for impact in &self.impacts {
            self.puffs(over, view, impact);
            if impact.has_ring {
                self.ring(over, impact);
            }
        }
    }

    /// A ring that runs along the ground.
    fn ring(&self, over: &mut Overlay, impact: &Impact) {
        let share = impact.seconds / RING_LASTS;
        if share >= 1.0 {
            return;
        }
        let [from, to] = impact.radii;
        let radius = from + (to - from) * (1.0 - (1.0 - share) * (1.0 - share));
        let width = 0.012 * self.height * (1.0 - 0.5 * share);
        let color = if impact.struck.is_some() {
            ORANGE
        } else {
            WHITE
        };
        let fade = (1.0 - share) as f32;
        let corner = |side: u32, radius: f64| {
            let angle = f64::from(side) / f64::from(SIDES) * core::f64::consts::TAU;
            let (sin, cos) = libm::sincos(angle);
            let place = impact.place + DVec3::new(cos, 0.0, sin) * radius;
            on_ground(place) + DVec3::Y * 0.15
        };
        for side in 0..SIDES {
            let inner = [side, side + 1].map(|side| corner(side, radius - width));
            let outer = [side, side + 1].map(|side| corner(side, radius));
            let color = seen_through(color, 0.7 * fade);
            over.triangle([inner[0], outer[0], outer[1]], color);
            over.triangle([inner[0], outer[1], inner[1]], color);
        }
        if let Some(struck) = impact.struck {
            let color = seen_through(ORANGE, 0.9 * fade);
            over.line(corner(0, 0.0), struck, 2.0, color);
            over.circle(struck, DVec3::Y, 0.5 + 1.5 * share, 2.5, color);
        }
    }

    /// Dust that is thrown up around the limb, drifts outward and settles.
    fn puffs(&self, over: &mut Overlay, view: &View, impact: &Impact) {
        let share = impact.seconds / DUST_LASTS;
        let count = if impact.has_ring { PUFFS } else { STEP_PUFFS };
        let [from, to] = impact.radii;
        // Fast at first.
        let way = 1.0 - (1.0 - share) * (1.0 - share) * (1.0 - share);
        let opacity = if impact.has_ring { 0.45 } else { 0.25 };
        let fade = opacity * (1.0 - share) as f32;
        for puff in 0..count {
            // Multiples of the golden angle and of the golden ratio are spread evenly, and are the same in every run.
            let angle = f64::from(puff) * 2.399_963;
            let other = (f64::from(puff) * 0.618_034).fract();
            let (sin, cos) = libm::sincos(angle);
            let far = from * (0.7 + 0.3 * other) + (to - from) * (0.3 + 0.5 * other) * way;
            let up = self.height * RISES * (0.3 + 0.7 * other) * way.sqrt();
            let radius = self.height * (PUFF[0] + (PUFF[1] - PUFF[0]) * way) * (0.6 + 0.6 * other);
            let place = on_ground(impact.place + DVec3::new(cos, 0.0, sin) * far);
            let place = place + DVec3::Y * (up + 0.5 * radius);
            let [red, green, blue] = DUST;
            glow(over, view, place, radius, [red, green, blue, fade]);
        }
    }
}

fn on_ground(place: DVec3) -> DVec3 {
    place.with_y(valley::height(place.x, place.z))
}

/// The middle of a sole, and the largest distance of its corners from there.
fn center(corners: [DVec3; 4]) -> (DVec3, f64) {
    let middle = corners.iter().sum::<DVec3>() / 4.0;
    let far = corners.map(|corner| corner.distance(middle));
    (middle, far.into_iter().fold(0.0, f64::max))
}
