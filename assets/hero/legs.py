"""Trousers and boots."""

import numpy as np
from giant import field as f

from . import mesh as m
from . import weights
from .palette import COLOURS
from .skeleton import ANKLE, HIP, LEFT, head

BOOT_TOP = 0.395


def pieces(thinned):
    """Trousers and boots of both legs."""
    return m.both_sides(_trouser()) + m.both_sides(_boot(thinned))


def _leg_field(p):
    """Distance to the left leg of the trousers."""
    knee = head("shin.L")
    cloth = 0.004 * np.sin(2 * np.pi * p[:, 1] / 0.055 + 1.2 * np.sin(np.arctan2(p[:, 2], p[:, 0] - 0.095)))
    cloth *= f.smooth_step(0.62, 0.50, p[:, 1])
    return (
        m.blended(
            f.round_cone(p, HIP + (0.0, -0.02, 0.0), knee, 0.089, 0.060),
            (f.ellipsoid(p, (0.094, 0.76, 0.020), (0.076, 0.16, 0.078)), 0.04),
            (f.ellipsoid(p, HIP + (0.0, 0.02, -0.045), (0.078, 0.090, 0.050)), 0.05),
            (f.ellipsoid(p, knee + (0.0, 0.0, 0.012), (0.054, 0.065, 0.052)), 0.03),
            (f.round_cone(p, knee, ANKLE, 0.058, 0.040), 0.03),
            (f.ellipsoid(p, (0.100, 0.365, -0.030), (0.056, 0.10, 0.060)), 0.03),
        )
        - cloth
    )


def _trouser():
    heights = np.array([0.965, 0.90, 0.845, 0.79, 0.735, 0.685, 0.64, 0.60, 0.565, 0.53, 0.492, 0.455, 0.42, 0.38])
    path = np.stack(
        [
            np.interp(heights, (ANKLE[1], HIP[1], 0.99), (ANKLE[0], HIP[0], 0.082)),
            heights,
            np.interp(heights, (ANKLE[1], 0.49, HIP[1]), (-0.026, 0.0, -0.006)),
        ],
        axis=1,
    )
    rings = m.wrapped(_leg_field, path, 14, LEFT, 0.16)
    # The upper end hides under the skirt.
    rings[0] = path[0] + 0.62 * (rings[0] - path[0])
    rings[1] = path[1] + 0.84 * (rings[1] - path[1])
    # Both legs meet in the middle plane.
    rings[..., 0] = np.maximum(rings[..., 0], -0.004)
    points, triangles = m.loft(rings)
    colours = m.mixed(COLOURS["trousers"], COLOURS["trousers_dark"], f.smooth_step(0.06, 0.02, points[:, 0]))
    return m.Piece("trouser", points, triangles, "cloth", colours, weights.leg(points), 80.0)


def boot_field(p):
    """Distance to the left boot: foot, shaft, folded top, sole with a heel."""
    knee = head("shin.L")
    turn = np.radians(6.0)
    q = p - (0.103, 0.0, 0.0)
    q = np.stack(
        [np.cos(turn) * q[:, 0] - np.sin(turn) * q[:, 2], q[:, 1], np.sin(turn) * q[:, 0] + np.cos(turn) * q[:, 2]],
        axis=1,
    )
    shaft = f.round_cone(p, knee, ANKLE + (0.0, 0.0, 0.002), 0.064, 0.046)
    calf = f.ellipsoid(p, (0.101, 0.325, -0.030), (0.058, 0.11, 0.064))
    heel = f.ellipsoid(q, (0.0, 0.050, -0.042), (0.036, 0.052, 0.042))
    instep = f.round_cone(q, (0.0, 0.088, -0.010), (0.002, 0.044, 0.110), 0.044, 0.034)
    ball = f.ellipsoid(q, (0.004, 0.034, 0.108), (0.046, 0.032, 0.055))
    tip = f.ellipsoid(q, (-0.002, 0.030, 0.150), (0.036, 0.026, 0.042))
    folds = (
        0.0030
        * np.sin(p[:, 1] * 120 + p[:, 2] * 30)
        * f.smooth_step(0.08, 0.11, p[:, 1])
        * f.smooth_step(0.22, 0.16, p[:, 1])
    )
    upper = m.blended(shaft, (calf, 0.03), (heel, 0.04), (instep, 0.035), (ball, 0.03), (tip, 0.025)) - folds
    upper = np.maximum(upper, p[:, 1] - BOOT_TOP)
    cuff = np.maximum(
        f.round_cone(p, knee, ANKLE, 0.076, 0.060),
        np.abs(p[:, 1] - BOOT_TOP + 0.036)
        - 0.036
        - 0.012 * np.sin(2.0 * np.arctan2(p[:, 2] + 0.01, p[:, 0] - 0.1)) * (p[:, 1] < BOOT_TOP - 0.03),
    )
    outline = np.minimum(
        f.ellipsoid(q, (0.003, 0.0, 0.100), (0.050, 0.2, 0.098)),
        f.ellipsoid(q, (-0.001, 0.0, -0.030), (0.041, 0.2, 0.060)),
    )
    outline = m.blended(outline, (f.round_cone(q, (0.0, 0.0, -0.02), (0.002, 0.0, 0.10), 0.036, 0.042), 0.03))
    sole = np.maximum(outline, p[:, 1] - 0.021)
    arch = np.maximum(np.abs(q[:, 2] - 0.028) - 0.024, p[:, 1] - 0.010)
    sole = np.maximum(sole, -arch)
    whole = np.minimum(np.minimum(np.maximum(upper, 0.008 - p[:, 1]), cuff), sole)
    return np.maximum(whole, -p[:, 1])


def _boot(thinned):
    points, triangles = m.meshed(boot_field, (0.0, -0.03, -0.14), (0.22, 0.43, 0.24), 0.0105, 0.092, thinned)
    points = points * (1.0, 0.0, 1.0) + (0.0, 1.0, 0.0) * np.maximum(points[:, 1:2], 0.0)
    colours = m.plain(points, COLOURS["boot"])
    colours[points[:, 1] < 0.024] = COLOURS["sole"]
    cuff = points[:, 1] > BOOT_TOP - 0.080
    colours[cuff] = COLOURS["leather"]
    strap = np.abs(points[:, 1] - 0.135 - 0.3 * (points[:, 2] + 0.02)) < 0.016
    colours[strap] = COLOURS["leather_dark"]
    return m.Piece("boot", points, triangles, "leather", colours, weights.leg(points), 50.0)
