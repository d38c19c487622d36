"""The seven clips, as tables of keys (seconds, value): metres and degrees; see `motion.py`.

Channels: pelvis.x/y/z (metres from rest) and .pitch/.yaw/.roll; spine, neck, head in pitch/yaw/roll;
breath, jaw; for each side arm.swing/out/across, elbow, forearm.in, wrist, curl, shoulder.lift/forward;
foot.x/y/z/out (the ball, metres from rest), foot.pitch (heel up), foot.yaw; loin (the hanging slabs).
"""

from dataclasses import dataclass

import numpy as np

from . import motion
from .skeleton import JOINTS

RATE = 30
# The stance foot goes backwards by this much, in metres per second.
WALK_SPEED = 5.0
WALK_CYCLE = 3.6
# The share of a cycle for which a foot stands.
STANCE = 0.62
# Keys for one period of a wave.
WAVE_KEYS = 16
# No point of the skin may be deeper in the ground than this, in metres.
DEEPEST = 0.10
# Joints of the feet, and of the arms from the elbow on.
LEGS = ("foot", "toe")
ARMS = ("forearm", "hand", "index", "middle", "ring", "thumb")
# How much an arm is raised for a metre of depth, in degrees.
RAISE = 3.5


@dataclass
class Clip:
    """Sampled poses: `local` (frames, joints, 3, 3) and the pelvis's shift (frames, 3)."""

    name: str
    loops: bool
    poses: list

    @property
    def length(self):
        return (len(self.poses) - 1) / RATE


def both(name, keys):
    """The same keys for both sides."""
    return {f"{name}.L": keys, f"{name}.R": keys}


def wave(length, size, count=1, late=0.0, rest=0.0):
    """Keys of a sine of `count` periods in a clip, its first peak at a quarter plus `late` periods."""
    step = length / count / WAVE_KEYS
    return [(i * step, rest + size * np.sin(2 * np.pi * (i / WAVE_KEYS - late))) for i in range(WAVE_KEYS * count)]


def idle():
    t = 6.0
    return t, True, {
        "pelvis.x": wave(t, 0.55), "pelvis.z": wave(t, 0.12, 2, 0.1, -0.45), "pelvis.y": wave(t, 0.15, 1, 0.3),
        "pelvis.roll": wave(t, 1.4), "pelvis.yaw": wave(t, 1.5, 1, 0.2),
        "spine.pitch": wave(t, 2.4, 2, 0.2, 3.0), "spine.roll": wave(t, -2.8, 1, 0.05), "spine.yaw": wave(t, 3.0, 1, 0.25),
        "breath": wave(t, 1.7, 2, 0.0),
        "neck.yaw": [(0, 0), (1.0, 14), (2.2, 16), (3.4, -12), (4.8, -15), (5.5, -4)],
        "neck.pitch": wave(t, 3.0, 2, 0.3, 2.0),
        "head.yaw": [(0, 0), (0.9, 12), (2.2, 13), (3.3, -12), (4.7, -13), (5.5, -3)],
        "head.pitch": [(0, 0), (1.4, -5), (3.0, 4), (4.6, -3)], "head.roll": wave(t, 3.0, 1, 0.15),
        "jaw": wave(t, 3.0, 2, 0.15, 4.0),
        "arm.swing.L": wave(t, 2.2, 2, 0.25, 3.0), "arm.swing.R": wave(t, 2.2, 2, 0.35, 2.0),
        "arm.out.L": wave(t, 1.6, 1, 0.2, 2.0), "arm.out.R": wave(t, 1.6, 1, 0.7, 2.0),
        **both("elbow", wave(t, 2.5, 2, 0.3, 6.0)), **both("wrist", wave(t, 3.0, 2, 0.3)),
        "curl.L": wave(t, 7.0, 1, 0.1, 12.0), "curl.R": wave(t, 7.0, 1, 0.55, 12.0),
        "loin": wave(t, 1.5, 2, 0.2), "loin.side": wave(t, -1.5, 1, 0.1),
    }


def walk():
    t = WALK_CYCLE
    swing = t * (1.0 - STANCE)
    channels = {
        "pelvis.z": wave(t, 0.38, 2, 0.42, -1.55), "pelvis.x": wave(t, 0.85, 1, 0.06), "pelvis.y": wave(t, 0.2, 2, 0.1, -0.5),
        "pelvis.yaw": wave(t, 8.0, 1, -0.25), "pelvis.roll": wave(t, -3.0, 1, 0.10), "pelvis.pitch": wave(t, 1.5, 2, 0.2, 4.0),
        "spine.yaw": wave(t, -19.0, 1, -0.22), "spine.roll": wave(t, 4.5, 1, 0.12), "spine.pitch": wave(t, 2.6, 2, 0.2, 6.0),
        "neck.yaw": wave(t, 7.0, 1, -0.2), "neck.pitch": wave(t, 3.0, 2, 0.3, -4.0), "head.yaw": wave(t, 5.0, 1, -0.2),
        "head.pitch": wave(t, 3.5, 2, 0.35, -5.0), "head.roll": wave(t, -3.0, 1, 0.1), "jaw": wave(t, 4.0, 2, 0.3, 5.0),
        "breath": wave(t, 1.0, 1),
        "loin": wave(t, 7.0, 2, 0.1), "loin.front": [(0, -11.0)], "loin.back": [(0, 9.0)], "loin.side": wave(t, -4.0, 1, 0.1),
    }
    for side, start in (("L", 0.0), ("R", t / 2)):
        # The foot comes down at `start`, half a stride ahead (-Y), and leaves at `off`.
        off = start + t * STANCE
        channels |= {
            f"foot.z.{side}": [(start, 0), (off, 0), (off + 0.12 * swing, 0.9), (off + 0.36 * swing, 2.4), (off + 0.7 * swing, 1.7)],
            f"foot.pitch.{side}": [(start, 0), (start + 0.62 * t * STANCE, 0), (off, 19), (off + 0.3 * swing, 32), (off + 0.75 * swing, -8)],
            f"foot.out.{side}": [(start, -0.9), (off, -0.9), (off + 0.5 * swing, -0.2)],
            f"arm.swing.{side}": wave(t, 17.0, 1, start / t + 0.30, 4.0),
            f"arm.out.{side}": wave(t, 2.5, 2, 0.1, 5.0),
            f"elbow.{side}": wave(t, 9.0, 1, start / t + 0.32, 16.0),
            f"wrist.{side}": wave(t, 8.0, 1, start / t + 0.36, 2.0),
            f"curl.{side}": wave(t, 8.0, 1, start / t + 0.4, 20.0),
            f"shoulder.lift.{side}": wave(t, 2.5, 2, 0.35),
            f"shoulder.forward.{side}": wave(t, 5.0, 1, start / t + 0.28),
        }
    return t, True, channels


def walk_foot(side, time):
    """Where the ball is along Y: at constant speed while it stands, a smooth arc while it swings."""
    start = 0.0 if side == "L" else WALK_CYCLE / 2
    phase = (time - start) % WALK_CYCLE
    stance, swing = WALK_CYCLE * STANCE, WALK_CYCLE * (1.0 - STANCE)
    half = WALK_SPEED * stance / 2
    if phase <= stance:
        return -half + WALK_SPEED * phase - 0.4
    s = (phase - stance) / swing
    slope = WALK_SPEED * swing
    cubic = half * (1 - 3 * s * s + 2 * s**3) * 2 - half + slope * (s * (1 - s) ** 2 + s * s * (s - 1))
    return cubic - 0.4


def shake():
    t = 2.6
    fast = 2
    return t, True, {
        "pelvis.z": wave(t, 0.15, 2 * fast, 0.1, -1.3), "pelvis.x": wave(t, 0.28, fast, -0.06), "pelvis.y": [(0, 0.3)],
        "pelvis.yaw": wave(t, 1.4, fast), "pelvis.roll": wave(t, 0.9, fast, 0.1), "pelvis.pitch": wave(t, 1.0, 1, 0.0, 5.0),
        "spine.yaw": wave(t, 4.6, fast, 0.04), "spine.roll": wave(t, 1.5, fast, 0.2), "spine.pitch": wave(t, 1.0, 2, 0.2, 10.0),
        "neck.yaw": wave(t, 7.0, fast, 0.10), "neck.pitch": wave(t, 2.0, 2, 0.2, 4.0), "neck.roll": wave(t, 5.0, fast, 0.2),
        "head.yaw": wave(t, 15.0, fast, 0.14), "head.roll": wave(t, 10.0, fast, 0.25), "head.pitch": wave(t, 3.0, 2, 0.1, -2.0),
        "jaw": wave(t, 6.0, 2 * fast, 0.2, 14.0), "breath": wave(t, 0.4, 2),
        "arm.swing.L": wave(t, 12.0, fast, 0.22, 6.0), "arm.swing.R": wave(t, -12.0, fast, 0.22, 6.0),
        **both("arm.out", wave(t, 5.0, 2 * fast, 0.2, 15.0)), **both("elbow", wave(t, 9.0, fast, 0.3, 30.0)),
        **both("curl", wave(t, 8.0, 2, 0.2, 26.0)), **both("wrist", wave(t, 7.0, fast, 0.4)),
        "shoulder.lift.L": wave(t, 2.5, fast, 0.2, 4.0), "shoulder.lift.R": wave(t, -2.5, fast, 0.2, 4.0),
        "loin": [(0, -2.0)], "loin.front": [(0, -6.0)], "loin.side": wave(t, -9.0, fast, 0.05),
        **both("foot.out", [(0, 0.7)]),
    }


def swipe():
    """The right hand reaches back, sweeps across the front and up to the left shoulder."""
    t = 3.6
    return t, False, {
        "pelvis.z": [(0, -0.4), (0.9, -0.9), (1.45, -1.5), (2.2, -1.1), (t, -0.4)],
        "pelvis.x": [(0, 0), (0.9, -0.8), (1.6, 0.9), (2.4, 0.5), (t, 0)],
        "pelvis.yaw": [(0, 0), (0.9, -9), (1.55, 11), (2.3, 8), (t, 0)],
        "pelvis.pitch": [(0, 0), (0.8, -1), (1.5, 5), (2.4, 2), (t, 0)],
        "spine.yaw": [(0, 0), (0.95, -26), (1.55, 24), (1.9, 29), (2.5, 20), (t, 0)],
        "spine.pitch": [(0, 3), (0.9, -2), (1.45, 15), (2.0, 7), (t, 3)],
        "spine.roll": [(0, 0), (0.9, -5), (1.6, 5), (t, 0)],
        "neck.yaw": [(0, 0), (0.7, 10), (1.3, -6), (2.0, 10), (t, 0)], "neck.pitch": [(0, 0), (1.4, 6), (2.2, -2), (t, 0)],
        "head.yaw": [(0, 0), (0.8, 12), (1.4, -8), (2.0, 14), (t, 0)], "head.pitch": [(0, 0), (0.9, -4), (1.5, 9), (t, 0)],
        "jaw": [(0, 3), (0.8, 6), (1.3, 22), (2.1, 15), (t, 3)],
        "arm.swing.R": [(0, 2), (0.95, -24), (1.4, 40), (1.75, 66), (2.2, 72), (2.7, 40), (t, 2)],
        "arm.out.R": [(0, 2), (0.9, 44), (1.35, 34), (1.8, 10), (2.4, 8), (t, 2)],
        "arm.across.R": [(0, 0), (0.9, -14), (1.5, 12), (1.85, 34), (2.3, 36), (2.9, 12), (t, 0)],
        "elbow.R": [(0, 6), (0.9, 34), (1.4, 18), (1.9, 58), (2.3, 74), (2.9, 36), (t, 6)],
        "forearm.in.R": [(0, 0), (1.3, 0), (1.9, 18), (2.4, 20), (t, 0)],
        "wrist.R": [(0, 0), (1.0, -14), (1.6, 12), (2.2, 16), (t, 0)], "curl.R": [(0, 12), (0.9, -8), (1.6, 4), (2.1, 40), (t, 12)],
        "shoulder.lift.R": [(0, 0), (0.9, 9), (1.7, 10), (2.3, 9), (t, 0)], "shoulder.forward.R": [(0, 0), (0.9, -14), (1.7, 18), (2.4, 14), (t, 0)],
        "arm.swing.L": [(0, 2), (0.9, 14), (1.6, -20), (2.4, -12), (t, 2)], "arm.out.L": [(0, 2), (1.5, 15), (t, 2)],
        "elbow.L": [(0, 6), (0.9, 20), (1.6, 26), (t, 6)], "curl.L": [(0, 12), (1.5, 30), (t, 12)],
        "loin.side": [(0, 0), (0.9, 4), (1.5, -7), (2.1, 4), (2.7, -2), (t, 0)],
        **both("foot.out", [(0, 0)]),
    }


def stomp():
    """The right foot goes up, hangs, and slams down."""
    t = 3.6
    return t, False, {
        "pelvis.x": [(0, 0), (0.4, -0.5), (1.1, 2.6), (1.5, 2.7), (2.15, 1.0), (2.8, 0.4), (t, 0)],
        "pelvis.z": [(0, -0.4), (0.5, -1.0), (1.3, -0.6), (1.5, -0.5), (1.92, -1.7), (2.4, -1.1), (2.8, -0.7), (t, -0.4)],
        "pelvis.y": [(0, 0), (1.3, 0.7), (2.0, -0.7), (2.7, -0.3), (t, 0)],
        "pelvis.roll": [(0, 0), (1.1, 6), (1.45, 6), (1.95, -2.5), (2.5, 1), (t, 0)], "pelvis.pitch": [(0, 0), (1.35, -4), (1.9, 5), (2.4, 3), (t, 0)],
        "pelvis.yaw": [(0, 0), (1.4, -5), (1.9, 5), (t, 0)],
        "spine.pitch": [(0, 3), (0.5, 7), (1.35, -4), (1.95, 12), (2.4, 7), (2.9, 5), (t, 3)],
        "spine.roll": [(0, 0), (1.3, 5), (1.9, -5), (t, 0)], "spine.yaw": [(0, 0), (1.4, 9), (1.95, -9), (t, 0)],
        "neck.pitch": [(0, 0), (1.4, -8), (1.9, 10), (2.3, 1), (t, 0)], "head.pitch": [(0, 0), (1.4, 4), (1.92, 14), (2.3, -4), (2.7, 2), (t, 0)],
        "jaw": [(0, 3), (1.4, 10), (1.85, 24), (2.4, 8), (t, 3)],
        **both("arm.out", [(0, 2), (1.4, 28), (1.9, 22), (2.3, 22), (t, 2)]),
        **both("elbow", [(0, 6), (1.3, 30), (1.86, 34), (2.2, 30), (t, 6)]),
        "arm.swing.L": [(0, 2), (1.3, 20), (1.9, -12), (2.4, 6), (t, 2)], "arm.swing.R": [(0, 2), (1.3, -6), (1.9, 14), (t, 2)],
        **both("shoulder.lift", [(0, 0), (1.4, 7), (1.9, -4), (2.2, 3), (t, 0)]),
        **both("curl", [(0, 12), (1.3, 36), (1.9, 6), (t, 12)]), **both("wrist", [(0, 0), (1.4, 8), (1.9, -10), (2.3, 4), (t, 0)]),
        "foot.z.R": [(0, 0), (0.55, 0), (1.3, 6.0), (1.6, 6.4), (1.83, 0), (2.5, 0), (2.78, 1.1), (3.1, 0), (t, 0)],
        "foot.y.R": [(0, 0), (0.55, 0), (1.4, -3.6), (1.83, -3.0), (2.5, -3.0), (2.8, -1.4), (3.1, 0), (t, 0)],
        "foot.pitch.R": [(0, 0), (0.45, 0), (0.75, 26), (1.4, -16), (1.7, -8), (1.84, 0), (2.5, 0), (2.7, 10), (2.95, 6), (3.15, 0), (t, 0)],
        "loin.front": [(0, 0), (0.5, 0), (1.35, -42), (1.65, -44), (2.05, -8), (2.4, -14), (2.9, 0), (t, 0)],
        "loin.side": [(0, 0), (1.2, -6), (1.9, 8), (2.3, -4), (t, 0)],
    }


def stagger():
    """Hit from the front left: reels back and to its right, catches itself with a step."""
    t = 3.2
    return t, False, {
        "pelvis.y": [(0, 0), (0.5, 1.9), (0.95, 2.7), (1.6, 2.2), (2.4, 1.0), (t, 0)],
        "pelvis.x": [(0, 0), (0.6, -1.4), (1.1, -1.9), (1.9, -0.9), (t, 0)],
        "pelvis.z": [(0, -0.4), (0.3, -0.9), (0.8, -1.2), (1.1, -2.5), (1.7, -1.5), (2.4, -1.1), (t, -0.4)],
        "pelvis.pitch": [(0, 0), (0.55, -5), (1.3, 4), (2.0, 3), (t, 0)], "pelvis.roll": [(0, 0), (0.5, -5), (1.2, 3), (t, 0)],
        "pelvis.yaw": [(0, 0), (0.4, -8), (1.3, -4), (t, 0)],
        "spine.pitch": [(0, 3), (0.5, -11), (0.8, -8), (1.4, 14), (2.0, 10), (t, 3)],
        "spine.yaw": [(0, 0), (0.45, -13), (1.3, -2), (1.8, 6), (t, 0)], "spine.roll": [(0, 0), (0.4, -8), (1.2, 6), (2, -2), (t, 0)],
        "neck.pitch": [(0, 0), (0.3, -12), (1.3, 14), (2.0, 4), (t, 0)], "neck.yaw": [(0, 0), (0.3, -12), (1.2, 8), (t, 0)],
        "head.pitch": [(0, 0), (0.3, -16), (1.3, 16), (2.1, -2), (t, 0)], "head.roll": [(0, 0), (0.35, -12), (1.2, 9), (1.9, -4), (t, 0)],
        "head.yaw": [(0, 0), (0.3, -14), (1.2, 8), (t, 0)],
        "jaw": [(0, 3), (0.3, 26), (1.0, 12), (1.6, 18), (t, 3)],
        "arm.swing.L": [(0, 2), (0.5, 34), (1.2, -12), (1.9, 12), (t, 2)], "arm.swing.R": [(0, 2), (0.5, -18), (1.2, 26), (1.9, 6), (t, 2)],
        **both("arm.out", [(0, 2), (0.55, 38), (1.3, 12), (1.8, 18), (t, 2)]),
        **both("elbow", [(0, 6), (0.5, 32), (1.2, 34), (1.8, 30), (t, 6)]), **both("curl", [(0, 12), (0.5, -10), (1.3, 34), (t, 12)]),
        **both("shoulder.lift", [(0, 0), (0.5, 9), (1.3, -3), (t, 0)]), **both("wrist", [(0, 0), (0.5, -12), (1.3, 12), (t, 0)]),
        "foot.y.R": [(0, 0), (0.45, 0), (0.98, 4.6), (2.2, 4.6), (2.55, 2.2), (2.9, 0), (t, 0)],
        "foot.z.R": [(0, 0), (0.45, 0), (0.75, 1.7), (1.0, 0), (2.2, 0), (2.55, 1.2), (2.9, 0), (t, 0)],
        "foot.out.R": [(0, 0), (0.45, 0), (1.0, 0.9), (2.2, 0.9), (2.9, 0), (t, 0)],
        "foot.pitch.R": [(0, 0), (0.4, 4), (0.7, 14), (1.0, 8), (1.25, 0), (2.2, 0), (2.5, 12), (2.9, 0), (t, 0)],
        "foot.pitch.L": [(0, 0), (0.4, -3), (0.8, -3), (1.1, 0), (t, 0)],
        "loin": [(0, 0), (0.6, -9), (1.2, 8), (1.8, -4), (2.4, 2), (t, 0)], "loin.back": [(0, 0), (0.9, 4), (1.6, 12), (2.4, 5), (t, 0)],
    }


def die():
    """The knees give way, it sinks upright, then falls forward onto hands and knees and comes to rest."""
    t = 6.4
    return t, False, {
        "pelvis.z": [(0, -0.4), (0.5, 0.0), (1.25, -4.2), (1.75, -6.6), (2.1, -6.2), (2.6, -6.5), (3.0, -6.7), (3.9, -8.4), (4.15, -8.2), (4.6, -8.5), (t, -8.6)],
        "pelvis.y": [(0, 0), (0.5, 0.7), (1.75, -1.6), (2.8, -1.7), (3.9, -6.2), (4.6, -6.0), (t, -6.0)],
        "pelvis.x": [(0, 0), (0.6, -0.5), (1.75, 0.4), (3.9, 0.9), (t, 0.9)],
        "pelvis.pitch": [(0, 0), (0.5, -6), (1.7, 8), (2.1, 3), (2.8, 10), (3.95, 64), (4.25, 61), (4.8, 64), (t, 64)],
        "pelvis.roll": [(0, 0), (1.7, 4), (2.8, 3), (3.9, 9), (t, 9)], "pelvis.yaw": [(0, 0), (1.7, -6), (3.9, 8), (t, 8)],
        "spine.pitch": [(0, 3), (0.5, -14), (1.7, 20), (2.2, 9), (2.9, 10), (3.6, 14), (3.98, 30), (4.3, 22), (4.9, 26), (t, 26)],
        "spine.roll": [(0, 0), (1.7, -5), (2.6, 4), (3.9, 8), (t, 10)], "spine.yaw": [(0, 0), (0.5, 8), (1.8, -6), (3.0, 6), (3.9, 10), (t, 10)],
        "neck.pitch": [(0, 0), (0.5, -14), (1.8, 16), (2.5, 2), (3.1, -8), (3.9, -34), (4.3, -26), (t, -28)],
        "neck.yaw": [(0, 0), (2.6, 4), (3.9, 20), (t, 22)],
        "head.pitch": [(0, 0), (0.5, -16), (1.8, 16), (2.5, -6), (3.2, -8), (4.0, -26), (4.4, -16), (t, -18)],
        "head.yaw": [(0, 0), (2.6, 6), (4.0, 22), (t, 26)], "head.roll": [(0, 0), (1.8, 8), (2.6, -6), (4.0, 12), (t, 14)],
        "jaw": [(0, 3), (0.45, 28), (1.6, 12), (2.6, 20), (3.9, 10), (4.2, 22), (t, 14)],
        "arm.swing.L": [(0, 2), (0.5, -10), (1.7, 12), (2.6, 4), (3.4, 38), (4.05, 24), (4.5, 17), (t, 17)],
        "arm.swing.R": [(0, 2), (0.5, -14), (1.7, 8), (2.6, 8), (3.3, 32), (4.0, 22), (4.4, 14), (t, 14)],
        **both("arm.out", [(0, 2), (0.5, 16), (1.75, 22), (2.6, 12), (3.5, 26), (4.1, 34), (t, 36)]),
        **both("elbow", [(0, 6), (0.6, 22), (1.75, 10), (2.4, 18), (3.5, 26), (4.1, 4), (4.6, 8), (t, 8)]),
        **both("wrist", [(0, 0), (0.6, 10), (1.8, -10), (3.4, -12), (4.2, -16), (t, -14)]),
        **both("curl", [(0, 12), (0.5, -8), (1.8, 30), (3.4, 0), (4.4, 22), (t, 26)]),
        **both("shoulder.lift", [(0, 0), (0.5, 7), (1.8, -4), (3.9, 8), (t, 6)]),
        "foot.pitch.L": [(0, 0), (0.5, -2), (1.2, 36), (1.75, 74), (3.0, 76), (3.9, 84), (t, 86)],
        "foot.pitch.R": [(0, 0), (0.5, -2), (1.2, 36), (1.75, 74), (3.0, 76), (3.9, 84), (t, 86)],
        **both("foot.y", [(0, 0), (0.6, 0), (1.75, 3.0), (3.0, 3.2), (3.95, 6.8), (t, 7.0)]),
        **both("foot.out", [(0, 0), (1.75, 0.6), (t, 1.0)]), **both("foot.z", [(0, 0), (0.8, 0), (1.3, 0.5), (1.75, 0.9), (3.2, 1.2), (3.9, 1.7), (t, 1.7)]),
        "loin.front": [(0, 0), (0.6, -4), (1.75, -62), (2.2, -50), (2.8, -54), (3.9, 44), (t, 50)],
        "loin.back": [(0, 0), (1.75, 14), (2.8, 4), (3.9, -40), (4.4, -48), (t, -46)],
    }


TABLES = {"idle": idle, "walk": walk, "shake": shake, "swipe": swipe, "stomp": stomp, "stagger": stagger, "die": die}


def sampled(name, points, weights):
    """A clip's poses; the skin (points, weights) is kept out of the ground."""
    length, loops, channels = TABLES[name]()
    curves = motion.Curves(length, loops, channels)
    if name == "walk":
        curve = curves
        curves = lambda channel, time: walk_foot(channel[-1], time) if channel.startswith("foot.y") else curve(channel, time)
    frames = round(length * RATE)
    times = [(frame % frames if loops else frame) / RATE for frame in range(frames + 1)]
    poses = [motion.posed(curves, time) for time in times]
    if name == "die":
        poses = _held_up(curves, times, points, weights)
    return Clip(name, loops, poses)


def _held_up(curves, times, points, weights):
    """Raises the pelvis where the trunk would sink into the ground, then the arms sideways."""
    legs, arms = _share(weights, LEGS), [_share(weights, ARMS, side) for side in (".L", ".R")]
    trunk = (legs < 0.5) & (arms[0] < 0.5) & (arms[1] < 0.5)
    extra = {"pelvis.z": np.zeros(len(times)), "arm.out.L": np.zeros(len(times)), "arm.out.R": np.zeros(len(times))}

    def helped(channel, time):
        value = curves(channel, time)
        return value + np.interp(time, times, extra[channel]) if channel in extra else value

    def depths(part):
        return np.array([
            -DEEPEST - motion.skinned(points[part], weights[part], motion.posed(helped, time))[:, 2].min()
            for time in times
        ])

    for _ in range(3):
        extra["pelvis.z"] += _spread(np.maximum(depths(trunk), 0.0))
    for channel, arm in zip(("arm.out.L", "arm.out.R"), arms):
        for _ in range(9):
            extra[channel] += _spread(np.clip(RAISE * depths(arm > 0.5), 0.0, 25.0))
    return [motion.posed(helped, time) for time in times]


def _share(weights, names, side=""):
    """How much of each vertex follows joints whose names begin so."""
    chosen = [n for n, j in enumerate(JOINTS) if j.name.startswith(names) and j.name.endswith(side)]
    return weights[:, chosen].sum(axis=1)


def _spread(values, reach=6):
    """The largest value nearby, softened: a smooth curve that is nowhere less than `values`."""
    padded = np.pad(values, 2 * reach, mode="edge")
    window = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1)
    soft = np.hanning(2 * reach + 3)[1:-1]
    return np.convolve(window.max(axis=1), soft / soft.sum(), mode="valid")
