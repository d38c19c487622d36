"""The hero's head: face, ears, neck, eyes, brows, lips, hair."""

import numpy as np
from giant import field as f

from . import mesh as m
from . import weights
from .palette import COLOURS

EYE = np.array([0.0310, 1.6335, 0.0655])
EYE_RADIUS = 0.0150
# Half width and half height of the eye's opening, in metres.
OPENING = (0.0160, 0.0073)
SKULL = (0.0, 1.652, -0.012)


def pieces(thinned):
    """Face, eyes, brows, mouth, hair."""
    result = [_face(thinned), _hair(thinned), _mouth()]
    for piece in (_eye(), _lid(), _brow()):
        result += m.both_sides(piece)
    return result


def face(points):
    """Distance to the head and the neck, without hair."""
    p = points * 1.0
    p[:, 0] = np.abs(p[:, 0])
    skull = f.ellipsoid(p, SKULL, (0.0725, 0.086, 0.093))
    mask = f.ellipsoid(p, (0, 1.600, 0.022), (0.0590, 0.082, 0.069))
    jaw = f.round_cone(p, (0.0480, 1.572, -0.002), (0.0130, 1.5215, 0.066), 0.0155, 0.0125)
    chin = f.ellipsoid(p, (0, 1.5200, 0.0755), (0.0200, 0.0135, 0.0130))
    cheek = f.ellipsoid(p, (0.0415, 1.606, 0.0560), (0.021, 0.016, 0.019))
    brow = f.round_cone(p, (0.010, 1.6530, 0.0850), (0.0440, 1.6545, 0.0640), 0.0085, 0.0085)
    muzzle = f.ellipsoid(p, (0, 1.560, 0.0740), (0.0270, 0.026, 0.0165))
    neck = f.round_cone(p, (0, 1.42, -0.034), (0, 1.575, -0.022), 0.0520, 0.0480)
    nape = f.round_cone(p, (0.022, 1.44, -0.050), (0.030, 1.60, -0.045), 0.036, 0.030)
    cords = f.round_cone(p, (0.012, 1.445, 0.022), (0.052, 1.575, -0.022), 0.010, 0.013)
    throat = f.ellipsoid(p, (0, 1.492, 0.0175), (0.012, 0.016, 0.012))
    head = m.blended(skull, (mask, 0.035), (jaw, 0.030), (cheek, 0.020), (muzzle, 0.018), (chin, 0.020), (brow, 0.014))
    socket = f.ellipsoid(p, (0.0315, 1.6360, 0.0900), (0.0190, 0.0110, 0.0165))
    head = m.smooth_carved(head, socket, 0.012)
    head = m.blended(head, (np.linalg.norm(p - EYE, axis=1) - EYE_RADIUS, 0.005))
    bridge = f.round_cone(p, (0, 1.6460, 0.0840), (0, 1.6050, 0.1030), 0.0070, 0.0090)
    tip = f.ellipsoid(p, (0, 1.5985, 0.1055), (0.0102, 0.0092, 0.0105))
    wing = f.ellipsoid(p, (0.0112, 1.5960, 0.0955), (0.0068, 0.0070, 0.0105))
    head = m.blended(head, (bridge, 0.014), (tip, 0.008), (wing, 0.006))
    upper = f.ellipsoid(p, (0.006, 1.5655, 0.0900), (0.0165, 0.0050, 0.0085))
    lower = f.ellipsoid(p, (0, 1.5555, 0.0890), (0.0165, 0.0058, 0.0085))
    head = m.blended(head, (upper, 0.006), (lower, 0.007))
    ear = f.ellipsoid(p, (0.0755, 1.612, -0.012), (0.0085, 0.0300, 0.0185), pitch=-0.22)
    ear = m.smooth_carved(ear, f.ellipsoid(p, (0.0860, 1.616, -0.008), (0.0080, 0.0190, 0.0105), pitch=-0.22), 0.006)
    return m.blended(head, (ear, 0.008), (nape, 0.03), (neck, 0.024), (cords, 0.012), (throat, 0.012))


def _face(thinned):
    cut = lambda p: np.maximum(face(p), 1.432 - p[:, 1])
    points, triangles = m.meshed(cut, (-0.1, 1.40, -0.13), (0.1, 1.76, 0.14), 0.0046, 0.076, thinned)
    points, triangles = _without_hidden(points, triangles)
    x, y, z = np.abs(points[:, 0]), points[:, 1], points[:, 2]
    warm = np.maximum.reduce([
        0.65 * _spot(points, (0.043, 1.596, 0.068), 0.026), 0.8 * _spot(points, (0, 1.598, 0.117), 0.014),
        0.7 * _spot(points, (0.082, 1.612, -0.012), 0.03), 0.35 * _spot(points, (0, 1.522, 0.088), 0.02),
        0.5 * _spot(points, (0.0315, 1.6335, 0.082), 0.020),
    ])
    colours = m.mixed(COLOURS["skin"], COLOURS["skin_warm"], warm)
    # A hint of a beard's shadow about the jaw.
    beard = f.smooth_step(1.562, 1.535, y) * f.smooth_step(1.48, 1.52, y) * f.smooth_step(-0.01, 0.03, z)
    colours *= 1.0 - 0.13 * beard[:, None]
    return m.Piece("face", points, triangles, "skin", colours, weights.neck(points), 180.0)


def _spot(points, centre, size):
    """1 at a place of either side, falling to 0 within `size` metres."""
    p = points * 1.0
    p[:, 0] = np.abs(p[:, 0])
    return f.smooth_step(size, 0.0, np.linalg.norm(p - np.asarray(centre), axis=1))


def _without_hidden(points, triangles):
    """Drops the skin that hair covers well."""
    deep = hair(points) < -0.006
    kept = ~deep[triangles].all(axis=1)
    used, renumbered = np.unique(triangles[kept], return_inverse=True)
    return points[used], renumbered.reshape(-1, 3)


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
    inside = lambda radius: np.clip(look + radius * circle, -1, np.stack([np.ones(around), 0.93 * OPENING[1] * np.ones(around)], axis=1))
    rings, colours = [], []
    for flat, colour in (
        (edge, "lash"), (0.93 * edge, "eye_white"), (inside(0.0070), "eye_white"), (inside(0.0068), "iris"),
        (inside(0.0034), "iris"), (inside(0.0031), "pupil"),
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
    colours[number[2:].reshape(-1)] = m.mixed(COLOURS["skin"], COLOURS["skin_warm"], np.full(number[2:].size, 0.8)) * 0.85
    return m.Piece("lid", points, _facing_front(points, triangles), "skin", colours, weights.neck(points), 180.0, False)


def _brow():
    middle = np.array([(0.0120, 1.6530), (0.0190, 1.6565), (0.0280, 1.6590), (0.0370, 1.6585), (0.0450, 1.6555), (0.0500, 1.6520)])
    points, triangles = _strip(middle, (0.0062, 0.0074, 0.0070, 0.0058, 0.0042, 0.0016), 0.0002, 0.0019)
    return m.Piece("brow", points, triangles, "hair", m.plain(points, COLOURS["brow"]), weights.neck(points), 180.0, False)


def _mouth():
    """Lips as a coloured strip over their relief, with a dark line between them."""
    x = np.array([-0.0235, -0.0175, -0.0100, -0.0040, 0.0, 0.0040, 0.0100, 0.0175, 0.0235])
    line = 1.5602 - 0.0010 * np.cos(x / 0.0235 * np.pi) * (np.abs(x) < 0.02)
    top = line + np.array([0.0, 0.0042, 0.0068, 0.0080, 0.0068, 0.0080, 0.0068, 0.0042, 0.0])
    bottom = line - np.array([0.0, 0.0045, 0.0074, 0.0084, 0.0086, 0.0084, 0.0074, 0.0045, 0.0])
    rows, colours = [], []
    for height, lift, colour in (
        (top, -0.0012, COLOURS["skin"]), ((top + 2 * line) / 3, 0.0019, COLOURS["lip"]), (line + 0.0005, 0.0010, np.multiply(COLOURS["lip"], 0.25)),
        (line - 0.0005, 0.0010, np.multiply(COLOURS["lip"], 0.25)), ((bottom + 2 * line) / 3, 0.0021, COLOURS["lip"]), (bottom, -0.0012, COLOURS["skin"]),
    ):
        rows.append(_on_face(np.stack([x, height, 0 * x], axis=1), lift))
        colours.append(m.plain(x, colour))
    points = np.concatenate(rows)
    number = np.arange(len(points)).reshape(6, -1)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]
    triangles = np.concatenate([np.stack([a, b, d], -1).reshape(-1, 3), np.stack([a, d, c], -1).reshape(-1, 3)])
    return m.Piece("mouth", points, _facing_front(points, triangles), "skin", np.concatenate(colours), weights.neck(points), 180.0, False)


# Locks of hair: points from the root to the tip, radius at the root and at the tip; metres, left side or middle.
_LOCKS = [
    # Over the brow, swept to his left.
    (((-0.040, 1.722, 0.042), (-0.020, 1.708, 0.086), (0.012, 1.682, 0.099), (0.034, 1.664, 0.092)), 0.017, 0.004),
    (((-0.050, 1.715, 0.035), (-0.046, 1.698, 0.074), (-0.024, 1.682, 0.096), (-0.006, 1.668, 0.101)), 0.016, 0.003),
    (((-0.015, 1.732, 0.040), (0.016, 1.718, 0.080), (0.046, 1.690, 0.084), (0.060, 1.662, 0.066)), 0.018, 0.004),
    (((-0.056, 1.706, 0.030), (-0.062, 1.684, 0.060), (-0.058, 1.660, 0.072), (-0.048, 1.648, 0.080)), 0.014, 0.003),
    (((0.030, 1.726, 0.030), (0.056, 1.704, 0.054), (0.072, 1.668, 0.048), (0.074, 1.640, 0.038)), 0.017, 0.004),
    # Before the ears.
    (((0.066, 1.690, 0.024), (0.076, 1.655, 0.028), (0.076, 1.620, 0.026), (0.070, 1.592, 0.030)), 0.014, 0.003),
    (((-0.066, 1.690, 0.024), (-0.076, 1.655, 0.028), (-0.077, 1.616, 0.025), (-0.071, 1.586, 0.030)), 0.014, 0.003),
    # Over the ears, to the back.
    (((0.066, 1.700, 0.000), (0.083, 1.660, -0.012), (0.086, 1.622, -0.036), (0.078, 1.575, -0.058)), 0.018, 0.006),
    (((-0.066, 1.700, 0.000), (-0.083, 1.660, -0.012), (-0.086, 1.622, -0.036), (-0.078, 1.572, -0.058)), 0.018, 0.006),
    (((0.050, 1.710, -0.050), (0.074, 1.655, -0.076), (0.070, 1.600, -0.090), (0.060, 1.545, -0.086)), 0.024, 0.006),
    (((-0.050, 1.710, -0.050), (-0.074, 1.655, -0.076), (-0.070, 1.600, -0.090), (-0.062, 1.548, -0.086)), 0.024, 0.006),
    (((0.020, 1.720, -0.070), (0.032, 1.660, -0.106), (0.034, 1.595, -0.110), (0.026, 1.530, -0.096)), 0.025, 0.006),
    (((-0.022, 1.720, -0.070), (-0.034, 1.660, -0.106), (-0.034, 1.598, -0.110), (-0.030, 1.536, -0.098)), 0.025, 0.006),
    (((0.0, 1.700, -0.088), (0.0, 1.640, -0.112), (-0.002, 1.580, -0.112), (0.002, 1.520, -0.096)), 0.022, 0.006),
    # Stray tufts of the crown.
    (((0.008, 1.725, -0.040), (0.020, 1.727, -0.066), (0.030, 1.716, -0.092), (0.038, 1.698, -0.108)), 0.016, 0.004),
    (((-0.026, 1.722, -0.030), (-0.040, 1.718, -0.056), (-0.052, 1.704, -0.080), (-0.060, 1.684, -0.096)), 0.016, 0.004),
    # From the parting over the crown.
    (((-0.030, 1.720, 0.030), (-0.006, 1.731, 0.004), (0.024, 1.724, -0.026), (0.046, 1.704, -0.056)), 0.016, 0.006),
    (((-0.034, 1.718, 0.026), (-0.052, 1.712, -0.004), (-0.060, 1.700, -0.036), (-0.064, 1.676, -0.066)), 0.016, 0.006),
]


def hair(points):
    """Distance to the hair: a cap with strands, and locks over it."""
    p = points
    x = np.abs(p[:, 0])
    cap = f.ellipsoid(p, (0.0, 1.655, -0.018), (0.0825, 0.0900, 0.1005))
    # The hairline: over the brow, before the ears, and around the nape.
    line = np.interp(p[:, 2], (-0.10, -0.05, -0.02, 0.015, 0.040, 0.070, 0.12), (1.560, 1.575, 1.625, 1.650, 1.672, 1.686, 1.694))
    cap = np.maximum(cap, 0.8 * (line - p[:, 1]))
    around = np.arctan2(p[:, 0] + 0.012, -(p[:, 2] + 0.02))
    strands = 0.0021 * f.smooth_step(0.02, 0.06, np.hypot(p[:, 0] + 0.012, p[:, 2] + 0.02)) * np.sin(26.0 * around + 3.0 * np.sin(30.0 * (p[:, 1] - 1.6)) + 2.0 * np.sin(3.0 * around))
    result = cap - strands
    for path, root, tip in _LOCKS:
        for part in range(3):
            start, end = (root + (tip - root) * (n / 3.0) ** 1.3 for n in (part, part + 1))
            result = f.smooth_union(result, f.round_cone(p, path[part], path[part + 1], start, end), 0.008)
    return result


def _hair(thinned):
    points, triangles = m.meshed(hair, (-0.13, 1.48, -0.16), (0.13, 1.78, 0.14), 0.0058, 0.094, thinned)
    points, triangles = _clear_of_skin(points, triangles)
    around = np.arctan2(points[:, 0] + 0.012, -(points[:, 2] + 0.02))
    streak = 0.5 + 0.5 * np.sin(26.0 * around + 3.0 * np.sin(30.0 * (points[:, 1] - 1.6)) + 2.0 * np.sin(3.0 * around))
    cap = f.ellipsoid(points, (0.0, 1.655, -0.018), (0.0825, 0.0900, 0.1005))
    high = f.smooth_step(-0.002, 0.014, cap)
    colours = m.mixed(COLOURS["hair"], COLOURS["hair_light"], np.clip(0.25 * streak + 0.55 * high + 0.25 * f.smooth_step(1.60, 1.74, points[:, 1]), 0, 1))
    return m.Piece("hair", points, triangles, "hair", colours, weights.neck(points), 65.0)


def _clear_of_skin(points, triangles):
    """Drops the hair's inner side."""
    deep = face(points) < -0.004
    kept = ~deep[triangles].all(axis=1)
    used, renumbered = np.unique(triangles[kept], return_inverse=True)
    return points[used], renumbered.reshape(-1, 3)
