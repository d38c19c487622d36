//! Orders: what a game does to an arena between two of its ticks.

use clamber_climber::{Blow, Climber};
use clamber_colossus::{Creature, CreatureConfig, Noise};
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{Arena, ArenaEvent, CreatureId, KindId, LAST, Member, Outcome, creature_obstacle};
use crate::error::ArenaError;
use crate::fighter::{Fighter, FighterConfig, FighterId, Room};
use crate::projectile::ProjectileId;

/// Something that a game does to an arena, beside what players do: falling rocks, fruit, checkpoints, scenes, waves of
/// creatures. Orders are given to [`Arena::step_with`], and followed at the beginning of that step, one after the other.
///
/// They are a part of what led to a tick as the inputs are: record them, and give them again when a tick is stepped
/// again. Nothing else changes an arena between ticks, but for [`Arena::restore`].
///
/// Who is named may be gone by then, as in a game over a network: such an order changes nothing, and
/// [`ArenaEvent::Unheard`] tells. Places are in world space, metres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Order {
    /// A fighter joins, at rest in the air, with the number [`Arena::next_fighter`]; it moves from this step on, without
    /// input in this one. It goes aside if somebody is there.
    AddFighter {
        /// Its body and weapons.
        config: Box<FighterConfig>,
        /// The centre of its climber's ball, where it rises after its death, too.
        position: DVec3,
    },
    /// A fighter leaves. Whoever holds it falls; its arrows stay.
    RemoveFighter {
        /// The fighter.
        fighter: FighterId,
    },
    /// A creature joins, with the number [`Arena::next_creature`]. Who is where it begins goes aside.
    AddCreature {
        /// Its kind, which the arena knows by [`Arena::add_kind`].
        kind: KindId,
        /// Where it begins, and how large it is.
        config: CreatureConfig,
    },
    /// A creature leaves. Whoever is on it falls, and arrows in it come loose.
    RemoveCreature {
        /// The creature.
        creature: CreatureId,
    },
    /// An arrow or a stone is taken away.
    RemoveProjectile {
        /// The projectile.
        projectile: ProjectileId,
    },
    /// A fighter loses hit points.
    Hurt {
        /// The fighter.
        fighter: FighterId,
        /// Hit points, 0 to 1.
        damage: f64,
    },
    /// A fighter who lives gets hit points and stamina, up to what is full.
    Heal {
        /// The fighter.
        fighter: FighterId,
        /// Hit points, 0 to 1.
        hit_points: f64,
        /// Stamina, 0 to 1.
        stamina: f64,
    },
    /// Something strikes a fighter: it is thrown, and loses hit points. Of several blows in a tick the hardest throws it,
    /// and all do damage.
    Strike {
        /// The fighter.
        fighter: FighterId,
        /// The blow.
        blow: Blow,
    },
    /// A fighter is put somewhere, at rest in the air, with the hit points that it has; what it did with its weapons is
    /// over. It goes aside if somebody is there.
    PlaceFighter {
        /// The fighter.
        fighter: FighterId,
        /// The centre of its climber's ball.
        position: DVec3,
    },
    /// A fighter rises here from its next death on.
    Checkpoint {
        /// The fighter.
        fighter: FighterId,
        /// The centre of its climber's ball.
        position: DVec3,
    },
    /// A dead fighter rises at once; nothing happens to one who lives.
    Rise {
        /// The fighter.
        fighter: FighterId,
    },
    /// A fighter gets arrows, if they are counted.
    AddArrows {
        /// The fighter.
        fighter: FighterId,
        /// How many more.
        arrows: u32,
    },
    /// Creatures hear something in this step.
    Noise(Noise),
    /// One of the game's own senses of a creature is set.
    Sense {
        /// The creature.
        creature: CreatureId,
        /// Its name in the brain's file.
        name: String,
        /// Its value.
        value: f64,
    },
    /// A creature walks somewhere, whatever its brain wants, or does what that wants again: [`Creature::send`].
    Send {
        /// The creature.
        creature: CreatureId,
        /// Where to; `None` calls it back.
        to: Option<DVec3>,
    },
    /// A creature's brain goes to a state: [`Creature::enter`].
    Enter {
        /// The creature.
        creature: CreatureId,
        /// The state's name in the brain's file.
        state: String,
    },
    /// A creature is put somewhere, as if it had begun there: [`Creature::put`]. Whoever is on it is left behind,
    /// and who is where it comes goes aside.
    PlaceCreature {
        /// The creature.
        creature: CreatureId,
        /// Where its model's origin is.
        position: DVec3,
        /// Its heading, radians about Y.
        yaw: f64,
    },
    /// A weak point of a creature is hurt, open or not: [`Creature::harm`].
    Harm {
        /// The creature.
        creature: CreatureId,
        /// The weak point, by its index.
        weak_point: usize,
        /// Damage, in the weak point's hit points.
        damage: f64,
    },
}

impl Order {
    /// Orders as bytes, for a file or to send them: in the format of the crate postcard, which only the same version of
    /// this crate reads.
    ///
    /// # Errors
    /// [`ArenaError::Damaged`] if they cannot be written, which does not happen.
    pub fn to_bytes(orders: &[Self]) -> Result<Vec<u8>, ArenaError> {
        postcard::to_stdvec(orders).map_err(|error| ArenaError::Damaged(error.to_string()))
    }

    /// What [`Order::to_bytes`] gave. Whether they can be followed, the step tells.
    ///
    /// # Errors
    /// [`ArenaError::Damaged`] if these are other bytes.
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

/// Whoever joins by the orders of a step, in order.
#[derive(Default)]
pub(super) struct Joining {
    fighters: Vec<Fighter>,
    creatures: Vec<Member>,
}

/// No more join in one step: each takes far more memory than the order for it.
const MOST_JOINS: usize = 256;

impl Joining {
    /// Refuses one more.
    fn check(&self, arena: &Arena) -> Result<(), String> {
        let (fighters, creatures) = (self.fighters.len(), self.creatures.len());
        check(fighters + creatures < MOST_JOINS, || {
            format!("more than {MOST_JOINS} would join in one step")
        })?;
        let next = |given: u32, joining: usize| u64::from(given) + joining as u64;
        let next = next(arena.next_fighter, fighters).max(next(arena.next_creature, creatures));
        check(next < u64::from(LAST), || {
            "all numbers were given".to_owned()
        })
    }
}

/// Places are no further from the origin, metres.
const FARTHEST: f64 = 1e12;

/// Headings are no larger, radians.
const MOST_YAW: f64 = 1e6;

impl Arena {
    /// Refuses orders that cannot be followed, and makes who joins. Nothing is changed.
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
        let share = |what: &str, found: f64| {
            let is_share = (0.0..=1.0).contains(&found);
            check(is_share, || format!("{what} {found} is not from 0 to 1"))
        };
        let place = |place: DVec3| {
            let is_near = place.is_finite() && place.abs().max_element() <= FARTHEST;
            check(is_near, || {
                format!("the place {place} is not finite, or beyond 1e12 m")
            })
        };
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
            Order::Strike { blow, .. } => {
                share("damage", blow.damage)?;
                check(blow.velocity.is_finite(), || {
                    "its velocity is not finite".to_owned()
                })
            }
            Order::PlaceFighter { fighter, position } => {
                place(*position)?;
                // Only a climber knows whether it can be there.
                let climber = self.fighter(*fighter).map(|one| one.config().climber);
                let there = climber.map(|config| Climber::new(config, *position));
                there.transpose().map_err(|error| error.to_string())?;
                Ok(())
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
                        format!(
                            "no own sense is called `{name}`; there are {}",
                            listed(senses)
                        )
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
            Order::AddFighter { .. }
            | Order::AddCreature { .. }
            | Order::RemoveFighter { .. }
            | Order::RemoveCreature { .. }
            | Order::RemoveProjectile { .. }
            | Order::Rise { .. }
            | Order::AddArrows { .. } => Ok(()),
        }
    }

    /// Checks what is asked of a creature, if it is there or joins before.
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

    /// Follows orders that were checked.
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

    /// Follows an order to a fighter; false if it is not there.
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
            Order::Strike { blow, .. } => one.take_blow(*blow),
            Order::PlaceFighter { position, .. } => one.place(*position)?,
            Order::Checkpoint { position, .. } => one.rest_mut().spawn = *position,
            Order::Rise { .. } => {
                let rose = one.rise()?.then_some(ArenaEvent::Rose { fighter });
                self.events.extend(rose);
            }
            Order::AddArrows { arrows, .. } => {
                let has = one.rest().arrows;
                one.rest_mut().arrows = has.saturating_add(*arrows);
            }
            _ => {}
        }
        Ok(true)
    }

    /// Follows an order to a creature; false if it is not there.
    fn order_creature(&mut self, id: CreatureId, order: &Order) -> Result<bool, ArenaError> {
        let Some(creature) = self.creature_mut(id) else {
            return Ok(false);
        };
        // What was checked is done; else it would be told.
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
            _ => {}
        }
        Ok(is_done)
    }

    /// Those on whom a creature has just come go aside in this step, but for those who rode it.
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

    /// Takes a creature away; false if it is not there.
    fn remove_creature(&mut self, creature: CreatureId) -> bool {
        let Some(index) = self.creature_index(creature) else {
            return false;
        };
        // Arrows fall from where they are, which only the skin knows.
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

fn check(holds: bool, reason: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(reason()) }
}

/// Names, for a message.
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
