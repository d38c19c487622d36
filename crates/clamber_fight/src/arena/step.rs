//! One step of an arena, in its fixed order.

use clamber_climber::{ClimberGroup, ClimberInput, ClimberMode, Knockback, StepRules};
use clamber_colossus::{Person, Riding, Surroundings};
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

use super::member::skins_of;
use super::{
    Arena, ArenaEvent, FIRST_CREATURE_ID, Member, Order, Outcome, Skins, creature_obstacle,
    fighter_obstacle,
};
use crate::error::ArenaError;
use crate::fighter::{Around, Fighter, FighterFrame, FighterId, Room, Wielding, looks_every};
use crate::projectile::{Air, Flown};

/// Memory that is reused in each step.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    people: Vec<Person>,
    /// Inputs of the fighters that were there before this step's orders, by ascending number.
    inputs: Vec<(FighterId, ClimberInput)>,
    /// Fighters without room yet that do not look at once; they look again every half second.
    waiting: Vec<FighterId>,
    ids: Vec<ObstacleId>,
    group: ClimberGroup,
    outcome: Outcome,
}

/// Part of a fighter's reach that grows with its size, in radii of its ball. Its height and its displacement in the
/// tick are added to it. If it is too small, climbers that touch are not obstacles to each other.
const REACH_IN_RADII: f64 = 20.0;

impl Arena {
    /// Advances the arena by one tick. `inputs` has one input for each fighter, dead ones included, by ascending
    /// number. The rules are the default ones: climbers can grip fur.
    ///
    /// The order is fixed:
    ///
    /// 1. Fighters that joined, were revived or were moved are moved aside if they have no room, and so are fighters on
    ///    which an order adds or moves a creature ([`Arena::step_with`]).
    /// 2. Creatures sense what was around them at the end of the last tick, decide, move, and strike. Then their shots
    ///    and waves go on.
    /// 3. Fighters' climbers move among terrain, creatures and each other, and their weapons go on.
    /// 4. Projectiles of fighters go on.
    /// 5. Hits of fighters' weapons do their damage to creatures, in the order of their times within the tick.
    ///
    /// A creature's blow reaches its fighter in the next step: it throws the fighter and costs hit points then.
    ///
    /// # Errors
    /// [`ArenaError::Inputs`], [`ArenaError::InputNotFinite`], [`ArenaError::TerrainId`] and
    /// [`ArenaError::TerrainTwice`]: nothing is changed then. [`ArenaError::Creature`] if a creature cannot be posed:
    /// the arena has to be restored then.
    pub fn step(
        &mut self,
        inputs: &[ClimberInput],
        terrain: &[(ObstacleId, &dyn Obstacle)],
    ) -> Result<&[ArenaEvent], ArenaError> {
        self.step_with(inputs, &[], terrain, &StepRules::default())
    }

    /// [`Arena::step`] with [`Order`]s and the game's own contact rules and custom modes. Orders are followed first.
    /// `inputs` has one input for each fighter before the orders; a fighter that joins by an order is idle in this
    /// step. The arena ignores [`StepRules::id`] and [`StepRules::knockback`]: it gives each climber its own
    /// [`fighter_obstacle`], and deals the blows itself. [`Order::Strike`] is a blow by the game.
    ///
    /// # Errors
    /// The errors of [`Arena::step`]. [`ArenaError::Order`] for an order that cannot be followed and
    /// [`ArenaError::Climber`] for rules that [`StepRules::check`] refuses: nothing is changed then.
    pub fn step_with(
        &mut self,
        inputs: &[ClimberInput],
        orders: &[Order],
        terrain: &[(ObstacleId, &dyn Obstacle)],
        rules: &StepRules<'_>,
    ) -> Result<&[ArenaEvent], ArenaError> {
        self.check(inputs, terrain)?;
        let rules = &StepRules {
            knockback: None,
            ..*rules
        };
        rules.check()?;
        let joining = self.check_orders(orders)?;
        self.tick = self.tick.wrapping_add(1);
        self.events.clear();
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.inputs.clear();
        let given = self
            .fighters
            .iter()
            .map(Fighter::id)
            .zip(inputs.iter().copied());
        scratch.inputs.extend(given);
        scratch.waiting.clear();
        // Fighters that an order places or revives look for room at once. If a creature is added or moved, all look at
        // once.
        let is_told = |id: FighterId| {
            orders.iter().any(|order| match order {
                Order::PlaceFighter { fighter, .. } | Order::Rise { fighter } => *fighter == id,
                Order::AddCreature { .. } | Order::PlaceCreature { .. } => true,
                _ => false,
            })
        };
        let waits = self.fighters.iter().filter(|one| !one.rest().has_begun);
        let waits = waits.map(Fighter::id).filter(|id| !is_told(*id));
        scratch.waiting.extend(waits);
        let stepped = self
            .follow(orders, joining)
            .and_then(|()| self.begin_fighters(terrain, &scratch.waiting))
            .and_then(|()| self.step_checked(terrain, rules, &mut scratch));
        self.scratch = scratch;
        stepped?;
        Ok(&self.events)
    }

    fn check(
        &mut self,
        inputs: &[ClimberInput],
        terrain: &[(ObstacleId, &dyn Obstacle)],
    ) -> Result<(), ArenaError> {
        let (fighters, found) = (self.fighters.len(), inputs.len());
        if fighters != found {
            return Err(ArenaError::Inputs { fighters, found });
        }
        for (fighter, input) in self.fighters.iter().zip(inputs) {
            let fighter = fighter.id().0 as usize;
            let vectors = [input.walk, input.climb, input.aim];
            if !vectors.iter().all(|v| v.is_finite()) {
                return Err(ArenaError::InputNotFinite { fighter });
            }
        }
        let ids = &mut self.scratch.ids;
        ids.clear();
        ids.extend(terrain.iter().map(|(id, _)| *id));
        ids.sort_unstable();
        if let Some(ObstacleId(found)) = ids
            .last()
            .copied()
            .filter(|last| last.0 >= FIRST_CREATURE_ID)
        {
            let below = FIRST_CREATURE_ID;
            return Err(ArenaError::TerrainId { found, below });
        }
        match ids.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(ArenaError::TerrainTwice { found: pair[0].0 }),
            None => Ok(()),
        }
    }

    fn step_checked(
        &mut self,
        terrain: &[(ObstacleId, &dyn Obstacle)],
        rules: &StepRules<'_>,
        scratch: &mut Scratch,
    ) -> Result<(), ArenaError> {
        self.step_creatures(terrain, &mut scratch.people)?;
        scratch.outcome.clear(self.next_projectile);
        self.step_fighters(terrain, rules, scratch)?;
        self.step_projectiles(terrain, &mut scratch.outcome);
        self.next_projectile = scratch.outcome.next;
        self.projectiles.append(&mut scratch.outcome.shot);
        self.noises.append(&mut scratch.outcome.noises);
        self.events.append(&mut scratch.outcome.events);
        self.do_damage(&mut scratch.outcome);
        self.deal_blows();
        Ok(())
    }

    fn step_creatures(
        &mut self,
        terrain: &[(ObstacleId, &dyn Obstacle)],
        people: &mut Vec<Person>,
    ) -> Result<(), ArenaError> {
        let ground: Vec<&dyn Obstacle> = terrain.iter().map(|(_, obstacle)| *obstacle).collect();
        // Shots and waves go on in a second pass, when all creatures have moved. So their contacts do not depend on the
        // order of the creatures, and are the same after a restore.
        for from_afar in [false, true] {
            for index in 0..self.creatures.len() {
                let (before, rest) = self.creatures.split_at_mut(index);
                let Some((member, after)) = rest.split_first_mut() else {
                    break;
                };
                let (id, creature) = (member.id, &mut member.creature);
                let is_idle = creature.attack().is_none()
                    && creature.shots().next().is_none()
                    && creature.waves().next().is_none();
                if from_afar && is_idle {
                    continue;
                }
                let others = before.iter().chain(after.iter());
                let others = others.map(|other| other.creature.surface());
                let others: Vec<&dyn Obstacle> = others.map(|skin| skin as &dyn Obstacle).collect();
                people.clear();
                // Creatures neither sense nor strike dead fighters.
                let living = self.fighters.iter().filter(|fighter| !fighter.is_dead());
                people.extend(living.map(|fighter| person(fighter, creature_obstacle(id))));
                let around = Surroundings {
                    terrain: &ground,
                    creatures: &others,
                    people,
                    noises: &self.noises,
                };
                if from_afar {
                    creature.step_from_afar(&around);
                } else {
                    creature.step_itself(&around)?;
                }
            }
        }
        for Member { id, creature, .. } in &self.creatures {
            let events = creature.report().events.iter();
            self.events.extend(events.map(|event| ArenaEvent::Creature {
                creature: *id,
                event: event.clone(),
            }));
        }
        self.noises.clear();
        Ok(())
    }

    /// Finds room for fighters that have not begun. It comes before the creatures' step, so that no creature strikes a
    /// fighter at a place that it leaves in this step. A fighter that finds no room looks again every half second, like
    /// a dead one.
    fn begin_fighters(
        &mut self,
        terrain: &[(ObstacleId, &dyn Obstacle)],
        waiting: &[FighterId],
    ) -> Result<(), ArenaError> {
        if self.fighters.iter().all(|one| one.rest().has_begun) {
            return Ok(());
        }
        let every = looks_every(self.config.tick);
        let looks = |id: FighterId| {
            let turn = self.tick.wrapping_add(u64::from(id.0));
            self.tick == 1 || turn.is_multiple_of(every)
        };
        let mut obstacles: Vec<(ObstacleId, &dyn Obstacle)> = terrain.to_vec();
        for member in &self.creatures {
            obstacles.push((creature_obstacle(member.id), member.creature.surface()));
        }
        // Fighters that have begun keep their places. Among the others, the first in the list chooses first.
        for index in 0..self.fighters.len() {
            let one = &self.fighters[index];
            let is_over = one.rest().has_begun || one.is_dead();
            if is_over || (!looks(one.id()) && waiting.contains(&one.id())) {
                continue;
            }
            let all = self.fighters.iter().enumerate();
            let others = all.filter(|(other, fighter)| {
                let is_before = *other < index || fighter.rest().has_begun;
                *other != index && is_before && !fighter.is_dead()
            });
            let bodies: Vec<_> = others.map(|(_, other)| other.climber().body()).collect();
            let room = Room {
                obstacles: &obstacles,
                bodies: &bodies,
            };
            self.fighters[index].begin_with_room(&room)?;
        }
        Ok(())
    }

    fn step_fighters(
        &mut self,
        terrain: &[(ObstacleId, &dyn Obstacle)],
        rules: &StepRules<'_>,
        scratch: &mut Scratch,
    ) -> Result<(), ArenaError> {
        let dt = self.config.tick;
        for fighter in &mut self.fighters {
            fighter.take_harm()?;
        }
        let mut obstacles: Vec<(ObstacleId, &dyn Obstacle)> = terrain.to_vec();
        for member in &self.creatures {
            obstacles.push((creature_obstacle(member.id), member.creature.surface()));
        }
        // The group takes all climbers before any of them moves, so that the order of the fighters does not matter.
        let living = self.fighters.iter().filter(|fighter| !fighter.is_dead());
        let climbers = living.map(|fighter| (fighter_obstacle(fighter.id()), fighter.climber()));
        scratch.group.update(climbers, &obstacles, dt);
        let fixed = obstacles.len();
        let skins = skins_of(&self.creatures);
        for index in 0..self.fighters.len() {
            obstacles.truncate(fixed);
            let ours = &self.fighters[index];
            // A fighter that has just joined is idle.
            let found = scratch.inputs.binary_search_by_key(&ours.id(), |one| one.0);
            let player = found.map_or(ClimberInput::IDLE, |index| scratch.inputs[index].1);
            let id = fighter_obstacle(ours.id());
            scratch.group.near(id, reach(ours, dt), &mut obstacles);
            let fighter = &mut self.fighters[index];
            let rules = StepRules {
                id: Some(id),
                knockback: fighter.take_knockback(),
                ..*rules
            };
            let is_held = fighter.be_held(dt);
            let (input, throws) = fighter.begin(&player, is_held);
            let before = FighterFrame::of(fighter.climber());
            fighter.step(&input, &obstacles, &rules, dt)?;
            let id = fighter.id();
            let events = fighter.report().events.iter();
            self.events.extend(events.map(|event| ArenaEvent::Climber {
                fighter: id,
                event: *event,
            }));
            let floor = self.config.floor;
            // Only dead fighters look for room, so the list stays empty for the living.
            let mut bodies = Vec::new();
            if fighter.is_dead() {
                let others = self.fighters.iter().enumerate();
                let living =
                    others.filter(|(other, fighter)| *other != index && !fighter.is_dead());
                bodies.extend(living.map(|(_, other)| other.climber().body()));
            }
            let room = Room {
                obstacles: &obstacles[..fixed],
                bodies: &bodies,
            };
            let fighter = &mut self.fighters[index];
            fighter.live([dt, floor], &room, &mut self.events)?;
            if !fighter.is_dead() {
                let wielding = Wielding {
                    before,
                    input: &player,
                    around: Around {
                        skins: Skins(&skins),
                        terrain,
                    },
                    dt,
                    is_held,
                    is_struck: rules.knockback.is_some(),
                    throws,
                };
                fighter.wield(&wielding, &mut scratch.outcome);
            }
        }
        Ok(())
    }

    fn step_projectiles(&mut self, terrain: &[(ObstacleId, &dyn Obstacle)], outcome: &mut Outcome) {
        let skins = skins_of(&self.creatures);
        let air = Air {
            skins: Skins(&skins),
            terrain,
            gravity: self.config.gravity,
            dt: self.config.tick,
        };
        self.projectiles
            .retain_mut(|projectile| projectile.step(&air, outcome) == Flown::There);
        let stuck = self.projectiles.iter().filter(|one| one.is_stuck()).count();
        let too_many = stuck.saturating_sub(self.config.stuck_arrows as usize);
        let oldest = self.projectiles.iter_mut().filter(|one| one.is_stuck());
        for projectile in oldest.take(too_many) {
            projectile.fall(&air, outcome);
        }
    }

    /// Applies the hits' damage in the order of their times. At equal times blades come first, by fighter number, then
    /// projectiles, by their numbers.
    fn do_damage(&mut self, outcome: &mut Outcome) {
        outcome.hits.sort_by(|a, b| a.time.total_cmp(&b.time));
        for hit in &outcome.hits {
            let id = hit.creature;
            let Some(index) = self.creature_index(id) else {
                continue;
            };
            let creature = &mut self.creatures[index].creature;
            let was_alive = creature.health() > 0.0;
            let (weak_point, plate) = creature.struck_at(&hit.at, hit.place);
            let by = self.fighters.iter_mut().find(|one| one.id() == hit.by);
            let points = creature.kind().weak_points().iter().enumerate();
            let below = points.filter_map(|(index, point)| {
                let radius = f64::from(point.radius) * creature.scale();
                let is_near = creature.weak_point(index)?.distance(hit.place) <= radius;
                (plate.is_some() && is_near).then_some(index)
            });
            let struck = [weak_point, plate];
            let is_new = by.is_none_or(|by| by.hurts_anew(hit.weapon, id, struck, below));
            let damage = if is_new { hit.damage } else { 0.0 };
            let damage = creature.hurt(&hit.at, hit.place, damage);
            self.events.push(ArenaEvent::Hit {
                by: hit.by,
                weapon: hit.weapon,
                projectile: hit.projectile,
                creature: id,
                at: hit.at,
                place: hit.place,
                time: hit.time,
                weak_point,
                plate,
                damage,
            });
            if was_alive && creature.health() <= 0.0 {
                self.events.push(ArenaEvent::Killed {
                    creature: id,
                    by: Some(hit.by),
                });
            }
        }
    }

    /// Gives the creatures' blows to the fighters, for the next tick. Among several blows, the hardest one's velocity
    /// counts, and the damages add up.
    fn deal_blows(&mut self) {
        for Member { id, creature, .. } in &self.creatures {
            for blow in &creature.report().blows {
                let person = u32::try_from(blow.person).map(FighterId);
                let mut fighters = self.fighters.iter_mut();
                let Some(fighter) = fighters.find(|one| Ok(one.id()) == person) else {
                    continue;
                };
                let (velocity, damage) = (blow.velocity, blow.damage.clamp(0.0, 1.0));
                self.events.push(ArenaEvent::Struck {
                    creature: *id,
                    fighter: fighter.id(),
                    velocity,
                    damage,
                    place: blow.place,
                });
                fighter.be_struck(Knockback {
                    velocity,
                    damage,
                    by: Some(creature_obstacle(*id)),
                });
            }
        }
    }
}

/// A fighter as a creature senses it.
fn person(fighter: &Fighter, creature: ObstacleId) -> Person {
    let climber = fighter.climber();
    let state = climber.state();
    let support = state
        .support
        .filter(|support| support.attachment.obstacle == creature);
    Person {
        id: u64::from(fighter.id().0),
        body: climber.body(),
        riding: support.map(|support| Riding {
            at: support.attachment.material,
            hangs: state.mode == ClimberMode::Hanging,
        }),
    }
}

/// A ball around everything that a fighter can touch in this tick: its centre and radius.
fn reach(fighter: &Fighter, dt: f64) -> (DVec3, f64) {
    let (state, body) = (fighter.climber().state(), fighter.config().climber.body);
    let reach = REACH_IN_RADII * body.radius + body.height + state.velocity.length() * dt;
    (state.position, reach)
}
