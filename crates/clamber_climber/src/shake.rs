use glam::DVec3;
pub struct Shake {
    pub acceleration: DVec3,
}
impl Shake {
    pub fn step(&mut self, dv: DVec3, tau: f64, dt: f64) {
        let k = libm::exp(-dt / tau);
        self.acceleration = self.acceleration * k + dv / dt * (1.0 - k);
    }
}
pub fn excess(a: &Shake, b: &Shake, th: f64, dt: f64) -> f64 {
    let f = |s: &Shake| (s.acceleration.length() - th).max(0.0);
    (f(a) + f(b)) * 0.5 * dt
}
