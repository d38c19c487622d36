//! Rollback over a network with the crate [ggrs]: the arena's side of it.
//!
//! Peers send each other their players' inputs and predict inputs that have not arrived. When a prediction was wrong,
//! they go back and step again. ggrs decides all of this. This module saves, restores and steps the arena on its
//! request, and keeps events until they are confirmed.
//!
//! ```no_run
//! use clamber_fight::rollback::{AdvanceError, ArenaSession, Rollback, Watch};
//! use clamber_climber::StepRules;
//! use clamber_fight::{Arena, Order, PlayerInput};
//! use clamber_world::{HalfSpace, Obstacle, ObstacleId};
//! use ggrs::{DesyncDetection, PlayerType, SessionBuilder, UdpNonBlockingSocket};
//!
//! # fn fight(mut arena: Arena, input: PlayerInput) -> Result<(), Box<dyn std::error::Error>> {
//! let (socket, mut watch) = Watch::over(UdpNonBlockingSocket::bind_to_port(7000)?);
//! let mut session = SessionBuilder::<ArenaSession<std::net::SocketAddr>>::new()
//!     .with_num_players(2)?
//!     .with_desync_detection_mode(DesyncDetection::On { interval: 60 })
//!     .add_player(PlayerType::Local, 0)? // fighter 0 is ours
//!     .add_player(PlayerType::Remote("192.168.0.2:7000".parse()?), 1)?
//!     .start_p2p_session(socket)?;
//! let mut rollback = Rollback::new(&arena);
//! let ground = HalfSpace::below(0.0);
//! let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &ground)];
//! loop {
//!     // One fixed tick.
//!     for event in watch.poll(&mut session) {
//!         println!("{event:?}"); // who is there, and who is gone
//!     }
//!     if session.current_state() == ggrs::SessionState::Running {
//!         session.add_local_input(0, input)?;
//!         match watch.advance(&mut session) {
//!             Ok(requests) => {
//!                 rollback.handle(&mut arena, requests, |arena, inputs, asked| {
//!                     let orders = orders_of(arena, asked); // the game's own: see below
//!                     arena.step_with(inputs, &orders, &terrain, &StepRules::default()).map(drop)
//!                 })?;
//!                 for (tick, event) in rollback.confirmed(session.confirmed_frame()) {
//!                     println!("{tick}: {event:?}"); // each once, and none of a tick that is taken back
//!                 }
//!             }
//!             Err(AdvanceError::Wait) => {} // for what others know of somebody who is gone
//!             Err(error) => return Err(error.into()),
//!         }
//!     }
//!     # return Ok(());
//! }
//! # }
//!
//! /// Fruit that heals, which a player eats by an order of its own; and lava, which hurts who stands in it.
//! fn orders_of(arena: &Arena, asked: &[u16]) -> Vec<Order> {
//!     const EATS: u16 = 1;
//!     let mut orders = Vec::new();
//!     for (fighter, asked) in arena.fighters().iter().zip(asked) {
//!         let (fighter, place) = (fighter.id(), fighter.climber().state().position);
//!         if *asked == EATS {
//!             orders.push(Order::Heal { fighter, hit_points: 0.2, stamina: 0.5 });
//!         }
//!         if place.y < -2.0 {
//!             orders.push(Order::Hurt { fighter, damage: 0.01 });
//!         }
//!     }
//!     orders
//! }
//! ```
//!
//! ggrs does not send [`Order`](crate::Order)s. Each peer derives them from the arena and the inputs, which all peers
//! know; [`PlayerInput::order`](crate::PlayerInput) is part of the inputs.
//!
//! ggrs does not let players join a session. For a late joiner, all peers end their session at a confirmed tick, and
//! one peer sends [`Arena::to_bytes`](crate::Arena) to the others. Then all begin a new session, and the new player
//! joins by [`Order::AddFighter`](crate::Order) in its first step. The example `duel` shows this.

mod watch;

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::hash::Hash;
use std::marker::PhantomData;

use clamber_climber::ClimberInput;
/// The version of ggrs that this module uses.
pub use ggrs;
use ggrs::{Config, Frame, GgrsRequest, InputPredictor, InputStatus};

use crate::actions::PlayerInput;
use crate::arena::{Arena, ArenaEvent, ArenaState};
use crate::error::ArenaError;
pub use watch::{AdvanceError, Watch, Watched};

/// ggrs's configuration for an arena; `A` is the type of the peers' addresses:
/// `SessionBuilder::<ArenaSession<SocketAddr>>::new()`.
#[derive(Debug)]
pub struct ArenaSession<A>(PhantomData<A>);

impl<A: Clone + PartialEq + Eq + Hash + Debug + 'static> Config for ArenaSession<A> {
    type Input = PlayerInput;
    type InputPredictor = PredictPlayer;
    type State = ArenaState;
    type Address = A;
}

/// Predicts inputs that have not arrived: the player repeats its last input, without its order.
#[derive(Debug)]
pub struct PredictPlayer;

impl InputPredictor<PlayerInput> for PredictPlayer {
    fn predict(previous: PlayerInput) -> PlayerInput {
        PlayerInput {
            order: 0,
            ..previous
        }
    }
}

/// The arena's side of one ggrs session: it saves, restores and steps the arena as the session requests, and keeps
/// events until they are confirmed.
#[derive(Clone, Debug)]
pub struct Rollback {
    /// The arena's tick when the session began.
    began: u64,
    /// Events of each tick that is not yet confirmed.
    events: BTreeMap<u64, Vec<ArenaEvent>>,
}

impl Rollback {
    /// Creates the handler of the requests of a new session. Each peer calls it once per session, before the session's
    /// first tick, with the arena as it is then; an arena that was stepped before is allowed. Only the arena's tick is
    /// kept.
    pub fn new(arena: &Arena) -> Self {
        Self {
            began: arena.tick(),
            events: BTreeMap::new(),
        }
    }

    /// Handles a session's requests in order: saves, restores, and steps. `step` gets the inputs and the
    /// [`PlayerInput::order`] of all players, by their numbers in the session. Each state is saved with its
    /// [`Arena::fingerprint`] as the checksum. A player that has left has idle inputs and no orders.
    ///
    /// `step` may depend only on the arena, these inputs and orders, and terrain that is the same on all peers. It is
    /// called again for the same tick when a prediction was wrong.
    ///
    /// # Errors
    /// The errors of `step`, and [`ArenaError::OtherArena`] if ggrs asks for a state that was not saved.
    pub fn handle<A: Clone + PartialEq + Eq + Hash + Debug + 'static>(
        &mut self,
        arena: &mut Arena,
        requests: Vec<GgrsRequest<ArenaSession<A>>>,
        mut step: impl FnMut(&mut Arena, &[ClimberInput], &[u16]) -> Result<(), ArenaError>,
    ) -> Result<(), ArenaError> {
        for request in requests {
            match request {
                GgrsRequest::SaveGameState { cell, frame } => {
                    let sum = u128::from(arena.fingerprint());
                    cell.save(frame, Some(arena.save()), Some(sum));
                }
                GgrsRequest::LoadGameState { cell, .. } => {
                    let missing = ArenaError::OtherArena("it was not saved");
                    let state = cell.data().ok_or(missing)?;
                    arena.restore(&state)?;
                    // The ticks after the restored one are played again, and produce their events again.
                    self.events.split_off(&(arena.tick() + 1));
                }
                GgrsRequest::AdvanceFrame { inputs } => {
                    let input = |(input, status): &(PlayerInput, InputStatus)| match status {
                        InputStatus::Disconnected => ClimberInput::IDLE,
                        InputStatus::Confirmed | InputStatus::Predicted => input.to_input(),
                    };
                    let order = |(input, status): &(PlayerInput, InputStatus)| match status {
                        InputStatus::Disconnected => 0,
                        InputStatus::Confirmed | InputStatus::Predicted => input.order,
                    };
                    let orders: Vec<u16> = inputs.iter().map(order).collect();
                    let inputs: Vec<ClimberInput> = inputs.iter().map(input).collect();
                    step(arena, &inputs, &orders)?;
                    if !arena.events().is_empty() {
                        self.events.insert(arena.tick(), arena.events().to_vec());
                    }
                }
            }
        }
        Ok(())
    }

    /// Events that were confirmed since the last call, with their ticks, in order. `frame` is the session's
    /// `confirmed_frame` after [`Rollback::handle`]: all inputs up to that frame are known and were played. Do not call
    /// it while [`Watch::advance`] returns [`AdvanceError::Wait`]: frames that are confirmed meanwhile have not been
    /// played yet.
    pub fn confirmed(&mut self, frame: Frame) -> impl Iterator<Item = (u64, ArenaEvent)> + use<> {
        let certain = u64::try_from(frame).map_or(0, |frame| self.began + frame + 1);
        let later = self.events.split_off(&(certain + 1));
        let events = std::mem::replace(&mut self.events, later);
        events
            .into_iter()
            .flat_map(|(tick, events)| events.into_iter().map(move |event| (tick, event)))
    }
}
