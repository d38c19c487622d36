"""Feet that stand where they stand, hands at the height that the channels say; on the skin itself."""

import numpy as np

from . import motion
from .skeleton import HEADS, INDEX, JOINTS

SIDES = ((".L", 1), (".R", -1))
# Skin belongs to a foot or a hand if those joints have this share of it.
LEAST_SHARE = 0.3
# Skin above the ankle has less than this of the foot.
ANKLE_SHARE = 0.05
# A foot stands if its sole is no higher and moves no faster over the ground (metres, metres a second).
STANDING_HEIGHT, STANDING_SPEED = 0.03, 0.06
# Skin this close to the lowest point touches the ground, in metres.
TOUCH = 0.06
PASSES = 5


def share(weights, names, side=""):
    """How much of each vertex follows joints whose names begin so."""
    chosen = [n for n, j in enumerate(JOINTS) if j.name.startswith(names) and j.name.endswith(side)]
    return weights[:, chosen].sum(axis=1)


def foot_skin(points, weights, side):
    """The skin of a foot."""
    chosen = share(weights, ("foot", "toe"), side) > LEAST_SHARE
    return points[chosen], weights[chosen]


def carried(places, speed, turn, rate):
    """Points after the ground has moved for a frame: backwards, and round the root's axis."""
    angle = -np.radians(turn) / rate
    x, y = places[..., 0], places[..., 1]
    moved = [x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle) + speed / rate]
    return np.stack(moved, axis=-1)


def standing(c, side, sign, speed, turn, rate):
    """For each step between two frames: whether the channels let the foot stand meanwhile."""
    plain = lambda name: c(f"foot.{name}{side}") - c.extra.get(f"foot.{name}{side}", 0.0)
    ball = HEADS[INDEX["toe" + side]]
    place = np.stack([ball[0] + sign * plain("out") + plain("x"), ball[1] + plain("y")], axis=1)
    off = np.linalg.norm(place[1:] - carried(place[:-1], speed, turn, rate), axis=1) * rate
    low = plain("z") < STANDING_HEIGHT
    return low[1:] & low[:-1] & (off < STANDING_SPEED)


def settle(c, points, weights, rate, loops, speed=0.0, turn=0.0):
    """Adds to the channels of feet and hands what puts their skin where the channels say.

    `foot.z` and `hand.z` are the height of the lowest skin; a foot that stands does not slide when its
    heel rises.
    """
    feet = {side: foot_skin(points, weights, side) for side, _ in SIDES}
    palms = {}
    for side, _ in SIDES:
        chosen = share(weights, ("hand", "index", "middle", "ring", "thumb"), side) > 0.5
        palms[side] = points[chosen], weights[chosen]
    for _ in range(PASSES):
        poses = motion.posed(c)
        for side, sign in SIDES:
            skin = motion.skinned(*feet[side], poses)
            _add(c, f"foot.z{side}", _plain(c, f"foot.z{side}") - skin[:, :, 2].min(axis=1))
            stands = standing(c, side, sign, speed, turn, rate)
            for axis, drift in zip("xy", _drift(skin, stands, loops, speed, turn, rate).T):
                _add(c, f"foot.{axis}{side}", -drift)
            if f"hand.hold{side}" in c:
                low = motion.skinned(*palms[side], poses)[:, :, 2].min(axis=1)
                hold = c("hand.hold" + side)
                _add(c, f"hand.z{side}", hold * (_plain(c, f"hand.z{side}") - low))


def _plain(c, name):
    return c(name) - c.extra.get(name, 0.0)


def _add(c, name, values):
    c.extra[name] = c.extra.get(name, np.zeros(len(c.times))) + values


def _drift(skin, stands, loops, speed, turn, rate):
    """How far the touching skin has slid at each frame; between two stands it fades out."""
    low = skin[:, :, 2].min(axis=1, keepdims=True)
    touch = np.exp(-(skin[:, :, 2] - low) / TOUCH)
    touch = np.minimum(touch[1:], touch[:-1])[:, :, None]
    slid = skin[1:, :, :2] - carried(skin[:-1, :, :2], speed, turn, rate)
    slid = (touch * slid).sum(axis=1) / touch.sum(axis=1)
    steps, first = len(stands), 0
    if loops and not stands.all():
        first = int(np.flatnonzero(~stands)[0])
    result, now, swing = np.zeros((steps + 1, 2)), np.zeros(2), []
    for n in range(first, first + steps):
        n, after = (n % steps, (n + 1) % steps) if loops else (n, n + 1)
        if stands[n]:
            if swing:
                _fade(result, swing)
                swing, now = [], np.zeros(2)
            now = now + slid[n]
            result[after] = now
        else:
            swing.append((after, now))
    if swing:
        _fade(result, swing)
    if loops:
        result[-1] = result[0]
    elif stands[-1] and not stands.all():
        start = len(stands) - int(np.argmin(stands[::-1]))
        result[start:] -= np.linspace(0.0, 1.0, steps + 1 - start)[:, None] * result[-1]
    elif stands.all():
        result -= np.linspace(0.0, 1.0, steps + 1)[:, None] * result[-1]
    return result


def _fade(result, swing):
    for number, (frame, now) in enumerate(swing, start=1):
        s = number / len(swing)
        result[frame] = now * (1 - s * s * (3 - 2 * s))
