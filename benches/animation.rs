//! Measures animation and inverse kinematics, compared with sampling one clip and composing its palette.
//!
//! The model is the hero, whose skeleton has 43 joints. All contenders take turns, a hundred frames each, on one
//! thread. A time is the median of the means over a hundred frames.
//!
//! - An animator with one layer, with three layers, and with one layer that fades; and the change of a clip itself.
//! - The body: four limbs that reach for moving points, and a look-at over head, neck and chest.
//!
//! Prints a table and writes it to `target/measure/animation.csv`: name, value, bound, holds.
//!
//! Run it with `cargo bench -p clamber_benches --bench animation`; briefly with `-- --test`.

use std::error::Error;
use std::process::ExitCode;

use clamber::animation::ik::{LookAt, LookMemory, PoleMemory, TwoBoneGoal};
use clamber::animation::{AnimationSet, Animator, ClipId, Layer, LayerKind, PoseBuffers};
use clamber::mesh::Rig;
use clamber::rig::{Palette, Playback, Pose};
use clamber_body::Humanoid;
use clamber_scenes::measure::{Bound, Cells, exit_code, is_brief, mean_us, quantile};
use glam::DVec3;

/// Frames over which a time is averaged.
const FRAMES: u32 = 100;

/// Length of a frame, seconds.
const DT: f64 = 1.0 / 60.0;

fn main() -> ExitCode {
    exit_code(run(is_brief()))
}

fn run(brief: bool) -> Result<(), Box<dyn Error>> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/hero.glb");
    let rig = clamber::gltf::load(file)?.rig;
    let set = AnimationSet::new(&rig.skeleton, rig.clips.clone())?;
    let find = |name: &str| set.find(name).ok_or("no such clip");
    let (walk, run) = (find("walk")?, find("run")?);
    let clip = set.clip(walk)?;

    let (mut pose, mut palette) = (rig.skeleton.rest_pose(), Palette::default());
    let mut time = 0.0;
    let mut sampling = || {
        time += DT;
        clip.sample_into(time, Playback::Loop, &mut pose)?;
        rig.skeleton.palette_into(&pose, &mut palette)
    };
    let one = vec![Layer::new(walk)];
    let three = vec![
        Layer::new(walk),
        Layer {
            weight: 0.5,
            ..Layer::new(run)
        },
        Layer {
            weight: 0.5,
            kind: LayerKind::Additive,
            ..Layer::new(run)
        },
    ];
    let mut plain = Player::new(one.clone());
    let mut layered = Player::new(three);
    let mut fading = Player::new(one.clone());
    let mut changing = Player::new(one);
    let mut body = Body::new(&rig)?;
    let mut times: [Vec<f64>; 6] = Default::default();
    for round in 0..if brief { 3 } else { 300 } {
        times[0].push(mean_us(FRAMES, |_| Ok(sampling()?))?);
        times[1].push(mean_us(FRAMES, |_| plain.frame(&set))?);
        times[2].push(mean_us(FRAMES, |_| layered.frame(&set))?);
        let to = if round % 2 == 0 { run } else { walk };
        fading.change(&set, to)?;
        times[3].push(mean_us(FRAMES, |_| fading.frame(&set))?);
        times[4].push(mean_us(FRAMES, |frame| {
            changing.change(&set, if frame % 2 == 0 { run } else { walk })
        })?);
        times[5].push(mean_us(FRAMES, |frame| body.solve(&rig, frame))?);
    }
    let [sampling, plain, layered, fading, changing, body] =
        times.map(|mut times| quantile(&mut times, 0.5));
    let mut cells = Cells::default();
    cells.value("one clip sampled and its palette composed, us", sampling);
    cells.value("an animator with one layer, us", plain);
    cells.value(
        "an animator with three layers, one of them additive, us",
        layered,
    );
    cells.value("an animator with one layer that fades, us", fading);
    cells.value("a change of clip, us", changing);
    cells.value("the body: four limbs and a look-at, us", body);
    let name = "the body / one clip sampled and its palette composed";
    cells.push(name, body / sampling, Bound::Most(1.0));
    cells.finish("animation", brief)
}

struct Player {
    animator: Animator,
    pose: Pose,
    buffers: PoseBuffers,
}

impl Player {
    fn new(layers: Vec<Layer>) -> Self {
        Self {
            animator: Animator::new(layers),
            pose: Pose::default(),
            buffers: PoseBuffers::default(),
        }
    }

    fn frame(&mut self, set: &AnimationSet) -> Result<(), Box<dyn Error>> {
        self.animator.advance(set, DT, &mut Vec::new())?;
        self.animator
            .pose_into(set, &mut self.pose, &mut self.buffers)?;
        Ok(())
    }

    /// Starts a fade to another clip. It takes 10 s, longer than the frames that are measured after it.
    fn change(&mut self, set: &AnimationSet, to: ClipId) -> Result<(), Box<dyn Error>> {
        Ok(self.animator.play(set, 0, to, 10.0)?)
    }
}

/// A body whose hands, feet and gaze follow moving points.
struct Body {
    body: Humanoid,
    look: LookAt,
    ends: Vec<DVec3>,
    poles: [PoleMemory; 4],
    gaze: LookMemory,
    walk: Pose,
    pose: Pose,
}

impl Body {
    fn new(rig: &Rig) -> Result<Self, Box<dyn Error>> {
        let body = Humanoid::find(&rig.skeleton)?;
        let chain = [
            (body.head, 0.6),
            (*body.neck.first().ok_or("no neck")?, 0.5),
            (body.chest(), 1.0),
        ];
        let eye = DVec3::new(0.0, 0.1, 0.1);
        let look = LookAt::new(&rig.skeleton, &chain, eye, DVec3::Z, DVec3::Y)?;
        let walk = rig.clip("walk").ok_or("no walk")?;
        let walk = walk.sample(&rig.skeleton.rest_pose(), 0.3, Playback::Loop)?;
        let limbs = body.arms.iter().chain(&body.legs);
        let ends: Result<Vec<DVec3>, _> = limbs
            .map(|limb| limb.ik.end(&rig.skeleton, &walk))
            .collect();
        Ok(Self {
            look,
            ends: ends?,
            poles: Default::default(),
            gaze: LookMemory::default(),
            pose: walk.clone(),
            walk,
            body,
        })
    }

    fn solve(&mut self, rig: &Rig, frame: u32) -> Result<(), Box<dyn Error>> {
        self.pose.transforms.clone_from(&self.walk.transforms);
        let sway = f64::from(frame) * 1e-3;
        let target = DVec3::new(1.0 - sway, 1.5, 4.0);
        let (skeleton, pose) = (&rig.skeleton, &mut self.pose);
        self.look
            .solve(skeleton, pose, target, 1.0, &mut self.gaze, DT)?;
        let limbs = self.body.arms.iter().chain(&self.body.legs);
        for ((limb, end), pole) in limbs.zip(&self.ends).zip(&mut self.poles) {
            let goal = TwoBoneGoal::reach(*end + DVec3::new(sway, 0.05, 0.0));
            limb.ik.solve(skeleton, pose, &goal, Some((pole, DT)))?;
        }
        Ok(())
    }
}
