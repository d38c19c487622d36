//! Overlays on the pictures of a battle.

use clamber::glam::DVec3;
use clamber::prelude::*;
use clamber::render::{Color, Image, Overlay, TextSize};
use clamber::rig::JointId;
use clamber_navigation::Footing;
use clamber_scenes::battle::{Battle, CREATURE, TICK};

use crate::options::OverlayKind;

// From Okabe and Ito's colours, which colour-blind people can tell apart, and white and magenta: linear red, green, blue
// and opacity.
const SKY_BLUE: Color = [0.09, 0.46, 0.82, 1.0];
const YELLOW: Color = [0.87, 0.78, 0.05, 1.0];
const VERMILION: Color = [0.67, 0.11, 0.0, 1.0];
const MAGENTA: Color = [1.0, 0.2, 0.8, 1.0];
const WHITE: Color = [1.0; 4];

/// Number of points of the climber's path that are drawn.
const WAY: usize = 90;

/// Length of a velocity's arrow: metres per metre a second.
const ARROW: f64 = 0.5;

/// Radius of a dot, as a share of its distance from the eye: about 4 pixels at 720 rows.
const DOT: f64 = 0.005;

/// Distance by which overlays on the skin are drawn nearer to the eye, as a share of the creature's height: visible fur
/// and stone reach that far beyond the collider.
const NEARER: f64 = 0.02;

/// The same for joints, which must be visible through the skin.
const THROUGH: f64 = 0.25;

/// Time to the goal at which skin is fully blue, seconds; longer times get the same colour.
const LONG: f64 = 30.0;

/// The selected kinds of overlays, and their data from earlier ticks.
pub(super) struct Overlays {
    kinds: Vec<OverlayKind>,
    /// Height of the creature, metres.
    height: f64,
    /// The climber's path, at the centre of its ball.
    way: Vec<DVec3>,
}

/// An overlay, and the eye towards which it is drawn nearer.
struct Pen {
    over: Overlay,
    eye: DVec3,
    nearer: f64,
}

impl Overlays {
    pub(super) fn new(kinds: &[OverlayKind], height: f64) -> Self {
        Self {
            kinds: kinds.to_vec(),
            height,
            way: Vec::new(),
        }
    }

    /// Takes in a tick. Call it before the first tick and after every one.
    pub(super) fn watch(&mut self, battle: &Battle<'_>) {
        self.way.push(battle.climber().state().position);
        if self.way.len() > WAY {
            self.way.remove(0);
        }
    }

    pub(super) fn draw(&self, battle: &Battle<'_>, eye: DVec3) -> Overlay {
        let mut pen = Pen {
            over: Overlay::default(),
            eye,
            nearer: NEARER * self.height,
        };
        for kind in &self.kinds {
            match kind {
                OverlayKind::Joints => pen.joints(battle, THROUGH * self.height),
                OverlayKind::Contact => pen.contact(battle, &self.way),
                OverlayKind::Anchors => pen.anchors(battle),
                OverlayKind::Plan => pen.plan(battle),
                OverlayKind::Ways => pen.ways(battle),
                // Text is written after the picture is drawn.
                OverlayKind::State => {}
            }
        }
        pen.over
    }

    /// Writes the text onto the picture.
    pub(super) fn write(&self, battle: &Battle<'_>, image: &mut Image) {
        if self.kinds.contains(&OverlayKind::State) {
            let size = if image.height < 600 {
                TextSize::Small
            } else {
                TextSize::Large
            };
            image.text([16, 16], size, &state(battle));
        }
    }
}

impl Pen {
    /// Moves a point towards the eye by `by` metres, at most by half of its distance. The point stays at the same pixel.
    fn near(&self, place: DVec3, by: f64) -> DVec3 {
        let distance = (place - self.eye).length();
        self.eye + (place - self.eye) * (1.0 - (by / distance).min(0.5))
    }

    /// Draws a dot that has about the same size at any distance.
    fn dot(&mut self, at: DVec3, size: f64, color: Color) {
        let radius = (at - self.eye).length() * DOT * size;
        for side in 0..8u32 {
            let sign = |bit: u32| {
                if side >> bit & 1 == 0 {
                    radius
                } else {
                    -radius
                }
            };
            let tips = [DVec3::X * sign(0), DVec3::Y * sign(1), DVec3::Z * sign(2)];
            self.over.triangle(tips.map(|tip| at + tip), color);
        }
    }

    fn joints(&mut self, battle: &Battle<'_>, by: f64) {
        let root = battle.surface().world_from_model();
        let place = |joint: JointId| {
            let frame = battle.palette().model_from_joint(joint)?;
            Some(root.transform_point(frame.translation))
        };
        for (index, joint) in (0..).zip(battle.creature().skeleton.joints()) {
            let Some(at) = place(JointId(index)).map(|at| self.near(at, by)) else {
                continue;
            };
            if let Some(parent) = joint.parent.and_then(place) {
                self.over
                    .line(self.near(parent, by), at, 3.0, [1.0, 0.75, 0.1, 0.9]);
            }
            self.dot(at, 1.0, VERMILION);
        }
    }

    fn contact(&mut self, battle: &Battle<'_>, way: &[DVec3]) {
        let config = battle.climber().config();
        let feet = config.up() * config.body.radius;
        let way: Vec<DVec3> = way.iter().map(|place| *place - feet).collect();
        self.over.path(&way, 2.5, [1.0, 1.0, 1.0, 0.8]);
        let support = battle.climber().state().support;
        let Some(support) = support.filter(|support| support.attachment.obstacle == CREATURE)
        else {
            return;
        };
        let triangle = support.attachment.material.triangle();
        if let Some([a, b, c]) = triangle.and_then(|triangle| posed(battle.surface(), triangle)) {
            self.over.triangle([a, b, c], [0.1, 1.0, 0.3, 0.55]);
            self.over.path(&[a, b, c, a], 3.0, [0.1, 1.0, 0.3, 1.0]);
        }
        self.over
            .sphere(support.attachment.point, 0.08, 2.0, [1.0, 0.1, 0.1, 1.0]);
    }

    /// A point in the middle of each part's list of triangles, and the climber's own point, with their velocities.
    fn anchors(&mut self, battle: &Battle<'_>) {
        let parts = battle.surface().mesh().parts().iter();
        let middles = parts.filter_map(|part| part.triangles.get(part.triangles.len() / 2));
        let points = middles.map(|triangle| MaterialPoint::on_triangle(*triangle, [1.0 / 3.0; 3]));
        let support = battle.climber().state().support;
        let support = support.filter(|support| support.attachment.obstacle == CREATURE);
        let own = support.map(|support| (support.attachment.material, 4.5, MAGENTA));
        for (point, width, color) in points.map(|point| (point, 3.0, SKY_BLUE)).chain(own) {
            let Some(motion) = battle.surface().motion(&point, TICK) else {
                continue;
            };
            let ends = [DVec3::ZERO, motion.velocity * ARROW];
            let [from, to] = ends.map(|along| self.near(motion.position + along, self.nearer));
            self.over.arrow(from, to - from, width, color);
            self.dot(from, f64::from(width) / 3.0, color);
        }
    }

    /// The way that the bot follows, as a line over the moving skin, with dots for rests and for the goal.
    fn plan(&mut self, battle: &Battle<'_>) {
        let Some((bot, goal, _)) = battle.bot() else {
            return;
        };
        let place = |pen: &Self, patch: usize| {
            let patch = &bot.graph().patches()[patch];
            let point = MaterialPoint::on_triangle(
                patch.triangle,
                patch.barycentric.map(|weight| weight as f32),
            );
            let motion = battle.surface().motion(&point, TICK);
            pen.near(
                motion.map_or(patch.point, |motion| motion.position),
                pen.nearer,
            )
        };
        for patch in goal.patches() {
            self.dot(place(self, *patch), 0.8, MAGENTA);
        }
        let Some(plan) = bot.plan() else {
            return;
        };
        let way: Vec<DVec3> = plan
            .steps
            .iter()
            .map(|step| place(self, step.patch))
            .collect();
        self.over.path(&way, 4.0, WHITE);
        for (pair, at) in plan.steps.windows(2).zip(way) {
            let stands = pair.iter().all(|step| step.footing == Footing::Stands);
            if stands && pair[0].patch == pair[1].patch {
                self.dot(at, 1.5, YELLOW);
            }
        }
    }

    /// The skin that faces the eye, coloured by the time from there to the bot's goal. Skin without a way stays bare.
    fn ways(&mut self, battle: &Battle<'_>) {
        let Some((bot, goal, _)) = battle.bot() else {
            return;
        };
        let triangles = battle.surface().mesh().triangles().len() as u32;
        for triangle in (0..triangles).map(TriangleId) {
            let patch = bot.graph().patch_of(triangle, [1.0 / 3.0; 3]);
            let seconds = patch.map_or(f64::INFINITY, |patch| goal.least_seconds_from(patch));
            let Some([a, b, c]) = posed(battle.surface(), triangle).filter(|_| seconds.is_finite())
            else {
                continue;
            };
            if (b - a).cross(c - a).dot(self.eye - a) > 0.0 {
                let share = (seconds / LONG).min(1.0) as f32;
                let color: [f32; 3] =
                    std::array::from_fn(|k| VERMILION[k] + (SKY_BLUE[k] - VERMILION[k]) * share);
                let corners = [a, b, c].map(|corner| self.near(corner, self.nearer));
                self.over
                    .triangle(corners, [color[0], color[1], color[2], 0.7]);
            }
        }
    }
}

/// The corners of a triangle in world space.
fn posed(surface: &SkinnedSurface, triangle: TriangleId) -> Option<[DVec3; 3]> {
    let corners = surface.mesh().triangles().get(triangle.index())?;
    let [a, b, c] = corners.map(|vertex| surface.in_model().position(vertex));
    let root = surface.world_from_model();
    Some([a?, b?, c?].map(|corner| root.transform_point_f32(corner)))
}

/// The battle's state as text, one value a line.
fn state(battle: &Battle<'_>) -> String {
    let state = battle.climber().state();
    let on = state.support.map(|support| support.attachment);
    let on = on.filter(|on| on.obstacle == CREATURE);
    let motion = on.and_then(|on| battle.surface().motion(&on.material, TICK));
    let skin = motion.map_or(DVec3::ZERO, |motion| motion.velocity);
    let skinned = battle.skinned();
    let share = 100.0 * skinned.vertices_skinned as f64 / skinned.vertices.max(1) as f64;
    format!(
        "time     {:5.2} s, tick {}\nclimber  {:?}\nstamina  {}\nhealth   {}\nshake    {:5.2} m/s2\n\
         speed    {:5.2} m/s over the skin\nskin     {:5.2} m/s\nskinned  {share:5.1} % of vertices",
        battle.tick() as f64 * TICK,
        battle.tick(),
        state.mode,
        bar(state.stamina),
        bar(state.hit_points),
        state.shake.length(),
        (state.velocity - skin).length(),
        skin.length(),
    )
}

/// A share from 0 to 1 as a bar of text.
fn bar(share: f64) -> String {
    let full = (share * 20.0).ceil() as usize;
    format!("[{:<20}]", "#".repeat(full))
}
