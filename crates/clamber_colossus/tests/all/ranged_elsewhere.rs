//! Attacks from afar in the cases that `ranged` leaves out: other rates and sizes, moving and steep ground, clips with
//! other markers, riders, no prey, and saves in the middle of an attack.

use crate::attacks::{before, before_at};
use crate::carried::{Deck, plate};
use crate::ranged::{act, attack, attack_among, on_ground, places, somebody, wall};
use crate::support::{TICK, with_people};
use clamber_colossus::{Creature, CreatureConfig, CreatureEvent, Person, Riding, Surroundings};
use clamber_surface::geometry::{Affine, Similarity, rotation_from_axis_angle};
use clamber_surface::mesh::TriangleId;
use clamber_surface::rig::Palette;
use clamber_world::{HalfSpace, MaterialPoint, Obstacle, TriangleTerrain};
use glam::{DVec3, Vec3};
use serde_json::{Value, json};

/// A wave, a shot and a beam that reach every person in these tests.
fn all_ways() -> [(&'static str, &'static str, Value); 3] {
    let blow = |mut way: Value| {
        (way["damage"], way["throw"]) = (0.5.into(), 5.0.into());
        way
    };
    [
        (
            "stomp_right",
            "wave",
            blow(json!({ "radius": 40.0, "speed": 8.0 })),
        ),
        (
            "swipe_right",
            "shot",
            blow(json!({ "speed": 25.0, "radius": 0.8 })),
        ),
        (
            "swipe_right",
            "beam",
            blow(json!({ "length": 90.0, "radius": 0.4 })),
        ),
    ]
}

#[test]
fn riders_are_spared() {
    for (state, way, file) in all_ways() {
        let giant = before(&act(state, json!({ way: file })));
        let at = Riding {
            at: MaterialPoint::on_triangle(TriangleId(0), [1.0, 0.0, 0.0]),
            hangs: false,
        };
        // The rider has the same body as the other person, which the giant sees.
        let people = |_| {
            let other = somebody(2, DVec3::new(2.0, 0.0, 20.0));
            let rider = Person {
                id: 1,
                riding: Some(at),
                ..other
            };
            vec![rider, other]
        };
        let seen = on_ground(&giant, people);
        assert_eq!(seen.struck(), [2], "{way}");
    }
}

#[test]
fn other_rates_strike_the_same_people() {
    for (state, way, file) in all_ways() {
        let told = [30.0, 60.0, 144.0].map(|rate| {
            let act = act(state, json!({ way: file.clone() }));
            let giant = before_at(&act, 1.0 / rate, CreatureConfig::default());
            let people = |_| {
                let all = (0..12u32).map(|id| {
                    let at = DVec3::new(
                        2.0 * f64::from(id % 4) - 3.0,
                        0.0,
                        12.0 + 2.0 * f64::from(id),
                    );
                    somebody(id.into(), at)
                });
                all.collect()
            };
            let seen = on_ground(&giant, people);
            let struck = seen.struck();
            let mut blows = seen.blows;
            blows.sort_by_key(|(_, blow)| blow.person);
            let when: Vec<f64> = blows.iter().map(|(tick, _)| *tick as f64 / rate).collect();
            (struck, when)
        });
        assert!(!told[0].0.is_empty(), "{way}");
        for (struck, when) in &told[1..] {
            assert_eq!(struck, &told[0].0, "{way}");
            for (a, b) in when.iter().zip(&told[0].1) {
                assert!((a - b).abs() < 0.1, "{way}: {a} {b}");
            }
        }
    }
}

/// A beam that turns fast strikes all people that it passes between two ticks.
#[test]
fn a_beam_that_turns_strikes_all_it_passes() {
    let beam = json!({ "length": 90.0, "radius": 0.1, "damage": 0.1, "throw": 1.0 });
    let with = json!({ "beam": beam, "follows": 60.0 });
    for rate in [30.0, 60.0] {
        let giant = before_at(
            &act("swipe_right", with.clone()),
            1.0 / rate,
            CreatureConfig::default(),
        );
        // The prey is in the air, at the height of the hand, and moves aside. Many people with tall bodies stand far
        // behind it.
        let people = |time: f64| {
            let aside = ((time - 1.6).max(0.0) * 40.0).min(24.0);
            let prey = somebody(1000, DVec3::new(-12.0 + aside, 9.0, 24.0));
            let all = (0..200u32).map(|id| {
                let angle = (f64::from(id) - 100.0) * 0.01;
                let way = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle)) * 70.0;
                let tall = somebody(id.into(), way);
                let mut body = tall.body;
                (body.ends[0].y, body.ends[1].y) = (-60.0, 60.0);
                Person { body, ..tall }
            });
            all.chain([prey]).collect()
        };
        let seen = attack(&giant, people, |_| Vec::new());
        let mut struck = seen.struck();
        struck.retain(|id| *id < 1000);
        let (first, last) = (struck[0], struck[struck.len() - 1]);
        assert!(last - first > 60, "{rate} Hz: {first} to {last}");
        let all: Vec<u64> = (first..=last).collect();
        assert_eq!(struck, all, "{rate} Hz");
    }
}

/// Waves begin above the ground below the limb, at any size of the giant and on any slope.
#[test]
fn waves_begin_on_the_ground_at_every_size_and_on_slopes() {
    for scale in [0.05, 1.0, 10.0] {
        for degrees in [-20.0f64, 0.0, 20.0, 40.0] {
            let slope = degrees.to_radians();
            let normal = DVec3::new(0.0, libm::cos(slope), -libm::sin(slope));
            let ground = HalfSpace::behind(DVec3::ZERO, normal).unwrap();
            for state in ["stomp_right", "kick_left", "swipe_right", "sweep_right"] {
                let wave = json!({ "radius": 15.0, "height": 0.5, "damage": 0.5, "throw": 5.0 });
                let config = CreatureConfig {
                    scale,
                    ..CreatureConfig::default()
                };
                let giant = before_at(&act(state, json!({ "wave": wave })), TICK, config);
                let what = format!("{state} at {scale} on {degrees} degrees");
                let begins = |people: &dyn Fn(f64) -> Vec<Person>| {
                    let seen = attack(&giant, people, |_| vec![&ground]);
                    let waves = seen.waves();
                    assert_eq!(waves.len(), 1, "{what}");
                    (waves[0].1, seen.blows.len())
                };
                let (from, _) = begins(&|_| Vec::new());
                let height = from.dot(normal) / normal.y;
                let least = if state.starts_with('s') && state != "stomp_right" {
                    0.3
                } else {
                    0.4
                };
                let most = if state == "stomp_right" {
                    0.51
                } else {
                    f64::INFINITY
                };
                assert!(
                    (least..=most).contains(&height),
                    "{what}: {height} m above it"
                );
                if state != "stomp_right" {
                    continue;
                }
                // All people around the place are struck.
                let all = places(DVec3::ZERO, 10.0, 3);
                let people = |_| {
                    let all = (0..).zip(&all).take(200);
                    let place = |way: DVec3| {
                        let at = from + way;
                        at - DVec3::Y * (at.dot(normal) / normal.y)
                    };
                    all.map(|(id, (way, _))| somebody(id, place(*way)))
                        .collect()
                };
                let (_, struck) = begins(&people);
                assert_eq!(struck, 200, "{what}");
            }
        }
    }
}

/// A wave starts at the first marker `impact` of the clip, even after `recovery`. Without that marker it starts at
/// `recovery`.
#[test]
fn waves_go_out_at_their_marker() {
    for (state, seconds) in [
        ("stomp_right", 1.84),
        ("kick_right", 3.4),
        ("swipe_right", 2.93),
    ] {
        let wave = json!({ "radius": 9.0, "damage": 0.5, "throw": 5.0 });
        let giant = before(&act(state, json!({ "wave": wave })));
        let seen = on_ground(&giant, |_| Vec::new());
        let waves = seen.waves();
        assert_eq!(waves.len(), 1, "{state}");
        let time = waves[0].0 as f64 * TICK;
        assert!((time - seconds).abs() < 0.06, "{state}: {time} s");
    }
}

/// Without prey in view, the giant throws at the ground ahead, even if it saw a person before. A creature that is put
/// elsewhere throws ahead of its new place.
#[test]
fn without_prey_it_throws_ahead() {
    let ground = HalfSpace::below(0.0);
    let shot = json!({ "speed": 60.0, "radius": 0.5, "gravity": 0.0, "damage": 0.5, "throw": 5.0 });
    let giant = before(&act("swipe_right", json!({ "shot": shot, "follows": 2.0 })));
    let ahead = DVec3::Z * giant.height();
    let alone = on_ground(&giant, |_| Vec::new()).burst().unwrap();
    assert!(alone.distance(ahead) < 0.01, "{alone} {ahead}");
    // A person that was seen, and is behind the giant now, is not a target.
    let mut later = giant.clone();
    for tick in 0..50 {
        let z = if tick < 20 { 30.0 } else { -30.0 };
        step(
            &mut later,
            &[somebody(1, DVec3::new(3.0, 0.0, z))],
            &[&ground],
        );
    }
    let people = |_| vec![somebody(1, DVec3::new(3.0, 0.0, -30.0))];
    let behind = on_ground(&later, people).burst().unwrap();
    assert!(behind.distance(ahead) < 0.01, "{behind} {ahead}");
    // The giant is put elsewhere in the wind-up of its attack.
    let mut put = giant.clone();
    let people = [somebody(1, DVec3::new(3.0, 0.0, 30.0))];
    for _ in 0..100 {
        step(&mut put, &people, &[&ground]);
    }
    assert!(put.attack().is_some());
    let there = DVec3::new(1000.0, 0.0, 0.0);
    put.put(there, 0.0).unwrap();
    let mut place = None;
    for _ in 0..300 {
        let report = step(&mut put, &[], &[&ground]);
        place = place.or(report.into_iter().find_map(|event| match event {
            CreatureEvent::Burst { place, .. } => Some(place),
            _ => None,
        }));
    }
    assert!(place.unwrap().distance(there + ahead) < 0.01, "{place:?}");
}

fn step(giant: &mut Creature, people: &[Person], terrain: &[&dyn Obstacle]) -> Vec<CreatureEvent> {
    giant
        .step(&with_people(terrain, people))
        .unwrap()
        .events
        .clone()
}

/// On a ship that sails and turns, the waves of limbs and the aimed places move with the deck. Shots and the waves of
/// their bursts do not.
#[test]
fn on_a_ship_waves_go_with_it_and_stones_fly_straight() {
    let with = json!({
        "wave": { "radius": 60.0, "speed": 2.0, "damage": 0.1, "throw": 1.0 },
        "shot": { "speed": 20.0, "radius": 0.5, "gravity": 0.0, "lasts": 30.0, "damage": 0.1, "throw": 1.0,
            "wave": { "radius": 7.0, "speed": 0.5, "damage": 0.1, "throw": 1.0 } }
    });
    let mut giant = before(&act("stomp_right", with));
    let at = |tick: u32| {
        let time = f64::from(tick) * TICK;
        Similarity {
            rotation: rotation_from_axis_angle(DVec3::Y, 0.1 * time),
            translation: DVec3::new(2.0, 0.0, 1.0) * time,
            ..Similarity::IDENTITY
        }
    };
    let (mut begun, mut shot): (Option<DVec3>, Option<(DVec3, DVec3)>) = (None, None);
    let (mut carried, mut flew, mut stayed) = (0, 0, 0);
    let mut burst: Option<DVec3> = None;
    for tick in 1..=400 {
        let deck = Deck {
            before: at(tick - 1),
            now: at(tick),
        };
        step(&mut giant, &[], &[&deck]);
        // The stone bursts before the foot comes down.
        let (of_burst, of_limb) = giant
            .waves()
            .partition::<Vec<_>, _>(|wave| wave.radius < 10.0);
        if let Some(wave) = of_burst.first() {
            assert_eq!(*burst.get_or_insert(wave.place), wave.place);
            stayed += 1;
        }
        if let Some(wave) = of_limb.first() {
            let there = at(tick).inverse_transform_point(wave.place);
            let first = *begun.get_or_insert(there);
            assert!(there.distance(first) < 1e-6, "{there} {first}");
            carried += 1;
        }
        if let Some(now) = giant.shots().next() {
            let (place, velocity) = shot.unwrap_or((now.place, now.velocity));
            assert!(now.place.distance(place) < 1e-9 && now.velocity == velocity);
            shot = Some((now.place + now.velocity * TICK, velocity));
            flew += 1;
        }
    }
    let told = format!("{carried} {flew} {stayed}");
    assert!(carried > 100 && flew > 20 && stayed > 100, "{told}");
}

/// Whenever an attack is saved, a fresh creature continues with the same bits.
#[test]
fn an_attack_is_saved_at_any_time() {
    let ground = HalfSpace::below(0.0);
    let mut with = json!({ "follows": 2.5 });
    for (_, way, file) in all_ways() {
        with[way] = file;
    }
    let before = before(&act("stomp_right", with));
    let mut giant = before.clone();
    let person = |tick: u32| {
        let angle = 0.01 * f64::from(tick);
        [somebody(1, DVec3::new(8.0 * libm::sin(angle), 0.0, 26.0))]
    };
    let around = |people: &[Person], giant: &mut Creature| {
        giant
            .step(&with_people(&[&ground], people))
            .unwrap()
            .clone()
    };
    let mut ways = [0; 3];
    for tick in 0..330u32 {
        if tick % 5 == 0 {
            let text = serde_json::to_string(giant.state()).unwrap();
            let json = serde_json::to_string(giant.kind().brain().file()).unwrap();
            let mut fresh =
                Creature::new(crate::support::kind(&json), CreatureConfig::default()).unwrap();
            fresh.restore(serde_json::from_str(&text).unwrap()).unwrap();
            let mut same = giant.clone();
            for later in tick..tick + 45 {
                let [one, two] = [&mut same, &mut fresh].map(|giant| around(&person(later), giant));
                assert_eq!(one, two, "tick {later} from {tick}");
                assert_eq!(same.state(), fresh.state(), "tick {later} from {tick}");
            }
        }
        let report = around(&person(tick), &mut giant);
        ways[0] += usize::from(giant.waves().next().is_some());
        ways[1] += usize::from(giant.shots().next().is_some());
        ways[2] += usize::from(report.beam.is_some());
    }
    assert!(ways.iter().all(|ticks| *ticks > 10), "{ways:?}");
}

/// The report of a beam gives the place where the beam ends in the world.
#[test]
fn beams_tell_where_they_end() {
    let ground = HalfSpace::below(0.0);
    let rock = wall(DVec3::new(-40.0, 0.0, 25.0), DVec3::X * 80.0, 60.0);
    let (_, way, file) = all_ways()[2].clone();
    let mut giant = before(&act("swipe_right", json!({ way: file })));
    let mut ends = Vec::new();
    for _ in 0..400 {
        let around = Surroundings {
            terrain: &[&ground],
            creatures: &[&rock],
            people: &[somebody(1, DVec3::new(0.0, 8.0, 40.0))],
            ..Surroundings::default()
        };
        ends.extend(giant.step(&around).unwrap().beam);
    }
    assert!(ends.len() > 60, "{}", ends.len());
    for beam in ends {
        let near = (beam.to.z - 25.0).abs() < 1e-4 && beam.from.z < 25.0;
        assert!(near && beam.radius == 0.4, "{beam:?}");
    }
}

/// The skin of another creature neither stops a wave nor counts as ground.
#[test]
fn waves_pass_other_creatures() {
    let ground = HalfSpace::below(0.0);
    let skin = wall(DVec3::new(-40.0, 0.0, 22.0), DVec3::X * 80.0, 10.0);
    let wave = json!({ "radius": 40.0, "height": 0.5, "damage": 0.5, "throw": 5.0 });
    let giant = before(&act("stomp_right", json!({ "wave": wave })));
    let people = |_| {
        vec![
            somebody(1, DVec3::new(0.0, 0.0, 26.0)),
            somebody(2, DVec3::new(0.0, 9.0, 22.0)),
        ]
    };
    let seen = attack_among(&giant, people, |_| {
        [vec![&ground as &dyn Obstacle], vec![&skin]]
    });
    assert_eq!(seen.struck(), [1]);
}

/// A limb, its wave and its beam strike a person once in each attack, also in several stomps with overlapping waves.
#[test]
fn limb_wave_and_beam_strike_once_in_each_attack() {
    let ground = HalfSpace::below(0.0);
    let mut act = act(
        "stomp_right",
        json!({
            "wave": { "radius": 30.0, "speed": 1.5, "damage": 0.2, "throw": 2.0 },
            "beam": { "length": 60.0, "radius": 0.5, "damage": 0.1, "throw": 1.0 }
        }),
    );
    (act["attack"]["damage"], act["attack"]["throw"]) = (0.6.into(), 9.0.into());
    let states = json!({
        "stomps": { "act": act, "transitions": [{ "to": "again" }] },
        "again": { "transitions": [{ "to": "stomps", "after": 0.1 }] },
        "ends": { "final": true }
    });
    let kind = crate::support::kind(&crate::support::brain_with("stomps", &states.to_string()));
    let mut giant = Creature::new(kind, CreatureConfig::default()).unwrap();
    // The beam's prey is at the foot. Only waves reach the other people, some of them while the foot is raised again.
    let far = (2..22u32).map(|id| somebody(id.into(), DVec3::new(-6.0 - f64::from(id), 0.0, 7.0)));
    let people: Vec<_> = far
        .chain([somebody(1, DVec3::new(-3.6, 0.0, 7.0))])
        .collect();
    let (mut begun, mut blows) = (0u32, Vec::new());
    for _ in 0..4_000 {
        let report = giant.step(&with_people(&[&ground], &people)).unwrap();
        let is_wave = |event: &&CreatureEvent| matches!(event, CreatureEvent::Wave { .. });
        begun += report.events.iter().filter(is_wave).count() as u32;
        blows.extend(report.blows.iter().map(|blow| (blow.person, blow.damage)));
        if begun == 4 {
            giant.enter("ends");
        }
    }
    assert_eq!((begun, giant.waves().count()), (4, 0));
    for id in 1..22 {
        let count = blows.iter().filter(|(person, _)| *person == id).count();
        assert_eq!(count, 4, "{id}: {blows:?}");
    }
}

/// A wave that has already left spares a person that the beam of the same attack strikes.
#[test]
fn a_wave_spares_whom_the_beam_strikes_after_it_left() {
    let stomp = act(
        "stomp_right",
        json!({
            "wave": { "radius": 40.0, "speed": 4.0, "damage": 0.2, "throw": 2.0 },
            "beam": { "length": 60.0, "radius": 0.5, "damage": 0.1, "throw": 1.0 }
        }),
    );
    let giant = before(&stomp);
    let mut blown = 0;
    for step in 0..12 {
        let comes = 1.80 + 0.02 * f64::from(step);
        let place = DVec3::new(0.0, 0.0, 25.0);
        let people = |since: f64| {
            let away = if since < comes {
                DVec3::X * 200.0
            } else {
                DVec3::ZERO
            };
            vec![somebody(1, place), somebody(2, place + away)]
        };
        let seen = on_ground(&giant, people);
        for id in [1, 2] {
            let blows = seen.blows.iter().filter(|(_, blow)| blow.person == id);
            let blows = blows.count();
            assert!(blows <= 1, "{comes}: {id} is struck {blows} times");
            blown += blows;
        }
    }
    println!("{blown} blows");
    assert!(blown >= 12, "{blown}");
}

/// A part of an attack with neither damage nor throw does not keep the other parts from striking a person.
#[test]
fn what_has_neither_damage_nor_throw_spares_nobody() {
    let wave = json!({ "radius": 5.0, "damage": 0.5, "throw": 5.0 });
    let shell = json!({ "speed": 30.0, "radius": 0.0, "damage": 0.0, "throw": 0.0, "wave": wave });
    let giant = before(&act("swipe_right", json!({ "shot": shell })));
    for at in [DVec3::new(2.0, 0.0, 20.0), DVec3::new(-8.0, 0.0, 26.0)] {
        let people = |_| vec![somebody(1, at), somebody(2, at + DVec3::X)];
        let seen = on_ground(&giant, people);
        assert_eq!(seen.struck(), [1, 2]);
        let harm = seen.blows.iter().all(|(_, blow)| blow.damage > 0.1);
        assert!(harm, "{:?}", seen.blows);
        // The wave also strikes a person that only stands near the burst on the ground.
        let people = |time: f64| {
            let ran = if time > 0.3 { 2.0 } else { 0.0 };
            vec![somebody(1, at + DVec3::X * ran)]
        };
        let seen = on_ground(&giant, people);
        assert_eq!(seen.blows.len(), 1);
        assert!(seen.blows[0].1.damage < 0.4, "{:?}", seen.blows);
    }
    let show = json!({ "radius": 30.0, "damage": 0.0, "throw": 0.0 });
    let mut act = act(
        "stomp_right",
        json!({ "wave": show.clone(), "beam": {
        "length": 60.0, "radius": 0.5, "damage": 0.0, "throw": 0.0 } }),
    );
    act["attack"]["damage"] = 0.5.into();
    let giant = before(&act);
    let under = crate::attacks::spot(&giant, &act).with_y(0.0);
    let seen = on_ground(&giant, |_| vec![somebody(1, under)]);
    assert_eq!(seen.blows.len(), 1);
}

/// Waves begin on the ground on a slab with a lower face, even if the slab rises around the limb, and below a bridge.
#[test]
fn waves_begin_on_slabs_and_below_bridges() {
    let slab = |heights: [f64; 2]| {
        let corners = [(-40.0, -40.0), (40.0, -40.0), (40.0, 40.0), (-40.0, 40.0)];
        let quad = |y: f64| corners.map(|(x, z)| DVec3::new(x, y, z).as_vec3());
        let places: Vec<_> = heights.into_iter().flat_map(quad).collect();
        let triangles = [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]];
        TriangleTerrain::new(&places, &triangles, &[], DVec3::ZERO).unwrap()
    };
    let (floor, bridge) = (slab([0.0, -3.0]), slab([90.0, 80.0]));
    // The slab rises by `rise` metres during the wind-up.
    for (state, rise) in [
        ("stomp_right", 0.0),
        ("kick_left", 0.0),
        ("stomp_right", 2.0),
    ] {
        let risen = slab([rise, -3.0]);
        let wave = json!({ "radius": 15.0, "damage": 0.5, "throw": 5.0 });
        let giant = before(&act(state, json!({ "wave": wave })));
        let seen = attack(
            &giant,
            |_| Vec::new(),
            |time| {
                let floor = if time > 1.8 { &risen } else { &floor };
                vec![floor as &dyn Obstacle, &bridge]
            },
        );
        let place = seen.waves()[0].1;
        let height = place.y - rise;
        assert!((height - 0.5).abs() < 1e-3, "{state} at {rise}: {height}");
    }
}

/// A person on an edge stands on the ground, so a low wave strikes it. A person in the air beside it is spared.
#[test]
fn low_waves_strike_who_stands_on_edges_and_slopes() {
    let wave = json!({ "radius": 40.0, "height": 0.05, "damage": 0.5, "throw": 5.0 });
    let giant = before(&act("stomp_right", json!({ "wave": wave })));
    let ground = HalfSpace::below(-3.0);
    let quad = [(-40.0, -40.0), (20.0, -40.0), (20.0, 40.0), (-40.0, 40.0)];
    let places = quad.map(|(x, z)| DVec3::new(x, 0.0, z).as_vec3());
    let table = TriangleTerrain::new(&places, &[[0, 2, 1], [0, 3, 2]], &[], DVec3::ZERO);
    let table = table.unwrap();
    // The lower end of the body is a ball of 0.3 m. It rests on the table's edge, with its centre 0.1 m beyond the
    // edge.
    let rise = 0.3 - (0.3f64 * 0.3 - 0.1 * 0.1).sqrt();
    let people = |_| {
        vec![
            somebody(1, DVec3::new(20.1, -rise, 5.0)),
            somebody(2, DVec3::new(20.1, 0.2, 8.0)),
        ]
    };
    let seen = attack(&giant, people, |_| vec![&table as &dyn Obstacle, &ground]);
    assert_eq!(seen.struck(), [1]);
}

/// A sheet stops a stone, however fast the sheet moves towards it and at any rate: no stone is ever behind the sheet.
#[test]
fn stones_do_not_go_through_gates_that_move() {
    let ground = HalfSpace::below(0.0);
    let file = json!({ "shot": { "speed": 25.0, "radius": 0.8, "gravity": 0.0, "damage": 0.5, "throw": 5.0 } });
    let mut met = 0;
    for rate in [30.0, 60.0] {
        let dt = 1.0 / rate;
        for (speed, from) in [
            (0.0, 24.0),
            (-3.0, 34.3),
            (-40.0, 90.0),
            (-40.0, 91.1),
            (12.0, 17.0),
        ] {
            let act = act("swipe_right", file.clone());
            let mut giant = before_at(&act, dt, CreatureConfig::default());
            let corners = [(-90.0, -1.0), (90.0, -1.0), (90.0, 90.0), (-90.0, 90.0)];
            let mut gate = plate(corners.map(|(x, y)| Vec3::new(x, y, 0.0)));
            let still = Palette::from_matrices([Affine::IDENTITY]);
            let mut put = |z: f64| {
                let place = Similarity {
                    translation: DVec3::Z * z,
                    ..Similarity::IDENTITY
                };
                gate.advance(&still, place).unwrap();
                gate.clone()
            };
            put(from);
            let person = somebody(1, DVec3::new(0.0, 0.0, 60.0));
            let (mut thrown, mut at) = (false, from);
            for tick in 0..(10.0 * rate) as u32 {
                if thrown {
                    at += speed * dt;
                }
                let gate = put(at);
                let terrain: [&dyn Obstacle; 2] = [&ground, &gate];
                let terrain = if thrown { &terrain[..] } else { &terrain[..1] };
                let events = step(&mut giant, std::slice::from_ref(&person), terrain);
                let throws = |event: &CreatureEvent| matches!(event, CreatureEvent::Threw { .. });
                thrown |= events.iter().any(throws);
                for shot in giant.shots() {
                    assert!(
                        shot.place.z < at + 1e-3,
                        "{rate} {speed}, tick {tick}: {} {at}",
                        shot.place
                    );
                }
                met += events
                    .iter()
                    .filter(|event| matches!(event, CreatureEvent::Burst { .. }))
                    .count();
            }
        }
    }
    assert_eq!(met, 10);
}
