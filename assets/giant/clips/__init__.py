"""The clips, as tables of keys (seconds, value): metres and degrees; see `tracks.py` and `motion.py`.

Channels: pelvis.x/y/z (metres from rest) and .pitch/.yaw/.roll; spine, chest, neck, head in
pitch/yaw/roll; breath, swell (the upper spine's part of it), jaw; for each side arm.swing/out/across,
elbow, forearm.in, wrist, curl, shoulder.lift/forward; hand.hold (the share by which the wrist is taken to a place),
hand.x (outwards)/y, hand.z (height of the lowest skin), hand.pitch/yaw/roll; foot.x/y/out (the ball, metres
from rest), foot.z (height of the lowest skin), foot.pitch (heel up), foot.yaw; loin (the hanging slabs).
"""

from dataclasses import dataclass

import numpy as np

from .. import motion, rideable, soles, steady
from ..tracks import Tracks
from . import attack, fall, rub, shake, stand, sweep, walk
from .keys import Table, mirrored

RATE = 30
# No point of the skin may be deeper in the ground than this, in metres.
DEEPEST = 0.08
# Joints of the feet, and of the arms from the elbow on.
LEGS = ("foot", "toe")
ARMS = ("forearm", "hand", "index", "middle", "ring", "thumb")
# How much an arm is raised for a metre of depth, in degrees.
RAISE = 3.5

TABLES = {
    "idle": stand.idle, "breathe": stand.breathe, "roar": stand.roar, "expose": stand.expose,
    "walk": walk.walk, "turn_left": walk.turn_left, "turn_right": lambda: mirrored(walk.turn_left()),
    "stomp": attack.stomp, "stomp_left": lambda: mirrored(attack.stomp()),
    "swipe": attack.swipe, "swipe_left": lambda: mirrored(attack.swipe()),
    "sweep_right": sweep.sweep_right, "sweep_left": lambda: mirrored(sweep.sweep_right()),
    "kick_right": attack.kick_right, "kick_left": lambda: mirrored(attack.kick_right()),
    "shrug": shake.shrug, "shake": shake.shake, "shake_loop": shake.shake_loop, "shake_head": shake.shake_head,
    "shake_arm_left": shake.shake_arm_left, "shake_arm_right": lambda: mirrored(shake.shake_arm_left()),
    "rage": shake.rage,
    "rub_left": rub.rub_left, "rub_right": lambda: mirrored(rub.rub_left()),
    "stagger": fall.stagger, "die": fall.die,
}


@dataclass
class Clip:
    """Sampled poses of a table."""

    name: str
    table: Table
    poses: motion.Poses

    @property
    def loops(self):
        return self.table.loops

    @property
    def length(self):
        return (len(self.poses) - 1) / RATE

    @property
    def blows(self):
        """Seconds of its impacts."""
        return self.table.blows

    @property
    def extras(self):
        """What the file's animation says of it."""
        tag = {"markers": [{"name": name, "time": time} for name, time in self.table.markers]}
        return tag if self.table.speed is None else tag | {"speed": self.table.speed}


def sampled(name, points, weights):
    """A clip with its poses; the skin (points, weights) is kept out of the ground."""
    table = TABLES[name]()
    frames = round(table.length * RATE)
    times = np.arange(frames + 1) / RATE
    if table.loops:
        times[-1] = 0.0
    base = None
    if table.from_idle and not table.loops:
        idle = stand.idle()
        base = Tracks(idle.length, True, idle.channels, [0.0])
    tracks = Tracks(table.length, table.loops, table.channels, times, base, table.blows)
    if name in rideable.SOFT:
        steady.soften(tracks, table.blows)
    speed = table.speed or 0.0
    if table.settles:
        soles.settle(tracks, points, weights, RATE, table.loops, speed, table.turn)
    if table.kneels:
        _hold_up(tracks, points, weights)
    return Clip(name, table, motion.posed(tracks))


def _hold_up(tracks, points, weights):
    """Raises the pelvis where the trunk would sink into the ground, then the arms.

    Arms go sideways while the trunk is upright, backwards while it lies on its front.
    """
    legs, arms = soles.share(weights, LEGS), [soles.share(weights, ARMS, side) for side in (".L", ".R")]
    trunk = (legs < soles.ANKLE_SHARE) & (arms[0] < 0.5) & (arms[1] < 0.5)

    def depths(part):
        return -DEEPEST - motion.skinned(points[part], weights[part], motion.posed(tracks))[:, :, 2].min(axis=1)

    def add(channel, values):
        tracks.extra[channel] = tracks.extra.get(channel, 0.0) + values

    for _ in range(3):
        add("pelvis.z", _spread(np.maximum(depths(trunk), 0.0)))
    lean = np.radians(tracks("pelvis.pitch"))
    for side, arm in zip((".L", ".R"), arms):
        if f"hand.hold{side}" in tracks:
            continue
        for _ in range(9):
            more = _spread(np.clip(RAISE * depths(arm > 0.5), 0.0, 25.0))
            add(f"arm.out{side}", np.cos(lean) * more)
            add(f"arm.swing{side}", -np.sin(lean) * more)


def _spread(values, reach=6):
    """The largest value nearby, softened: a smooth curve that is nowhere less than `values`."""
    padded = np.pad(values, 2 * reach, mode="edge")
    window = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1)
    soft = np.hanning(2 * reach + 3)[1:-1]
    return np.convolve(window.max(axis=1), soft / soft.sum(), mode="valid")
