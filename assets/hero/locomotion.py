"""Clips that stand and go: idle, walk, run, walk_back, strafes, turns."""

import numpy as np
from giant.curves import Curves

from .table import both, standing, wave

WALK, RUN, BACK, STRAFE = 1.4, 4.0, 1.2, 1.2
# Degrees per second at which the turns' feet fit the ground.
TURN = 90.0


class Foot:
    """The path of one foot over a cycle: it stands and goes with the ground, then swings forward."""

    def __init__(self, cycle, start, stance, velocity, middle, lift, skew=0.42):
        self.cycle, self.start, self.stance = cycle, start, stance
        self.velocity, self.middle = np.asarray(velocity, float), np.asarray(middle, float)
        self.lift, self.skew = lift, skew

    def phase(self, time):
        """0 where the foot plants, `stance` where it leaves, up to 1."""
        return (time / self.cycle - self.start) % 1.0

    def place(self, time):
        """The contact point against its middle (x, z), and its height."""
        phase = self.phase(time)
        reach = self.velocity * self.stance * self.cycle / 2
        if phase < self.stance:
            return (*(self.middle + reach * (1.0 - 2.0 * phase / self.stance)), 0.0)
        s = (phase - self.stance) / (1.0 - self.stance)
        # A cubic that leaves and meets the ground at the ground's speed.
        slope = -self.velocity * (1.0 - self.stance) * self.cycle
        x, z = (
            self.middle
            + -reach * (1 + 2 * s) * (1 - s) ** 2
            + slope * s * (1 - s) ** 2
            + reach * s * s * (3 - 2 * s)
            - slope * s * s * (1 - s)
        )
        bump = s ** (1.0 / (1.0 + self.skew))
        return x, z, self.lift * np.sin(np.pi * bump) ** 2

    def channels(self, side, pitch):
        """The foot's channels; `pitch` are keys (phase, degrees)."""
        phases, degrees = (np.array(column, float) for column in zip(*pitch))
        return {
            f"foot.x{side}": lambda t: self.place(t)[0],
            f"foot.z{side}": lambda t: self.place(t)[1],
            f"foot.y{side}": lambda t: self.place(t)[2],
            f"foot.pitch{side}": _periodic(phases, degrees, self.phase),
        }

    def stands(self, side):
        """When the foot stands, within two cycles."""
        first = self.start * self.cycle
        return [(side, first + n * self.cycle, first + (n + self.stance) * self.cycle) for n in (-1, 0)]


def _periodic(phases, degrees, phase):
    """A smooth closed curve through keys of the phase, without overshoot."""
    curve = Curves(1.0, True, {"v": list(zip(phases, degrees))})
    return lambda time: curve("v", phase(time))


def _pair(cycle, stance, velocity, middle, lift, late=0.5, skew=0.42):
    """Both feet: the left one plants at 0, the right one `late` of a cycle after it."""
    return [
        (".L", Foot(cycle, 0.0, stance, velocity, middle[0], lift, skew)),
        (".R", Foot(cycle, late, stance, velocity, middle[1], lift, skew)),
    ]


def _steps(feet):
    """Markers where the feet plant, and when they stand."""
    names = {".L": "step_left", ".R": "step_right"}
    return {
        "markers": [(foot.start * foot.cycle, names[side]) for side, foot in feet],
        "stands": [span for side, foot in feet for span in foot.stands(side)],
    }


def idle():
    t = 4.0
    return (
        t,
        True,
        {
            **standing(),
            "hips.x": wave(t, 0.014, 0.25),
            "hips.y": wave(t, 0.003, 0.1, 2, -0.016),
            "hips.roll": wave(t, -1.1, 0.25),
            "hips.yaw": wave(t, 1.2, 0.4),
            "spine.roll": wave(t, 1.6, 0.27),
            "spine.yaw": wave(t, 1.5, 0.55),
            "spine.pitch": wave(t, 0.8, 0.3, 2, 1.5),
            "breath": wave(t, 1.5, 0.25, 2),
            "head.yaw": [(0, 2), (1.1, 7), (2.0, 5), (3.0, -6), (3.6, -3)],
            "head.pitch": wave(t, 1.2, 0.6, 2, -2.0),
            "head.roll": wave(t, 1.0, 0.4),
            "arm.swing.L": wave(t, 1.6, 0.35, 2, 2.0),
            "arm.swing.R": wave(t, 1.6, 0.45, 2, 0.0),
            "arm.out.L": wave(t, 1.0, 0.35, 2, 11.0),
            "arm.out.R": wave(t, 1.0, 0.35, 2, 11.0),
            **both("elbow", wave(t, 2.0, 0.4, 2, 16.0)),
            "curl.L": wave(t, 5.0, 0.2, 1, 26.0),
            "curl.R": wave(t, 5.0, 0.7, 1, 26.0),
            "foot.out.L": 0.018,
            "foot.out.R": 0.018,
            "foot.yaw.L": 9.0,
            "foot.yaw.R": 12.0,
            "foot.z.L": 0.012,
            "foot.z.R": -0.015,
            "scabbard": wave(t, 0.8, 0.4, 2),
        },
        {"stands": [(side, 0.0, t) for side in (".L", ".R")]},
    )


def walk():
    t = 1.0
    feet = _pair(t, 0.61, (0.0, WALK), ((-0.012, -0.050), (0.012, -0.050)), 0.055)
    pitch = [(0.0, -17), (0.10, 0), (0.30, 0), (0.39, 6), (0.51, 28), (0.61, 52), (0.69, 58), (0.82, 12), (0.93, -16)]
    return (
        t,
        True,
        {
            **standing(),
            **both("foot.yaw", 5.0),
            **both("foot.out", 0.0),
            **feet[0][1].channels(".L", pitch),
            **feet[1][1].channels(".R", pitch),
            "hips.y": wave(t, 0.015, 0.60, 2, -0.050),
            "hips.x": wave(t, 0.020, 0.27),
            "hips.z": wave(t, 0.008, 0.3, 2),
            "hips.yaw": wave(t, -6.0, 0.0),
            "hips.roll": wave(t, -3.2, 0.22),
            "hips.pitch": wave(t, 1.0, 0.1, 2, 3.0),
            "spine.yaw": wave(t, 12.0, 0.03),
            "spine.roll": wave(t, 3.6, 0.24),
            "spine.pitch": wave(t, 1.2, 0.2, 2, 1.5),
            "neck.yaw": wave(t, -3.0, 0.05),
            "head.yaw": wave(t, -3.0, 0.07),
            "head.pitch": wave(t, 1.2, 0.35, 2, -3.5),
            "head.roll": wave(t, -0.8, 0.25),
            "arm.swing.L": wave(t, -23.0, 0.03, 1, 2.0),
            "arm.swing.R": wave(t, 23.0, 0.03, 1, 2.0),
            "elbow.L": wave(t, -13.0, 0.08, 1, 26.0),
            "elbow.R": wave(t, 13.0, 0.08, 1, 26.0),
            **both("arm.out", wave(t, 1.5, 0.1, 2, 9.0)),
            "wrist.L": wave(t, -7.0, 0.16, 1, 4.0),
            "wrist.R": wave(t, 7.0, 0.16, 1, 4.0),
            "shoulder.forward.L": wave(t, -4.0, 0.02),
            "shoulder.forward.R": wave(t, 4.0, 0.02),
            "curl.L": wave(t, 5.0, 0.2, 1, 32.0),
            "curl.R": wave(t, 5.0, 0.7, 1, 32.0),
            "scabbard": wave(t, 4.0, 0.35, 2),
            "scabbard.out": wave(t, 3.0, 0.4),
        },
        {**_steps(feet), "travel": (0.0, WALK, 0.0)},
    )


def run():
    t = 0.7
    feet = _pair(t, 0.28, (0.0, RUN), ((-0.035, -0.110), (0.035, -0.110)), 0.24, skew=-0.08)
    pitch = [(0.0, -7), (0.07, 0), (0.13, 4), (0.21, 28), (0.28, 58), (0.42, 98), (0.56, 92), (0.74, 34), (0.90, -8)]
    return (
        t,
        True,
        {
            **standing(),
            **both("foot.yaw", 2.0),
            **both("foot.out", 0.0),
            **feet[0][1].channels(".L", pitch),
            **feet[1][1].channels(".R", pitch),
            # Highest in flight, which is before each foot plants.
            "hips.y": wave(t, 0.036, 0.84, 2, -0.084),
            "hips.x": wave(t, 0.012, 0.18),
            "hips.z": wave(t, 0.012, 0.4, 2),
            "hips.yaw": wave(t, -9.0, 0.92),
            "hips.roll": wave(t, -3.0, 0.16),
            "hips.pitch": wave(t, 2.0, 0.2, 2, 11.0),
            "spine.yaw": wave(t, 21.0, 0.94),
            "spine.roll": wave(t, 3.5, 0.18),
            "spine.pitch": wave(t, 2.5, 0.25, 2, 4.0),
            "neck.yaw": wave(t, -6.0, 0.95),
            "head.yaw": wave(t, -6.0, 0.96),
            "neck.pitch": -5.0,
            "head.pitch": wave(t, 2.0, 0.45, 2, -6.0),
            "arm.swing.L": wave(t, -42.0, 0.93, 1, -6.0),
            "arm.swing.R": wave(t, 42.0, 0.93, 1, -6.0),
            "elbow.L": wave(t, -16.0, 0.98, 1, 84.0),
            "elbow.R": wave(t, 16.0, 0.98, 1, 84.0),
            **both("arm.out", wave(t, 2.0, 0.2, 2, 13.0)),
            "arm.twist.L": wave(t, -12.0, 0.93, 1, 22.0),
            "arm.twist.R": wave(t, 12.0, 0.93, 1, 22.0),
            "shoulder.forward.L": wave(t, -8.0, 0.92),
            "shoulder.forward.R": wave(t, 8.0, 0.92),
            **both("shoulder.lift", wave(t, 2.0, 0.95, 2, 2.0)),
            **both("curl", 52.0),
            **both("thumb", 25.0),
            "scabbard": wave(t, 9.0, 0.30, 2, -8.0),
            "scabbard.out": wave(t, 5.0, 0.3, 1, 4.0),
        },
        {**_steps(feet), "travel": (0.0, RUN, 0.0)},
    )


def walk_back():
    t = 0.9
    feet = _pair(t, 0.62, (0.0, -BACK), ((0.0, -0.045), (0.0, -0.045)), 0.07, skew=0.0)
    # He lands on the ball, and rolls over the heel.
    pitch = [(0.0, 18), (0.12, 5), (0.22, 0), (0.45, 0), (0.56, -8), (0.64, -12), (0.78, 6), (0.92, 20)]
    return (
        t,
        True,
        {
            **standing(),
            **both("foot.yaw", 9.0),
            **both("foot.out", 0.012),
            **feet[0][1].channels(".L", pitch),
            **feet[1][1].channels(".R", pitch),
            "hips.y": wave(t, 0.014, 0.62, 2, -0.055),
            "hips.x": wave(t, 0.024, 0.28),
            "hips.yaw": wave(t, 5.0, 0.0),
            "hips.roll": wave(t, -2.6, 0.25),
            "hips.pitch": 2.0,
            "spine.pitch": wave(t, 1.0, 0.1, 2, 5.0),
            "spine.yaw": wave(t, -9.0, 0.03),
            "spine.roll": wave(t, 3.0, 0.25),
            "head.yaw": wave(t, 4.0, 0.05, 1, 6.0),
            "neck.yaw": 5.0,
            "head.pitch": -3.0,
            "arm.swing.L": wave(t, 14.0, 0.05, 1, 3.0),
            "arm.swing.R": wave(t, -14.0, 0.05, 1, 3.0),
            **both("arm.out", 15.0),
            "elbow.L": wave(t, 8.0, 0.1, 1, 30.0),
            "elbow.R": wave(t, -8.0, 0.1, 1, 30.0),
            **both("curl", 28.0),
            "scabbard": wave(t, 3.0, 0.3, 2),
        },
        {**_steps(feet), "travel": (0.0, -BACK, 0.0)},
    )


def _strafe(sign):
    """A shuffle to the left (sign 1) or to the right: the feet never cross."""
    t, late, spread = 0.6, 0.45, 0.135
    lead, trail = (".L", ".R") if sign > 0 else (".R", ".L")
    velocity = (sign * STRAFE, 0.0)
    feet = [
        (lead, Foot(t, 0.0, 0.56, velocity, (sign * spread, 0.015), 0.045, 0.0)),
        (trail, Foot(t, late, 0.56, velocity, (-sign * spread, -0.02), 0.045, 0.0)),
    ]
    pitch = [(0.0, 3), (0.08, 0), (0.38, 0), (0.56, 20), (0.70, 16), (0.92, 5)]
    return (
        t,
        True,
        {
            **standing(),
            **both("foot.out", 0.0),
            **both("foot.yaw", 6.0),
            **feet[0][1].channels(lead, pitch),
            **feet[1][1].channels(trail, pitch),
            "hips.y": wave(t, 0.022, 0.62, 1, -0.105),
            "hips.x": wave(t, sign * 0.012, 0.35),
            "hips.roll": wave(t, -sign * 2.0, 0.2, 1, sign * 2.0),
            "hips.yaw": wave(t, sign * 3.0, 0.3),
            "hips.pitch": 7.0,
            "spine.pitch": 9.0,
            "spine.roll": wave(t, sign * 2.5, 0.3, 1, -sign * 1.0),
            "neck.pitch": -5.0,
            "head.pitch": -7.0,
            "head.yaw": sign * 4.0,
            **both("arm.out", wave(t, 3.0, 0.7, 1, 22.0)),
            **both("arm.swing", wave(t, 3.0, 0.5, 1, 14.0)),
            **both("elbow", wave(t, 5.0, 0.75, 1, 48.0)),
            **both("arm.twist", 20.0),
            **both("curl", 34.0),
            "scabbard.out": wave(t, 4.0, 0.4),
        },
        {**_steps(feet), "travel": (sign * STRAFE, 0.0, 0.0)},
    )


def strafe_left():
    return _strafe(1.0)


def strafe_right():
    return _strafe(-1.0)


class Pivot(Foot):
    """A foot that stands while the body turns over it: it goes round the origin."""

    def __init__(self, cycle, start, stance, rate, ball, lift):
        super().__init__(cycle, start, stance, (0.0, 0.0), (0.0, 0.0), lift, 0.0)
        self.rate, self.ball = rate, np.asarray(ball, float)

    def angle(self, time):
        """How far the foot is turned to the left of its middle, in degrees."""
        phase = self.phase(time)
        reach = self.rate * self.stance * self.cycle / 2
        if phase < self.stance:
            return reach * (1.0 - 2.0 * phase / self.stance)
        s = (phase - self.stance) / (1.0 - self.stance)
        slope = -self.rate * (1.0 - self.stance) * self.cycle
        return (
            -reach * (1 + 2 * s) * (1 - s) ** 2
            + slope * s * (1 - s) ** 2
            + reach * s * s * (3 - 2 * s)
            - slope * s * s * (1 - s)
        )

    def place(self, time):
        angle = np.radians(self.angle(time))
        x, z = self.ball
        turned = np.array([np.cos(angle) * x + np.sin(angle) * z, np.cos(angle) * z - np.sin(angle) * x])
        height = super().place(time)[2]
        return (*(turned - self.ball), height)


def _turn(sign):
    t = 1.0
    out = 0.112
    feet = [
        (side, Pivot(t, start, 0.64, sign * TURN, (s * out, 0.108), 0.05))
        for side, start, s in ((".L", 0.0 if sign > 0 else 0.5, 1.0), (".R", 0.5 if sign > 0 else 0.0, -1.0))
    ]
    pitch = [(0.0, 3), (0.06, 0), (0.50, 0), (0.58, 5), (0.64, 14), (0.76, 22), (0.92, 8)]
    table = {**standing(), **both("foot.out", 0.0)}
    for side, foot in feet:
        table |= foot.channels(side, pitch)
        flip = 1.0 if side == ".L" else -1.0
        table[f"foot.yaw{side}"] = lambda time, foot=foot, flip=flip: flip * foot.angle(time)
    return (
        t,
        True,
        table
        | {
            "hips.y": wave(t, 0.010, 0.6, 2, -0.035),
            "hips.x": wave(t, 0.022, 0.28 if sign > 0 else 0.78),
            "hips.roll": wave(t, -2.0, 0.25 if sign > 0 else 0.75),
            "hips.yaw": wave(t, sign * 3.0, 0.1, 2),
            "spine.yaw": wave(t, sign * 3.0, 0.15, 2, sign * 7.0),
            "neck.yaw": sign * 7.0,
            "head.yaw": wave(t, sign * 2.0, 0.1, 2, sign * 10.0),
            "spine.roll": wave(t, 2.4, 0.27 if sign > 0 else 0.77),
            "arm.swing.L": wave(t, 6.0, 0.1, 1, 2.0 - sign * 5.0),
            "arm.swing.R": wave(t, -6.0, 0.1, 1, 2.0 + sign * 5.0),
            **both("elbow", wave(t, 4.0, 0.3, 2, 22.0)),
            **both("arm.out", wave(t, 1.5, 0.4, 2, 13.0)),
            "scabbard": wave(t, 2.0, 0.3, 2),
        },
        {**_steps(feet), "travel": (0.0, 0.0, sign * TURN)},
    )


def turn_left():
    return _turn(1.0)


def turn_right():
    return _turn(-1.0)


TABLES = {
    "idle": idle,
    "walk": walk,
    "run": run,
    "walk_back": walk_back,
    "strafe_left": strafe_left,
    "strafe_right": strafe_right,
    "turn_left": turn_left,
    "turn_right": turn_right,
}
