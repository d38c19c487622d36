use super::*;

/// Tick rates, Hz.
const RATES: [f64; 4] = [30.0, 60.0, 64.0, 240.0];

/// Runs ticks at 64 Hz with poses at the given intervals, seconds. A pose comes after the ticks before it. Returns for
/// each tick the step of the seen time, in ticks, and the motion.
fn run(intervals: impl IntoIterator<Item = f64>) -> Vec<(f64, PoseMotion)> {
    /// Length of a tick, seconds.
    const TICK: f64 = 1.0 / 64.0;
    let mut clock = PoseClock::default();
    let (mut now, mut next) = (0.0, TICK);
    let mut ticks = Vec::new();
    clock.record(0.0).unwrap();
    for interval in intervals {
        now += interval;
        while next <= now {
            let before = clock.time();
            let motion = clock.tick(next, TICK).unwrap();
            ticks.push(((clock.time() - before) / TICK, motion));
            next += TICK;
        }
        clock.record(now).unwrap();
    }
    ticks
}

fn random(count: usize, low: f64, high: f64) -> Vec<f64> {
    let mut random = fastrand::Rng::with_seed(7);
    let length = |_| (low + (high - low) * random.f64()) / 1000.0;
    (0..count).map(length).collect()
}

fn jumps(ticks: &[(f64, PoseMotion)]) -> usize {
    let placed = |(_, motion): &&(f64, PoseMotion)| *motion == PoseMotion::Teleported;
    ticks.iter().filter(placed).count()
}

#[test]
fn with_jitter_time_passes_evenly_after_the_first_poses() {
    for (low, high) in [
        (15.7, 17.7),
        (10.0, 23.0),
        (3.0, 9.0),
        (30.0, 45.0),
        (16.0, 16.0),
    ] {
        let ticks = run(random(2000, low, high));
        assert_eq!(jumps(&ticks[100..]), 0, "{low} to {high} ms");
        for (moved, _) in &ticks[100..] {
            assert!((moved - 1.0).abs() <= 0.01, "{low} to {high} ms: {moved}");
        }
    }
}

#[test]
fn a_long_interval_is_jumped_and_does_not_change_the_lag() {
    for hitch in [50.0, 250.0, 2000.0] {
        let mut intervals = random(400, 16.0, 17.0);
        intervals[200] = hitch / 1000.0;
        let ticks = run(intervals);
        let jumps = jumps(&ticks[100..]);
        // A jump for each tick in the long interval, and one for the first tick after it.
        let most = hitch / 15.625 + 3.0;
        assert!(
            jumps > 0 && (jumps as f64) < most,
            "{hitch} ms: {jumps} jumps"
        );
        for (moved, motion) in &ticks[100..] {
            assert!(
                *motion == PoseMotion::Teleported || (moved - 1.0).abs() <= 0.01,
                "{hitch} ms: {moved}"
            );
        }
    }
}

#[test]
fn longer_intervals_are_followed() {
    let mut intervals = random(100, 16.0, 17.0);
    intervals.extend(random(300, 33.0, 34.0));
    intervals.extend(random(300, 5.0, 6.0));
    let jumps = jumps(&run(intervals)[90..]);
    assert!((2..8).contains(&jumps), "{jumps}");
}

/// Poses in every `every`-th tick, each `late` ticks after its time; the clock starts at `start`.
fn regular(rate: f64, every: u32, late: u32, start: f64) -> (PoseClock, Vec<PoseMotion>) {
    let (mut clock, mut ticks) = (PoseClock::default(), Vec::new());
    for tick in 0..200 {
        let time = |tick: u32| start + f64::from(tick) / rate;
        if tick >= late && (tick - late).is_multiple_of(every) {
            clock.record(time(tick - late)).unwrap();
        }
        ticks.push(clock.tick(time(tick), 1.0 / rate).unwrap());
    }
    (clock, ticks)
}

#[test]
fn with_regular_poses_the_lag_is_one_interval_or_how_late_they_come() {
    for rate in RATES {
        for every in [1, 2, 3, 4, 7] {
            for late in [0, 1, 2, 5] {
                for start in [0.0, -3.0, 7.5, 1e5] {
                    let case = format!("{rate} Hz, {every}, {late} late, from {start}");
                    let (clock, ticks) = regular(rate, every, late, start);
                    let lag = f64::from(every.max(every + late - 1)) / rate;
                    assert!((clock.lag() - lag).abs() < 1e-9, "{case}: {}", clock.lag());
                    // The interval is not known until the second pose has come.
                    let first = (every + late + u32::from(late == 0)) as usize;
                    for (tick, motion) in ticks.iter().enumerate() {
                        let moved = *motion == PoseMotion::Moved;
                        assert_eq!(moved, tick >= first, "{case}: tick {tick}");
                    }
                }
            }
        }
    }
}

#[test]
fn bad_times_change_nothing() {
    let mut clock = PoseClock::default();
    clock.record(1.0).unwrap();
    clock.tick(1.0, 0.1).unwrap();
    let before = clock.clone();
    for time in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let not_finite = |found| matches!(found, Err(RigError::NotFinite { .. }));
        assert!(not_finite(clock.record(time)), "{time}");
        assert!(not_finite(clock.restart(time)), "{time}");
        assert!(not_finite(clock.tick(time, 0.1).map(|_| ())), "{time}");
        assert!(not_finite(clock.tick(1.1, time).map(|_| ())), "{time}");
    }
    let back = RigError::TimeGoesBack {
        what: "the pose's time",
        time: 0.5,
        last: 1.0,
    };
    assert_eq!(clock.record(0.5), Err(back));
    assert!(matches!(
        clock.tick(1.1, -0.1),
        Err(RigError::TimeGoesBack { .. })
    ));
    assert_eq!(clock, before);
}

#[test]
fn the_largest_times_do_not_panic() {
    let mut clock = PoseClock::default();
    for time in [f64::MIN, -1.0, 0.0, 1e-300, f64::MAX] {
        clock.record(time).unwrap();
        for now in [f64::MIN, 0.0, f64::MAX] {
            clock.tick(now, 1.0).unwrap();
        }
    }
}
