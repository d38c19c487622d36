"""Clips low on the ground: crouch, crushed, lie, get_up, die."""

from .table import both, mirrored, pose_keys, standing, wave

# Lying on the back: the head towards -Z, the hips over the origin's back; knees a little up.
_LYING = {
    "hips.y": -0.812,
    "hips.z": -0.30,
    "hips.pitch": -88.0,
    "hips.yaw": 0.0,
    "hips.roll": 3.0,
    "spine.pitch": 4.0,
    "spine.roll": -4.0,
    "spine.yaw": 0.0,
    "neck.pitch": 6.0,
    "head.pitch": 6.0,
    "head.yaw": 16.0,
    "neck.yaw": 8.0,
    "arm.swing.L": -8.0,
    "arm.swing.R": -2.0,
    "arm.out.L": 44.0,
    "arm.out.R": 62.0,
    "elbow.L": 20.0,
    "elbow.R": 34.0,
    "turn.L": -30.0,
    "turn.R": -40.0,
    "arm.twist.L": -40.0,
    "arm.twist.R": -50.0,
    "curl.L": 34.0,
    "curl.R": 38.0,
    "thigh.swing.L": 8.0,
    "thigh.swing.R": 22.0,
    "knee.L": 20.0,
    "knee.R": 46.0,
    "thigh.out.L": 9.0,
    "thigh.out.R": 12.0,
    "ankle.L": 26.0,
    "ankle.R": 22.0,
    "thigh.twist.L": 14.0,
    "thigh.twist.R": 16.0,
    "leg.free.L": 1.0,
    "leg.free.R": 1.0,
    "scabbard": 0.0,
    "floor": 1.0,
}


def crouch():
    t = 3.0
    return (
        t,
        True,
        {
            "hips.y": wave(t, 0.006, 0.1, 2, -0.40),
            "hips.x": wave(t, 0.008, 0.3),
            "hips.z": -0.07,
            "hips.pitch": 30.0,
            "hips.yaw": 10.0,
            "spine.pitch": wave(t, 1.0, 0.2, 2, 18.0),
            "spine.yaw": wave(t, 1.5, 0.4, 1, -8.0),
            "breath": wave(t, 1.6, 0.0, 2),
            "neck.pitch": -16.0,
            "head.pitch": wave(t, 1.2, 0.5, 2, -20.0),
            "head.yaw": [(0, 0), (0.9, 8), (1.6, 6), (2.4, -6)],
            "foot.z.L": 0.15,
            "foot.z.R": -0.17,
            "foot.pitch.R": 34.0,
            "foot.out.L": 0.04,
            "foot.out.R": 0.05,
            **both("foot.yaw", 8.0),
            **both("knee.out", 12.0),
            "arm.swing.L": wave(t, 1.5, 0.3, 2, 26.0),
            "arm.swing.R": wave(t, 1.5, 0.4, 2, 8.0),
            **both("arm.out", 20.0),
            "elbow.L": wave(t, 2.0, 0.3, 2, 64.0),
            "elbow.R": wave(t, 2.0, 0.4, 2, 52.0),
            **both("arm.twist", 26.0),
            **both("curl", 34.0),
            **both("turn", 10.0),
        },
        {"stands": [(side, 0.0, t) for side in (".L", ".R")]},
    )


def crushed():
    """Pressed down from above: deep on both feet, arms over the head."""
    t = 1.0
    return (
        t,
        True,
        {
            "hips.y": wave(t, 0.006, 0.2, 2, -0.57),
            "hips.z": -0.11,
            "hips.x": wave(t, 0.004, 0.3),
            "hips.pitch": 40.0,
            "spine.pitch": wave(t, 2.0, 0.1, 2, 44.0),
            "spine.roll": wave(t, 1.2, 0.4),
            "breath": wave(t, 2.0, 0.0),
            "neck.pitch": 16.0,
            "head.pitch": wave(t, 1.5, 0.3, 2, 12.0),
            "head.yaw": 6.0,
            **both("foot.out", 0.05),
            "foot.z.L": 0.06,
            "foot.z.R": -0.08,
            **both("foot.yaw", 14.0),
            "foot.pitch.L": 18.0,
            "foot.pitch.R": 36.0,
            **both("knee.out", 24.0),
            **both("of_chest", 1.0),
            "hand.L": (0.055, 1.775, -0.035),
            "hand.R": (-0.075, 1.745, 0.015),
            "fingers.L": (-0.88, 0.30, -0.25),
            "fingers.R": (0.86, 0.28, -0.35),
            "palm.L": (0.0, -0.9, -0.2),
            "palm.R": (0.0, -0.9, -0.2),
            **mirrored("elbow.to", (0.75, 0.25, 0.65)),
            **both("curl", 22.0),
        },
        {"stands": [(side, 0.0, t) for side in (".L", ".R")]},
    )


def lie():
    t = 3.0
    return (
        t,
        True,
        _LYING
        | {
            "breath": wave(t, 2.2, 0.5, 1, -2.2),
            "head.yaw": wave(t, 1.0, 0.2, 1, 15.0),
            "arm.out.L": wave(t, 0.6, 0.5, 1, 43.4),
            "curl.L": wave(t, 2.0, 0.5, 1, 32.0),
        },
        {},
    )


def die():
    """The knees give way, he falls back and comes to rest as in `lie`."""
    t = 1.5
    stand = standing() | {"thigh.swing.L": 6.0, "thigh.swing.R": 6.0, "knee.L": 12.0, "knee.R": 12.0}
    table = pose_keys(
        stand,
        [
            (
                0.18,
                {
                    "hips.y": 0.0,
                    "hips.z": 0.02,
                    "hips.pitch": 4,
                    "spine.pitch": -12,
                    "spine.yaw": 10,
                    "head.pitch": -14,
                    "arm.out.L": 30,
                    "arm.out.R": 24,
                    "arm.swing.L": 14,
                    "elbow.L": 40,
                    "elbow.R": 34,
                },
            ),
            (
                0.45,
                {
                    "hips.y": -0.30,
                    "hips.z": -0.07,
                    "hips.pitch": -6,
                    "hips.yaw": 8,
                    "spine.pitch": 16,
                    "spine.yaw": 2,
                    "neck.pitch": 10,
                    "head.pitch": 14,
                    "arm.out.L": 22,
                    "arm.out.R": 20,
                    "arm.swing.L": 20,
                    "arm.swing.R": 26,
                    "elbow.L": 46,
                    "elbow.R": 40,
                    "thigh.swing.L": 60,
                    "thigh.swing.R": 66,
                    "knee.L": 95,
                    "knee.R": 100,
                },
            ),
            (
                0.70,
                {
                    "hips.y": -0.70,
                    "hips.z": -0.26,
                    "hips.pitch": -34,
                    "spine.pitch": 26,
                    "neck.pitch": 14,
                    "head.pitch": 14,
                    "arm.out.L": 50,
                    "arm.out.R": 46,
                    "arm.swing.L": 10,
                    "arm.swing.R": 20,
                    "elbow.L": 24,
                    "elbow.R": 26,
                    "thigh.swing.L": 70,
                    "thigh.swing.R": 80,
                    "knee.L": 90,
                    "knee.R": 104,
                    "ankle.L": 6,
                    "ankle.R": 8,
                },
            ),
            (
                0.98,
                {
                    "hips.y": -0.808,
                    "hips.z": -0.31,
                    "hips.pitch": -92,
                    "hips.yaw": 0,
                    "hips.roll": 2,
                    "spine.pitch": 10,
                    "spine.yaw": 0,
                    "neck.pitch": 2,
                    "head.pitch": -4,
                    "head.yaw": 6,
                    "arm.out.L": 62,
                    "arm.out.R": 74,
                    "arm.swing.L": 2,
                    "arm.swing.R": 8,
                    "thigh.swing.L": 26,
                    "thigh.swing.R": 44,
                    "knee.L": 40,
                    "knee.R": 76,
                    "ankle.L": 12,
                    "ankle.R": 10,
                },
            ),
            (1.12, {"hips.y": -0.796, "hips.pitch": -86, "spine.pitch": 6, "neck.pitch": 10, "head.pitch": 10}),
            (t, _LYING),
        ],
    )
    for side, late in ((".L", 0.0), (".R", 0.05)):
        table[f"leg.free{side}"] = [(0.0, 0.0), (0.56 + late, 0.0), (0.86 + late, 1.0), (t, 1.0)]
        table[f"foot.pitch{side}"] = [(0.0, 0.0), (0.20, 0.0), (0.45, 22.0), (0.60, 8.0), (0.80, -10.0), (t, -30.0)]
    # The scabbard swings aside by itself.
    table["breath"] = [(0.0, 0.0), (0.15, 3.0), (0.9, -2.0), (1.1, -1.0), (t, -4.4)]
    table["head.yaw"] = [*table["head.yaw"][:-1], (t, 15.0 + 0.30901699)]
    return t, False, _as_lying(table, t), {"stands": [(side, 0.0, 0.18) for side in (".L", ".R")]}


def _as_lying(table, time):
    """Makes the last keys those of the first pose of `lie`."""
    first = lie()[2]
    for name, value in first.items():
        end = value(0.0) if callable(value) else value
        keys = table.setdefault(name, [(0.0, 0.0)])
        if isinstance(keys, (int, float)):
            keys = [(0.0, keys)]
        table[name] = [key for key in keys if key[0] < time] + [(time, end)]
    return table


def get_up():
    """From the back: sits up over a hand, plants a foot, and rises."""
    t = 1.2
    start = {name: (value(0.0) if callable(value) else value) for name, value in lie()[2].items()}
    table = pose_keys(
        start,
        [
            (
                0.14,
                {
                    "hips.pitch": -96,
                    "hips.y": -0.815,
                    "spine.pitch": 10,
                    "neck.pitch": 14,
                    "head.pitch": 14,
                    "head.yaw": 4,
                    "thigh.swing.L": 30,
                    "thigh.swing.R": 60,
                    "knee.L": 40,
                    "knee.R": 96,
                    "arm.swing.L": 20,
                    "arm.swing.R": -10,
                },
            ),
            (
                0.42,
                {
                    "hips.pitch": -34,
                    "hips.y": -0.80,
                    "hips.z": -0.28,
                    "hips.yaw": -6,
                    "hips.roll": -4,
                    "spine.pitch": 36,
                    "spine.roll": 0,
                    "spine.yaw": -8,
                    "neck.pitch": 4,
                    "neck.yaw": 0,
                    "head.pitch": 0,
                    "head.yaw": 0,
                    "thigh.swing.L": 74,
                    "thigh.swing.R": 92,
                    "knee.L": 88,
                    "knee.R": 118,
                    "thigh.out.L": 10,
                    "thigh.out.R": 8,
                    "thigh.twist.L": 4,
                    "thigh.twist.R": 4,
                    "ankle.L": 4,
                    "ankle.R": 4,
                    "arm.swing.L": 46,
                    "arm.out.L": 18,
                    "elbow.L": 30,
                    "arm.swing.R": -34,
                    "arm.out.R": 36,
                    "elbow.R": 16,
                    "arm.twist.L": 0,
                    "arm.twist.R": -10,
                    "turn.L": 0,
                    "turn.R": 0,
                },
            ),
            (
                0.66,
                {
                    "hips.pitch": 22,
                    "hips.y": -0.60,
                    "hips.z": -0.16,
                    "hips.yaw": -4,
                    "hips.roll": 0,
                    "spine.pitch": 40,
                    "spine.yaw": -4,
                    "neck.pitch": -8,
                    "head.pitch": -12,
                    "arm.swing.L": 44,
                    "arm.out.L": 18,
                    "elbow.L": 44,
                    "arm.swing.R": 4,
                    "arm.out.R": 32,
                    "elbow.R": 36,
                    "arm.twist.R": 12,
                    "arm.twist.L": 12,
                    "curl.L": 24,
                    "curl.R": 24,
                },
            ),
            (
                0.92,
                {
                    "hips.pitch": 16,
                    "hips.y": -0.22,
                    "hips.z": -0.03,
                    "hips.yaw": 0,
                    "spine.pitch": 18,
                    "spine.yaw": 0,
                    "neck.pitch": 0,
                    "head.pitch": -12,
                    "arm.swing.L": 12,
                    "arm.swing.R": 10,
                    "arm.out.L": 20,
                    "arm.out.R": 22,
                    "elbow.L": 34,
                    "elbow.R": 34,
                },
            ),
            (
                t,
                {
                    **standing(),
                    "hips.pitch": 0,
                    "hips.z": 0,
                    "hips.roll": 0,
                    "breath": 0,
                    "thigh.swing.L": 80,
                    "thigh.swing.R": 80,
                },
            ),
        ],
    )
    for side, late in ((".L", 0.08), (".R", 0.0)):
        table[f"leg.free{side}"] = [(0.0, 1.0), (0.30 + late, 1.0), (0.48 + late, 0.0), (t, 0.0)]
        table[f"foot.pitch{side}"] = [(0.0, -20.0), (0.36 + late, -20.0), (0.46 + late, 0.0), (t, 0.0)]
    # The feet stand in front, then step back under the body.
    table["foot.z.R"] = [(0.0, 0.06), (0.94, 0.06), (1.08, 0.0), (t, 0.0)]
    table["foot.y.R"] = [(0.0, 0.0), (0.94, 0.0), (1.01, 0.03), (1.08, 0.0), (t, 0.0)]
    table["foot.z.L"] = [(0.0, 0.22), (0.56, 0.22), (0.80, -0.06), (t, 0.0)]
    table["foot.y.L"] = [(0.0, 0.03), (0.40, 0.0), (0.56, 0.0), (0.70, 0.06), (0.82, 0.0), (t, 0.0)]
    table["foot.pitch.L"] = [
        (0.0, -20.0),
        (0.44, -20.0),
        (0.54, 0.0),
        (0.66, 10.0),
        (0.82, 22.0),
        (1.05, 4.0),
        (t, 0.0),
    ]
    table["foot.z.L"] = [(0.0, 0.22), (0.56, 0.22), (0.82, 0.0), (t, 0.0)]
    table["knee.out.L"] = table["knee.out.R"] = [(0.0, 14.0), (0.7, 14.0), (t, 0.0)]
    return t, False, table, {"markers": [(0.46, "step_right"), (0.82, "step_left")]}


TABLES = {"crouch": crouch, "get_up": get_up, "lie": lie, "die": die, "crushed": crushed}
