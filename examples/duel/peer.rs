//! One peer: a session of ggrs, its arena, and the events that it has reported.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Debug;
use std::hash::Hash;

use clamber::climber::ClimberInput;
use clamber::fight::rollback::ggrs::{
    DesyncDetection, GgrsEvent, GgrsRequest, NonBlockingSocket, P2PSession, PlayerType,
    SessionBuilder, SessionState,
};
use clamber::fight::rollback::{AdvanceError, ArenaSession, Rollback, Watch};
use clamber::fight::{ArenaEvent, FighterConfig, Order};
use clamber::glam::DVec3;

use clamber_scenes::duel::Duel;

/// Delay of the local player's input, ticks. With less, there are more rollbacks; with more, the game reacts later.
const DELAY: usize = 2;

/// Largest number of ticks that are predicted and repeated. With less, a peer waits more often on a slow line.
const WINDOW: usize = 10;

/// A third climber joins in the step in which this is given: behind the giant.
fn joiner() -> Order {
    Order::AddFighter {
        config: Box::new(FighterConfig::hero()),
        position: DVec3::new(-4.0, 1.0, -25.0),
    }
}

/// The address of another peer.
pub(crate) trait Address: Clone + PartialEq + Eq + Hash + Debug + 'static {}

impl<A: Clone + PartialEq + Eq + Hash + Debug + 'static> Address for A {}

/// The inputs of a step, and its orders.
pub(crate) type Step = (Vec<ClimberInput>, Vec<Order>);

pub(crate) struct Peer<A: Address> {
    session: P2PSession<ArenaSession<A>>,
    watch: Watch<A>,
    /// Tick of the arena when the session began.
    began: u64,
    /// The tick in whose step a third climber joins.
    joins: Option<u64>,
    /// The arena at the end of the tick before that. A rollback replaces it.
    saved: Vec<u8>,
    fight: Duel,
    rollback: Rollback,
    /// The checksum of each tick, from its last repetition.
    sums: BTreeMap<u64, u64>,
    /// The inputs and orders of each tick, from its last repetition.
    steps: BTreeMap<u64, Step>,
    told: Vec<(u64, ArenaEvent)>,
    rollbacks: u32,
    longest: u32,
    waits: u32,
}

impl<A: Address> Peer<A> {
    /// A peer that plays the players without an address. A third climber joins in the step to the tick `joins`.
    pub(crate) fn new(
        socket: impl NonBlockingSocket<A> + 'static,
        players: &[Option<A>],
        fight: Duel,
        joins: Option<u64>,
    ) -> Result<Self, Box<dyn Error>> {
        let (socket, watch) = Watch::over(socket);
        Ok(Self {
            session: session(socket, players)?,
            watch,
            began: fight.arena.tick(),
            joins,
            saved: Vec::new(),
            rollback: Rollback::new(&fight.arena),
            fight,
            sums: BTreeMap::new(),
            steps: BTreeMap::new(),
            told: Vec::new(),
            rollbacks: 0,
            longest: 0,
            waits: 0,
        })
    }

    /// Goes on from a saved arena in a new session, with other players: a ggrs session that has begun takes no new
    /// players.
    pub(crate) fn begin_again(
        &mut self,
        socket: impl NonBlockingSocket<A> + 'static,
        players: &[Option<A>],
        saved: &[u8],
    ) -> Result<(), Box<dyn Error>> {
        let arena = &mut self.fight.arena;
        arena.restore_bytes(saved)?;
        self.began = arena.tick();
        self.rollback = Rollback::new(arena);
        let (socket, watch) = Watch::over(socket);
        (self.session, self.watch) = (session(socket, players)?, watch);
        // Later ticks of the old session were not confirmed.
        self.sums.split_off(&(self.began + 1));
        self.steps.split_off(&(self.began + 1));
        Ok(())
    }

    /// The arena before the third climber joins; final once that tick is confirmed.
    pub(crate) fn saved(&self) -> &[u8] {
        &self.saved
    }

    pub(crate) fn is_running(&self) -> bool {
        self.session.current_state() == SessionState::Running
    }

    /// The last tick whose inputs are all confirmed.
    pub(crate) fn confirmed(&self) -> u64 {
        // Frame 0 leads to the first tick.
        self.began + u64::try_from(self.session.confirmed_frame() + 1).unwrap_or(0)
    }

    /// Steps one tick, unless the session has to wait, or the last tick is confirmed.
    pub(crate) fn tick(&mut self, last: u64) -> Result<(), Box<dyn Error>> {
        for event in self.watch.poll(&mut self.session) {
            match event {
                GgrsEvent::DesyncDetected { frame, .. } => {
                    return Err(format!("the peers differ at frame {frame}").into());
                }
                GgrsEvent::Disconnected { addr } => {
                    return Err(format!("{addr:?} has left").into());
                }
                _ => {}
            }
        }
        // The session steps up to 30 ticks beyond the last one: their inputs confirm it.
        let tick = self.began + u64::from(self.session.current_frame().unsigned_abs());
        if !self.is_running() || tick >= last + 30 {
            return Ok(());
        }
        for player in self.session.local_player_handles() {
            self.session
                .add_local_input(player, Duel::input(player, tick))?;
        }
        let requests = match self.watch.advance(&mut self.session) {
            Ok(requests) => requests,
            // The others are too far behind.
            Err(AdvanceError::Wait) => {
                self.waits += 1;
                return Ok(());
            }
            Err(error) => return Err(error.into()),
        };
        let is_step =
            |request: &&GgrsRequest<_>| matches!(request, GgrsRequest::AdvanceFrame { .. });
        let is_load =
            |request: &&GgrsRequest<_>| matches!(request, GgrsRequest::LoadGameState { .. });
        let steps = requests.iter().filter(is_step).count() as u32;
        self.rollbacks += requests.iter().filter(is_load).count() as u32;
        self.longest = self.longest.max(steps.saturating_sub(1));
        let (sums, taken, ground) = (&mut self.sums, &mut self.steps, self.fight.ground);
        let (joins, saved, began) = (self.joins, &mut self.saved, self.began);
        self.rollback
            .handle(&mut self.fight.arena, requests, |arena, inputs, _| {
                let next = arena.tick() + 1;
                // Only the new session adds the climber: the ticks of the old one beyond its end are discarded.
                let orders: Vec<Order> = match joins {
                    Some(tick) if tick == next && tick == began + 1 => vec![joiner()],
                    _ => Vec::new(),
                };
                // A climber that joins in this step has no input in it.
                let inputs = &inputs[..inputs.len().min(arena.fighters().len())];
                Duel::step(arena, &ground, inputs, &orders)?;
                if joins == Some(next + 1) {
                    *saved = arena.to_bytes()?;
                }
                sums.insert(next, arena.fingerprint());
                taken.insert(next, (inputs.to_vec(), orders));
                Ok(())
            })?;
        let confirmed = self.session.confirmed_frame();
        // A game plays sounds and shows hits here, so that each comes once.
        let certain = self.rollback.confirmed(confirmed);
        // Events beyond the last tick are dropped.
        self.told.extend(certain.filter(|(tick, _)| *tick <= last));
        Ok(())
    }

    /// The checksums of all ticks up to one.
    pub(crate) fn sums_until(&self, tick: u64) -> Vec<(u64, u64)> {
        self.sums
            .range(..=tick)
            .map(|(tick, sum)| (*tick, *sum))
            .collect()
    }

    /// The inputs and orders of all ticks up to one.
    pub(crate) fn steps_until(&self, tick: u64) -> impl Iterator<Item = Step> {
        self.steps.range(..=tick).map(|(_, step)| step.clone())
    }

    /// The reported events of ticks before one.
    pub(crate) fn told_before(&self, tick: u64) -> Vec<&(u64, ArenaEvent)> {
        self.told.iter().filter(|(at, _)| *at < tick).collect()
    }

    pub(crate) fn report(&self) -> String {
        format!(
            "tick {}, {} rollbacks of up to {} ticks, {} waits, {} events",
            self.fight.arena.tick(),
            self.rollbacks,
            self.longest,
            self.waits,
            self.told.len()
        )
    }
}

/// A session with these players. Players without an address are local.
fn session<A: Address>(
    socket: impl NonBlockingSocket<A> + 'static,
    players: &[Option<A>],
) -> Result<P2PSession<ArenaSession<A>>, Box<dyn Error>> {
    let mut builder = SessionBuilder::<ArenaSession<A>>::new()
        .with_num_players(players.len())?
        .with_max_prediction_window(WINDOW)
        .with_input_delay(DELAY)
        .with_desync_detection_mode(DesyncDetection::On { interval: 30 });
    for (player, address) in players.iter().cloned().enumerate() {
        let kind = address.map_or(PlayerType::Local, PlayerType::Remote);
        builder = builder.add_player(kind, player)?;
    }
    Ok(builder.start_p2p_session(socket)?)
}
