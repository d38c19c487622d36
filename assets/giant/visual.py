"""The meshes with what a vertex and a triangle carry: materials, colours, UVs."""

from dataclasses import dataclass

import numpy as np

from . import decor, flesh, nets, shell, stone
from . import field as f
from .signs import in_crest, near_sign

# Where the creature is in its rest pose, with room around it.
LOW, HIGH = (-21.0, -15.0, -1.5), (21.0, 13.0, 43.0)
# Grid cells, in metres: body, stone (before it is thinned out), collision mesh.
BODY_CELL, STONE_CELL, COLLISION_CELL = 0.43, 0.24, 0.93
# Share of the stone's triangles that remain.
STONE_SHARE = 0.30
# A stone face is a ledge if its plate is one and it is this level (cosine of 12 degrees).
LEVEL = 0.978
# Triangles this deep inside another solid are left out of the visual mesh.
HIDDEN_DEPTH = 0.25
# Grooves of overlapping blocks leave voids inside stone: what is this deep is one of them.
VOID_DEPTH = 0.45
# One repeat of a texture covers this many metres.
UV_METRES = 4.0

# The number of stone with a level top, for games that want to find ledges.
LEDGE_USER = 2

# name: (surface, number for the game, base colour, roughness, glow)
MATERIALS = {
    "fur": ("fur", None, (0.085, 0.060, 0.043), 0.95, None),
    "hide": ("skin", None, (0.20, 0.155, 0.125), 0.8, None),
    "stone": ("stone", None, (0.37, 0.345, 0.30), 0.9, None),
    "stone_ledge": ("stone", LEDGE_USER, (0.43, 0.41, 0.345), 0.9, None),
    "shell": ("stone", shell.USER, (0.30, 0.36, 0.37), 0.7, None),
    "glow": ("stone", None, (0.25, 0.85, 0.90), 0.4, (0.15, 0.95, 1.0)),
}
NAMES = list(MATERIALS)


@dataclass
class Dressed:
    """A mesh with a material for each triangle, colours for vertices and UVs for corners."""

    mesh: nets.Mesh
    materials: np.ndarray
    colours: np.ndarray | None = None
    uvs: np.ndarray | None = None


def collision():
    """The collision mesh: body and stone as one closed solid, and the shell."""
    solid = lambda p: np.minimum(flesh.body(p), stone.smooth(p))
    mesh = _on_ground(nets.largest_piece(nets.mesh_field(solid, LOW, HIGH, COLLISION_CELL)))
    plate = shell.collision()
    materials = [_surface_materials(mesh), np.full(len(plate.triangles), NAMES.index("shell"))]
    return Dressed(decor.joined([mesh, plate]), np.concatenate(materials))


def visual(thinned):
    """The visual mesh; `thinned(mesh, share)` removes triangles where the surface is plain."""
    body = _on_ground(nets.largest_piece(nets.mesh_field(flesh.furred_body, LOW, HIGH, BODY_CELL)))
    rock = thinned(nets.mesh_field(stone.weathered, LOW, HIGH, STONE_CELL), STONE_SHARE)
    fur, fur_shade, fur_uvs = decor.tufts(body)
    body = nets.kept(body, stone.smooth(_centres(body)) > -HIDDEN_DEPTH)
    rock = nets.kept(rock, flesh.body(_centres(rock)) > -HIDDEN_DEPTH)
    rock = nets.kept(rock, stone.smooth(_centres(rock)) > -VOID_DEPTH)
    parts = [_dressed_body(body), _dressed_stone(rock), _dressed_fur(fur, fur_shade, fur_uvs), _dressed_fur(*decor.crest())]
    parts += [_dressed_glow(decor.sigils()), _dressed_glow(decor.eyes()), _dressed_shell(shell.visual())]
    return Dressed(
        decor.joined([part.mesh for part in parts]),
        *(np.concatenate([getattr(part, name) for part in parts]) for name in ("materials", "colours", "uvs")),
    )


def furry(dressed):
    """For each vertex: whether it is a corner of a triangle that can be gripped."""
    result = np.zeros(len(dressed.mesh.points), bool)
    result[dressed.mesh.triangles[dressed.materials == NAMES.index("fur")]] = True
    return result


def _on_ground(mesh):
    """Soles are flat: nothing is below height 0."""
    return nets.Mesh(mesh.points * (1.0, 1.0, 0.0) + (0.0, 0.0, 1.0) * np.maximum(mesh.points[:, 2:], 0.0), mesh.triangles)


def _centres(mesh):
    return mesh.points[mesh.triangles].mean(axis=1)


def _surface_materials(mesh):
    """Materials of triangles of the union of body and stone."""
    centres = _centres(mesh)
    plates = stone.distances(centres)
    is_stone = plates.min(axis=0) < flesh.body(centres) + 0.05
    # Around a sigil the hair is short, and can be held all the same.
    furry = (flesh.fur_amount(centres) > 0.5) | near_sign(centres)
    result = np.where(is_stone, _stone_materials(mesh, plates), np.where(furry, NAMES.index("fur"), NAMES.index("hide")))
    return np.where(in_crest(centres), NAMES.index("fur"), result)


def _stone_materials(mesh, plates):
    is_ledge_plate = np.array([plate.ledge for plate in stone.PLATES])[plates.argmin(axis=0)]
    level = nets.normals(mesh)[:, 2] > LEVEL
    return np.where(level & is_ledge_plate, NAMES.index("stone_ledge"), NAMES.index("stone"))


def _dressed_body(mesh):
    fur = flesh.fur_amount(mesh.points)
    light = _openness(mesh.points, f.gradient(flesh.body, mesh.points, 0.2))
    tone = 1.0 + 0.22 * f.layered_noise(mesh.points * (0.9, 0.9, 0.25), 2, seed=41) + 0.15 * f.noise(mesh.points * 0.12, seed=43)
    warm = 0.5 + 0.5 * f.noise(mesh.points * 0.15, seed=47)
    tint = np.stack([1.0 + 0.12 * warm, np.ones_like(warm), 1.0 - 0.15 * warm], axis=1)
    shade = light * tone * np.where(fur > 0.5, 0.72, 0.9)
    materials = np.where(flesh.fur_amount(_centres(mesh)) > 0.5, NAMES.index("fur"), NAMES.index("hide"))
    return Dressed(mesh, materials, _colours(shade, tint), _limb_uvs(mesh))


def _dressed_fur(mesh, shade, uvs):
    light = _openness(mesh.points, f.gradient(flesh.body, mesh.points, 0.2))
    warm = 0.5 + 0.5 * f.noise(mesh.points * 0.15, seed=47)
    tint = np.stack([1.0 + 0.25 * warm, np.ones_like(warm), 1.0 - 0.2 * warm], axis=1)
    materials = np.full(len(mesh.triangles), NAMES.index("fur"))
    return Dressed(mesh, materials, _colours(light * shade, tint), uvs[mesh.triangles])


def _dressed_stone(mesh):
    normal = f.gradient(stone.smooth, mesh.points, 0.1)
    light = _openness(mesh.points, normal)
    groove = np.clip(stone.smooth(mesh.points) / -0.22, 0.0, 1.0)
    tone = 1.0 + 0.24 * f.layered_noise(mesh.points * 0.5, 3, seed=53)
    moss = np.clip(0.9 * f.layered_noise(mesh.points * 0.35, 2, seed=59) - 0.1 + 0.5 * groove, 0.0, 1.0)
    tint = np.array([1.0, 1.0, 1.0]) * (1.0 - moss[:, None]) + np.array([0.55, 0.66, 0.36]) * moss[:, None]
    materials = _stone_materials(mesh, stone.distances(_centres(mesh)))
    return Dressed(mesh, materials, _colours(light * tone * (1.0 - 0.7 * groove), tint), _box_uvs(mesh))


def _dressed_shell(mesh):
    light = _openness(mesh.points, f.gradient(stone.smooth, mesh.points, 0.1))
    tone = 1.0 + 0.2 * f.layered_noise(mesh.points * 0.8, 3, seed=61)
    materials = np.full(len(mesh.triangles), NAMES.index("shell"))
    return Dressed(mesh, materials, _colours(light * tone, np.ones((1, 3))), _box_uvs(mesh))


def of_shell(dressed):
    """For each vertex: whether it belongs to the shell."""
    result = np.zeros(len(dressed.mesh.points), bool)
    result[dressed.mesh.triangles[dressed.materials == NAMES.index("shell")]] = True
    return result


def _dressed_glow(mesh):
    materials = np.full(len(mesh.triangles), NAMES.index("glow"))
    return Dressed(mesh, materials, np.ones((len(mesh.points), 4)), _box_uvs(mesh))


def _colours(shade, tint):
    colours = np.ones((len(shade), 4))
    colours[:, :3] = np.clip(shade[:, None] * tint, 0.03, 1.0)
    return colours


def _openness(points, normals):
    """How much of the sky a point sees, roughly: the field along its normal tells what is near."""
    shade = np.zeros(len(points))
    for reach, share in ((0.5, 0.25), (1.2, 0.35), (2.8, 0.4)):
        place = points + reach * normals
        free = np.minimum(flesh.body(place), stone.smooth(place)) / reach
        shade += share * np.clip(1.0 - free, 0.0, 1.0)
    return 1.0 - 0.8 * shade


# Vertical axes around which limbs are unrolled: heights, and x and y of the axis there.
_ARM = ((3, 7, 11, 20.6, 32), (13.4, 14.1, 14.0, 13.2, 9.4), (-3.8, -3.4, -2.2, 1.4, -0.6))
_LEG = ((0, 2.6, 8.8, 15.4), (6.3, 6.2, 5.8, 4.3), (-1.5, 0.8, -1.4, 0.8))


def _limb_uvs(mesh):
    """Cylinder UVs around the trunk, the head, each arm and each leg, seamless across the wrap."""
    centres = _centres(mesh)
    corners = mesh.points[mesh.triangles]
    side = np.abs(centres[:, 0])
    edge = np.interp(centres[:, 2], (0, 18, 22, 30, 34), (9.6, 9.6, 8.6, 8.4, 11))
    arm = side > edge
    leg = ~arm & (centres[:, 2] < 14.0) & (side > 0.8)
    head = centres[:, 1] < np.interp(centres[:, 2], (29.0, 36.0), (-7.0, -4.6))
    head &= ~arm & (centres[:, 2] > 29.0)
    uvs = _unrolled(corners, ((0, 40), (0, 0), (0.6, 0.6)), 10)
    for mask, axis, repeats in ((arm, _ARM, 5), (leg, _LEG, 4), (head, ((0, 40), (0, 0), (-7.8, -7.8)), 5)):
        sided = np.sign(centres[mask, 0])[:, None, None] * np.ones((1, 3, 1))
        if axis[1] == (0, 0):
            sided = np.ones_like(sided)
        uvs[mask] = _unrolled(corners[mask] * np.concatenate([sided, sided**2, sided**2], axis=2), axis, repeats)
    return uvs


def _unrolled(corners, axis, repeats):
    height = corners[..., 2]
    x = corners[..., 0] - np.interp(height, axis[0], axis[1])
    y = corners[..., 1] - np.interp(height, axis[0], axis[2])
    turn = np.arctan2(x, -y) / (2 * np.pi)
    turn = np.where(turn.max(axis=1, keepdims=True) - turn > 0.5, turn + 1.0, turn)
    return np.stack([turn * repeats, height / UV_METRES], axis=-1)


def _box_uvs(mesh):
    """Each triangle projected along the axis that it faces most."""
    corners = mesh.points[mesh.triangles] / UV_METRES
    facing = np.abs(nets.normals(mesh)).argmax(axis=1)
    planes = np.array([(1, 2), (0, 2), (0, 1)])[facing]
    return np.take_along_axis(corners, np.repeat(planes[:, None, :], 3, axis=1), axis=2)


def height_at(sign):
    """How far the skin is from a sign's place along its normal."""
    place, normal, height = np.asarray(sign.place, float), sign.normal, 1.5
    for _ in range(60):
        point = (place + height * normal)[None]
        height -= float(np.clip(0.7 * min(flesh.body(point)[0], stone.smooth(point)[0]), -0.2, 0.2))
    return height
