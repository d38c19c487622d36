//! Shows the joints that make a human body, as a table and as a drawing of the rest pose.

use std::fmt::Write as _;
use std::path::Path;

use clamber_body::{HumanJoint, Humanoid, Limb, LimbEnd, Side};
use clamber_gltf::Model;
use clamber_surface::rig::JointId;
use glam::DVec3;
use plotters::prelude::*;

use super::{InspectError, InspectOptions};

/// Prints the human body of a file, and draws it if `options.draw` is given. Returns false if the file has no human
/// body.
pub(super) fn print(model: &Model, options: &InspectOptions) -> Result<bool, InspectError> {
    println!("{}", options.file.display());
    let body = match Humanoid::find(&model.rig.skeleton) {
        Ok(body) => Some(body),
        Err(error) => {
            println!("  no human body: {error}");
            let joints = model.rig.skeleton.joints().iter();
            let names: Vec<&str> = joints.map(|joint| joint.name.as_str()).collect();
            println!("  its joints: {}", names.join(", "));
            None
        }
    };
    if let Some(body) = &body {
        print!("{}", table(model, body));
    }
    if let Some(file) = &options.draw {
        draw(model, body.as_ref(), file).map_err(|error| InspectError::Draw {
            file: file.clone(),
            error,
        })?;
        println!("  drawn in {}", file.display());
    }
    Ok(body.is_some())
}

/// The joints of the body, the lengths of its limbs and the direction that it faces, as text.
fn table(model: &Model, body: &Humanoid) -> String {
    let name = |joint: JointId| model.rig.skeleton.joints()[joint.index()].name.as_str();
    let mut text = String::new();
    let mut line = |what: &str, found: &str| {
        // Writing to a string does not fail.
        let _ = writeln!(text, "  {what:<18} {found}");
    };
    for (role, joint) in body.joints() {
        line(&role.to_string(), name(joint));
    }
    for side in Side::BOTH {
        let (arm, leg) = (body.arm(side), body.leg(side));
        let hand = HumanJoint::Hand(side).to_string();
        if let LimbEnd::Point(_) = arm.end {
            line(&hand, "no joint: in the middle of the palms");
        }
        if let LimbEnd::Beside(foot, _) = leg.end {
            let foot = format!("{} stands beside the leg", name(foot));
            line(&HumanJoint::Foot(side).to_string(), &foot);
        }
        let fingers = arm.fingers.iter().filter_map(|finger| finger.first());
        let fingers: Vec<&str> = fingers.map(|joint| name(*joint)).collect();
        if !fingers.is_empty() {
            line(&format!("{hand}'s fingers"), &fingers.join(", "));
        }
    }
    let length = |limbs: &[Limb; 2]| {
        let [left, right] = [&limbs[0], &limbs[1]].map(Limb::length);
        format!("{left:.3} m left, {right:.3} m right")
    };
    line("arms", &length(&body.arms));
    line("legs", &length(&body.legs));
    let DVec3 { x, z, .. } = body.facing;
    line("faces", &format!("{x:.2} 0 {z:.2}"));
    text
}

/// Width and height of the drawing, pixels.
const SIZE: (u32, u32) = (1200, 720);

/// Draws the skeleton at rest from the front and from its left. The labels are the roles of the body's joints, or the
/// names of all joints if there is no body.
fn draw(model: &Model, body: Option<&Humanoid>, file: &Path) -> Result<(), String> {
    let palette = model.rig.skeleton.palette(&model.rig.skeleton.rest_pose());
    let palette = palette.map_err(|error| error.to_string())?;
    let place = |joint: JointId| {
        let model = palette.model_from_joint(joint);
        model.map_or(DVec3::ZERO, |model| model.translation)
    };
    let all: Vec<DVec3> = (0..model.rig.skeleton.joints().len() as u32)
        .map(|joint| place(JointId(joint)))
        .collect();
    let facing = body.map_or(DVec3::Z, |body| body.facing);
    let left = DVec3::Y.cross(facing);
    let is_body = |joint| body.is_some_and(|body| body.role(joint).is_some());
    let named = labels(&model.rig, body);
    // The horizontal axes of the pictures. Seen from the front, its left is at the right; seen from its left, it faces
    // left.
    let views = [("from the front", left), ("from its left", -facing)];
    let area = SVGBackend::new(file, SIZE).into_drawing_area();
    let failed = |error: &dyn std::fmt::Display| error.to_string();
    area.fill(&WHITE).map_err(|error| failed(&error))?;
    for (half, (title, across)) in area.split_evenly((1, 2)).into_iter().zip(views) {
        let flat = |point: DVec3| (point.dot(across), point.y);
        let (low, high) = all.iter().fold(
            ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]),
            |(low, high), point| {
                let (x, y) = flat(*point);
                (
                    [low[0].min(x), low[1].min(y)],
                    [high[0].max(x), high[1].max(y)],
                )
            },
        );
        // The same scale for both axes, with a margin.
        let (pixels_x, pixels_y) = half.dim_in_pixel();
        let aspect = f64::from(pixels_x) / f64::from(pixels_y);
        let tall = (high[1] - low[1])
            .max((high[0] - low[0]) / aspect)
            .max(1e-6)
            * 1.15;
        let middle = [0, 1].map(|axis| (low[axis] + high[axis]) * 0.5);
        let range = |middle: f64, size: f64| middle - size * 0.5..middle + size * 0.5;
        let mut chart = ChartBuilder::on(&half)
            .caption(title, ("sans-serif", 18))
            .build_cartesian_2d(range(middle[0], tall * aspect), range(middle[1], tall))
            .map_err(|error| failed(&error))?;
        for (index, joint) in model.rig.skeleton.joints().iter().enumerate() {
            let Some(parent) = joint.parent else { continue };
            let child = JointId(index as u32);
            let color = if is_body(child) && is_body(parent) {
                BLUE.stroke_width(3)
            } else {
                BLACK.mix(0.3).stroke_width(1)
            };
            let bone = [flat(place(parent)), flat(place(child))];
            let bone = PathElement::new(bone, color);
            chart.draw_series([bone]).map_err(|error| failed(&error))?;
        }
        for (name, joint) in &named {
            let at = flat(place(*joint));
            let dot = Circle::new(at, 4, RED.filled());
            chart.draw_series([dot]).map_err(|error| failed(&error))?;
            // The view from the left does not label the joints of the right side, which are behind the left ones.
            let is_near = title == "from the front" || !name.starts_with("right ");
            if is_near {
                let text = Text::new(name.clone(), (7, -5), ("sans-serif", 12));
                let text = EmptyElement::at(at) + text;
                chart.draw_series([text]).map_err(|error| failed(&error))?;
            }
        }
    }
    area.present().map_err(|error| failed(&error))
}

/// The labels of the drawing: the roles of the body's joints, or the names of all joints if there is no body.
fn labels(rig: &clamber_surface::mesh::Rig, body: Option<&Humanoid>) -> Vec<(String, JointId)> {
    match body {
        Some(body) => {
            let joints = body.joints().into_iter();
            joints
                .map(|(role, joint)| (role.to_string(), joint))
                .collect()
        }
        None => {
            let joints = rig.skeleton.joints().iter().zip(0..);
            joints
                .map(|(joint, id)| (joint.name.clone(), JointId(id)))
                .collect()
        }
    }
}
