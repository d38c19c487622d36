"""How clips feel: feet that stand, limbs that start gently, and what a rider has to hold out."""

import numpy as np

from . import motion, rideable, soles
from .clips import RATE
from .signs import SIGNS
from .skeleton import HEADS, JOINTS, TAILS
from .turns import turned, turned_back

# Skin within this height of a standing foot's lowest point must move with the ground, by so much
# (metres a second) for 95 % of it; and no skin may be deeper in the ground (metres).
SOLE, MOST_SLIP, DEEPEST = 0.05, 0.15, 0.10
# A limb is at rest below this speed for that long; it may start with this acceleration for a while,
# and a blow excuses it for some time (metres, seconds).
REST_SPEED, REST_TIME, START_PULL, START_TIME, BLOW_TIME = 0.1, 0.2, 4.9, 0.1, 0.15
# A rider feels a point's changes of velocity, averaged over this time, at ticks of this length.
SMOOTHING, TICK = 0.1, 1.0 / 60.0
# Pulls (metres a second squared) that throw riders off, tire them, and can be held out; for how long
# the first one must be passed (seconds), how much of the second one may add up (metres a second).
THROWS, TIRES, HELD = 15.0, 4.0, 10.5
LEAST_THROW, MOST_TIRING = 0.3, 20.0
# A place to hold out is this close to a weak point, in metres.
NEAR = 1.5
# The clip that is meant for riders at each weak point.
MEANT = {"weak_point_head": "shake_head", "weak_point_nape": "shake", "weak_point_forearm.L": "shake_arm_left"}
ASSERTED = ("shake", "shake_head")


def check(clip, points, weights, fur):
    """Prints and asserts all of it for a clip; `fur` marks the vertices that can be gripped."""
    low, slip = standing(clip, points, weights)
    pull, joint, time = starts(clip)
    print(
        f"{clip.name}: lowest skin {low:.3f} m, standing soles slide {slip:.3f} m/s (95 %), "
        f"starts with up to {pull:.2f} m/s^2 ({joint} at {time:.2f} s)"
    )
    if clip.name != "die":
        assert low > -DEEPEST and slip < MOST_SLIP, clip.name
    if clip.name != "breathe":
        assert pull < START_PULL, clip.name
    rideable.check(clip)
    for sign in SIGNS:
        if MEANT[sign.name] == clip.name or clip.name == "rage":
            throw, tiring, held, grip = ride(clip, sign, points, weights, fur)
            print(
                f"{clip.name}: a rider on {sign.name} ({sign.joint}) is thrown for {throw:.2f} s, tired by {tiring:.1f} m/s; "
                f"{grip} {NEAR} m off stays at {held:.1f} m/s^2"
            )
            if clip.name in ASSERTED:
                assert throw >= LEAST_THROW and tiring <= MOST_TIRING and held <= HELD, clip.name


def standing(clip, points, weights):
    """The lowest skin of all, and how fast the soles of standing feet slide over the ground."""
    middle = motion.halfway(clip.poses)
    low = min(motion.skinned(points, weights, poses)[:, :, 2].min() for poses in (clip.poses, middle))
    slips = [np.zeros(1)]
    for side, _ in soles.SIDES:
        skin = motion.skinned(*soles.foot_skin(points, weights, side), clip.poses)
        touch = skin[:, :, 2] < skin[:, :, 2].min(axis=1, keepdims=True) + SOLE
        touch = touch[1:] & touch[:-1] & clip.stands[side][:, None]
        ground = soles.carried(skin[:-1, :, :2], clip.table.speed or 0.0, clip.table.turn, RATE)
        slips.append(np.linalg.norm(skin[1:, :, :2] - ground, axis=2)[touch] * RATE)
    return low, np.percentile(np.concatenate(slips), 95)


def starts(clip):
    """The largest acceleration of a limb's centre just after it was at rest: how much, which, when."""
    turn, place = clip.poses.placed()
    centres = place + np.einsum("fjab,jb->fja", turn, (TAILS - HEADS) / 2)
    still = round(REST_TIME * RATE)
    before = [centres[:1]] * (still + 1) if not clip.loops else [centres[-2 - still : -1]]
    centres = on_ground(np.concatenate([*before, centres]), clip)
    speed = np.linalg.norm(np.diff(centres, axis=0), axis=2) * RATE
    pull = np.linalg.norm(np.diff(centres, 2, axis=0), axis=2) * RATE**2
    blows = [time for name, time in clip.table.markers if name == "impact"]
    worst = (0.0, JOINTS[0].name, 0.0)
    for step in range(still - 1, len(pull)):
        rested = (speed[step - still + 1 : step + 1] < REST_SPEED).all(axis=0)
        for later in range(step, min(step + round(START_TIME * RATE) + 1, len(pull))):
            # `pull[n]` is at frame n + 1 of the padded ones.
            time = (later + 1 - (still + 1)) / RATE
            if any(abs(time - blow) <= BLOW_TIME + 0.5 / RATE for blow in blows):
                continue
            felt = np.where(rested, pull[later], 0.0)
            if felt.max() > worst[0]:
                worst = (float(felt.max()), JOINTS[int(felt.argmax())].name, time)
    return worst


def on_ground(path, clip):
    """A path (frames, points, 3) in the clip's place, as it is over the ground."""
    if not clip.table.speed and not clip.table.turn:
        return path
    seconds = np.arange(len(path)) / RATE
    turn = turned(0.0, clip.table.turn * seconds)
    return path @ turned_back(turn) - np.array([0.0, clip.table.speed or 0.0, 0.0]) * seconds[:, None, None]


def ride(clip, sign, points, weights, fur):
    """What a rider feels at a weak point: seconds thrown, how tiring, and the least of the places nearby."""
    spot = np.linalg.norm(points - np.asarray(sign.place), axis=1).argmin()
    away = np.linalg.norm(points - points[spot], axis=1)
    near, grip = np.flatnonzero(fur & (away <= NEAR)), "fur within"
    if not len(near):
        near, grip = np.flatnonzero((away <= NEAR) & (away > 0.0)), "stone within"
    felt = pulls(clip, points[[spot, *near]], weights[[spot, *near]])
    throw = (felt[:, 0] > THROWS).sum() * TICK
    tiring = np.maximum(felt[:, 0] - TIRES, 0.0).sum() * TICK
    return throw, tiring, felt[:, 1:].max(axis=0).min(), grip


def pulls(clip, points, weights):
    """Smoothed accelerations (ticks, points) of points on the skin, as a player moves them.

    A one-shot starts from rest and ends at rest; a loop has run for a cycle before.
    """
    frames = motion.skinned(points, weights, clip.poses)
    path = np.empty((2 * len(frames) - 1, *frames.shape[1:]))
    path[::2], path[1::2] = frames, motion.skinned(points, weights, motion.halfway(clip.poses))
    cycle = len(path) - 1
    path = np.concatenate([path, path[1:], path[1:3]] if clip.loops else [path[:1], path[:1], path, path[-1:], path[-1:]])
    jolts = np.diff(path, 2, axis=0) / TICK**2
    share = 1.0 - np.exp(-TICK / SMOOTHING)
    felt, now = np.empty(jolts.shape[:2]), np.zeros_like(jolts[0])
    for tick, jolt in enumerate(jolts):
        now = (1.0 - share) * now + share * jolt
        felt[tick] = np.linalg.norm(now, axis=1)
    return felt[cycle:] if clip.loops else felt
