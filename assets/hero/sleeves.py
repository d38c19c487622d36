"""Sleeves of linen and bracers of leather."""

import numpy as np
from giant import field as f

from . import mesh as m
from . import weights
from .palette import COLOURS
from .skeleton import (
    ALONG,
    ELBOW,
    FORWARD,
    LOWER,
    PALM_SIDE,
    SHOULDER,
    THUMB_SIDE,
    WRIST,
)


def pieces():
    """Sleeves and bracers of both arms."""
    return m.both_sides(_sleeve()) + m.both_sides(_bracer())


def upper_arm(p):
    """Distance to the sleeve of the left arm, down to the bracer."""
    folds = _folds(p)
    deltoid = f.ellipsoid(p, SHOULDER + (0.020, -0.018, 0.0), (0.058, 0.063, 0.060))
    upper = f.round_cone(p, SHOULDER, ELBOW, 0.054, 0.046)
    biceps = m.turned_ellipsoid(p, SHOULDER + 0.15 * ALONG + 0.010 * FORWARD, (0.085, 0.05, 0.05), _arm_axes())
    lower = f.round_cone(p, ELBOW, ELBOW + 0.10 * LOWER, 0.046, 0.053)
    cuff = f.round_cone(p, ELBOW + 0.075 * LOWER, ELBOW + 0.10 * LOWER, 0.055, 0.052)
    wrist = f.round_cone(p, ELBOW + 0.11 * LOWER, WRIST, 0.038, 0.028)
    return m.blended(deltoid, (upper, 0.05), (biceps, 0.03), (lower, 0.03), (cuff, 0.03), (wrist, 0.012)) - folds


def _arm_axes():
    return np.stack([ALONG, PALM_SIDE, FORWARD], axis=1)


def _folds(p):
    """Height of the sleeve's folds: rings that wind about the arm, strongest near the elbow."""
    along = (p - SHOULDER) @ ALONG
    around = np.arctan2((p - SHOULDER) @ FORWARD, (p - SHOULDER) @ PALM_SIDE)
    strong = f.smooth_step(0.10, 0.22, along) * f.smooth_step(0.40, 0.34, along)
    wave = np.sin(2 * np.pi * along / 0.052 + 1.3 * np.sin(around + 0.6) + 0.7 * np.sin(2 * around))
    return (0.0008 + 0.0042 * strong) * wave


def _sleeve():
    share = np.array([-0.16, -0.04, 0.08, 0.20, 0.33, 0.46, 0.59, 0.70, 0.80, 0.90, 1.0])
    upper = SHOULDER + 0.285 * share[:, None] * ALONG
    lower = ELBOW + np.array([0.026, 0.052, 0.072, 0.090, 0.104])[:, None] * LOWER
    path = np.concatenate([upper[:-1], ELBOW[None], lower])
    rings = m.wrapped(upper_arm, path, 12, FORWARD, 0.11)
    # Its upper side is flat under the mantle, so that a raised arm does not come through it.
    for row, size in enumerate((0.30, 0.45, 0.68, 0.86)):
        above = np.maximum(-(rings[row] - path[row]) @ PALM_SIDE, 0.0)
        rings[row] += (1.0 - size) * above[:, None] * PALM_SIDE
    points, triangles = m.loft(rings)
    return m.Piece("sleeve", points, triangles, "cloth", m.plain(points, COLOURS["linen"]), weights.arm(points), 80.0)


def _bracer():
    stations = np.array([0.093, 0.096, 0.118, 0.125, 0.166, 0.170, 0.208, 0.212, 0.236, 0.237])
    radii = np.array([0.042, 0.0500, 0.0485, 0.0455, 0.0415, 0.0412, 0.0372, 0.0392, 0.0375, 0.026])
    path = ELBOW + stations[:, None] * LOWER
    rings = [m.ring(c, PALM_SIDE, THUMB_SIDE, (0.90 * r, r), 12) for c, r in zip(path, radii)]
    points, triangles = m.loft(np.array(rings))
    row = np.arange(len(points)) // 12
    colours = m.plain(points, COLOURS["leather"])
    colours[np.isin(row, (0, 1, 2, 7, 8, 9))] = COLOURS["leather_dark"]
    colours[np.isin(row, (4, 5))] = np.asarray(COLOURS["leather"]) * 0.7
    return m.Piece("bracer", points, triangles, "leather", colours, weights.arm(points), 40.0)
