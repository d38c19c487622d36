"""Helpers to write the tables of the clips."""

import numpy as np

from .skeleton import GRIP, LOWER, PALM_SIDE, SWORD_LEAN, THUMB_SIDE, WRIST

_IN_GRIP = np.array([(GRIP - WRIST) @ axis for axis in (LOWER, THUMB_SIDE, PALM_SIDE)])


def wave(length, size, peak=0.0, count=1, rest=0.0):
    """A cosine of `count` periods in a clip; it peaks at `peak` of its period."""
    return lambda time: rest + size * np.cos(2 * np.pi * (count * time / length - peak))


def both(name, value):
    """The same for both sides."""
    return {f"{name}.L": value, f"{name}.R": value}


def mirrored(name, left):
    """Keys or a value of three numbers for the left side, mirrored for the right."""
    flip = lambda v: (-v[0], v[1], v[2])
    right = [(time, flip(v)) for time, v in left] if isinstance(left, list) else flip(left)
    return {f"{name}.L": left, f"{name}.R": right}


def unit(vector):
    """A vector of length 1."""
    vector = np.asarray(vector, float)
    return vector / np.linalg.norm(vector)


def fist(side, grip, thumb, fingers):
    """Wrist, fingers' direction and palm's normal of a fist at a place.

    `thumb` is where the rod in the fist points on the thumb's side, `fingers` roughly where the fingers
    point before they close.
    """
    thumb = unit(thumb)
    fingers = unit(np.asarray(fingers, float) - thumb * (thumb @ np.asarray(fingers, float)))
    palm = np.cross(fingers, thumb) * (1.0 if side == ".L" else -1.0)
    wrist = np.asarray(grip, float) - _IN_GRIP[0] * fingers - _IN_GRIP[1] * thumb - _IN_GRIP[2] * palm
    return tuple(wrist), tuple(fingers), tuple(palm)


def sword_fist(grip, blade, fingers):
    """Grip, thumb's side and fingers of a fist whose sword points along `blade`."""
    blade, lean = unit(blade), np.radians(SWORD_LEAN)
    ahead = unit(np.asarray(fingers, float) - blade * (blade @ np.asarray(fingers, float)))
    return grip, np.cos(lean) * blade - np.sin(lean) * ahead, np.cos(lean) * ahead + np.sin(lean) * blade


def fist_keys(side, keys):
    """Channels of a hand from keys (time, grip, thumb, fingers)."""
    rows = [(time, *fist(side, *rest)) for time, *rest in keys]
    return {
        f"{name}{side}": [(row[0], row[column]) for row in rows]
        for column, name in ((1, "hand"), (2, "fingers"), (3, "palm"))
    }


def standing():
    """Feet a little apart, arms loose."""
    return {
        "hips.y": -0.012,
        "spine.pitch": 1.5,
        "neck.pitch": 2.0,
        "head.pitch": -2.0,
        **both("arm.out", 11.0),
        **both("arm.swing", 1.0),
        **both("elbow", 15.0),
        **both("curl", 24.0),
        **both("turn", 12.0),
        **both("arm.twist", 12.0),
        **both("foot.out", 0.012),
        **both("foot.yaw", 7.0),
    }


def pose_keys(start, keys):
    """Keys for many channels: `keys` are (time, {channel: value}); `start` gives those at 0."""
    table = {name: [(0.0, value)] for name, value in start.items() if isinstance(value, (int, float))}
    for time, values in keys:
        for name, value in values.items():
            track = table.setdefault(name, [(0.0, 0.0)])
            if track[-1][0] == time:
                track.pop()
            track.append((time, value))
    return table
