//! Detects that a player has left while the peers know different parts of its inputs.

use std::fmt::Debug;
use std::hash::Hash;
use std::sync::{Arc, Mutex, PoisonError};

use ggrs::{Frame, GgrsError, GgrsEvent, GgrsRequest, Message, NonBlockingSocket, P2PSession};
use thiserror::Error;

use super::ArenaSession;

/// Watches a ggrs session for a player that leaves while the remaining peers know different parts of its inputs.
/// [`Watch::advance`] then returns [`AdvanceError::LeftBadly`], at once or after some waiting: the session has to end.
/// Without the watch, ggrs may panic.
///
/// With three or more peers, each peer may have received a different part of the leaving player's last packets. All
/// peers then go back to the first tick that one of them does not know. ggrs 0.13 repeats this in each of its steps,
/// and panics once that tick is out of its prediction window. The watch recognises this earlier, from the connection
/// states that peers send each other.
///
/// Use [`Watch::poll`] and [`Watch::advance`] in place of the session's own `poll_remote_clients`, `events` and
/// `advance_frame`, and give the session the socket of [`Watch::over`].
#[derive(Debug)]
pub struct Watch<A> {
    heard: Arc<Mutex<Heard<A>>>,
    /// Peers whose disconnection this peer has noticed itself.
    gone: Vec<A>,
    /// Consecutive calls in which this peer has waited for the others' reports on a player that left.
    waited: u32,
}

/// A socket whose messages a [`Watch`] reads as well.
#[derive(Debug)]
pub struct Watched<S, A> {
    socket: S,
    heard: Arc<Mutex<Heard<A>>>,
}

/// The last report of each peer, with its session's number: for each player, whether it has left, and its last frame
/// that the peer has received.
type Heard<A> = Vec<(A, u16, Vec<(bool, Frame)>)>;

/// Greatest number of addresses whose reports are stored. Any address may send packets, so the list must not grow
/// without limit.
const MOST_PEERS: usize = 64;

/// Why [`Watch::advance`] returns no requests.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AdvanceError {
    /// This peer is too far ahead of the others, or waits for their reports on a player that left. Poll again in the
    /// next tick, and do not treat any event as confirmed meanwhile.
    #[error("this peer waits for the others")]
    Wait,
    /// A player has left, and another peer knows fewer of its inputs than this one. This session has to end.
    #[error(
        "player {player} has left, and the peers know different parts of what it did: end this session, let one peer send its arena (`Arena::to_bytes`), and begin a new one from there"
    )]
    LeftBadly {
        /// The player's number in the session.
        player: usize,
    },
    /// Another error of ggrs.
    #[error(transparent)]
    Ggrs(GgrsError),
}

/// Greatest number of calls for which a peer waits for the others' reports on a player that left: ten seconds at 60
/// ticks a second.
const LONGEST_WAIT: u32 = 600;

/// Index of ggrs's message with inputs among its kinds of messages. It begins with the connection states of all
/// players. Valid for ggrs 0.13.
const INPUT_MESSAGE: u32 = 2;

impl<A: Clone + PartialEq + Eq + Hash + Debug + 'static> Watch<A> {
    /// Wraps a socket. Returns the socket for the session, and the watch that reads its messages.
    pub fn over<S: NonBlockingSocket<A>>(socket: S) -> (Watched<S, A>, Self) {
        let heard = Arc::new(Mutex::new(Vec::new()));
        let watch = Self {
            heard: Arc::clone(&heard),
            gone: Vec::new(),
            waited: 0,
        };
        (Watched { socket, heard }, watch)
    }

    /// Receives and sends messages, and returns the session's events.
    pub fn poll(
        &mut self,
        session: &mut P2PSession<ArenaSession<A>>,
    ) -> Vec<GgrsEvent<ArenaSession<A>>> {
        session.poll_remote_clients();
        let events: Vec<_> = session.events().collect();
        for event in &events {
            if let GgrsEvent::Disconnected { addr } = event {
                self.gone.push(addr.clone());
            }
        }
        events
    }

    /// The session's requests for [`Rollback::handle`](super::Rollback::handle). Add this peer's inputs first. A peer
    /// that is too far ahead of the others gets [`AdvanceError::Wait`].
    ///
    /// # Errors
    /// [`AdvanceError`]: the peer has to wait, the session has to end, or ggrs fails.
    pub fn advance(
        &mut self,
        session: &mut P2PSession<ArenaSession<A>>,
    ) -> Result<Vec<GgrsRequest<ArenaSession<A>>>, AdvanceError> {
        self.check(session)?;
        match session.advance_frame() {
            Ok(requests) => Ok(requests),
            Err(GgrsError::PredictionThreshold) => Err(AdvanceError::Wait),
            Err(error) => Err(AdvanceError::Ggrs(error)),
        }
    }

    /// Returns an error if the session would have to go back too far, or may soon have to.
    fn check(&mut self, session: &P2PSession<ArenaSession<A>>) -> Result<(), AdvanceError> {
        let heard = Arc::clone(&self.heard);
        let heard = heard.lock().unwrap_or_else(PoisonError::into_inner);
        let mut waits = None;
        for player in session.remote_player_handles() {
            let is_theirs = |peer: &A| session.handles_by_address(peer.clone()).contains(&player);
            let of = |players: &[(bool, Frame)]| players.get(player).copied();
            // All inputs of this player came from its own peer, whose messages also tell the last of its frames.
            let theirs = heard.iter().find(|(peer, ..)| is_theirs(peer));
            let Some((_, ours)) = theirs.and_then(|(.., players)| of(players)) else {
                continue;
            };
            let others = heard.iter().filter(|(peer, ..)| {
                let is_peer = !session.handles_by_address(peer.clone()).is_empty();
                is_peer && !self.gone.contains(peer) && !is_theirs(peer)
            });
            let others: Vec<_> = others.filter_map(|(.., players)| of(players)).collect();
            let Some(least) = others.iter().map(|(_, last)| *last).min() else {
                continue;
            };
            let is_said = others.iter().any(|(is_gone, _)| *is_gone);
            let is_gone = self.gone.iter().any(is_theirs);
            if least >= ours || !(is_said || is_gone) {
                continue;
            }
            // Here ggrs would go back, in each of its steps, to the first frame that one of the peers does not know.
            if is_said {
                return Err(AdvanceError::LeftBadly { player });
            }
            waits = Some(player);
        }
        let Some(player) = waits else {
            self.waited = 0;
            return Ok(());
        };
        self.waited += 1;
        if self.waited > LONGEST_WAIT {
            return Err(AdvanceError::LeftBadly { player });
        }
        Err(AdvanceError::Wait)
    }
}

impl<S: NonBlockingSocket<A>, A: Clone + PartialEq + Eq + Hash + Debug> NonBlockingSocket<A>
    for Watched<S, A>
{
    fn send_to(&mut self, message: &Message, to: &A) {
        self.socket.send_to(message, to);
    }

    fn receive_all_messages(&mut self) -> Vec<(A, Message)> {
        let messages = self.socket.receive_all_messages();
        let mut heard = self.heard.lock().unwrap_or_else(PoisonError::into_inner);
        for (from, message) in &messages {
            let has_room = heard.len() < MOST_PEERS;
            let Some((session, players)) = told(message) else {
                continue;
            };
            match heard.iter_mut().find(|(peer, ..)| peer == from) {
                // Messages arrive in any order. A player that has left does not return, and a peer's last known frame
                // does not decrease.
                Some((_, known, before)) if *known == session && before.len() == players.len() => {
                    for (known, told) in before.iter_mut().zip(players) {
                        *known = (known.0 || told.0, known.1.max(told.1));
                    }
                }
                Some(other) => (other.1, other.2) = (session, players),
                None if has_room => heard.push((from.clone(), session, players)),
                None => {}
            }
        }
        messages
    }
}

/// The connection states in a message; `None` if it is of another kind. ggrs keeps the fields of messages private, so
/// they are read from its serialised form.
fn told(message: &Message) -> Option<(u16, Vec<(bool, Frame)>)> {
    let bytes = postcard::to_stdvec(message).ok()?;
    // The number of the sender's session, and the kind of the message.
    let ((session, kind), rest) = postcard::take_from_bytes::<(u16, u32)>(&bytes).ok()?;
    if kind != INPUT_MESSAGE {
        return None;
    }
    let (players, _) = postcard::take_from_bytes(rest).ok()?;
    Some((session, players))
}
