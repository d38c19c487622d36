"""Which joints move a point of the rest pose, and by how much.

Each rule follows a chain of bones: a point belongs to the next bone where it passes the joint's plane,
softly over some centimetres. Pieces that lie on each other use the same rules, so they stay together.
"""

import numpy as np
from giant.field import round_cone, smooth_step

from .skeleton import (
    ALONG,
    ANKLE,
    ELBOW,
    HIP,
    JOINTS,
    LOWER,
    NAMES,
    SHOULDER,
    WRIST,
    head,
)

# Half the width of the soft zone about each joint, in metres.
WAIST, BREAST, NAPE, ELBOW_ZONE, KNEE_ZONE, ANKLE_ZONE, TOE_ZONE = 0.06, 0.08, 0.035, 0.055, 0.065, 0.035, 0.022
# Flesh and cloth farther than this from the arm's bone do not follow it, in metres: inner and outer limit.
ARM_REACH = (0.088, 0.140)
MOST_INFLUENCES = 4
# A height at which all of the trunk is chest, in metres.
CHEST_HEIGHT = 1.45
SIDES = ((".L", 1.0), (".R", -1.0))


def _empty(points):
    return np.zeros((len(points), len(JOINTS)))


def _passed(points, place, along, before, after):
    """0 where a point is `before` metres ahead of a plane, 1 where it is `after` metres past it."""
    along = np.asarray(along, float)
    return smooth_step(-before, after, (points - place) @ (along / np.linalg.norm(along)))


def _split(result, source, target, share):
    """Moves a share of one joint's weight to another."""
    source, target = NAMES.index(source), NAMES.index(target)
    result[:, target] += result[:, source] * share
    result[:, source] *= 1.0 - share


def body(points, legs=0.0):
    """Trunk, shoulders, arms; with `legs`, the share of the thighs in what hangs below the hips."""
    result = _empty(points)
    x, y = points[:, 0], points[:, 1]
    arms = {side: _arm_share(points * (sign, 1.0, 1.0)) for side, sign in SIDES}
    # Arms hang on the chest, however low they are in the rest pose.
    height = y + (CHEST_HEIGHT - y) * np.maximum(arms[".L"], arms[".R"])
    result[:, NAMES.index("hips")] = 1.0
    _split(result, "hips", "spine", smooth_step(1.035 - WAIST, 1.035 + WAIST, height))
    _split(result, "spine", "chest", smooth_step(1.20 - BREAST, 1.20 + BREAST, height))
    for side, sign in SIDES:
        p = points * (sign, 1.0, 1.0)
        collar = smooth_step(0.02, 0.13, p[:, 0]) * smooth_step(1.24, 1.42, y) * 0.85
        _split(result, "chest", "shoulder" + side, np.maximum(collar, arms[side]))
        _split(result, "shoulder" + side, "upper_arm" + side, arms[side])
        lower = _passed(p, ELBOW, ALONG + LOWER, ELBOW_ZONE, ELBOW_ZONE) * (p[:, 0] > 0.2)
        _split(result, "upper_arm" + side, "forearm" + side, lower)
    if legs:
        hang = legs * smooth_step(HIP[1] + 0.08, HIP[1] - 0.16, y)
        left = hang * smooth_step(-0.07, 0.07, x)
        _split(result, "hips", "thigh.L", left)
        _split(result, "hips", "thigh.R", (hang - left) / np.maximum(1.0 - left, 1e-9))
    return _strongest(result)


def _arm_share(points):
    """How much points follow the left arm: near its bones, and past the shoulder."""
    near = 1.0 - smooth_step(*ARM_REACH, round_cone(points, SHOULDER, WRIST, 0.0, 0.0))
    return near * _passed(points, SHOULDER, ALONG + (0.35, 0.0, 0.0), 0.075, 0.070)


def arm(points):
    """The left sleeve and bracer: from the shoulder to the wrist."""
    result = body(points)
    _split(result, "forearm.L", "hand.L", _passed(points, WRIST, LOWER, 0.012, 0.022))
    return _strongest(result)


def leg(points):
    """The left leg of the trousers and the boot."""
    result = _empty(points)
    y = points[:, 1]
    result[:, NAMES.index("hips")] = 1.0
    _split(result, "hips", "thigh.L", smooth_step(HIP[1] + 0.08, HIP[1] - 0.16, y))
    knee = head("shin.L")
    _split(result, "thigh.L", "shin.L", smooth_step(knee[1] + KNEE_ZONE, knee[1] - KNEE_ZONE, y))
    _split(result, "shin.L", "foot.L", smooth_step(ANKLE[1] + ANKLE_ZONE + 0.012, ANKLE[1] - ANKLE_ZONE + 0.012, y))
    _split(result, "foot.L", "toe.L", smooth_step(-TOE_ZONE, TOE_ZONE, points[:, 2] - head("toe.L")[2]))
    return _strongest(result)


def neck(points):
    """The skin of neck and head."""
    result = _empty(points)
    y, z = points[:, 1], points[:, 2]
    result[:, NAMES.index("chest")] = 1.0
    _split(result, "chest", "neck", smooth_step(1.45 - NAPE, 1.45 + NAPE, y))
    # The chin belongs to the head, though it is as low as the nape.
    _split(result, "neck", "head", smooth_step(1.505, 1.575, y + 0.7 * np.maximum(z - 0.02, 0.0)))
    return _strongest(result)


def mantle(points):
    """The mantle and its cowl, which lies around the neck."""
    result = body(points)
    y, x = points[:, 1], points[:, 0]
    round_neck = smooth_step(1.45, 1.53, y) * smooth_step(0.16, 0.08, np.abs(x))
    for source in ("chest", "shoulder.L", "shoulder.R"):
        _split(result, source, "neck", 0.6 * round_neck)
    return _strongest(result)


def _strongest(weights):
    """The four largest of each row, less the fifth so that none appears or goes suddenly."""
    order = np.sort(weights, axis=1)
    cut = np.maximum(weights - order[:, -MOST_INFLUENCES - 1, None], 0.0)
    return cut / cut.sum(axis=1, keepdims=True)
