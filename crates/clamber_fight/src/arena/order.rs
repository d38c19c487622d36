//! Orders: changes that a game makes to an arena between two of its ticks.

use clamber_climber::{Climber, Knockback};
use clamber_colossus::{Creature, CreatureConfig, Noise};
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{
    Arena, ArenaEvent, CreatureId, KindId, LAST_NUMBER, Member, Outcome, creature_obstacle,
};
use crate::error::ArenaError;
use crate::fighter::{Fighter, FighterConfig, FighterId, Room};
use crate::projectile::ProjectileId;

/// A change that the game itself makes to an arena, in addition to the players' inputs: falling rocks, fruit,
/// checkpoints, scenes, waves of creatures. Orders are passed to [`Arena::step_with`], and are followed one after the
/// other at the beginning of that step.
///
/// Orders determine a tick just as inputs do: record them, and pass them again when the tick is repeated. Besides
/// orders, only [`Arena::restore`] changes an arena between ticks.
///
/// The fighter, creature or projectile that an order names may be gone by then, as in a game over a network. Such an
/// order changes nothing, and [`ArenaEvent::Unheard`] reports it. Positions are in world space, metres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Order {
    /// Adds a fighter, at rest in the air, with the number [`Arena::next_fighter`]. It moves from this step on, without
    /// input in this one. If its place is occupied, it is moved aside.
    AddFighter {
        /// The fighter's body and weapons.
        config: Box<FighterConfig>,
        /// The centre of its climber's ball, and its spawn point after a death.
        position: DVec3,
    },
    /// Removes a fighter. Climbers that hold it fall; its arrows stay.
    RemoveFighter {
        /// The fighter.
        fighter: FighterId,
    },
    /// Adds a creature, with the number [`Arena::next_creature`]. Fighters in its place are moved aside.
    AddCreature {
        /// The creature's kind, registered with [`Arena::add_kind`].
        kind: KindId,
        /// The creature's place at first, and its size.
        config: CreatureConfig,
    },
    /// Removes a creature. Climbers on it fall, and arrows in it come loose.
    RemoveCreature {
        /// The creature.
        creature: CreatureId,
    },
    /// Removes an arrow or a stone.
    RemoveProjectile {
        /// The projectile.
        projectile: ProjectileId,
    },
    /// Takes hit points from a fighter.
    Hurt {
        /// The fighter.
        fighter: FighterId,
        /// Hit points, 0 to 1.
        damage: f64,
    },
    /// Gives hit points and stamina to a living fighter, up to 1 each.
    Heal {
        /// The fighter.
        fighter: FighterId,
        /// Hit points, 0 to 1.
        hit_points: f64,
        /// Stamina, 0 to 1.
        stamina: f64,
    },
    /// Strikes a fighter: it is thrown, and loses hit points. Among several blows in a tick, the hardest one throws it,
    /// and the damages add up.
    Strike {
        /// The fighter.
        fighter: FighterId,
        /// The blow's effect on it.
        knockback: Knockback,
    },
    /// Moves a fighter to a place, at rest in the air. It keeps its hit points, and its act ends. If the place is
    /// occupied, it is moved aside.
    PlaceFighter {
        /// The fighter.
        fighter: FighterId,
        /// The centre of its climber's ball.
        position: DVec3,
    },
    /// Sets a fighter's spawn point for its next respawn and all later ones. If the fighter is dead now, it already
    /// respawns there.
    Checkpoint {
        /// The fighter.
        fighter: FighterId,
        /// The centre of its climber's ball.
        position: DVec3,
    },
    /// Revives a dead fighter at once. A living fighter is not changed.
    Rise {
        /// The fighter.
        fighter: FighterId,
    },
    /// Gives arrows to a fighter whose arrows are counted.
    AddArrows {
        /// The fighter.
        fighter: FighterId,
        /// Number of additional arrows.
        arrows: u32,
    },
    /// A noise that creatures hear in this step.
    Noise(Noise),
    /// Sets one of the game's own senses of a creature.
    Sense {
        /// The creature.
        creature: CreatureId,
        /// The sense's name in the brain's file.
        name: String,
        /// The sense's new value.
        value: f64,
    },
    /// Makes a creature walk to a place instead of following its brain, or follow its brain again: [`Creature::send`].
    Send {
        /// The creature.
        creature: CreatureId,
        /// Where it walks to; `None` calls it back.
        to: Option<DVec3>,
    },
    /// Puts a creature's brain into a state: [`Creature::enter`].
    Enter {
        /// The creature.
        creature: CreatureId,
        /// The state's name in the brain's file.
        state: String,
    },
    /// Moves a creature to a place, as if it had begun there: [`Creature::put`]. Fighters on it are left behind, and
    /// other fighters in its new place are moved aside.
    PlaceCreature {
        /// The creature.
        creature: CreatureId,
        /// New position of the model's origin, in world space, metres.
        position: DVec3,
        /// The creature's new heading about Y, radians: 0 is +Z, and positive turns to the creature's left.
        yaw: f64,
    },
    /// Damages a weak point of a creature, open or not: [`Creature::harm`].
    Harm {
        /// The creature.
        creature: CreatureId,
        /// Index of the weak point in its creature's
        /// [`CreatureKind::weak_points`](clamber_colossus::CreatureKind::weak_points).
        weak_point: usize,
        /// Damage, in the unit of the weak point's hit points.
        damage: f64,
    },
}

impl Order {
    /// Orders as bytes, for a file or a network, in the format of the crate postcard. Only the same version of this
    /// crate reads them.
    ///
    /// # Errors
    /// [`ArenaError::Damaged`] if they cannot be written, which does not happen.
    pub fn to_bytes(orders: &[Self]) -> Result<Vec<u8>, ArenaError> {
        postcard::to_stdvec(orders).map_err(|error| ArenaError::Damaged(error.to_string()))
    }

    /// Reads orders from the bytes of [`Order::to_bytes`]. The step checks whether they can be followed.
    ///
    /// # Errors
    /// [`ArenaError::Damaged`] if the bytes are something else.
    pub fn from_bytes(bytes: &[u8]) -> Result<Vec<Self>, ArenaError> {
        let read = postcard::take_from_bytes(bytes);
        let (orders, rest) = read.map_err(|error| ArenaError::Damaged(error.to_string()))?;
        if rest.is_empty() {
            Ok(orders)
        } else {
            Err(ArenaError::Damaged(
                "there is something after the orders".to_owned(),
            ))
        }
    }
}

/// The fighters and creatures that join by the orders of a step, in the order of the list.
#[derive(Default)]
pub(super) struct Joining {
    fighters: Vec<Fighter>,
    creatures: Vec<Member>,
}

/// Greatest number of fighters and creatures that join in one step. Each takes far more memory than its order, so that
/// a short list of orders could otherwise exhaust the memory.
const MOST_JOINS: usize = 256;

impl Joining {
    /// Refuses one more to join if there are too many already, or if no numbers are left.
    fn check(&self, arena: &Arena) -> Result<(), String> {
        let (fighters, creatures) = (self.fighters.len(), self.creatures.len());
        check(fighters + creatures < MOST_JOINS, || {
            format!("more than {MOST_JOINS} would join in one step")
        })?;
        let next = |given: u32, joining: usize| u64::from(given) + joining as u64;
        let next = next(arena.next_fighter, fighters).max(next(arena.next_creature, creatures));
        check(next < u64::from(LAST_NUMBER), || {
            "all numbers were given".to_owned()
        })
    }
}

/// Greatest coordinate of a position in an order, metres.
const FARTHEST_PLACE: f64 = 1e12;

/// Greatest absolute heading in an order, radians.
const MOST_YAW: f64 = 1e6;

impl Arena {
    /// Refuses orders that cannot be followed, and builds the fighters and creatures that join. Does not change the
    /// arena.
    pub(super) fn check_orders(&self, orders: &[Order]) -> Result<Joining, ArenaError> {
        let mut joining = Joining::default();
        for (index, order) in orders.iter().enumerate() {
            let refuse = |reason: String| ArenaError::Order { index, reason };
            match order {
                Order::AddFighter { config, position } => {
                    joining.check(self).map_err(refuse)?;
                    let id = FighterId(self.next_fighter + joining.fighters.len() as u32);
                    let fighter = self.new_fighter(id, **config, *position);
                    let fighter = fighter.map_err(|error| refuse(error.to_string()))?;
                    joining.fighters.push(fighter);
                }
                Order::AddCreature { kind, config } => {
                    joining.check(self).map_err(refuse)?;
                    let id = CreatureId(self.next_creature + joining.creatures.len() as u32);
                    let member = self.new_member(id, *kind, *config);
                    let member = member.map_err(|error| refuse(error.to_string()))?;
                    joining.creatures.push(member);
                }
                _ => self.check_order(order, &joining).map_err(refuse)?,
            }
        }
        Ok(joining)
    }

    fn check_order(&self, order: &Order, joining: &Joining) -> Result<(), String> {
        match order {
            Order::Hurt { damage, .. } => share("damage", *damage),
            Order::Heal {
                hit_points,
                stamina,
                ..
            } => {
                share("hit points", *hit_points)?;
                share("stamina", *stamina)
            }
            Order::Strike { knockback, .. } => {
                share("damage", knockback.damage)?;
                check(knockback.velocity.is_finite(), || {
                    "its velocity is not finite".to_owned()
                })
            }
            Order::PlaceFighter { fighter, position } => {
                place(*position)?;
                self.check_position(*fighter, *position)
            }
            Order::Checkpoint { position, .. } => place(*position),
            Order::Noise(noise) => {
                place(noise.place)?;
                let loudness = noise.loudness;
                let is_loud = (0.0..=f64::MAX).contains(&loudness);
                check(is_loud, || {
                    format!("loudness {loudness} is negative, or not finite")
                })
            }
            other => self.check_creature_order(other, joining),
        }
    }

    /// Refuses an order to a creature; all others pass. A new kind of order has to be added here or in `check_order`.
    fn check_creature_order(&self, order: &Order, joining: &Joining) -> Result<(), String> {
        match order {
            Order::Sense {
                creature,
                name,
                value,
            } => {
                check(value.is_finite(), || {
                    format!("the sense `{name}` is not finite")
                })?;
                self.check_creature((*creature, joining), |creature| {
                    let senses = creature.kind().brain().own_senses();
                    check(senses.contains(name), || {
                        let known = listed(senses);
                        format!("no own sense is called `{name}`; there are {known}")
                    })
                })
            }
            Order::Send { creature, to } => {
                to.map_or(Ok(()), place)?;
                self.check_creature((*creature, joining), |creature| {
                    check(to.is_none() || creature.kind().can_walk(), || {
                        "the creature cannot walk: its brain's file names no gait".to_owned()
                    })
                })
            }
            Order::Enter { creature, state } => {
                self.check_creature((*creature, joining), |creature| {
                    let brain = creature.kind().brain();
                    check(brain.find(state).is_some(), || {
                        let paths: Vec<&str> =
                            brain.states().map(|state| brain.path(state)).collect();
                        format!("no state is called `{state}`; there are {}", listed(&paths))
                    })
                })
            }
            Order::PlaceCreature { position, yaw, .. } => {
                place(*position)?;
                let is_angle = yaw.abs() <= MOST_YAW;
                check(is_angle, || {
                    format!("the heading {yaw} is not finite, or beyond 1e6")
                })
            }
            Order::Harm {
                creature,
                weak_point,
                damage,
            } => {
                let is_damage = (0.0..=f64::MAX).contains(damage);
                check(is_damage, || {
                    format!("damage {damage} is negative, or not finite")
                })?;
                self.check_creature((*creature, joining), |creature| {
                    let count = creature.kind().weak_points().len();
                    check(*weak_point < count, || {
                        format!("there is no weak point {weak_point}: there are {count}")
                    })
                })
            }
            // Listed, so that a new kind of order cannot pass unchecked by oversight.
            Order::AddFighter { .. }
            | Order::AddCreature { .. }
            | Order::RemoveFighter { .. }
            | Order::RemoveCreature { .. }
            | Order::RemoveProjectile { .. }
            | Order::Hurt { .. }
            | Order::Heal { .. }
            | Order::Strike { .. }
            | Order::PlaceFighter { .. }
            | Order::Checkpoint { .. }
            | Order::Rise { .. }
            | Order::AddArrows { .. }
            | Order::Noise(_) => Ok(()),
        }
    }

    /// Refuses a position where a climber with a fighter's configuration cannot be: `Climber::new` decides. An order to
    /// a fighter that is not there passes.
    fn check_position(&self, fighter: FighterId, position: DVec3) -> Result<(), String> {
        let climber = self.fighter(fighter).map(|one| one.config().climber);
        let there = climber.map(|config| Climber::new(config, position));
        there.transpose().map_err(|error| error.to_string())?;
        Ok(())
    }

    /// Runs a check on a creature that is there or joins earlier in the list. An order to any other creature passes.
    fn check_creature(
        &self,
        (creature, joining): (CreatureId, &Joining),
        check: impl FnOnce(&Creature) -> Result<(), String>,
    ) -> Result<(), String> {
        let joins = || {
            let joins = joining.creatures.iter().find(|one| one.id == creature)?;
            Some(&joins.creature)
        };
        self.creature(creature).or_else(joins).map_or(Ok(()), check)
    }

    /// Follows orders that `check_orders` has accepted.
    pub(super) fn follow(&mut self, orders: &[Order], joining: Joining) -> Result<(), ArenaError> {
        let (mut fighters, mut creatures) =
            (joining.fighters.into_iter(), joining.creatures.into_iter());
        for (index, order) in orders.iter().enumerate() {
            let is_heard = match order {
                Order::AddFighter { .. } => fighters.next().is_some_and(|one| {
                    let fighter = self.join_fighter(one);
                    self.events.push(ArenaEvent::FighterJoined { fighter });
                    true
                }),
                Order::AddCreature { .. } => creatures.next().is_some_and(|one| {
                    let creature = self.join_creature(one);
                    self.events.push(ArenaEvent::CreatureJoined { creature });
                    self.make_room(creature);
                    true
                }),
                Order::RemoveCreature { creature } => self.remove_creature(*creature),
                Order::Noise(noise) => {
                    self.noises.push(*noise);
                    true
                }
                Order::RemoveProjectile { projectile } => {
                    let before = self.projectiles.len();
                    self.projectiles.retain(|one| one.id != *projectile);
                    self.projectiles.len() < before
                }
                Order::RemoveFighter { fighter }
                | Order::Hurt { fighter, .. }
                | Order::Heal { fighter, .. }
                | Order::Strike { fighter, .. }
                | Order::PlaceFighter { fighter, .. }
                | Order::Checkpoint { fighter, .. }
                | Order::Rise { fighter }
                | Order::AddArrows { fighter, .. } => self.order_fighter(*fighter, order)?,
                Order::Sense { creature, .. }
                | Order::Send { creature, .. }
                | Order::Enter { creature, .. }
                | Order::PlaceCreature { creature, .. }
                | Order::Harm { creature, .. } => self.order_creature(*creature, order)?,
            };
            if let Order::PlaceCreature { creature, .. } = order {
                self.make_room(*creature);
            }
            if !is_heard {
                self.events.push(ArenaEvent::Unheard { order: index });
            }
        }
        Ok(())
    }

    /// Follows an order to a fighter; false if the fighter is not there.
    fn order_fighter(&mut self, fighter: FighterId, order: &Order) -> Result<bool, ArenaError> {
        let Some(index) = self.fighter_index(fighter) else {
            return Ok(false);
        };
        let one = &mut self.fighters[index];
        match order {
            Order::RemoveFighter { .. } => {
                self.fighters.remove(index);
                self.events.push(ArenaEvent::FighterLeft { fighter });
            }
            Order::Hurt { damage, .. } => one.hurt(*damage)?,
            Order::Heal {
                hit_points,
                stamina,
                ..
            } => one.heal(*hit_points, *stamina)?,
            Order::Strike { knockback, .. } => one.be_struck(*knockback),
            Order::PlaceFighter { position, .. } => one.place(*position)?,
            Order::Checkpoint { position, .. } => one.rest_mut().spawn = *position,
            Order::Rise { .. } => {
                let rose = one.rise()?.then_some(ArenaEvent::Rose { fighter });
                self.events.extend(rose);
            }
            Order::AddArrows { arrows, .. } => {
                if let Some(has) = one.arrows() {
                    one.rest_mut().arrows = has.saturating_add(*arrows);
                }
            }
            // Listed, so that a new kind of order cannot be ignored by oversight.
            Order::AddFighter { .. }
            | Order::AddCreature { .. }
            | Order::RemoveCreature { .. }
            | Order::RemoveProjectile { .. }
            | Order::Noise(_)
            | Order::Sense { .. }
            | Order::Send { .. }
            | Order::Enter { .. }
            | Order::PlaceCreature { .. }
            | Order::Harm { .. } => {}
        }
        Ok(true)
    }

    /// Follows an order to a creature; false if the creature is not there.
    fn order_creature(&mut self, id: CreatureId, order: &Order) -> Result<bool, ArenaError> {
        let Some(creature) = self.creature_mut(id) else {
            return Ok(false);
        };
        // A checked order succeeds; a failure would be reported as `Unheard`.
        let mut is_done = true;
        match order {
            Order::Sense { name, value, .. } => is_done = creature.set_sense(name, *value),
            Order::Send { to, .. } => is_done = creature.send(*to),
            Order::Enter { state, .. } => is_done = creature.enter(state),
            Order::PlaceCreature { position, yaw, .. } => creature.put(*position, *yaw)?,
            Order::Harm {
                weak_point, damage, ..
            } => {
                let was_alive = creature.health() > 0.0;
                is_done = creature.harm(*weak_point, *damage).is_some();
                if was_alive && creature.health() <= 0.0 {
                    self.events.push(ArenaEvent::Killed {
                        creature: id,
                        by: None,
                    });
                }
            }
            Order::AddFighter { .. }
            | Order::AddCreature { .. }
            | Order::RemoveFighter { .. }
            | Order::RemoveCreature { .. }
            | Order::RemoveProjectile { .. }
            | Order::Hurt { .. }
            | Order::Heal { .. }
            | Order::Strike { .. }
            | Order::PlaceFighter { .. }
            | Order::Checkpoint { .. }
            | Order::Rise { .. }
            | Order::AddArrows { .. }
            | Order::Noise(_) => {}
        }
        Ok(is_done)
    }

    /// Makes fighters inside a creature that was just added or moved look for room in this step, except those that ride
    /// it.
    fn make_room(&mut self, creature: CreatureId) {
        let Some(index) = self.creature_index(creature) else {
            return;
        };
        let skin = self.creatures[index].creature.surface();
        let skins: [(ObstacleId, &dyn Obstacle); 1] = [(creature_obstacle(creature), skin)];
        let room = Room {
            obstacles: &skins,
            bodies: &[],
        };
        let living = self.fighters.iter_mut().filter(|one| !one.is_dead());
        for fighter in living {
            let support = fighter.climber().state().support;
            let rides = support.is_some_and(|on| on.attachment.obstacle == skins[0].0);
            if !rides && !room.is_free(&fighter.climber().body()) {
                fighter.rest_mut().has_begun = false;
            }
        }
    }

    /// Removes a creature; false if it is not there.
    fn remove_creature(&mut self, creature: CreatureId) -> bool {
        let Some(index) = self.creature_index(creature) else {
            return false;
        };
        // Arrows fall from where they stick. This takes the creature's skin, so they are let go before it is removed.
        let mut outcome = Outcome::default();
        let obstacle = super::creature_obstacle(creature);
        let skin = self.creatures[index].creature.surface();
        let stuck = self
            .projectiles
            .iter_mut()
            .filter(|one| one.is_in(obstacle));
        stuck.for_each(|projectile| projectile.drop_from(skin, &mut outcome));
        self.creatures.remove(index);
        self.events.push(ArenaEvent::CreatureLeft { creature });
        self.events.append(&mut outcome.events);
        true
    }
}

/// Refuses a share that is not from 0 to 1.
fn share(what: &str, found: f64) -> Result<(), String> {
    let is_share = (0.0..=1.0).contains(&found);
    check(is_share, || format!("{what} {found} is not from 0 to 1"))
}

/// Refuses a place that is too far away.
fn place(place: DVec3) -> Result<(), String> {
    let is_near = place.is_finite() && place.abs().max_element() <= FARTHEST_PLACE;
    check(is_near, || {
        format!("the place {place} is not finite, or beyond 1e12 m")
    })
}

fn check(holds: bool, reason: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(reason()) }
}

/// A list of names for an error message.
fn listed(names: &[impl AsRef<str>]) -> String {
    if names.is_empty() {
        return "none".to_owned();
    }
    let quoted: Vec<String> = names
        .iter()
        .map(|name| format!("`{}`", name.as_ref()))
        .collect();
    quoted.join(", ")
}
