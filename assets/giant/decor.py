"""What lies on the body in the visual mesh alone: tufts of fur, glowing sigils, eyes."""

import numpy as np

from . import field as f
from . import flesh, nets, stone
from .signs import SIGNS, in_crest

# Tufts: at most this many, this far apart at least, with these lengths and half widths.
TUFT_CANDIDATES = 26_000
TUFT_SPACING = 0.88
TUFT_LENGTH = (1.7, 3.0)
TUFT_WIDTH = (0.34, 0.52)
# How high a tuft's ridge and tip stand above the skin; the collision mesh does not know of tufts.
RIDGE_HEIGHT, TIP_HEIGHT = 0.30, 0.34
# The crest's tufts: their distance, from the sigil's ring too, their lengths and half widths.
CREST_SPACING, CREST_GAP = 0.5, 0.25
CREST_LENGTH, CREST_WIDTH = (0.9, 1.5), (0.22, 0.34)
# No tuft reaches deeper under stone than this, in metres.
TUFT_COVER = 0.3
SEED = 20

# Sigils: half width, height above the skin and depth below it.
STROKE_HALF_WIDTH, STROKE_HEIGHT, STROKE_DEPTH = 0.13, 0.07, 0.15


def tufts(body_mesh):
    """Spikes of fur on the furry parts, pointing down: mesh, colour brightness, UVs per vertex."""
    random = np.random.default_rng(SEED)
    roots, normals = _tuft_roots(body_mesh, random)
    count = len(roots)
    length = random.uniform(*TUFT_LENGTH, count)[:, None]
    width = random.uniform(*TUFT_WIDTH, count)[:, None]
    fall = np.array([0.0, 0.45, -1.0]) + random.normal(0.0, 0.22, (count, 3))
    fall -= (fall * normals).sum(axis=1, keepdims=True) * normals
    along = fall / np.linalg.norm(fall, axis=1, keepdims=True)
    across = np.cross(along, normals)

    middle, middle_up = _on_body(roots + 0.42 * length * along, 0.0)
    tip, _ = _on_body(roots + length * along, TIP_HEIGHT)
    free = np.minimum(stone.smooth(middle), stone.smooth(tip)) > -TUFT_COVER
    return _spikes(*(part[free] for part in (roots, normals, middle, middle_up, tip, across, width)), random)


def crest():
    """The same for the crest of hair on the head, which grows out of level stone and points backwards."""
    random = np.random.default_rng(SEED)
    sign = SIGNS[0]
    across, along = np.meshgrid(np.arange(-2.2, 2.3, CREST_SPACING), np.arange(0.3, 2.3, CREST_SPACING))
    away = np.stack([across.ravel(), along.ravel(), np.zeros(across.size)], axis=1)
    away[:, :2] += random.uniform(-0.12, 0.12, (len(away), 2))
    roots = away + sign.place
    roots = roots[in_crest(roots) & (np.hypot(away[:, 0], away[:, 1]) > sign.size + CREST_GAP)]
    count, up = len(roots), np.array([0.0, 0.0, 1.0])
    along = np.array([0.0, 1.0, 0.0]) + 0.3 * (roots - sign.place) * (1.0, 0.0, 0.0)
    along += random.normal(0.0, 0.15, (count, 3)) * (1.0, 1.0, 0.0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    length = random.uniform(*CREST_LENGTH, count)[:, None]
    width = random.uniform(*CREST_WIDTH, count)[:, None]
    ups = np.tile(up, (count, 1))
    tip = roots + length * along + TIP_HEIGHT * up
    return _spikes(roots, ups, roots + 0.42 * length * along, ups, tip, np.cross(along, up), width, random)


def _spikes(roots, normals, middle, middle_up, tip, across, width, random):
    """Tufts of three corners at their roots, three at their middles and a tip."""
    corners = [
        roots - 0.22 * normals + 0.6 * width * across,
        roots - 0.22 * normals - 0.6 * width * across,
        roots + 0.04 * normals,
        middle - 0.10 * middle_up + width * across,
        middle - 0.10 * middle_up - width * across,
        middle + RIDGE_HEIGHT * middle_up,
        tip,
    ]
    pattern = np.array([
        (0, 1, 2),
        (0, 2, 5), (0, 5, 3), (2, 1, 4), (2, 4, 5), (1, 0, 3), (1, 3, 4),
        (3, 5, 6), (5, 4, 6), (4, 3, 6),
    ])
    points = np.stack(corners, axis=1).reshape(-1, 3)
    count = len(roots)
    triangles = (pattern[None] + 7 * np.arange(count)[:, None, None]).reshape(-1, 3)
    shade = random.uniform(0.75, 1.2, count)[:, None] * np.array([0.5, 0.5, 0.7, 0.75, 0.75, 1.0, 1.25])
    uv = np.array([(0, 0), (0.2, 0), (0.1, 0), (0, 0.4), (0.2, 0.4), (0.1, 0.4), (0.1, 1.0)])
    return nets.Mesh(points, triangles), shade.reshape(-1), np.tile(uv, (count, 1))


def _tuft_roots(mesh, random):
    """Points spread over the furry skin, and its normals there."""
    corners = mesh.points[mesh.triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    chosen = random.choice(len(area), TUFT_CANDIDATES, p=area / area.sum())
    share = random.dirichlet((1.0, 1.0, 1.0), TUFT_CANDIDATES)
    points = (corners[chosen] * share[:, :, None]).sum(axis=1)
    normals = f.gradient(flesh.body, points, 0.3)
    wanted = (flesh.fur_amount(points) > 0.75) & (normals[:, 2] > -0.75)
    below = points + (0.0, 0.2, -1.2)
    for place, gap in ((points, 0.15), (below, 0.1)):
        wanted &= stone.smooth(place) > gap
    points, normals = points[wanted], normals[wanted]
    taken, cells = [], {}
    for index, point in enumerate(points):
        cell = tuple((point // TUFT_SPACING).astype(int))
        near = (
            other
            for dx in (-1, 0, 1) for dy in (-1, 0, 1) for dz in (-1, 0, 1)
            for other in cells.get((cell[0] + dx, cell[1] + dy, cell[2] + dz), ())
        )
        if all(((points[other] - point) ** 2).sum() > TUFT_SPACING**2 for other in near):
            cells.setdefault(cell, []).append(index)
            taken.append(index)
    return points[taken], normals[taken]


def _on_body(points, height):
    """The points moved to a height above the smooth body, and the directions away from it."""
    for _ in range(2):
        up = f.gradient(flesh.body, points, 0.3)
        points = points + (height - flesh.body(points))[:, None] * up
    return points, up


def sigils():
    """The glowing strokes of all weak points, as one mesh of closed strips."""
    pieces = [
        _stroke(sign.placed(path), sign.normal) for sign in SIGNS for path in _strokes(sign.size)
    ]
    return joined(pieces)


def _strokes(size):
    """A ring, an eye in it and rays: polylines in the plane, in metres."""
    turn = np.linspace(0.0, 2 * np.pi, 33)
    ring = size * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    lens = np.linspace(-0.62, 0.62, 11)
    bow = 0.34 * np.cos(lens / 0.62 * np.pi / 2)
    yield ring
    yield size * np.stack([lens, bow], axis=1)
    yield size * np.stack([lens, -bow], axis=1)
    yield size * np.array([(0.0, -0.14), (0.0, 0.14)])
    for angle in np.pi / 4 + np.pi / 2 * np.arange(4):
        ray = np.array([np.cos(angle), np.sin(angle)])
        yield size * np.linspace(1.15, 1.5, 3)[:, None] * ray
    yield size * np.array([(0.0, -1.0), (0.0, -1.3), (0.0, -1.75)])
    yield size * np.array([(0.0, 0.5), (0.0, 1.0)])


def _stroke(path, normal):
    """A closed strip along a path in space, laid onto the surface along -normal."""
    path = _laid(path, normal)
    tangent = np.gradient(path, axis=0)
    across = np.cross(normal, tangent)
    across *= STROKE_HALF_WIDTH / np.linalg.norm(across, axis=1, keepdims=True)
    up, down = STROKE_HEIGHT * normal, -STROKE_DEPTH * normal
    ring = np.stack([path - across + down, path + across + down, path + across + up, path - across + up], axis=1)
    count = len(path)
    corner = lambda row, column: 4 * row + column % 4
    triangles = [(0, 1, 2), (0, 2, 3)]
    last = 4 * (count - 1)
    triangles += [(last, last + 2, last + 1), (last, last + 3, last + 2)]
    for row in range(count - 1):
        for column in range(4):
            a, b = corner(row, column), corner(row, column + 1)
            c, d = corner(row + 1, column + 1), corner(row + 1, column)
            triangles += [(a, c, b), (a, d, c)]
    return nets.Mesh(ring.reshape(-1, 3), np.array(triangles))


def _laid(path, normal):
    """Points moved along -normal until they meet the surface."""
    height = np.full(len(path), 1.5)
    for _ in range(60):
        place = path + height[:, None] * normal
        height -= np.clip(0.7 * np.minimum(flesh.body(place), stone.smooth(place)), -0.2, 0.2)
    return path + height[:, None] * normal


def eyes():
    """Two glowing eyeballs deep in the sockets."""
    centre = np.array([1.55, -10.15, 34.5])
    one = nets.mesh_field(lambda p: f.ellipsoid(p, centre, (0.62, 0.4, 0.36)), centre - 1.0, centre + 1.0, 0.22)
    other = nets.Mesh(one.points * (-1.0, 1.0, 1.0), one.triangles[:, ::-1])
    return joined([one, other])


def joined(pieces):
    """Several meshes as one."""
    offset, points, triangles = 0, [], []
    for piece in pieces:
        points.append(piece.points)
        triangles.append(piece.triangles + offset)
        offset += len(piece.points)
    return nets.Mesh(np.concatenate(points), np.concatenate(triangles))
