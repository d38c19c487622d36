"""Clips on walls: climb, hang, ledge, mantle."""

from .table import both, mirrored, standing, wave

# The wall of `climb` and of `ledge`, in metres in front of the origin; the ledge's height.
WALL, LEDGE_WALL, LEDGE = 0.45, 0.36, 1.61


def climb():
    """Hands on a wall at shoulder height, knees bent, feet on the wall; it only breathes."""
    t = 3.0
    return (
        t,
        True,
        {
            "hips.y": wave(t, 0.010, 0.1, 1, -0.135),
            "hips.z": wave(t, 0.006, 0.3, 1, -0.02),
            "hips.x": wave(t, 0.006, 0.2),
            "hips.pitch": 4.0,
            "spine.pitch": wave(t, 1.0, 0.2, 1, 7.0),
            "spine.roll": wave(t, 0.8, 0.4),
            "breath": wave(t, 2.0, 0.0),
            "neck.pitch": -12.0,
            "head.pitch": wave(t, 1.5, 0.3, 1, -14.0),
            "head.yaw": wave(t, 4.0, 0.5),
            **mirrored("hand", (0.255, 1.36, WALL - 0.045)),
            **mirrored("fingers", (-0.16, 0.90, 0.34)),
            **mirrored("palm", (0.0, -0.35, 0.94)),
            **mirrored("elbow.to", (0.60, -0.75, -0.30)),
            **both("curl", 30.0),
            **both("thumb", 8.0),
            **both("of_chest", 0.0),
            **both("foot.out", 0.075),
            **both("foot.pitch", -16.0),
            **both("foot.yaw", 16.0),
            **both("knee.out", 36.0),
            "on_wall": 1.0,
            "foot.y.L": 0.26,
            "foot.y.R": 0.13,
            **both("foot.z", WALL - 0.108 - 0.085),
            "scabbard": -6.0,
        },
        {},
    )


def hang():
    """From both hands, straight down; the legs sway."""
    t = 2.4
    return (
        t,
        True,
        {
            "hips.x": wave(t, 0.012, 0.25),
            "hips.z": wave(t, 0.012, 0.1),
            "hips.y": wave(t, 0.004, 0.0, 2, 0.03),
            "hips.pitch": wave(t, 2.0, 0.1, 1, -3.0),
            "hips.roll": wave(t, 2.0, 0.25),
            "spine.roll": wave(t, -1.6, 0.2),
            "spine.pitch": wave(t, 1.5, 0.2, 1, -2.0),
            "breath": wave(t, 1.6, 0.0, 2),
            "neck.pitch": -8.0,
            "head.pitch": wave(t, 2.0, 0.3, 1, -14.0),
            **mirrored("hand", (0.195, 1.985, 0.055)),
            **mirrored("fingers", (-0.06, 0.97, 0.22)),
            **mirrored("palm", (0.0, -0.22, 0.97)),
            **mirrored("elbow.to", (0.9, -0.1, 0.25)),
            **both("curl", 52.0),
            **both("thumb", 25.0),
            **both("leg.free", 1.0),
            "thigh.swing.L": wave(t, 4.0, 0.25, 1, 9.0),
            "thigh.swing.R": wave(t, 4.0, 0.32, 1, 3.0),
            "knee.L": wave(t, 4.0, 0.5, 1, 24.0),
            "knee.R": wave(t, 4.0, 0.55, 1, 14.0),
            "thigh.out.L": wave(t, 2.0, 0.3, 1, 2.0),
            "thigh.out.R": wave(t, -2.0, 0.3, 1, 2.0),
            **both("ankle", wave(t, 4.0, 0.7, 1, 34.0)),
            **both("toe", 10.0),
            "scabbard": wave(t, 3.0, 0.35, 1, 4.0),
            "scabbard.out": wave(t, 3.0, 0.45),
        },
        {},
    )


_LEDGE_HANDS = (0.225, LEDGE - 0.015, LEDGE_WALL - 0.045)


def _on_ledge():
    return {
        "hips.y": -0.18,
        "hips.z": -0.13,
        "hips.pitch": 2.0,
        "spine.pitch": 3.0,
        "neck.pitch": -8.0,
        "head.pitch": -12.0,
        **both("foot.out", 0.02),
        **both("foot.pitch", -24.0),
        **both("foot.yaw", 8.0),
        **both("knee.out", 14.0),
        "foot.y.L": 0.24,
        "foot.y.R": 0.15,
        **both("foot.z", LEDGE_WALL - 0.108 - 0.085),
        **both("curl", 46.0),
        **both("thumb", 12.0),
    }


def ledge():
    """Both hands on an edge in front and above, feet against the wall."""
    t = 3.0
    return (
        t,
        True,
        _on_ledge()
        | {
            "hips.y": wave(t, 0.008, 0.0, 1, -0.18),
            "hips.x": wave(t, 0.012, 0.3),
            "hips.roll": wave(t, 1.2, 0.3),
            "spine.roll": wave(t, -1.0, 0.35),
            "breath": wave(t, 1.8, 0.1, 1),
            "head.pitch": wave(t, 1.5, 0.3, 1, -12.0),
            "head.yaw": wave(t, 4.0, 0.5),
            **mirrored("hand", _LEDGE_HANDS),
            **mirrored("fingers", (0.0, 0.42, 0.90)),
            **mirrored("palm", (0.0, -0.90, 0.42)),
            **mirrored("elbow.to", (0.75, -0.65, 0.0)),
            "on_wall": 1.0,
            "scabbard.out": wave(t, 2.0, 0.4),
        },
        {},
    )


def mantle():
    """From the ledge to standing on it. The hands go down with the edge as the body rises past it."""
    t = 1.2
    start, stand = _on_ledge(), standing()
    keys = {
        "hips.y": [
            (0, -0.172),
            (0.12, -0.215),
            (0.38, -0.06),
            (0.60, -0.05),
            (0.80, -0.36),
            (1.02, -0.10),
            (t, -0.012),
        ],
        "hips.z": [(0, -0.13), (0.12, -0.135), (0.38, -0.08), (0.60, -0.13), (0.80, -0.06), (t, 0.0)],
        "hips.pitch": [(0, 2), (0.12, 4), (0.38, 10), (0.60, 34), (0.80, 30), (1.0, 12), (t, 0)],
        "hips.roll": [(0, 0), (0.5, -4), (0.68, -6), (0.9, 2), (t, 0)],
        "spine.pitch": [(0, 3), (0.12, 8), (0.38, 8), (0.60, 26), (0.80, 26), (1.0, 10), (t, 1.5)],
        "spine.yaw": [(0, 0), (0.45, -6), (0.7, 8), (t, 0)],
        "neck.pitch": [(0, -8), (0.38, -8), (0.62, -16), (0.85, -14), (t, 2)],
        "head.pitch": [(0, -12), (0.38, -6), (0.62, -14), (0.85, -12), (t, -2)],
        **mirrored(
            "hand",
            [
                (0, _LEDGE_HANDS),
                (0.12, _LEDGE_HANDS),
                (0.38, (0.235, 1.22, 0.30)),
                (0.60, (0.245, 0.82, 0.25)),
                (0.74, (0.245, 0.62, 0.24)),
                (0.92, (0.24, 0.72, 0.16)),
                (t, (0.24, 0.88, 0.06)),
            ],
        ),
        **mirrored(
            "fingers",
            [
                (0, (0.0, 0.42, 0.90)),
                (0.38, (-0.1, 0.1, 1.0)),
                (0.60, (-0.25, -0.15, 0.95)),
                (0.78, (-0.25, -0.15, 0.95)),
                (1.0, (0.0, -0.8, 0.5)),
                (t, (0.05, -1.0, 0.1)),
            ],
        ),
        **mirrored(
            "palm",
            [
                (0, (0.0, -0.90, 0.42)),
                (0.38, (0.0, -1.0, 0.1)),
                (0.60, (0.0, -1.0, -0.1)),
                (0.78, (0.0, -1.0, -0.1)),
                (1.0, (-0.6, -0.6, -0.5)),
                (t, (-1.0, 0.0, -0.1)),
            ],
        ),
        **mirrored(
            "elbow.to",
            [(0, (0.75, -0.65, 0.0)), (0.35, (0.7, 0.2, -0.7)), (0.7, (0.75, 0.2, -0.65)), (t, (0.6, -0.3, -0.75))],
        ),
        **both("loose", [(0, 0.0), (0.80, 0.0), (t, 1.0)]),
        # The right foot comes up onto the edge first.
        "foot.y.R": [(0, 0.15), (0.38, 0.12), (0.60, 0.34), (0.70, 0.20), (0.80, 0.0), (t, 0.0)],
        "foot.z.R": [(0, 0.167), (0.38, 0.14), (0.62, 0.22), (0.80, 0.02), (t, 0.0)],
        "foot.y.L": [(0, 0.24), (0.30, 0.10), (0.55, 0.03), (0.78, 0.06), (0.95, 0.10), (1.06, 0.0), (t, 0.0)],
        "foot.z.L": [(0, 0.167), (0.30, 0.10), (0.60, -0.16), (0.80, -0.22), (1.06, 0.0), (t, 0.0)],
        "foot.pitch.R": [(0, -24), (0.38, 20), (0.6, 6), (0.80, 0), (t, 0)],
        "foot.pitch.L": [(0, -24), (0.3, 24), (0.6, 52), (0.82, 44), (1.06, 0), (t, 0)],
        "foot.out.R": [(0, 0.02), (0.6, 0.03), (0.8, 0.012), (t, 0.012)],
        "foot.out.L": [(0, 0.02), (t, 0.012)],
        "foot.yaw.L": [(0, 8), (t, 7)],
        "foot.yaw.R": [(0, 8), (t, 7)],
        "knee.out.R": [(0, 14), (0.6, 22), (t, 0)],
        "knee.out.L": [(0, 14), (0.6, 8), (t, 0)],
        **both("curl", [(0, 46), (0.38, 20), (0.6, 6), (0.8, 8), (t, 24)]),
        **both("thumb", [(0, 12), (0.5, 0), (t, 0)]),
        **{name: value for name, value in stand.items() if name.startswith(("arm", "elbow", "turn"))},
    }
    return t, False, start | keys | {"on_wall": 1.0}, {"markers": [(0.80, "step_right"), (1.06, "step_left")]}


TABLES = {"climb": climb, "hang": hang, "ledge": ledge, "mantle": mantle}
