"""The trunk under its clothes, the tunic, and what is strapped about it."""

import numpy as np
from giant import field as f

from . import mesh as m
from . import weights
from .palette import COLOURS
from .skeleton import FORWARD, LEFT, SHOULDER

BELT = 1.045
HEM = 0.715
# The tunic's waist and hem: half widths and half depths, in metres.
WAIST_SIZE, HEM_SIZE = (0.146, 0.107), (0.232, 0.178)
SKIRT_FOLDS, FOLD_DEPTH = 8, 0.012
# How far the lining is inside the cloth, from the hem upwards, in metres.
LINING = (0.010, 0.016, 0.032, 0.060)


def pieces():
    """Tunic, belt, pouch and the strap of the quiver."""
    return [_tunic(), _skirt(), _belt(), _buckle(), _pouch(), _baldric()]


def trunk(p):
    """Distance to the clothed trunk; both sides alike."""
    p = p * 1.0
    p[:, 0] = np.abs(p[:, 0])
    ribs = f.ellipsoid(p, (0, 1.285, -0.016), (0.158, 0.185, 0.108))
    return m.blended(
        ribs,
        (f.ellipsoid(p, (0, 1.10, -0.004), (0.138, 0.16, 0.098)), 0.08),
        (f.ellipsoid(p, (0, 0.965, -0.006), (0.160, 0.12, 0.112)), 0.08),
        (f.ellipsoid(p, (0.066, 1.322, 0.058), (0.080, 0.058, 0.042), pitch=-0.25), 0.05),
        (f.ellipsoid(p, (0.085, 1.34, -0.085), (0.075, 0.10, 0.045)), 0.05),
        (f.round_cone(p, (0.05, 1.415, -0.024), SHOULDER + (0.0, -0.004, 0.0), 0.052, 0.054), 0.05),
        (f.round_cone(p, (0.02, 1.475, -0.034), (0.125, 1.43, -0.028), 0.046, 0.036), 0.04),
        (f.round_cone(p, (0.125, 1.33, -0.045), (0.13, 1.18, -0.03), 0.045, 0.03), 0.06),
    )


def _tunic():
    """The tunic's upper part, open in a short slit under the throat."""
    heights = np.array([1.03, 1.07, 1.105, 1.14, 1.175, 1.21, 1.25, 1.29, 1.33, 1.37, 1.41])
    path = np.stack([0 * heights, heights, np.interp(heights, (1.0, 1.3, 1.48), (-0.004, -0.014, -0.034))], axis=1)
    creases = lambda p: (
        trunk(p)
        - 0.0035 * np.sin(46 * p[:, 1] + 26 * np.abs(p[:, 0]) + 5 * p[:, 2]) * f.smooth_step(1.24, 1.10, p[:, 1])
    )
    rings = m.wrapped(creases, path, 32, LEFT, 0.30)
    points, triangles = m.loft(rings)
    placket = f.smooth_step(0.018, 0.012, np.abs(points[:, 0])) * (points[:, 2] > 0.0) * (points[:, 1] > 1.30)
    seam = f.smooth_step(0.15, 0.2, np.abs(points[:, 0])) * 0.3
    colours = m.mixed(COLOURS["tunic"], COLOURS["tunic_dark"], np.maximum(placket, seam))
    return m.Piece("tunic", points, triangles, "cloth", colours, weights.body(points), 80.0)


def _skirt_ring(share, inset=0.0):
    """A ring of the skirt, `share` of the way from the belt to the hem."""
    around = 34
    angle = 2 * np.pi * np.arange(around) / around
    half = [np.interp(share**bulge, (0.0, 1.0), pair) for pair, bulge in zip(zip(WAIST_SIZE, HEM_SIZE), (0.7, 0.55))]
    fold = np.cos(SKIRT_FOLDS * angle + 0.5 * np.sin(3 * angle)) + 0.3 * np.cos(5 * angle + 1.0)
    # The hem is cut higher at the sides, where the thighs push it up.
    slit = np.abs(np.cos(angle)) ** 10
    x = (half[0] + FOLD_DEPTH * share * fold - inset) * np.cos(angle)
    z = (half[1] + FOLD_DEPTH * share * fold - inset) * np.sin(angle)
    y = BELT - 0.012 + (HEM - BELT) * share * (1.0 - 0.13 * slit) + 0.004 * share * fold
    return np.stack([x, y, z - 0.004], axis=1)


def _skirt():
    shares = (0.0, 0.16, 0.36, 0.58, 0.80, 0.93, 0.932, 1.0)
    outer = [_skirt_ring(share) for share in shares]
    # The lining has its rings where the cloth has some, so that it stays inside when the thighs bend both.
    inner = [_skirt_ring(share, inset) for share, inset in zip((1.0, 0.8, 0.58, 0.36), LINING)]
    points, triangles = m.loft(np.array(outer + inner))
    around = len(outer[0])
    row = np.arange(len(points)) // around
    colours = m.plain(points, COLOURS["tunic"])
    colours[row >= len(outer)] = COLOURS["tunic_dark"]
    colours[(row == len(outer) - 1) | (row == len(outer) - 2)] = COLOURS["trim"]
    shade = 0.82 + 0.18 * np.cos(SKIRT_FOLDS * np.arctan2(points[:, 2], points[:, 0]))[:, None] * 0.6
    colours = np.where((row < len(outer) - 2)[:, None], colours * shade, colours)
    return m.Piece("skirt", points, triangles, "cloth", colours, weights.body(points, legs=0.94), 70.0)


def _belt():
    path = np.array([(0, BELT + h, -0.005) for h in (-0.027, -0.025, -0.020, 0.020, 0.025, 0.027)])
    grow = np.array([-0.004, 0.012, 0.0145, 0.0145, 0.0145, 0.012, -0.004])
    rings = [m.ring(c, LEFT, FORWARD, (WAIST_SIZE[0] + g, WAIST_SIZE[1] + g + 0.002), 24) for c, g in zip(path, grow)]
    points, triangles = m.loft(np.array(rings))
    row = np.arange(len(points)) // 24
    colours = np.where(np.isin(row, (2, 3))[:, None], COLOURS["leather"], np.asarray(COLOURS["leather"]) * 0.7)
    return m.Piece("belt", points, triangles, "leather", colours, weights.body(points), 50.0)


def _baldric():
    """The strap of the quiver: from the right shoulder, under the mantle, to the left hip."""
    around, middle = 26, np.array([0.0, 1.22, -0.010])
    slope = np.array([0.52, -0.85, 0.0])
    slope /= np.linalg.norm(slope)
    rings = []
    for aside, lift in ((-0.017, -0.003), (-0.015, 0.005), (0.015, 0.005), (0.017, -0.003)):
        centre = middle + aside * np.cross(FORWARD, slope)
        path = np.stack([centre - 0.01 * np.cross(FORWARD, slope), centre, centre + 0.01 * np.cross(FORWARD, slope)])
        rings.append(m.wrapped(lambda p, lift=lift: trunk(p) - lift - 0.003, path, around, FORWARD, 0.34)[1])
    points, triangles = m.loft(rings)
    row = np.arange(len(points)) // around
    colours = np.where(np.isin(row, (1, 2))[:, None], COLOURS["leather"], COLOURS["leather_dark"])
    return m.Piece("baldric", points, triangles, "leather", colours, weights.body(points), 50.0)


def _box(centre, half, axes=None):
    """A box with bevelled front: points and triangles; the front is the third axis."""
    outline = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)
    rings = []
    for depth, size in ((-1.0, 1.0), (0.55, 1.0), (1.0, 0.82)):
        corner = np.concatenate([outline * size, np.full((4, 1), depth)], axis=1) * half
        rings.append(np.asarray(centre) + corner @ (np.eye(3) if axes is None else axes).T)
    return m.loft(rings, cap_end=True)


def _buckle():
    points, triangles = _box((0, BELT, WAIST_SIZE[1] + 0.011), (0.027, 0.032, 0.010))
    return m.Piece("buckle", points, triangles, "metal", m.plain(points, COLOURS["brass"]), weights.body(points), 30.0)


def _pouch():
    """A bag on the right of the belt, towards the back."""
    angle = np.radians(212.0)
    out = np.array([np.cos(angle), 0.0, np.sin(angle)])
    axes = np.stack([np.cross((0, 1, 0), out), (0, 1, 0), out], axis=1)
    centre = np.array([0.150 * np.cos(angle), BELT - 0.055, 0.113 * np.sin(angle)]) + 0.022 * out
    points, triangles = _box(centre, (0.043, 0.045, 0.026), axes)
    colours = m.mixed(COLOURS["leather_dark"], COLOURS["leather"], f.smooth_step(-0.01, 0.02, points[:, 1] - centre[1]))
    return m.Piece("pouch", points, triangles, "leather", colours, weights.body(points), 30.0)
