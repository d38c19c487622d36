"""The hair: a cap with strands, and locks over it."""

import numpy as np
from giant import field as f

from . import mesh as m
from . import weights
from .face import face
from .palette import COLOURS

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
    (
        ((-0.050, 1.710, -0.050), (-0.074, 1.655, -0.076), (-0.070, 1.600, -0.090), (-0.062, 1.548, -0.086)),
        0.024,
        0.006,
    ),
    (((0.020, 1.720, -0.070), (0.032, 1.660, -0.106), (0.034, 1.595, -0.110), (0.026, 1.530, -0.096)), 0.025, 0.006),
    (
        ((-0.022, 1.720, -0.070), (-0.034, 1.660, -0.106), (-0.034, 1.598, -0.110), (-0.030, 1.536, -0.098)),
        0.025,
        0.006,
    ),
    (((0.0, 1.700, -0.088), (0.0, 1.640, -0.112), (-0.002, 1.580, -0.112), (0.002, 1.520, -0.096)), 0.022, 0.006),
    # Stray tufts of the crown.
    (((0.008, 1.725, -0.040), (0.020, 1.727, -0.066), (0.030, 1.716, -0.092), (0.038, 1.698, -0.108)), 0.016, 0.004),
    (
        ((-0.026, 1.722, -0.030), (-0.040, 1.718, -0.056), (-0.052, 1.704, -0.080), (-0.060, 1.684, -0.096)),
        0.016,
        0.004,
    ),
    # From the parting over the crown.
    (((-0.030, 1.720, 0.030), (-0.006, 1.731, 0.004), (0.024, 1.724, -0.026), (0.046, 1.704, -0.056)), 0.016, 0.006),
    (((-0.034, 1.718, 0.026), (-0.052, 1.712, -0.004), (-0.060, 1.700, -0.036), (-0.064, 1.676, -0.066)), 0.016, 0.006),
]


def hair(points):
    """Distance to the hair: a cap with strands, and locks over it."""
    p = points
    cap = f.ellipsoid(p, (0.0, 1.655, -0.018), (0.0825, 0.0900, 0.1005))
    # The hairline: over the brow, before the ears, and around the nape.
    line = np.interp(
        p[:, 2], (-0.10, -0.05, -0.02, 0.015, 0.040, 0.070, 0.12), (1.560, 1.575, 1.625, 1.650, 1.672, 1.686, 1.694)
    )
    cap = np.maximum(cap, 0.8 * (line - p[:, 1]))
    around = np.arctan2(p[:, 0] + 0.012, -(p[:, 2] + 0.02))
    strands = (
        0.0021
        * f.smooth_step(0.02, 0.06, np.hypot(p[:, 0] + 0.012, p[:, 2] + 0.02))
        * np.sin(26.0 * around + 3.0 * np.sin(30.0 * (p[:, 1] - 1.6)) + 2.0 * np.sin(3.0 * around))
    )
    result = cap - strands
    for path, root, tip in _LOCKS:
        for part in range(3):
            start, end = (root + (tip - root) * (n / 3.0) ** 1.3 for n in (part, part + 1))
            result = f.smooth_union(result, f.round_cone(p, path[part], path[part + 1], start, end), 0.008)
    return result


def piece(thinned):
    """The hair."""
    points, triangles = m.meshed(hair, (-0.13, 1.48, -0.16), (0.13, 1.78, 0.14), 0.0058, 0.094, thinned)
    points, triangles = _clear_of_skin(points, triangles)
    around = np.arctan2(points[:, 0] + 0.012, -(points[:, 2] + 0.02))
    streak = 0.5 + 0.5 * np.sin(26.0 * around + 3.0 * np.sin(30.0 * (points[:, 1] - 1.6)) + 2.0 * np.sin(3.0 * around))
    cap = f.ellipsoid(points, (0.0, 1.655, -0.018), (0.0825, 0.0900, 0.1005))
    high = f.smooth_step(-0.002, 0.014, cap)
    colours = m.mixed(
        COLOURS["hair"],
        COLOURS["hair_light"],
        np.clip(0.25 * streak + 0.55 * high + 0.25 * f.smooth_step(1.60, 1.74, points[:, 1]), 0, 1),
    )
    return m.Piece("hair", points, triangles, "hair", colours, weights.neck(points), 65.0)


def _clear_of_skin(points, triangles):
    """Drops the hair's inner side."""
    deep = face(points) < -0.004
    kept = ~deep[triangles].all(axis=1)
    used, renumbered = np.unique(triangles[kept], return_inverse=True)
    return points[used], renumbered.reshape(-1, 3)
