//! Goals of hands and feet while the body holds on: on walls, at ledges, and overhead.

use glam::DVec3;

use super::context::Context;
use super::hold::{Found, Hold};
use super::root::Root;
use super::stance::Stance;
use crate::Extremity;

/// Distance outside a wall's goal at which the ray for a hold begins, metres.
const WALL_RAY_START: f64 = 0.35;

/// Distance behind a wall's goal at which the ray for a hold ends, metres.
const WALL_RAY_END: f64 = 0.5;

/// Distance from a wall's goal within which a hold is looked for if the ray finds none, metres. Half of it at an edge.
const WALL_SEARCH_RADIUS: f64 = 0.4;

/// Height above a ledge's edge at which the ray for a hold begins, metres.
const LEDGE_RAY_START: f64 = 0.3;

/// Depth below a ledge's edge at which the ray for a hold ends, metres.
const LEDGE_RAY_END: f64 = 0.4;

/// Distance from an overhead goal within which a hold is looked for, metres.
const OVERHEAD_SEARCH_RADIUS: f64 = 0.35;

/// Least cosine between the normal at a ray's hit and the goal's outward direction.
const FACING_COSINE: f64 = 0.1;

/// Tangent of the angle by which fingers lean towards the middle of the body.
const FINGER_INWARD_TANGENT: f64 = 0.18;

/// Sine of the angle by which toes point up on a wall.
const TOES_UP_SINE: f64 = 0.28;

/// Distance of the toes' tips ahead of the ankle, as a multiple of the ball's distance.
const TOE_TIP_RATIO: f64 = 1.3;

/// The desired place of a hand or foot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal {
    /// The point to hold, in world space.
    pub(crate) point: DVec3,
    /// Unit vector out of the held surface.
    pub(crate) out: DVec3,
    /// Direction of the head.
    above: DVec3,
    /// Direction that the body faces.
    ahead: DVec3,
    /// The body's left for a left hand or foot, its right for a right one.
    pub(crate) aside: DVec3,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Wall,
    Edge,
    Overhead,
}

/// The goals of hands and feet; `None` for free ones.
pub(crate) fn goals(context: &Context<'_>, stance: Stance, root: &Root) -> [Option<Goal>; 4] {
    let figure = context.figure;
    let postures = figure.postures();
    let facing = figure.humanoid().facing;
    let [left, ahead, above] =
        [DVec3::Y.cross(facing), facing, DVec3::Y].map(|axis| root.rotation * axis);
    let Some(support) = &context.state.support else {
        return [None; 4];
    };
    let held = support.attachment.point;
    let goal = |extremity: Extremity, point: DVec3, out: DVec3, kind: Kind| {
        let aside = if extremity.index() & 1 == 0 {
            left
        } else {
            -left
        };
        Some(Goal {
            point,
            out,
            above,
            ahead,
            aside,
            kind,
        })
    };
    let sides = |width: f64| [left * width, left * -width];
    match stance {
        Stance::Wall => Extremity::ALL.map(|extremity| {
            goal(
                extremity,
                root.point(postures.wall[extremity.index()]),
                -ahead,
                Kind::Wall,
            )
        }),
        Stance::Hang => {
            let mut goals = [None; 4];
            let out = support.normal_in_world();
            for (index, side) in sides(postures.above_width.min(0.15 * context.size()))
                .into_iter()
                .enumerate()
            {
                goals[index] = goal(Extremity::ALL[index], held + side, out, Kind::Overhead);
            }
            goals
        }
        Stance::Ledge => {
            let mut goals = [None; 4];
            if context.state.ledge_hanging.pull_up < HANDS_LEAVE {
                for (index, side) in sides(postures.edge_width).into_iter().enumerate() {
                    goals[index] = goal(Extremity::ALL[index], held + side, context.up, Kind::Edge);
                }
            }
            if context.state.ledge_hanging.pull_up == 0.0 {
                for (index, foot) in postures.edge_feet.into_iter().enumerate() {
                    goals[2 + index] = goal(
                        Extremity::ALL[2 + index],
                        root.point(foot),
                        -ahead,
                        Kind::Wall,
                    );
                }
            }
            goals
        }
        _ => [None; 4],
    }
}

/// Progress of a pull-up at which hands leave the edge. In the hero's clip the hands are down at the hips then.
const HANDS_LEAVE: f64 = 0.6;

impl Goal {
    /// The goal, displaced.
    pub(crate) fn moved(self, way: DVec3) -> Self {
        Self {
            point: self.point + way,
            ..self
        }
    }

    /// The hold nearest to the goal. `None` if no surface is near, as for feet below a ledge without a wall.
    pub(crate) fn find(&self, context: &Context<'_>, extremity: Extremity) -> Option<Hold> {
        let size = context.size();
        let around = &context.around;
        let (before, length, radius) = match self.kind {
            Kind::Wall => (
                WALL_RAY_START * size,
                (WALL_RAY_START + WALL_RAY_END) * size,
                WALL_SEARCH_RADIUS * size,
            ),
            Kind::Edge => (
                LEDGE_RAY_START * size,
                (LEDGE_RAY_START + LEDGE_RAY_END) * size,
                0.5 * WALL_SEARCH_RADIUS * size,
            ),
            Kind::Overhead => (0.0, 0.0, OVERHEAD_SEARCH_RADIUS * size),
        };
        let from = self.point + self.out * before;
        let faces = |normal: DVec3| normal.dot(self.out) > FACING_COSINE;
        let ahead = if self.kind == Kind::Overhead {
            None
        } else {
            around
                .cast(from, -self.out, length)
                .filter(|found| faces(found.contact.normal))
        };
        let found = ahead.or_else(|| {
            let found = around.nearest(self.point, radius)?;
            // From inside a wall, the nearest surface may be the wall's back.
            (found.contact.normal.dot(self.out) > -0.5).then_some(found)
        })?;
        Some(self.hold(context, extremity, &found))
    }

    /// The hold on the surface nearest to the goal, within a distance.
    pub(crate) fn near(
        &self,
        context: &Context<'_>,
        extremity: Extremity,
        reach: f64,
    ) -> Option<Hold> {
        let found = context.around.nearest(self.point, reach)?;
        Some(self.hold(context, extremity, &found))
    }

    fn hold(&self, context: &Context<'_>, extremity: Extremity, found: &Found<'_>) -> Hold {
        let normal = found.contact.normal;
        let shape = context.shape(extremity);
        let (along, outward, touching) = if extremity.is_hand() {
            let along = match self.kind {
                Kind::Edge => self.ahead,
                _ => self.above - self.aside * FINGER_INWARD_TANGENT,
            };
            (along, normal, shape.contact)
        } else {
            let into =
                -normal * (1.0 - TOES_UP_SINE * TOES_UP_SINE).sqrt() + self.above * TOES_UP_SINE;
            let tip = DVec3::new(
                shape.ball.x * TOE_TIP_RATIO,
                0.6 * shape.ball.y,
                shape.ball.z,
            );
            (into, self.above, tip)
        };
        Hold::new(found, along, outward, touching)
    }
}
