use clamber_body::{Body, BodyInput, Figure};
use clamber_scenes::bodies::{Scene, Stage};
use glam::DVec3;

/// Plays a scene with one frame per tick, and passes each frame to `see`.
pub(crate) fn play(
    scene: &Scene,
    figure: &Figure,
    rate: f64,
    mut see: impl FnMut(&Stage<'_>, &Body),
) {
    let mut stage = Stage::new(scene).unwrap();
    let mut body = Body::new(figure);
    let ticks = (scene.seconds * rate).round() as usize;
    for _ in 0..ticks {
        stage.tick(1.0 / rate).unwrap();
        let obstacles = stage.obstacles();
        body.update(
            figure,
            &BodyInput::new(&stage.climber, &obstacles),
            1.0 / rate,
        )
        .unwrap();
        drop(obstacles);
        see(&stage, &body);
    }
}

/// The place of a body's hips in the world.
pub(crate) fn hips(figure: &Figure, body: &Body) -> DVec3 {
    let hips = figure.humanoid().hips;
    let model = clamber_animation::joint_in_model(figure.skeleton(), body.pose(), hips);
    let place = model.unwrap().translation;
    body.world_from_model().transform_point(place)
}

/// The largest of values; 0 without values.
pub(crate) fn most(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// The quantile at `share` of values, which it sorts in ascending order. 0 without values.
pub(crate) fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    values
        .get((last as f64 * share).round() as usize)
        .copied()
        .unwrap_or(0.0)
}
