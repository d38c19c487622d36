"""Signed distance fields on arrays of points (n, 3), negative inside, in metres, and noise.

Distances of ellipsoids, tapers and smooth unions are approximations that are right to first order
near the surface, which is all that meshing by sign changes and gradients needs.
"""

import numpy as np


def round_cone(points, start, end, start_radius, end_radius):
    """A capsule whose radius changes from one end to the other."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    axis = end - start
    along = np.clip((points - start) @ axis / (axis @ axis), 0.0, 1.0)
    radius = start_radius + (end_radius - start_radius) * along
    return np.linalg.norm(points - start - along[:, None] * axis, axis=1) - radius


def ellipsoid(points, centre, radii, pitch=0.0):
    """An ellipsoid; `pitch` turns it about the X axis, in radians, nose (-Y) down if positive."""
    offset = turned_about_x(points - np.asarray(centre, float), -pitch)
    radii = np.asarray(radii, float)
    scaled = np.linalg.norm(offset / radii, axis=1)
    slope = np.linalg.norm(offset / radii**2, axis=1)
    return scaled * (scaled - 1.0) / np.maximum(slope, 1e-9)


def box(points, centre, half, pitch=0.0, yaw=0.0, roll=0.0, rounding=0.0):
    """A box turned by roll (about Y), pitch (about X), then yaw (about Z), in radians."""
    offset = points - np.asarray(centre, float)
    offset = turned_about_y(turned_about_x(turned_about_z(offset, -yaw), -pitch), -roll)
    outside = np.abs(offset) - (np.asarray(half, float) - rounding)
    return (
        np.linalg.norm(np.maximum(outside, 0.0), axis=1)
        + np.minimum(outside.max(axis=1), 0.0)
        - rounding
    )


def prism(points, outline, low, high, axis=2):
    """An outline (corners in counter-clockwise order) drawn out along an axis from low to high.

    The outline's two coordinates are the other two axes, in ascending order.
    """
    plane = [index for index in range(3) if index != axis]
    flat = polygon(points[:, plane], outline)
    middle, half = (low + high) / 2, (high - low) / 2
    slab = np.abs(points[:, axis] - middle) - half
    outside = np.stack([flat, slab], axis=1)
    return np.linalg.norm(np.maximum(outside, 0.0), axis=1) + np.minimum(outside.max(axis=1), 0.0)


def polygon(points, corners):
    """Distance to a polygon in the plane."""
    corners = np.asarray(corners, float)
    nearest = np.full(len(points), np.inf)
    inside = np.zeros(len(points), bool)
    for start, end in zip(corners, np.roll(corners, -1, axis=0)):
        edge = end - start
        offset = points - start
        along = np.clip(offset @ edge / (edge @ edge), 0.0, 1.0)
        gap = offset - along[:, None] * edge
        nearest = np.minimum(nearest, (gap * gap).sum(axis=1))
        spans = (start[1] <= points[:, 1]) != (end[1] <= points[:, 1])
        left = (edge[0] * offset[:, 1] - edge[1] * offset[:, 0]) * np.sign(edge[1]) < 0.0
        inside ^= spans & left
    return np.where(inside, -1.0, 1.0) * np.sqrt(nearest)


def half_space(points, through, normal):
    """The half space behind a plane."""
    normal = np.asarray(normal, float)
    return (points - np.asarray(through, float)) @ (normal / np.linalg.norm(normal))


def smooth_union(first, second, width):
    """Union with a fillet of about `width` metres."""
    overlap = np.maximum(width - np.abs(first - second), 0.0)
    return np.minimum(first, second) - overlap * overlap / (4.0 * width)


def carved(solid, tool):
    """`solid` without `tool`."""
    return np.maximum(solid, -tool)


def turned_about_x(points, angle):
    return _turned(points, angle, 1, 2)


def turned_about_y(points, angle):
    return _turned(points, angle, 2, 0)


def turned_about_z(points, angle):
    return _turned(points, angle, 0, 1)


def _turned(points, angle, first, second):
    if angle == 0.0:
        return points
    sine, cosine = np.sin(angle), np.cos(angle)
    result = points.copy()
    result[:, first] = cosine * points[:, first] - sine * points[:, second]
    result[:, second] = sine * points[:, first] + cosine * points[:, second]
    return result


def gradient(field, points, step=0.02):
    """Unit gradients by differences at the corners of a tetrahedron (four evaluations)."""
    total = np.zeros_like(points)
    for corner in ((1, -1, -1), (-1, -1, 1), (-1, 1, -1), (1, 1, 1)):
        corner = np.array(corner, float)
        total += corner * field(points + step * corner)[:, None]
    return total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-12)


def noise(points, seed=0):
    """Smooth noise in -1..1 with features of the size of one unit, from a hashed lattice."""
    cell = np.floor(points).astype(np.int64)
    within = points - cell
    fade = within * within * (3.0 - 2.0 * within)
    total = np.zeros(len(points))
    for corner in range(8):
        offset = np.array([corner & 1, corner >> 1 & 1, corner >> 2 & 1])
        share = np.where(offset == 1, fade, 1.0 - fade).prod(axis=1)
        total += share * _hashed(cell + offset, seed)
    return total


def _hashed(cell, seed):
    """A number in -1..1 for every lattice cell."""
    key = cell.astype(np.uint64)
    mixed = (
        key[:, 0] * np.uint64(0x9E3779B97F4A7C15)
        ^ key[:, 1] * np.uint64(0xC2B2AE3D27D4EB4F)
        ^ key[:, 2] * np.uint64(0x165667B19E3779F9)
        ^ np.uint64(seed * 0x27D4EB2F165667C5 & 0xFFFFFFFFFFFFFFFF)
    )
    mixed = (mixed ^ mixed >> np.uint64(31)) * np.uint64(0x7FB5D329728EA185)
    mixed = (mixed ^ mixed >> np.uint64(27)) * np.uint64(0x81DADEF4BC2DD44D)
    mixed ^= mixed >> np.uint64(33)
    return (mixed >> np.uint64(11)).astype(float) / 2.0**52 - 1.0


def layered_noise(points, octaves, seed=0):
    """Noise of several sizes, each half as large and half as strong as the one before."""
    total, strength = np.zeros(len(points)), 1.0
    for octave in range(octaves):
        total += strength * noise(points * 2.0**octave, seed + octave)
        strength /= 2.0
    return total


def smooth_step(low, high, value):
    """0 below `low`, 1 above `high`, smooth between."""
    share = np.clip((value - low) / (high - low), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)
