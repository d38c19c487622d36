"""The hero's clothes: tunic, belt, sleeves, bracers, mantle, trousers, boots."""

import numpy as np
from giant import field as f

from . import mesh as m
from . import weights
from .palette import COLOURS
from .skeleton import ALONG, ANKLE, ELBOW, FORWARD, HIP, LEFT, LOWER, PALM_SIDE, SHOULDER, THUMB_SIDE, WRIST, head

BELT = 1.045
HEM = 0.715
BOOT_TOP = 0.395
# The tunic's waist and hem: half widths and half depths, in metres.
WAIST_SIZE, HEM_SIZE = (0.146, 0.107), (0.232, 0.178)
SKIRT_FOLDS, FOLD_DEPTH = 8, 0.012
CLOTH_THICKNESS = 0.010


def pieces(thinned):
    """All clothes."""
    result = [_tunic(), _skirt(), _belt(), _buckle(), _pouch(), _baldric(), _mantle(), _cowl(), _clasp()]
    for piece in (_sleeve(), _bracer(), _trouser(), _boot(thinned)):
        result += m.both_sides(piece)
    return result


def trunk(p):
    """Distance to the clothed trunk; both sides alike."""
    p = p * 1.0
    p[:, 0] = np.abs(p[:, 0])
    ribs = f.ellipsoid(p, (0, 1.285, -0.016), (0.158, 0.185, 0.108))
    return m.blended(
        ribs,
        (f.ellipsoid(p, (0, 1.10, -0.004), (0.138, 0.16, 0.098)), 0.08),
        (f.ellipsoid(p, (0, 0.965, -0.006), (0.160, 0.12, 0.112)), 0.08),
        (f.ellipsoid(p, (0.066, 1.322, 0.058), (0.080, 0.058, 0.042), pitch=-0.25), 0.05),
        (f.ellipsoid(p, (0.085, 1.34, -0.085), (0.075, 0.10, 0.045)), 0.05),
        (f.round_cone(p, (0.05, 1.415, -0.024), SHOULDER + (0.0, -0.004, 0.0), 0.052, 0.054), 0.05),
        (f.round_cone(p, (0.02, 1.475, -0.034), (0.125, 1.43, -0.028), 0.046, 0.036), 0.04),
        (f.round_cone(p, (0.125, 1.33, -0.045), (0.13, 1.18, -0.03), 0.045, 0.03), 0.06),
    )


def upper_arm(p):
    """Distance to the sleeve of the left arm, down to the bracer."""
    folds = _folds(p)
    deltoid = f.ellipsoid(p, SHOULDER + (0.020, -0.018, 0.0), (0.058, 0.063, 0.060))
    upper = f.round_cone(p, SHOULDER, ELBOW, 0.054, 0.046)
    biceps = m.turned_ellipsoid(p, SHOULDER + 0.15 * ALONG + 0.010 * FORWARD, (0.085, 0.05, 0.05), _arm_axes())
    lower = f.round_cone(p, ELBOW, ELBOW + 0.10 * LOWER, 0.046, 0.053)
    cuff = f.round_cone(p, ELBOW + 0.075 * LOWER, ELBOW + 0.10 * LOWER, 0.055, 0.052)
    wrist = f.round_cone(p, ELBOW + 0.11 * LOWER, WRIST, 0.038, 0.028)
    return m.blended(deltoid, (upper, 0.05), (biceps, 0.03), (lower, 0.03), (cuff, 0.03), (wrist, 0.012)) - folds


def _arm_axes():
    return np.stack([ALONG, PALM_SIDE, FORWARD], axis=1)


def _folds(p):
    """Height of the sleeve's folds: rings that wind about the arm, strongest near the elbow."""
    along = (p - SHOULDER) @ ALONG
    around = np.arctan2((p - SHOULDER) @ FORWARD, (p - SHOULDER) @ PALM_SIDE)
    strong = f.smooth_step(0.10, 0.22, along) * f.smooth_step(0.40, 0.34, along)
    wave = np.sin(2 * np.pi * along / 0.052 + 1.3 * np.sin(around + 0.6) + 0.7 * np.sin(2 * around))
    return (0.0008 + 0.0042 * strong) * wave


def _tunic():
    """The tunic's upper part, open in a short slit under the throat."""
    heights = np.array([1.03, 1.07, 1.105, 1.14, 1.175, 1.21, 1.25, 1.29, 1.33, 1.37, 1.41])
    path = np.stack([0 * heights, heights, np.interp(heights, (1.0, 1.3, 1.48), (-0.004, -0.014, -0.034))], axis=1)
    creases = lambda p: trunk(p) - 0.0035 * np.sin(46 * p[:, 1] + 26 * np.abs(p[:, 0]) + 5 * p[:, 2]) * f.smooth_step(1.24, 1.10, p[:, 1])
    rings = m.wrapped(creases, path, 32, LEFT, 0.30)
    points, triangles = m.loft(rings)
    placket = f.smooth_step(0.018, 0.012, np.abs(points[:, 0])) * (points[:, 2] > 0.0) * (points[:, 1] > 1.30)
    seam = f.smooth_step(0.15, 0.2, np.abs(points[:, 0])) * 0.3
    colours = m.mixed(COLOURS["tunic"], COLOURS["tunic_dark"], np.maximum(placket, seam))
    return m.Piece("tunic", points, triangles, "cloth", colours, weights.body(points), 80.0)


def _skirt_ring(share, inset=0.0):
    """A ring of the skirt, `share` of the way from the belt to the hem."""
    around = 34
    angle = 2 * np.pi * np.arange(around) / around
    half = [np.interp(share**bulge, (0.0, 1.0), pair) for pair, bulge in zip(zip(WAIST_SIZE, HEM_SIZE), (0.7, 0.55))]
    fold = np.cos(SKIRT_FOLDS * angle + 0.5 * np.sin(3 * angle)) + 0.3 * np.cos(5 * angle + 1.0)
    # The hem is cut higher at the sides, where the thighs push it up.
    slit = np.abs(np.cos(angle)) ** 10
    x = (half[0] + FOLD_DEPTH * share * fold - inset) * np.cos(angle)
    z = (half[1] + FOLD_DEPTH * share * fold - inset) * np.sin(angle)
    y = BELT - 0.012 + (HEM - BELT) * share * (1.0 - 0.13 * slit) + 0.004 * share * fold
    return np.stack([x, y, z - 0.004], axis=1)


def _skirt():
    shares = (0.0, 0.16, 0.36, 0.58, 0.80, 0.93, 0.932, 1.0)
    outer = [_skirt_ring(share) for share in shares]
    inner = [_skirt_ring(share, CLOTH_THICKNESS) for share in (1.0, 0.6, 0.2)]
    points, triangles = m.loft(np.array(outer + inner))
    around = len(outer[0])
    row = np.arange(len(points)) // around
    colours = m.plain(points, COLOURS["tunic"])
    colours[row >= len(outer)] = COLOURS["tunic_dark"]
    colours[(row == len(outer) - 1) | (row == len(outer) - 2)] = COLOURS["trim"]
    front = (points[:, 2] > 0.0)[:, None] & (row < len(outer) - 2)[:, None]
    shade = 0.82 + 0.18 * np.cos(SKIRT_FOLDS * np.arctan2(points[:, 2], points[:, 0]))[:, None] * 0.6
    colours = np.where(front | (row < len(outer) - 2)[:, None], colours * shade, colours)
    return m.Piece("skirt", points, triangles, "cloth", colours, weights.body(points, legs=0.94), 70.0)


def _belt():
    path = np.array([(0, BELT + h, -0.005) for h in (-0.027, -0.025, -0.020, 0.020, 0.025, 0.027)])
    grow = np.array([-0.004, 0.012, 0.0145, 0.0145, 0.0145, 0.012, -0.004])
    rings = [m.ring(c, LEFT, FORWARD, (WAIST_SIZE[0] + g, WAIST_SIZE[1] + g + 0.002), 24) for c, g in zip(path, grow)]
    points, triangles = m.loft(np.array(rings))
    row = np.arange(len(points)) // 24
    colours = np.where(np.isin(row, (2, 3))[:, None], COLOURS["leather"], np.asarray(COLOURS["leather"]) * 0.7)
    return m.Piece("belt", points, triangles, "leather", colours, weights.body(points), 50.0)


def _baldric():
    """The strap of the quiver: from the right shoulder, under the mantle, to the left hip."""
    around, middle = 26, np.array([0.0, 1.22, -0.010])
    slope = np.array([0.52, -0.85, 0.0])
    slope /= np.linalg.norm(slope)
    rings = []
    for aside, lift in ((-0.017, -0.003), (-0.015, 0.005), (0.015, 0.005), (0.017, -0.003)):
        centre = middle + aside * np.cross(FORWARD, slope)
        path = np.stack([centre - 0.01 * np.cross(FORWARD, slope), centre, centre + 0.01 * np.cross(FORWARD, slope)])
        rings.append(m.wrapped(lambda p, lift=lift: trunk(p) - lift - 0.003, path, around, FORWARD, 0.34)[1])
    points, triangles = m.loft(rings)
    row = np.arange(len(points)) // around
    colours = np.where(np.isin(row, (1, 2))[:, None], COLOURS["leather"], COLOURS["leather_dark"])
    return m.Piece("baldric", points, triangles, "leather", colours, weights.body(points), 50.0)


def _box(centre, half, axes=np.eye(3), taper=1.0):
    """A box with bevelled front: points and triangles; the front is the third axis."""
    outline = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)
    rings = []
    for depth, size in ((-1.0, 1.0), (0.55, 1.0), (1.0, 0.82 * taper)):
        corner = np.concatenate([outline * size, np.full((4, 1), depth)], axis=1) * half
        rings.append(np.asarray(centre) + corner @ np.asarray(axes, float).T)
    return m.loft(rings, cap_end=True)


def _buckle():
    points, triangles = _box((0, BELT, WAIST_SIZE[1] + 0.011), (0.027, 0.032, 0.010))
    return m.Piece("buckle", points, triangles, "metal", m.plain(points, COLOURS["brass"]), weights.body(points), 30.0)


def _pouch():
    """A bag on the right of the belt, towards the back."""
    angle = np.radians(212.0)
    out = np.array([np.cos(angle), 0.0, np.sin(angle)])
    axes = np.stack([np.cross((0, 1, 0), out), (0, 1, 0), out], axis=1)
    centre = np.array([0.150 * np.cos(angle), BELT - 0.055, 0.113 * np.sin(angle)]) + 0.022 * out
    points, triangles = _box(centre, (0.043, 0.045, 0.026), axes)
    colours = m.mixed(COLOURS["leather_dark"], COLOURS["leather"], f.smooth_step(-0.01, 0.02, points[:, 1] - centre[1]))
    return m.Piece("pouch", points, triangles, "leather", colours, weights.body(points), 30.0)


def _sleeve():
    share = np.array([-0.16, -0.04, 0.08, 0.20, 0.33, 0.46, 0.59, 0.70, 0.80, 0.90, 1.0])
    upper = SHOULDER + 0.285 * share[:, None] * ALONG
    lower = ELBOW + np.array([0.026, 0.052, 0.072, 0.090, 0.104])[:, None] * LOWER
    path = np.concatenate([upper[:-1], ELBOW[None], lower])
    rings = m.wrapped(upper_arm, path, 12, FORWARD, 0.11)
    # Its upper side is flat under the mantle, so that a raised arm does not come through it.
    for row, size in enumerate((0.30, 0.45, 0.68, 0.86)):
        above = np.maximum(-(rings[row] - path[row]) @ PALM_SIDE, 0.0)
        rings[row] += (1.0 - size) * above[:, None] * PALM_SIDE
    points, triangles = m.loft(rings)
    return m.Piece("sleeve", points, triangles, "cloth", m.plain(points, COLOURS["linen"]), weights.arm(points), 80.0)


def _bracer():
    stations = np.array([0.093, 0.096, 0.118, 0.125, 0.166, 0.170, 0.208, 0.212, 0.236, 0.237])
    radii = np.array([0.042, 0.0500, 0.0485, 0.0455, 0.0415, 0.0412, 0.0372, 0.0392, 0.0375, 0.026])
    path = ELBOW + stations[:, None] * LOWER
    rings = [m.ring(c, PALM_SIDE, THUMB_SIDE, (0.90 * r, r), 12) for c, r in zip(path, radii)]
    points, triangles = m.loft(np.array(rings))
    row = np.arange(len(points)) // 12
    colours = m.plain(points, COLOURS["leather"])
    colours[np.isin(row, (0, 1, 2, 7, 8, 9))] = COLOURS["leather_dark"]
    colours[np.isin(row, (4, 5))] = np.asarray(COLOURS["leather"]) * 0.7
    return m.Piece("bracer", points, triangles, "leather", colours, weights.arm(points), 40.0)


def _leg_field(p):
    """Distance to the left leg of the trousers."""
    knee = head("shin.L")
    cloth = 0.004 * np.sin(2 * np.pi * p[:, 1] / 0.055 + 1.2 * np.sin(np.arctan2(p[:, 2], p[:, 0] - 0.095)))
    cloth *= f.smooth_step(0.62, 0.50, p[:, 1])
    return m.blended(
        f.round_cone(p, HIP + (0.0, -0.02, 0.0), knee, 0.089, 0.060),
        (f.ellipsoid(p, (0.094, 0.76, 0.020), (0.076, 0.16, 0.078)), 0.04),
        (f.ellipsoid(p, HIP + (0.0, 0.02, -0.045), (0.078, 0.090, 0.050)), 0.05),
        (f.ellipsoid(p, knee + (0.0, 0.0, 0.012), (0.054, 0.065, 0.052)), 0.03),
        (f.round_cone(p, knee, ANKLE, 0.058, 0.040), 0.03),
        (f.ellipsoid(p, (0.100, 0.365, -0.030), (0.056, 0.10, 0.060)), 0.03),
    ) - cloth


def _trouser():
    heights = np.array([0.965, 0.90, 0.845, 0.79, 0.735, 0.685, 0.64, 0.60, 0.565, 0.53, 0.492, 0.455, 0.42, 0.38])
    path = np.stack([np.interp(heights, (ANKLE[1], HIP[1], 0.99), (ANKLE[0], HIP[0], 0.082)), heights,
                     np.interp(heights, (ANKLE[1], 0.49, HIP[1]), (-0.026, 0.0, -0.006))], axis=1)
    rings = m.wrapped(_leg_field, path, 14, LEFT, 0.16)
    # The upper end hides under the skirt.
    rings[0] = path[0] + 0.62 * (rings[0] - path[0])
    rings[1] = path[1] + 0.94 * (rings[1] - path[1])
    # Both legs meet in the middle plane.
    rings[..., 0] = np.maximum(rings[..., 0], -0.004)
    points, triangles = m.loft(rings)
    colours = m.mixed(COLOURS["trousers"], COLOURS["trousers_dark"], f.smooth_step(0.06, 0.02, points[:, 0]))
    return m.Piece("trouser", points, triangles, "cloth", colours, weights.leg(points), 80.0)


def boot_field(p):
    """Distance to the left boot: foot, shaft, folded top, sole with a heel."""
    knee = head("shin.L")
    turn = np.radians(6.0)
    q = p - (0.103, 0.0, 0.0)
    q = np.stack([np.cos(turn) * q[:, 0] - np.sin(turn) * q[:, 2], q[:, 1], np.sin(turn) * q[:, 0] + np.cos(turn) * q[:, 2]], axis=1)
    shaft = f.round_cone(p, knee, ANKLE + (0.0, 0.0, 0.002), 0.064, 0.046)
    calf = f.ellipsoid(p, (0.101, 0.325, -0.030), (0.058, 0.11, 0.064))
    heel = f.ellipsoid(q, (0.0, 0.050, -0.042), (0.036, 0.052, 0.042))
    instep = f.round_cone(q, (0.0, 0.088, -0.010), (0.002, 0.044, 0.110), 0.044, 0.034)
    ball = f.ellipsoid(q, (0.004, 0.034, 0.108), (0.046, 0.032, 0.055))
    tip = f.ellipsoid(q, (-0.002, 0.030, 0.150), (0.036, 0.026, 0.042))
    folds = 0.0030 * np.sin(p[:, 1] * 120 + p[:, 2] * 30) * f.smooth_step(0.08, 0.11, p[:, 1]) * f.smooth_step(0.22, 0.16, p[:, 1])
    upper = m.blended(shaft, (calf, 0.03), (heel, 0.04), (instep, 0.035), (ball, 0.03), (tip, 0.025)) - folds
    upper = np.maximum(upper, p[:, 1] - BOOT_TOP)
    cuff = np.maximum(f.round_cone(p, knee, ANKLE, 0.076, 0.060), np.abs(p[:, 1] - BOOT_TOP + 0.036) - 0.036 - 0.012 * np.sin(2.0 * np.arctan2(p[:, 2] + 0.01, p[:, 0] - 0.1)) * (p[:, 1] < BOOT_TOP - 0.03))
    outline = np.minimum(
        f.ellipsoid(q, (0.003, 0.0, 0.100), (0.050, 0.2, 0.098)),
        f.ellipsoid(q, (-0.001, 0.0, -0.030), (0.041, 0.2, 0.060)),
    )
    outline = m.blended(outline, (f.round_cone(q, (0.0, 0.0, -0.02), (0.002, 0.0, 0.10), 0.036, 0.042), 0.03))
    sole = np.maximum(outline, p[:, 1] - 0.021)
    arch = np.maximum(np.abs(q[:, 2] - 0.028) - 0.024, p[:, 1] - 0.010)
    sole = np.maximum(sole, -arch)
    whole = np.minimum(np.minimum(np.maximum(upper, 0.008 - p[:, 1]), cuff), sole)
    return np.maximum(whole, -p[:, 1])


def _boot(thinned):
    points, triangles = m.meshed(boot_field, (0.0, -0.03, -0.14), (0.22, 0.43, 0.24), 0.0105, 0.092, thinned)
    points = points * (1.0, 0.0, 1.0) + (0.0, 1.0, 0.0) * np.maximum(points[:, 1:2], 0.0)
    colours = m.plain(points, COLOURS["boot"])
    colours[points[:, 1] < 0.024] = COLOURS["sole"]
    cuff = points[:, 1] > BOOT_TOP - 0.080
    colours[cuff] = COLOURS["leather"]
    strap = np.abs(points[:, 1] - 0.135 - 0.3 * (points[:, 2] + 0.02)) < 0.016
    colours[strap] = COLOURS["leather_dark"]
    return m.Piece("boot", points, triangles, "leather", colours, weights.leg(points), 50.0)


def mantle_field(p):
    """Distance to the mantle's outer face, which lies over trunk and arms."""
    p = p * 1.0
    p[:, 0] = np.abs(p[:, 0])
    around = np.arctan2(p[:, 0], p[:, 2] + 0.03)
    folds = 0.006 * np.sin(9.0 * around + 2.0 * np.sin(2 * around)) * f.smooth_step(1.47, 1.33, p[:, 1])
    hood = f.ellipsoid(p, (0.0, 1.425, -0.128), (0.090, 0.075, 0.046), pitch=0.25)
    return m.blended(trunk(p), (_plain_arm(p), 0.06), (hood, 0.04)) - 0.015 - folds


def _plain_arm(p):
    return m.blended(
        f.ellipsoid(p, SHOULDER + (0.020, -0.018, 0.0), (0.059, 0.064, 0.061)), (f.round_cone(p, SHOULDER, ELBOW, 0.054, 0.050), 0.05)
    )


def _mantle():
    """Rings about the neck, from under the cowl to a trimmed edge that is turned in."""
    around, middle = 36, np.array([0.0, 1.435, -0.032])
    angle = 2 * np.pi * np.arange(around) / around
    out = np.stack([np.cos(angle), 0 * angle, np.sin(angle)], axis=1)
    # How far the edge hangs below the horizontal, seen from the neck: less over the shoulders.
    edge = np.radians(np.interp(np.abs(np.degrees(np.arctan2(out[:, 0], out[:, 2]))), (0, 25, 65, 90, 120, 150, 180), (50, 44, 23, 11, 21, 42, 50)))
    edge += 0.035 * np.cos(9.0 * angle)
    shares = (-0.10, 0.15, 0.34, 0.52, 0.68, 0.80, 0.805, 0.90, 0.995)
    start = np.radians(-38.0)
    rings = []
    for share, lift in [*((share, 0.003 * (share > 0.802)) for share in shares), (1.0, -0.002), (0.985, -0.013)]:
        slope = (start + share * (edge - start))[:, None]
        ways = np.cos(slope) * out - np.sin(slope) * np.array([0.0, 1.0, 0.0])
        far = np.full(around, 0.34)
        for _ in range(m.RAY_STEPS):
            far -= 0.7 * (mantle_field(middle + far[:, None] * ways) - lift)
        rings.append(middle + far[:, None] * ways)
    points, triangles = m.loft(rings)
    row = np.arange(len(points)) // around
    colours = m.mixed(COLOURS["mantle"], COLOURS["mantle_light"], f.smooth_step(1.36, 1.48, points[:, 1]))
    colours[row >= 6] = COLOURS["mantle_trim"]
    return m.Piece("mantle", points, triangles, "cloth", colours, weights.mantle(points), 55.0)


def _cowl():
    """Two rolls of cloth about the neck, lower in front."""
    around, sides = 24, 8
    angle = 2 * np.pi * np.arange(around) / around
    rings = []
    for turn in 2 * np.pi * np.arange(sides + 1) / sides:
        # The section of a soft collar: thick below, with a fold in its outer side.
        thick = 0.031 * (1.0 - 0.22 * np.cos(2 * turn + 0.5)) * (1.0 + 0.10 * np.sin(3.0 * angle + 1.0)) * np.interp(np.sin(angle), (-1, 1), (1.15, 0.95))
        far, high = thick * np.cos(turn), thick * 1.35 * np.sin(turn)
        x, z = (0.083 + far) * np.cos(angle), (0.080 + far) * np.sin(angle)
        y = high + 0.005 * np.sin(2.0 * angle + 0.6) + 0.004 * np.sin(5.0 * angle + 2.0 * turn)
        tilt = 0.30
        rings.append(np.stack([x, 1.472 + y * np.cos(tilt) - z * np.sin(tilt), -0.022 + z * np.cos(tilt) + y * np.sin(tilt)], axis=1))
    points, triangles = m.loft(rings)
    colours = m.mixed(COLOURS["mantle"], COLOURS["mantle_light"], f.smooth_step(1.44, 1.51, points[:, 1]))
    return m.Piece("cowl", points, triangles, "cloth", colours, weights.mantle(points), 180.0)


def _clasp():
    """A brass disc that holds the mantle."""
    centre = np.array([0.062, 1.395, 0.0])
    for _ in range(30):
        centre[2] = centre[2] if centre[2] else 0.2
        centre[2] -= 0.7 * mantle_field(centre[None])[0]
    out = f.gradient(mantle_field, centre[None], 0.01)[0]
    u = np.cross((0, 1, 0), out)
    u /= np.linalg.norm(u)
    v = np.cross(out, u)
    rings = [m.ring(centre + h * out, u, v, (r, r), 10) for h, r in ((-0.006, 0.023), (0.005, 0.023), (0.009, 0.017), (0.007, 0.012))]
    points, triangles = m.loft(rings, cap_end=True)
    # It follows the cloth under its middle.
    same = np.repeat(weights.mantle(centre[None]), len(points), axis=0)
    return m.Piece("clasp", points, triangles, "metal", m.plain(points, COLOURS["brass"]), same, 30.0)
