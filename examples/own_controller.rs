//! A custom character controller on the mover alone: it walks, jumps, falls, and rides the walking giant.
//!
//! Jolt and box3d have such a mover, too. All code above it is in this file: one struct, with one function for a tick.

use clamber::glam::DVec3;
use clamber::mover::{Ground, GroundProbe, Mover, MoverBody, MoverMemory, Path, StepUp, Walking};
use clamber::prelude::*;

/// Length of a tick, seconds.
const DT: f64 = 1.0 / 60.0;
/// Downward acceleration, metres a second squared.
const GRAVITY: f64 = 9.81;
/// Upward speed of a jump, metres a second.
const JUMP: f64 = 4.0;
/// The body: a ball with a radius of 0.4 m and a margin of 0.01 m.
const BODY: MoverBody = MoverBody::ball(0.4, 0.01);
/// Steepest slope that counts as ground, radians: 50 degrees.
const MAX_SLOPE: f64 = 0.87;
/// Highest step that the character climbs, metres.
const STEP_HEIGHT: f64 = 0.3;
/// Distance below the feet within which a walking character finds the ground, metres.
const SNAP: f64 = 0.2;
/// Largest distance of a material point from its stored position, metres: more than rounding, too little to be seen.
const SLACK: f64 = 0.01;

/// Tick of the run below in which the player jumps.
const JUMP_TICK: u32 = 360;

struct Controller {
    position: DVec3,
    velocity: DVec3,
    /// Velocity of the ground; in the air, the velocity of the last ground. The player's own motion is relative to it.
    base: DVec3,
    /// The point of the ground under the player; `None` in the air.
    ground: Option<Attachment>,
    memory: MoverMemory,
    /// Deepest penetration of the core into any obstacle so far, metres.
    deepest: f64,
}

impl Controller {
    /// Starts in the air, at rest.
    fn at(position: DVec3) -> Self {
        Self {
            position,
            velocity: DVec3::ZERO,
            base: DVec3::ZERO,
            ground: None,
            memory: MoverMemory::default(),
            deepest: 0.0,
        }
    }

    /// Makes one tick. `walk` is a level velocity over the ground.
    fn step(
        &mut self,
        walk: DVec3,
        jumps: bool,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
    ) -> Result<(), Box<dyn std::error::Error>> {
        let mut memory = std::mem::take(&mut self.memory);
        let mut mover = Mover::new(obstacles, DT, &mut memory)?;
        let carried = self.be_carried(&mover);
        match carried {
            Some(place) if !jumps => self.walk(&mut mover, place, walk),
            _ => {
                if carried.is_some() {
                    self.velocity = self.base + walk + DVec3::Y * JUMP;
                    self.ground = None;
                }
                self.fly(&mut mover);
            }
        }
        self.memory = memory;
        Ok(())
    }

    /// The position to which the ground carries the player by the end of the tick; `None` in the air, or if the ground
    /// is gone.
    fn be_carried(&mut self, mover: &Mover<'_>) -> Option<DVec3> {
        let mut ground = self.ground.take()?;
        let followed = ground.follow(mover.obstacle(ground.obstacle)?, DT, SLACK)?;
        self.base = followed.motion.velocity;
        self.ground = Some(ground);
        Some(ground.position())
    }

    fn walk(&mut self, mover: &mut Mover<'_>, place: DVec3, walk: DVec3) {
        let target = place + walk * DT;
        // The player walks on slopes up to the limit; steeper slopes are walls.
        let walking = Some(Walking {
            up: DVec3::Y,
            max_slope: MAX_SLOPE,
        });
        let path = Path {
            walking,
            frame: place - self.position,
            ..Path::new(BODY, self.position, target)
        };
        let moved = mover.slide(&path);
        self.deepest = larger(self.deepest, moved.penetration);
        self.position = moved.position;
        self.velocity = mover.clip_velocity(self.base + walk, self.base, None);
        if walk == DVec3::ZERO {
            // The player stays on its material point, or on the point that it is pushed to.
            self.ground = self.ground.map(|ground| ground.moved_to(moved.position));
            return;
        }
        let over_step = mover.step_up(&StepUp {
            probe: probe(STEP_HEIGHT),
            from: place,
            target,
            position: moved.position,
        });
        self.position = over_step.unwrap_or(moved.position);
        self.ground = None;
        if let Some(ground) = mover.find_ground(&probe(SNAP), self.position) {
            self.stand_on(mover, &ground);
        }
    }

    fn fly(&mut self, mover: &mut Mover<'_>) {
        let change = DVec3::NEG_Y * (GRAVITY * DT);
        let target = self.position + (self.velocity + change * 0.5) * DT;
        let path = Path {
            frame: self.base * DT,
            ..Path::new(BODY, self.position, target)
        };
        let moved = mover.slide(&path);
        self.deepest = larger(self.deepest, moved.penetration);
        self.position = moved.position;
        let falling = self.velocity + change;
        self.velocity = mover.clip_velocity(falling, self.base, None);
        if let Some(ground) = mover.find_ground(&probe(0.0), moved.position) {
            let approach = falling - mover.velocity_of(&ground.touch);
            if approach.dot(ground.touch.normal) < 0.0 {
                self.stand_on(mover, &ground);
            }
        }
    }

    fn stand_on(&mut self, mover: &Mover<'_>, ground: &Ground) {
        self.position = ground.position;
        self.base = mover.velocity_of(&ground.touch);
        self.ground = Some(mover.attach(&ground.touch, ground.position));
    }
}

fn probe(reach: f64) -> GroundProbe {
    GroundProbe {
        body: BODY,
        up: DVec3::Y,
        max_slope: MAX_SLOPE,
        reach,
    }
}

/// The larger of two numbers; NaN if one of them is NaN, which `f64::max` ignores.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let giant = clamber::gltf::load("assets/colossus.glb")?.rig;
    let clip = giant.clip("walk").ok_or("no walk")?;
    let rest = giant.skeleton.rest_pose();
    let pace = DVec3::Z * clip.ground_speed().ok_or("no speed")?;
    let mut skin = SkinnedSurface::new(giant.collider.clone());
    // The player starts above the back, as fast as the giant.
    let mut player = Controller::at(DVec3::new(0.0, 36.0, -2.0));
    (player.velocity, player.base) = (pace, pace);
    let (mut rode, mut drift, mut walked, mut nearest) = (0, 0.0f64, 0.0, f64::INFINITY);
    let (mut jump_from, mut jump_height) = (DVec3::ZERO, 0.0f64);
    for tick in 0..540_u32 {
        let time = f64::from(tick) * DT;
        let palette = giant
            .skeleton
            .palette(&clip.sample(&rest, time, Playback::Loop)?)?;
        let place = Similarity::from_translation(pace * time);
        match tick {
            0 => skin.teleport(&palette, place)?,
            _ => skin.advance(&palette, place)?,
        }
        let (walk, jumps) = match tick {
            120..240 => (DVec3::Z, false),
            JUMP_TICK => (DVec3::ZERO, true),
            _ => (DVec3::ZERO, false),
        };
        let (ground, start) = (player.ground, player.position);
        player.step(walk, jumps, &[(ObstacleId(1), &skin)])?;

        // The player's way over the skin: the distance from the place to which the skin alone would have carried it.
        if let (Some(mut ground), Some(_)) = (ground, player.ground) {
            ground.follow(&skin, DT, SLACK).ok_or("the skin is gone")?;
            let went = player.position.distance(ground.position());
            rode += 1;
            if walk != DVec3::ZERO {
                walked += went;
            } else if tick < JUMP_TICK {
                // Only before the jump: the player then lands in a fold of the shoulder, which may push it by
                // millimetres.
                drift = larger(drift, went);
            }
        }
        // The height of the jump, relative to the motion of the skin that the player left.
        if jumps {
            jump_from = start;
        }
        if tick >= JUMP_TICK && player.ground.is_none() {
            let left = jump_from + player.base * (f64::from(tick - JUMP_TICK + 1) * DT);
            jump_height = larger(jump_height, (player.position - left).y);
        }
        let skin_is: &dyn Obstacle = &skin;
        let closest = skin_is
            .closest_point(player.position, 100.0)
            .ok_or("no skin")?;
        nearest = nearest.min(closest.distance);
    }
    let height = JUMP * JUMP / (2.0 * GRAVITY);
    println!(
        "rode for {:.1} s, drift {:.1e} m a tick",
        f64::from(rode) * DT,
        drift
    );
    println!("walked {walked:.2} m in 2 s");
    println!("jumped {jump_height:.3} m high, v^2/2g is {height:.3} m");
    println!(
        "nearest to the skin {nearest:.4} m, core in it by {:.1e} m",
        player.deepest
    );
    assert!(player.ground.is_some() && rode > 400, "fell off: {rode}");
    assert!(drift < 1e-5, "{drift}");
    assert!((walked - 2.0).abs() < 0.2, "{walked}");
    assert!((jump_height - height).abs() < 1e-3, "{jump_height}");
    assert!(
        nearest > BODY.core_radius() - 1e-4 && player.deepest < 1e-4,
        "{nearest}"
    );
    Ok(())
}
