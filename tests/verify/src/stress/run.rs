//! Runs one case from beginning to end.

use crate::agreement::{Answers, Comparison, Found, Question};
use clamber_surface::SimdLevel;
use clamber_surface::geometry::Similarity;
use clamber_surface::measure::BruteForce;
use clamber_surface::mesh::PaletteError;
use clamber_surface::rig::{JointId, Palette};
use clamber_surface::surface::{SkinnedSurface, SurfaceError};
use glam::DVec3;

use super::bounds::Bounds;
use super::places::Journey;
use super::posed::Posed;
use super::poses::{Motion, spoilt};
use super::world::Before;
use super::{Case, Class, Seen, Subject, Times, contacts, leaks, nearest, world};

/// Number of rounds of all questions in a tick.
const ROUNDS: usize = 2;

/// Number of ray origins near closed skin in a tick. Each has six targets.
const ORIGINS: usize = 4;

/// Number of closest points that are checked in a tick.
const NEAREST: usize = 4;

/// Number of rounds of contact checks in a tick, with two movers each.
const CONTACTS: usize = 6;

/// Number of places in the world that are checked in a tick.
const WORLD: usize = 6;

/// Number of timed questions of every name in a tick.
const TIMED: usize = 64;

/// Largest number of steps of a cast's exact test, as documented.
const STEPS: u32 = 256;

/// Runs a case; returns the numbers of its checks.
///
/// With `times`, queries are timed as well. Each query runs once before it is timed, so that the time does not include
/// skinning.
///
/// # Panics
/// If a check fails.
pub fn run(case: &Case, mut times: Option<&mut Times>) -> Seen {
    let mut rng = fastrand::Rng::with_seed(case.seed);
    let journey = Journey::new(case.place, &mut rng);
    let subject = Subject::new(case.mesh, case.triangles, journey.extent, case.seed);
    let motion = Motion::new(&subject, case.pose, &mut rng);
    let bounds = Bounds::new(&subject.mesh, &mut rng);
    let levels = SimdLevel::available();
    let mut any_level = || levels[rng.usize(0..levels.len())];
    let [level, other] = [any_level(), any_level()];
    let mut surface = SkinnedSurface::with_simd_level(subject.mesh.clone(), level);
    // The twin gets no faulty palette, and skins ahead.
    let mut twin = SkinnedSurface::with_simd_level(subject.mesh.clone(), other);
    let fault = rng.usize(0..case.ticks.max(1));
    let mut before: Option<Before> = None;
    let mut last: Option<(Palette, Similarity)> = None;
    let mut seen = Seen::default();
    for tick in 0..case.ticks {
        let palette = motion.palette(&subject, tick, &mut rng);
        let place = journey.at(tick);
        if tick == fault {
            refuse(&mut surface, &palette, place, &mut rng);
            seen.refused += 1;
        }
        for surface in [&mut surface, &mut twin] {
            let taken = if tick == 0 {
                surface.teleport(&palette, place)
            } else {
                surface.advance(&palette, place)
            };
            assert_eq!(taken, Ok(()), "tick {tick}");
        }
        twin.skin_ahead();
        seen.ticks += 1;
        let posed = Posed::new(&surface, subject.extent);
        seen += compare(&posed, &twin, &mut rng);
        seen.bounds += bounds.check(&posed);
        if case.mesh.is_closed() {
            seen.rays += leaks::check(&posed, &mut rng, ORIGINS);
        }
        seen.nearest += nearest::check(&posed, &mut rng, NEAREST);
        seen.contacts += contacts::check(&posed, &mut rng, CONTACTS);
        seen.world += world::check(&posed, &palette, before.as_ref(), &mut rng, WORLD);
        before = Some(Before::of(&posed, &palette));
        if let Some(times) = times.as_deref_mut() {
            let now = (&palette, place);
            let then = last
                .as_ref()
                .map_or(now, |(palette, place)| (palette, *place));
            time(case, &posed, [then, now], times, &mut rng);
        }
        last = Some((palette, place));
    }
    seen
}

/// Asks all questions of both surfaces, and compares the answers with brute force.
fn compare(posed: &Posed<'_>, twin: &SkinnedSurface, rng: &mut fastrand::Rng) -> Seen {
    let mut seen = Seen::default();
    let brute_force = BruteForce::new(posed.surface.in_model());
    let (mut questions, mut comparison) = (Vec::new(), Comparison::default());
    for _ in 0..ROUNDS {
        posed.aims(rng).named(&mut questions);
        for (name, question) in &questions {
            comparison.ask(&brute_force, question);
            for (how, surface) in [("ahead", twin), ("lazily", posed.surface)] {
                if let Err(disagreement) = comparison.hold(&surface.in_model()) {
                    panic!("{name}, skinned {how}: {disagreement}");
                }
            }
            let found = comparison.found();
            seen.questions += 1;
            seen.hits += found.len();
            seen.undecided += found.iter().filter(|found| found.is_undecided()).count();
        }
    }
    let steps = posed.surface.diagnostics().most_cast_steps;
    assert!(steps <= STEPS, "{steps} steps");
    seen.steps = steps as usize;
    seen
}

/// Checks that a surface rejects a faulty palette and an invalid place, and that it does not change.
fn refuse(
    surface: &mut SkinnedSurface,
    palette: &Palette,
    place: Similarity,
    rng: &mut fastrand::Rng,
) {
    let state = |surface: &SkinnedSurface| {
        let posed = Posed::new(surface, 1.0);
        let bits = |p: &glam::Vec3| crate::targets::bits::bits(*p);
        let now: Vec<_> = posed.positions.iter().map(bits).collect();
        let before: Vec<_> = posed.previous.iter().map(bits).collect();
        (
            now,
            before,
            *surface.world_from_model(),
            surface.bounding_ball(),
        )
    };
    let before = state(surface);
    let (broken, joint) = spoilt(palette, rng);
    let fault = PaletteError::Matrix(JointId(joint as u32));
    let refusal = Err(SurfaceError::Palette(fault));
    assert_eq!(surface.advance(&broken, place), refusal);
    assert_eq!(surface.teleport(&broken, place), refusal);
    let nowhere = Similarity {
        translation: DVec3::new(0.0, f64::NAN, 0.0),
        ..place
    };
    assert_eq!(
        surface.advance(palette, nowhere),
        Err(SurfaceError::WorldFromModel)
    );
    assert!(
        state(surface) == before,
        "a rejected palette changed the surface"
    );
}

/// The previous pose and the current one, each a palette and a place.
type Poses<'a> = [(&'a Palette, Similarity); 2];

/// Times all questions, each in its class.
fn time(
    case: &Case,
    posed: &Posed<'_>,
    poses: Poses<'_>,
    times: &mut Times,
    rng: &mut fastrand::Rng,
) {
    let mut fresh = posed.surface.clone();
    let (mut questions, mut answer) = (Vec::new(), Vec::new());
    for _ in 0..TIMED {
        posed.aims(rng).named(&mut questions);
        for (query, question) in &questions {
            // `work` asks the question once before it is timed, so that all clusters that it touches are skinned. It
            // asks the same surface, since a surface that is skinned ahead has other bounds, so the work differs.
            let class = Class {
                mesh: case.mesh,
                triangles: case.triangles,
                query,
                work: work(&mut fresh, poses, question, &mut answer),
            };
            times.add(class, case, || {
                answer.clear();
                fresh.in_model().answer(question, &mut answer);
            });
        }
    }
}

/// The work of a question that is the first of its tick: nodes, clusters and triangles, weighted about in proportion to
/// their cost. It is rounded up to a power of four minus one.
fn work(
    fresh: &mut SkinnedSurface,
    [before, now]: Poses<'_>,
    question: &Question,
    answer: &mut Vec<Found>,
) -> usize {
    let posed = fresh
        .teleport(before.0, before.1)
        .and_then(|()| fresh.advance(now.0, now.1));
    assert_eq!(posed, Ok(()));
    answer.clear();
    fresh.in_model().answer(question, answer);
    let touched = fresh.diagnostics();
    // A node has eight bounds.
    let nodes = touched.bounds_evaluated / 8;
    let done = nodes + 4 * touched.clusters_touched + 8 * touched.triangles_tested as usize;
    let mut work = 0;
    while work < done {
        work = work * 4 + 3;
    }
    work
}
