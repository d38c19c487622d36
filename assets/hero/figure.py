"""The whole figure: all pieces joined, with normals and baked shade, split where edges are sharp."""

from dataclasses import dataclass

import numpy as np
from giant.blender import thinned
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from . import face, features, gear, hair, hands, legs, mantle, sleeves, tunic
from .palette import MATERIALS
from .skeleton import GEAR, NAMES

# Rays with which a vertex looks for what hides the sky from it, and their length in metres.
SHADE_RAYS, SHADE_REACH, SHADE_DEPTH = 40, 0.22, 0.75
# Vertices are lifted by this much before rays start, in metres.
LIFT = 0.004


@dataclass
class Figure:
    """What is drawn: vertices with normals, colours and weights, and triangles with materials."""

    points: np.ndarray
    normals: np.ndarray
    colours: np.ndarray
    weights: np.ndarray
    triangles: np.ndarray
    materials: np.ndarray
    # The piece to which each triangle belongs, for pictures and checks.
    names: list


def figure():
    """Makes all pieces and joins them."""
    pieces = [face.piece(thinned, hair.hair), hair.piece(thinned), *features.pieces(), *hands.pieces(thinned)]
    pieces += tunic.pieces() + mantle.pieces() + sleeves.pieces() + legs.pieces(thinned) + gear.pieces()
    for piece in pieces:
        assert np.isfinite(piece.points).all(), piece.name
    _shade(pieces)
    parts = [_split(piece) for piece in pieces]
    starts = np.cumsum([0] + [len(part[0]) for part in parts])
    names = [piece.name for piece, part in zip(pieces, parts) for _ in part[4]]
    materials = [list(MATERIALS).index(piece.material) for piece, part in zip(pieces, parts) for _ in part[4]]
    for name in sorted(set(names)):
        print(f"  {name}: {names.count(name)} triangles")
    return Figure(
        *(np.concatenate([part[column] for part in parts]) for column in range(4)),
        np.concatenate([part[4] + start for part, start in zip(parts, starts)]),
        np.array(materials),
        names,
    )


def _split(piece):
    """Vertices that part where faces meet at more than the crease, and triangles with an area."""
    a, b, c = (piece.points[piece.triangles[:, corner]] for corner in range(3))
    cross = np.cross(b - a, c - a)
    area = np.linalg.norm(cross, axis=1)
    faces, cross = piece.triangles[area > 1e-10], cross[area > 1e-10]
    normal = cross / np.linalg.norm(cross, axis=1, keepdims=True)
    around = [[] for _ in piece.points]
    for number, corners in enumerate(faces):
        for corner in corners:
            around[corner].append(number)
    limit = np.cos(np.radians(piece.crease))
    table, source, normals, triangles = {}, [], [], np.empty_like(faces)
    for number, corners in enumerate(faces):
        for slot, corner in enumerate(corners):
            near = [other for other in around[corner] if normal[other] @ normal[number] >= limit]
            mean = cross[near].sum(axis=0)
            mean /= max(np.linalg.norm(mean), 1e-12)
            key = (int(corner), *np.round(mean, 3))
            if key not in table:
                table[key] = len(source)
                source.append(corner)
                normals.append(mean)
            triangles[number, slot] = table[key]
    return piece.points[source], np.array(normals), piece.colours[source], piece.weights[source], triangles


def _shade(pieces):
    """Darkens the vertices that see little of the sky; equipment throws no shade and takes none."""
    worn = [piece for piece in pieces if not piece.weights[:, [NAMES.index(name) for name in GEAR]].any()]
    starts = np.cumsum([0] + [len(piece.points) for piece in worn])
    points = np.concatenate([piece.points for piece in worn])
    triangles = np.concatenate([piece.triangles + start for piece, start in zip(worn, starts)])
    tree = BVHTree.FromPolygons(points.tolist(), triangles.tolist())
    rays = _sphere(SHADE_RAYS)
    for piece in worn:
        if not piece.shade:
            continue
        normals = _vertex_normals(piece)
        light = np.empty(len(piece.points))
        for number, (place, normal) in enumerate(zip(piece.points, normals)):
            start, free, total = Vector(place + LIFT * normal), 0.0, 0.0
            for ray in rays:
                facing = ray @ normal
                if facing > 0.05:
                    # Light from above counts more.
                    share = facing * (0.65 + 0.35 * ray[1])
                    distance = tree.ray_cast(start, Vector(ray), SHADE_REACH)[3]
                    free += share * (1.0 if distance is None else (distance / SHADE_REACH) ** 0.8)
                    total += share
            light[number] = free / max(total, 1e-9)
        piece.colours = piece.colours * (1.0 - SHADE_DEPTH * (1.0 - light))[:, None]


def _vertex_normals(piece):
    a, b, c = (piece.points[piece.triangles[:, corner]] for corner in range(3))
    cross = np.cross(b - a, c - a)
    result = np.zeros_like(piece.points)
    for corner in range(3):
        np.add.at(result, piece.triangles[:, corner], cross)
    return result / np.maximum(np.linalg.norm(result, axis=1, keepdims=True), 1e-12)


def _sphere(count):
    """Directions spread evenly (a Fibonacci lattice)."""
    number = np.arange(count) + 0.5
    height, turn = 1.0 - 2.0 * number / count, np.pi * (1.0 + 5.0**0.5) * number
    flat = np.sqrt(1.0 - height * height)
    return np.stack([flat * np.cos(turn), height, flat * np.sin(turn)], axis=1)
