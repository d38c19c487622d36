"""The mantle, its cowl, and the clasp that holds it."""

import numpy as np
from giant import field as f

from . import mesh as m
from . import weights
from .palette import COLOURS
from .skeleton import ELBOW, SHOULDER
from .tunic import trunk


def pieces():
    """Mantle, cowl and clasp."""
    return [_mantle(), _cowl(), _clasp()]


def mantle_field(p):
    """Distance to the mantle's outer face, which lies over trunk and arms."""
    p = p * 1.0
    p[:, 0] = np.abs(p[:, 0])
    around = np.arctan2(p[:, 0], p[:, 2] + 0.03)
    folds = 0.006 * np.sin(9.0 * around + 2.0 * np.sin(2 * around)) * f.smooth_step(1.47, 1.33, p[:, 1])
    hood = f.ellipsoid(p, (0.0, 1.425, -0.128), (0.090, 0.075, 0.046), pitch=0.25)
    return m.blended(trunk(p), (_plain_arm(p), 0.06), (hood, 0.04)) - 0.015 - folds


def _plain_arm(p):
    return m.blended(
        f.ellipsoid(p, SHOULDER + (0.020, -0.018, 0.0), (0.059, 0.064, 0.061)),
        (f.round_cone(p, SHOULDER, ELBOW, 0.054, 0.050), 0.05),
    )


def _mantle():
    """Rings about the neck, from under the cowl to a trimmed edge that is turned in."""
    around, middle = 36, np.array([0.0, 1.435, -0.032])
    angle = 2 * np.pi * np.arange(around) / around
    out = np.stack([np.cos(angle), 0 * angle, np.sin(angle)], axis=1)
    # How far the edge hangs below the horizontal, seen from the neck: less over the shoulders.
    edge = np.radians(
        np.interp(
            np.abs(np.degrees(np.arctan2(out[:, 0], out[:, 2]))),
            (0, 25, 65, 90, 120, 150, 180),
            (50, 44, 23, 11, 21, 42, 50),
        )
    )
    edge += 0.035 * np.cos(9.0 * angle)
    shares = (-0.10, 0.15, 0.34, 0.52, 0.68, 0.80, 0.805, 0.90, 0.995)
    start = np.radians(-38.0)
    rings = []
    for share, lift in [*((share, 0.003 * (share > 0.802)) for share in shares), (1.0, -0.002), (0.985, -0.013)]:
        slope = (start + share * (edge - start))[:, None]
        ways = np.cos(slope) * out - np.sin(slope) * np.array([0.0, 1.0, 0.0])
        far = np.full(around, 0.34)
        for _ in range(m.RAY_STEPS):
            far -= 0.7 * (mantle_field(middle + far[:, None] * ways) - lift)
        rings.append(middle + far[:, None] * ways)
    points, triangles = m.loft(rings)
    row = np.arange(len(points)) // around
    colours = m.mixed(COLOURS["mantle"], COLOURS["mantle_light"], f.smooth_step(1.36, 1.48, points[:, 1]))
    colours[row >= 6] = COLOURS["mantle_trim"]
    return m.Piece("mantle", points, triangles, "cloth", colours, weights.mantle(points), 55.0)


def _cowl():
    """Two rolls of cloth about the neck, lower in front."""
    around, sides = 24, 8
    angle = 2 * np.pi * np.arange(around) / around
    rings = []
    for turn in 2 * np.pi * np.arange(sides + 1) / sides:
        # The section of a soft collar: thick below, with a fold in its outer side.
        thick = (
            0.031
            * (1.0 - 0.22 * np.cos(2 * turn + 0.5))
            * (1.0 + 0.10 * np.sin(3.0 * angle + 1.0))
            * np.interp(np.sin(angle), (-1, 1), (1.15, 0.95))
        )
        far, high = thick * np.cos(turn), thick * 1.35 * np.sin(turn)
        x, z = (0.083 + far) * np.cos(angle), (0.080 + far) * np.sin(angle)
        y = high + 0.005 * np.sin(2.0 * angle + 0.6) + 0.004 * np.sin(5.0 * angle + 2.0 * turn)
        tilt = 0.30
        rings.append(
            np.stack(
                [x, 1.472 + y * np.cos(tilt) - z * np.sin(tilt), -0.022 + z * np.cos(tilt) + y * np.sin(tilt)], axis=1
            )
        )
    points, triangles = m.loft(rings)
    colours = m.mixed(COLOURS["mantle"], COLOURS["mantle_light"], f.smooth_step(1.44, 1.51, points[:, 1]))
    return m.Piece("cowl", points, triangles, "cloth", colours, weights.mantle(points), 180.0)


def _clasp():
    """A brass disc that holds the mantle."""
    centre = np.array([0.062, 1.395, 0.0])
    for _ in range(30):
        centre[2] = centre[2] if centre[2] else 0.2
        centre[2] -= 0.7 * mantle_field(centre[None])[0]
    out = f.gradient(mantle_field, centre[None], 0.01)[0]
    u = np.cross((0, 1, 0), out)
    u /= np.linalg.norm(u)
    v = np.cross(out, u)
    rings = [
        m.ring(centre + h * out, u, v, (r, r), 10)
        for h, r in ((-0.006, 0.023), (0.005, 0.023), (0.009, 0.017), (0.007, 0.012))
    ]
    points, triangles = m.loft(rings, cap_end=True)
    # It follows the cloth under its middle.
    same = np.repeat(weights.mantle(centre[None]), len(points), axis=0)
    return m.Piece("clasp", points, triangles, "metal", m.plain(points, COLOURS["brass"]), same, 30.0)
