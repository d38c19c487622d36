use super::*;

/// No number of a foot may be NaN or infinite: a restored state with such a number would spread it over the whole pose.
#[test]
fn a_foot_with_what_is_no_number_is_refused() {
    let at = |number: f64| Footing {
        ball: DVec3::splat(number),
        normal: DVec3::Y,
    };
    let step = |number: f64| Step {
        from: DVec3::ZERO,
        to: at(0.0),
        lift: number,
        passed: 0.1,
        lasts: 1.0,
    };
    let changes: [fn(&mut Foot, f64); 9] = [
        |foot, number| foot.clip.z = number,
        |foot, number| foot.offset.velocity.x = number,
        |foot, number| foot.yaw.value = number,
        |foot, number| foot.flat.velocity = number,
        |foot, number| foot.firm.value = number,
        |foot, number| foot.normal.y = number,
        |foot, number| foot.settling.value.x = number,
        |foot, number| foot.path.offset = number,
        |foot, number| foot.path.floor = number,
    ];
    let holds = |number: f64| {
        [
            Hold::Planted {
                at: at(number),
                heading: 0.0,
                below: 0.0,
            },
            Hold::Planted {
                at: at(0.0),
                heading: number,
                below: 1.0,
            },
            Hold::Lands {
                ball: Spring::at(DVec3::splat(number)),
                to: at(0.0),
                left: 0.5,
            },
            Hold::Lands {
                ball: Spring::at(DVec3::ZERO),
                to: at(0.0),
                left: number,
            },
            Hold::Steps(step(number)),
        ]
    };
    let most = 1e12;
    for (number, fits) in [
        (1.0, true),
        (f64::NAN, false),
        (1e13, false),
        (f64::INFINITY, false),
    ] {
        for (index, change) in changes.iter().enumerate() {
            let mut foot = Foot::new();
            change(&mut foot, number);
            assert_eq!(foot.is_within(most), fits, "change {index}: {number}");
        }
        for hold in holds(number) {
            let foot = Foot {
                hold,
                landing: Some(at(0.0)),
                ..Foot::new()
            };
            assert_eq!(foot.is_within(most), fits, "{hold:?}");
        }
    }
    let foot = Foot {
        landing: Some(at(f64::NAN)),
        ..Foot::new()
    };
    assert!(!foot.is_within(most));
    let mut foot = Foot::new();
    foot.path.left = f64::NAN;
    assert!(!foot.is_within(most));
}
