"""The weak points: where they sit, on which joint, how much they take."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Sign:
    """One weak point with its sigil; `place` lies near the skin, `normal` points away from it."""

    name: str
    joint: str
    place: tuple
    normal: np.ndarray
    up: np.ndarray
    size: float
    hit_points: float
    major: bool

    def placed(self, path):
        """A drawing in the plane (right, up), set into space."""
        right = np.cross(self.up, self.normal)
        return np.asarray(self.place) + path[:, :1] * right + path[:, 1:] * self.up


def _sign(name, joint, place, normal, up, size, hit_points, major):
    normal = np.asarray(normal, float)
    normal /= np.linalg.norm(normal)
    up = np.asarray(up, float) - normal * (np.asarray(up, float) @ normal)
    return Sign(name, joint, place, normal, up / np.linalg.norm(up), size, hit_points, major)


SIGNS = (
    _sign("weak_point_head", "head", (0.0, -7.7, 37.8), (0, 0, 1), (0, -1, 0), 1.15, 3.0, True),
    _sign("weak_point_nape", "chest", (0.0, -0.9, 35.0), (0, -0.15, 1), (0, -1, 0), 1.0, 2.0, False),
    _sign("weak_point_forearm.L", "forearm.L", (16.3, 0.2, 18.6), (1, 0, 0.1), (0, 0, 1), 0.9, 2.0, False),
)
# Fur leaves a bare patch of this many sizes around a sigil.
BARE = 1.9
# Hair grows on the stone behind the sigil on the head: within this distance of it, and behind this (metres).
# A climber who goes for that sigil can hold on there.
CREST_RADIUS, CREST_FRONT = 2.3, 0.2


def in_crest(points):
    """Whether points on the top of the head are in its crest of hair."""
    away = points - np.asarray(SIGNS[0].place)
    return (np.linalg.norm(away, axis=1) < CREST_RADIUS) & (away[:, 1] > CREST_FRONT)


def near_sign(points):
    """Whether points are in the bare patch around a sigil."""
    gaps = [np.linalg.norm(points - np.asarray(sign.place), axis=1) / sign.size for sign in SIGNS]
    return np.min(gaps, axis=0) < BARE + 0.5
