"""Clips with sword and bow: stab, swing, unsheathe, sheathe, draw, aim, loose."""

import numpy as np
from giant.field import smooth_step

from .table import both, fist, fist_keys, pose_keys, standing, sword_fist, unit, wave

SWORD = ("sword", "scabbard", "bow_back", "quiver")
SHEATHED = ("scabbard", "sword_sheathed", "bow_back", "quiver")
BOW = ("bow", "scabbard", "sword_sheathed", "quiver")
BOW_AND_ARROW = (*BOW, "arrow")
# From the right fist to the left one along the hilt, to the pommel, in metres.
FISTS = 0.088
_GRIPPED = {**both("curl", 84.0), **both("thumb", 44.0)}


def _stab(keys):
    """Both hands from keys (time, the right fist's place, the blade's direction); held with the blade down."""
    right, left = [], []
    for time, grip, blade in keys:
        hilt = -unit(blade)
        fingers = np.array([0.0, 0.25, 1.0]) if abs(hilt[2]) < 0.9 else np.array([0.0, -1.0, 0.2])
        right.append((time, grip, hilt, fingers + (0.5, 0.0, 0.0)))
        left.append((time, np.asarray(grip) + FISTS * hilt, hilt, fingers - (0.5, 0.0, 0.0)))
    return {**fist_keys(".R", right), **fist_keys(".L", left)}


_RAISED = ((0.0, 1.80, 0.13), (0.0, -0.93, 0.36))
_STRUCK = ((0.0, 0.92, 0.47), (0.0, -0.96, 0.28))
_BRACED = {
    "foot.z.L": 0.13,
    "foot.z.R": -0.12,
    "foot.out.L": 0.04,
    "foot.out.R": 0.045,
    "foot.yaw.L": 6.0,
    "foot.yaw.R": 20.0,
}
_WIDE = {"elbow.to.L": (0.85, -0.15, 0.45), "elbow.to.R": (-0.85, -0.15, 0.45)}


def stab_raise():
    t = 0.5
    stand = standing()
    table = pose_keys(
        stand,
        [
            (0.18, {"hips.y": -0.10, "hips.pitch": 6, "spine.pitch": 12, "head.pitch": 4}),
            (
                t,
                {
                    "hips.y": -0.045,
                    "hips.z": -0.01,
                    "hips.pitch": -5,
                    "spine.pitch": -13,
                    "neck.pitch": 8,
                    "head.pitch": 18,
                },
            ),
        ],
    )
    table |= _stab(
        [
            (0.0, (-0.05, 1.00, 0.33), (0.05, -0.96, 0.30)),
            (0.16, (-0.03, 1.02, 0.36), (0.03, -0.96, 0.30)),
            (0.34, (0.0, 1.50, 0.36), (0.0, -0.92, 0.38)),
            (t, *_RAISED),
        ]
    )
    table |= _GRIPPED | _WIDE | {"sword.flip": 1.0}
    table["elbow.to.L"] = [(0.0, (0.8, -0.5, -0.1)), (t, (0.85, -0.15, 0.45))]
    table["elbow.to.R"] = [(0.0, (-0.8, -0.5, -0.1)), (t, (-0.85, -0.15, 0.45))]
    for name, value in _BRACED.items():
        table[name] = [(0.0, value)]
    return t, False, table, {"shown": [(0.0, SWORD)], "stands": [(side, 0.0, t) for side in (".L", ".R")]}


def _held():
    """The last pose of `stab_raise`, as numbers."""
    table = {name: (value[-1][1] if isinstance(value, list) else value) for name, value in stab_raise()[2].items()}
    return table


def stab_hold():
    t = 1.0
    table = _held()
    for name, size, count in (
        ("hips.x", 0.0022, 4),
        ("hips.z", 0.0018, 5),
        ("spine.roll", 0.35, 6),
        ("spine.yaw", 0.30, 5),
        ("head.roll", 0.4, 4),
    ):
        table[name] = wave(t, size, 0.2 * count, count, table.get(name, 0.0))
    table["breath"] = wave(t, 1.6, 0.3)
    frames = 15
    keys = []
    for number in range(frames):
        time = t * number / frames
        turn = 2 * np.pi * number / frames
        grip, blade = _RAISED
        keys.append(
            (
                time,
                np.add(
                    grip,
                    (0.003 * np.cos(4 * turn), 0.004 * np.cos(turn) - 0.004, 0.003 * np.cos(3 * turn + 1.0) - 0.0016),
                ),
                np.add(blade, (0.012 * np.sin(4 * turn), 0.0, 0.010 * np.sin(3 * turn))),
            )
        )
    table |= _stab(keys)
    return t, True, table, {"shown": [(0.0, SWORD)], "stands": [(side, 0.0, t) for side in (".L", ".R")]}


def stab_strike():
    t = 0.35
    held = _held()
    table = pose_keys(
        held,
        [
            (0.06, {"hips.y": -0.03, "spine.pitch": -17, "hips.pitch": -6}),
            (
                0.20,
                {
                    "hips.y": -0.36,
                    "hips.z": 0.03,
                    "hips.pitch": 24,
                    "spine.pitch": 34,
                    "neck.pitch": -4,
                    "head.pitch": -2,
                },
            ),
            (0.27, {"hips.y": -0.375, "spine.pitch": 38, "head.pitch": 6}),
            (
                t,
                {
                    "hips.y": -0.35,
                    "hips.z": 0.02,
                    "hips.pitch": 23,
                    "spine.pitch": 33,
                    "neck.pitch": -6,
                    "head.pitch": 0,
                },
            ),
        ],
    )
    table |= _stab(
        [
            (0.0, *_RAISED),
            (0.06, (0.0, 1.82, 0.09), (0.0, -0.95, 0.30)),
            (0.13, (0.0, 1.42, 0.42), (0.0, -0.93, 0.36)),
            (0.20, (0.0, 0.80, 0.50), (0.0, -0.985, 0.17)),
            (0.27, (0.0, 0.77, 0.50), (0.0, -0.985, 0.17)),
            (t, (0.0, 0.80, 0.50), (0.0, -0.985, 0.17)),
        ]
    )
    table |= _GRIPPED | {"sword.flip": 1.0, "knee.out.L": 6.0, "knee.out.R": 10.0}
    for side, sign in ((".L", 1.0), (".R", -1.0)):
        table[f"elbow.to{side}"] = [
            (0.0, (0.85 * sign, -0.15, 0.45)),
            (0.2, (0.9 * sign, -0.2, -0.1)),
            (t, (0.9 * sign, -0.2, -0.1)),
        ]
    table["foot.pitch.R"] = [(0.0, 0.0), (0.06, 0.0), (0.20, 30.0), (t, 30.0)]
    for name, value in _BRACED.items():
        table[name] = [(0.0, value)]
    return t, False, table, {"shown": [(0.0, SWORD)], "markers": [(0.20, "hit")], "stands": [(".L", 0.0, t)]}


def swing():
    """A slash from right to left: the hips lead, the blade comes last."""
    t = 0.6
    table = pose_keys(
        standing() | _BRACED,
        [
            (
                0.20,
                {
                    "hips.y": -0.07,
                    "hips.yaw": -24,
                    "hips.z": -0.03,
                    "spine.yaw": -34,
                    "spine.pitch": 2,
                    "spine.roll": -4,
                    "neck.yaw": 20,
                    "head.yaw": 30,
                    "arm.swing.L": 40,
                    "arm.out.L": 30,
                    "elbow.L": 50,
                },
            ),
            (
                0.33,
                {
                    "hips.y": -0.12,
                    "hips.yaw": 14,
                    "hips.z": 0.05,
                    "spine.yaw": 8,
                    "spine.pitch": 10,
                    "spine.roll": 3,
                    "neck.yaw": -4,
                    "head.yaw": -10,
                    "arm.swing.L": 4,
                    "arm.out.L": 40,
                    "elbow.L": 56,
                },
            ),
            (
                0.43,
                {
                    "hips.y": -0.11,
                    "hips.yaw": 24,
                    "hips.z": 0.05,
                    "spine.yaw": 32,
                    "spine.pitch": 12,
                    "neck.yaw": -18,
                    "head.yaw": -26,
                    "arm.swing.L": -26,
                    "arm.out.L": 38,
                    "elbow.L": 50,
                },
            ),
            (
                t,
                {
                    **standing(),
                    "hips.y": -0.04,
                    "hips.yaw": 4,
                    "hips.z": 0.0,
                    "spine.yaw": 6,
                    "spine.roll": 0,
                    "neck.yaw": -2,
                    "head.yaw": -6,
                },
            ),
        ],
    )
    table |= fist_keys(
        ".R",
        [
            (0.0, (-0.26, 0.98, 0.24), (0.12, 0.50, 0.86), (0.1, -0.8, 0.5)),
            (0.10, (-0.40, 1.22, 0.10), (-0.2, 0.85, 0.45), (0.2, -0.4, 0.9)),
            (0.20, (-0.47, 1.55, -0.06), (-0.35, 0.62, -0.70), (0.3, 0.75, 0.6)),
            (0.27, (-0.42, 1.48, 0.30), (-0.85, 0.40, 0.05), (0.2, 0.1, 1.0)),
            (0.33, (-0.02, 1.28, 0.60), (-0.35, 0.10, 0.93), (0.93, -0.1, 0.35)),
            (0.39, (0.32, 1.10, 0.42), (0.72, -0.22, 0.66), (0.65, -0.15, -0.75)),
            (0.46, (0.32, 1.0, 0.22), (0.80, -0.30, -0.52), (-0.4, -0.5, -0.75)),
            (t, (0.02, 0.98, 0.34), (0.55, 0.30, 0.75), (0.6, -0.6, 0.1)),
        ],
    )
    table |= {
        "elbow.to.R": [
            (0.0, (-0.6, -0.6, -0.5)),
            (0.20, (-0.8, -0.3, -0.5)),
            (0.33, (-0.7, -0.7, -0.1)),
            (t, (-0.6, -0.7, -0.3)),
        ]
    }
    table |= {
        "curl.R": 84.0,
        "thumb.R": 44.0,
        "foot.pitch.R": [(0.0, 0.0), (0.24, 0.0), (0.36, 26.0), (0.48, 28.0), (t, 0.0)],
    }
    for name, value in _BRACED.items():
        table[name] = [(0.0, value)]
    return t, False, table, {"shown": [(0.0, SWORD)], "markers": [(0.33, "hit")], "stands": [(".L", 0.0, t)]}


# The sword in the scabbard while he draws or sheathes it: its grip, and where its blade points.
_IN_SCABBARD = (0.1755, 1.0135, 0.0835), (0.189, -0.761, -0.621)
# The left hand about the scabbard meanwhile.
_ON_SCABBARD = (0.205, 0.905, -0.008), (-0.19, 0.76, 0.62), (0.15, -0.65, 0.72)


def _left_on_scabbard(take, leave, end):
    """The left hand goes to the scabbard's mouth, and comes back."""
    return fist_keys(".L", [(0.0, *_ON_SCABBARD)]) | {
        "elbow.to.L": (0.75, -0.1, -0.75),
        "loose.L": [(0.0, 1.0), (take, 0.0), (leave, 0.0), (end, 1.0)],
        "curl.L": [(0.0, 24.0), (take - 0.04, 18.0), (take + 0.04, 70.0), (leave, 70.0), (end, 24.0)],
        "thumb.L": [(0.0, 0.0), (take, 30.0), (leave, 30.0), (end, 0.0)],
    }


def unsheathe():
    t = 0.5
    swap = 0.20
    table = pose_keys(
        standing(),
        [
            (
                0.18,
                {"hips.y": -0.04, "hips.yaw": 8, "spine.yaw": 16, "spine.pitch": 8, "head.pitch": 4, "head.yaw": -10},
            ),
            (
                0.34,
                {"hips.y": -0.05, "hips.yaw": -8, "spine.yaw": -12, "spine.pitch": 2, "head.pitch": -2, "head.yaw": 12},
            ),
            (t, {"hips.y": -0.03, "hips.yaw": -2, "spine.yaw": -4, "spine.pitch": 2, "head.yaw": 4}),
        ],
    )
    table |= fist_keys(
        ".R",
        [
            (0.0, (-0.27, 0.82, 0.08), (0.0, 0.1, 1.0), (0.0, -1.0, 0.1)),
            (0.11, (-0.08, 0.98, 0.25), (-0.68, -0.68, 0.27), (0.7, -0.7, 0.0)),
            (swap, *sword_fist(*_IN_SCABBARD, (0.85, 0.40, -0.20))),
            (0.28, (-0.02, 1.28, 0.44), (0.30, -0.55, -0.5), (0.8, 0.3, 0.3)),
            (0.38, (-0.36, 1.30, 0.42), (0.10, 0.75, 0.6), (0.3, -0.5, 0.8)),
            (t, (-0.28, 1.02, 0.30), (0.12, 0.50, 0.86), (0.1, -0.8, 0.5)),
        ],
    )
    table |= {
        "elbow.to.R": [
            (0.0, (-0.6, -0.6, -0.5)),
            (0.2, (-0.7, -0.3, 0.4)),
            (0.35, (-0.8, -0.4, -0.1)),
            (t, (-0.6, -0.6, -0.5)),
        ],
        "curl.R": [(0.0, 24.0), (0.12, 20.0), (swap, 84.0), (t, 84.0)],
        "thumb.R": [(0.0, 0.0), (swap, 40.0), (t, 40.0)],
    } | _left_on_scabbard(0.14, 0.30, t)
    return (
        t,
        False,
        table,
        {
            "shown": [(0.0, SHEATHED), (swap, SWORD)],
            "markers": [(swap, "unsheathed")],
            "stands": [(side, 0.0, t) for side in (".L", ".R")],
        },
    )


def sheathe():
    """The way back, slower at the mouth of the scabbard."""
    t = 0.5
    swap = 0.30
    table = pose_keys(
        standing(),
        [
            (
                0.16,
                {"hips.y": -0.04, "hips.yaw": -6, "spine.yaw": -6, "spine.pitch": 4, "head.pitch": 6, "head.yaw": 12},
            ),
            (
                0.30,
                {"hips.y": -0.045, "hips.yaw": 8, "spine.yaw": 16, "spine.pitch": 9, "head.pitch": 12, "head.yaw": 6},
            ),
            (t, {**standing(), "hips.yaw": 0, "spine.yaw": 0, "head.yaw": 0}),
        ],
    )
    table |= fist_keys(
        ".R",
        [
            (0.0, (-0.28, 1.02, 0.30), (0.12, 0.50, 0.86), (0.1, -0.8, 0.5)),
            (0.10, (-0.30, 1.30, 0.42), (0.10, 0.55, 0.7), (0.5, -0.4, 0.6)),
            (0.19, (-0.02, 1.34, 0.46), (0.30, -0.55, -0.5), (0.8, 0.3, 0.3)),
            (swap, *sword_fist(*_IN_SCABBARD, (0.85, 0.40, -0.20))),
            (0.40, (-0.08, 0.98, 0.25), (-0.68, -0.68, 0.27), (0.7, -0.7, 0.0)),
            (t, (-0.27, 0.82, 0.08), (0.0, 0.1, 1.0), (0.0, -1.0, 0.1)),
        ],
    )
    table |= {
        "elbow.to.R": [
            (0.0, (-0.6, -0.6, -0.5)),
            (0.15, (-0.8, -0.4, -0.1)),
            (0.3, (-0.7, -0.3, 0.4)),
            (t, (-0.6, -0.6, -0.5)),
        ],
        "curl.R": [(0.0, 84.0), (swap, 84.0), (0.38, 20.0), (t, 24.0)],
        "thumb.R": [(0.0, 40.0), (swap, 40.0), (t, 0.0)],
    } | _left_on_scabbard(0.20, 0.34, t)
    return (
        t,
        False,
        table,
        {
            "shown": [(0.0, SWORD), (swap, SHEATHED)],
            "markers": [(swap, "sheathed")],
            "stands": [(side, 0.0, t) for side in (".L", ".R")],
        },
    )


# The archer's stance: the left side in front.
_ARCHER = {
    "hips.y": -0.04,
    "hips.x": -0.02,
    "hips.z": 0.0,
    "hips.yaw": -42.0,
    "hips.pitch": 0.0,
    "spine.yaw": -30.0,
    "spine.pitch": -1.0,
    "spine.roll": 0.0,
    "neck.yaw": 30.0,
    "neck.pitch": 2.0,
    "head.yaw": 36.0,
    "head.pitch": 2.0,
    "head.roll": 4.0,
}
_ARCHER_FEET = {
    "foot.x.L": -0.02,
    "foot.z.L": 0.13,
    "foot.yaw.L": -22.0,
    "foot.x.R": -0.03,
    "foot.z.R": -0.12,
    "foot.yaw.R": 62.0,
}
# The bow's grip, and the arrow's nock at full draw.
_BOW_GRIP, _NOCK = (0.022, 1.446, 0.655), (-0.082, 1.496, 0.050)
_STRING_HAND = (0.088, 0.018, 0.022)


def _string_hand(nock, aim, up=(0.35, 0.92, 0.0)):
    """Wrist, fingers and palm of the right hand with the nock between its fingers."""
    fingers = unit(aim)
    thumb = unit(np.asarray(up) - fingers * (fingers @ np.asarray(up)))
    palm = -np.cross(fingers, thumb)
    wrist = np.asarray(nock) - _STRING_HAND[0] * fingers - _STRING_HAND[1] * thumb - _STRING_HAND[2] * palm
    return tuple(wrist), tuple(fingers), tuple(palm)


def _string_keys(keys):
    rows = [(time, *(fist(".R", *rest[1:]) if rest[0] == "fist" else _string_hand(*rest[1:]))) for time, *rest in keys]
    return {
        f"{name}.R": [(row[0], row[column]) for row in rows]
        for column, name in ((1, "hand"), (2, "fingers"), (3, "palm"))
    }


_AIM = np.subtract(_BOW_GRIP, _NOCK) + (0.0, 0.02, 0.0)
_UP = (-0.20, 0.97, 0.0)
_DRAWN = {
    "curl.L": 84.0,
    "thumb.L": 40.0,
    "curl.R": 70.0,
    "thumb.R": 6.0,
    "elbow.to.L": (0.75, -0.55, 0.1),
    "shoulder.forward.R": -8.0,
}


def draw():
    t = 0.6
    swap, take, nock = 0.10, 0.20, 0.40
    stand = {name: value for name, value in standing().items() if not name.startswith("foot")}
    table = pose_keys(
        stand,
        [
            (
                0.16,
                {
                    "hips.y": -0.03,
                    "hips.yaw": -16,
                    "spine.yaw": -8,
                    "spine.pitch": 2,
                    "neck.yaw": 10,
                    "head.yaw": 8,
                    "head.pitch": 4,
                },
            ),
            (0.38, {**_ARCHER, "hips.yaw": -36, "spine.yaw": -20, "neck.yaw": 24, "head.yaw": 28, "head.pitch": 8}),
            (t, _ARCHER),
        ],
    )
    table |= fist_keys(
        ".L",
        [
            (0.0, (0.29, 0.86, 0.10), (0.0, 0.2, 1.0), (0.0, -1.0, 0.2)),
            (swap, (0.30, 1.02, 0.30), (-0.3, 0.6, 0.7), (0.1, -0.6, 0.8)),
            (0.36, (0.06, 1.30, 0.58), (-0.30, 0.95, 0.0), (0.0, 0.0, 1.0)),
            (t, _BOW_GRIP, _UP, _AIM),
        ],
    )
    table |= _string_keys(
        [
            (0.0, "fist", (-0.27, 0.82, 0.08), (0.0, 0.1, 1.0), (0.0, -1.0, 0.1)),
            (0.09, "fist", (-0.36, 1.35, 0.02), (0.3, -0.3, 0.9), (0.1, 0.9, 0.3)),
            (take, "nock", (-0.235, 1.545, -0.195), (0.25, -0.75, -0.45), (0.8, 0.3, 0.3)),
            (0.25, "nock", (-0.290, 1.640, -0.02), (-0.80, -0.15, 0.10), (0.3, 0.9, 0.6)),
            (0.31, "nock", (-0.20, 1.56, 0.22), (-0.20, 0.15, 0.95), (0.5, 0.85, 0.0)),
            (nock, "nock", (0.045, 1.36, 0.42), (0.0, 0.05, 1.0)),
            (t, "nock", _NOCK, _AIM),
        ]
    )
    table |= {
        "elbow.to.R": [
            (0.0, (-0.6, -0.6, -0.5)),
            (take, (-0.9, 0.1, 0.4)),
            (0.32, (-0.9, -0.2, -0.2)),
            (t, (-0.75, 0.25, -0.6)),
        ],
        "elbow.to.L": [(0.0, (0.6, -0.6, -0.5)), (t, (0.75, -0.55, 0.1))],
        "curl.L": [(0.0, 24.0), (swap, 84.0), (t, 84.0)],
        "thumb.L": [(0.0, 0.0), (swap, 36.0), (t, 36.0)],
        "curl.R": [(0.0, 24.0), (0.14, 16.0), (take, 70.0), (t, 70.0)],
        "thumb.R": [(0.0, 0.0), (t, 6.0)],
        "shoulder.forward.R": [(0.0, 0.0), (nock, 4.0), (t, -8.0)],
        "nocked": lambda time: smooth_step(0.29, nock, time),
        "string": lambda time: float(time >= nock - 1e-9),
    }
    for name, value in _ARCHER_FEET.items():
        first = {"foot.yaw.L": 7.0, "foot.yaw.R": 7.0}.get(name, 0.0)
        begin = 0.06 if name.endswith("R") else 0.24
        table[name] = [(0.0, first), (begin, first), (begin + 0.16, value), (t, value)]
    for side, begin in ((".R", 0.06), (".L", 0.24)):
        table[f"foot.y{side}"] = [(0.0, 0.0), (begin, 0.0), (begin + 0.08, 0.03), (begin + 0.16, 0.0), (t, 0.0)]
    return (
        t,
        False,
        table,
        {
            "shown": [(0.0, SHEATHED), (swap, BOW), (take, BOW_AND_ARROW)],
            "markers": [(0.22, "step_right"), (0.40, "step_left")],
        },
    )


def _aimed():
    """The last pose of `draw`, as numbers."""
    table = {}
    for name, value in draw()[2].items():
        table[name] = value(0.6) if callable(value) else value[-1][1] if isinstance(value, list) else value
    return table


def aim():
    t = 2.0
    table = _aimed() | {
        "breath": wave(t, 0.8, 0.0),
        "hips.x": lambda time: _ARCHER["hips.x"] + 0.0025 * (np.cos(2 * np.pi * time / t) - 1.0),
        "spine.roll": lambda time: 0.3 * np.sin(4 * np.pi * time / t),
    }
    steps = 12
    grips, nocks = [], []
    for number in range(steps):
        turn = 2 * np.pi * number / steps
        sway = np.array([0.004 * np.sin(turn), 0.003 * (np.cos(2 * turn) - 1.0), 0.0])
        grips.append((t * number / steps, np.add(_BOW_GRIP, sway), _UP, _AIM))
        nocks.append((t * number / steps, "nock", np.add(_NOCK, 0.3 * sway), _AIM + 0.7 * sway))
    table |= fist_keys(".L", grips) | _string_keys(nocks)
    return t, True, table, {"shown": [(0.0, BOW_AND_ARROW)], "stands": [(side, 0.0, t) for side in (".L", ".R")]}


def loose():
    """The string goes, the hand springs back, the bow arm gives a little."""
    t = 0.3
    gone = 1.0 / 30.0
    table = pose_keys(
        _aimed(),
        [
            (0.10, {"spine.yaw": -35, "spine.roll": -2, "hips.x": -0.026, "head.yaw": 38}),
            (t, {"spine.yaw": -29, "spine.roll": 0, "hips.x": -0.02}),
        ],
    )
    back = np.asarray(_NOCK) - 0.13 * unit(_AIM) + (-0.05, 0.0, 0.0)
    table |= fist_keys(
        ".L",
        [
            (0.0, _BOW_GRIP, _UP, _AIM),
            (gone, _BOW_GRIP, _UP, _AIM),
            (0.10, np.add(_BOW_GRIP, (0.03, 0.015, 0.0)), (-0.02, 0.97, 0.22), _AIM + (0.03, 0.0, 0.0)),
            (t, np.add(_BOW_GRIP, (0.01, -0.03, -0.01)), _UP, _AIM + (0.0, -0.05, 0.0)),
        ],
    )
    table |= _string_keys(
        [
            (0.0, "nock", _NOCK, _AIM),
            (gone, "nock", _NOCK, _AIM),
            (0.10, "nock", back, _AIM + (0.0, 0.06, 0.0)),
            (t, "nock", np.add(back, (-0.02, -0.04, 0.03)), _AIM),
        ]
    )
    table |= {
        "elbow.to.R": (-0.75, 0.25, -0.6),
        "elbow.to.L": (0.75, -0.55, 0.1),
        "curl.R": [(0.0, 70.0), (gone, 70.0), (0.10, 12.0), (t, 24.0)],
        "nocked": 1.0,
        "string": lambda time: float(time <= 1e-9) if time < gone - 1e-9 else 0.0,
    }
    for name, value in _ARCHER_FEET.items():
        table[name] = [(0.0, value)]
    return (
        t,
        False,
        table,
        {
            "shown": [(0.0, BOW_AND_ARROW), (gone, BOW)],
            "markers": [(gone, "loose")],
            "stands": [(side, 0.0, t) for side in (".L", ".R")],
        },
    )


TABLES = {
    "stab_raise": stab_raise,
    "stab_hold": stab_hold,
    "stab_strike": stab_strike,
    "swing": swing,
    "draw": draw,
    "aim": aim,
    "loose": loose,
    "unsheathe": unsheathe,
    "sheathe": sheathe,
}
