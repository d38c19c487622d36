"""Rotations, as arrays of matrices (..., 3, 3)."""

import numpy as np


def turned(pitch=0.0, yaw=0.0, roll=0.0):
    """The rotations that roll, then pitch, then yaw, by degrees."""
    p, y, r = np.radians(np.broadcast_arrays(pitch, yaw, roll))
    return _about(2, y) @ _about(0, p) @ _about(1, r)


def _about(axis, angle):
    a, b = [(1, 2), (2, 0), (0, 1)][axis]
    result = np.zeros((*np.shape(angle), 3, 3))
    result[..., axis, axis] = 1.0
    result[..., a, a] = result[..., b, b] = np.cos(angle)
    result[..., a, b], result[..., b, a] = -np.sin(angle), np.sin(angle)
    return result


def turned_back(turns):
    """The inverse rotations."""
    return np.swapaxes(turns, -1, -2)


def frame(direction, normal):
    """Axes whose first one is along `direction` and whose third one is along `normal`."""
    x = direction / np.linalg.norm(direction, axis=-1, keepdims=True)
    z = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return np.stack([x, np.cross(z, x), z], axis=-1)


def between(first, second, share):
    """Rotations part of the way from one to another: those nearest to the mix of both."""
    share = share[:, None, None]
    left, _, right = np.linalg.svd((1 - share) * first + share * second)
    left[:, :, 2] *= np.sign(np.linalg.det(left @ right))[:, None]
    return left @ right


def matrices(quaternion):
    """Rotations of unit quaternions (n, 4), which begin with w."""
    w, x, y, z = quaternion.T
    return np.stack([
        np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], axis=1),
        np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], axis=1),
        np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=1),
    ], axis=1)


def quaternions(matrices):
    """Unit quaternions (w, x, y, z) of rotations (n, 3, 3)."""
    m = matrices
    trace = np.stack([
        1 + m[:, 0, 0] + m[:, 1, 1] + m[:, 2, 2],
        1 + m[:, 0, 0] - m[:, 1, 1] - m[:, 2, 2],
        1 - m[:, 0, 0] + m[:, 1, 1] - m[:, 2, 2],
        1 - m[:, 0, 0] - m[:, 1, 1] + m[:, 2, 2],
    ], axis=1)
    yz, zx, xy = m[:, 2, 1] - m[:, 1, 2], m[:, 0, 2] - m[:, 2, 0], m[:, 1, 0] - m[:, 0, 1]
    y_z, z_x, x_y = m[:, 2, 1] + m[:, 1, 2], m[:, 0, 2] + m[:, 2, 0], m[:, 1, 0] + m[:, 0, 1]
    rows = np.stack([
        np.stack([trace[:, 0], yz, zx, xy], axis=1),
        np.stack([yz, trace[:, 1], x_y, z_x], axis=1),
        np.stack([zx, x_y, trace[:, 2], y_z], axis=1),
        np.stack([xy, z_x, y_z, trace[:, 3]], axis=1),
    ], axis=1)
    best = rows[np.arange(len(m)), trace.argmax(axis=1)]
    return best / np.linalg.norm(best, axis=1, keepdims=True)
