//! Rollback by ggrs: every tick is played again with the same checksum, and peers over a bad connection have the same
//! fight. Scenes B53 and B55.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use crate::support::{Melee, giant, level_ground};
use clamber_colossus::Noise;
use clamber_fight::rollback::ggrs::{
    DesyncDetection, GgrsError, GgrsEvent, GgrsRequest, Message, NonBlockingSocket, P2PSession,
    PlayerType, SessionBuilder, SessionState,
};
use clamber_fight::rollback::{AdvanceError, ArenaSession, Rollback, Watch};
use clamber_fight::{ArenaEvent, Order, PlayerInput};

type Session = ArenaSession<usize>;

/// Length of the fights, ticks: 78 s at 60 ticks a second.
const TICKS: u64 = 60 * 78;

/// Ticks that are played beyond the last compared one. They confirm its inputs, and play it again where a prediction
/// was wrong.
const BEYOND: u64 = 20;

fn input(tick: u64, player: usize) -> PlayerInput {
    let asks = tick + 11 * player as u64;
    PlayerInput {
        // Orders come in two consecutive ticks, so that predictions, which have no order, are often wrong.
        order: if asks % 37 < 2 {
            1 + (asks / 37 % 4) as u16
        } else {
            0
        },
        ..PlayerInput::from_input(&Melee::inputs(tick)[player])
    }
}

/// The game's orders for the players' requests.
fn orders(arena: &clamber_fight::Arena, asked: &[u16]) -> Vec<Order> {
    let fighters = arena.fighters().iter().zip(asked);
    let orders = fighters.filter_map(|(fighter, asked)| {
        let place = fighter.climber().state().position;
        let fighter = fighter.id();
        match asked {
            1 => Some(Order::Heal {
                fighter,
                hit_points: 0.01,
                stamina: 0.3,
            }),
            2 => Some(Order::Hurt {
                fighter,
                damage: 0.01,
            }),
            3 => Some(Order::Noise(Noise {
                place,
                loudness: 0.1,
            })),
            4 => Some(Order::AddArrows { fighter, arrows: 1 }),
            _ => None,
        }
    });
    orders.collect()
}

#[test]
fn every_tick_of_the_fight_is_the_same_when_it_is_played_again() {
    let mut melee = Melee::new(&giant());
    let mut session = SessionBuilder::<Session>::new()
        .with_num_players(3)
        .unwrap()
        .with_max_prediction_window(8)
        .with_check_distance(7)
        .start_synctest_session()
        .unwrap();
    let mut rollback = Rollback::new(&melee.arena);
    let (mut saved, mut loaded) = (0, 0);
    for tick in 0..TICKS {
        for player in 0..3 {
            session
                .add_local_input(player, input(tick, player))
                .unwrap();
        }
        // The session compares each checksum with the first one of its tick.
        for request in session.advance_frame().unwrap() {
            let saves = match &request {
                GgrsRequest::SaveGameState { cell, .. } => Some(cell.clone()),
                _ => None,
            };
            let saves = saves.map(|cell| (cell, melee.arena.fingerprint()));
            loaded += u64::from(matches!(request, GgrsRequest::LoadGameState { .. }));
            let handled = rollback.handle(&mut melee.arena, vec![request], melee_step);
            handled.unwrap();
            if let Some((cell, sum)) = saves {
                // The saved cell contains the checksum, which is the state's fingerprint.
                saved += 1;
                assert!(
                    format!("{cell:?}").contains(&format!("checksum: Some({sum})")),
                    "{cell:?}"
                );
                assert_eq!(cell.data().unwrap().fingerprint(), sum);
            }
        }
    }
    assert!(
        saved > 7 * (TICKS - 10) && loaded > TICKS - 10,
        "{saved} {loaded}"
    );
}

fn melee_step(
    arena: &mut clamber_fight::Arena,
    inputs: &[clamber_climber::ClimberInput],
    asked: &[u16],
) -> Result<(), clamber_fight::ArenaError> {
    let terrain = level_ground();
    let orders = orders(arena, asked);
    let rules = clamber_climber::StepRules::default();
    arena.step_with(inputs, &orders, &terrain, &rules).map(drop)
}

/// A message in transit: time of arrival in milliseconds, receiver, sender, and the message.
type UnderWay = (f64, usize, usize, Message);

/// A connection between peers that delays messages and loses some.
#[derive(Clone)]
struct Line {
    now: Rc<RefCell<f64>>,
    under_way: Rc<RefCell<Vec<UnderWay>>>,
    random: Rc<RefCell<fastrand::Rng>>,
    ours: usize,
}

/// Delay of a message one way, milliseconds.
const ONE_WAY: f64 = 50.0;
/// Greatest deviation from [`ONE_WAY`] in both directions, milliseconds.
const JITTER: f64 = 10.0;
/// Share of the messages that are lost.
const LOST: f64 = 0.05;

impl NonBlockingSocket<usize> for Line {
    fn send_to(&mut self, message: &Message, to: &usize) {
        let mut random = self.random.borrow_mut();
        if random.f64() < LOST {
            return;
        }
        let takes = ONE_WAY + JITTER * (2.0 * random.f64() - 1.0);
        let arrives = *self.now.borrow() + takes;
        self.under_way
            .borrow_mut()
            .push((arrives, *to, self.ours, message.clone()));
    }

    fn receive_all_messages(&mut self) -> Vec<(usize, Message)> {
        let (now, mut under_way) = (*self.now.borrow(), self.under_way.borrow_mut());
        let arrived = |one: &UnderWay| one.1 == self.ours && one.0 <= now;
        let (mut here, rest): (Vec<_>, Vec<_>) = under_way.drain(..).partition(arrived);
        *under_way = rest;
        here.sort_by(|a, b| a.0.total_cmp(&b.0));
        here.into_iter()
            .map(|(_, _, from, message)| (from, message))
            .collect()
    }
}

struct Peer {
    session: P2PSession<Session>,
    melee: Melee,
    rollback: Rollback,
    /// The last checksum of each tick.
    sums: BTreeMap<i32, u64>,
    events: Vec<(u64, ArenaEvent)>,
    /// Greatest number of ticks that were played again at once. `rollbacks` counts how often that happened.
    longest: u32,
    rollbacks: u32,
    waits: u32,
}

/// Input delay of the sessions, ticks.
const DELAY: u64 = 2;

impl Peer {
    fn new(line: &Line, ours: usize, melee: Melee) -> Self {
        let mut builder = SessionBuilder::<Session>::new()
            .with_num_players(3)
            .unwrap()
            .with_max_prediction_window(8)
            .with_input_delay(DELAY as usize)
            .with_desync_detection_mode(DesyncDetection::On { interval: 10 });
        // The first peer plays the third fighter, too.
        for player in 0..3 {
            let owner = player % 2;
            let kind = if owner == ours {
                PlayerType::Local
            } else {
                PlayerType::Remote(owner)
            };
            builder = builder.add_player(kind, player).unwrap();
        }
        let line = Line {
            ours,
            ..line.clone()
        };
        Self {
            session: builder.start_p2p_session(line).unwrap(),
            rollback: Rollback::new(&melee.arena),
            melee,
            sums: BTreeMap::new(),
            events: Vec::new(),
            longest: 0,
            rollbacks: 0,
            waits: 0,
        }
    }

    fn step(&mut self) {
        self.session.poll_remote_clients();
        for event in self.session.events() {
            let is_bad = matches!(
                event,
                GgrsEvent::DesyncDetected { .. } | GgrsEvent::Disconnected { .. }
            );
            assert!(!is_bad, "{event:?}");
        }
        if self.session.current_state() != SessionState::Running
            || self.session.current_frame() as u64 >= TICKS + BEYOND
        {
            return;
        }
        let tick = self.session.current_frame() as u64;
        for player in self.session.local_player_handles() {
            self.session
                .add_local_input(player, input(tick, player))
                .unwrap();
        }
        let requests = match self.session.advance_frame() {
            Err(GgrsError::PredictionThreshold) => {
                self.waits += 1;
                return;
            }
            requests => requests.unwrap(),
        };
        let mut steps = 0;
        for request in &requests {
            steps += u32::from(matches!(request, GgrsRequest::AdvanceFrame { .. }));
            self.rollbacks += u32::from(matches!(request, GgrsRequest::LoadGameState { .. }));
        }
        self.longest = self.longest.max(u32::saturating_sub(steps, 1));
        let sums = &mut self.sums;
        self.rollback
            .handle(&mut self.melee.arena, requests, |arena, inputs, asked| {
                melee_step(arena, inputs, asked)?;
                sums.insert(arena.tick() as i32, arena.fingerprint());
                Ok(())
            })
            .unwrap();
        let confirmed = self.session.confirmed_frame();
        self.events.extend(self.rollback.confirmed(confirmed));
    }
}

#[test]
fn two_peers_over_a_bad_line_have_the_same_fight_and_its_events_once() {
    let line = Line {
        now: Rc::default(),
        under_way: Rc::default(),
        random: Rc::new(RefCell::new(fastrand::Rng::with_seed(55))),
        ours: 0,
    };
    let kind = giant();
    let mut peers = [0, 1].map(|ours| Peer::new(&line, ours, Melee::new(&kind)));
    let began = std::time::Instant::now();
    let is_done = |peers: &[Peer; 2]| {
        peers.iter().all(|peer| {
            peer.session.confirmed_frame() as u64 >= TICKS - 1
                && peer.session.current_frame() as u64 >= TICKS + BEYOND
        })
    };
    while !is_done(&peers) {
        for peer in &mut peers {
            peer.step();
        }
        *line.now.borrow_mut() += 1000.0 / 60.0;
        // While peers synchronise, ggrs waits in real time before it repeats a lost message. So this loop takes real
        // time as well.
        if peers
            .iter()
            .any(|peer| peer.session.current_state() != SessionState::Running)
        {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        assert!(began.elapsed().as_secs() < 300, "the peers do not get on");
    }
    // The same fight on one machine alone.
    let mut alone = Melee::new(&kind);
    let mut events = Vec::new();
    let mut sums = BTreeMap::new();
    for tick in 0..TICKS {
        let of = |player: usize| match tick.checked_sub(DELAY) {
            Some(tick) => input(tick, player),
            None => PlayerInput::default(),
        };
        let inputs = [0, 1, 2].map(|player| of(player).to_input());
        let asked = [0, 1, 2].map(|player| of(player).order);
        melee_step(&mut alone.arena, &inputs, &asked).unwrap();
        let tick = alone.arena.tick();
        sums.insert(tick as i32, alone.arena.fingerprint());
        events.extend(
            alone
                .arena
                .events()
                .iter()
                .map(|event| (tick, event.clone())),
        );
    }
    for peer in &peers {
        println!(
            "{} rollbacks, of up to {} ticks, {} waits",
            peer.rollbacks, peer.longest, peer.waits
        );
        assert!(
            peer.rollbacks > 500 && peer.longest >= 3,
            "the line is too good"
        );
        let ours: BTreeMap<i32, u64> = peer
            .sums
            .range(..=TICKS as i32)
            .map(|(tick, sum)| (*tick, *sum))
            .collect();
        assert!(ours == sums, "ticks differ");
        // The events of the last tick need not be confirmed yet.
        let known: Vec<_> = events.iter().filter(|(tick, _)| *tick < TICKS).collect();
        let told: Vec<_> = peer
            .events
            .iter()
            .filter(|(tick, _)| *tick < TICKS)
            .collect();
        assert!(told == known, "{} events for {}", told.len(), known.len());
    }
}

/// A peer leaves two others after its last packets have reached only one of them. If the others know nearly the same
/// inputs of it, they go on and have the same fight. If not, the peer that knows more is told that the session has to
/// end, and nothing panics.
#[test]
fn three_peers_of_whom_one_leaves_badly_go_on_or_are_told() {
    // The delay of packets in ticks; the ticks for which the third peer reaches only the first one before it leaves;
    // and whether the others can go on.
    for (lag, cut, goes_on) in [
        (1, 0, true),
        (3, 0, true),
        (6, 0, true),
        (2, 1, false),
        (4, 8, false),
        (2, 20, false),
        (1, 40, false),
    ] {
        let mut peers = Peers::new(lag);
        while !peers.all(|peer| peer.confirmed() >= 60) {
            peers.tick(3);
        }
        peers.net.borrow_mut().cut = cut > 0;
        for _ in 0..cut {
            peers.tick(3);
        }
        let began = std::time::Instant::now();
        let end = peers.sides[0].session.current_frame() as u64 + 120;
        let is_over = |side: &Side| side.left.is_some() || side.confirmed() >= end;
        while !peers.sides[..2].iter().all(is_over) && began.elapsed().as_secs() < 5 {
            if !goes_on && peers.sides[0].left.is_some() {
                break;
            }
            peers.tick(2);
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        let [a, b] = [0, 1].map(|side| &peers.sides[side]);
        let what = format!("lag {lag}, cut {cut}: {:?} {:?}", a.left, b.left);
        if !goes_on {
            // The first peer knows more inputs and cannot go back. The second one waits for it.
            assert_eq!(a.left, Some(2), "{what}");
            continue;
        }
        assert!(a.confirmed() >= end && b.confirmed() >= end, "{what}");
        assert!(!a.differs && !b.differs, "{what}: they differ");
        for (tick, sum) in a.sums.iter().filter(|(tick, _)| **tick <= end) {
            assert_eq!(b.sums.get(tick), Some(sum), "{what}: tick {tick}");
        }
        let told = |side: &Side| {
            let all = side.told.iter().filter(|(tick, _)| *tick <= end - 20);
            all.cloned().collect::<Vec<_>>()
        };
        assert!(told(a) == told(b), "{what}: other events");
    }
}

/// Peers in one process whose packets are delayed by some ticks.
struct Peers {
    net: Rc<RefCell<Net>>,
    sides: Vec<Side>,
}

#[derive(Default)]
struct Net {
    tick: u64,
    lag: u64,
    cut: bool,
    under_way: Vec<(u64, usize, usize, Message)>,
}

struct End(Rc<RefCell<Net>>, usize);

impl NonBlockingSocket<usize> for End {
    fn send_to(&mut self, message: &Message, to: &usize) {
        let mut net = self.0.borrow_mut();
        if net.cut && (self.1, *to) == (2, 1) {
            return;
        }
        let arrives = net.tick + net.lag;
        net.under_way.push((arrives, *to, self.1, message.clone()));
    }

    fn receive_all_messages(&mut self) -> Vec<(usize, Message)> {
        let mut net = self.0.borrow_mut();
        let (tick, ours) = (net.tick, self.1);
        let arrived = |one: &(u64, usize, usize, Message)| one.1 == ours && one.0 <= tick;
        let (here, rest): (Vec<_>, Vec<_>) = net.under_way.drain(..).partition(arrived);
        net.under_way = rest;
        here.into_iter()
            .map(|(_, _, from, message)| (from, message))
            .collect()
    }
}

struct Side {
    session: P2PSession<Session>,
    watch: Watch<usize>,
    /// The player that has left badly.
    left: Option<usize>,
    /// True if ggrs has detected a desync.
    differs: bool,
    arena: clamber_fight::Arena,
    rollback: Rollback,
    sums: BTreeMap<u64, u64>,
    told: Vec<(u64, ArenaEvent)>,
}

impl Peers {
    fn new(lag: u64) -> Self {
        let net = Rc::new(RefCell::new(Net {
            lag,
            ..Net::default()
        }));
        let timeout = std::time::Duration::from_millis;
        let sides = (0..3).map(|ours| {
            let mut builder = SessionBuilder::<Session>::new()
                .with_num_players(3)
                .unwrap()
                .with_max_prediction_window(12)
                .with_input_delay(DELAY as usize)
                .with_disconnect_timeout(timeout(300 + 60 * ours as u64))
                .with_disconnect_notify_delay(timeout(150))
                .with_desync_detection_mode(DesyncDetection::On { interval: 10 });
            for player in 0..3 {
                let kind = if player == ours {
                    PlayerType::Local
                } else {
                    PlayerType::Remote(player)
                };
                builder = builder.add_player(kind, player).unwrap();
            }
            let config = clamber_fight::ArenaConfig::default();
            let mut arena = clamber_fight::Arena::new(config).unwrap();
            for number in 0..3 {
                let place = glam::DVec3::new(4.0 * f64::from(number), 1.0, 0.0);
                let hero = clamber_fight::FighterConfig::hero();
                arena.add_fighter(hero, place).unwrap();
            }
            let (socket, watch) = Watch::over(End(net.clone(), ours));
            Side {
                session: builder.start_p2p_session(socket).unwrap(),
                watch,
                left: None,
                differs: false,
                rollback: Rollback::new(&arena),
                arena,
                sums: BTreeMap::new(),
                told: Vec::new(),
            }
        });
        Self {
            sides: sides.collect(),
            net,
        }
    }

    fn all(&self, is: impl Fn(&Side) -> bool) -> bool {
        self.sides.iter().all(is)
    }

    /// One tick of the first `count` peers.
    fn tick(&mut self, count: usize) {
        self.net.borrow_mut().tick += 1;
        for side in &mut self.sides[..count] {
            side.tick();
        }
        if !self.all(|side| side.session.current_state() == SessionState::Running) {
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
    }
}

impl Side {
    fn confirmed(&self) -> u64 {
        u64::try_from(self.session.confirmed_frame()).unwrap_or(0)
    }

    fn tick(&mut self) {
        for event in self.watch.poll(&mut self.session) {
            self.differs |= matches!(event, GgrsEvent::DesyncDetected { .. });
        }
        if self.left.is_some() || self.session.current_state() != SessionState::Running {
            return;
        }
        let tick = self.session.current_frame() as u64;
        for player in self.session.local_player_handles() {
            // The player walks back and forth, jumps, and throws stones in a random sequence, so that predictions are
            // wrong.
            let lot = fastrand::Rng::with_seed(tick * 3 + player as u64).u64(..);
            let input = clamber_climber::ClimberInput {
                walk: glam::DVec3::X * if lot & 1 == 0 { 1.0 } else { -1.0 },
                jump: lot.is_multiple_of(5),
                actions: if lot.is_multiple_of(7) {
                    clamber_fight::actions::THROW
                } else {
                    0
                },
                aim: glam::DVec3::new(0.0, 0.3, 1.0),
                ..clamber_climber::ClimberInput::IDLE
            };
            let input = PlayerInput::from_input(&input);
            self.session.add_local_input(player, input).unwrap();
        }
        let requests = match self.watch.advance(&mut self.session) {
            Err(AdvanceError::Wait) => return,
            Err(AdvanceError::LeftBadly { player }) => {
                self.left = Some(player);
                return;
            }
            requests => requests.unwrap(),
        };
        let sums = &mut self.sums;
        self.rollback
            .handle(&mut self.arena, requests, |arena, inputs, asked| {
                melee_step(arena, inputs, asked)?;
                sums.insert(arena.tick(), arena.fingerprint());
                Ok(())
            })
            .unwrap();
        let confirmed = self.session.confirmed_frame();
        self.told.extend(self.rollback.confirmed(confirmed));
    }
}
