"""The shell over the nape: a plate apart from the skin below it, which can be broken off."""

import numpy as np

from . import field as f
from . import flesh, nets, stone
from .signs import SIGNS

# The joint that carries it, rigidly, and the number by which a brain's file names it.
JOINT, USER = "chest", 1
# It covers this sign, so far around it, at such a height above the skin, and is so thick (metres).
SIGN = next(sign for sign in SIGNS if sign.name == "weak_point_nape")
RADIUS, HEIGHT, THICKNESS = 2.3, 0.55, 0.6
# Grid cells, in metres: for the collision mesh and for the visual one.
COLLISION_CELL, VISUAL_CELL = 0.42, 0.18
# Width and depth of the carved rings.
GROOVE, GROOVE_DEPTH = 0.16, 0.12


def collision():
    """Its collision mesh: closed."""
    return _meshed(_plain, COLLISION_CELL)


def visual():
    """Its visual mesh, with rings around the sign."""
    return _meshed(_carved, VISUAL_CELL)


def _meshed(solid, cell):
    low, high = (np.asarray(SIGN.place) + side * (RADIUS + 2.0) for side in (-1.0, 1.0))
    return nets.largest_piece(nets.mesh_field(solid, tuple(low), tuple(high), cell))


def _plain(points):
    skin = np.minimum(flesh.body(points), stone.smooth(points))
    away = np.linalg.norm(points - SIGN.place, axis=1)
    return np.maximum(np.abs(skin - HEIGHT) - THICKNESS / 2, away - RADIUS)


def _carved(points):
    solid = _plain(points)
    away = np.linalg.norm(points - SIGN.place, axis=1)
    rings = np.min([np.abs(away - radius) for radius in (0.7, 1.3, 1.9)], axis=0) - GROOVE / 2
    return f.carved(solid, np.maximum(rings, -solid - GROOVE_DEPTH))
