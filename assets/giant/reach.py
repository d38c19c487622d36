"""What blows reach: how long they threaten, how low a hand or a foot passes, and over which arc."""

import numpy as np

from . import motion, soles
from .clips import RATE
from .skeleton import INDEX

HAND = ("hand", "index", "middle", "ring", "thumb")
FOOT = ("foot", "toe")
# A person stands this high, in metres: what is lower hits them.
PERSON = 1.8


def markers(clip):
    """Seconds of each marker; of the first one, if a name occurs twice."""
    return dict(reversed(clip.table.markers))


def lowest(clip, points, weights, limb, side):
    """Heights of the lowest skin of a hand or a foot in all frames, and its centre's places."""
    chosen = soles.share(weights, limb, side) > 0.5
    skin = motion.skinned(points[chosen], weights[chosen], clip.poses)
    return skin[:, :, 2].min(axis=1), skin.mean(axis=1)


def active(clip, limb, side, points, weights):
    """How low the limb passes in the active window, and over how many degrees around the root it is low."""
    low, centre = lowest(clip, points, weights, limb, side)
    time = markers(clip)
    window = slice(round(time["active"] * RATE), round(time["recovery"] * RATE) + 1)
    hits = low[window] < PERSON
    bearing = np.unwrap(np.arctan2(centre[window, 0], -centre[window, 1]))[hits]
    return low[window].min(), np.degrees(np.ptp(bearing)) if hits.any() else 0.0


def head_turn(clip, time):
    """How far the head is turned to the side, in degrees."""
    frame = round(time * RATE)
    turn, _ = clip.poses.part(slice(frame, frame + 1)).placed()
    facing = turn[0, INDEX["head"]] @ np.array([0.0, -1.0, 0.0])
    return abs(np.degrees(np.arctan2(facing[0], -facing[1])))
