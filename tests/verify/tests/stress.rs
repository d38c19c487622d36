//! Stress cases: every family of meshes in every family of poses, at every place in turn.
//!
//! The tests run a few small cases; with `--ignored`, many and large ones. `cargo xtask soak` runs cases for any time.

use clamber_verify::stress::{Case, MeshFamily, Place, PoseFamily, Seen, run};

/// Runs a mesh in every pose, at the places in turn, with `seeds` cases for each pose.
fn stress(mesh: MeshFamily, triangles: usize, ticks: usize, seeds: u64) -> Seen {
    let mut all = Seen::default();
    for seed in 0..seeds {
        for (index, pose) in PoseFamily::ALL.iter().enumerate() {
            let case = Case {
                mesh,
                pose: *pose,
                place: Place::ALL[(index + seed as usize) % Place::ALL.len()],
                triangles,
                ticks,
                seed,
            };
            println!("{case}");
            all += run(&case, None);
        }
    }
    println!("{mesh}: {all:?}");
    all
}

/// Runs [`stress`] briefly, and checks that it made enough checks.
fn briefly(mesh: MeshFamily) {
    let seen = stress(mesh, 600, 3, 2);
    let cases = 2 * PoseFamily::ALL.len();
    assert_eq!(seen.ticks, 3 * cases);
    assert_eq!(seen.refused, cases);
    assert!(seen.questions > 100 * cases, "{seen:?}");
    assert!(seen.hits > 400 * cases, "{seen:?}");
    assert!(seen.bounds > 2_000 * cases, "{seen:?}");
    assert!(seen.contacts > 15 * cases, "{seen:?}");
    assert!(seen.world > 40 * cases, "{seen:?}");
    if mesh.is_closed() {
        assert!(seen.rays > 20 * cases, "{seen:?}");
    }
}

/// A test of a family, and a long test of it.
macro_rules! families {
    ($($name:ident, $long:ident: $family:ident;)*) => {$(
        #[test]
        fn $name() {
            briefly(MeshFamily::$family);
        }

        #[test]
        #[ignore = "a minute or more: run it in release"]
        fn $long() {
            stress(MeshFamily::$family, 700, 6, 40);
            stress(MeshFamily::$family, 20_000, 4, 1);
        }
    )*};
}

families! {
    balls, many_balls: Ball;
    limbs, many_limbs: Limb;
    one_joint, one_joint_often: OneJoint;
    a_thousand_joints, a_thousand_joints_often: Chain;
    all_weights_on_one_joint, all_weights_on_one_joint_often: AllOnOne;
    tubes_of_slivers, many_tubes_of_slivers: SliverTube;
    soups_of_slivers, many_soups_of_slivers: Slivers;
    soups_of_copies, many_soups_of_copies: Copies;
    spikes, many_spikes: Spikes;
    t_junctions, many_t_junctions: TJunctions;
}

#[test]
fn a_case_is_parsed_from_its_name_and_runs_the_same_again() {
    let case = Case {
        mesh: MeshFamily::SliverTube,
        pose: PoseFamily::InsideOut,
        place: Place::Far,
        triangles: 100,
        ticks: 2,
        seed: 7,
    };
    assert_eq!(case.to_string(), "sliver-tube/inside-out/far/100/2/7");
    assert_eq!(case.to_string().parse(), Ok(case));
    for wrong in [
        "",
        "limb",
        "limb/bent/far/100/2",
        "limb/bent/far/100/2/x",
        "lamb/bent/far/1/1/1",
    ] {
        assert!(wrong.parse::<Case>().is_err(), "{wrong}");
    }
    // A case runs the same way every time.
    assert_eq!(run(&case, None), run(&case, None));
}

#[test]
#[ignore = "minutes and gigabytes: run it in release, and alone"]
fn ten_million_triangles() {
    let case = Case {
        mesh: MeshFamily::Limb,
        pose: PoseFamily::Bent,
        place: Place::Far,
        triangles: 10_000_000,
        ticks: 2,
        seed: 1,
    };
    let start = std::time::Instant::now();
    let seen = run(&case, None);
    println!("{case}: {seen:?}");
    println!("{:.0} s", start.elapsed().as_secs_f64());
    // Only Linux reports its peak memory in this file.
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find(|line| line.starts_with("VmHWM"));
    println!("{}", peak.unwrap_or("peak memory unknown"));
    assert!(seen.rays > 0 && seen.contacts > 0, "{seen:?}");
}
