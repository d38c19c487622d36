"""Which joints move a point of the rest pose, and by how much: one rule for both meshes."""

import numpy as np

from . import field as f
from . import stone
from .skeleton import HEADS, INDEX, JOINTS, RADII, TAILS

# Weights fall with this power of the distance to a bone over the flesh's radius around it: the
# smaller, the wider a joint bends.
FALL_OFF = 5.0
# Shares below this one, of the strongest, are cut off: a limb does not pull at its neighbour.
LEAST_SHARE = 0.03
# A plate holds its own surface rigidly; flesh follows it less and less over this distance.
PLATE_HOLD = 0.30
PLATE_REACH = 1.3
MOST_INFLUENCES = 4
# The heel belongs to the foot, though it lies under the shin: an end of a second line of the foot
# (metres, left side), and the share of the shin that pulls at the skin.
HEEL = np.array([6.2, 2.2, 0.8])
SHIN_SHARE = 0.80
# Soles are rigid: below the first height (metres) no shin and no thigh pulls at the skin, above the
# second one they do as they may.
SOLE_TOP, ANKLE = 0.8, 2.4
# Bones that carry nothing by themselves.
_WITHOUT_FLESH = {"root", "loin.front", "loin.back", "jaw"}


def weights(points):
    """Weights (points, joints): not negative, sums 1, at most four of a point above 0."""
    result = _flesh_weights(points)
    distance = stone.distances(points)
    nearest = distance.argmin(axis=0)
    hold = 1.0 - f.smooth_step(PLATE_HOLD, PLATE_REACH, distance.min(axis=0))
    for number, plate in enumerate(stone.PLATES):
        for side in (1, -1):
            there = (nearest == number) & (np.where(points[:, 0] >= 0.0, 1, -1) == side)
            rigid = np.zeros(len(JOINTS))
            for name, weight in plate.weights(side).items():
                rigid[INDEX[name]] = weight
            share = hold[there, None]
            result[there] = (1.0 - share) * result[there] + share * rigid
    return _strongest(result)


def rigid(weights, there, joint):
    """The same weights, but where `there` is true, on one joint alone."""
    result = weights.copy()
    result[there] = 0.0
    result[there, INDEX[joint]] = 1.0
    return result


def _flesh_weights(points):
    """Weights by distance to the bones, without plates."""
    closeness = np.zeros((len(points), len(JOINTS)))
    for number, joint in enumerate(JOINTS):
        if joint.name not in _WITHOUT_FLESH:
            gap = f.round_cone(points, HEADS[number], _end(number), 0.0, 0.0)
            if joint.name.startswith("foot"):
                heel = HEEL * (np.sign(HEADS[number, 0]), 1.0, 1.0)
                gap = np.minimum(gap, f.round_cone(points, heel, TAILS[number], 0.0, 0.0))
            closeness[:, number] = (RADII[number] / np.maximum(gap, 0.2)) ** FALL_OFF
            if joint.name.startswith(("shin", "thigh")):
                closeness[:, number] *= f.smooth_step(SOLE_TOP, ANKLE, points[:, 2])
    _separate_sides(points, closeness)
    closeness /= closeness.max(axis=1, keepdims=True)
    closeness = np.maximum(closeness - LEAST_SHARE, 0.0)
    return closeness / closeness.sum(axis=1, keepdims=True)


def _end(number):
    """Where a bone ends as far as flesh is concerned: a shin stops above the heel."""
    if JOINTS[number].name.startswith("shin"):
        return HEADS[number] + SHIN_SHARE * (TAILS[number] - HEADS[number])
    return TAILS[number]


def _separate_sides(points, closeness):
    """Fades out the limbs of the other side of the body."""
    left = f.smooth_step(-2.0, 2.0, points[:, 0])
    for number, joint in enumerate(JOINTS):
        if joint.name.endswith(".L"):
            closeness[:, number] *= left
        elif joint.name.endswith(".R"):
            closeness[:, number] *= 1.0 - left


def _strongest(weights):
    """The four largest of each row, less the fifth so that none appears or goes suddenly."""
    order = np.sort(weights, axis=1)
    fifth = order[:, -MOST_INFLUENCES - 1, None]
    cut = np.maximum(weights - fifth, 0.0)
    return cut / cut.sum(axis=1, keepdims=True)
