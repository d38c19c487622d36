//! Overlays of the bot's plan.

use clamber::glam::DVec3;
use clamber::mesh::TriangleId;
use clamber::render::Overlay;
use clamber::world::MaterialPoint;
use clamber::world::Obstacle;
use clamber_navigation::{Footing, Patch, PlanStep};
use clamber_scenes::battle::{Battle, TICK};

use crate::colors::{MAGENTA, SKY_BLUE, VERMILION, WHITE, YELLOW, opaque, seen_through};
use crate::overlays::{dot, nearer, posed};

/// Time to the goal at which skin is fully blue, seconds; longer times get the same colour.
const LONG: f64 = 30.0;

/// Draws the way that the bot follows, as a line over the moving skin, with dots for rests and for the goal.
pub(crate) fn plan(over: &mut Overlay, battle: &Battle<'_>, eye: DVec3, by: f64) {
    let Some((bot, goal)) = battle.bot() else {
        return;
    };
    let patches = bot.graph().patches();
    let place = |patch: usize| nearer(place(battle, &patches[patch]), eye, by);
    for patch in goal.patches() {
        dot(over, place(*patch), eye, 0.8, MAGENTA);
    }
    let Some(plan) = bot.plan() else {
        return;
    };
    let way: Vec<DVec3> = plan.steps.iter().map(|step| place(step.patch)).collect();
    over.path(&way, 4.0, opaque(WHITE));
    let is_rest = |pair: &[PlanStep]| {
        pair.iter().all(|step| step.footing == Footing::Stands) && pair[0].patch == pair[1].patch
    };
    let pairs = plan.steps.windows(2);
    for rest in pairs.filter(|pair| is_rest(pair)) {
        dot(over, place(rest[0].patch), eye, 1.5, YELLOW);
    }
}

/// Colours the skin by the time from there to the bot's goal, from red to blue. Skin without a way to the goal stays
/// bare.
pub(crate) fn ways(over: &mut Overlay, battle: &Battle<'_>, eye: DVec3, by: f64) {
    let Some((bot, goal)) = battle.bot() else {
        return;
    };
    let graph = bot.graph();
    let triangles = battle.surface().mesh().triangles().len() as u32;
    for triangle in (0..triangles).map(TriangleId) {
        let patch = graph.patch_of(triangle, [1.0 / 3.0; 3]);
        let Some(seconds) = patch.map(|patch| goal.least_seconds_from(patch)) else {
            continue;
        };
        let Some([a, b, c]) = posed(battle.surface(), triangle) else {
            continue;
        };
        if !seconds.is_finite() || (b - a).cross(c - a).dot(eye - a) <= 0.0 {
            continue;
        }
        let share = (seconds / LONG).min(1.0) as f32;
        let color = std::array::from_fn(|k| VERMILION[k] + (SKY_BLUE[k] - VERMILION[k]) * share);
        let corners = [a, b, c].map(|corner| nearer(corner, eye, by));
        over.triangle(corners, seen_through(color, 0.7));
    }
}

/// The current position of a patch.
fn place(battle: &Battle<'_>, patch: &Patch) -> DVec3 {
    let weights = patch.barycentric.map(|weight| weight as f32);
    let point = MaterialPoint::on_triangle(patch.triangle, weights);
    let motion = battle.surface().motion(&point, TICK);
    motion.map_or(patch.point, |motion| motion.position)
}
