//! A fighter's acts with its weapons in a tick: how buttons begin them, when they are broken off, and how they go on.

use clamber_climber::{Climber, ClimberError, ClimberEvent, ClimberInput, ClimberMode};
use clamber_world::{Attachment, MaterialPoint, Obstacle, ObstacleId};
use glam::DVec3;

use super::state::HARMED_PLATES;
use super::{Around, Fighter, FighterFrame, Room, StabTarget, WeaponAction, arrows};
use crate::actions::{BOW, CUT, STAB, THROW};
use crate::arena::{ArenaEvent, CreatureId, Hit, Outcome, Weapon, creature_obstacle, creature_of};

/// Walking speed while a bow is drawn, as a share of the normal speed.
const DRAWN_WALK: f64 = 0.5;

/// Seconds after which a fighter without room looks for room again.
const ROOM_SEARCH_INTERVAL: f64 = 0.5;

/// Ticks after which a living fighter without room looks for room again.
pub(crate) fn looks_every(tick: f64) -> u64 {
    (ROOM_SEARCH_INTERVAL / tick).ceil().max(1.0) as u64
}

/// True in the ticks in which a dead fighter looks for room, `waited` seconds after the time of its respawn: in the
/// first one, then every [`ROOM_SEARCH_INTERVAL`] seconds.
fn looks(waited: f64, dt: f64) -> bool {
    let round = |seconds: f64| (seconds / ROOM_SEARCH_INTERVAL).floor();
    waited < dt || round(waited) > round(waited - dt)
}

/// Data of a tick that a fighter's weapons need.
#[derive(Clone, Copy)]
pub(crate) struct Wielding<'a> {
    /// The body's frame before the climber's step.
    pub(crate) before: FighterFrame,
    pub(crate) input: &'a ClimberInput,
    pub(crate) around: Around<'a>,
    pub(crate) dt: f64,
    /// True if the hit-stop of its own impact holds the fighter in this tick.
    pub(crate) is_held: bool,
    /// True if a blow struck the fighter in this tick.
    pub(crate) is_struck: bool,
    /// True if the fighter throws a stone at the end of this tick.
    pub(crate) throws: bool,
}

impl Fighter {
    /// Begins the acts that the pressed buttons ask for. Returns the climber's input, and true if a stone is thrown at
    /// the end of this tick.
    pub(crate) fn begin(&mut self, input: &ClimberInput, is_held: bool) -> (ClimberInput, bool) {
        let pressed = input.actions & !self.state.actions;
        self.state.actions = input.actions;
        if self.is_dead() {
            return (ClimberInput::IDLE, false);
        }
        let throws = !is_held && self.press(input.actions, pressed);
        let mut input = *input;
        let mode = self.climber.state().mode;
        let stands_still = match self.state.act {
            WeaponAction::Raise { .. }
            | WeaponAction::Charge { .. }
            | WeaponAction::Strike { .. }
            | WeaponAction::PullOut { .. } => mode != ClimberMode::Falling,
            _ => is_held,
        };
        if stands_still {
            (input.walk, input.climb, input.jump) = (DVec3::ZERO, DVec3::ZERO, false);
        }
        if matches!(self.state.act, WeaponAction::Draw { .. }) {
            input.walk *= DRAWN_WALK;
        }
        (input, throws)
    }

    /// Begins the act that the pressed buttons ask for. Returns true if it throws a stone.
    fn press(&mut self, actions: u32, pressed: u32) -> bool {
        use ClimberMode::{Falling, Holding, Sliding, Standing};
        let mode = self.climber.state().mode;
        let is_free = matches!(mode, Standing | Sliding | Falling);
        let (has_sword, config) = (self.config.sword.is_some(), &self.config);
        match self.state.act {
            WeaponAction::Ready if has_sword && pressed & STAB != 0 => {
                if matches!(mode, Standing | Holding | Falling) {
                    let falls = mode == Falling;
                    self.state.act = WeaponAction::Raise {
                        seconds: 0.0,
                        falls,
                    };
                }
            }
            WeaponAction::Ready if has_sword && pressed & CUT != 0 && is_free => {
                self.state.act = WeaponAction::Cut {
                    seconds: 0.0,
                    struck: Vec::new(),
                    harmed: Vec::new(),
                };
            }
            WeaponAction::Ready if config.bow.is_some() && actions & BOW != 0 && is_free => {
                let counted = config.bow.is_some_and(|bow| bow.arrows.is_some());
                if !counted || self.state.arrows > 0 {
                    self.state.act = WeaponAction::Draw { drawn: 0.0 };
                }
            }
            WeaponAction::Ready if pressed & THROW != 0 && is_free => {
                if let Some(stones) = config.stones {
                    self.state.act = WeaponAction::Throw {
                        seconds: stones.again,
                    };
                    return true;
                }
            }
            WeaponAction::Charge { charge, falls } if pressed & STAB != 0 => {
                self.state.act = if falls {
                    WeaponAction::Plunge { charge }
                } else {
                    WeaponAction::Strike {
                        seconds: 0.0,
                        charge,
                        target: StabTarget::Open,
                    }
                };
            }
            _ => {}
        }
        false
    }

    /// Applies the harm that was stored for this tick, which comes from crushing. A dead climber is put into
    /// [`ClimberMode::Tumbling`] if its configuration has that mode.
    pub(crate) fn take_harm(&mut self) -> Result<(), ClimberError> {
        let harm = std::mem::take(&mut self.state.harm);
        let mut state = *self.climber.state();
        if self.is_dead() {
            if self.config.climber.tumble.is_none() {
                return Ok(());
            }
            // A dead climber falls over and lies.
            (state.mode, state.support, state.tumbling.still) = (ClimberMode::Tumbling, None, 0.0);
        } else if harm > 0.0 {
            state.hit_points = (state.hit_points - harm).max(0.0);
        } else {
            return Ok(());
        }
        self.climber.restore(state)
    }

    /// Counts the hit-stop down. Returns true if it holds the fighter in this tick.
    pub(crate) fn be_held(&mut self, dt: f64) -> bool {
        let left = self.state.hit_stop - dt;
        // A rest of less than half a tick is rounding error.
        self.state.hit_stop = if left > 0.5 * dt { left } else { 0.0 };
        left > -0.5 * dt
    }

    /// Applies the climber's step: harm by crushing, death by lost hit points or below the world's floor, and respawn.
    pub(crate) fn live(
        &mut self,
        [dt, floor]: [f64; 2],
        room: &Room<'_>,
        events: &mut Vec<ArenaEvent>,
    ) -> Result<(), ClimberError> {
        if let Some(crush) = &self.config.crush {
            let crushes = self.report.events.iter().any(
                |event| matches!(event, ClimberEvent::Crushed { depth } if *depth > crush.depth),
            );
            if crushes {
                self.state.harm += crush.damage * dt;
            }
        }
        let (fighter, state) = (self.id, self.climber.state());
        match self.state.dead {
            None if state.hit_points <= 0.0 || state.position.y < floor => {
                self.state.dead = Some(0.0);
                self.state.act = WeaponAction::Ready;
                self.state.hit_stop = 0.0;
                events.push(ArenaEvent::Died { fighter });
            }
            None => {}
            Some(seconds) => {
                let seconds = seconds + dt;
                self.state.dead = Some(seconds);
                if let Some(after) = self.config.respawn.filter(|after| seconds >= *after)
                    && looks(seconds - after, dt)
                    && let Some(place) = self.free_place(self.state.spawn, room)
                {
                    self.stand_up_again(place)?;
                    events.push(ArenaEvent::Rose { fighter });
                }
            }
        }
        Ok(())
    }

    /// Moves a fighter aside that has not begun, if its place is in rock or overlaps a creature or another fighter. If
    /// there is no room, it stays and has not begun.
    pub(crate) fn begin_with_room(&mut self, room: &Room<'_>) -> Result<(), ClimberError> {
        // Terrain pushes out a body that overlaps it a little. Creatures and other climbers do not push out a body that
        // is deep inside them.
        let is_creature = |(id, _): &&(ObstacleId, &dyn Obstacle)| creature_of(*id).is_some();
        let creatures = room.obstacles.iter().filter(is_creature);
        let creatures: Vec<(ObstacleId, &dyn Obstacle)> = creatures.copied().collect();
        let living = Room {
            obstacles: &creatures,
            bodies: room.bodies,
        };
        let body = self.climber.body();
        let is_free = !room.is_in_rock(&body) && living.is_free(&body);
        if !is_free {
            let Some(place) = self.free_place(self.climber.state().position, room) else {
                return Ok(());
            };
            self.put(place)?;
            self.state.act = WeaponAction::Ready;
            self.state.hit_stop = 0.0;
        }
        self.state.has_begun = true;
        Ok(())
    }

    pub(super) fn stand_up_again(&mut self, place: DVec3) -> Result<(), ClimberError> {
        let fresh = Climber::new(self.config.climber, place)?;
        self.climber.restore(*fresh.state())?;
        self.state.dead = None;
        self.state.knockback = None;
        self.state.harm = 0.0;
        self.state.arrows = arrows(&self.config);
        Ok(())
    }

    /// True if the current act is broken off. A blow, a shake above the one that makes the climber hang, or the loss of
    /// its hold breaks off a stab. A blow or tumbling breaks off a plunge. Cuts and bow shots need both hands: a blow
    /// breaks them off, and so does any mode but standing, sliding and falling.
    fn is_broken_off(&self, is_struck: bool) -> bool {
        use ClimberMode::{Falling, Hanging, LedgeHanging, Sliding, Standing, Tumbling};
        let state = self.climber.state();
        let stabs = |falls: bool| {
            let most = self
                .config
                .climber
                .grip
                .map_or(f64::INFINITY, |grip| grip.hang_acceleration);
            let shakes = state.support.is_some() && state.shake.length() > most;
            let has_lost = matches!(state.mode, Hanging | LedgeHanging | Tumbling | Sliding)
                || state.mode == Falling && !falls;
            is_struck || shakes || has_lost
        };
        match self.state.act {
            WeaponAction::Ready | WeaponAction::PullOut { .. } | WeaponAction::Throw { .. } => {
                false
            }
            WeaponAction::Raise { falls, .. } | WeaponAction::Charge { falls, .. } => stabs(falls),
            WeaponAction::Strike { .. } => stabs(false),
            WeaponAction::Plunge { .. } => is_struck || matches!(state.mode, Tumbling),
            WeaponAction::Cut { .. } | WeaponAction::Draw { .. } => {
                is_struck || !matches!(state.mode, Standing | Sliding | Falling)
            }
        }
    }

    /// Advances the current act by a tick, after the climber's step.
    pub(crate) fn wield(&mut self, tick: &Wielding<'_>, out: &mut Outcome) {
        if tick.throws
            && let Some(stone) = self.throw(tick, out.next_projectile())
        {
            out.shoot(stone);
        }
        if self.is_broken_off(tick.is_struck) {
            self.state.act = WeaponAction::Ready;
            out.events.push(ArenaEvent::BrokenOff { fighter: self.id });
            return;
        }
        if tick.is_held {
            // The hit-stop holds the blade, but the skin that the blade is in moves on.
            let mut act = std::mem::take(&mut self.state.act);
            match &mut act {
                WeaponAction::Strike { target, .. } => *target = self.aimed(*target, tick),
                WeaponAction::PullOut { target, .. } => *target = follow(*target, tick),
                _ => {}
            }
            self.state.act = act;
            return;
        }
        let dt = tick.dt;
        let act = std::mem::take(&mut self.state.act);
        self.state.act = match act {
            WeaponAction::Ready => WeaponAction::Ready,
            WeaponAction::Cut {
                seconds,
                struck,
                harmed,
            } => self.go_on_cutting(seconds, [struck, harmed], tick, out),
            WeaponAction::Raise { seconds, falls } => self.go_on_raising(seconds + dt, falls),
            WeaponAction::Charge { charge, falls } => self.go_on_charging(charge, falls, dt),
            WeaponAction::Strike {
                seconds,
                charge,
                target,
            } => self.go_on_striking([seconds, charge], target, tick, out),
            WeaponAction::Plunge { charge } => self.go_on_plunging(charge, tick, out),
            WeaponAction::PullOut { seconds, target } => {
                let target = follow(target, tick);
                if seconds > dt {
                    WeaponAction::PullOut {
                        seconds: seconds - dt,
                        target,
                    }
                } else {
                    WeaponAction::Ready
                }
            }
            WeaponAction::Draw { drawn } => self.go_on_drawing(drawn, tick, out),
            WeaponAction::Throw { seconds } if seconds > dt => WeaponAction::Throw {
                seconds: seconds - dt,
            },
            WeaponAction::Throw { .. } => WeaponAction::Ready,
        };
    }

    fn go_on_cutting(
        &mut self,
        seconds: f64,
        [mut struck, harmed]: [Vec<(ObstacleId, u32)>; 2],
        tick: &Wielding<'_>,
        out: &mut Outcome,
    ) -> WeaponAction {
        let Some(sword) = self.config.sword else {
            return WeaponAction::Ready;
        };
        let (until, frames) = (
            seconds + tick.dt,
            [tick.before, FighterFrame::of(&self.climber)],
        );
        let mut hits = Vec::new();
        let times = [seconds, until];
        let skins = tick.around.skins;
        sword.cut_through(times, frames, tick.dt, skins, &mut struck, &mut hits);
        hits.retain(|found| {
            // Everything is compared at the end of the tick, where the rays see obstacles.
            let frame = &frames[1];
            let hit = &found.hit.hit;
            let at = MaterialPoint::on_triangle(hit.triangle, hit.barycentric);
            let place = tick.around.now(found.creature, &at, hit.point, tick.dt);
            let places = [frame.origin, frame.at(sword.shoulder), place];
            let is_hidden = tick.around.hides(&places, Some(found.creature));
            if is_hidden {
                // A later part of the cut may reach the part of the creature from another side.
                let part = hit.part.0;
                struck.retain(|one| *one != (creature_obstacle(found.creature), part));
            }
            !is_hidden
        });
        for found in &hits {
            let hit = &found.hit.hit;
            self.state.hit_stop = self.config.hit_stop;
            out.hits.push(Hit {
                by: self.id,
                weapon: Weapon::Cut,
                projectile: None,
                creature: found.creature,
                at: MaterialPoint::on_triangle(hit.triangle, hit.barycentric),
                place: hit.point,
                time: found.time,
                damage: sword.cut_damage,
            });
        }
        // The arena does the damage later in this tick and needs `harmed` then. So a cut that hits in its last tick
        // goes on for one more tick.
        if until < sword.wind_up + sword.cut + sword.recover || !hits.is_empty() {
            WeaponAction::Cut {
                seconds: until,
                struck,
                harmed,
            }
        } else {
            WeaponAction::Ready
        }
    }

    /// True if a hit does damage. A cut damages a weak point or a plate once, however many joints move the skin there.
    /// A plate that breaks absorbs the rest of the damage: the weak points `below` it may open then, but the same cut
    /// does not damage them. Always true for other weapons.
    pub(crate) fn hurts_anew(
        &mut self,
        weapon: Weapon,
        creature: CreatureId,
        [weak_point, plate]: [Option<usize>; 2],
        below: impl Iterator<Item = usize>,
    ) -> bool {
        let WeaponAction::Cut { harmed, .. } = &mut self.state.act else {
            return true;
        };
        let plate = plate.map(|plate| HARMED_PLATES | plate as u32);
        let weak_point = weak_point.map(|weak_point| weak_point as u32);
        let Some(what) = plate.or(weak_point).filter(|_| weapon == Weapon::Cut) else {
            return true;
        };
        let creature = creature_obstacle(creature);
        let is_new = !harmed.contains(&(creature, what));
        let below = below.map(|point| point as u32);
        for what in [plate, weak_point].into_iter().flatten().chain(below) {
            if !harmed.contains(&(creature, what)) {
                harmed.push((creature, what));
            }
        }
        is_new
    }

    fn go_on_raising(&self, seconds: f64, falls: bool) -> WeaponAction {
        let falls = falls && self.climber.state().mode == ClimberMode::Falling;
        match &self.config.sword {
            Some(sword) if seconds < sword.raise => WeaponAction::Raise { seconds, falls },
            // A stab in a fall has its full strength at once.
            Some(_) => WeaponAction::Charge {
                charge: if falls { 1.0 } else { 0.0 },
                falls,
            },
            None => WeaponAction::Ready,
        }
    }

    fn go_on_charging(&self, charge: f64, falls: bool, dt: f64) -> WeaponAction {
        let Some(sword) = &self.config.sword else {
            return WeaponAction::Ready;
        };
        let is_pressed = self.state.actions & STAB != 0;
        let rate = if is_pressed { sword.pressed } else { 1.0 } / sword.charge;
        let still_falls = falls && self.climber.state().mode == ClimberMode::Falling;
        // The full strength of a fall ends with the fall.
        let charge = if falls && !still_falls { 0.0 } else { charge };
        WeaponAction::Charge {
            charge: (charge + rate * dt).min(1.0),
            falls: still_falls,
        }
    }

    /// The target of a stab after this tick. A target on skin follows the skin. If that skin is gone, as with a broken
    /// plate, the stab gets a new target.
    fn aimed(&self, target: StabTarget, tick: &Wielding<'_>) -> StabTarget {
        match target {
            StabTarget::Air => StabTarget::Air,
            StabTarget::Open => self.stab_target(&tick.around),
            StabTarget::Skin(_) => match follow(target, tick) {
                StabTarget::Skin(at) => StabTarget::Skin(at),
                StabTarget::Air | StabTarget::Open => self.stab_target(&tick.around),
            },
        }
    }

    fn go_on_striking(
        &mut self,
        [seconds, charge]: [f64; 2],
        target: StabTarget,
        tick: &Wielding<'_>,
        out: &mut Outcome,
    ) -> WeaponAction {
        let Some(sword) = self.config.sword else {
            return WeaponAction::Ready;
        };
        let target = self.aimed(target, tick);
        let until = seconds + tick.dt;
        if until < sword.strike {
            return WeaponAction::Strike {
                seconds: until,
                charge,
                target,
            };
        }
        let target = self.still_reached(target, &tick.around);
        if let StabTarget::Skin(at) = &target
            && let Some(creature) = creature_of(at.obstacle)
        {
            self.state.hit_stop = self.config.hit_stop;
            out.hits.push(Hit {
                by: self.id,
                weapon: Weapon::Stab,
                projectile: None,
                creature,
                at: at.material,
                place: at.point,
                time: ((sword.strike - seconds) / tick.dt).clamp(0.0, 1.0),
                damage: sword.stab_damage * charge,
            });
        }
        WeaponAction::PullOut {
            seconds: sword.pull_out,
            target,
        }
    }

    fn go_on_plunging(
        &mut self,
        charge: f64,
        tick: &Wielding<'_>,
        out: &mut Outcome,
    ) -> WeaponAction {
        let Some(sword) = self.config.sword else {
            return WeaponAction::Ready;
        };
        let frames = [tick.before, FighterFrame::of(&self.climber)];
        let Some((creature, hit)) = self.plunge_contact(frames, &tick.around, tick.dt) else {
            let falls = self.climber.state().mode == ClimberMode::Falling;
            // The fighter has landed without touching a creature.
            return if falls {
                WeaponAction::Plunge { charge }
            } else {
                WeaponAction::Ready
            };
        };
        self.state.hit_stop = self.config.hit_stop;
        let contact = hit.contact;
        out.hits.push(Hit {
            by: self.id,
            weapon: Weapon::Stab,
            projectile: None,
            creature,
            at: contact.material,
            place: contact.point,
            time: hit.fraction,
            damage: sword.stab_damage * charge,
        });
        let obstacle = creature_obstacle(creature);
        let into = frames[1].direction(DVec3::NEG_Y);
        let skin = tick.around.skins.get(creature);
        let target = skin.map_or(StabTarget::Air, |skin| {
            let at = Attachment::new(obstacle, skin, &contact, contact.point);
            StabTarget::Skin(at.moved_to(at.point + into))
        });
        WeaponAction::PullOut {
            seconds: sword.pull_out_fallen,
            target,
        }
    }

    fn go_on_drawing(
        &mut self,
        drawn: f64,
        tick: &Wielding<'_>,
        out: &mut Outcome,
    ) -> WeaponAction {
        let Some(bow) = self.config.bow else {
            return WeaponAction::Ready;
        };
        if tick.input.actions & BOW != 0 {
            let drawn = (drawn + tick.dt / bow.draw).min(1.0);
            return WeaponAction::Draw { drawn };
        }
        if drawn >= bow.least_draw
            && let Some(arrow) = self.shoot(tick, drawn, out.next_projectile())
        {
            out.shoot(arrow);
        }
        WeaponAction::Ready
    }
}

/// Moves a target with its skin over the tick; [`StabTarget::Air`] if the skin is gone.
fn follow(target: StabTarget, tick: &Wielding<'_>) -> StabTarget {
    let StabTarget::Skin(mut at) = target else {
        return target;
    };
    let skin = creature_of(at.obstacle).and_then(|creature| tick.around.skins.get(creature));
    /// Slack of [`Attachment::follow`], metres: more than rounding, less than a player sees.
    const SLACK: f64 = 0.01;
    match skin.and_then(|skin| at.follow(skin, tick.dt, SLACK)) {
        Some(_) => StabTarget::Skin(at),
        None => StabTarget::Air,
    }
}
