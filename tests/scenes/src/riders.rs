//! The queries of riders who stand on a walking giant, tick by tick: a workload for benches.

use std::sync::Arc;

use clamber_surface::geometry::{Capsule, Ray, Similarity, Sphere};
use clamber_surface::mesh::{ColliderMesh, TriangleId, VertexId};
use clamber_surface::rig::Palette;
use clamber_surface::surface::{Anchor, SkinnedSurface};

use crate::{Creature, SceneError};

/// Ticks a second.
const RATE: f64 = 60.0;

/// How deep a rider's spheres reach into the skin, as a share of the radius: 10 mm for a sphere of 0.5 m.
const DEPTH: f32 = 0.02;

/// A single rider takes the best of so many seats: the one where its body touches nearest to `TOUCHED`
/// triangles, averaged over `LOOKS` ticks of the walk.
const CHOICES: usize = 64;
const TOUCHED: usize = 30;
const LOOKS: usize = 8;

/// One rider's queries of one tick, in model space.
pub struct Rider {
    /// The rider's body, with a radius of ten mean edge lengths.
    pub body: Sphere,
    /// The rider's foot, with a radius of one mean edge length.
    pub foot: Sphere,
    /// The ray from the centre of the body towards the skin.
    pub ray: Ray,
    /// How far to cast the ray: twice the body's radius.
    pub reach: f32,
    /// The point of the skin that the rider stands on.
    pub anchor: Anchor,
}

/// One tick: the pose, and the queries of all riders.
pub struct Tick {
    /// The pose. Model space is world space.
    pub palette: Palette,
    /// The riders, in the same order in every tick.
    pub riders: Vec<Rider>,
}

/// A giant with its ticks.
pub struct Workload {
    /// The giant's collider.
    pub mesh: Arc<ColliderMesh>,
    /// The ticks of the walk, from its beginning.
    pub ticks: Vec<Tick>,
}

impl Workload {
    /// A giant that walks for `ticks` ticks, with `riders` riders on it.
    ///
    /// The riders stand on seeded random points of the skin where their body fits at rest. A single
    /// rider takes the one of 64 such points where its body touches nearest to 30 triangles on average
    /// over the walk, so that riders on giants of different resolution do as much work.
    pub fn new(creature: &Creature, riders: usize, ticks: usize) -> Result<Self, SceneError> {
        let mesh = creature.rig.collider.clone();
        let mut surface = SkinnedSurface::new(mesh.clone());
        let edge = mean_edge(&mesh);
        let mut rng = fastrand::Rng::with_seed(4);
        surface.teleport(&creature.rest_palette()?, Similarity::IDENTITY)?;
        let mut seats = Vec::with_capacity(riders);
        let wanted = if riders == 1 { CHOICES } else { riders };
        while seats.len() < wanted {
            let triangle = TriangleId(rng.u32(0..mesh.triangles().len() as u32));
            let seat = surface.anchor(triangle, [0.5, 0.25, 0.25])?;
            if fits(&surface, &rider(&surface, &seat, edge)?.body) {
                seats.push(seat);
            }
        }
        let palette = |tick: usize| creature.palette("walk", tick as f64 / RATE);
        if riders == 1 {
            let mut hits = Vec::new();
            let mut touched = vec![0; seats.len()];
            for part in 0..LOOKS {
                surface.advance(&palette(part * ticks / LOOKS)?, Similarity::IDENTITY)?;
                for (seat, touched) in seats.iter().zip(&mut touched) {
                    let body = rider(&surface, seat, edge)?.body;
                    let body = Capsule::ball(body.center, body.radius).ok_or("no body")?;
                    surface.in_model().overlap_capsule(&body, &mut hits);
                    *touched += hits.len();
                }
            }
            let off = |seat: &usize| touched[*seat].abs_diff(TOUCHED * LOOKS);
            let best = (0..seats.len()).min_by_key(off);
            seats = best.map(|best| seats[best]).into_iter().collect();
        }
        let mut all = Vec::with_capacity(ticks);
        for tick in 0..ticks {
            let palette = palette(tick)?;
            surface.advance(&palette, Similarity::IDENTITY)?;
            let riders = seats.iter().map(|seat| rider(&surface, seat, edge));
            let riders = riders.collect::<Result<_, SceneError>>()?;
            all.push(Tick { palette, riders });
        }
        Ok(Self { mesh, ticks: all })
    }
}

/// True if no skin is much deeper in a rider's body than the point it stands on: the seat is not in a crease.
fn fits(surface: &SkinnedSurface, body: &Sphere) -> bool {
    let nearest = surface.in_model().closest_point(body.center, body.radius);
    nearest.is_none_or(|hit| hit.distance as f32 > body.radius * (1.0 - 1.5 * DEPTH))
}

fn rider(surface: &SkinnedSurface, seat: &Anchor, edge: f32) -> Result<Rider, SceneError> {
    let motion = surface.in_model().motion(seat, 1.0 / RATE)?;
    let above = |radius: f32| Sphere {
        center: motion.position + motion.normal * (radius * (1.0 - DEPTH)),
        radius,
    };
    let body = above(10.0 * edge);
    Ok(Rider {
        body,
        foot: above(edge),
        reach: 2.0 * body.radius,
        ray: Ray::new(body.center, -motion.normal).ok_or("a normal without length")?,
        anchor: *seat,
    })
}

/// Mean edge length of a mesh at rest, over the three edges of every triangle.
pub fn mean_edge(mesh: &ColliderMesh) -> f32 {
    let place = |v: VertexId| mesh.positions()[v.index()];
    let lengths = mesh.triangles().iter().flat_map(|&[a, b, c]| {
        [(a, b), (b, c), (c, a)].map(|(from, to)| f64::from(place(from).distance(place(to))))
    });
    let sum: f64 = lengths.sum();
    (sum / (3 * mesh.triangles().len()) as f64) as f32
}
