//! One peer: a session of ggrs, its arena, and what it has told.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Debug;
use std::hash::Hash;

use clamber::climber::ClimberInput;
use clamber::fight::ArenaEvent;
use clamber::fight::rollback::ggrs::{
    DesyncDetection, GgrsError, GgrsEvent, GgrsRequest, NonBlockingSocket, P2PSession, PlayerType,
    SessionBuilder, SessionState,
};
use clamber::fight::rollback::{ArenaSession, Rollback};

use clamber_scenes::duel::Duel;

/// Ticks from a press of a button until it counts: the less, the more rollbacks.
const DELAY: usize = 2;

/// Who the other one is, to a line.
pub(crate) trait Address: Clone + PartialEq + Eq + Hash + Debug + 'static {}

impl<A: Clone + PartialEq + Eq + Hash + Debug + 'static> Address for A {}

pub(crate) struct Peer<A: Address> {
    session: P2PSession<ArenaSession<A>>,
    fight: Duel,
    rollback: Rollback,
    /// Of each tick, the checksum that it had last.
    sums: BTreeMap<u64, u64>,
    /// Of each tick, the inputs that led to it, as they were last.
    inputs: BTreeMap<u64, Vec<ClimberInput>>,
    told: Vec<(u64, ArenaEvent)>,
    rollbacks: u32,
    longest: u32,
    waits: u32,
}

impl<A: Address> Peer<A> {
    /// A peer that plays the players without an address.
    pub(crate) fn new(
        socket: impl NonBlockingSocket<A> + 'static,
        players: [Option<A>; 2],
        fight: Duel,
    ) -> Result<Self, Box<dyn Error>> {
        let mut builder = SessionBuilder::<ArenaSession<A>>::new()
            .with_num_players(2)?
            .with_input_delay(DELAY)
            .with_desync_detection_mode(DesyncDetection::On { interval: 30 });
        for (player, address) in players.into_iter().enumerate() {
            let kind = address.map_or(PlayerType::Local, PlayerType::Remote);
            builder = builder.add_player(kind, player)?;
        }
        Ok(Self {
            session: builder.start_p2p_session(socket)?,
            rollback: Rollback::new(&fight.arena),
            fight,
            sums: BTreeMap::new(),
            inputs: BTreeMap::new(),
            told: Vec::new(),
            rollbacks: 0,
            longest: 0,
            waits: 0,
        })
    }

    pub(crate) fn is_running(&self) -> bool {
        self.session.current_state() == SessionState::Running
    }

    /// Ticks that are certain.
    pub(crate) fn confirmed(&self) -> u64 {
        // Frame 0 leads to tick 1.
        u64::try_from(self.session.confirmed_frame() + 1).unwrap_or(0)
    }

    /// One tick, if the session lets it pass; none after the last one.
    pub(crate) fn tick(&mut self, last: u64) -> Result<(), Box<dyn Error>> {
        self.session.poll_remote_clients();
        for event in self.session.events() {
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
        // Some ticks beyond the last one: their inputs confirm it.
        let tick = self.session.current_frame().unsigned_abs().into();
        if !self.is_running() || tick >= last + 30 {
            return Ok(());
        }
        for player in self.session.local_player_handles() {
            self.session
                .add_local_input(player, Duel::input(player, tick))?;
        }
        let requests = match self.session.advance_frame() {
            Ok(requests) => requests,
            // The other one is too far behind.
            Err(GgrsError::PredictionThreshold) => {
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
        let (sums, taken, ground) = (&mut self.sums, &mut self.inputs, self.fight.ground);
        self.rollback
            .handle(&mut self.fight.arena, requests, |arena, inputs, _| {
                Duel::step(arena, &ground, inputs)?;
                sums.insert(arena.tick(), arena.fingerprint());
                taken.insert(arena.tick(), inputs.to_vec());
                Ok(())
            })?;
        let confirmed = self.session.confirmed_frame();
        // A game plays sounds and shows hits here: each once.
        self.told.extend(self.rollback.confirmed(confirmed));
        Ok(())
    }

    /// The checksums of all ticks up to one.
    pub(crate) fn sums_until(&self, tick: u64) -> Vec<(u64, u64)> {
        self.sums
            .range(..=tick)
            .map(|(tick, sum)| (*tick, *sum))
            .collect()
    }

    /// The inputs of all ticks up to one.
    pub(crate) fn inputs_until(&self, tick: u64) -> impl Iterator<Item = Vec<ClimberInput>> {
        self.inputs.range(..=tick).map(|(_, inputs)| inputs.clone())
    }

    /// What was told of ticks before one.
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
