"""What blows reach: how long they threaten, how low a hand or a foot passes, and whom it hits on which arc."""

import numpy as np

from . import motion, soles
from .clips import RATE
from .skeleton import INDEX

HAND = ("hand", "index", "middle", "ring", "thumb")
FOOT = ("foot", "toe")
# What hits together with them.
BESIDE = {HAND: ("forearm",), FOOT: ("shin",)}
# A person's height and radius, in metres.
PERSON, PERSON_RADIUS = 1.75, 0.3
# Persons are placed at these bearings (degrees) and distances around the root, in rings so wide (metres).
BEARINGS, RINGS = np.arange(-178.0, 180.0, 2.0), np.arange(5.5, 20.0, 1.0)


def markers(clip):
    """Seconds of each marker; of the first one, if a name occurs twice."""
    return dict(reversed(clip.table.markers))


def lowest(clip, points, weights, limb, side):
    """Heights of the lowest skin of a hand or a foot in all frames."""
    chosen = soles.share(weights, limb, side) > 0.5
    return motion.skinned(points[chosen], weights[chosen], clip.poses)[:, :, 2].min(axis=1)


def window(clip):
    """The frames of the active window."""
    time = markers(clip)
    return slice(round(time["active"] * RATE), round(time["recovery"] * RATE) + 1)


def arc(clip, limb, side, points, weights):
    """The widest arc on which the active window hits everybody: degrees, and its distance from the root."""
    chosen = soles.share(weights, limb + BESIDE[limb], side) > 0.5
    part = clip.poses.part(window(clip))
    skin = [motion.skinned(points[chosen], weights[chosen], poses).reshape(-1, 3) for poses in (part, motion.halfway(part))]
    skin = np.concatenate(skin)
    skin = skin[skin[:, 2] < PERSON]
    distance, bearing = np.hypot(skin[:, 0], skin[:, 1]), np.degrees(np.arctan2(skin[:, 0], -skin[:, 1]))
    best = (0.0, 0.0)
    for ring in RINGS:
        there = bearing[np.abs(distance - ring) < PERSON_RADIUS]
        gap = np.abs((BEARINGS[:, None] - there + 180.0) % 360.0 - 180.0)
        hit = (gap < np.degrees(PERSON_RADIUS / ring)).any(axis=1)
        longest = max(len(run) for run in "".join("x" if one else " " for one in hit).split(" "))
        best = max(best, (2.0 * longest, ring))
    return best


def head_turn(clip, time):
    """How far the head is turned to the side, in degrees."""
    frame = round(time * RATE)
    turn, _ = clip.poses.part(slice(frame, frame + 1)).placed()
    facing = turn[0, INDEX["head"]] @ np.array([0.0, -1.0, 0.0])
    return abs(np.degrees(np.arctan2(facing[0], -facing[1])))
