/// The same angle in the range from -π to π, radians.
pub(crate) fn nearest_turn(angle: f64) -> f64 {
    use core::f64::consts::TAU;
    angle - TAU * (angle / TAU).round()
}
