//! Overlays on the pictures of a battle.

use clamber::glam::DVec3;
use clamber::prelude::*;
use clamber::render::{Color, Image, Overlay, TextSize};
use clamber::rig::JointId;
use clamber_scenes::battle::{Battle, CREATURE, TICK};

use crate::options::OverlayKind;
use crate::report::skinned_share;

// Linear red, green, blue and opacity. From Okabe and Ito's colours, which colour-blind people can tell apart, and
// magenta.
const SKY_BLUE: Color = [0.09, 0.46, 0.82, 0.7];
const YELLOW: Color = [0.87, 0.6, 0.05, 0.9];
const VERMILION: Color = [0.67, 0.11, 0.0, 0.7];
const MAGENTA: Color = [1.0, 0.2, 0.8, 1.0];
const GREEN: Color = [0.1, 1.0, 0.3, 0.55];
const WHITE: Color = [1.0, 1.0, 1.0, 0.9];

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

/// Draws overlays. `way` is the path of the climber's centre.
pub(super) fn draw(
    kinds: &[OverlayKind],
    battle: &Battle<'_>,
    eye: DVec3,
    way: &[DVec3],
) -> Overlay {
    let mut pen = Pen {
        over: Overlay::default(),
        battle,
        eye,
    };
    for kind in kinds {
        match kind {
            OverlayKind::Joints => pen.joints(),
            OverlayKind::Contact => pen.contact(way),
            OverlayKind::Anchors => pen.anchors(),
            OverlayKind::Plan => pen.plan(),
            OverlayKind::Ways => pen.ways(),
            // Text is written after the picture is drawn.
            OverlayKind::State => {}
        }
    }
    pen.over
}

/// Writes the text onto a picture.
pub(super) fn write(kinds: &[OverlayKind], battle: &Battle<'_>, image: &mut Image) {
    if kinds.contains(&OverlayKind::State) {
        let size = [TextSize::Large, TextSize::Small][usize::from(image.height < 600)];
        image.text([16, 16], size, &state(battle));
    }
}

/// An overlay of a battle as seen by an eye.
struct Pen<'a> {
    over: Overlay,
    battle: &'a Battle<'a>,
    eye: DVec3,
}

impl Pen<'_> {
    /// Moves a point towards the eye by a share of the creature's height, at most by half of its distance. The point
    /// stays at the same pixel.
    fn near(&self, place: DVec3, share: f64) -> DVec3 {
        let way = place - self.eye;
        let by = share * self.battle.height / way.length();
        self.eye + way * (1.0 - by.min(0.5))
    }

    /// Draws a dot that has about the same size at any distance.
    fn dot(&mut self, at: DVec3, size: f64, color: Color) {
        let radius = (at - self.eye).length() * DOT * size;
        self.over.sphere(at, radius, 4.0, color);
    }

    fn joints(&mut self) {
        let root = self.battle.surface().world_from_model();
        let place = |pen: &Self, joint: JointId| {
            let frame = pen.battle.palette().model_from_joint(joint)?;
            Some(pen.near(root.transform_point(frame.translation), THROUGH))
        };
        for (index, joint) in (0..).zip(self.battle.creature.rig.skeleton.joints()) {
            let parent = joint.parent.and_then(|parent| place(self, parent));
            if let (Some(from), Some(to)) = (parent, place(self, JointId(index))) {
                self.over.line(from, to, 3.0, YELLOW);
                self.dot(to, 1.0, VERMILION);
            }
        }
    }

    fn contact(&mut self, way: &[DVec3]) {
        self.over.path(way, 2.5, WHITE);
        let triangle = own_point(self.battle).and_then(|point| point.triangle());
        if let Some([a, b, c]) = triangle.and_then(|triangle| self.posed(triangle)) {
            self.over.triangle([a, b, c], GREEN);
            self.over.path(&[a, b, c, a], 3.0, GREEN);
        }
    }

    /// A point in the middle of each part's list of triangles, and the climber's own point, with their velocities.
    fn anchors(&mut self) {
        let parts = self.battle.surface().mesh().parts().iter();
        let middles = parts.filter_map(|part| part.triangles.get(part.triangles.len() / 2));
        let points = middles.map(|triangle| MaterialPoint::on_triangle(*triangle, [1.0 / 3.0; 3]));
        let own = own_point(self.battle).map(|point| (point, 4.5, MAGENTA));
        for (point, width, color) in points.map(|point| (point, 3.0, SKY_BLUE)).chain(own) {
            if let Some(motion) = self.battle.surface().motion(&point, TICK) {
                let ends = [DVec3::ZERO, motion.velocity * ARROW];
                let [from, to] = ends.map(|end| self.near(motion.position + end, NEARER));
                self.over.arrow(from, to - from, width, color);
                self.dot(from, 1.0, color);
            }
        }
    }

    /// The way that the bot follows, as a line over the moving skin, with dots for rests and for the goal.
    fn plan(&mut self) {
        let Some((bot, goal, _)) = self.battle.bot() else {
            return;
        };
        let place = |pen: &Self, patch: usize| {
            let patch = &bot.graph().patches()[patch];
            let weights = patch.barycentric.map(|weight| weight as f32);
            let point = MaterialPoint::on_triangle(patch.triangle, weights);
            let motion = pen.battle.surface().motion(&point, TICK);
            let at = motion.map_or(patch.point, |motion| motion.position);
            pen.near(at, NEARER)
        };
        for patch in goal.patches() {
            self.dot(place(self, *patch), 0.8, MAGENTA);
        }
        let steps = bot.plan().map_or(&[][..], |plan| &plan.steps);
        let way: Vec<DVec3> = steps.iter().map(|step| place(self, step.patch)).collect();
        self.over.path(&way, 4.0, WHITE);
        for (pair, at) in steps.windows(2).zip(way) {
            // Two steps in one patch are a rest.
            if pair[0].patch == pair[1].patch {
                self.dot(at, 1.5, YELLOW);
            }
        }
    }

    /// The skin that faces the eye, coloured by the time from there to the bot's goal. Skin without a way stays bare.
    fn ways(&mut self) {
        let Some((bot, goal, _)) = self.battle.bot() else {
            return;
        };
        let count = self.battle.surface().mesh().triangles().len() as u32;
        for triangle in (0..count).map(TriangleId) {
            let patch = bot.graph().patch_of(triangle, [1.0 / 3.0; 3]);
            let seconds = patch.map_or(f64::INFINITY, |patch| goal.least_seconds_from(patch));
            let share = (seconds / LONG).min(1.0) as f32;
            let color = std::array::from_fn(|k| VERMILION[k] * (1.0 - share) + SKY_BLUE[k] * share);
            let corners = self.posed(triangle).filter(|_| seconds.is_finite());
            if let Some([a, b, c]) = corners
                && (b - a).cross(c - a).dot(self.eye - a) > 0.0
            {
                let corners = [a, b, c].map(|corner| self.near(corner, NEARER));
                self.over.triangle(corners, color);
            }
        }
    }

    /// The corners of a triangle in world space.
    fn posed(&self, triangle: TriangleId) -> Option<[DVec3; 3]> {
        let surface = self.battle.surface();
        let corners = surface.mesh().triangles().get(triangle.index())?;
        let [a, b, c] = corners.map(|vertex| surface.in_model().position(vertex));
        let root = surface.world_from_model();
        Some([a?, b?, c?].map(|corner| root.transform_point_f32(corner)))
    }
}

/// The climber's material point on the creature.
fn own_point(battle: &Battle<'_>) -> Option<MaterialPoint> {
    let support = battle.climber().state().support?.attachment;
    (support.obstacle == CREATURE).then_some(support.material)
}

/// The battle's state as text, one value a line.
fn state(battle: &Battle<'_>) -> String {
    let state = battle.climber().state();
    let motion = own_point(battle).and_then(|point| battle.surface().motion(&point, TICK));
    let speed = (state.velocity - motion.map_or(DVec3::ZERO, |motion| motion.velocity)).length();
    let share = 100.0 * skinned_share(battle);
    // A share from 0 to 1 as a bar.
    let bar = |share: f64| format!("[{:<20}]", "#".repeat((share * 20.0).ceil() as usize));
    format!(
        "time     {:5.2} s, tick {}\nclimber  {:?}\nstamina  {}\nhealth   {}\nshake    {:5.2} m/s2\n\
         speed    {speed:5.2} m/s over the skin\nskinned  {share:5.1} % of vertices",
        battle.tick() as f64 * TICK,
        battle.tick(),
        state.mode,
        bar(state.stamina),
        bar(state.hit_points),
        state.shake.length(),
    )
}
