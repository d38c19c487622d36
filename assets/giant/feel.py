"""How clips feel: feet that stand, limbs that start gently, and what a rider has to hold out."""

import numpy as np

from . import motion, rideable, soles
from .clips import RATE
from .signs import SIGNS
from .skeleton import HEADS, INDEX, JOINTS, TAILS
from .turns import turned, turned_back

# A foot is planted while its lowest skin is below the first height, in metres. Its skin within the second
# height of the lowest point touches the ground, and must not slide over it.
PLANTED, SOLE = 0.03, 0.05
# A limb is at rest when it has been below this speed for that long. Its start lasts that long, and a blow
# excuses starts for some time around it (metres, seconds).
REST_SPEED, REST_TIME, START_TIME, BLOW_TIME = 0.1, 0.2, 0.1, 0.15
# Pulls (metres a second squared) that throw riders off, and that tire them.
THROWS, TIRES = 15.0, 4.0
# A place to hold out is this close to a weak point, in metres.
NEAR = 1.5


def standing(clip, points, weights):
    """The lowest skin of all, and how fast the soles of planted feet slide over the ground (95th percentile)."""
    middle = motion.halfway(clip.poses)
    low = min(motion.skinned(points, weights, poses)[:, :, 2].min() for poses in (clip.poses, middle))
    slips = []
    for side, _ in soles.SIDES:
        skin = motion.skinned(*soles.foot_skin(points, weights, side), clip.poses)
        lowest = skin[:, :, 2].min(axis=1, keepdims=True)
        touch = (skin[:, :, 2] < lowest + SOLE) & (lowest < PLANTED)
        ground = soles.carried(skin[:-1, :, :2], clip.table.speed or 0.0, clip.table.turn, RATE)
        slips.append(np.linalg.norm(skin[1:, :, :2] - ground, axis=2)[touch[1:] & touch[:-1]] * RATE)
    return low, np.percentile(np.concatenate(slips), 95)


def stretch(clip, points, weights):
    """How far planted legs are stretched: the largest distance of hip and ankle, as a share of the leg's length."""
    _, place = clip.poses.placed()
    worst = 0.0
    for side, _ in soles.SIDES:
        hip, knee, ankle = (INDEX[name + side] for name in ("thigh", "shin", "foot"))
        length = np.linalg.norm(HEADS[knee] - HEADS[hip]) + np.linalg.norm(HEADS[ankle] - HEADS[knee])
        planted = motion.skinned(*soles.foot_skin(points, weights, side), clip.poses)[:, :, 2].min(axis=1) < PLANTED
        worst = max(worst, *(np.linalg.norm(place[:, ankle] - place[:, hip], axis=1)[planted] / length))
    return worst


def starts(clip):
    """The largest acceleration of a limb's centre just after it was at rest: how much, which, when."""
    turn, place = clip.poses.placed()
    centres = place + np.einsum("fjab,jb->fja", turn, (TAILS - HEADS) / 2)
    still = round(REST_TIME * RATE)
    before = [centres[:1]] * (still + 1) if not clip.loops else [centres[-2 - still : -1]]
    centres = _over_ground(np.concatenate([*before, centres]), clip)
    speed = np.linalg.norm(np.diff(centres, axis=0), axis=2) * RATE
    pull = np.linalg.norm(np.diff(centres, 2, axis=0), axis=2) * RATE**2
    worst = (0.0, JOINTS[0].name, 0.0)
    for step in range(still - 1, len(pull)):
        rested = (speed[step - still + 1 : step + 1] < REST_SPEED).all(axis=0)
        for later in range(step, min(step + round(START_TIME * RATE) + 1, len(pull))):
            # `pull[n]` is at frame n + 1 of the padded ones.
            time = (later + 1 - (still + 1)) / RATE
            if any(abs(time - blow) <= BLOW_TIME + 0.5 / RATE for blow in clip.blows):
                continue
            felt = np.where(rested, pull[later], 0.0)
            if felt.max() > worst[0]:
                worst = (float(felt.max()), JOINTS[int(felt.argmax())].name, time)
    return worst


def _over_ground(path, clip):
    """A path (frames, points, 3) in the clip's place, as it is over the ground."""
    if not clip.table.speed and not clip.table.turn:
        return path
    seconds = np.arange(len(path)) / RATE
    turn = turned(0.0, clip.table.turn * seconds)
    return path @ turned_back(turn) - np.array([0.0, clip.table.speed or 0.0, 0.0]) * seconds[:, None, None]


def ride(clip, sign_name, points, weights, fur):
    """What a rider feels at a weak point.

    Returns the largest pull, the seconds for which it throws him, how far it tires him (metres a second),
    and the largest pull at the calmest of the places nearby that `fur` marks.
    """
    sign = next(sign for sign in SIGNS if sign.name == sign_name.replace(".R", ".L"))
    place = np.asarray(sign.place) * ((-1, 1, 1) if sign_name.endswith(".R") else (1, 1, 1))
    spot = np.linalg.norm(points - place, axis=1).argmin()
    away = np.linalg.norm(points - points[spot], axis=1)
    near = np.flatnonzero(fur & (away <= NEAR))
    felt = pulls(clip, points[[spot, *near]], weights[[spot, *near]])
    throw = (felt[:, 0] > THROWS).sum() * rideable.TICK
    tiring = np.maximum(felt[:, 0] - TIRES, 0.0).sum() * rideable.TICK
    return felt[:, 0].max(), throw, tiring, felt[:, 1:].max(axis=0).min()


def pulls(clip, points, weights):
    """Felt accelerations (ticks, points) of points on the skin, as a player moves them."""
    frames = motion.skinned(points, weights, clip.poses)
    path = np.empty((2 * len(frames) - 1, *frames.shape[1:]))
    path[::2], path[1::2] = frames, motion.skinned(points, weights, motion.halfway(clip.poses))
    return rideable.felt(path, clip.loops)
