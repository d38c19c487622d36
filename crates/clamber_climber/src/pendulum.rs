use glam::DVec3;
pub struct Pendulum {
    pub arm: DVec3,
    pub velocity: DVec3,
}
pub struct PendulumTick {
    pub length: f64,
    pub gravity: DVec3,
    pub pivot_change: DVec3,
    pub damping: f64,
    pub dt: f64,
}
impl Pendulum {
    pub fn step(&mut self, t: &PendulumTick) {
        self.velocity -= t.pivot_change;
        self.velocity += t.gravity * t.dt;
        let a = self.arm + self.velocity * t.dt;
        let l = a.length();
        self.arm = if l > t.length { a * (t.length / l) } else { a };
        if l > t.length {
            let n = self.arm.normalize();
            let o = self.velocity.dot(n);
            if o > 0.0 {
                self.velocity -= n * o;
            }
        }
        self.velocity *= libm::exp(-t.damping * t.dt);
    }
}
