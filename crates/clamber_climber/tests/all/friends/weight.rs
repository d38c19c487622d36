//! The weight of climbers on climbers, on supports that can be pushed.

use clamber_climber::{
    Climber, ClimberConfig, ClimberGroup, ClimberInput, ContactQuery, ContactRule, StepRules,
};
use clamber_world::{HalfSpace, ObstacleId};
use glam::DVec3;

use crate::cases::{pairs, triples};
use crate::friends::crowd::{RATES, SIZES};
use crate::held::Held;
use crate::input::{HOLD, IDLE};
use crate::numbers::in_world_of_size;
use crate::scene::{FUR, list};
use crate::stage::tireless;

fn grips_friends(query: &ContactQuery<'_>) -> ContactRule {
    query.usual().with_grip(true)
}

/// The force on the scales, as a multiple of one climber's weight, after all climbers have come to rest.
fn weighed(
    scales: &Held<HalfSpace>,
    config: ClimberConfig,
    places: &[DVec3],
    input: &ClimberInput,
    rate: f64,
) -> f64 {
    let ids = |index: usize| ObstacleId(20 - index as u64);
    let place = |at: &DVec3| Climber::new(config, *at).unwrap();
    let mut climbers: Vec<Climber> = places.iter().map(place).collect();
    let mut group = ClimberGroup::default();
    let fixed = list(&[scales]);
    let dt = 1.0 / rate;
    let (settles, weighs) = ((2.0 * rate) as u32, rate as u32);
    let mut given = DVec3::ZERO;
    for tick in 0..settles + weighs {
        let listed = climbers.iter().enumerate();
        group.update(listed.map(|(index, one)| (ids(index), one)), &fixed, dt);
        for (index, climber) in climbers.iter_mut().enumerate() {
            let id = ids(index);
            let obstacles: Vec<_> = fixed.iter().copied().chain(group.others(id)).collect();
            let rules = StepRules {
                id: Some(id),
                ..StepRules::by(&grips_friends)
            };
            let report = climber.step_with(input, &obstacles, &rules, dt).unwrap();
            let pushes = report.pushes.iter();
            let pushed = pushes.filter(|push| push.obstacle == ObstacleId(0));
            if tick >= settles {
                given += pushed.map(|push| push.impulse).sum::<DVec3>();
            }
        }
    }
    let weight = config.gravity * config.body.mass;
    given.dot(weight) / weight.length_squared()
}

#[test]
fn a_tower_weighs_as_much_as_all_of_its_climbers() {
    for (size, rate, count) in triples(SIZES, RATES, 1..=4) {
        let config = in_world_of_size(ClimberConfig::walker(), size);
        let scales = Held(HalfSpace::below(0.0), 5.0);
        let places: Vec<_> = (0..count)
            .map(|index| DVec3::Y * ((0.4 + 0.8 * f64::from(index)) * size))
            .collect();
        let found = weighed(&scales, config, &places, &IDLE, rate);
        let off = found - f64::from(count);
        assert!(off.abs() < 0.01, "size {size}, {rate} Hz, {count}: {found}");
    }
}

/// The upper climber holds a ceiling, and the lower one holds the upper one's feet.
#[test]
fn who_hangs_from_a_climber_that_hangs_weighs_on_its_hold() {
    for (size, rate) in pairs(SIZES, RATES) {
        let config = tireless();
        let mut config = in_world_of_size(config, size);
        config.grip.as_mut().unwrap().max_overhang = 1.7;
        let ceiling = HalfSpace::behind(DVec3::Y * (6.0 * size), DVec3::NEG_Y).unwrap();
        let scales = Held(ceiling.with_tag(FUR), 5_000.0);
        for count in [1, 2] {
            let places = [DVec3::Y * (5.5 * size), DVec3::Y * (4.5 * size)];
            let found = weighed(&scales, config, &places[..count], &HOLD, rate);
            let off = found - count as f64;
            assert!(off.abs() < 0.05, "size {size}, {rate} Hz, {count}: {found}");
        }
    }
}
