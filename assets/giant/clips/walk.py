"""Walking, and turning in place: steps over a ground that moves."""

import numpy as np

from ..skeleton import HEADS, INDEX
from .keys import HIT, Table, both, wave

# The stance foot goes backwards by this much, in metres per second.
WALK_SPEED = 5.0
WALK_CYCLE = 3.6
# Degrees a second of the turns, and one step with each foot, in seconds.
TURN_RATE = 20.0
TURN_CYCLE = 3.0
# The share of a cycle for which a foot stands.
STANCE = 0.62
# Toes leave the ground this long before the foot swings, in seconds.
PEEL = 0.26


def walk():
    t = WALK_CYCLE
    swing = t * (1.0 - STANCE)
    channels = {
        "pelvis.z": wave(t, 0.27, 2, 0.43, -1.65), "pelvis.x": wave(t, 0.74, 1, 0.06), "pelvis.y": wave(t, 0.19, 2, 0.12, -0.5),
        "pelvis.yaw": wave(t, 7.97, 1, -0.25), "pelvis.roll": wave(t, -3.25, 1, 0.08), "pelvis.pitch": wave(t, 1.00, 2, 0.18, 4),
        "spine.yaw": wave(t, -17.04, 1, -0.22), "spine.roll": wave(t, 4.44, 1, 0.11), "spine.pitch": wave(t, 1.24, 2, -0.41, 6),
        "neck.yaw": wave(t, 7.03, 1, -0.20), "neck.pitch": wave(t, 2.59, 2, 0.30, -4), "head.yaw": wave(t, 5.0, 1, -0.2),
        "head.pitch": wave(t, 3.5, 2, 0.35, -5.0), "head.roll": wave(t, -3.0, 1, 0.1), "jaw": wave(t, 4.0, 2, 0.3, 5.0),
        "breath": wave(t, 1.0, 1),
        "loin": wave(t, 7.0, 2, 0.1), "loin.front": [(0, -11.0)], "loin.back": [(0, 9.0)], "loin.side": wave(t, -4.0, 1, 0.1),
    }
    for side, start in (("L", 0.0), ("R", t / 2)):
        # The foot comes down at `start`, half a stride ahead (-Y), and leaves at `off`.
        off = start + t * STANCE
        channels |= {
            f"foot.y.{side}": lambda times, start=start: -0.4 + WALK_SPEED * _along(times - start, t),
            f"foot.z.{side}": [(start, 0, HIT), (off - PEEL, 0), (off + 0.3 * swing, 0.9), (off + 0.62 * swing, 1.5), (off + 0.85 * swing, 0.6)],
            f"foot.pitch.{side}": [(start, 0), (start + 0.68 * t * STANCE, 0), (off, 17), (off + 0.3 * swing, 34), (off + 0.75 * swing, -9)],
            f"foot.out.{side}": [(start, -0.9), (off, -0.9), (off + 0.5 * swing, -0.2)],
            f"arm.swing.{side}": wave(t, 17.0, 1, start / t + 0.30, 4.0),
            f"arm.out.{side}": wave(t, 2.5, 2, 0.1, 5.0),
            f"elbow.{side}": wave(t, 9.0, 1, start / t + 0.32, 16.0),
            f"wrist.{side}": wave(t, 8.0, 1, start / t + 0.36, 2.0),
            f"curl.{side}": wave(t, 8.0, 1, start / t + 0.4, 20.0),
            f"shoulder.lift.{side}": wave(t, 2.5, 2, 0.35),
            f"shoulder.forward.{side}": wave(t, 5.0, 1, start / t + 0.28),
        }
    steps = [("step_left", 0.0), ("step_right", t / 2)]
    return Table(t, channels, loops=True, markers=steps, speed=WALK_SPEED)


def turn_left():
    """Steps in place while the ground under it turns to the right."""
    t = TURN_CYCLE
    swing = t * (1.0 - STANCE)
    channels = {
        "pelvis.z": wave(t, 0.17, 2, 0.43, -1.15), "pelvis.x": wave(t, 0.85, 1, 0.07), "pelvis.y": wave(t, 0.04, 2, 0.19, -0.2),
        "pelvis.roll": wave(t, -3.12, 1, 0.08), "pelvis.yaw": wave(t, 0.32, 2, 0.29, 1), "pelvis.pitch": wave(t, 0.45, 2, 0.21, 2),
        "spine.yaw": wave(t, 1.10, 2, 0.22, 7), "spine.roll": wave(t, 2.56, 1, 0.10, -1.5), "spine.pitch": wave(t, 0.65, 2, 0.17, 5),
        "neck.yaw": wave(t, 1.19, 2, 0.19, 9), "neck.pitch": wave(t, 1.40, 2, 0.29), "head.yaw": wave(t, 1.2, 2, 0.2, 10.0),
        "head.pitch": wave(t, 1.5, 2, 0.35, 2.0), "head.roll": wave(t, -2.5, 1, 0.1), "jaw": wave(t, 3.0, 2, 0.3, 4.0),
        "breath": wave(t, 1.0, 1), "loin": wave(t, 3.0, 2, 0.1), "loin.front": [(0, -6.0)], "loin.side": wave(t, -4.0, 1, 0.1),
        "arm.swing.L": wave(t, 6.0, 1, 0.3, -2.0), "arm.swing.R": wave(t, -6.0, 1, 0.3, 6.0),
        **both("arm.out", wave(t, 2.0, 2, 0.1, 7.0)), **both("elbow", wave(t, 4.0, 2, 0.3, 16.0)),
        **both("wrist", wave(t, 4.0, 2, 0.36)), **both("curl", wave(t, 5.0, 1, 0.4, 18.0)),
        **both("shoulder.lift", wave(t, 2.0, 2, 0.35)),
    }
    for side, start in (("L", 0.0), ("R", t / 2)):
        sign, off = (1 if side == "L" else -1), start + t * STANCE
        channels |= _turning_foot(side, sign, start)
        channels |= {
            f"foot.z.{side}": [(start, 0, HIT), (off - PEEL, 0), (off + 0.3 * swing, 0.8), (off + 0.62 * swing, 1.3), (off + 0.85 * swing, 0.5)],
            f"foot.pitch.{side}": [(start, 0), (start + 0.68 * t * STANCE, 0), (off, 9), (off + 0.35 * swing, 16), (off + 0.8 * swing, -3)],
        }
    steps = [("step_left", 0.0), ("step_right", t / 2)]
    return Table(t, channels, loops=True, markers=steps, turn=TURN_RATE)


def _turning_foot(side, sign, start):
    """A foot that stands on a ground which turns to the right, and steps back to the left meanwhile."""
    ball = HEADS[INDEX[f"toe.{side}"]] + np.array([-0.5 * sign, 0.0, 0.0])
    angle = lambda times: -TURN_RATE * _along(times - start, TURN_CYCLE)
    turned = lambda times: (np.cos(np.radians(angle(times))), np.sin(np.radians(angle(times))))

    def x(times):
        c, s = turned(times)
        return c * ball[0] - s * ball[1] - HEADS[INDEX[f"toe.{side}"]][0]

    def y(times):
        c, s = turned(times)
        return s * ball[0] + c * ball[1] - ball[1]

    return {f"foot.x.{side}": x, f"foot.y.{side}": y, f"foot.yaw.{side}": angle}


def _along(times, cycle):
    """Seconds of ground from the middle of a stance: at constant speed while it stands, a smooth arc back."""
    stance, swing = cycle * STANCE, cycle * (1.0 - STANCE)
    phase = times % cycle
    s = np.clip((phase - stance) / swing, 0.0, 1.0)
    back = stance * (0.5 - 3 * s * s + 2 * s**3) + swing * (s * (1 - s) ** 2 + s * s * (s - 1))
    return np.where(phase <= stance, phase - stance / 2, back)
