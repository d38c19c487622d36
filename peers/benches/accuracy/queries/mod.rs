//! Rays, overlaps, closest points and sphere casts of all peers, on one pose of each mesh.

mod score;
mod sets;

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use clamber_peers::{Answer, Entry, Kind, Peer, Unsupported};
use clamber_scenes::measure::quantile;
use score::{Report, Score};
use sets::{Query, Set, sets};

/// Number of rounds that are timed.
const ROUNDS: usize = 7;

/// Scores all peers on all sets.
pub(crate) fn run(brief: bool) -> Result<(), Box<dyn Error>> {
    let mut report = Report::default();
    let entries = clamber_peers::all();
    for set in sets(if brief { 40 } else { 3_000 })? {
        eprintln!("{} ...", set.name);
        for (kind, _) in Kind::ALL {
            let truth: Vec<Expected> = set
                .queries
                .iter()
                .map(|q| expected(&set, q, kind))
                .collect();
            for entry in &entries {
                let score = judge(entry, &set, kind, &truth)?;
                report.add(set.name, entry.name, kind, score)?;
            }
        }
    }
    report.finish(brief)
}

/// The true answer to a query: the distance along a ray, to the closest point, or along a motion, metres. For overlaps,
/// the number of triangles.
struct Expected {
    value: Option<f64>,
    /// Number of triangles at the sphere's border: an overlap may find up to this number of triangles more.
    more: usize,
    /// The query's reach, metres. An error larger than a share of the reach counts as a leak or a false hit.
    scale: f64,
}

fn expected(set: &Set, query: &Query, kind: Kind) -> Expected {
    let (origin, radius) = (
        query.sphere.center.as_dvec3(),
        f64::from(query.sphere.radius),
    );
    let truth = &set.truth;
    let (value, more) = match kind {
        Kind::Ray => {
            let direction = query.ray.direction().as_dvec3();
            (truth.cast_ray(origin, direction, f64::from(query.reach)), 0)
        }
        Kind::Closest => {
            let distance = truth.distance(origin);
            ((distance <= f64::from(query.reach)).then_some(distance), 0)
        }
        Kind::Overlap => {
            let reach = radius + f64::from(query.reach) / 2.0;
            let [within, unsure] = truth.within(origin, f64::from(reach as f32), 1e-5);
            (Some(within as f64), unsure)
        }
        Kind::Cast => {
            let motion = query.motion.as_dvec3();
            let share = truth.cast_sphere(origin, radius, motion);
            (share.map(|share| share * motion.length()), 0)
        }
    };
    Expected {
        value,
        more,
        scale: f64::from(query.reach),
    }
}

/// A peer's answer, in the form of [`Expected::value`].
fn answer(peer: &mut dyn Peer, query: &Query, kind: Kind) -> Answer<Option<f64>> {
    Ok(match kind {
        Kind::Ray => {
            let hit = peer.cast_ray(&query.ray, query.reach)?;
            hit.map(|hit| f64::from(hit.distance))
        }
        Kind::Closest => {
            let found = peer.closest_point(query.sphere.center, query.reach)?;
            found.map(|found| f64::from(found.distance))
        }
        Kind::Overlap => {
            let mut sphere = query.sphere;
            sphere.radius = (f64::from(sphere.radius) + f64::from(query.reach) / 2.0) as f32;
            Some(peer.overlap_sphere(&sphere)? as f64)
        }
        Kind::Cast => {
            let share = peer.cast_sphere(&query.sphere, query.motion)?;
            share.map(|share| f64::from(share) * query.motion.as_dvec3().length())
        }
    })
}

/// The score of a peer; `None` if it has no such query.
fn judge(
    entry: &Entry,
    set: &Set,
    kind: Kind,
    truth: &[Expected],
) -> Result<Option<Score>, Box<dyn Error>> {
    let mut peer = (entry.make)(&set.mesh)?;
    peer.update(&set.palette, set.place)?;
    let mut score = Score::default();
    for (query, expected) in set.queries.iter().zip(truth) {
        let found = match answer(peer.as_mut(), query, kind) {
            Ok(found) => found,
            Err(Unsupported) => return Ok(None),
        };
        score.add(kind, expected.value, expected.more, expected.scale, found);
    }
    // The second tick in which everything is touched.
    peer.update(&set.palette, set.place)?;
    let mut rounds: Vec<f64> = (0..ROUNDS)
        .map(|_| {
            let start = Instant::now();
            for query in &set.queries {
                let _ = black_box(answer(peer.as_mut(), query, kind));
            }
            start.elapsed().as_secs_f64() * 1e9 / set.queries.len() as f64
        })
        .collect();
    score.nanoseconds = quantile(&mut rounds, 0.5);
    Ok(Some(score))
}
