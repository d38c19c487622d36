//! Two climbers against one giant, by rollback: two peers in one process over a bad line, or two processes over a
//! network.
//!
//! Both peers send each other only their players' inputs, thirteen bytes a tick. Each guesses what has not arrived, goes
//! back when a guess was wrong, and plays again. At the end both have the same fight, tick by tick, and have told of
//! everything once.
//!
//! `cargo run --release --features ggrs --example duel` plays both. For two processes, on one machine or two:
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
use clamber_scenes::duel::{Duel, RATE};
use clap::Parser;
use line::Line;
use peer::Peer;

/// Two climbers fight one giant over a network, by rollback.
#[derive(Debug, Parser)]
#[command(name = "duel", version)]
struct Options {
    /// Plays this climber alone; the other process plays the other one. Both are played here without it.
    #[arg(long, value_name = "0|1", requires = "peer")]
    #[arg(value_parser = clap::value_parser!(u8).range(0..2))]
    player: Option<u8>,

    /// Address of the other process, in numbers; this one waits until the other is there.
    #[arg(long, value_name = "ADDRESS:PORT", requires = "player")]
    peer: Option<SocketAddr>,

    /// Port to listen at.
    #[arg(long, default_value_t = 7000)]
    port: u16,

    /// Length of the fight.
    #[arg(long, value_name = "SECONDS", default_value_t = 30)]
    #[arg(value_parser = clap::value_parser!(u64).range(1..=3600))]
    seconds: u64,

    /// Time of a message there and back, by how much it varies, and the share that gets lost, in a fight in one
    /// process.
    #[arg(long, value_name = "MILLISECONDS", default_value_t = 100.0)]
    round_trip: f64,
    #[arg(long, value_name = "MILLISECONDS", default_value_t = 20.0)]
    jitter: f64,
    #[arg(long, value_name = "PERCENT", default_value_t = 5.0)]
    lost: f64,

    /// Record the fight to a file for Foxglove, Rerun and the replay example; needs --features record.
    #[arg(long, value_name = "FILE.mcap")]
    record: Option<PathBuf>,
}

fn main() -> ExitCode {
    let options = Options::parse();
    let result = match (options.player, options.peer) {
        (Some(player), Some(address)) => over_network(&options, player.into(), address),
        _ => in_one_process(&options),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("duel: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Both peers, over a line that delays and loses messages, as fast as they can.
fn in_one_process(options: &Options) -> Result<(), Box<dyn Error>> {
    let lines = Line::pair(options.round_trip, options.jitter, options.lost)?;
    let kind = Duel::kind()?;
    let ticks = options.seconds * RATE;
    let [mut one, mut other] = {
        let [a, b] = lines.clone();
        [
            Peer::new(a, [None, Some(1)], Duel::new(&kind)?)?,
            Peer::new(b, [Some(0), None], Duel::new(&kind)?)?,
        ]
    };
    while one.confirmed() < ticks || other.confirmed() < ticks {
        for peer in [&mut one, &mut other] {
            peer.tick(ticks)?;
        }
        lines[0].wait(1000.0 / RATE as f64);
        // Until both know each other, lost messages are sent again by the clock.
        if !(one.is_running() && other.is_running()) {
            std::thread::sleep(Duration::from_millis(2));
        }
    }
    for (number, peer) in [&one, &other].into_iter().enumerate() {
        println!("peer {number}: {}", peer.report());
    }
    let same = one.sums_until(ticks) == other.sums_until(ticks);
    let told = one.told_before(ticks) == other.told_before(ticks);
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
    record(options, &kind, &one, ticks)
}

/// Records a peer's fight if that was asked for, now that all inputs are certain.
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
    let sum = clamber_scenes::duel::record(kind, peer.inputs_until(ticks), path)?;
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

/// One peer in real time.
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
    let mut peer = Peer::new(socket, players, Duel::new(&kind)?)?;
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
    // The other one may still wait for our last inputs.
    for _ in 0..RATE {
        peer.tick(ticks)?;
        std::thread::sleep(Duration::from_millis(16));
    }
    let sum = peer.sums_until(ticks).last().map_or(0, |(_, sum)| *sum);
    println!("{ticks} ticks, checksum {sum:016x}: the other process has to print the same");
    record(options, &kind, &peer, ticks)
}
