"""The hero's hands: a palm, and fingers as tubes that bend at their joints."""

import numpy as np
from giant import field as f
from giant.field import smooth_step

from . import mesh as m
from .palette import COLOURS
from .skeleton import (
    JOINTS,
    LOWER,
    NAMES,
    PALM_SIDE,
    TAILS,
    THUMB_SIDE,
    WRIST,
    finger,
    head,
    in_hand,
)

FINGER_SIDES, THICKNESS = 6, (0.0100, 0.0104, 0.0098, 0.0087)
# Half the width of the soft zone about a finger's joint, in metres.
SOFT = 0.011


def pieces(thinned):
    """Both hands."""
    result = m.both_sides(_palm(thinned))
    for number in range(4):
        result += m.both_sides(_finger(number))
    return result + m.both_sides(_thumb())


def _axes():
    return np.stack([LOWER, THUMB_SIDE, PALM_SIDE], axis=1)


def palm(p):
    """Distance to the left palm and the ball of its thumb."""
    axes = _axes()
    q = (p - WRIST) @ axes
    wrist = f.round_cone(q, (-0.045, 0.0, 0.0), (0.006, 0.0, 0.0), 0.0270, 0.0255)
    wrist = np.maximum(wrist, np.abs(q[:, 2]) - 0.0205)
    result = m.blended(
        f.ellipsoid(q, (0.056, -0.001, 0.001), (0.052, 0.041, 0.0155)),
        (wrist, 0.030),
        (f.ellipsoid(q, (0.040, 0.022, 0.010), (0.034, 0.016, 0.0135)), 0.016),
        (f.round_cone(q, (0.026, -0.024, 0.008), (0.068, -0.026, 0.004), 0.012, 0.011), 0.014),
    )
    for number in range(4):
        knuckle = (finger(number)[0] - WRIST) @ axes
        result = f.smooth_union(result, f.round_cone(q, (0.045, 0.7 * knuckle[1], 0.0), knuckle, 0.0105, 0.0102), 0.010)
    return result


def _hand_weights(points):
    result = np.zeros((len(points), len(JOINTS)))
    share = smooth_step(-0.012, 0.022, (points - WRIST) @ LOWER)
    result[:, NAMES.index("forearm.L")], result[:, NAMES.index("hand.L")] = 1.0 - share, share
    q = (points - WRIST) @ _axes()
    ball = 0.7 * smooth_step(0.038, 0.008, np.linalg.norm(q - (0.048, 0.036, 0.014), axis=1))
    result[:, NAMES.index("thumb.01.L")] = ball
    result[:, NAMES.index("hand.L")] -= np.minimum(ball, result[:, NAMES.index("hand.L")])
    return result / result.sum(axis=1, keepdims=True)


def _palm(thinned):
    low, high = WRIST - 0.075, WRIST + (0.13, 0.06, 0.09)
    points, triangles = m.meshed(palm, low - (0, 0.06, 0), high, 0.0048, 0.095, thinned)
    keep = (((points - WRIST) @ LOWER) > -0.036)[triangles].any(axis=1)
    used, renumbered = np.unique(triangles[keep], return_inverse=True)
    points, triangles = points[used], renumbered.reshape(-1, 3)
    q = (points - WRIST) @ _axes()
    warm = 0.35 * smooth_step(0.0, 0.015, q[:, 2]) + 0.3 * smooth_step(0.075, 0.09, q[:, 0]) * (q[:, 2] < 0.0)
    return m.Piece(
        "palm",
        points,
        triangles,
        "skin",
        m.mixed(COLOURS["skin"], COLOURS["skin_warm"], warm),
        _hand_weights(points),
        180.0,
    )


def _digit(name, path, radii, first, second, stiff_root=True):
    """A tube along a path. It bends in the planes of its joints, also where three fingers share them."""
    rings = m.frames_along(path, PALM_SIDE)
    tube = [m.ring(c, u, v, (0.92 * r, r), FINGER_SIDES) for c, u, v, r in zip(path, *rings, radii)]
    points, triangles = m.loft(tube, cap_end=True)
    step = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    along = np.append(np.repeat(step, FINGER_SIDES), step[-1])
    result = np.zeros((len(points), len(JOINTS)))
    bends = []
    for joint in (first, second):
        way = TAILS[NAMES.index(joint)] - head(joint)
        bends.append(smooth_step(-SOFT, SOFT, (points - head(joint)) @ way / np.linalg.norm(way)))
    bends[0] = bends[0] if stiff_root else np.ones(len(points))
    result[:, NAMES.index("hand.L")] = 1.0 - bends[0]
    result[:, NAMES.index(first)] = bends[0] * (1.0 - bends[1])
    result[:, NAMES.index(second)] = bends[0] * bends[1]
    nail = (along > step[-1] * 0.86) * 0.35
    colours = m.mixed(COLOURS["skin"], COLOURS["skin_warm"], np.maximum(nail, 0.15 * bends[1]))
    return m.Piece(name, points, triangles, "skin", colours, result, 180.0)


def _finger(number):
    knuckle, middle, tip = finger(number)
    back = knuckle - 0.026 * LOWER
    size = THICKNESS[number]
    between = lambda a, b, share: a + share * (b - a)
    end = tip - 0.0035 * (tip - middle) / np.linalg.norm(tip - middle)
    path = np.array(
        [
            back,
            between(back, knuckle, 0.75),
            between(knuckle, middle, 0.3),
            between(knuckle, middle, 0.75),
            between(middle, tip, 0.0),
            between(middle, tip, 0.28),
            between(middle, tip, 0.62),
            between(middle, tip, 0.86),
            end,
        ]
    )
    radii = size * np.array([0.80, 1.02, 1.0, 0.95, 1.02, 0.93, 0.90, 0.74, 0.38])
    joints = ("index.01.L", "index.02.L") if number == 0 else ("fingers.01.L", "fingers.02.L")
    return _digit(f"finger{number}", path, radii, *joints)


def _thumb():
    root, middle = head("thumb.01.L"), head("thumb.02.L")
    tip = in_hand(0.088, 0.062, 0.030)
    between = lambda a, b, share: a + share * (b - a)
    path = np.array(
        [
            between(root, middle, -0.1),
            between(root, middle, 0.35),
            between(root, middle, 0.75),
            middle,
            between(middle, tip, 0.3),
            between(middle, tip, 0.6),
            between(middle, tip, 0.85),
            between(middle, tip, 0.95),
        ]
    )
    radii = 0.0124 * np.array([0.85, 1.02, 0.95, 1.0, 0.95, 0.96, 0.76, 0.40])
    return _digit("thumb", path, radii, "thumb.01.L", "thumb.02.L", stiff_root=False)
