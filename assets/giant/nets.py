"""Meshing of a signed distance field: a dual method on a regular grid.

One vertex for each cell through which the surface goes, placed where the tangent planes of the
cell's edge crossings meet (T. Ju et al., Dual Contouring of Hermite Data, 2002), so that edges of
stone stay sharp; one quad for each grid edge that the surface crosses. Before that, single grid
points are filled until no two solid points touch only across a diagonal ("well composed"): then the
mesh is a closed 2-manifold.
"""

from dataclasses import dataclass

import numpy as np

from . import field as fields

# Shares of a cell: how far the corner finder may leave the cell's inside, and how strongly vertices
# of flat cells are drawn to the middle of their crossings.
CELL_MARGIN = 0.06
PULL_TO_MIDDLE = 0.04
# A field is only evaluated on the fine grid where the coarse one (this many cells) comes near it.
COARSE = 4
# The smallest ratio of the QEF's second to its first eigenvalue at which a vertex counts as an edge.
EDGE_RATIO = 0.06


@dataclass
class Mesh:
    """Vertices (n, 3) and triangles (m, 3), counter-clockwise from outside."""

    points: np.ndarray
    triangles: np.ndarray


def mesh_field(field, low, high, cell, relaxations=3):
    """Meshes the zero surface of `field` within the box low..high with cells of the given size."""
    low = np.asarray(low, float)
    counts = np.ceil((np.asarray(high, float) - low) / cell).astype(int) // COARSE * COARSE + COARSE + 1
    inside = _well_composed(_solid(field, low, cell, counts))
    points, quads, sharp, centres = _contoured(field, low, cell, inside)
    for _ in range(relaxations):
        points = _relaxed(field, points, quads, sharp, centres, cell)
    return Mesh(points, _split(points, quads))


def _solid(field, low, cell, counts):
    """Which grid points are inside."""
    axes = [low[a] + cell * np.arange(counts[a]) for a in range(3)]
    coarse_axes = [axis[::COARSE] for axis in axes]
    coarse = field(_grid_points(coarse_axes)).reshape([len(axis) for axis in coarse_axes])
    near = np.abs(coarse) < COARSE * cell * 2.2
    block = np.zeros([n - 1 for n in coarse.shape], bool)
    deep = np.zeros_like(block)
    for dx in (0, 1):
        for dy in (0, 1):
            for dz in (0, 1):
                part = np.s_[dx : dx + block.shape[0], dy : dy + block.shape[1], dz : dz + block.shape[2]]
                block |= near[part]
                deep |= coarse[part] < 0.0
    inside = np.zeros(counts, bool)
    wanted = np.zeros(counts, bool)
    for part, source in ((inside, deep), (wanted, block)):
        spread = source
        for axis in range(3):
            spread = np.repeat(spread, COARSE, axis=axis)
        part[: spread.shape[0], : spread.shape[1], : spread.shape[2]] = spread
    where = np.argwhere(wanted)
    inside[tuple(where.T)] = field(low + cell * where) < 0.0
    for axis in range(3):
        edge = np.moveaxis(inside, axis, 0)
        edge[0], edge[-1] = False, False
    return inside


def _grid_points(axes):
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def _well_composed(inside):
    """Fills points until solid points that share a square or a cube are joined by edges."""
    while True:
        fill = np.zeros_like(inside)
        for first, second in ((0, 1), (0, 2), (1, 2)):
            a, b, c, d = (_shifted(inside, {first: i, second: j}) for i, j in ((0, 0), (1, 0), (0, 1), (1, 1)))
            rising, falling = a & d & ~b & ~c, b & c & ~a & ~d
            _shifted(fill, {first: 1, second: 0})[rising] = True
            _shifted(fill, {first: 0, second: 0})[falling] = True
        corners = {
            (i, j, k): _shifted(inside, {0: i, 1: j, 2: k}) for i in (0, 1) for j in (0, 1) for k in (0, 1)
        }
        total = sum(corner.astype(np.int8) for corner in corners.values())
        for (i, j, k), corner in corners.items():
            opposite = corners[1 - i, 1 - j, 1 - k]
            _shifted(fill, {0: i, 1: j, 2: 1 - k})[(total == 2) & corner & opposite] = True
            _shifted(fill, {0: i, 1: j, 2: k})[(total == 6) & ~corner & ~opposite] = True
        if not (fill & ~inside).any():
            return inside
        inside = inside | fill


def _shifted(values, shifts):
    """A view without the last layer (shift 0) or the first layer (shift 1) along some axes."""
    part = [slice(None)] * 3
    for axis, shift in shifts.items():
        part[axis] = slice(1, None) if shift else slice(None, -1)
    return values[tuple(part)]


def _contoured(field, low, cell, inside):
    """Vertices, quads, which vertices are edges or corners of the surface, and the cells' centres."""
    crossings = [_crossings(field, low, cell, inside, axis) for axis in range(3)]
    shape = np.array(inside.shape)
    stride = np.array([shape[1] * shape[2], shape[2], 1])
    quads, samples, normals = [], [], []
    for axis, (where, rising, places) in enumerate(crossings):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        ring = [where - offset for offset in _ring(u, v)]
        keys = np.stack([cells @ stride for cells in ring], axis=1)
        keys[~rising] = keys[~rising][:, ::-1]
        quads.append(keys)
        samples.append(places)
        normals.append(fields.gradient(field, places, step=0.02 * cell))
    keys, places, normals = map(np.concatenate, (quads, samples, normals))
    cells, quads = np.unique(keys, return_inverse=True)
    quads = quads.reshape(-1, 4)
    corner = np.stack([cells // stride[0], cells % stride[0] // stride[1], cells % stride[1]], axis=1)
    centres = low + cell * (corner + 0.5)
    points, sharp = _solved(quads, places, normals, centres, cell)
    return points, quads, sharp, centres


def _ring(u, v):
    """Offsets to the four cells around a grid edge, counter-clockwise about its direction."""
    zero = np.zeros(3, int)
    left, down = zero.copy(), zero.copy()
    left[u], down[v] = 1, 1
    return [left + down, down, zero, left]


def _crossings(field, low, cell, inside, axis):
    """Grid edges along an axis that the surface crosses, their sense, and where."""
    start, end = _shifted(inside, {axis: 0}), _shifted(inside, {axis: 1})
    where = np.argwhere(start != end)
    rising = start[tuple(where.T)]
    near, far = np.zeros(len(where)), np.ones(len(where))
    origin, direction = low + cell * where, np.zeros(3)
    direction[axis] = cell
    for _ in range(8):
        middle = (near + far) / 2
        same = (field(origin + middle[:, None] * direction) < 0.0) == rising
        near, far = np.where(same, middle, near), np.where(same, far, middle)
    return where, rising, origin + ((near + far) / 2)[:, None] * direction


def _solved(quads, places, normals, centres, cell):
    """Each cell's point of least squared distance to its tangent planes, kept within the cell."""
    count = len(centres)
    owner = quads.reshape(-1)
    repeated = np.repeat(places - 0.0, 4, axis=0) - centres[owner]
    normal = np.repeat(normals, 4, axis=0)
    number = np.bincount(owner, minlength=count)[:, None]
    middle = _summed(owner, repeated, count) / number
    products = _summed(owner, (normal[:, :, None] * normal[:, None, :]).reshape(-1, 9), count)
    products = products.reshape(-1, 3, 3)
    height = (normal * (repeated - middle[owner])).sum(axis=1, keepdims=True)
    right = _summed(owner, normal * height, count)
    pull = PULL_TO_MIDDLE * number[:, :, None] * np.eye(3)
    offset = np.linalg.solve(products + pull, right[:, :, None])[:, :, 0]
    limit = cell * (0.5 - CELL_MARGIN)
    eigenvalues = np.linalg.eigvalsh(products)
    sharp = eigenvalues[:, 1] > EDGE_RATIO * eigenvalues[:, 2]
    return centres + np.clip(middle + offset, -limit, limit), sharp


def _summed(owner, values, count):
    return np.stack([np.bincount(owner, column, minlength=count) for column in values.T], axis=1)


def _relaxed(field, points, quads, sharp, centres, cell):
    """Slides smooth vertices halfway to the middle of their neighbours, along the surface."""
    count = len(points)
    ends = np.concatenate([quads, quads[:, ::-1]])
    others = np.roll(ends, -1, axis=1).reshape(-1)
    ends = ends.reshape(-1)
    middle = _summed(ends, points[others], count) / np.bincount(ends, minlength=count)[:, None]
    normal = fields.gradient(field, points, step=0.02 * cell)
    slide = 0.5 * (middle - points)
    slide -= (slide * normal).sum(axis=1, keepdims=True) * normal
    moved = points + slide
    for _ in range(2):
        moved -= field(moved)[:, None] * fields.gradient(field, moved, step=0.02 * cell)
    limit = 0.75 * cell
    kept = sharp | (np.abs(moved - centres) > limit).any(axis=1)
    return np.where(kept[:, None], points, moved)


def _split(points, quads):
    """Two triangles for each quad, split so that the smallest angle is largest."""
    a, b, c, d = quads.T
    one = [np.stack(corners, axis=1) for corners in ((a, b, c), (a, c, d))]
    two = [np.stack(corners, axis=1) for corners in ((a, b, d), (b, c, d))]
    worst = [np.minimum(*(smallest_angles(points, part) for part in parts)) for parts in (one, two)]
    better = (worst[0] >= worst[1])[:, None]
    return np.concatenate([np.where(better, one[0], two[0]), np.where(better, one[1], two[1])])


def smallest_angles(points, triangles):
    """The smallest angle of each triangle, in radians."""
    corners = points[triangles]
    angles = []
    for first in range(3):
        one = corners[:, (first + 1) % 3] - corners[:, first]
        two = corners[:, (first + 2) % 3] - corners[:, first]
        area = np.linalg.norm(np.cross(one, two), axis=1)
        angles.append(np.arctan2(area, (one * two).sum(axis=1)))
    return np.min(angles, axis=0)


def normals(mesh):
    """Unit normals of the triangles."""
    a, b, c = (mesh.points[mesh.triangles[:, index]] for index in range(3))
    cross = np.cross(b - a, c - a)
    return cross / np.maximum(np.linalg.norm(cross, axis=1, keepdims=True), 1e-12)


def kept(mesh, triangles):
    """The mesh of some of the triangles (a mask), without unused vertices."""
    chosen = mesh.triangles[triangles]
    used, renumbered = np.unique(chosen, return_inverse=True)
    return Mesh(mesh.points[used], renumbered.reshape(-1, 3))


def largest_piece(mesh):
    """The connected piece with the most triangles."""
    label = np.arange(len(mesh.points))
    while True:
        low = label[mesh.triangles].min(axis=1)
        new = label.copy()
        for column in range(3):
            np.minimum.at(new, mesh.triangles[:, column], low)
        new = new[new]
        if (new == label).all():
            break
        label = new
    piece = label[mesh.triangles[:, 0]]
    return kept(mesh, piece == np.bincount(piece).argmax())


def is_closed_manifold(triangles):
    """Whether every edge belongs to exactly two triangles, once in each direction."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    count = int(edges.max()) + 1
    forward = edges[:, 0] * count + edges[:, 1]
    backward = edges[:, 1] * count + edges[:, 0]
    return len(np.unique(forward)) == len(forward) and (np.sort(forward) == np.sort(backward)).all()
