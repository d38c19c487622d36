"""From a handful of controls to the rotations of all joints.

Rotations here are in the model's axes: a joint's local rotation q turns it against its parent, and
`model rotation = parent's model rotation @ q`. Angles are radians (degrees in the clips' tables):
pitch about +X leans forward, yaw about +Z turns to the creature's left, roll about +Y leans to its
left.
"""

import numpy as np

from .limbs import leg, reach
from .skeleton import HEADS, INDEX, JOINTS, PARENT
from .turns import matrices, quaternions, turned, turned_back

SPINE = ("spine.1", "spine.2", "spine.3", "chest")
# The joints from the ground to the head.
TRUNK = ("root", "pelvis", *SPINE, "neck.1", "neck.2", "head")
FINGERS = ("index", "middle", "ring", "thumb")
# Delays, in seconds, with which the parts of the body follow the pelvis: what makes it heavy.
SPINE_LAG, NECK_LAG, HEAD_LAG, JAW_LAG = 0.05, 0.10, 0.16, 0.22
ELBOW_LAG, WRIST_LAG, FINGER_LAG = 0.08, 0.16, 0.22
LOIN_LAG = 0.25


class Poses:
    """Rotations (frames, joints, 3, 3) against the parents, and how far the pelvis is moved (frames, 3)."""

    def __init__(self, frames):
        self.local = np.tile(np.eye(3), (frames, len(JOINTS), 1, 1))
        self.shift = np.zeros((frames, 3))

    def __len__(self):
        return len(self.shift)

    def part(self, frames):
        """Some of the frames."""
        result = Poses(0)
        result.local, result.shift = self.local[frames], self.shift[frames]
        return result

    def placed(self, joints=None):
        """Model rotations and heads of all joints in all frames; or of some joints that follow their parents."""
        turn, place = np.empty_like(self.local), np.zeros((len(self), len(JOINTS), 3))
        for joint in range(len(JOINTS)) if joints is None else joints:
            parent = PARENT[joint]
            if parent < 0:
                turn[:, joint], place[:, joint] = self.local[:, joint], HEADS[joint]
                continue
            turn[:, joint] = turn[:, parent] @ self.local[:, joint]
            place[:, joint] = place[:, parent] + turn[:, parent] @ (HEADS[joint] - HEADS[parent])
            if JOINTS[joint].name == "pelvis":
                place[:, joint] += self.shift
        return turn, place


def posed(c):
    """The poses that the channels `c` (see `tracks.py`) give at their times."""
    pose = trunk(c)
    turn = _turner(pose)
    lean, loin, aside = c("pelvis.pitch"), c("loin", LOIN_LAG), c("loin.side", LOIN_LAG)
    turn("jaw", c("jaw", JAW_LAG))
    turn("loin.front", np.minimum(-lean, 0.0) + loin + c("loin.front", LOIN_LAG), 0, aside)
    turn("loin.back", np.maximum(-lean, 0.0) + loin + c("loin.back", LOIN_LAG), 0, aside)
    for side, sign in ((".L", 1), (".R", -1)):
        _arm(c, turn, side, sign)
        if f"hand.hold{side}" in c:
            reach(c, pose, side, sign)
        leg(c, pose, side, sign)
    return pose


def trunk(c):
    """The same, but of the joints in `TRUNK` alone."""
    pose = Poses(len(c.times))
    turn = _turner(pose)

    def angles(name, lag=0.0):
        return np.array([c(f"{name}.{kind}", lag) for kind in ("pitch", "yaw", "roll")])

    pose.shift = np.stack([c(f"pelvis.{axis}") for axis in "xyz"], axis=1)
    turn("pelvis", *angles("pelvis"))
    for number, joint in enumerate(SPINE):
        bent = angles("spine", SPINE_LAG * number) / len(SPINE)
        if joint == "spine.3":
            bent[0] += c("swell")
        if joint == "chest":
            bent += angles("chest")
            bent[0] -= 0.6 * c("breath")
        turn(joint, *bent)
    neck = angles("neck", NECK_LAG)
    turn("neck.1", *(0.5 * neck))
    turn("neck.2", *(0.5 * neck))
    turn("head", *angles("head", HEAD_LAG))
    return pose


def _turner(pose):
    def turn(joint, pitch=0.0, yaw=0.0, roll=0.0):
        pose.local[:, INDEX[joint]] = turned(pitch, yaw, roll)

    return turn


def _arm(c, turn, side, sign):
    """Swing is forward, out is away from the body, across is towards the other side."""
    at = lambda name, lag=0.0: c(name + side, lag)
    turn("clavicle" + side, 0.0, -sign * at("shoulder.forward"), -sign * (at("shoulder.lift") + c("breath")))
    turn("upper_arm" + side, -at("arm.swing"), -sign * at("arm.across"), -sign * at("arm.out"))
    turn("forearm" + side, -at("elbow", ELBOW_LAG), -sign * at("forearm.in", ELBOW_LAG), 0.0)
    turn("hand" + side, -at("wrist", WRIST_LAG), 0.0, sign * at("wrist.in", WRIST_LAG))
    curl = at("curl", FINGER_LAG)
    for number, finger in enumerate(FINGERS):
        amount = curl * (1.0 + 0.08 * number)
        lean = -0.45 * amount if finger == "thumb" else 0.0
        turn(f"{finger}.1{side}", lean, 0.0, sign * amount)
        turn(f"{finger}.2{side}", lean, 0.0, sign * 0.9 * amount)


def halfway(pose):
    """The poses between frames, as a player of the file makes them."""
    result = Poses(len(pose) - 1)
    result.shift = (pose.shift[1:] + pose.shift[:-1]) / 2
    for joint in range(len(JOINTS)):
        turns = quaternions(pose.local[:, joint])
        flip = np.sign((turns[1:] * turns[:-1]).sum(axis=1, keepdims=True))
        mixed = turns[1:] + flip * turns[:-1]
        result.local[:, joint] = matrices(mixed / np.linalg.norm(mixed, axis=1, keepdims=True))
    return result


def skinned(points, weights, pose):
    """Points of the rest pose, moved by linear blend skinning: (frames, points, 3)."""
    turn, place = pose.placed()
    result = np.zeros((len(pose), len(points), 3))
    for joint in np.flatnonzero(weights.any(axis=0)):
        used = weights[:, joint] > 0.0
        moved = (points[used] - HEADS[joint]) @ turned_back(turn[:, joint]) + place[:, joint, None]
        result[:, used] += weights[used, joint, None] * moved
    return result
