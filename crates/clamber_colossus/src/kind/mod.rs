//! The data that all creatures of one kind share.

mod act;
mod additions;
mod blended;
mod extent;
mod facing;
mod file;
mod gait;
mod leg;
mod limb;
mod measures;
mod names;
mod plate;
mod sole;
mod strikes;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use clamber_animation::ik::{IkError, LookAt, LookLimits};
use clamber_animation::rig::{Channel, Clip, JointId, Keyframes, Skeleton, WeakPoint};
use clamber_animation::{AnimationSet, ClipId, joint_in_model};
use clamber_surface::Fingerprint;
use clamber_surface::mesh::{ColliderMesh, Rig, TriangleId};
use clamber_surface::surface::creature_fingerprint;
use glam::{DAffine3, DVec3};

use act::CompiledAct;
pub(crate) use blended::BlendedSole;
pub(crate) use extent::{BAND_COUNT, BAND_EDGES, Band, Extent, Extents};
pub use file::{
    BodyFile, ClipFile, Facing, FurFile, GaitFile, HeadFile, Knee, LegFile, PlateFile, Times,
    WeakPointFile,
};
pub(crate) use gait::Gait;
pub(crate) use leg::{Contacts, Leg, rotation_of};
pub(crate) use measures::{JointBall, RestSkin};
pub(crate) use names::Names;
pub use plate::Plate;
pub(crate) use sole::SoleShape;
pub(crate) use strikes::{Strike, Swept};

use crate::brain::{Brain, BrainError, BrainProblem, BrainReport, StateId, check, whole};
use crate::error::ColossusError;

/// Gravity, metres a second squared. The speed up to which a foot counts as standing depends on it.
const GRAVITY: f64 = 9.81;

/// Height of a human, metres. If a brain file gives neither `made_for` nor `height`, standing feet are found in clips
/// as for a creature of this height. The unit of a file tells no height, since many files are in centimetres.
pub(crate) const HUMAN_HEIGHT: f64 = 1.75;

/// A kind of creature: its skeleton, clips, skin and brain, and the use of its body. It never changes, and many
/// creatures share it.
#[derive(Clone, Debug)]
pub struct CreatureKind {
    skeleton: Skeleton,
    clips: AnimationSet,
    mesh: Arc<ColliderMesh>,
    weak_points: Vec<WeakPoint>,
    brain: Brain,
    /// Per state, the data of its act.
    acts: Vec<CompiledAct>,
    /// Per joint, the regions that it belongs to, one bit each.
    regions: Vec<u64>,
    legs: Vec<Leg>,
    /// The innermost joint that all legs hang from.
    hips: Option<JointId>,
    gait: Option<Gait>,
    /// The room that it takes up while it stands, walks and turns; `None` without a gait, since it stays in place.
    extents: Option<Extents>,
    look: Option<LookAt>,
    /// The head's joint, and the eye in that joint's space.
    head: Option<(JointId, DVec3)>,
    breathe: Option<ClipId>,
    plates: Vec<Plate>,
    /// The triangles of plates in ascending order, each with its plate's index.
    plate_of: Vec<(TriangleId, u32)>,
    /// Half the width of the body on the ground, at rest, in the model's units.
    girth: f64,
    /// Height of the skin at rest, in the model's units.
    height: f64,
    /// A number that no other kind in this process has. A state keeps it, so that it is checked only once for a kind.
    number: u64,
}

/// The `number` of the next kind.
static NEXT_NUMBER: AtomicU64 = AtomicU64::new(1);

impl CreatureKind {
    /// Combines a creature with a brain.
    ///
    /// # Errors
    /// [`ColossusError::Brain`] if the brain names a clip, joint or weak point that the rig does not have, with the
    /// state and its line, or if legs or head cannot be moved; [`ColossusError::Animation`] if the parts of the rig do
    /// not fit each other.
    pub fn new(rig: &Rig, brain: Brain) -> Result<Self, ColossusError> {
        let (mesh, materials) = (Arc::clone(&rig.collider), &rig.collider_materials);
        let body = &brain.file().body;
        let (skeleton, clips) =
            facing::turned(rig.skeleton.clone(), rig.clips.clone(), body.facing)?;
        let mut clips = additions::changed(clips, body)?;
        let mut weak_points = rig.weak_points.clone();
        let breath = add_breath(&mut clips, body);
        let clips = AnimationSet::new(&skeleton, clips)?;
        let rest = RestSkin::new(&skeleton, &mesh)?;
        let height = rest.height();
        check_body(body, height)?;
        let known = body.made_for.or(body.height);
        let names = Names {
            skeleton: &skeleton,
            clips: &clips,
            gravity: GRAVITY * height / known.unwrap_or(HUMAN_HEIGHT),
        };
        let mesh = additions::furred(&names, &body.fur, mesh, materials)?;
        for file in &body.weak_points {
            weak_points.push(additions::weak_point(&names, file, height)?);
        }
        let mut legs = Vec::new();
        for file in &body.legs {
            legs.push(Leg::new(&names, &mesh, &rest, file)?);
        }
        let gait = body
            .gait
            .as_ref()
            .map(|file| Gait::new(&names, file, &legs, height))
            .transpose()?;
        let extents = gait
            .as_ref()
            .map(|gait| Extents::new(&skeleton, &clips, &mesh, &rest, gait))
            .transpose()?;
        let balls = rest.balls(&skeleton, &mesh);
        let acts = act::compile_all(&brain, &names, &legs, gait.as_ref(), &weak_points, &balls)?;
        let regions = regions_of(&names, &brain)?;
        let plates = body.plates.iter().map(|file| Plate::new(file, &mesh));
        let plates = plates.collect::<Result<Vec<_>, _>>()?;
        let breathe = body
            .breathe
            .as_ref()
            .map(|name| names.clip(name).map_err(whole))
            .transpose()?
            .and(breath);
        let (look, head) = body
            .head
            .as_ref()
            .map(|file| look(&names, file, height))
            .transpose()?
            .unzip();
        Ok(Self {
            number: NEXT_NUMBER.fetch_add(1, Ordering::Relaxed),
            acts,
            regions,
            hips: common_parent(&skeleton, &legs),
            legs,
            gait,
            extents,
            look,
            head,
            breathe,
            plate_of: plate_of(&plates),
            plates,
            girth: rest.girth,
            height,
            skeleton,
            clips,
            mesh,
            weak_points,
            brain,
        })
    }

    /// A number that no other kind in this process has; not 0.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    /// True if it can walk: the body in the brain's file has a gait.
    pub fn can_walk(&self) -> bool {
        self.gait.is_some()
    }

    /// A 64-bit hash of the skeleton, clips, skin, weak points, plates, brain file and tick length, for comparing peers
    /// and saved states.
    pub fn fingerprint(&self) -> u64 {
        let body = creature_fingerprint(&self.skeleton, self.clips.clips(), &self.mesh);
        let mut hash = Fingerprint::new(body);
        hash.numbers([self.brain.tick()]);
        hash.word(self.weak_points.len() as u64);
        for point in &self.weak_points {
            hash.text(&point.name);
            hash.floats(&point.position.to_array());
            hash.word(u64::from(point.joint.0) << 32 | u64::from(point.radius.to_bits()));
            hash.numbers([point.hit_points]);
            hash.word(u64::from(point.order) << 1 | u64::from(point.major));
        }
        // Plates are chosen by `SurfaceTag::user`, which the body's hash leaves out.
        for plate in &self.plates {
            hash.word(plate.triangles.len() as u64);
            for triangle in &plate.triangles {
                hash.word(u64::from(triangle.0));
            }
        }
        // A brain file that was read can always be written.
        hash.text(&serde_json::to_string(self.brain.file()).unwrap_or_default());
        hash.value()
    }

    /// The creature as it lives by its brain, whose file may turn it, and change its clips, materials and weak points.
    /// The breath, which is added to other clips, and the names of materials are left out.
    ///
    /// It is a copy of all clips, made for climb graphs and recordings: make it once, not in each tick. For a second
    /// kind, take the rig from the file: the changes of the brain's file would be made twice.
    pub fn rig(&self) -> Rig {
        let breath = usize::from(self.breathe.is_some());
        let clips = self.clips.clips();
        let mut rig = Rig::new(self.skeleton.clone(), Arc::clone(&self.mesh));
        rig.clips = clips.iter().take(clips.len() - breath).cloned().collect();
        rig.weak_points.clone_from(&self.weak_points);
        rig
    }

    /// The skeleton, with its rest pose, turned to look along +Z ([`BodyFile::facing`]).
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// The clips, with what the brain's file adds to them and turned as the skeleton is, and the rest pose.
    pub fn clips(&self) -> &AnimationSet {
        &self.clips
    }

    /// The skin that people touch: the mesh of the creature's file, with the fur of the brain's file.
    pub fn mesh(&self) -> &Arc<ColliderMesh> {
        &self.mesh
    }

    /// The weak points: first the ones in the creature's file, then the ones in the brain's file.
    pub fn weak_points(&self) -> &[WeakPoint] {
        &self.weak_points
    }

    /// The brain that decides for all creatures of this kind.
    pub fn brain(&self) -> &Brain {
        &self.brain
    }

    /// The brain's states and transitions as text, and those that can never happen.
    pub fn report(&self) -> BrainReport {
        self.brain.report_with(&|clip, marker| {
            let clip = self.clips.find(clip);
            let clip = clip.and_then(|clip| self.clips.clip(clip).ok());
            clip.is_some_and(|clip| clip.markers().iter().any(|one| one.name == marker))
        })
    }

    /// Height of the skin posed at rest, in the model's units.
    pub fn height(&self) -> f64 {
        self.height
    }

    /// Half the body's width as seen from above, at rest, in the model's units: the largest `min(|x|, |z|)` of all
    /// vertices of its skin, so that arms held aside do not count. [`Creature::scale`](crate::Creature::scale) gives
    /// the metres per unit.
    pub fn girth(&self) -> f64 {
        self.girth
    }

    /// Place of the eye at rest, in model space and in the model's units: from [`BodyFile::head`], or without a head
    /// 0.9 of the height above the origin.
    pub fn eye(&self) -> DVec3 {
        self.eye_in(|joint| joint_in_model(&self.skeleton, self.clips.rest(), joint))
    }

    /// Speed of the walk over ground, the model's units a second of the clip; `None` if it does not walk.
    pub fn walking_speed(&self) -> Option<f64> {
        self.gait.as_ref().map(|gait| gait.speed)
    }

    /// True if the walk's speed was measured at the feet, because neither the creature's file nor the brain's file
    /// gives it. False if one of them gives it, and for a kind that does not walk.
    pub fn is_speed_measured(&self) -> bool {
        self.gait.as_ref().is_some_and(|gait| gait.is_measured)
    }

    /// Direction of the feet's motion over ground in the walk's clip, degrees to the left of +Z: about 0 for a model
    /// that looks along +Z, about 180 for a model that looks backward. [`BodyFile::facing`] corrects such a model.
    /// `None` if it has no legs, does not walk, or its feet hardly move.
    pub fn walks_aside(&self) -> Option<f64> {
        self.gait.as_ref()?.walks_aside
    }

    /// Place of the eye in model space, when joints have these frames in model space.
    pub(crate) fn eye_in(&self, frame: impl Fn(JointId) -> Option<DAffine3>) -> DVec3 {
        let head = self
            .head
            .and_then(|(joint, eye)| Some(frame(joint)?.transform_point3(eye)));
        head.unwrap_or(DVec3::Y * (0.9 * self.height))
    }

    /// The plates of armour, in the order of [`BodyFile::plates`] in the brain's file. Other items refer to a plate by
    /// its index in this list.
    pub fn plates(&self) -> &[Plate] {
        &self.plates
    }

    /// The index in [`CreatureKind::plates`] of the plate that a triangle belongs to, whether or not a creature has
    /// lost that plate. `None` if the triangle belongs to no plate.
    pub fn plate_of(&self, triangle: TriangleId) -> Option<usize> {
        let found = self
            .plate_of
            .binary_search_by_key(&triangle, |(one, _)| *one)
            .ok()?;
        Some(self.plate_of[found].1 as usize)
    }

    /// Length of a foot's sole, in the model's units; 0 if there is no such leg.
    pub fn foot_length(&self, leg: usize) -> f64 {
        self.legs.get(leg).map_or(0.0, |leg| leg.sole.size()[1])
    }

    pub(crate) fn act(&self, state: StateId) -> &CompiledAct {
        &self.acts[state.index()]
    }

    pub(crate) fn legs(&self) -> &[Leg] {
        &self.legs
    }

    pub(crate) fn hips(&self) -> Option<JointId> {
        self.hips
    }

    pub(crate) fn tremor(&self) -> f64 {
        self.brain.file().body.tremor
    }

    pub(crate) fn gait(&self) -> Option<&Gait> {
        self.gait.as_ref()
    }

    pub(crate) fn extents(&self) -> Option<&Extents> {
        self.extents.as_ref()
    }

    pub(crate) fn look(&self) -> Option<&LookAt> {
        self.look.as_ref()
    }

    pub(crate) fn breathe(&self) -> Option<ClipId> {
        self.breathe
    }

    /// True if a joint belongs to a region.
    pub(crate) fn is_in_region(&self, joint: JointId, region: usize) -> bool {
        let regions = self.regions.get(joint.index()).copied().unwrap_or(0);
        region < 64 && regions >> region & 1 == 1
    }
}

/// Refuses a tremor or heights out of range, and heights for a skin without height.
fn check_body(body: &BodyFile, height: f64) -> Result<(), BrainError> {
    let tremor = body.tremor;
    check(
        (0.0..=20.0).contains(&tremor),
        "tremor",
        "from 0 to 20",
        tremor,
    )
    .map_err(whole)?;
    for (what, found) in [("height", body.height), ("made_for", body.made_for)] {
        let Some(found) = found else { continue };
        let is_within = (1e-3..=1e5).contains(&found);
        check(is_within, what, "from 0.001 to 100,000 m", found).map_err(whole)?;
        if height <= 0.0 {
            return Err(whole(BrainProblem::NoHeight { what }));
        }
    }
    Ok(())
}

/// Per joint, the regions that it belongs to, one bit each.
fn regions_of(names: &Names<'_>, brain: &Brain) -> Result<Vec<u64>, BrainError> {
    let mut regions = vec![0; names.skeleton.joints().len()];
    for (bit, (_, patterns)) in brain.regions().enumerate() {
        for pattern in patterns {
            for joint in names.joints(pattern).map_err(whole)? {
                regions[joint.index()] |= 1u64 << bit;
            }
        }
    }
    Ok(regions)
}

/// The triangles of plates in ascending order, each with its plate's index.
fn plate_of(plates: &[Plate]) -> Vec<(TriangleId, u32)> {
    let mut plate_of: Vec<(TriangleId, u32)> = Vec::new();
    for (index, plate) in plates.iter().enumerate() {
        plate_of.extend(plate.triangles.iter().map(|one| (*one, index as u32)));
    }
    plate_of.sort_unstable();
    plate_of
}

/// Adds the clip of breathing to the clips, if there is one: a copy, since the clip itself may be played as well.
fn add_breath(clips: &mut Vec<Clip>, body: &BodyFile) -> Option<ClipId> {
    let name = body.breathe.as_ref()?;
    let breath = breath_of(clips.iter().find(|clip| clip.name == *name)?);
    clips.push(breath);
    Some(ClipId(clips.len() as u32 - 1))
}

/// A clip of breathing without its constant channels, since it is added to other clips in every tick.
fn breath_of(clip: &Clip) -> Clip {
    let moves = |channel: &&Channel| match channel.values() {
        Keyframes::Translation(values) | Keyframes::Scale(values) => {
            values.iter().any(|value| *value != values[0])
        }
        Keyframes::Rotation(values) => values.iter().any(|value| *value != values[0]),
    };
    let channels = clip.channels().iter().filter(moves).cloned().collect();
    Clip::new(clip.name.clone(), channels)
}

/// The innermost joint that all legs hang from.
fn common_parent(skeleton: &Skeleton, legs: &[Leg]) -> Option<JointId> {
    let parent = |joint: &JointId| skeleton.joints()[joint.index()].parent;
    let first = parent(&legs.first()?.hip);
    core::iter::successors(first, parent).find(|joint| {
        legs.iter()
            .all(|leg| skeleton.is_descendant_or_self(leg.hip, *joint))
    })
}

/// Largest angular acceleration of the head, radians a second squared, for a creature of human height. Larger creatures
/// turn the head slower: times grow with the square root of the height. At any size a rider on the head feels two
/// fifths of this number in metres a second squared.
const HEAD_TURN_ACCELERATION: f64 = 20.0;

fn look(
    names: &Names<'_>,
    file: &HeadFile,
    height: f64,
) -> Result<(LookAt, (JointId, DVec3)), ColossusError> {
    let mut chain = Vec::new();
    for (name, share) in &file.joints {
        chain.push((names.joint(name).map_err(whole)?, *share));
    }
    let Some(&(head, _)) = chain.first() else {
        let error = IkError::BadSetUp("it has no joints");
        return Err(names.limb_error("head", [].into_iter(), error).into());
    };
    let rest = names.skeleton.rest_pose();
    let model_from_head = joint_in_model(names.skeleton, &rest, head);
    let head_from_model = model_from_head.map(|frame| frame.matrix3.inverse());
    let forward = head_from_model.map_or(DVec3::Z, |turn| turn * DVec3::Z);
    let [yaw, pitch] = file.limits_deg.map(f64::to_radians);
    let eye = DVec3::from_array(file.eye) * height;
    let eye = head_from_model.map_or(eye, |turn| turn * eye);
    let look = LookAt::new(names.skeleton, &chain, eye, forward, DVec3::Y).and_then(|look| {
        look.with_limits(LookLimits {
            yaw,
            pitch,
            acceleration: HEAD_TURN_ACCELERATION,
        })
    });
    let joints = file.joints.iter().map(|(name, _)| name);
    let look = look.map_err(|error| names.limb_error("head", joints, error))?;
    Ok((look, (head, eye)))
}
