//! Moves the body so that hands and feet reach their places: the pelvis goes down for the feet, or the body moves
//! towards its holds.

use clamber_animation::Spring;
use glam::DVec3;

use super::Update;
use crate::Extremity;
use crate::body::climb::Schedule;
use crate::body::context::Context;
use crate::body::feet;
use crate::body::limb::{Doing, LimbMemory};
use crate::body::reach::{self, Tie};
use crate::body::root::Root;
use crate::body::stance::Stance;
use crate::body::walk::Walk;
use crate::figure::Place;

/// Half time of the body's displacement to where all limbs reach, seconds.
const PULL_HALF_TIME: f64 = 0.06;

/// The body where its limbs reach.
pub(super) struct Reached {
    pub(super) root: Root,
    /// Displacement of the root for the limbs.
    pub(super) moved: DVec3,
    /// The places of hands and feet that do not move with the body. `None` for limbs that follow the clips.
    pub(super) ends: [Option<Place>; 4],
    /// Depth of the pelvis below its height in the clips' pose, metres.
    pub(super) drop: f64,
    /// Displacement towards the holds.
    pub(super) pull: Spring<DVec3>,
}

impl Update<'_> {
    /// Moves the body so that its limbs reach their places.
    pub(super) fn reach(
        &self,
        schedule: &Schedule<'_, '_>,
        stand: &Root,
        walk: &Walk,
        limbs: &mut [LimbMemory; 4],
    ) -> Reached {
        let context = schedule.context;
        let mut root = *schedule.root;
        let mut ends = self.ends(context, stand, limbs);
        let mut drop = 0.0;
        let mut pull = Spring::default();
        if self.stance == Stance::Upright {
            drop = self.drop(context, &ends, &schedule.shoulders, walk);
            root.position -= self.up * drop;
        } else if self.stance.is_held() {
            pull = self.pull(context, stand, schedule, limbs, &mut ends);
            root.position += pull.value;
        }
        let moved = root.position - schedule.root.position;
        if self.stance.is_held() {
            for hand in (0..2).filter(|&hand| schedule.goals[hand].is_some()) {
                let shoulder = schedule.shoulders[hand] + moved;
                ends[hand] = ends[hand]
                    .or_else(|| self.free_hand(context, &root, hand, shoulder, &mut limbs[hand]));
            }
        }
        Reached {
            root,
            moved,
            ends,
            drop,
            pull,
        }
    }

    /// Depth of the pelvis at which the feet reach the ground, metres.
    fn drop(
        &self,
        context: &Context<'_>,
        ends: &[Option<Place>; 4],
        shoulders: &[DVec3; 4],
        walk: &Walk,
    ) -> f64 {
        let ties = self.ties(ends, shoulders);
        let needed = reach::needed_drop(&[ties[2], ties[3]], self.up);
        let was = self.kept().map_or(0.0, |memory| memory.drop);
        if context.is_fresh {
            needed
        } else {
            reach::dropped(was, needed, walk.is_going(), context.size(), self.dt)
        }
    }

    /// The displacement of the body by which hands and feet reach their holds. While limbs are out of reach, the one
    /// that is farthest out of reach is let go. The last hand stays longer: limbs on their way are let go before it,
    /// then feet.
    fn pull(
        &self,
        context: &Context<'_>,
        stand: &Root,
        schedule: &Schedule<'_, '_>,
        limbs: &mut [LimbMemory; 4],
        ends: &mut [Option<Place>; 4],
    ) -> Spring<DVec3> {
        let size = context.size();
        let mut ties = self.ties(ends, &schedule.shoulders);
        let mut wanted = DVec3::ZERO;
        // Each limb is let go at most twice: once on its way, and once from its hold.
        for _ in 0..2 * Extremity::ALL.len() {
            wanted = reach::pulled(DVec3::ZERO, &ties, size);
            let Some(worst) = reach::out_of_reach(&ties, wanted) else {
                break;
            };
            let is_last_hand = worst < 2 && !limbs[1 - worst].is_planted();
            let on_its_way =
                (0..4).find(|index| ties[*index].is_some() && !limbs[*index].is_planted());
            let foot = (2..4).find(|index| ties[*index].is_some());
            let dropped = match (on_its_way, foot) {
                (Some(index), _) if is_last_hand || index == worst => index,
                (None, Some(foot)) if is_last_hand => foot,
                _ => worst,
            };
            if limbs[dropped].is_planted() {
                schedule.replace(dropped, limbs);
                *ends = self.ends(context, stand, limbs);
            }
            ties[dropped] = None;
        }
        if context.is_fresh {
            return Spring::at(wanted);
        }
        // The pull changes softly, since limbs come and go, but planted limbs stay within reach in each frame. In a new
        // stance the pull starts at 0: the displacement between the stances contains the rest of it.
        let mut pull = self.kept().map_or(Spring::default(), |memory| memory.pull);
        pull.value = self.carry.vector(pull.value);
        pull.velocity = self.carry.vector(pull.velocity);
        pull.step(wanted, PULL_HALF_TIME * size.sqrt(), self.dt);
        for (tie, limb) in ties.iter_mut().zip(limbs.iter()) {
            *tie = tie.filter(|_| limb.is_planted());
        }
        pull.value = reach::pulled(pull.value, &ties, size);
        pull
    }

    /// The places of hands and feet that do not move with the body. `None` for limbs that follow the clips.
    fn ends(
        &self,
        context: &Context<'_>,
        stand: &Root,
        limbs: &[LimbMemory; 4],
    ) -> [Option<Place>; 4] {
        Extremity::ALL.map(|extremity| {
            let limb = &limbs[extremity.index()];
            match (&limb.doing, extremity) {
                (_, Extremity::Foot(side)) if self.stance == Stance::Upright => {
                    Some(feet::place(context, stand, limb, side))
                }
                (Doing::Free, _) => None,
                (Doing::Planted(hold), _) => Some(limb.kept(&hold.place())),
                (Doing::Swinging(swing), _) => Some(limb.detour.lead(swing)),
            }
        })
    }

    /// The place of a hand without a hold that is led out of an obstacle. `None` if the hand needs no displacement.
    fn free_hand(
        &self,
        context: &Context<'_>,
        root: &Root,
        hand: usize,
        shoulder: DVec3,
        limb: &mut LimbMemory,
    ) -> Option<Place> {
        let extremity = Extremity::ALL[hand];
        let shape = self.figure.limb(extremity);
        let mut place = limb.kept(&context.clip_in_world(root, extremity));
        let way = place.position - shoulder;
        place.position = shoulder + way.clamp_length_max(shape.length);
        limb.detour.step(context, place.point(shape.contact));
        limb.detour.lead_free(&place)
    }

    /// The limbs that the body has to stay within reach of.
    fn ties(&self, ends: &[Option<Place>; 4], shoulders: &[DVec3; 4]) -> [Option<Tie>; 4] {
        Extremity::ALL.map(|extremity| {
            let index = extremity.index();
            let end = ends[index]?;
            let length = self.figure.limb(extremity).length;
            let share = if extremity.is_hand() {
                reach::ARM_REACH
            } else {
                reach::LEG_REACH
            };
            Some(Tie {
                root: shoulders[index],
                end: end.position,
                reach: share * length,
                length,
            })
        })
    }
}
