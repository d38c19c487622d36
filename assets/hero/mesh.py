"""Pieces of the hero's mesh, and the ways to make one: a lofted tube, a wrapped field, a meshed field."""

from dataclasses import dataclass, field, replace

import numpy as np
from giant import field as f
from giant import nets

from .skeleton import JOINTS, MIRROR, NAMES

# Steps with which a ray finds a field's surface.
RAY_STEPS = 40


@dataclass
class Piece:
    """A mesh with colours (linear) and weights of its vertices, and a material."""

    name: str
    points: np.ndarray
    triangles: np.ndarray
    material: str
    colours: np.ndarray
    weights: np.ndarray
    # Faces that meet at a larger angle than this, in degrees, keep an edge.
    crease: float = 60.0
    shade: bool = field(default=True)


def loft(rings, cap_start=False, cap_end=False):
    """Points and triangles of a tube through rings (r, s, 3), outside facing out."""
    rings = np.asarray(rings, float)
    count, around = rings.shape[:2]
    number = np.arange(count * around).reshape(count, around)
    a, b = number[:-1], np.roll(number[:-1], -1, axis=1)
    c, d = number[1:], np.roll(number[1:], -1, axis=1)
    triangles = [np.stack([a, b, d], axis=-1).reshape(-1, 3), np.stack([a, d, c], axis=-1).reshape(-1, 3)]
    points = [rings.reshape(-1, 3)]
    for wanted, ring, flip in ((cap_start, 0, True), (cap_end, -1, False)):
        if wanted:
            middle = sum(len(part) for part in points)
            points.append(rings[ring].mean(axis=0)[None])
            fan = np.stack([np.full(around, middle), number[ring], np.roll(number[ring], -1)], axis=1)
            triangles.append(fan[:, ::-1] if flip else fan)
    points, triangles = np.concatenate(points), np.concatenate(triangles)
    return points, triangles[:, ::-1] if _volume(points, triangles) < 0.0 else triangles


def _volume(points, triangles):
    """The volume that triangles enclose; negative if they face inwards."""
    a, b, c = (points[triangles[:, corner]] - points.mean(axis=0) for corner in range(3))
    return (a * np.cross(b, c)).sum() / 6.0


def ring(centre, u, v, radii, around, start=0.0):
    """A ring of points about a centre: counter-clockwise from u to v."""
    angle = start + 2 * np.pi * np.arange(around) / around
    radii = np.broadcast_to(np.asarray(radii, float), (2,))
    return centre + radii[0] * np.cos(angle)[:, None] * u + radii[1] * np.sin(angle)[:, None] * v


def frames_along(path, hint):
    """Two axes across a path (n, 3) at each point, the first one close to `hint`."""
    path = np.asarray(path, float)
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    u = hint - along * (along @ hint)[:, None]
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    return u, np.cross(along, u)


def tube(path, radii, around, hint, **caps):
    """A tube along a path; `radii` are (n,) or (n, 2), along `hint` and across it."""
    u, v = frames_along(path, np.asarray(hint, float))
    rings = [ring(np.asarray(c, float), a, b, r, around) for c, a, b, r in zip(path, u, v, radii)]
    return loft(rings, **caps)


def wrapped(solid, path, around, hint, reach):
    """Rings about a path, drawn in from `reach` metres to the surface of a field."""
    u, v = frames_along(path, np.asarray(hint, float))
    angle = 2 * np.pi * np.arange(around) / around
    ways = np.cos(angle)[None, :, None] * u[:, None] + np.sin(angle)[None, :, None] * v[:, None]
    centres = np.repeat(np.asarray(path, float)[:, None], around, axis=1)
    far = np.full(ways.shape[:2], float(reach))
    for _ in range(RAY_STEPS):
        place = centres + far[..., None] * ways
        far -= 0.7 * solid(place.reshape(-1, 3)).reshape(far.shape)
        far = np.clip(far, 0.004, reach)
    return centres + far[..., None] * ways


def meshed(solid, low, high, cell, share, thinned):
    """A field's surface with a share of its triangles."""
    mesh = nets.largest_piece(nets.mesh_field(solid, low, high, cell))
    mesh = thinned(mesh, share) if share < 1.0 else mesh
    return mesh.points, mesh.triangles


def both_sides(piece):
    """A piece of the left side and its mirror image."""
    swapped = [name[:-1] + {"L": "R", "R": "L"}[name[-1]] if name[-2:] in (".L", ".R") else name for name in NAMES]
    order = [NAMES.index(name) if name in NAMES else number for number, name in enumerate(swapped)]
    mirror = replace(
        piece,
        name=piece.name + ".R",
        points=piece.points * MIRROR,
        triangles=piece.triangles[:, ::-1],
        weights=piece.weights[:, order],
    )
    return [replace(piece, name=piece.name + ".L"), mirror]


def rigid(points, joint):
    """Weights of points that follow one joint."""
    result = np.zeros((len(points), len(JOINTS)))
    result[:, NAMES.index(joint)] = 1.0
    return result


def plain(points, colour):
    """One colour for all points."""
    return np.tile(np.asarray(colour, float), (len(points), 1))


def mixed(first, second, share):
    """Colours between two, for each point."""
    share = np.asarray(share, float)[:, None]
    return np.asarray(first, float) * (1.0 - share) + np.asarray(second, float) * share


def smooth_carved(solid, tool, width):
    """`solid` without `tool`, with a rounded edge."""
    return -f.smooth_union(-solid, tool, width)


def blended(first, *others):
    """Smooth unions: each of `others` is a field and a width."""
    for other, width in others:
        first = f.smooth_union(first, other, width)
    return first


def turned_ellipsoid(points, centre, radii, axes):
    """An ellipsoid whose own axes are the columns of `axes`."""
    return f.ellipsoid((points - np.asarray(centre, float)) @ axes, (0, 0, 0), radii)
