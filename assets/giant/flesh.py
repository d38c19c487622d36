"""The body under fur and hide, as a signed distance field, and which of the two is where."""

import numpy as np

from . import field as f
from .signs import BARE, SIGNS
from .skeleton import INDEX, TAILS
from .skeleton import head as joint

# How far fur lifts the skin, and how long its streaks are compared to their width.
FUR_DEPTH = 0.16
STREAK_LENGTH = 4.0


def body(points):
    """Distance to the smooth body, in metres, rest pose; both sides alike."""
    p = points.copy()
    p[:, 0] = np.abs(p[:, 0])
    torso = _torso(p)
    legs = _leg(p)
    arms = _arm(p)
    whole = f.smooth_union(torso, legs, 1.6)
    whole = f.smooth_union(whole, arms, 1.8)
    whole = f.smooth_union(whole, _head(p), 1.2)
    return np.maximum(whole, -points[:, 2])


def furred_body(points):
    """The body with streaks of fur and folds of hide, for the visual mesh."""
    smooth = body(points)
    near = np.abs(smooth) < 1.5
    q = points[near]
    amount = fur_amount(q)
    streaks = f.layered_noise(q * (1.1, 1.1, 1.1 / STREAK_LENGTH), 2, seed=11)
    clumps = f.noise(q * (0.35, 0.35, 0.22), seed=17)
    folds = f.noise(q * (0.5, 0.5, 1.4), seed=23)
    lift = amount * FUR_DEPTH * (streaks + 0.8 * clumps) + (1.0 - amount) * 0.07 * folds
    result = smooth.copy()
    result[near] = np.maximum(smooth[near] - lift, -q[:, 2])
    return result


def fur_amount(points):
    """1 where fur grows, 0 on bare hide (face, belly, palms, soles), smooth between."""
    x, y, z = np.abs(points[:, 0]), points[:, 1], points[:, 2]
    ragged = 0.7 * f.noise(points * (0.8, 0.8, 0.5), seed=5)
    belly = np.hypot(x / 4.6, (z - 21.0) / 5.2) + 0.35 * (y + 4.0).clip(0.0)
    breast = np.hypot((x - 3.4) / 3.2, (z - 28.2) / 2.4) + 0.5 * (y + 4.6).clip(0.0)
    bare = np.minimum(belly, breast) + 0.16 * ragged
    fur = f.smooth_step(0.85, 1.1, bare)
    fur *= 1.0 - f.smooth_step(9.4, 8.2, z + ragged) * f.smooth_step(10.5, 11.2, x)  # hands
    fur *= f.smooth_step(2.0, 3.4, z + ragged)  # feet
    face = np.hypot(x / 3.0, (z - 33.0) / 4.0) + 0.5 * (y + 9.6).clip(0.0)
    fur *= f.smooth_step(0.8, 1.0, face)
    for sign in SIGNS:
        gap = np.linalg.norm(points - np.asarray(sign.place), axis=1) / sign.size
        fur *= f.smooth_step(BARE - 0.5, BARE, gap + 0.2 * ragged)
    return fur


def _torso(p):
    pelvis = f.ellipsoid(p, (0, 1.0, 16.2), (6.4, 4.9, 3.9))
    belly = f.ellipsoid(p, (0, -0.1, 21.0), (6.2, 5.4, 5.2))
    ribs = f.ellipsoid(p, (0, -0.3, 27.2), (8.0, 6.3, 6.4), pitch=0.15)
    hump = f.ellipsoid(p, (0, 2.6, 30.6), (7.6, 5.0, 5.2), pitch=0.25)
    breast = f.ellipsoid(p, (3.7, -4.4, 28.3), (4.2, 2.7, 3.1), pitch=0.2)
    shoulders = f.round_cone(p, (3.0, 0.2, 32.0), (9.0, -0.3, 30.4), 3.7, 3.7)
    shoulder_blade = f.ellipsoid(p, (4.6, 4.6, 29.0), (3.2, 2.6, 4.4))
    seat = f.ellipsoid(p, (3.1, 3.4, 15.4), (3.4, 3.0, 3.6))
    flank = f.ellipsoid(p, (5.4, 1.4, 24.0), (3.0, 3.6, 4.6))
    result = f.smooth_union(pelvis, belly, 2.6)
    for part, width in (
        (ribs, 2.4), (hump, 2.2), (shoulders, 2.0), (breast, 0.9),
        (shoulder_blade, 1.0), (seat, 1.4), (flank, 1.4),
    ):
        result = f.smooth_union(result, part, width)
    return result


def _head(p):
    neck = f.round_cone(p, (0, -1.6, 31.2), (0, -6.4, 33.2), 4.6, 3.2)
    skull = f.ellipsoid(p, (0, -7.8, 34.2), (2.9, 3.3, 3.0))
    muzzle = f.ellipsoid(p, (0, -9.6, 32.3), (2.0, 1.9, 1.8))
    jaw = f.round_cone(p, (0.9, -8.2, 31.6), (0.5, -10.4, 30.8), 1.3, 0.9)
    mane = f.round_cone(p, (0, -4.8, 31.0), (0, -7.0, 28.8), 3.4, 1.7)
    cheek = f.round_cone(p, (2.6, -6.4, 34.2), (2.4, -7.2, 30.6), 1.5, 1.2)
    result = f.smooth_union(neck, skull, 1.6)
    for part, width in ((muzzle, 0.8), (jaw, 0.7), (mane, 1.4), (cheek, 0.9)):
        result = f.smooth_union(result, part, width)
    return result


def _arm(p):
    shoulder, elbow, wrist = joint("upper_arm.L"), joint("forearm.L"), joint("hand.L")
    deltoid = f.ellipsoid(p, shoulder + (0.6, -0.1, -1.2), (3.7, 3.9, 4.8))
    upper = f.round_cone(p, shoulder, elbow, 3.3, 2.5)
    biceps = f.ellipsoid(p, (11.2, -1.3, 25.2), (2.4, 2.2, 3.6))
    triceps = f.ellipsoid(p, (11.6, 2.3, 25.0), (2.3, 2.0, 3.8))
    lower = f.round_cone(p, elbow, wrist, 2.5, 1.75)
    swell = f.ellipsoid(p, elbow * 0.68 + wrist * 0.32, (2.9, 3.1, 4.0), pitch=0.34)
    point = f.ellipsoid(p, elbow + (0.3, 1.2, 0.2), (1.5, 1.4, 1.6))
    result = f.smooth_union(deltoid, upper, 1.4)
    for part, width in (
        (biceps, 1.0), (triceps, 1.0), (lower, 1.2), (swell, 1.2), (point, 0.8), (_hand(p), 1.1),
    ):
        result = f.smooth_union(result, part, width)
    return result


def _hand(p):
    palm = f.box(p, (14.1, -3.2, 8.9), (1.35, 2.5, 2.2), pitch=0.2, rounding=0.8)
    heel = f.round_cone(p, (14.0, -2.2, 10.6), (13.4, -4.2, 9.4), 1.7, 1.2)
    result = f.smooth_union(palm, heel, 1.0)
    for finger, thickness in (("index", 0.95), ("middle", 1.0), ("ring", 0.92), ("thumb", 0.98)):
        base, knuckle = joint(f"{finger}.1.L"), joint(f"{finger}.2.L")
        tip = _tail(f"{finger}.2.L")
        first = f.round_cone(p, base, knuckle, thickness, thickness * 0.92)
        second = f.round_cone(p, knuckle, tip, thickness * 0.92, thickness * 0.78)
        digit = f.smooth_union(first, second, 0.2)
        result = f.smooth_union(result, digit, 0.35)
    return result


def _leg(p):
    hip, knee, ankle = joint("thigh.L"), joint("shin.L"), joint("foot.L")
    thigh = f.round_cone(p, hip, knee, 3.7, 2.4)
    front = f.ellipsoid(p, (5.1, -1.5, 12.4), (2.7, 2.2, 3.6), pitch=-0.3)
    knee_ball = f.ellipsoid(p, knee + (0, -0.4, 0), (2.2, 2.2, 2.1))
    shin = f.round_cone(p, knee, ankle, 2.2, 1.75)
    calf = f.ellipsoid(p, (6.1, 0.7, 6.0), (2.1, 2.0, 2.9), pitch=0.25)
    result = f.smooth_union(thigh, front, 1.2)
    for part, width in ((knee_ball, 0.9), (shin, 0.9), (calf, 0.9), (_foot(p), 0.9)):
        result = f.smooth_union(result, part, width)
    return result


def _foot(p):
    heel = f.ellipsoid(p, (6.2, 1.6, 1.0), (1.8, 1.7, 1.9))
    arch = f.round_cone(p, (6.2, 0.4, 1.9), (6.4, -2.6, 1.2), 1.7, 1.5)
    result = f.smooth_union(heel, arch, 1.0)
    for base, tip, radius in (
        ((4.9, -2.6, 1.0), (4.5, -5.4, 0.75), 1.05),
        ((6.5, -2.8, 1.0), (6.6, -5.9, 0.7), 0.95),
        ((8.0, -2.2, 0.9), (8.6, -4.9, 0.65), 0.9),
    ):
        result = f.smooth_union(result, f.round_cone(p, base, tip, radius, radius * 0.8), 0.5)
    return result


def _tail(name):
    return TAILS[INDEX[name]]
