"""Clips of jumps and falls: jump, fall, land_soft, land_hard, tumble."""

from .table import both, pose_keys, standing, wave

# The pose in the air, about which `fall` moves; `jump` ends as `fall` begins.
_AIR = {
    "hips.pitch": 6.0,
    "spine.pitch": 2.0,
    "head.pitch": -4.0,
    "arm.swing.L": 34.0,
    "arm.swing.R": 18.0,
    "arm.out.L": 62.0,
    "arm.out.R": 68.0,
    "elbow.L": 34.0,
    "elbow.R": 30.0,
    "curl.L": 14.0,
    "curl.R": 14.0,
    "thigh.swing.L": 38.0,
    "thigh.swing.R": -4.0,
    "knee.L": 58.0,
    "knee.R": 40.0,
    "ankle.L": 24.0,
    "ankle.R": 30.0,
    "thigh.out.L": 7.0,
    "thigh.out.R": 7.0,
}


def _falling():
    """The first pose of `fall`, as numbers."""
    return {name: value(0.0) if callable(value) else value for name, value in fall()[2].items()}


def jump():
    t = 0.35
    stand = standing()
    body = [name for name in stand if not name.startswith("foot")]
    table = pose_keys(
        stand,
        [
            (
                0.10,
                {
                    "hips.y": -0.20,
                    "hips.z": -0.02,
                    "hips.pitch": 16,
                    "spine.pitch": 14,
                    "head.pitch": -14,
                    "arm.swing.L": -34,
                    "arm.swing.R": -34,
                    "arm.out.L": 16,
                    "arm.out.R": 16,
                    "elbow.L": 14,
                    "elbow.R": 14,
                },
            ),
            (
                0.20,
                {
                    "hips.y": 0.055,
                    "hips.z": 0.02,
                    "hips.pitch": 2,
                    "spine.pitch": -6,
                    "head.pitch": -10,
                    "arm.swing.L": 88,
                    "arm.swing.R": 66,
                    "arm.out.L": 34,
                    "arm.out.R": 32,
                    "elbow.L": 62,
                    "elbow.R": 70,
                },
            ),
            (t, {"hips.y": 0.0, "hips.z": 0.0, **dict.fromkeys(body, 0.0), **_falling()}),
        ],
    )
    for side in (".L", ".R"):
        table[f"leg.free{side}"] = [(0.0, 0.0), (0.19, 0.0), (0.29, 1.0), (t, 1.0)]
        table[f"foot.pitch{side}"] = [(0.0, 0.0), (0.10, 2.0), (0.20, 52.0), (t, 55.0)]
        table[f"foot.y{side}"] = [(0.0, 0.0), (0.19, 0.0), (0.26, 0.08), (t, 0.12)]
        for name in ("thigh.swing", "knee", "ankle", "thigh.out"):
            first = {"thigh.swing": 4.0, "knee": 10.0, "ankle": 50.0, "thigh.out": 3.0}[name]
            table[name + side] = [(0.0, first), (0.20, first), (t, _falling()[name + side])]
    return t, False, table, {"markers": [(0.20, "take_off")], "stands": [(side, 0.0, 0.1) for side in (".L", ".R")]}


def fall():
    t = 0.8
    table = (
        dict(_AIR)
        | both("leg.free", 1.0)
        | {
            "hips.pitch": wave(t, 2.0, 0.2, 1, 6.0),
            "hips.roll": wave(t, 3.0, 0.4),
            "spine.roll": wave(t, -4.0, 0.45),
            "spine.yaw": wave(t, 5.0, 0.1),
            "head.pitch": wave(t, 2.0, 0.3, 1, 6.0),
            "neck.pitch": 4.0,
            # Each arm's hand goes round: the swing runs a quarter ahead of the lift.
            "arm.swing.L": wave(t, 17.0, 0.0, 1, 34.0),
            "arm.out.L": wave(t, 13.0, 0.25, 1, 62.0),
            "elbow.L": wave(t, 10.0, 0.35, 1, 34.0),
            "arm.swing.R": wave(t, 17.0, 0.5, 1, 18.0),
            "arm.out.R": wave(t, 13.0, 0.75, 1, 68.0),
            "elbow.R": wave(t, 10.0, 0.85, 1, 30.0),
            "thigh.swing.L": wave(t, 9.0, 0.5, 1, 38.0),
            "thigh.swing.R": wave(t, 9.0, 0.0, 1, -4.0),
            "knee.L": wave(t, 10.0, 0.6, 1, 58.0),
            "knee.R": wave(t, 10.0, 0.1, 1, 40.0),
            "shoulder.lift.L": wave(t, 4.0, 0.25, 1, 8.0),
            "shoulder.lift.R": wave(t, 4.0, 0.75, 1, 8.0),
            "scabbard": wave(t, 8.0, 0.6, 1, -14.0),
            "scabbard.out": wave(t, 5.0, 0.2, 1, 8.0),
        }
    )
    return t, True, table, {}


def _landing(t, keys, feet_from):
    """A landing that begins in the air pose and ends standing; the feet stand all the time."""
    table = pose_keys({}, keys)
    air = {name: value for name, value in _AIR.items() if not name.startswith(("thigh", "knee", "ankle"))}
    for name, value in air.items():
        table[name] = [(0.0, value), *table.get(name, [(0.0, 0.0)])[1:]]
    for name, value in standing().items():
        table.setdefault(name, [(0.0, value)])
        if table[name][-1][0] < t:
            table[name] = [*table[name], (t, value)]
    for side, ahead in ((".L", feet_from[0]), (".R", feet_from[1])):
        table[f"foot.z{side}"] = [(0.0, ahead)]
    return table


def land_soft():
    t = 0.5
    table = _landing(
        t,
        [
            (0.0, {"hips.y": -0.03}),
            (
                0.12,
                {
                    "hips.y": -0.24,
                    "hips.z": -0.035,
                    "hips.pitch": 20,
                    "spine.pitch": 16,
                    "head.pitch": -16,
                    "arm.swing.L": 12,
                    "arm.swing.R": 8,
                    "arm.out.L": 40,
                    "arm.out.R": 42,
                    "elbow.L": 46,
                    "elbow.R": 46,
                },
            ),
            (0.20, {"hips.y": -0.235, "hips.z": -0.03, "hips.pitch": 19, "spine.pitch": 18}),
            (
                0.38,
                {
                    "hips.y": -0.03,
                    "hips.z": 0.0,
                    "hips.pitch": 3,
                    "spine.pitch": 1,
                    "head.pitch": -1,
                    "arm.swing.L": 6,
                    "arm.swing.R": 6,
                    "arm.out.L": 17,
                    "arm.out.R": 17,
                    "elbow.L": 22,
                    "elbow.R": 22,
                },
            ),
            (t, {"hips.y": -0.012, "hips.z": 0.0, "hips.pitch": 0, "spine.pitch": 1.5, "head.pitch": -2}),
        ],
        (0.0, 0.0),
    )
    table["hips.y"][0] = (0.0, -0.03)
    table["foot.pitch.L"] = table["foot.pitch.R"] = [(0.0, 20.0), (0.06, 2.0), (0.09, 0.0), (t, 0.0)]
    return t, False, table, {"markers": [(0.0, "land")], "stands": [(side, 0.1, t) for side in (".L", ".R")]}


def land_hard():
    t = 0.9
    hand = [
        (0.0, (-0.42, 1.25, 0.20)),
        (0.10, (-0.34, 0.70, 0.30)),
        (0.18, (-0.235, 0.085, 0.375)),
        (0.44, (-0.235, 0.085, 0.375)),
        (0.58, (-0.27, 0.45, 0.30)),
        (t, (-0.25, 0.86, 0.06)),
    ]
    table = _landing(
        t,
        [
            (
                0.17,
                {
                    "hips.y": -0.560,
                    "hips.z": -0.10,
                    "hips.pitch": 44,
                    "hips.yaw": 8,
                    "spine.pitch": 40,
                    "spine.roll": -8,
                    "spine.yaw": 12,
                    "neck.pitch": -10,
                    "head.pitch": -8,
                    "arm.swing.L": -42,
                    "arm.out.L": 44,
                    "elbow.L": 24,
                    "curl.L": 10,
                },
            ),
            (0.30, {"hips.y": -0.575, "hips.pitch": 46, "spine.pitch": 44, "neck.pitch": -6, "head.pitch": 4}),
            (
                0.46,
                {
                    "hips.y": -0.530,
                    "hips.z": -0.10,
                    "hips.pitch": 42,
                    "hips.yaw": 8,
                    "spine.pitch": 38,
                    "spine.roll": -7,
                    "spine.yaw": 10,
                    "neck.pitch": -18,
                    "head.pitch": -16,
                    "arm.swing.L": -30,
                    "arm.out.L": 34,
                },
            ),
            (
                0.72,
                {
                    "hips.y": -0.10,
                    "hips.z": -0.02,
                    "hips.pitch": 12,
                    "hips.yaw": 2,
                    "spine.pitch": 10,
                    "spine.roll": 0,
                    "spine.yaw": 2,
                    "neck.pitch": 0,
                    "head.pitch": -8,
                    "arm.swing.L": 4,
                    "arm.out.L": 18,
                    "elbow.L": 26,
                },
            ),
            (t, {"hips.y": -0.012, "hips.z": 0.0, "hips.pitch": 0, "hips.yaw": 0, "spine.roll": 0, "spine.yaw": 0}),
        ],
        (0.05, -0.10),
    )
    table["hips.y"][0] = (0.0, -0.03)
    table["foot.z.L"], table["foot.z.R"] = [(0.0, 0.09), (0.62, 0.09), (0.74, 0.05), (0.84, 0.0)], [(0.0, -0.13)]
    table["foot.y.L"] = [(0.0, 0.0), (0.62, 0.0), (0.73, 0.035), (0.84, 0.0)]
    table["foot.z.R"] = [(0.0, -0.13), (0.70, -0.13), (0.80, -0.05), (0.9, 0.0)]
    table["foot.y.R"] = [(0.0, 0.0), (0.70, 0.0), (0.80, 0.03), (0.9, 0.0)]
    table["foot.pitch.L"] = [(0.0, 18.0), (0.07, 2.0), (0.12, 0.0), (t, 0.0)]
    table["foot.pitch.R"] = [(0.0, 24.0), (0.08, 26.0), (0.17, 54.0), (0.46, 52.0), (0.72, 8.0), (t, 0.0)]
    table |= {
        "foot.out.L": [(0.0, 0.05), (0.62, 0.05), (0.84, 0.012)],
        "foot.out.R": [(0.0, 0.03), (0.70, 0.03), (t, 0.012)],
        "knee.out.L": [(0.0, 14.0), (0.5, 14.0), (t, 0.0)],
        "knee.out.R": [(0.0, 16.0), (0.5, 16.0), (t, 0.0)],
        "hand.R": hand,
        "fingers.R": [
            (0.0, (-0.7, -0.3, 0.6)),
            (0.18, (0.15, -0.25, 0.95)),
            (0.44, (0.15, -0.25, 0.95)),
            (t, (0.0, -1.0, 0.1)),
        ],
        "palm.R": [
            (0.0, (0.2, -0.9, 0.2)),
            (0.18, (0.1, -0.97, -0.15)),
            (0.44, (0.1, -0.97, -0.15)),
            (t, (1.0, 0.0, -0.1)),
        ],
        "elbow.to.R": (-0.9, -0.1, -0.45),
        "loose.R": [(0.0, 1.0), (0.12, 0.1), (0.18, 0.0), (0.46, 0.0), (0.70, 0.75), (t, 1.0)],
        "arm.out.R": [(0.0, 68.0), (0.18, 30.0), (0.5, 30.0), (t, 11.0)],
        "curl.R": [(0.0, 14.0), (0.18, 16.0), (0.46, 16.0), (t, 24.0)],
    }
    return t, False, table, {"markers": [(0.0, "land")], "stands": [(".L", 0.13, 0.6), (".R", 0.19, 0.44)]}


def tumble():
    t = 0.8
    table = (
        both("leg.free", 1.0)
        | both("thigh.swing", wave(t, 5.0, 0.3, 1, 112.0))
        | both("knee", wave(t, 6.0, 0.4, 1, 122.0))
        | both("ankle", 18.0)
        | both("thigh.out", 6.0)
    )
    table |= {
        "hips.y": -0.10,
        "hips.z": -0.02,
        "hips.pitch": 12.0,
        "spine.pitch": wave(t, 5.0, 0.2, 1, 62.0),
        "neck.pitch": 22.0,
        "head.pitch": wave(t, 3.0, 0.5, 1, 22.0),
        "hips.roll": wave(t, 4.0, 0.1),
        "spine.roll": wave(t, 5.0, 0.6),
        "thigh.swing.L": wave(t, 7.0, 0.6, 1, 108.0),
        **both("arm.swing", wave(t, 6.0, 0.4, 1, 54.0)),
        **both("arm.out", 12.0),
        **both("arm.twist", 34.0),
        **both("elbow", wave(t, 7.0, 0.5, 1, 88.0)),
        **both("curl", 60.0),
        **both("thumb", 20.0),
        **both("shoulder.forward", 16.0),
        "scabbard": -85.0,
    }
    return t, True, table, {}


TABLES = {"jump": jump, "fall": fall, "land_soft": land_soft, "land_hard": land_hard, "tumble": tumble}
