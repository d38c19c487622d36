"""The stone: plates that the colossus wears, each rigid on its joints, most with a level top.

Outlines are corners in metres in the plane across the direction in which they are drawn out,
counter-clockwise. Sided plates are built for the left and mirrored.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import field as f

# Chips and weathering of the visual stone, as a depth in metres; tops stay smooth for the feet.
CHIP_DEPTH = 0.13
# Width and depth of carved grooves.
GROOVE = 0.26
GROOVE_DEPTH = 0.22


@dataclass(frozen=True)
class Plate:
    """One rigid piece. `shape(points, fine)` is its distance; `fine` asks for carving."""

    name: str
    joints: dict
    shape: Callable
    sided: bool = False
    ledge: bool = True

    def distance(self, points, fine=False):
        """Distance to the plate, or to the nearer of a pair."""
        if self.sided:
            points = points * (1.0, 1.0, 1.0)
            points[:, 0] = np.abs(points[:, 0])
        return self.shape(points, fine)

    def weights(self, side):
        """Joint names and weights; `side` is +1 for the left, -1 for the right."""
        suffix = ".L" if side > 0 else ".R"
        return {name.replace(".*", suffix): weight for name, weight in self.joints.items()}


def distances(points, fine=False):
    """Distances to all plates: (plates, points)."""
    return np.stack([plate.distance(points, fine) for plate in PLATES])


def weathered(points):
    """Distance to the carved and chipped stone, for the visual mesh."""
    result = distances(points, fine=True).min(axis=0)
    near = np.abs(result) < 1.0
    q = points[near]
    chips = f.layered_noise(q * 0.9, 2, seed=31) + 0.9 * np.abs(f.noise(q * 0.45, seed=37)) - 0.3
    worn = result.copy()
    worn[near] += CHIP_DEPTH * np.maximum(chips, -0.25)
    return worn


def smooth(points):
    """Distance to the plain stone, for the collision mesh."""
    return distances(points).min(axis=0)


def _with_grooves(solid, lines, fine):
    """Carves grooves where any of the given distances to a line or plane is small."""
    if not fine:
        return solid
    nearest = np.min([np.abs(line) for line in lines], axis=0) - GROOVE / 2
    depth = -solid - GROOVE_DEPTH
    return f.carved(solid, np.maximum(nearest, depth))


def _shoulder(p, fine):
    """Two tiers and a parapet, like the corner of a ruined tower."""
    upper = [(6.0, -3.0), (7.2, -4.0), (11.4, -3.8), (13.2, -2.0), (13.2, 1.6), (11.6, 3.4), (7.4, 3.8), (6.0, 2.8)]
    lower = [(6.4, -4.6), (12.0, -4.8), (14.8, -2.6), (14.8, 2.2), (12.2, 4.6), (6.8, 5.0)]
    solid = f.prism(p, upper, 31.4, 35.0)
    tier = f.prism(p, lower, 30.6, 32.8)
    tier = np.maximum(tier, f.half_space(p, (14.8, 0, 31.6), (1.0, 0, -0.8)))
    solid = _with_grooves(solid, [p[:, 2] - 34.2, p[:, 1] - 0.9, p[:, 1] + 1.6], fine)
    tier = _with_grooves(tier, [p[:, 1] - 2.0, p[:, 1] + 0.4, p[:, 1] + 2.8, p[:, 0] - 9.6, p[:, 0] - 12.2], fine)
    result = np.minimum(solid, tier)
    for centre, half in (
        ((12.5, -1.1, 35.4), (0.7, 0.75, 0.9)),
        ((12.5, 1.1, 35.1), (0.7, 0.6, 0.6)),
        ((10.7, 3.0, 35.5), (0.8, 0.6, 1.0)),
    ):
        result = np.minimum(result, f.box(p, centre, half))
    return result


def _pauldron(p, fine):
    """A slab that hangs over the outside of the upper arm."""
    outer = f.box(p, (13.7, -0.1, 28.9), (1.15, 3.0, 2.6), roll=-0.22)
    point = f.box(p, (13.7, -0.1, 26.6), (1.15, 2.2, 2.2), roll=-0.22, pitch=np.pi / 4)
    solid = np.minimum(outer, np.maximum(point, p[:, 2] - 27.5))
    return _with_grooves(solid, [p[:, 1] - 1.2, p[:, 1] + 1.4, p[:, 2] - 29.8], fine)


def _belt(p, fine):
    """A ring of blocks around the waist with a rim to walk on."""
    outer = [(-4.4, -6.8), (4.4, -6.8), (7.9, -3.6), (8.3, 1.0), (7.4, 5.6), (4.2, 8.4), (-4.2, 8.4), (-7.4, 5.6), (-8.3, 1.0), (-7.9, -3.6)]
    rim = f.prism(p, outer, 18.2, 19.6)
    under = f.prism(p, np.array(outer) * 0.92 + (0, 0.05), 16.6, 19.3)
    angle = np.arctan2(p[:, 0], -p[:, 1] + 0.8)
    blocks = 14
    seam = (np.mod(angle / (2 * np.pi) * blocks, 1.0) - 0.5) * 2 * np.pi / blocks * 7.0
    under = _with_grooves(under, [seam, p[:, 2] - 17.5], fine)
    rim = _with_grooves(rim, [np.maximum(np.abs(seam), 18.9 - p[:, 2])], fine)
    buckle = f.prism(p, [(-2.2, 17.0), (0, 15.6), (2.2, 17.0), (2.2, 19.6), (-2.2, 19.6)], -7.9, -5.0, axis=1)
    buckle = _with_grooves(buckle, [f.polygon(p[:, [0, 2]], [(-1.3, 17.9), (0, 16.8), (1.3, 17.9), (0, 19.0)])], fine)
    return np.minimum(np.minimum(rim, under), buckle)


def _loin(p, fine, depth, top, bottom, width):
    """A slab hanging from the belt, before or behind."""
    outline = [(-width, bottom + 1.2), (0, bottom), (width, bottom + 1.2), (width * 0.9, top), (-width * 0.9, top)]
    solid = f.prism(p, outline, depth - 0.55, depth + 0.55, axis=1)
    frame = f.polygon(p[:, [0, 2]], np.array(outline) * (0.68, 1.0) + (0, 0.0))
    return _with_grooves(solid, [frame, p[:, 2] - (top + bottom) / 2], fine)


def _dorsal(p, fine, height, reach, width):
    """A pointed slab that juts out of the back like a stair; its underside slopes to the back."""
    skin = reach - 2.3
    outline = [(-width, skin - 2.6), (width, skin - 2.6), (width, reach - 0.9), (width * 0.55, reach), (-width * 0.55, reach), (-width, reach - 0.9)]
    solid = f.prism(p, outline, height - 2.6, height)
    solid = np.maximum(solid, f.half_space(p, (0, reach, height - 0.8), (0, 0.75, -1.0)))
    return _with_grooves(solid, [p[:, 2] - height + 0.55, p[:, 0] - width * 0.45, p[:, 0] + width * 0.45], fine)


def _bracer(p, fine):
    """A collar around the forearm; its upper rim is a ledge."""
    cx, cy = 13.95, -1.0
    rim = [(-3.1, -3.9), (2.0, -4.3), (4.5, -2.2), (4.6, 2.2), (2.2, 4.4), (-2.9, 3.9)]
    body = np.array(rim) * 0.86
    lower = np.array(rim) * 0.72
    result = f.prism(p, np.array(rim) + (cx, cy), 15.0, 16.4)
    middle = f.prism(p, body + (cx, cy - 0.5), 13.1, 16.1)
    middle = _with_grooves(middle, [p[:, 2] - 14.1, p[:, 0] - cx - 1.0, p[:, 1] - cy], fine)
    cuff = f.prism(p, lower + (cx, cy - 0.9), 11.9, 14.6)
    return np.minimum(np.minimum(result, middle), cuff)


def _knee(p, fine):
    """A block before the knee with a step on top."""
    outline = [(3.4, -4.0), (4.4, -6.2), (7.2, -6.2), (8.2, -4.0), (8.2, -1.6), (3.4, -1.6)]
    block = f.prism(p, outline, 8.0, 10.3)
    block = np.maximum(block, f.half_space(p, (0, -6.2, 9.2), (0, -1.0, -0.7)))
    shin = f.box(p, (6.0, -2.9, 6.6), (1.5, 0.7, 2.6), pitch=-0.30)
    block = _with_grooves(block, [p[:, 2] - 9.6, p[:, 0] - 4.7, p[:, 0] - 6.9], fine)
    shin = _with_grooves(shin, [p[:, 0] - 6.0, p[:, 2] - 6.4], fine)
    return np.minimum(block, shin)


def _crown(p, fine):
    """The level top of the head: two steps."""
    top = [(-2.3, -10.4), (2.3, -10.4), (2.9, -8.4), (2.5, -5.6), (1.4, -4.6), (-1.4, -4.6), (-2.5, -5.6), (-2.9, -8.4)]
    slab = f.prism(p, top, 35.5, 37.8)
    base = f.prism(p, np.array(top) * 1.16 + (0, 1.15), 35.2, 36.5)
    slab = _with_grooves(slab, [p[:, 2] - 37.1], fine)
    return np.minimum(slab, base)


def _mask(p, fine):
    """A carved face: brow, sockets, nose, cheeks."""
    side = np.abs(p[:, 0])
    q = np.stack([side, p[:, 1], p[:, 2]], axis=1)
    outline = [(0, 31.4), (1.5, 31.5), (2.5, 32.8), (3.1, 34.6), (3.0, 36.2), (0, 36.2), (-1, 34)]
    face = f.prism(q, outline, -11.2, -7.6, axis=1)
    face = np.maximum(face, f.half_space(q, (3.0, -9.4, 0), (0.75, -0.66, 0)))
    face = np.maximum(face, f.half_space(q, (0, -11.2, 33.6), (0, -1.0, -0.34)))
    brow = f.box(q, (1.6, -10.9, 35.7), (2.1, 0.95, 0.62), roll=0.20, yaw=0.22)
    nose = f.prism(q, [(-1, 32.2), (0.75, 32.4), (0.42, 35.4), (-1, 35.4)], -12.1, -10.0, axis=1)
    nose = np.maximum(nose, f.half_space(q, (0, -12.1, 32.6), (0, -1.0, 0.36)))
    cheek = f.box(q, (2.15, -10.3, 33.1), (0.75, 0.8, 0.95), roll=-0.35, yaw=0.5)
    solid = np.minimum(face, cheek)
    socket = f.box(q, (1.55, -11.0, 34.5), (0.82, 1.15, 0.50), roll=0.22)
    solid = f.carved(solid, socket)
    solid = np.minimum(np.minimum(solid, brow), nose)
    return _with_grooves(solid, [q[:, 0] - 2.45, np.maximum(np.abs(q[:, 2] - 35.75), 0.6 - q[:, 0])], fine)


def _jaw(p, fine):
    """A lower jaw with teeth and two tusks."""
    side = np.abs(p[:, 0])
    q = np.stack([side, p[:, 1], p[:, 2]], axis=1)
    outline = [(-1, -11.5), (1.1, -11.5), (2.0, -10.4), (2.5, -8.0), (-1, -8.0)]
    solid = f.prism(q, outline, 29.9, 31.3)
    solid = np.maximum(solid, f.half_space(q, (0, -11.5, 30.6), (0, -1.0, -0.8)))
    tusk = f.round_cone(q, (1.75, -10.9, 30.6), (2.3, -12.2, 32.6), 0.62, 0.2)
    solid = np.minimum(solid, tusk)
    return _with_grooves(solid, [q[:, 0] - 0.45, q[:, 0] - 1.15], fine)


def _horns(p, fine):
    """Two horns; the right one broke off long ago. `p` is not mirrored."""
    q = np.stack([np.abs(p[:, 0]), p[:, 1], p[:, 2]], axis=1)
    path = [(2.3, -7.4, 35.4), (4.6, -7.0, 36.2), (6.3, -7.6, 37.8), (6.9, -9.2, 39.6), (6.5, -11.0, 40.9)]
    radius = [1.35, 1.2, 0.98, 0.7, 0.25]
    horn = f.round_cone(q, path[0], path[1], radius[0], radius[1])
    for index in range(1, 4):
        horn = f.smooth_union(horn, f.round_cone(q, path[index], path[index + 1], radius[index], radius[index + 1]), 0.4)
    if fine:
        horn = horn + 0.07 * np.sin(4.2 * (q[:, 0] + q[:, 2]))
    stump = f.half_space(p, (-6.2, -7.6, 37.6), (-0.62, -0.35, 0.7))
    return np.where(p[:, 0] < 0.0, np.maximum(horn, stump), horn)


def _dorsals():
    rows = (
        ("spine.2", 23.2, 7.6, 2.0),
        ("spine.3", 26.2, 8.7, 2.3),
        ("chest", 29.4, 9.9, 2.6),
        ("chest", 32.6, 9.9, 2.4),
        ("chest", 35.6, 7.6, 2.0),
    )
    for number, (joint, height, reach, width) in enumerate(rows):
        yield Plate(
            f"dorsal.{number}",
            {joint: 1.0},
            lambda p, fine, h=height, r=reach, w=width: _dorsal(p, fine, h, r, w),
        )


PLATES = [
    Plate("shoulder", {"clavicle.*": 1.0}, _shoulder, sided=True),
    Plate("pauldron", {"clavicle.*": 0.6, "upper_arm.*": 0.4}, _pauldron, sided=True, ledge=False),
    Plate("belt", {"pelvis": 1.0}, _belt),
    Plate("loin.front", {"loin.front": 1.0}, lambda p, fine: _loin(p, fine, -6.1, 18.0, 11.6, 1.9), ledge=False),
    Plate("loin.back", {"loin.back": 1.0}, lambda p, fine: _loin(p, fine, 7.5, 18.0, 12.6, 1.7), ledge=False),
    *_dorsals(),
    Plate("bracer", {"forearm.*": 1.0}, _bracer, sided=True),
    Plate("knee", {"shin.*": 0.75, "thigh.*": 0.25}, _knee, sided=True),
    Plate("crown", {"head": 1.0}, _crown),
    Plate("mask", {"head": 1.0}, _mask, ledge=False),
    Plate("jaw", {"jaw": 1.0}, _jaw, ledge=False),
    Plate("horns", {"head": 1.0}, _horns, ledge=False),
]
