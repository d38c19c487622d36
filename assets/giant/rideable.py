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
# The most that is felt at the chest and at the head, in metres a second squared.
GENTLE, WALKS, ACTS, SHAKES, SHRUG = (1.5, 3.0), (4.0, 8.0), (15.0, 30.0), (30.0, 60.0), (15.0, 15.0)
# Clips that are softened to keep to `ACTS`; see `steady.py`.
SOFT = (
    *("stomp", "stomp_left", "swipe", "swipe_left", "sweep_left", "sweep_right", "kick_left", "kick_right"),
    *("roar", "expose", "rub_left", "rub_right", "stagger"),
)
# Limits at chest and head for each clip but `die`.
LIMITS = {
    **dict.fromkeys(("idle", "breathe"), GENTLE),
    **dict.fromkeys(("walk", "turn_left", "turn_right"), WALKS),
    **dict.fromkeys((*SOFT, "shake_head", "shake_arm_left", "shake_arm_right"), ACTS),
    **dict.fromkeys(("shake", "shake_loop", "rage"), SHAKES),
    "shrug": SHRUG,
}
# Limits at hands and forearms.
HANDS = {"shake": 150.0, "shake_loop": 150.0, "rage": 150.0, "shrug": 60.0}
FOREARMS = {"shake": 100.0, "shake_loop": 100.0, "rage": 100.0}


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
    """The most that is felt outside blows at chest, head, hands and forearms."""
    frames, halves = clip.poses.placed()[1], motion.halfway(clip.poses).placed()[1]
    path = np.empty((len(frames) + len(halves), *frames.shape[1:]))
    path[::2], path[1::2] = frames, halves
    groups = (("chest",), ("head",), ("hand.L", "hand.R"), ("forearm.L", "forearm.R"))
    pulls = [felt(path[:, [INDEX[name] for name in names]], clip.loops).max(axis=1) for names in groups]
    return [pull[between_blows(len(pull), clip.blows)].max() for pull in pulls]


def check(clip, expect):
    """Prints what is felt, and expects the clip's limits."""
    pulls = most(clip)
    print(f"{clip.name:16}" + "".join(f" {pull:6.1f}" for pull in pulls))
    limits = (*LIMITS.get(clip.name, ()), HANDS.get(clip.name, np.inf), FOREARMS.get(clip.name, np.inf))
    if clip.name in LIMITS:
        for place, pull, limit in zip(("chest", "head", "hands", "forearms"), pulls, limits):
            expect(pull <= limit, f"{clip.name}: {pull:.1f} m/s^2 felt at the {place}, at most {limit} wanted")
