//! Attacks from afar: waves, shots and beams. No person behind rock is struck, people that run get away, and the
//! strength of waves falls off as documented.

use std::sync::Arc;

use crate::attacks::{attacks, before, spot};
use crate::support::{TICK, brain_with, creature, kind, person, with_people};
use clamber_colossus::{
    Brain, Creature, CreatureConfig, CreatureEvent, CreatureKind, CreatureReport, Person,
    StrikeHit, Surroundings,
};
use clamber_world::{HalfSpace, Obstacle, TriangleTerrain};
use glam::DVec3;
use serde_json::{Value, json};

/// The act of an attack state of the giant with these additions. Its limb has no damage, no throw and no aim, unless
/// they are added.
pub(crate) fn act(state: &str, with: Value) -> Value {
    let (_, mut act) = attacks()
        .into_iter()
        .find(|(name, _)| name == state)
        .unwrap();
    let attack = act["attack"].as_object_mut().unwrap();
    attack.remove("damage");
    attack.remove("throw");
    attack.insert("aim".into(), 0.0.into());
    attack.extend(with.as_object().unwrap().clone());
    act
}

/// A vertical wall of two triangles that is solid from both sides. Its lower edge goes from `corner` along `along`.
pub(crate) fn wall(corner: DVec3, along: DVec3, height: f64) -> TriangleTerrain {
    let up = DVec3::Y * height;
    let places = [corner, corner + along, corner + along + up, corner + up];
    let places = places.map(|place| place.as_vec3());
    TriangleTerrain::new(&places, &[[0, 1, 2], [0, 2, 3]], &[], DVec3::ZERO).unwrap()
}

/// The blows and events of an attack.
#[derive(Debug, Default)]
pub(crate) struct Seen {
    /// Blows, with the number of ticks since the attack began.
    pub(crate) blows: Vec<(usize, StrikeHit)>,
    /// Events, with the number of ticks since the attack began.
    pub(crate) events: Vec<(usize, CreatureEvent)>,
}

impl Seen {
    /// The ids of the people of the blows, sorted.
    pub(crate) fn struck(&self) -> Vec<u64> {
        let mut struck: Vec<u64> = self.blows.iter().map(|(_, blow)| blow.person).collect();
        struck.sort_unstable();
        struck
    }

    /// The ticks and places at which waves began.
    pub(crate) fn waves(&self) -> Vec<(usize, DVec3)> {
        let all = self.events.iter().filter_map(|(tick, event)| match event {
            CreatureEvent::Wave { place, .. } => Some((*tick, *place)),
            _ => None,
        });
        all.collect()
    }

    /// The place of the first burst.
    pub(crate) fn burst(&self) -> Option<DVec3> {
        self.events.iter().find_map(|(_, event)| match event {
            CreatureEvent::Burst { place, .. } => Some(*place),
            _ => None,
        })
    }
}

/// Runs an attack on people among obstacles. Both are functions of the seconds since the attack began.
pub(crate) fn attack<'a>(
    before: &Creature,
    people: impl Fn(f64) -> Vec<Person>,
    terrain: impl Fn(f64) -> Vec<&'a dyn Obstacle>,
) -> Seen {
    attack_among(before, people, |since| [terrain(since), Vec::new()])
}

/// [`attack`] on level ground.
pub(crate) fn on_ground(before: &Creature, people: impl Fn(f64) -> Vec<Person>) -> Seen {
    let ground = HalfSpace::below(0.0);
    attack(before, people, |_| vec![&ground])
}

/// [`attack`] with two lists of obstacles: terrain and other creatures.
pub(crate) fn attack_among<'a>(
    before: &Creature,
    people: impl Fn(f64) -> Vec<Person>,
    obstacles: impl Fn(f64) -> [Vec<&'a dyn Obstacle>; 2],
) -> Seen {
    let mut giant = before.clone();
    let mut seen = Seen::default();
    let (mut begun, mut has_ended) = (None, false);
    let dt = giant.kind().brain().tick();
    for tick in 0.. {
        let since = begun.map_or(0.0, |begun| f64::from(tick - begun) * dt);
        let (people, [terrain, creatures]) = (people(since), obstacles(since));
        let around = Surroundings {
            terrain: &terrain,
            creatures: &creatures,
            people: &people,
            ..Surroundings::default()
        };
        let report = giant.step(&around).unwrap().clone();
        let ticks = begun.map_or(0, |begun| (tick - begun) as usize);
        seen.blows
            .extend(report.blows.iter().map(|blow| (ticks, *blow)));
        for event in report.events {
            if let CreatureEvent::Entered { to, .. } = &event {
                match giant.kind().brain().path(*to) {
                    "attacks" => begun = Some(tick),
                    "ends" => has_ended = true,
                    _ => {}
                }
            }
            seen.events.push((ticks, event));
        }
        // Shots and waves go on after the attack has ended. The burst of a shot counts as the end of the attack, too.
        has_ended |= seen.burst().is_some();
        if has_ended && giant.shots().next().is_none() && giant.waves().next().is_none() {
            return seen;
        }
        assert!(tick < 8_000, "the attack does not end");
    }
    seen
}

/// A person with an id.
pub(crate) fn somebody(id: u64, at: DVec3) -> Person {
    Person { id, ..person(at) }
}

/// A thousand random places within a radius around a place, each with a direction to run away from there.
pub(crate) fn places(around: DVec3, radius: f64, seed: u64) -> Vec<(DVec3, DVec3)> {
    let mut random = fastrand::Rng::with_seed(seed);
    let place = |_| {
        let angle = random.f64() * core::f64::consts::TAU;
        let away = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
        (around + away * (random.f64().sqrt() * radius), away)
    };
    (0..1000).map(place).collect()
}

/// People at these places, with ids from 0 on.
fn standing(all: &[(DVec3, DVec3)]) -> Vec<Person> {
    let all = (0..).zip(all);
    all.map(|(id, (at, _))| somebody(id, *at)).collect()
}

/// Counts the struck people among a thousand: if all stay, and if all run away from 0.30 s on at 3 m/s.
fn stay_and_run(before: &Creature, all: &[(DVec3, DVec3)]) -> [usize; 2] {
    [0.0, 3.0].map(|speed| {
        let people = |since: f64| {
            let ran = (since - 0.3).max(0.0) * speed;
            let all = (0..).zip(all);
            all.map(|(id, (at, away))| somebody(id, *at + *away * ran))
                .collect()
        };
        let seen = on_ground(before, people);
        let mut struck = seen.struck();
        let count = struck.len();
        struck.dedup();
        assert_eq!(struck.len(), count, "somebody was struck twice");
        count
    })
}

#[test]
fn waves_strike_who_stays_and_spare_who_runs() {
    for (what, wave) in [
        (
            "shock wave",
            json!({ "radius": 6.0, "speed": 8.0, "height": 0.5, "damage": 0.5, "throw": 9.0 }),
        ),
        (
            "tremor",
            json!({ "radius": 5.5, "height": 0.5, "damage": 0.5, "throw": 9.0 }),
        ),
    ] {
        for state in ["stomp_left", "stomp_right"] {
            let radius = wave["radius"].as_f64().unwrap();
            let act = act(state, json!({ "wave": wave.clone() }));
            let giant = before(&act);
            let spot = spot(&giant, &act).with_y(0.0);
            let [stay, run] = stay_and_run(&giant, &places(spot, radius, 1));
            println!(
                "{what} of {state}: of 1000 who stay {stay} are struck, of those who run {run}"
            );
            assert!(stay >= 950 && run <= 50, "{what} {state}: {stay} {run}");
        }
    }
}

#[test]
fn waves_fall_off_as_stated() {
    for speed in [None, Some(5.0), Some(12.0)] {
        let wave = json!({ "radius": 15.0, "speed": speed, "damage": 0.8, "throw": 9.0 });
        let giant = before(&act("stomp_right", json!({ "wave": wave })));
        let all = places(DVec3::new(-3.0, 0.0, 9.0), 20.0, 2);
        let seen = on_ground(&giant, |_| standing(&all));
        let (began, from) = seen.waves()[0];
        // The wave begins at the clip's marker, after 1.84 s of the giant's own time.
        assert!((began as f64 * TICK - 1.84).abs() < 3.0 * TICK, "{began}");
        let mut struck = 0;
        for (id, (at, _)) in (0..).zip(&all) {
            let level = (*at - from).with_y(0.0);
            // The wave begins at a height between the ends of the body's axis, 0.3 and 1.45 m.
            assert!((0.3..1.45).contains(&from.y));
            let distance = (level.length() - 0.3).max(0.0);
            let blow = seen.blows.iter().find(|(_, blow)| blow.person == id);
            let share = 1.0 - distance / 15.0;
            let Some((tick, blow)) = blow else {
                assert!(share <= 0.0, "{distance} m away");
                continue;
            };
            struck += 1;
            let wanted = DVec3::new(0.0, 9.0 * share, 0.0).length();
            assert!((blow.damage - 0.8 * share).abs() < 1e-12, "{blow:?}");
            assert!((blow.velocity.length() - wanted).abs() < 1e-9, "{blow:?}");
            if level.length() > 1e-3 {
                let direction = (level.normalize() + DVec3::Y).normalize();
                assert!(blow.velocity.normalize().dot(direction) > 1.0 - 1e-9);
            }
            // The blow comes in the tick in which the wave's front arrives.
            let after = (tick - began) as f64 * TICK;
            let due = speed.map_or(0.0, |speed| distance / speed);
            assert!(
                (-1e-9..=TICK + 1e-9).contains(&(after - due)),
                "{after} s, due {due} s"
            );
        }
        assert!(struck > 400, "{struck}");
    }
}

/// A wave along the ground spares a person that is in the air when its front arrives, or that stands high. A person
/// that comes down behind the front is spared, too.
#[test]
fn waves_along_the_ground_are_jumped_over() {
    let wave = json!({ "radius": 15.0, "speed": 6.0, "height": 0.5, "damage": 0.8, "throw": 9.0 });
    let giant = before(&act("stomp_right", json!({ "wave": wave })));
    let spot = DVec3::new(-4.0, 0.0, 8.0);
    let due = {
        let seen = on_ground(&giant, |_| vec![somebody(1, spot + DVec3::X * 10.0)]);
        assert_eq!(seen.blows.len(), 1);
        seen.blows[0].0 as f64 * TICK
    };
    for (what, from, to, high, hits) in [
        ("stands", 0.0, 0.0, 0.0, 1),
        ("jumps", due - 0.25, due + 0.25, 1.0, 0),
        ("jumps early", due - 0.8, due - 0.3, 1.0, 1),
        ("jumps late", due + 0.1, due + 0.5, 1.0, 1),
        ("hops", due - 0.25, due + 0.25, 0.4, 1),
        ("stands high", 0.0, 100.0, 3.0, 0),
    ] {
        let people = |since: f64| {
            let rise = if (from..to).contains(&since) {
                high
            } else {
                0.0
            };
            vec![somebody(1, spot + DVec3::X * 10.0 + DVec3::Y * rise)]
        };
        let seen = on_ground(&giant, people);
        assert_eq!(seen.blows.len(), hits, "who {what}");
    }
}

#[test]
fn nobody_is_struck_by_a_wave_behind_rock() {
    let ground = HalfSpace::below(0.0);
    for speed in [None, Some(8.0)] {
        let wave = json!({ "radius": 20.0, "speed": speed, "damage": 0.8, "throw": 9.0 });
        let act = act("stomp_right", json!({ "wave": wave }));
        let giant = before(&act);
        let spot = spot(&giant, &act).with_y(0.0);
        // A wall of 3 m height and 30 m width, 6 m ahead of the place where the foot comes down.
        let rock = wall(spot + DVec3::new(-15.0, 0.0, 6.0), DVec3::X * 30.0, 3.0);
        let all = places(spot, 18.0, 5);
        let people = |_| standing(&all);
        let open = on_ground(&giant, people);
        let behind = attack(&giant, people, |_| vec![&ground as &dyn Obstacle, &rock]);
        assert_eq!(open.blows.len(), 1000);
        let mut hidden = 0;
        for (id, (at, _)) in (0..).zip(&all) {
            let way = *at - spot;
            // The x at which the straight line to the person crosses the plane of the wall.
            let across = way.x * 6.0 / way.z;
            let is_behind = way.z > 6.3 && across.abs() < 14.0;
            let is_open = way.z < 5.4 || way.z > 6.3 && across.abs() > 16.0;
            let is_struck = behind.blows.iter().any(|(_, blow)| blow.person == id);
            assert!(!(is_behind && is_struck), "{at}");
            assert!(!is_open || is_struck, "{at}");
            hidden += usize::from(is_behind);
        }
        println!("of 1000 people {hidden} are behind rock, and none of them is struck");
        assert!(hidden > 100, "{hidden}");
    }
}

/// A shot from the giant's hand. If `wave`, it bursts into a wave.
fn shot(gravity: f64, wave: bool) -> Value {
    let wave = wave.then(|| json!({ "radius": 3.0, "damage": 0.5, "throw": 6.0 }));
    let mut shot =
        json!({ "speed": 25.0, "radius": 0.8, "gravity": gravity, "damage": 0.6, "throw": 10.0 });
    if let Some(wave) = wave {
        shot["wave"] = wave;
    }
    json!({ "shot": shot })
}

/// Random places in front of the giant, each with a direction to run: away from the giant or aside.
fn ahead(count: usize, seed: u64) -> Vec<(DVec3, DVec3)> {
    let mut random = fastrand::Rng::with_seed(seed);
    let place = |_| {
        let angle = (random.f64() - 0.5) * 1.6;
        let at = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
        let run = angle + (random.f64() - 0.5) * 4.0;
        let away = DVec3::new(libm::sin(run), 0.0, libm::cos(run));
        (at * (12.0 + 28.0 * random.f64()), away)
    };
    (0..count).map(place).collect()
}

/// Counts the people that are struck if each is attacked alone. A person runs at `speed` from `since` seconds on.
fn one_by_one(giant: &Creature, all: &[(DVec3, DVec3)], [since, speed]: [f64; 2]) -> usize {
    let struck = all.iter().map(|(at, away)| {
        let people = |time: f64| {
            let ran = (time - since).max(0.0) * speed;
            vec![somebody(1, *at + *away * ran)]
        };
        let seen = on_ground(giant, people);
        assert!(seen.blows.len() <= 1, "{at}: {:?}", seen.blows);
        seen.blows.len()
    });
    struck.sum()
}

#[test]
fn shots_and_beams_strike_who_stays_and_spare_who_runs() {
    let beam = json!({ "beam": { "length": 80.0, "radius": 0.4, "damage": 0.6, "throw": 10.0 } });
    for (what, with) in [
        ("stone", shot(9.81, false)),
        ("stone that bursts", shot(9.81, true)),
        ("bolt", shot(0.0, true)),
        ("beam", beam),
    ] {
        let giant = before(&act("swipe_right", with));
        let all = ahead(1000, 7);
        let stay = one_by_one(&giant, &all[..200], [0.0; 2]);
        let run = one_by_one(&giant, &all, [0.3, 3.0]);
        println!("{what}: of 200 who stay {stay} are struck, of 1000 who run {run}");
        assert!(stay >= 190 && run <= 50, "{what}: {stay} {run}");
    }
}

/// An attack that follows its prey at a speed does not strike a faster person. A beam strikes all slower ones.
#[test]
fn what_follows_strikes_who_is_slower() {
    let mut with = shot(0.0, false);
    with["follows"] = 4.0.into();
    let beam = json!({ "beam": { "length": 80.0, "radius": 0.4, "damage": 0.6, "throw": 10.0 }, "follows": 4.0 });
    for (what, with) in [("bolt", with), ("beam", beam)] {
        let giant = before(&act("swipe_right", with));
        // The people run aside.
        let all = ahead(60, 11).into_iter().map(|(at, _)| {
            let to = at.normalize();
            (at.normalize() * 20.0, DVec3::new(to.z, 0.0, -to.x))
        });
        let all: Vec<_> = all.collect();
        let slow = one_by_one(&giant, &all, [0.0, 3.0]);
        let fast = one_by_one(&giant, &all, [0.0, 7.0]);
        println!("{what}: of 60 who are slower {slow} are struck, of those who are faster {fast}");
        assert_eq!(fast, 0, "{what}");
        if what == "beam" {
            assert_eq!(slow, 60);
            // The beam overtakes a fast person that stops when it starts to shine.
            let (at, away) = all[0];
            let people = |time: f64| vec![somebody(1, at + away * (time.min(1.4) * 7.0))];
            let seen = on_ground(&giant, people);
            let since = seen.blows[0].0 as f64 * TICK;
            assert!((1.9..2.8).contains(&since), "{since} s");
        } else {
            // A bolt does not lead its target, so it misses a person that keeps running while it flies.
            assert_eq!(slow, 0);
        }
    }
}

#[test]
fn shots_and_beams_end_at_rock_and_at_other_creatures() {
    let ground = HalfSpace::below(0.0);
    let beam = json!({ "beam": { "length": 80.0, "radius": 0.4, "damage": 0.6, "throw": 10.0 } });
    let (mut high, mut struck) = (0, 0);
    for (what, with, is_creature) in [
        ("stone", shot(9.81, true), false),
        ("bolt", shot(0.0, true), false),
        ("beam", beam.clone(), false),
        ("stone", shot(9.81, false), true),
        ("beam", beam, true),
    ] {
        let giant = before(&act("swipe_right", with));
        for (at, _) in ahead(100, 13) {
            // Rock rises in front of the people after they were seen, beyond the reach of the hand.
            let to = at.normalize();
            let at = to * (25.0 + 0.4 * at.length());
            let aside = DVec3::new(to.z, 0.0, -to.x);
            let rock = wall(at - to * 4.0 - aside * 20.0, aside * 40.0, 40.0);
            let all = [0.0, 2.0, -1.0, -2.9, -3.6].map(|behind| at + to * behind);
            let people = |_| (0..).zip(all).map(|(id, at)| somebody(id, at)).collect();
            let obstacles = |time: f64| {
                let rock: &dyn Obstacle = &rock;
                let rock = if time > 0.2 { vec![rock] } else { Vec::new() };
                let ground: Vec<&dyn Obstacle> = vec![&ground];
                if is_creature {
                    [ground, rock]
                } else {
                    [[ground, rock].concat(), Vec::new()]
                }
            };
            let seen = attack_among(&giant, people, obstacles);
            let open = on_ground(&giant, people);
            struck += usize::from(!open.blows.is_empty());
            assert!(seen.blows.is_empty(), "{what} at {at}: {:?}", seen.blows);
            if let Some(place) = seen.burst() {
                // The burst is at the rock, or at the ground in front of it.
                let depth = place.dot(to) - (at - to * 4.0).dot(to);
                let is_high = place.y > 1e-3;
                assert!(
                    depth < 1e-4 && (!is_high || depth > -1e-4),
                    "{what}: {depth}"
                );
                high += usize::from(is_high);
            }
        }
        let rock = if is_creature {
            "another creature"
        } else {
            "rock"
        };
        println!("{what}: of 500 people behind {rock} none is struck");
    }
    assert!(high > 100, "{high}");
    // Without rock the people are struck.
    assert!(struck > 450, "{struck}");
}

/// The giant with a wave that spreads and a stone in the air, and two people ahead of it.
fn under_way() -> (Creature, [Person; 2]) {
    let mut with = shot(9.81, true);
    with["shot"]["speed"] = 20.0.into();
    with["shot"]["wave"]["speed"] = 2.0.into();
    let (swipe, stomp) = (
        act("swipe_right", with),
        act(
            "stomp_right",
            json!({ "wave": { "radius": 60.0, "speed": 3.0, "damage": 0.1, "throw": 1.0 } }),
        ),
    );
    let states = json!({
        "stomps": { "act": stomp, "transitions": [{ "to": "throws", "when": ["done"] }] },
        "throws": { "act": swipe, "transitions": [{ "to": "dozes", "on": "active", "interrupts": true }] },
        "dozes": { "act": "sleep" }
    });
    let kind = kind(&brain_with("stomps", &states.to_string()));
    let mut giant = creature(&kind, CreatureConfig::default());
    let people = [
        somebody(1, DVec3::new(3.0, 0.0, 30.0)),
        somebody(2, DVec3::new(3.5, 0.0, 31.8)),
    ];
    let ground = HalfSpace::below(0.0);
    while giant.shots().next().is_none() {
        step(&mut giant, &people, &ground);
    }
    step(&mut giant, &people, &ground);
    assert!(giant.waves().next().is_some());
    (giant, people)
}

fn step(giant: &mut Creature, people: &[Person], ground: &dyn Obstacle) -> CreatureReport {
    giant.step(&with_people(&[ground], people)).unwrap().clone()
}

/// A stone and a wave that are under way strike even if the giant sleeps, and are part of the saved state.
#[test]
fn what_is_under_way_is_saved_and_goes_on() {
    let ground = HalfSpace::below(0.0);
    let (mut giant, people) = under_way();
    let mut blows = Vec::new();
    for tick in 0..1300 {
        // A fresh creature with the saved state continues in the same way.
        let mut other = (tick % 30 == 0).then(|| {
            let text = serde_json::to_string(giant.state()).unwrap();
            let mut fresh = fresh_giant(giant.kind());
            fresh.restore(serde_json::from_str(&text).unwrap()).unwrap();
            fresh
        });
        if let Some(other) = &mut other {
            let mut same = giant.clone();
            for _ in 0..40 {
                let [one, two] = [&mut same, other].map(|giant| step(giant, &people, &ground));
                assert_eq!(one, two, "from tick {tick}");
            }
        }
        let report = step(&mut giant, &people, &ground);
        blows.extend(report.blows.iter().map(|blow| (blow.person, blow.damage)));
    }
    assert_eq!(giant.state().animator().layers()[0].speed, 0.0, "it sleeps");
    assert!(giant.shots().next().is_none() && giant.waves().next().is_none());
    // The stone strikes one person, the wave of its burst the other one, and the wave of the stomp both.
    let of = |id| blows.iter().filter(|(person, _)| *person == id).count();
    assert_eq!([of(1), of(2)], [2, 2], "{blows:?}");
}

fn fresh_giant(kind: &Arc<CreatureKind>) -> Creature {
    // The kind is built anew, so it checks a state that it did not make itself.
    let json = serde_json::to_string(kind.brain().file()).unwrap();
    creature(&crate::support::kind(&json), CreatureConfig::default())
}

#[test]
fn forged_shots_and_waves_are_refused() {
    let (giant, people) = under_way();
    let text = serde_json::to_value(giant.state()).unwrap();
    let mut fresh = fresh_giant(giant.kind());
    let mut restore = |change: &dyn Fn(&mut Value)| {
        let mut text = text.clone();
        change(&mut text["ranged"]);
        let state = serde_json::from_value(text).map_err(|error| error.to_string())?;
        fresh.restore(state).map_err(|error| error.to_string())?;
        // A state that is accepted can be stepped.
        for _ in 0..10 {
            step(&mut fresh, &people, &HalfSpace::below(0.0));
        }
        Ok::<_, String>(())
    };
    restore(&|_| ()).unwrap();
    let many = |list: &mut Value| {
        let one = list[0].clone();
        list.as_array_mut().unwrap().extend(vec![one; 70]);
    };
    let dozes = giant.kind().brain().find("dozes").unwrap().0;
    let changes: [&dyn Fn(&mut Value); 14] = [
        &|ranged| {
            let one = ranged["shots"][0].clone();
            ranged["shots"].as_array_mut().unwrap().push(one);
        },
        &|ranged| ranged["shots"][0]["state"] = 77.into(),
        &|ranged| ranged["shots"][0]["state"] = dozes.into(),
        &|ranged| ranged["shots"][0]["velocity"][1] = 1e9.into(),
        &|ranged| ranged["shots"][0]["place"][0] = 1e13.into(),
        &|ranged| ranged["shots"][0]["number"] = 5.into(),
        &|ranged| ranged["next_shot"] = u64::MAX.into(),
        &|ranged| many(&mut ranged["shots"]),
        &|ranged| many(&mut ranged["waves"]),
        &|ranged| ranged["waves"][0]["of"] = "Shot".into(),
        &|ranged| ranged["waves"][0]["place"][2] = 1e13.into(),
        &|ranged| ranged["waves"][0]["reach"] = (-1.0).into(),
        &|ranged| ranged["mark"][0] = 1e13.into(),
        &|ranged| ranged["beam"] = json!({ "from": [0.0, 0.0, 0.0], "direction": [0.0, 0.0, 2.0] }),
    ];
    for (index, change) in changes.iter().enumerate() {
        let error = restore(*change).unwrap_err();
        assert!(error.contains("attacks have let out"), "{index}: {error}");
    }
    // Shots and waves past their end are accepted: they end in the next step.
    restore(&|ranged| ranged["waves"][0]["reach"] = 1e9.into()).unwrap();
    restore(&|ranged| ranged["shots"][0]["ticks"] = u32::MAX.into()).unwrap();
    assert_eq!((fresh.shots().count(), fresh.waves().count()), (0, 1));
}

/// Another brain takes over the shots and waves of the attacks that it still has.
#[test]
fn another_brain_takes_over_what_it_knows() {
    let (giant, _) = under_way();
    let mut file = serde_json::to_value(giant.kind().brain().file()).unwrap();
    file["states"]["aaa"] = json!({ "final": true });
    let other = kind(&file.to_string());
    let kept = giant.state().carry_over(giant.kind(), &other).unwrap();
    let mut same = creature(&other, CreatureConfig::default());
    same.restore(kept).unwrap();
    let all = |giant: &Creature| {
        let shots = giant
            .shots()
            .map(|shot| (giant.kind().brain().path(shot.state).to_owned(), shot.place));
        let waves = giant
            .waves()
            .map(|wave| (giant.kind().brain().path(wave.state).to_owned(), wave.place));
        shots.chain(waves).collect::<Vec<_>>()
    };
    assert_eq!(all(&same), all(&giant));
    assert_eq!(all(&giant).len(), 2);
    file["states"]["throws"]["act"]["attack"]["shot"].take();
    file["states"]["throws"]["act"]["attack"]["damage"] = 0.5.into();
    let other = kind(&file.to_string());
    let kept = giant.state().carry_over(giant.kind(), &other).unwrap();
    same = creature(&other, CreatureConfig::default());
    same.restore(kept).unwrap();
    assert_eq!((same.shots().count(), same.waves().count()), (0, 1));
}

#[test]
fn attacks_out_of_range_are_refused() {
    let wave = json!({ "radius": 5.0, "damage": 0.1, "throw": 1.0 });
    let shot = json!({ "radius": 0.5, "speed": 20.0, "damage": 0.1, "throw": 1.0 });
    let beam = json!({ "radius": 0.5, "length": 20.0, "damage": 0.1, "throw": 1.0 });
    for (what, file) in [("wave", &wave), ("shot", &shot), ("beam", &beam)] {
        let with = |key: &str, value: Value| {
            let mut file = file.clone();
            file[key] = value;
            let act = act("stomp_right", json!({ what: file }));
            let states = json!({ "attacks": { "act": act } });
            Brain::from_json(&brain_with("attacks", &states.to_string()), TICK)
        };
        with("damage", 0.2.into()).unwrap();
        let mut wrong = vec![
            ("damage", 1.5),
            ("damage", -0.1),
            ("throw", -1.0),
            ("throw", 1e7),
            ("radius", -1.0),
            ("colour", 1.0),
        ];
        match what {
            "wave" => wrong.extend([
                ("radius", 0.0),
                ("speed", 0.0),
                ("speed", -1.0),
                ("height", -1.0),
            ]),
            "shot" => wrong.extend([
                ("speed", 0.0),
                ("speed", 1001.0),
                ("gravity", -1.0),
                ("gravity", 1001.0),
                ("lasts", 0.0),
                ("lasts", 61.0),
            ]),
            _ => wrong.extend([("length", 0.0), ("length", 1e7)]),
        }
        for (key, value) in wrong {
            let error = with(key, value.into()).unwrap_err().to_string();
            let name = if key == "colour" {
                key.to_owned()
            } else {
                format!("`{what}.{key}`")
            };
            assert!(error.contains(&name), "{what} {key} {value}: {error}");
        }
    }
    let refused = |with: Value, needs: &str| {
        let states = json!({ "attacks": { "act": act("stomp_right", with) } });
        let error =
            Brain::from_json(&brain_with("attacks", &states.to_string()), TICK).unwrap_err();
        assert!(error.to_string().contains(needs), "{error}");
    };
    let mut bursts = shot.clone();
    bursts["wave"] = json!({ "radius": 5.0, "damage": 1.5, "throw": 1.0 });
    refused(json!({ "shot": bursts }), "`shot.wave.damage`");
    refused(json!({}), "needs `damage`");
    refused(json!({ "limb": [], "wave": wave.clone() }), "`limb`");
    refused(json!({ "wave": wave.clone(), "follows": 1.0 }), "`follows`");
    refused(
        json!({ "shot": shot.clone(), "follows": -1.0 }),
        "`follows`",
    );
    refused(json!({ "wave": wave, "aim": -1.0 }), "`aim`");
}

/// A thrown stone strikes the nearest of several people at the hand, in any order of their ids.
#[test]
fn a_stone_strikes_the_nearest_of_those_at_the_hand() {
    let giant = before(&act("swipe_right", shot(9.81, false)));
    let prey = DVec3::new(0.0, 0.0, 30.0);
    let begin = |near: Option<DVec3>, swaps: bool| {
        on_ground(&giant, |since| {
            let mut people = vec![somebody(9, prey)];
            if let Some(hand) = near.filter(|_| since > 0.5) {
                let at = |aside: f64| hand + DVec3::new(aside, -0.875, 0.0);
                let ids = if swaps { [1, 5] } else { [5, 1] };
                people.extend([somebody(ids[0], at(0.1)), somebody(ids[1], at(1.0))]);
            }
            people
        })
    };
    let hand = begin(None, false)
        .events
        .iter()
        .find_map(|(_, event)| match event {
            CreatureEvent::Threw { place, .. } => Some(*place),
            _ => None,
        });
    for swaps in [false, true] {
        let seen = begin(hand, swaps);
        assert_eq!(seen.struck(), [if swaps { 1 } else { 5 }]);
    }
}
