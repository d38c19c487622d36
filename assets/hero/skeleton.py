"""The joints of the hero: names, parents, places and axes in the rest pose.

Everything in this folder is in glTF's frame, in metres: Y up, the hero faces +Z, his left is +X.
A joint's +Y points along its bone. Its +X is the axis about which it bends: a positive turn about +X
bends an elbow, a knee and a finger, and leans the back forward, on both sides alike.
"""

from dataclasses import dataclass

import numpy as np

# The rest pose is an A-pose: arms this far below the horizontal, in degrees.
ARM_SLOPE = 40.0
# Elbows and knees are bent a little, so that their bending direction is defined; in degrees.
ELBOW_BEND = 4.0
UPPER_ARM, FOREARM, PALM = 0.285, 0.252, 0.092
# The sword leans from the fist towards the fingers by this much, in degrees.
SWORD_LEAN = 24.0
# From the bow's grip to its string at rest.
BOW_BRACE = 0.17
MIRROR = np.array([-1.0, 1.0, 1.0])
FORWARD, UP, LEFT = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])


@dataclass(frozen=True)
class Joint:
    """A bone in its rest pose: where it begins and ends, and the axis about which it bends."""

    name: str
    parent: str | None
    head: tuple
    tail: tuple
    hinge: tuple


def _arm():
    """Directions of the left arm: along the upper arm, along the forearm, to the palm's side."""
    slope, bend = np.radians([ARM_SLOPE, ELBOW_BEND])
    along = np.array([np.cos(slope), -np.sin(slope), 0.0])
    palm = np.array([-np.sin(slope), -np.cos(slope), 0.0])
    return along, np.cos(bend) * along + np.sin(bend) * FORWARD, palm


ALONG, LOWER, PALM_SIDE = _arm()
# From the index finger's side of the hand to the little finger's is backward: the thumb is in front.
THUMB_SIDE = np.cross(PALM_SIDE, LOWER)
SHOULDER = np.array([0.162, 1.412, -0.022])
ELBOW = SHOULDER + UPPER_ARM * ALONG
WRIST = ELBOW + FOREARM * LOWER
HIP, KNEE_HEIGHT, ANKLE = np.array([0.088, 0.918, -0.004]), 0.492, np.array([0.100, 0.088, -0.026])


def _knee():
    """A point in the plane of hip, ankle and the forward direction."""
    share = (HIP[1] - KNEE_HEIGHT) / (HIP[1] - ANKLE[1])
    return HIP + share * (ANKLE - HIP) + 0.016 * FORWARD


def in_hand(along, side, depth):
    """A point of the left hand: along the fingers, to the thumb's side, towards the palm; metres from the wrist."""
    return WRIST + along * LOWER + side * THUMB_SIDE + depth * PALM_SIDE


def finger(number):
    """Knuckle, middle joint and tip of a finger of the left hand, 0 (index) to 3 (little)."""
    spread = np.radians((5.0, 0.5, -4.5, -10.0)[number])
    knuckle = in_hand((0.088, 0.091, 0.087, 0.080)[number], (0.030, 0.0095, -0.0110, -0.030)[number], 0.0)
    length = (0.078, 0.086, 0.080, 0.064)[number]
    along = np.cos(spread) * LOWER + np.sin(spread) * THUMB_SIDE
    bent = np.radians(14.0)
    middle = knuckle + 0.5 * length * (np.cos(bent / 2) * along + np.sin(bent / 2) * PALM_SIDE)
    bent *= 2.2
    return knuckle, middle, middle + 0.5 * length * (np.cos(bent) * along + np.sin(bent) * PALM_SIDE)


def _rows():
    """Name, parent, head, tail and bending axis of the middle and of the left side."""
    x, knee = tuple(LEFT), _knee()
    curl = -THUMB_SIDE
    thumb = (in_hand(0.022, 0.026, 0.010), in_hand(0.056, 0.052, 0.022), in_hand(0.088, 0.062, 0.030))
    thumb_axis = np.cross(thumb[1] - thumb[0], 0.9 * PALM_SIDE - 0.4 * THUMB_SIDE)
    index, ring = finger(0), finger(2)
    middle_rows = [
        ("root", None, (0, 0, 0), (0, 0.2, 0), x),
        ("hips", "root", (0, 0.945, -0.004), (0, 1.035, -0.006), x),
        ("spine", "hips", (0, 1.035, -0.006), (0, 1.19, -0.014), x),
        ("chest", "spine", (0, 1.19, -0.014), (0, 1.45, -0.026), x),
        ("neck", "chest", (0, 1.45, -0.030), (0, 1.535, -0.012), x),
        ("head", "neck", (0, 1.535, -0.012), (0, 1.74, -0.012), x),
    ]
    left = [
        ("shoulder", "chest", (0.022, 1.412, -0.004), SHOULDER, -UP),
        ("upper_arm", "shoulder", SHOULDER, ELBOW, PALM_SIDE),
        ("forearm", "upper_arm", ELBOW, WRIST, PALM_SIDE),
        ("hand", "forearm", WRIST, WRIST + PALM * LOWER, curl),
        ("thumb.01", "hand", thumb[0], thumb[1], thumb_axis),
        ("thumb.02", "thumb.01", thumb[1], thumb[2], thumb_axis),
        ("index.01", "hand", index[0], index[1], curl),
        ("index.02", "index.01", index[1], index[2], curl),
        ("fingers.01", "hand", ring[0], ring[1], curl),
        ("fingers.02", "fingers.01", ring[1], ring[2], curl),
        ("thigh", "hips", HIP, knee, x),
        ("shin", "thigh", knee, ANKLE, x),
        ("foot", "shin", ANKLE, (0.112, 0.022, 0.108), x),
        ("toe", "foot", (0.112, 0.022, 0.108), (0.118, 0.020, 0.172), x),
    ]
    return middle_rows, left


# Where a fist holds a hilt or a bow: in the bend of the fingers, under the palm.
GRIP = in_hand(0.074, 0.0, 0.027)


def _gear():
    """Equipment: name, parent, head, the direction of +Y, and of +X."""
    lean = np.radians(SWORD_LEAN)
    blade = np.cos(lean) * THUMB_SIDE + np.sin(lean) * LOWER
    right_grip, right_blade = GRIP * MIRROR, blade * MIRROR
    scabbard, down = np.array([0.188, 0.985, 0.050]), np.array([0.27, -0.76, -0.59])
    down = down / np.linalg.norm(down)
    rows = [
        ("sword", "hand.R", right_grip, right_blade, LOWER * MIRROR),
        ("scabbard", "hips", scabbard, down, np.cross(down, LEFT)),
        # The sword lies in the scabbard: its blade begins at the mouth.
        ("sword_sheathed", "scabbard", scabbard - 0.095 * down, down, np.cross(down, LEFT)),
        ("bow", "hand.L", GRIP, THUMB_SIDE, np.cross(THUMB_SIDE, LOWER)),
        ("bow_string", "bow", GRIP - BOW_BRACE * LOWER, THUMB_SIDE, np.cross(THUMB_SIDE, LOWER)),
        ("bow_back", "chest", (0.045, 1.20, -0.212), (0.52, 0.85, 0.0), -FORWARD),
        ("quiver", "chest", (-0.035, 1.05, -0.160), (-0.40, 0.90, -0.10), -FORWARD),
        ("arrow", "hand.R", in_hand(0.088, 0.018, 0.022) * MIRROR, LOWER * MIRROR, PALM_SIDE * MIRROR),
    ]
    return [
        (name, parent, np.asarray(head, float), np.asarray(y, float), np.asarray(x, float))
        for name, parent, head, y, x in rows
    ]


def joints():
    """All joints, parents before children."""
    middle, left = _rows()
    sided = {row[0] for row in left}
    result = [Joint(name, parent, *(tuple(map(float, v)) for v in rest)) for name, parent, *rest in middle]
    for suffix, sign in ((".L", 1.0), (".R", -1.0)):
        flip = np.array([sign, 1.0, 1.0])
        for name, parent, head, tail, hinge in left:
            parent = parent + suffix if parent in sided else parent
            places = [tuple(flip * np.asarray(place, float)) for place in (head, tail)]
            # A turn about an axis is mirrored by mirroring the axis and turning the other way.
            result.append(Joint(name + suffix, parent, *places, tuple(sign * flip * np.asarray(hinge, float))))
    for name, parent, head, along, hinge in _gear():
        tail = head + 0.2 * along / np.linalg.norm(along)
        result.append(Joint(name, parent, tuple(head), tuple(tail), tuple(hinge)))
    return result


def _frame(joint):
    """The joint's axes in the rest pose, as columns."""
    y = np.subtract(joint.tail, joint.head)
    y /= np.linalg.norm(y)
    x = np.asarray(joint.hinge, float)
    x = x - y * (x @ y)
    x /= np.linalg.norm(x)
    return np.stack([x, y, np.cross(x, y)], axis=1)


JOINTS = joints()
NAMES = [joint.name for joint in JOINTS]
INDEX = {name: number for number, name in enumerate(NAMES)}
PARENT = [INDEX[joint.parent] if joint.parent else -1 for joint in JOINTS]
HEADS = np.array([joint.head for joint in JOINTS], dtype=float)
TAILS = np.array([joint.tail for joint in JOINTS], dtype=float)
FRAMES = np.stack([_frame(joint) for joint in JOINTS])
GEAR = ("sword", "scabbard", "sword_sheathed", "bow", "bow_string", "bow_back", "quiver", "arrow")


def head(name):
    """Where a joint is in the rest pose."""
    return HEADS[INDEX[name]].copy()
