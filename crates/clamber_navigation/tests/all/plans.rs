//! B62: more stamina, reach or fur never makes a place unreachable, and no plan is faster than the least time.

use std::collections::BTreeSet;

use crate::support::{Body, ball, climber};
use clamber_navigation::{ClimbGraph, Footing, Forecast, GraphConfig, Start};
use clamber_surface::mesh::SurfaceKind::{Fur, Skin, Stone};
use fastrand::Rng;
use glam::Vec3;

/// A ball on a pillar, both patched with stone at random.
fn patched(seed: u64, fur: f32) -> Body {
    let mut rng = Rng::with_seed(seed);
    let noise: Vec<f32> = (0..400).map(|_| rng.f32()).collect();
    let kind = |u: f32, v: f32| {
        let cell = (u * 20.0) as usize % 20 * 20 + (v * 20.0) as usize % 20;
        if noise[cell] < fur { Fur } else { Stone }
    };
    let pillar = |u: f32, v: f32| {
        let around = u * std::f32::consts::TAU;
        Vec3::new(1.5 * libm::cosf(around), 9.0 * v, -1.5 * libm::sinf(around))
    };
    ball(Vec3::Y * 11.5, 4.0, kind).and(&Body::grid([24, 24], pillar, kind))
}

/// The points of a graph's reachable patches, rounded to a tenth of a millimetre.
fn places(graph: &ClimbGraph, reached: &[bool]) -> BTreeSet<[i64; 3]> {
    let patches = graph.patches().iter().zip(reached);
    let places = patches.filter(|(_, reached)| **reached);
    places
        .map(|(patch, _)| (patch.point * 1e4).round().as_i64vec3().to_array())
        .collect()
}

fn area(graph: &ClimbGraph) -> f64 {
    let reached = graph.reachable();
    let patches = graph.patches().iter().zip(&reached);
    patches
        .filter(|(_, reached)| **reached)
        .map(|(patch, _)| patch.area)
        .sum()
}

#[test]
fn more_reach_and_more_fur_never_take_anything_away() {
    let grew: u32 = std::thread::scope(|scope| {
        let bodies = [0, 1].map(|seed| scope.spawn(move || growths(seed)));
        bodies.map(|grew| grew.join().unwrap()).iter().sum()
    });
    assert!(grew >= 8, "it grew only {grew} times");
}

/// The number of times that a body's reachable area grows with more reach, and with more fur. It must never shrink.
fn growths(seed: u64) -> u32 {
    let (mut before, mut grew) = ((0.0, 0.0), 0);
    for step in 0..3 {
        let mut config = climber();
        if let Some(grip) = &mut config.climber.grip {
            grip.reach = 0.15 + 0.15 * f64::from(step);
        }
        let reach = area(&patched(seed, 0.6).report(&config).0);
        let fur = area(&patched(seed, 0.4 + 0.15 * step as f32).report(&climber()).0);
        // Areas are sums of the same pieces in another order, so they may differ by rounding.
        assert!(
            reach >= before.0 - 1e-9,
            "{seed}, reach: {reach} after {}",
            before.0
        );
        assert!(
            fur >= before.1 - 1e-9,
            "{seed}, fur: {fur} after {}",
            before.1
        );
        grew += u32::from(reach > before.0 + 1.0) + u32::from(fur > before.1 + 1.0);
        before = (reach, fur);
    }
    grew
}

#[test]
fn more_stamina_never_takes_anything_away() {
    // Skin that cannot be gripped, with a strip of fur: the way up is too long for a climber with little stamina, which
    // cannot rest on it.
    let wall = |u: f32, v: f32| Vec3::new(8.0 * (u - 0.5), 30.0 * v, 0.0);
    let kind = |u: f32, _: f32| if (0.3..0.7).contains(&u) { Fur } else { Skin };
    let (graph, _) = Body::grid([16, 60], wall, kind).report(&climber());
    let reachable = |stamina: f64| {
        let starts: Vec<Start> = graph.starts_on_ground(stamina).collect();
        let is_reached = |patch: usize| {
            let goal = graph.goal(&[patch]);
            graph.plan(&starts, &goal, &Forecast::still()).is_some()
        };
        let reached: Vec<bool> = (0..graph.patches().len()).map(is_reached).collect();
        places(&graph, &reached)
    };
    let sets = [0.1, 0.2, 0.35, 0.5].map(reachable);
    for pair in sets.windows(2) {
        assert!(pair[0].is_subset(&pair[1]) && pair[0].len() < pair[1].len());
    }
}

#[test]
fn no_plan_is_faster_than_the_least_time() {
    let (graph, _) = patched(3, 0.75).report(&GraphConfig {
        spacing: 0.5,
        ..climber()
    });
    let mut rng = Rng::with_seed(62);
    let (mut pairs, mut rests) = (0, 0);
    while pairs < 10_000 {
        let goal = graph.goal(&[rng.usize(0..graph.patches().len())]);
        for _ in 0..250 {
            let patch = rng.usize(0..graph.patches().len());
            let footing = if rng.bool() {
                Footing::Stands
            } else {
                Footing::Holds
            };
            let start = Start {
                patch,
                footing,
                seconds: 0.0,
                stamina: 0.05 + 0.95 * rng.f64(),
            };
            let least = goal.least_seconds_with(patch, footing, start.stamina);
            assert!(least >= goal.least_seconds(patch, footing));
            let plan = graph.plan(&[start], &goal, &Forecast::still());
            pairs += 1;
            let Some(plan) = plan else {
                continue;
            };
            assert!(
                least <= plan.seconds() + 1e-9,
                "{least} for {}",
                plan.seconds()
            );
            rests += u32::from(least > goal.least_seconds(patch, footing) + 1e-6);
            for pair in plan.steps.windows(2) {
                // The least times are consistent: along a step they fall by at most the step's time.
                let [a, b] = [&pair[0], &pair[1]];
                let [from, to] = [a, b].map(|step| goal.least_seconds(step.patch, step.footing));
                assert!(from <= to + (b.seconds - a.seconds) + 1e-9);
            }
        }
    }
    assert!(rests > 50, "only {rests} plans have to rest");
}

#[test]
fn a_plan_is_found_wherever_stamina_is_enough() {
    // Ledges for rests, and long ways of fur between them.
    let stairs = |u: f32, v: f32| {
        let (up, step) = (v * 12.0, libm::floorf(v * 12.0 / 4.0));
        let out = if up - 4.0 * step < 1.0 {
            up - 4.0 * step
        } else {
            1.0
        };
        Vec3::new(
            10.0 * (u - 0.5),
            4.0 * step + (up - 4.0 * step - 1.0).max(0.0) * 4.0 / 3.0,
            -2.0 * (step + out),
        )
    };
    let (graph, _) = Body::grid([12, 48], stairs, |_, _| Fur).report(&climber());
    let mut rng = Rng::with_seed(63);
    let (mut found, mut refused) = (0, 0);
    let mut sums = [0.0, 0.0];
    for _ in 0..20 {
        let goal = graph.goal(&[rng.usize(0..graph.patches().len())]);
        for _ in 0..100 {
            let patch = rng.usize(0..graph.patches().len());
            let start = Start {
                patch,
                footing: Footing::Holds,
                seconds: 0.0,
                stamina: rng.f64() * rng.f64(),
            };
            let needs = goal.least_stamina(patch, Footing::Holds);
            let plan = graph.plan(&[start], &goal, &Forecast::still());
            assert_eq!(
                plan.is_some(),
                start.stamina > needs,
                "{} of {needs}",
                start.stamina
            );
            if let Some(plan) = &plan {
                let least = goal.least_seconds_with(patch, Footing::Holds, start.stamina);
                sums = [sums[0] + plan.seconds(), sums[1] + least];
            }
            found += u32::from(plan.is_some());
            refused += u32::from(plan.is_none() && needs.is_finite());
        }
    }
    assert!(
        found > 500 && refused > 100,
        "{found} found, {refused} refused"
    );
}

/// A horizontal sheet of skin that cannot be gripped, one metre above the ground.
fn table() -> Body {
    let place = |u: f32, v: f32| Vec3::new(6.0 * (u - 0.5), 1.0, -6.0 * (v - 0.5));
    Body::grid([12, 12], place, |_, _| Skin)
}

fn start(patch: usize, stamina: f64) -> Start {
    Start {
        patch,
        footing: Footing::Stands,
        seconds: 0.0,
        stamina,
    }
}

#[test]
fn whoever_has_no_strength_walks() {
    let mut config = climber();
    config.climber.stamina.as_mut().unwrap().refill = 0.0;
    let (graph, _) = table().report(&config);
    let last = graph.patches().len() - 1;
    let goal = graph.goal(&[last]);
    assert_eq!(goal.least_stamina(0, Footing::Stands), 0.0);
    let plan = graph.plan(&[start(0, 0.0)], &goal, &Forecast::still());
    assert!(plan.unwrap().seconds() > 1.0);
}

#[test]
fn whoever_cannot_walk_needs_no_strength_in_vain() {
    let mut config = climber();
    config.climber.ground.walk_speed = 0.0;
    let (graph, _) = table().report(&config);
    let goal = graph.goal(&[0]);
    let last = graph.patches().len() - 1;
    assert_eq!(goal.least_seconds(last, Footing::Stands), f64::INFINITY);
    assert_eq!(goal.least_stamina(last, Footing::Stands), f64::INFINITY);
    assert_eq!(
        graph.plan(&[start(last, 1.0)], &goal, &Forecast::still()),
        None
    );
}

#[test]
fn starts_and_goals_that_make_no_sense_lead_nowhere() {
    let (graph, _) = table().report(&climber());
    let (larger, _) = ball(Vec3::Y * 3.0, 3.0, |_, _| Fur).report(&climber());
    let (goal, still) = (graph.goal(&[0]), Forecast::still());
    for odd in [1e7, 1e20, 1e300, -1.0, f64::NAN, f64::INFINITY] {
        let seconds = Start {
            seconds: odd,
            ..start(1, 1.0)
        };
        assert_eq!(graph.plan(&[seconds], &goal, &still), None, "{odd} s");
    }
    assert_eq!(graph.plan(&[start(1, f64::NAN)], &goal, &still), None);
    assert_eq!(graph.plan(&[start(usize::MAX, 1.0)], &goal, &still), None);
    assert_eq!(larger.plan(&[start(1, 1.0)], &goal, &still), None);
    assert_eq!(
        goal.least_seconds(usize::MAX, Footing::Holds),
        f64::INFINITY
    );
    assert_eq!(
        graph.plan(&[start(1, 1.0)], &graph.goal(&[usize::MAX]), &still),
        None
    );
}
