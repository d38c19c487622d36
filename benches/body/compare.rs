//! Compares the body with inverse kinematics alone, on climbs.
//!
//! Game engines offer this alternative: a clip plays, the model is a child of the climber, and a two-bone solver brings
//! each hand and foot to a place that the game names. Here the places are those that the body chose, and the time of
//! choosing them is not charged to the alternative. The model's offset from the climber is the mean of the body's
//! offsets over the climb, one mean for holding and one for hanging, and it turns as the body does. **Hard** reaches as
//! far as the bones do. **Soft** slows down from 97 % of the limb's length on, so that elbows do not snap, and keeps
//! the bend directions of elbows and knees in a pole memory.

use std::error::Error;
use std::time::Instant;

use clamber::animation::ik::{PoleMemory, TwoBoneGoal, aim};
use clamber::animation::joint_in_model;
use clamber::body::{Body, BodyClip, BodyInput, Extremity, Figure, Limb};
use clamber::climber::ClimberMode;
use clamber::geometry::Similarity;
use clamber::rig::{Playback, Pose};
use clamber_scenes::bodies::{Scene, Stage};
use clamber_scenes::measure::{Cells, quantile};
use glam::{DAffine3, DVec3};

/// Length of a tick and of a frame, seconds.
const DT: f64 = 1.0 / 60.0;

/// Time at the start of a climb that is not measured, seconds: the climber settles.
const SETTLES: f64 = 1.5;

/// The goal of a limb in a frame of a climb, in world space.
#[derive(Clone, Copy)]
struct Asked {
    /// Position and rotation of the hand or foot.
    end: DAffine3,
    /// If the limb holds something: the held point in world space, and the point of the hand or foot that should touch
    /// it, in the space of `end`.
    held: Option<(DVec3, DVec3)>,
}

/// A frame of a climb.
struct Frame {
    time: f64,
    hangs: bool,
    /// Position of the climber.
    position: DVec3,
    root: Similarity,
    limbs: [Asked; 4],
}

/// Measurements of a climb by one method.
#[derive(Default)]
struct Shown {
    micros: Vec<f64>,
    /// Distances of hands and of feet from their holds, metres.
    errors: [Vec<f64>; 2],
    /// Angular speeds of elbows and knees, radians a second.
    rates: Vec<f64>,
    angles: Option<[f64; 4]>,
}

/// Compares three methods on each climb: hard IK, soft IK, and the body.
pub(crate) fn compare(
    climbs: &[Scene],
    figure: &Figure,
    most: u32,
    cells: &mut Cells,
) -> Result<(), Box<dyn Error>> {
    let names = ["hard IK", "soft IK", "clamber's body"];
    for climb in climbs {
        let (frames, ours) = watch(climb, figure, most)?;
        let hard = alone(&frames, figure, 1.0)?;
        let soft = alone(&frames, figure, 0.97)?;
        for (method, mut shown) in names.iter().zip([hard, soft, ours]) {
            let mut rows = cells.of(format!("{}, {method}", climb.name));
            rows.value("us a frame", quantile(&mut shown.micros, 0.5));
            for (part, errors) in ["hands", "feet"].iter().zip(&mut shown.errors) {
                if errors.is_empty() {
                    continue;
                }
                for (what, share) in [("median", 0.5), ("99th percentile", 0.99)] {
                    let error = quantile(errors, share) * 1e3;
                    rows.value(&format!("{part} off their holds, {what}, mm"), error);
                }
            }
            let rate = quantile(&mut shown.rates, 0.999);
            rows.value("elbows and knees, 99.9 %, rad/s", rate);
        }
    }
    Ok(())
}

/// Plays a climb with the body; returns its frames and the body's measurements.
fn watch(climb: &Scene, figure: &Figure, most: u32) -> Result<(Vec<Frame>, Shown), Box<dyn Error>> {
    let mut stage = Stage::new(climb)?;
    let mut body = Body::new(figure);
    let (mut frames, mut shown) = (Vec::new(), Shown::default());
    for _ in 0..((climb.seconds / DT) as u32).min(most) {
        stage.tick(DT)?;
        let obstacles = stage.obstacles();
        let frame = BodyInput::new(&stage.climber, &obstacles);
        let start = Instant::now();
        body.update(figure, &frame, DT)?;
        let micros = start.elapsed().as_secs_f64() * 1e6;
        let state = stage.climber.state();
        if stage.time < SETTLES || !state.mode.is_holding() {
            shown.angles = None;
            continue;
        }
        let root = body.world_from_model();
        let mut limbs = Vec::new();
        for extremity in Extremity::ALL {
            let end = end_in_world(figure, &root, body.pose(), extremity)?;
            let touching = body.touching_point(figure, extremity).ok_or("no body")?;
            let hold = body.hold(extremity).map(|hold| hold.point);
            let held = hold.map(|hold| (hold, end.inverse().transform_point3(touching)));
            limbs.push(Asked { end, held });
        }
        let limbs = <[Asked; 4]>::try_from(limbs).map_err(|_| "not four limbs")?;
        shown.see(figure, &root, body.pose(), &limbs)?;
        shown.micros.push(micros);
        frames.push(Frame {
            time: stage.time,
            hangs: state.mode == ClimberMode::Hanging,
            position: state.position,
            root,
            limbs,
        });
    }
    Ok((frames, shown))
}

/// Shows the frames of a climb with inverse kinematics alone; `soft` is the share of the limb's length from which the
/// solver slows down, 1 for never.
fn alone(frames: &[Frame], figure: &Figure, soft: f64) -> Result<Shown, Box<dyn Error>> {
    // The model's mean offset from the climber, in the model's axes.
    let seen =
        |frame: &Frame| frame.root.rotation.conjugate() * (frame.root.translation - frame.position);
    let mean = |hangs: bool| {
        let alike = || frames.iter().filter(move |frame| frame.hangs == hangs);
        alike().map(seen).sum::<DVec3>() / alike().count().max(1) as f64
    };
    let offsets = [mean(false), mean(true)];
    let set = figure.animations();
    let find = |clip: BodyClip| set.find(clip.name()).ok_or("a clip is missing");
    let clips = [find(BodyClip::Climb)?, find(BodyClip::Hang)?];
    let mut pose = set.rest().clone();
    let mut poles: [PoleMemory; 4] = Default::default();
    let mut shown = Shown::default();
    let mut last = f64::NEG_INFINITY;
    for frame in frames {
        if frame.time - last > 1.5 * DT {
            (shown.angles, poles) = (None, Default::default());
        }
        last = frame.time;
        let kind = usize::from(frame.hangs);
        let root = Similarity {
            translation: frame.position + frame.root.rotation * offsets[kind],
            ..frame.root
        };
        let start = Instant::now();
        set.clip(clips[kind])?
            .sample_into(frame.time, Playback::Loop, &mut pose)?;
        for ((extremity, asked), pole) in Extremity::ALL.iter().zip(&frame.limbs).zip(&mut poles) {
            let pole = (soft < 1.0).then_some((pole, DT));
            reach(figure, &mut pose, &root, *extremity, &asked.end, soft, pole)?;
        }
        shown.micros.push(start.elapsed().as_secs_f64() * 1e6);
        shown.see(figure, &root, &pose, &frame.limbs)?;
    }
    Ok(shown)
}

fn reach(
    figure: &Figure,
    pose: &mut Pose,
    root: &Similarity,
    extremity: Extremity,
    end: &DAffine3,
    soft: f64,
    pole: Option<(&mut PoleMemory, f64)>,
) -> Result<(), Box<dyn Error>> {
    let skeleton = figure.skeleton();
    let limb = limb_of(figure, extremity);
    let goal = TwoBoneGoal {
        soft,
        ..TwoBoneGoal::reach(root.inverse_transform_point(end.translation))
    };
    limb.ik.solve(skeleton, pose, &goal, pole)?;
    let joint = limb.end.joint().ok_or("a limb without hand or foot")?;
    let model_from_end =
        [DVec3::Y, DVec3::X].map(|axis| root.rotation.conjugate() * (end.matrix3 * axis));
    Ok(aim(
        skeleton,
        pose,
        joint,
        [DVec3::Y, DVec3::X],
        model_from_end,
    )?)
}

impl Shown {
    /// Measures the hold errors and the joint rates of a pose.
    fn see(
        &mut self,
        figure: &Figure,
        root: &Similarity,
        pose: &Pose,
        limbs: &[Asked; 4],
    ) -> Result<(), Box<dyn Error>> {
        let mut angles = [0.0; 4];
        for (index, (extremity, asked)) in Extremity::ALL.iter().zip(limbs).enumerate() {
            let end = end_in_world(figure, root, pose, *extremity)?;
            if let Some((hold, touching)) = asked.held {
                let errors = &mut self.errors[usize::from(!extremity.is_hand())];
                errors.push(end.transform_point3(touching).distance(hold));
            }
            let limb = limb_of(figure, *extremity);
            let at = |joint| {
                let placed = joint_in_model(figure.skeleton(), pose, joint);
                placed
                    .map(|placed| placed.translation)
                    .ok_or("no such joint")
            };
            let [upper, lower] = [at(limb.upper)?, at(limb.lower)?];
            let hand = limb.ik.end(figure.skeleton(), pose)?;
            angles[index] = between(upper - lower, hand - lower);
        }
        if let Some(before) = self.angles {
            let rates = angles
                .iter()
                .zip(before)
                .map(|(now, was)| (now - was).abs() / DT);
            self.rates.extend(rates);
        }
        self.angles = Some(angles);
        Ok(())
    }
}

fn limb_of(figure: &Figure, extremity: Extremity) -> &Limb {
    match extremity {
        Extremity::Hand(side) => figure.humanoid().arm(side),
        Extremity::Foot(side) => figure.humanoid().leg(side),
    }
}

/// The world-space transform of a hand or foot.
fn end_in_world(
    figure: &Figure,
    root: &Similarity,
    pose: &Pose,
    extremity: Extremity,
) -> Result<DAffine3, Box<dyn Error>> {
    let joint = limb_of(figure, extremity).end.joint();
    let joint = joint.ok_or("a limb without hand or foot")?;
    let placed = joint_in_model(figure.skeleton(), pose, joint).ok_or("no such joint")?;
    Ok(DAffine3::from_mat3_translation(
        glam::DMat3::from_quat(root.rotation) * placed.matrix3,
        root.transform_point(placed.translation),
    ))
}

/// The angle between two vectors, radians.
fn between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}
