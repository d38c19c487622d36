"""The head without hair: skull, face, ears, neck."""

import numpy as np
from giant import field as f

from . import mesh as m
from . import weights
from .palette import COLOURS

EYE = np.array([0.0310, 1.6335, 0.0655])
EYE_RADIUS = 0.0150
SKULL = (0.0, 1.652, -0.012)


def face(points):
    """Distance to the head and the neck, without hair."""
    p = points * 1.0
    p[:, 0] = np.abs(p[:, 0])
    skull = f.ellipsoid(p, SKULL, (0.0725, 0.086, 0.093))
    mask = f.ellipsoid(p, (0, 1.600, 0.022), (0.0590, 0.082, 0.069))
    jaw = f.round_cone(p, (0.0480, 1.572, -0.002), (0.0130, 1.5215, 0.066), 0.0155, 0.0125)
    chin = f.ellipsoid(p, (0, 1.5200, 0.0755), (0.0200, 0.0135, 0.0130))
    cheek = f.ellipsoid(p, (0.0415, 1.606, 0.0560), (0.021, 0.016, 0.019))
    brow = f.round_cone(p, (0.010, 1.6530, 0.0850), (0.0440, 1.6545, 0.0640), 0.0085, 0.0085)
    muzzle = f.ellipsoid(p, (0, 1.560, 0.0740), (0.0270, 0.026, 0.0165))
    neck = f.round_cone(p, (0, 1.42, -0.034), (0, 1.575, -0.022), 0.0520, 0.0480)
    nape = f.round_cone(p, (0.022, 1.44, -0.050), (0.030, 1.60, -0.045), 0.036, 0.030)
    cords = f.round_cone(p, (0.012, 1.445, 0.022), (0.052, 1.575, -0.022), 0.010, 0.013)
    throat = f.ellipsoid(p, (0, 1.492, 0.0175), (0.012, 0.016, 0.012))
    head = m.blended(skull, (mask, 0.035), (jaw, 0.030), (cheek, 0.020), (muzzle, 0.018), (chin, 0.020), (brow, 0.014))
    socket = f.ellipsoid(p, (0.0315, 1.6360, 0.0900), (0.0190, 0.0110, 0.0165))
    head = m.smooth_carved(head, socket, 0.012)
    head = m.blended(head, (np.linalg.norm(p - EYE, axis=1) - EYE_RADIUS, 0.005))
    bridge = f.round_cone(p, (0, 1.6460, 0.0840), (0, 1.6050, 0.1030), 0.0070, 0.0090)
    tip = f.ellipsoid(p, (0, 1.5985, 0.1055), (0.0102, 0.0092, 0.0105))
    wing = f.ellipsoid(p, (0.0112, 1.5960, 0.0955), (0.0068, 0.0070, 0.0105))
    head = m.blended(head, (bridge, 0.014), (tip, 0.008), (wing, 0.006))
    upper = f.ellipsoid(p, (0.006, 1.5655, 0.0900), (0.0165, 0.0050, 0.0085))
    lower = f.ellipsoid(p, (0, 1.5555, 0.0890), (0.0165, 0.0058, 0.0085))
    head = m.blended(head, (upper, 0.006), (lower, 0.007))
    ear = f.ellipsoid(p, (0.0755, 1.612, -0.012), (0.0085, 0.0300, 0.0185), pitch=-0.22)
    ear = m.smooth_carved(ear, f.ellipsoid(p, (0.0860, 1.616, -0.008), (0.0080, 0.0190, 0.0105), pitch=-0.22), 0.006)
    return m.blended(head, (ear, 0.008), (nape, 0.03), (neck, 0.024), (cords, 0.012), (throat, 0.012))


def piece(thinned, hair):
    """The skin of head and neck, without what lies deep under the field `hair`."""
    cut = lambda p: np.maximum(face(p), 1.432 - p[:, 1])
    points, triangles = m.meshed(cut, (-0.1, 1.40, -0.13), (0.1, 1.76, 0.14), 0.0046, 0.0755, thinned)
    points, triangles = _without_hidden(points, triangles, hair)
    y, z = points[:, 1], points[:, 2]
    warm = np.maximum.reduce(
        [
            0.65 * _spot(points, (0.043, 1.596, 0.068), 0.026),
            0.8 * _spot(points, (0, 1.598, 0.117), 0.014),
            0.7 * _spot(points, (0.082, 1.612, -0.012), 0.03),
            0.35 * _spot(points, (0, 1.522, 0.088), 0.02),
            0.5 * _spot(points, (0.0315, 1.6335, 0.082), 0.020),
        ]
    )
    colours = m.mixed(COLOURS["skin"], COLOURS["skin_warm"], warm)
    # A hint of a beard's shadow about the jaw.
    beard = f.smooth_step(1.562, 1.535, y) * f.smooth_step(1.48, 1.52, y) * f.smooth_step(-0.01, 0.03, z)
    colours *= 1.0 - 0.13 * beard[:, None]
    return m.Piece("face", points, triangles, "skin", colours, weights.neck(points), 180.0)


def _spot(points, centre, size):
    """1 at a place of either side, falling to 0 within `size` metres."""
    p = points * 1.0
    p[:, 0] = np.abs(p[:, 0])
    return f.smooth_step(size, 0.0, np.linalg.norm(p - np.asarray(centre), axis=1))


def _without_hidden(points, triangles, hair):
    """Drops the skin that hair covers well."""
    deep = hair(points) < -0.006
    kept = ~deep[triangles].all(axis=1)
    used, renumbered = np.unique(triangles[kept], return_inverse=True)
    return points[used], renumbered.reshape(-1, 3)
