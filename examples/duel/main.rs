//! Two climbers against one giant, by rollback: two peers in one process over a bad line, or two processes over a
//! network.
//!
//! With `--joins 10`, a third climber joins after ten seconds. A ggrs session that has begun takes no new players. So
//! all peers end their session at the tick before, the new peer gets the arena's state of that tick, and all begin a
//! new session.
//!
//! Peers send each other only their players' inputs, thirteen bytes a tick. Each peer predicts inputs that have not
//! arrived, rolls back when a prediction was wrong, and repeats the ticks. At the end, both peers have the same fight,
//! tick by tick, and each has reported every event once.
//!
//! `cargo run --release --features ggrs --example duel` runs both peers. For two processes, on one machine or two:
//!
//! ```sh
//! cargo run --release --features ggrs --example duel -- --player 0 --port 7000 --peer 127.0.0.1:7001
//! cargo run --release --features ggrs --example duel -- --player 1 --port 7001 --peer 127.0.0.1:7000
//! ```

mod line;
mod peer;

use std::error::Error;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

use clamber::colossus::CreatureKind;
use clamber::fight::{Arena, ArenaConfig};
use clamber_scenes::duel::{Duel, RATE};
use clamber_scenes::measure::exit_code;
use clap::Parser;
use line::Line;
use peer::Peer;

/// Two climbers fight one giant over a network, by rollback.
#[derive(Debug, Parser)]
#[command(name = "duel", version)]
struct Options {
    /// Plays only this climber; the other process plays the other one. Without this option, this process plays both.
    #[arg(long, value_name = "0|1", requires = "peer")]
    #[arg(value_parser = clap::value_parser!(u8).range(0..2))]
    player: Option<u8>,

    /// Address of the other process, in numbers. This process waits for the other one.
    #[arg(long, value_name = "ADDRESS:PORT", requires = "player")]
    peer: Option<SocketAddr>,

    /// Port to listen at.
    #[arg(long, default_value_t = 7000)]
    port: u16,

    /// Length of the fight.
    #[arg(long, value_name = "SECONDS", default_value_t = 30)]
    #[arg(value_parser = clap::value_parser!(u64).range(1..=3600))]
    seconds: u64,

    /// Round-trip time of a message, its variation, and the share of lost messages, in a fight in one process.
    #[arg(long, value_name = "MILLISECONDS", default_value_t = 100.0)]
    round_trip: f64,
    #[arg(long, value_name = "MILLISECONDS", default_value_t = 20.0)]
    jitter: f64,
    #[arg(long, value_name = "PERCENT", default_value_t = 5.0)]
    lost: f64,

    /// A third climber joins after this time, in a fight in one process.
    #[arg(long, value_name = "SECONDS", conflicts_with = "player")]
    #[arg(value_parser = clap::value_parser!(u64).range(1..=3600))]
    joins: Option<u64>,

    /// Record the fight to a file for Foxglove, Rerun and the replay example; needs --features record.
    #[arg(long, value_name = "FILE.mcap")]
    record: Option<PathBuf>,
}

fn main() -> ExitCode {
    let options = Options::parse();
    let ended = match (options.player, options.peer) {
        (Some(player), Some(address)) => over_network(&options, player.into(), address),
        _ => in_one_process(&options),
    };
    exit_code(ended.map_err(|error| format!("duel: {error}").into()))
}

/// Runs all peers in this process, over a line that delays and loses messages, as fast as possible.
fn in_one_process(options: &Options) -> Result<(), Box<dyn Error>> {
    let lines = Line::ends(options.round_trip, options.jitter, options.lost)?;
    let kind = Duel::kind()?;
    let ticks = options.seconds * RATE;
    let joins = match options.joins {
        Some(seconds) if seconds >= options.seconds => {
            return Err("nobody can join after the end: --joins is less than --seconds".into());
        }
        joins => joins.map(|seconds| seconds * RATE),
    };
    let of = |number: usize, all: usize| -> Vec<Option<usize>> {
        (0..all).map(|one| (one != number).then_some(one)).collect()
    };
    let mut peers = Vec::new();
    for (number, line) in lines.iter().enumerate().take(2) {
        let fight = Duel::new(&kind)?;
        peers.push(Peer::new(line.clone(), &of(number, 2), fight, joins)?);
    }
    if let Some(tick) = joins {
        play(&mut peers, &lines[0], tick - 1)?;
        let saved = peers[0].saved().to_vec();
        lines[0].clear();
        for (number, peer) in peers.iter_mut().enumerate() {
            peer.begin_again(lines[number].clone(), &of(number, 3), &saved)?;
        }
        // An arena that knows the giant, and nobody in it yet: its state comes from the others.
        let mut fight = Duel::new(&kind)?;
        fight.arena = Arena::new(ArenaConfig::default())?;
        fight.arena.add_kind(Arc::clone(&kind))?;
        let mut newcomer = Peer::new(lines[2].clone(), &of(2, 3), fight, joins)?;
        newcomer.begin_again(lines[2].clone(), &of(2, 3), &saved)?;
        peers.push(newcomer);
    }
    play(&mut peers, &lines[0], ticks)?;
    for (number, peer) in peers.iter().enumerate() {
        println!("peer {number}: {}", peer.report());
    }
    // The peer that joined has only the ticks after that.
    let from = joins.map_or(0, |tick| tick - 1);
    let (mut same, mut told) = (true, true);
    for (number, peer) in peers.iter().enumerate() {
        let from = if number < 2 { 0 } else { from };
        let after = |sums: Vec<(u64, u64)>| -> Vec<_> {
            sums.into_iter().filter(|(tick, _)| *tick > from).collect()
        };
        same &= after(peer.sums_until(ticks)) == after(peers[0].sums_until(ticks));
        let mut theirs = peers[0].told_before(ticks);
        theirs.retain(|(tick, _)| *tick > from);
        told &= peer.told_before(ticks) == theirs;
    }
    println!(
        "{ticks} ticks: {}, {}",
        if same {
            "the same checksums"
        } else {
            "OTHER CHECKSUMS"
        },
        if told {
            "the same events, each once"
        } else {
            "OTHER EVENTS"
        },
    );
    if !(same && told) {
        return Err("the peers have different fights".into());
    }
    record(options, &kind, &peers[0], ticks)
}

/// Plays until all peers have confirmed a number of ticks.
fn play(peers: &mut [Peer<usize>], line: &Line, ticks: u64) -> Result<(), Box<dyn Error>> {
    while peers.iter().any(|peer| peer.confirmed() < ticks) {
        for peer in peers.iter_mut() {
            peer.tick(ticks)?;
        }
        line.wait(1000.0 / RATE as f64);
        // Until all sessions run, ggrs sends lost messages again by real time.
        if !peers.iter().all(Peer::is_running) {
            std::thread::sleep(Duration::from_millis(2));
        }
    }
    Ok(())
}

/// Records a peer's fight if the options ask for it. All inputs are confirmed by then.
#[cfg(feature = "record")]
fn record<A: peer::Address>(
    options: &Options,
    kind: &Arc<CreatureKind>,
    peer: &Peer<A>,
    ticks: u64,
) -> Result<(), Box<dyn Error>> {
    let Some(path) = &options.record else {
        return Ok(());
    };
    let sum = clamber_scenes::duel::record(kind, peer.steps_until(ticks), path)?;
    if peer.sums_until(ticks).last().map(|(_, sum)| *sum) != Some(sum) {
        return Err("the recorded fight is another one than the peer's".into());
    }
    println!("recorded to {}, with the same checksum", path.display());
    Ok(())
}

#[cfg(not(feature = "record"))]
fn record<A: peer::Address>(
    options: &Options,
    _: &Arc<CreatureKind>,
    _: &Peer<A>,
    _: u64,
) -> Result<(), Box<dyn Error>> {
    match options.record {
        Some(_) => Err("built without recording: add `,record` to the features".into()),
        None => Ok(()),
    }
}

/// Runs one peer in real time.
fn over_network(
    options: &Options,
    player: usize,
    address: SocketAddr,
) -> Result<(), Box<dyn Error>> {
    let socket = clamber::fight::rollback::ggrs::UdpNonBlockingSocket::bind_to_port(options.port)
        .map_err(|error| format!("cannot listen at port {}: {error}", options.port))?;
    let ticks = options.seconds * RATE;
    let mut players = [Some(address); 2];
    players[player] = None;
    let kind = Duel::kind()?;
    let mut peer = Peer::new(socket, &players, Duel::new(&kind)?, None)?;
    println!("waits for {address}");
    let (mut due, mut shown) = (Instant::now(), 0);
    while peer.confirmed() < ticks {
        peer.tick(ticks)?;
        let second = peer.confirmed() / RATE;
        if second > shown {
            shown = second;
            println!("{second:4} s: {}", peer.report());
        }
        due += Duration::from_secs_f64(1.0 / RATE as f64);
        std::thread::sleep(due.saturating_duration_since(Instant::now()));
    }
    // The other peer may still wait for the last inputs of this one.
    for _ in 0..RATE {
        peer.tick(ticks)?;
        std::thread::sleep(Duration::from_millis(16));
    }
    let sum = peer.sums_until(ticks).last().map_or(0, |(_, sum)| *sum);
    println!("{ticks} ticks, checksum {sum:016x}: the other process has to print the same");
    record(options, &kind, &peer, ticks)
}
