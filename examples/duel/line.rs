//! A simulated network line between peers in one process, which delays messages and loses some.

use std::cell::RefCell;
use std::rc::Rc;

use clamber::fight::rollback::ggrs::{Message, NonBlockingSocket};

/// A message under way: its arrival time, milliseconds; its receiver; its sender.
type UnderWay = (f64, usize, usize, Message);

struct Shared {
    now: f64,
    under_way: Vec<UnderWay>,
    random: fastrand::Rng,
    /// Mean time of a message one way, and its largest variation, milliseconds.
    takes: [f64; 2],
    /// Share of the messages that are lost, from 0 to 1.
    lost: f64,
}

/// One end of the line.
#[derive(Clone)]
pub(crate) struct Line {
    shared: Rc<RefCell<Shared>>,
    ours: usize,
}

impl Line {
    /// The three ends of a line. `round_trip` and `jitter` are in milliseconds, `lost` is in percent.
    pub(crate) fn ends(round_trip: f64, jitter: f64, lost: f64) -> Result<[Self; 3], String> {
        let is_time = |x: f64| (0.0..=1000.0).contains(&x);
        if !(is_time(round_trip) && is_time(jitter) && (0.0..=50.0).contains(&lost)) {
            return Err("a line takes from 0 to 1000 ms and loses from 0 to 50 %".to_owned());
        }
        let shared = Rc::new(RefCell::new(Shared {
            now: 0.0,
            under_way: Vec::new(),
            random: fastrand::Rng::with_seed(1),
            takes: [0.5 * round_trip, 0.5 * jitter],
            lost: lost / 100.0,
        }));
        Ok([0, 1, 2].map(|ours| Self {
            shared: Rc::clone(&shared),
            ours,
        }))
    }

    /// Lets time pass, milliseconds.
    pub(crate) fn wait(&self, milliseconds: f64) {
        self.shared.borrow_mut().now += milliseconds;
    }
}

impl Line {
    /// Drops all messages under way, for the beginning of a new session.
    pub(crate) fn clear(&self) {
        self.shared.borrow_mut().under_way.clear();
    }
}

impl NonBlockingSocket<usize> for Line {
    fn send_to(&mut self, message: &Message, to: &usize) {
        let mut shared = self.shared.borrow_mut();
        if shared.random.f64() < shared.lost {
            return;
        }
        let [takes, more] = shared.takes;
        let takes = takes + more * (2.0 * shared.random.f64() - 1.0);
        let arrives = shared.now + takes.max(0.0);
        shared
            .under_way
            .push((arrives, *to, self.ours, message.clone()));
    }

    fn receive_all_messages(&mut self) -> Vec<(usize, Message)> {
        let mut shared = self.shared.borrow_mut();
        let now = shared.now;
        let (mut here, rest): (Vec<_>, Vec<_>) = std::mem::take(&mut shared.under_way)
            .into_iter()
            .partition(|one| one.1 == self.ours && one.0 <= now);
        shared.under_way = rest;
        here.sort_by(|a, b| a.0.total_cmp(&b.0));
        here.into_iter()
            .map(|(_, _, from, message)| (from, message))
            .collect()
    }
}
