"""Sword, scabbard, bow, quiver and arrow: rigid meshes, each in the axes of its joint."""

import numpy as np

from . import mesh as m
from .palette import COLOURS
from .skeleton import BOW_BRACE, FRAMES, HEADS, INDEX, NAMES

BLADE, GUARD = 0.90, 0.085
ARROW = 0.74
# Half the bow's length, and how far its tips bend to the archer, in metres.
BOW_HALF = 0.62
X, Y, Z = np.eye(3)


def pieces():
    """All equipment."""
    result = []
    for joint in ("sword", "sword_sheathed"):
        result += _sword(joint)
    result += _scabbard() + _bow("bow", "bow_string") + _bow("bow_back", "bow_back") + _quiver()
    return result + _arrow("arrow", (0.0, 0.0, 0.0), "arrow")


def _placed(name, joint, shape, material, colour, crease=35.0):
    """A piece from points in a joint's axes."""
    points, triangles = shape
    world = HEADS[INDEX[joint]] + points @ FRAMES[INDEX[joint]].T
    colours = m.plain(points, COLOURS[colour]) if isinstance(colour, str) else colour
    return m.Piece(name, world, triangles, material, colours, m.rigid(points, joint), crease)


def _rings(stations):
    """Rings about +Y: (height, half width along X, half depth along Z), with `sides` corners."""
    return lambda sides, start=0.0: [m.ring(h * Y, Z, X, (d, w), sides, start) for h, w, d in stations]


def _sword(joint):
    blade = np.array(
        [
            (GUARD, 0.024, 0.0052),
            (GUARD + 0.25, 0.0225, 0.0048),
            (GUARD + 0.6, 0.0195, 0.0042),
            (GUARD + 0.82, 0.0150, 0.0034),
            (GUARD + BLADE, 0.0008, 0.0008),
        ]
    )
    # A flat hexagon: two edges and a broad ridge.
    outline = np.array([(1.0, 0.0), (0.42, 1.0), (-0.42, 1.0), (-1.0, 0.0), (-0.42, -1.0), (0.42, -1.0)])
    rings = [np.stack([w * outline[:, 0], np.full(6, h), d * outline[:, 1]], axis=1) for h, w, d in blade]
    edge = np.tile(np.array([1.0, 0.72, 0.72, 1.0, 0.72, 0.72]), len(blade))
    steel = m.loft(rings)
    colours = np.asarray(COLOURS["steel"]) * edge[:, None]
    grip = m.loft(
        _rings([(-0.078, 0.0125, 0.0110), (-0.03, 0.0150, 0.0130), (0.02, 0.0145, 0.0125), (0.076, 0.0130, 0.0115)])(7)
    )
    guard_path = np.array(
        [
            (-0.105, 0.092, 0),
            (-0.09, 0.082, 0),
            (-0.03, 0.078, 0),
            (0.03, 0.078, 0),
            (0.09, 0.082, 0),
            (0.105, 0.092, 0),
        ]
    )
    guard = m.tube(
        guard_path,
        [(0.006, 0.006), (0.009, 0.009), (0.011, 0.015), (0.011, 0.015), (0.009, 0.009), (0.006, 0.006)],
        5,
        Y,
        cap_start=True,
        cap_end=True,
    )
    pommel = m.loft(
        _rings([(-0.112, 0.010, 0.008), (-0.106, 0.020, 0.015), (-0.094, 0.023, 0.017), (-0.080, 0.014, 0.012)])(7),
        cap_start=True,
    )
    return [
        _placed("blade", joint, steel, "metal", colours, 12.0),
        _placed("grip", joint, grip, "leather", "leather_dark", 60.0),
        _placed("guard", joint, guard, "metal", "brass"),
        _placed("pommel", joint, pommel, "metal", "brass", 40.0),
    ]


def _scabbard():
    stations = [
        (-0.004, 0.0285, 0.0125),
        (-0.004, 0.0310, 0.0150),
        (0.045, 0.0310, 0.0150),
        (0.047, 0.0285, 0.0125),
        (0.45, 0.0255, 0.0110),
        (0.80, 0.0215, 0.0095),
        (0.802, 0.0235, 0.0110),
        (0.90, 0.0165, 0.0085),
        (0.925, 0.0060, 0.0050),
    ]
    shape = m.loft(_rings(stations)(10), cap_end=True, cap_start=True)
    row = np.minimum(np.arange(len(shape[0])) // 10, len(stations) - 1)
    colours = np.where(np.isin(row, (0, 1, 2, 6, 7, 8))[:, None], COLOURS["brass"], COLOURS["leather_dark"])
    colours[-1] = COLOURS["leather_dark"]
    strap = m.tube([(0.0, 0.02, 0.0), (-0.02, -0.02, 0.0), (-0.03, -0.065, 0.01)], [(0.004, 0.016)] * 3, 4, X)
    return [
        _placed("scabbard", "scabbard", shape, "leather", colours, 45.0),
        _placed("strap", "scabbard", strap, "leather", "leather"),
    ]


def _bow(joint, string):
    height = np.array([-1.0, -0.91, -0.78, -0.5, -0.12, 0.12, 0.5, 0.78, 0.91, 1.0])
    # A flat bow with recurved tips.
    depth = -BOW_BRACE * 1.02 * np.abs(height) ** 1.7 + 0.055 * np.maximum(np.abs(height) - 0.82, 0.0) / 0.18
    path = np.stack([0 * height, BOW_HALF * height, depth], axis=1)
    radii = [(0.0125 + 0.004 * (abs(h) < 0.13) - 0.0065 * abs(h), 0.0150 - 0.009 * h * h) for h in height]
    wood = m.tube(path, radii, 5, Z, cap_start=True, cap_end=True)
    count = 5 * len(height)
    grip = np.repeat(np.abs(height) < 0.13, 5)
    colours = np.where(np.append(grip, [False, False])[:, None], COLOURS["leather_dark"], COLOURS["wood"])
    assert len(colours) == len(wood[0]) == count + 2
    nock = 0.93 * BOW_HALF
    ends = -BOW_BRACE * 1.02 * 0.93**1.7 + 0.055 * 0.11 / 0.18
    line = np.array(
        [(0, -nock, ends - 0.008), (0, -0.001, -BOW_BRACE), (0, 0.001, -BOW_BRACE), (0, nock, ends - 0.008)]
    )
    cord = m.tube(line, [(0.0016, 0.0016)] * 4, 3, X)
    parts = [
        _placed("limbs", joint, wood, "leather", colours, 60.0),
        _placed("cord", joint, cord, "cloth", "string", 80.0),
    ]
    middle = np.repeat([False, True, True, False], 3)
    parts[1].weights[middle] = 0.0
    parts[1].weights[middle, NAMES.index(string)] = 1.0
    return parts


def _quiver():
    stations = [
        (0.0, 0.030, 0.030),
        (0.012, 0.040, 0.036),
        (0.34, 0.050, 0.044),
        (0.342, 0.054, 0.048),
        (0.40, 0.055, 0.049),
        (0.40, 0.048, 0.042),
        (0.33, 0.044, 0.038),
    ]
    shape = m.loft(_rings(stations)(12), cap_start=True, cap_end=True)
    row = np.minimum(np.arange(len(shape[0])) // 12, len(stations) - 1)
    colours = np.where(np.isin(row, (0, 1, 3, 4))[:, None], COLOURS["leather_dark"], COLOURS["leather"])
    colours[-1] = COLOURS["sole"]
    parts = [_placed("quiver", "quiver", shape, "leather", colours, 45.0)]
    for x, z, turn, depth in (
        (0.018, 0.012, 0.06, 0.52),
        (-0.020, 0.010, -0.05, 0.50),
        (0.002, -0.018, 0.02, 0.535),
        (-0.008, 0.020, -0.02, 0.485),
        (0.022, -0.014, 0.08, 0.47),
    ):
        parts += _stored_arrow((x, depth, z), turn)
    return parts


def _shaft_and_vanes(nock, along, across, length, vane_colour):
    """An arrow from its nock forward: a shaft and three vanes."""
    third = np.cross(along, across)
    shaft = m.tube([nock, nock + length * along], [(0.0038, 0.0038)] * 2, 4, across)
    points, triangles, colours = shaft[0], shaft[1], m.plain(shaft[0], COLOURS["wood"])
    for angle in (0.0, 2.1, 4.2):
        out = np.cos(angle) * across + np.sin(angle) * third
        vane = nock + np.array([0.012 * along, 0.022 * along + 0.017 * out, 0.075 * along + 0.014 * out, 0.100 * along])
        faces = np.array([(0, 1, 2), (0, 2, 3), (2, 1, 0), (3, 2, 0)])
        triangles = np.concatenate([triangles, faces % 4 + len(points) + 4 * (np.arange(4) > 1)[:, None]])
        points = np.concatenate([points, vane, vane])
        colours = np.concatenate([colours, m.plain(np.zeros(8), COLOURS[vane_colour])])
    return points, triangles, colours


def _stored_arrow(nock, turn):
    along = np.array([turn, -1.0, 0.4 * turn])
    along /= np.linalg.norm(along)
    across = np.cross(along, Z)
    points, triangles, colours = _shaft_and_vanes(
        np.asarray(nock), along, across / np.linalg.norm(across), 0.2, "feather_red"
    )
    return [_placed("stored_arrow", "quiver", (points, triangles), "cloth", colours, 40.0)]


def _arrow(joint, nock, name):
    points, triangles, colours = _shaft_and_vanes(np.asarray(nock), Y, X, ARROW, "feather")
    tip = m.loft(
        [
            m.ring(h * Y, X, Z, (w, 0.3 * w + 0.001), 4)
            for h, w in ((ARROW - 0.002, 0.003), (ARROW + 0.008, 0.011), (ARROW + 0.045, 0.0005))
        ]
    )
    return [
        _placed(name, joint, (points, triangles), "cloth", colours, 40.0),
        _placed("point", joint, tip, "metal", "steel_dark", 20.0),
    ]
