/// The same angle within half a turn.
pub(crate) fn nearest_turn(angle: f64) -> f64 {
    use core::f64::consts::TAU;
    angle - TAU * (angle / TAU).round()
}
