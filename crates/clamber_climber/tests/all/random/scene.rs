use clamber_climber::{Climber, ClimberConfig, ClimberInput, Knockback, StepReport, StepRules};
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use clamber_surface::mesh::{SurfaceKind, SurfaceTag, TriangleId};
use clamber_surface::rig::{Clip, Playback, Skeleton};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

use crate::creature::{JOINTS, clip, ground, skeleton, tube};
use crate::input::IDLE;
use crate::scene::{DT, rest};

/// A tube that crawls over the ground, and a second one that flies around and into it.
pub(crate) struct Scene {
    pub(crate) rng: fastrand::Rng,
    skeleton: Skeleton,
    clip: Clip,
    tubes: [SkinnedSurface; 2],
    floor: SkinnedSurface,
    /// A table of 4 m, for climbers to hang from.
    block: SkinnedSurface,
    time: f64,
    /// Speed factor of the clip.
    haste: f64,
    config: ClimberConfig,
    start: DVec3,
    input: ClimberInput,
    /// The blow in this tick.
    knockback: Option<Knockback>,
}

impl Scene {
    pub(crate) fn new(seed: u64) -> Self {
        let mut rng = fastrand::Rng::with_seed(seed);
        let mut tubes = [tube(), tube()].map(SkinnedSurface::new);
        let furry = rng.f64();
        for tube in &mut tubes {
            let count = tube.mesh().triangles().len() as u32;
            tube.edit(|edit| {
                for triangle in (0..count).map(TriangleId) {
                    let is_fur = rng.f64() < furry || triangle.0 % 7 < 3;
                    let kind = if is_fur {
                        SurfaceKind::Fur
                    } else {
                        SurfaceKind::Stone
                    };
                    edit.set_tag(triangle, SurfaceTag::new(kind)).unwrap();
                }
            });
        }
        let mut floor = SkinnedSurface::new(ground());
        let under = Similarity::from_translation(DVec3::Y * -3.0);
        floor.teleport(&rest(), under).unwrap();
        let mut block = SkinnedSurface::new(ground());
        let steep = Similarity {
            rotation: rotation_from_axis_angle(DVec3::Z, 0.3 * (rng.f64() - 0.5)),
            scale: 0.02,
            translation: DVec3::new(
                10.0 + 8.0 * rng.f64(),
                4.0 * rng.f64(),
                4.0 * rng.f64() - 2.0,
            ),
        };
        block.teleport(&rest(), steep).unwrap();
        let mut config = match rng.u32(0..4) {
            0 => ClimberConfig::walker(),
            _ => ClimberConfig::colossus_climber(),
        };
        if rng.bool() {
            config.tumble = None;
        }
        config.body.height = [0.0, 0.0, 0.9][rng.usize(0..3)];
        let haste = [0.1, 0.3, 1.0][rng.usize(0..3)];
        let mut scene = Self {
            rng,
            skeleton: skeleton(),
            clip: clip(),
            tubes,
            floor,
            block,
            time: 0.0,
            haste,
            config,
            start: DVec3::new(f64::from(JOINTS) * 0.9, 5.0, 0.2),
            input: IDLE,
            knockback: None,
        };
        if scene.rng.bool() {
            // The climber starts beside the table, about to catch its ledge.
            scene.start = steep.translation + DVec3::new(2.6, -0.3, 0.0);
            scene.input.walk = -DVec3::X;
            scene.input.grip = true;
        }
        scene.pose(true);
        scene
    }

    pub(crate) fn climber(&self) -> Climber {
        Climber::new(self.config, self.start).unwrap()
    }

    pub(crate) fn advance(&mut self) {
        self.time += DT;
        let is_placed = self.rng.u32(0..1000) == 0;
        if is_placed {
            self.time += 1.0;
        }
        self.pose(is_placed);
    }

    fn pose(&mut self, is_placed: bool) {
        let rest = self.skeleton.rest_pose();
        let places = [self.crawling(), self.flying()];
        for (index, (tube, place)) in self.tubes.iter_mut().zip(places).enumerate() {
            let time = self.time * self.haste + index as f64 * 0.7;
            let pose = self.clip.sample(&rest, time, Playback::Loop).unwrap();
            let palette = self.skeleton.palette(&pose).unwrap();
            if is_placed {
                tube.teleport(&palette, place).unwrap();
            } else {
                tube.advance(&palette, place).unwrap();
            }
        }
    }

    fn crawling(&self) -> Similarity {
        let time = self.time * self.haste;
        let turn = rotation_from_axis_angle(DVec3::Y, 0.2 * time);
        let roll = rotation_from_axis_angle(DVec3::X, 0.2 * libm::sin(2.0 * time));
        Similarity {
            rotation: turn * roll,
            scale: 2.0,
            translation: DVec3::X * (2.0 * time),
        }
    }

    fn flying(&self) -> Similarity {
        let time = self.time * self.haste;
        let turn = rotation_from_axis_angle(DVec3::new(0.6, 0.8, 0.0), 0.5 * time);
        let height = 6.0 + 4.0 * libm::sin(1.3 * time);
        Similarity {
            rotation: turn,
            scale: 1.0,
            translation: DVec3::new(10.0 + 2.0 * time, height, 3.0 * libm::sin(0.7 * time)),
        }
    }

    pub(crate) fn input(&mut self, climber: &Climber) -> ClimberInput {
        let rng = &mut self.rng;
        let mut direction = || {
            let mut one = || rng.f64() * 2.0 - 1.0;
            DVec3::new(one(), one(), one())
        };
        let (walk, climb) = (direction(), direction());
        if rng.u32(0..20) == 0 {
            self.input.walk = walk * f64::from(rng.u32(0..2));
            self.input.climb = climb * f64::from(rng.u32(0..2));
        }
        if rng.u32(0..60) == 0 {
            self.input.grip = rng.u32(0..3) > 0;
        }
        self.input.jump = rng.u32(0..90) == 0;
        self.knockback = (rng.u32(0..400) == 0).then(|| Knockback {
            by: None,
            velocity: walk * 6.0,
            damage: rng.f64() * 0.1,
        });
        // A climber that has gone too far walks back.
        let away = climber.state().position - self.tubes[0].world_from_model().translation;
        if away.length() > 60.0 {
            self.input.walk = -away.normalize();
        }
        self.input
    }

    fn obstacles(&self) -> [(ObstacleId, &dyn Obstacle); 4] {
        [
            (ObstacleId(7), &self.floor),
            (ObstacleId(1), &self.tubes[0]),
            (ObstacleId(2), &self.tubes[1]),
            (ObstacleId(4), &self.block),
        ]
    }

    pub(crate) fn step(&self, climber: &mut Climber, input: &ClimberInput) -> StepReport {
        let rules = StepRules {
            knockback: self.knockback,
            ..StepRules::default()
        };
        let step = climber.step_with(input, &self.obstacles(), &rules, DT);
        step.unwrap()
    }

    /// Depth of an obstacle in the climber's core, metres.
    pub(crate) fn depth(&self, climber: &Climber) -> f64 {
        let body = &climber.config().body;
        let core = climber.body().with_radius(body.radius - body.margin);
        let mut contacts = Vec::new();
        for (_, obstacle) in self.obstacles() {
            obstacle.overlap_capsule(&core, &mut contacts);
        }
        let depths = contacts
            .iter()
            .map(|contact| core.radius - contact.distance);
        depths.fold(0.0, f64::max)
    }
}
