"""Eyes, lids, brows and lips: small patches on the face."""

import numpy as np
from giant import field as f

from . import mesh as m
from . import weights
from .face import EYE, EYE_RADIUS, face
from .palette import COLOURS

# Half width and half height of the eye's opening, in metres.
OPENING = (0.0160, 0.0073)


def pieces():
    """Eyes, lids and brows of both sides, and the mouth."""
    return [_mouth()] + m.both_sides(_eye()) + m.both_sides(_lid()) + m.both_sides(_brow())


def _on_face(points, lift):
    """Moves points along Z to the face's surface, and `lift` metres out of it."""
    result = points * 1.0
    result[:, 2] = 0.13
    for _ in range(40):
        result[:, 2] -= 0.6 * face(result)
    result[:, 2] += lift
    return result


def _almond(angle):
    """The edge of the left eye's opening about its middle, counter-clockwise from the outer corner."""
    x, y = np.cos(angle), np.sin(angle)
    height = np.where(y > 0.0, OPENING[1] * 1.02, OPENING[1] * 0.80)
    # The outer corner is a little higher than the inner one.
    return np.stack([OPENING[0] * np.sign(x) * np.abs(x) ** 0.85, height * y * np.abs(y) ** 0.15 + 0.0012 * x], axis=1)


def _bulged(flat):
    """Points (x, y about the eye's middle) on the eyeball."""
    depth = np.sqrt(np.maximum((EYE_RADIUS + 0.0007) ** 2 - (flat**2).sum(axis=1), 1e-6))
    return np.concatenate([EYE[:2] + flat, EYE[2] + depth[:, None]], axis=1)


def _eye():
    around = 14
    angle = 2 * np.pi * np.arange(around) / around
    edge = _almond(angle)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    look = np.array([-0.0008, 0.0006])
    inside = lambda radius: np.clip(
        look + radius * circle, -1, np.stack([np.ones(around), 0.93 * OPENING[1] * np.ones(around)], axis=1)
    )
    rings, colours = [], []
    for flat, colour in (
        (edge, "lash"),
        (0.93 * edge, "eye_white"),
        (inside(0.0070), "eye_white"),
        (inside(0.0068), "iris"),
        (inside(0.0034), "iris"),
        (inside(0.0031), "pupil"),
    ):
        rings.append(_bulged(flat))
        colours.append(np.tile(COLOURS[colour], (around, 1)))
    points, triangles = m.loft(rings, cap_end=True)
    colours = np.concatenate([*colours, [COLOURS["pupil"]]])
    triangles = _facing_front(points, triangles)
    shaded = 1.0 - 0.45 * f.smooth_step(0.002, OPENING[1], points[:, 1] - EYE[1])
    glint = [_glint()]
    points, triangles, colours = _with(points, triangles, colours * shaded[:, None], glint)
    return m.Piece("eye", points, triangles, "eyes", colours, weights.neck(points), 180.0, False)


def _glint():
    """The light in the eye: a small white square."""
    flat = np.array([(0.0012, 0.0018), (0.0030, 0.0018), (0.0030, 0.0034), (0.0012, 0.0034)])
    points = _bulged(flat) + (0.0, 0.0, 0.0004)
    return points, np.array([(0, 1, 2), (0, 2, 3)]), np.full((4, 3), 0.9)


def _with(points, triangles, colours, others):
    for more, faces, tint in others:
        triangles = np.concatenate([triangles, faces + len(points)])
        points, colours = np.concatenate([points, more]), np.concatenate([colours, tint])
    return points, triangles, colours


def _facing_front(points, triangles):
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    back = np.cross(b - a, c - a)[:, 2] < 0.0
    return np.where(back[:, None], triangles[:, ::-1], triangles)


def _strip(middle, widths, lift, rise):
    """A raised strip along points (n, 2) on the face, `widths` metres high."""
    count = len(middle)
    rows = []
    for share, out in ((-0.5, 0.0), (0.0, rise), (0.5, 0.0)):
        flat = middle + np.stack([np.zeros(count), share * np.asarray(widths)], axis=1)
        rows.append(_on_face(np.concatenate([flat, np.zeros((count, 1))], axis=1), lift + out))
    points = np.concatenate(rows)
    number = np.arange(3 * count).reshape(3, count)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]
    triangles = np.concatenate([np.stack([a, b, d], -1).reshape(-1, 3), np.stack([a, d, c], -1).reshape(-1, 3)])
    return points, _facing_front(points, triangles)


def _lid():
    """The upper lid with its dark lashes: an arch over the eye."""
    angle = np.linspace(np.pi * 1.01, -0.02 * np.pi, 9)
    edge = _almond(angle)
    rings = []
    for scale, out in ((0.96, 0.0006), (1.03, 0.0016), (1.20, 0.0010), (1.55, -0.0022)):
        flat = edge * (1.0 + 0.35 * (scale - 1.0), scale) + (0.0006 * (scale > 1.0), 0.0)
        rings.append(_bulged(flat) + (0.0, 0.0, out))
    points = np.concatenate(rings)
    number = np.arange(len(points)).reshape(4, -1)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]
    triangles = np.concatenate([np.stack([a, b, d], -1).reshape(-1, 3), np.stack([a, d, c], -1).reshape(-1, 3)])
    colours = m.plain(points, COLOURS["lash"])
    colours[number[2:].reshape(-1)] = (
        m.mixed(COLOURS["skin"], COLOURS["skin_warm"], np.full(number[2:].size, 0.8)) * 0.85
    )
    return m.Piece("lid", points, _facing_front(points, triangles), "skin", colours, weights.neck(points), 180.0, False)


def _brow():
    middle = np.array(
        [(0.0120, 1.6530), (0.0190, 1.6565), (0.0280, 1.6590), (0.0370, 1.6585), (0.0450, 1.6555), (0.0500, 1.6520)]
    )
    points, triangles = _strip(middle, (0.0062, 0.0074, 0.0070, 0.0058, 0.0042, 0.0016), 0.0002, 0.0019)
    return m.Piece(
        "brow", points, triangles, "hair", m.plain(points, COLOURS["brow"]), weights.neck(points), 180.0, False
    )


def _mouth():
    """Lips as a coloured strip over their relief, with a dark line between them."""
    x = np.array([-0.0235, -0.0175, -0.0100, -0.0040, 0.0, 0.0040, 0.0100, 0.0175, 0.0235])
    line = 1.5602 - 0.0010 * np.cos(x / 0.0235 * np.pi) * (np.abs(x) < 0.02)
    top = line + np.array([0.0, 0.0042, 0.0068, 0.0080, 0.0068, 0.0080, 0.0068, 0.0042, 0.0])
    bottom = line - np.array([0.0, 0.0045, 0.0074, 0.0084, 0.0086, 0.0084, 0.0074, 0.0045, 0.0])
    rows, colours = [], []
    for height, lift, colour in (
        (top, -0.0012, COLOURS["skin"]),
        ((top + 2 * line) / 3, 0.0019, COLOURS["lip"]),
        (line + 0.0005, 0.0010, np.multiply(COLOURS["lip"], 0.25)),
        (line - 0.0005, 0.0010, np.multiply(COLOURS["lip"], 0.25)),
        ((bottom + 2 * line) / 3, 0.0021, COLOURS["lip"]),
        (bottom, -0.0012, COLOURS["skin"]),
    ):
        rows.append(_on_face(np.stack([x, height, 0 * x], axis=1), lift))
        colours.append(m.plain(x, colour))
    points = np.concatenate(rows)
    number = np.arange(len(points)).reshape(6, -1)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]
    triangles = np.concatenate([np.stack([a, b, d], -1).reshape(-1, 3), np.stack([a, d, c], -1).reshape(-1, 3)])
    return m.Piece(
        "mouth",
        points,
        _facing_front(points, triangles),
        "skin",
        np.concatenate(colours),
        weights.neck(points),
        180.0,
        False,
    )
