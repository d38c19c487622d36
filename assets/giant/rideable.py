"""How hard clips pull at a rider who is not meant: chest and head may not throw off everybody all the time."""

import numpy as np

from .clips import RATE
from .skeleton import JOINTS

# As in `feel`: seconds.
SMOOTHING, TICK = 0.1, 1.0 / 60.0
# Most pull that is felt (metres a second squared, as in `feel`) at the chest and at the head, outside blows.
# Tiring begins at 4, and 15 throws off: walks can be ridden, attacks only held through.
GENTLE, WALKS, ACTS = (1.5, 3.0), (4.0, 8.0), (15.0, 30.0)
LIMITS = {
    "idle": GENTLE,
    "breathe": GENTLE,
    "walk": WALKS,
    "turn_left": WALKS,
    "turn_right": WALKS,
    **dict.fromkeys(("stomp", "stomp_left", "swipe", "swipe_left", "sweep_left", "sweep_right"), ACTS),
    **dict.fromkeys(("kick_left", "kick_right", "roar", "expose", "rub_left", "rub_right", "stagger"), ACTS),
}


def check(clip):
    """Prints what is felt at chest and head, and asserts the clip's limits."""
    names = ("chest", "head")
    turn, place = clip.poses.placed()
    index = [[joint.name for joint in JOINTS].index(name) for name in names]
    path = place[:, index]
    # Frames are longer than ticks: places between them are interpolated as a player does.
    frames = np.arange(len(path))
    ticks = np.arange(0.0, len(path) - 1, TICK * RATE)
    at = np.stack([[np.interp(ticks, frames, path[:, j, axis]) for axis in range(3)] for j in range(len(names))])
    at = at.transpose(2, 0, 1)
    if clip.loops:
        at = np.concatenate([at[:-1], at])
    jolts = np.diff(at, 2, axis=0) / TICK**2
    share, felt, most = 1.0 - np.exp(-TICK / SMOOTHING), np.zeros((len(names), 3)), np.zeros(len(names))
    blows = [time for name, time in clip.table.markers if name == "impact"]
    for tick, jolt in enumerate(jolts):
        felt = felt + (jolt - felt) * share
        time = tick * TICK
        if not any(-0.05 <= time - blow <= 0.5 for blow in blows):
            most = np.maximum(most, np.linalg.norm(felt, axis=1))
    print(f"{clip.name}: felt at most {most[0]:.1f} m/s^2 at the chest, {most[1]:.1f} at the head")
    limits = LIMITS.get(clip.name)
    if limits:
        assert (most <= limits).all(), f"{clip.name}: {most} m/s^2 felt at chest and head, at most {limits} wanted"
