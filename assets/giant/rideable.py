"""What riders feel where they are not meant to be shaken: limits at joints, and the filter that measures them.

A player moves a rider with the skin; the rider feels the changes of that velocity, averaged over a short
time. It begins to tire from 4 m/s^2, and 15 m/s^2 throws it off: walks can be ridden, attacks only held
through.
"""

import numpy as np

from . import motion
from .skeleton import INDEX

# The filter's time constant, and a player's ticks, in seconds.
SMOOTHING, TICK = 0.1, 1.0 / 60.0
# The blow of an impact may be felt from and until so long after its marker, in seconds.
BLOW = (-0.05, 0.5)
HANDS, FOREARMS = ("hand.L", "hand.R"), ("forearm.L", "forearm.R")


def _limits(chest, head, **more):
    return {("chest",): chest, ("head",): head, **{globals()[name.upper()]: limit for name, limit in more.items()}}


# The most that is felt at joints, in metres a second squared; `die` has no limits.
_GENTLE, _WALKS, _ACTS, _SHAKES = _limits(1.5, 3.0), _limits(4.0, 8.0), _limits(15.0, 30.0), _limits(30.0, 60.0, hands=150.0, forearms=100.0)
LIMITS = {
    **dict.fromkeys(("idle", "breathe"), _GENTLE),
    **dict.fromkeys(("walk", "turn_left", "turn_right"), _WALKS),
    **dict.fromkeys(("stomp", "stomp_left", "swipe", "swipe_left", "sweep_left", "sweep_right", "kick_left", "kick_right"), _ACTS),
    **dict.fromkeys(("roar", "expose", "rub_left", "rub_right", "stagger", "shake_head", "shake_arm_left", "shake_arm_right"), _ACTS),
    **dict.fromkeys(("shake", "shake_loop", "rage"), _SHAKES),
    "shrug": _limits(15.0, 15.0, hands=60.0),
}


def felt(path, loops):
    """Felt accelerations (ticks, points) of points that are moved along a path (ticks, points, 3).

    A one-shot starts from rest and ends at rest; a loop has run for a cycle before.
    """
    cycle = len(path) - 1
    path = np.concatenate([path, path[1:], path[1:3]] if loops else [path[:1], path[:1], path, path[-1:], path[-1:]])
    jolts = np.diff(path, 2, axis=0) / TICK**2
    share = 1.0 - np.exp(-TICK / SMOOTHING)
    result, now = np.empty(jolts.shape[:2]), np.zeros_like(jolts[0])
    for tick, jolt in enumerate(jolts):
        now = (1.0 - share) * now + share * jolt
        result[tick] = np.linalg.norm(now, axis=1)
    return result[cycle:] if loops else result


def between_blows(ticks, blows):
    """Whether each tick is outside all blows."""
    time = np.arange(ticks) * TICK
    return np.all([(time < blow + BLOW[0]) | (time > blow + BLOW[1]) for blow in blows], axis=0) if blows else np.ones(ticks, bool)


def most(clip):
    """The most that is felt at each group of joints with a limit, outside blows: {joints: (felt, limit)}."""
    frames, halves = clip.poses.placed()[1], motion.halfway(clip.poses).placed()[1]
    path = np.empty((len(frames) + len(halves), *frames.shape[1:]))
    path[::2], path[1::2] = frames, halves
    result = {}
    for names, limit in LIMITS.get(clip.name, {}).items():
        pull = felt(path[:, [INDEX[name] for name in names]], clip.loops).max(axis=1)
        result[names] = pull[between_blows(len(pull), clip.blows)].max(), limit
    return result
