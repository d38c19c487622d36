"""The joints of the colossus: names, parents, places in the rest pose.

Everything here is in Blender's frame, in metres: Z up, the creature faces -Y, its left is +X.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Joint:
    """One bone in its rest pose; `radius` is the mean thickness of the flesh around it."""

    name: str
    parent: str | None
    head: tuple
    tail: tuple
    radius: float


# name, parent, head, tail, radius of the flesh
_MIDDLE = [
    ("root", None, (0, 0, 0), (0, 0, 3), 1.0),
    ("pelvis", "root", (0, 1.0, 16.0), (0, 1.2, 18.6), 5.2),
    ("spine.1", "pelvis", (0, 1.2, 18.6), (0, 1.0, 21.2), 5.2),
    ("spine.2", "spine.1", (0, 1.0, 21.2), (0, 0.4, 24.0), 5.6),
    ("spine.3", "spine.2", (0, 0.4, 24.0), (0, -0.2, 27.0), 6.4),
    ("chest", "spine.3", (0, -0.2, 27.0), (0, -1.2, 32.0), 6.8),
    ("neck.1", "chest", (0, -2.6, 31.6), (0, -5.0, 32.8), 4.2),
    ("neck.2", "neck.1", (0, -5.0, 32.8), (0, -7.2, 33.6), 3.6),
    ("head", "neck.2", (0, -7.2, 33.6), (0, -10.6, 34.4), 3.0),
    ("jaw", "head", (0, -8.2, 31.9), (0, -11.4, 30.2), 1.4),
    ("loin.front", "pelvis", (0, -5.4, 17.0), (0, -5.9, 11.6), 1.0),
    ("loin.back", "pelvis", (0, 7.0, 17.0), (0, 7.3, 12.4), 1.0),
]

# The left side; the right one is its mirror image.
_LEFT = [
    ("clavicle", "chest", (2.4, -1.2, 31.2), (9.4, -0.6, 30.2), 4.4),
    ("upper_arm", "clavicle", (9.4, -0.6, 30.2), (13.2, 1.4, 20.6), 3.3),
    ("forearm", "upper_arm", (13.2, 1.4, 20.6), (14.0, -2.2, 11.0), 2.7),
    ("hand", "forearm", (14.0, -2.2, 11.0), (14.1, -3.5, 7.2), 1.7),
    ("index.1", "hand", (14.1, -5.4, 7.3), (13.9, -6.2, 5.3), 0.9),
    ("index.2", "index.1", (13.9, -6.2, 5.3), (13.0, -6.4, 3.5), 0.8),
    ("middle.1", "hand", (14.3, -3.6, 6.9), (14.2, -4.0, 4.7), 0.9),
    ("middle.2", "middle.1", (14.2, -4.0, 4.7), (13.2, -4.1, 2.8), 0.8),
    ("ring.1", "hand", (14.1, -1.7, 7.1), (14.0, -1.7, 5.1), 0.9),
    ("ring.2", "ring.1", (14.0, -1.7, 5.1), (13.1, -1.7, 3.4), 0.8),
    ("thumb.1", "hand", (13.2, -4.4, 9.6), (12.0, -5.9, 8.1), 0.9),
    ("thumb.2", "thumb.1", (12.0, -5.9, 8.1), (11.6, -6.7, 6.3), 0.8),
    ("thigh", "pelvis", (4.3, 0.8, 15.4), (5.8, -1.4, 8.8), 3.5),
    ("shin", "thigh", (5.8, -1.4, 8.8), (6.2, 0.8, 2.6), 2.3),
    ("foot", "shin", (6.2, 0.8, 2.6), (6.4, -2.8, 1.0), 1.6),
    ("toe", "foot", (6.4, -2.8, 1.0), (6.6, -5.2, 0.8), 1.2),
]


def _mirrored(point):
    return (-point[0], point[1], point[2])


def joints():
    """All joints, parents before children."""
    sided = {row[0] for row in _LEFT}
    result = [Joint(*row) for row in _MIDDLE]
    for suffix, place in ((".L", tuple), (".R", _mirrored)):
        for name, parent, head, tail, radius in _LEFT:
            parent = parent + suffix if parent in sided else parent
            result.append(Joint(name + suffix, parent, place(head), place(tail), radius))
    return result


JOINTS = joints()
INDEX = {joint.name: number for number, joint in enumerate(JOINTS)}
PARENT = [INDEX[joint.parent] if joint.parent else -1 for joint in JOINTS]
HEADS = np.array([joint.head for joint in JOINTS], dtype=float)
TAILS = np.array([joint.tail for joint in JOINTS], dtype=float)
RADII = np.array([joint.radius for joint in JOINTS], dtype=float)


def head(name):
    """Where a joint is in the rest pose."""
    return HEADS[INDEX[name]].copy()
