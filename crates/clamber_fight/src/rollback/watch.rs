//! Leaving: what peers know of somebody who is gone, before ggrs goes back to it.

use std::fmt::Debug;
use std::hash::Hash;
use std::sync::{Arc, Mutex, PoisonError};

use ggrs::{Frame, GgrsError, GgrsEvent, GgrsRequest, Message, NonBlockingSocket, P2PSession};
use thiserror::Error;

use super::ArenaSession;

/// Watches a session of ggrs for somebody who leaves badly.
///
/// Of three and more peers each may have heard another part of what somebody sent who is gone. All then go back to the
/// first tick that one of them does not know. ggrs 0.13 does so in each of its steps again, and panics once that tick is
/// out of its window. A watch knows it before: it listens to what peers tell each other about who is there.
///
/// Use [`Watch::poll`] and [`Watch::advance`] in place of the session's own `poll_remote_clients`, `events` and
/// `advance_frame`, and give the session the socket of [`Watch::over`].
#[derive(Debug)]
pub struct Watch<A> {
    heard: Arc<Mutex<Heard<A>>>,
    /// Who is gone, as far as this peer knows by itself.
    gone: Vec<A>,
    /// Calls for which this peer has waited for what others know of somebody who is gone.
    waited: u32,
}

/// A socket that a [`Watch`] listens to.
#[derive(Debug)]
pub struct Watched<S, A> {
    socket: S,
    heard: Arc<Mutex<Heard<A>>>,
}

/// What each peer has told last, with the number of its session: of each player, whether it is gone, and the last of its
/// frames that the peer has.
type Heard<A> = Vec<(A, u16, Vec<(bool, Frame)>)>;

/// No more peers are listened to: anybody may send something.
const MOST_PEERS: usize = 64;

/// Why there are no requests.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AdvanceError {
    /// This peer waits until the others say what they know of somebody who is gone: poll again in the next tick, and tell
    /// nothing as certain meanwhile.
    #[error("this peer waits for the others")]
    Wait,
    /// Somebody has left, and another peer knows less of its inputs than this one. This session is at its end.
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

/// A peer waits for no more calls until the others say what they know of somebody who is gone: ten seconds of a game.
const LONGEST: u32 = 600;

/// The message of ggrs that holds inputs, by its place in their list, in which the state of all players comes first.
const INPUT: u32 = 2;

impl<A: Clone + PartialEq + Eq + Hash + Debug + 'static> Watch<A> {
    /// A watch over a socket, and the socket for the session.
    pub fn over<S: NonBlockingSocket<A>>(socket: S) -> (Watched<S, A>, Self) {
        let heard = Arc::new(Mutex::new(Vec::new()));
        let watch = Self {
            heard: Arc::clone(&heard),
            gone: Vec::new(),
            waited: 0,
        };
        (Watched { socket, heard }, watch)
    }

    /// Receives and sends messages, and gives the session's events.
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

    /// What the session asks for, for [`Rollback::handle`](super::Rollback::handle). Add this peer's inputs before. A peer
    /// that is too far ahead of the others is asked for no step.
    ///
    /// # Errors
    /// [`AdvanceError`].
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

    /// Refuses to go on if the session would have to go back too far, or may have to soon.
    fn check(&mut self, session: &P2PSession<ArenaSession<A>>) -> Result<(), AdvanceError> {
        let heard = Arc::clone(&self.heard);
        let heard = heard.lock().unwrap_or_else(PoisonError::into_inner);
        let mut waits = None;
        for player in session.remote_player_handles() {
            let is_theirs = |peer: &A| session.handles_by_address(peer.clone()).contains(&player);
            let of = |players: &[(bool, Frame)]| players.get(player).copied();
            // Whoever has gone sent all that this peer has of it, and told up to where.
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
            // ggrs would go back to the first frame that one of them does not know, in each of its steps again.
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
        if self.waited > LONGEST {
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
                // They come in any order: nobody comes back, and nobody knows less than before.
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

/// What a message tells of all players; `None` if it is of another kind. ggrs shows messages only as what they are
/// serialised to.
fn told(message: &Message) -> Option<(u16, Vec<(bool, Frame)>)> {
    let bytes = postcard::to_stdvec(message).ok()?;
    // The session's number, and which message it is.
    let ((session, kind), rest) = postcard::take_from_bytes::<(u16, u32)>(&bytes).ok()?;
    if kind != INPUT {
        return None;
    }
    let (players, _) = postcard::take_from_bytes(rest).ok()?;
    Some((session, players))
}
