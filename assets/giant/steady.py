"""Trunks and heads that can be ridden: keys say how a body moves, this softens it where it is too fast.

Where the chest or the head would accelerate more than `rideable.ACTS` allows, the channels that move them
are averaged over a wider time, again and again. Hands and feet that are held or stand stay where they are.
"""

import copy

import numpy as np

from . import motion, rideable
from .skeleton import INDEX

# Channels that move the chest, and those that move the head on it.
TRUNK, HEAD = ("pelvis", "spine", "chest", "swell"), ("neck", "head")
# Each pass averages over at most this time, in seconds, and over no more than REACH of the time to the clip's ends.
WIDTH, REACH, PASSES = 0.5, 0.13, 150
# Passes stop at this share of the limits. Around a moment that is too fast channels are softened for NEAR
# seconds; what is felt lags by LAG seconds.
ROOM, NEAR, LAG = 0.97, 0.35, 0.1
# The share of the way to the average that one pass takes: so much for each unit of excess, and at most.
GAIN, STEP = 3.0, 0.5


def soften(tracks, blows):
    """Softens the channels of a one-shot."""
    dense = copy.copy(tracks)
    # Two ticks a frame: a player interpolates every second one.
    ticks = 2 * len(tracks.times) - 1
    dense.times = np.arange(ticks) * rideable.TICK
    outside = rideable.between_blows(ticks + 2, blows)
    joints, chain = [INDEX["chest"], INDEX["head"]], [INDEX[name] for name in motion.TRUNK]
    for _ in range(PASSES):
        path = motion.trunk(dense).placed(chain)[1][:, joints]
        path[1::2] = (path[:-1:2] + path[2::2]) / 2
        felt = rideable.felt(path, loops=False) * outside[:, None]
        over = felt / (ROOM * np.array(rideable.ACTS)) - 1.0
        if over.max() <= 0.0:
            break
        for parts, excess in ((TRUNK, over.max(axis=1)), (HEAD, over[:, 1])):
            share = _around(np.clip(GAIN * excess, 0.0, STEP), dense)
            for name, values in tracks.tables.items():
                if name.split(".")[0] in parts:
                    tracks.tables[name] = values + share * (_averaged(values, tracks) - values)


def _around(excess, dense):
    """The largest excess nearby, faded, on the channels' grid."""
    reach = round(NEAR / rideable.TICK)
    padded = np.pad(excess, 2 * reach)
    widest = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1).max(axis=1)
    window = np.hanning(2 * reach + 3)[1:-1]
    soft = np.convolve(widest, window / window.sum(), mode="valid")
    return np.interp(dense.grid + LAG, np.arange(len(soft)) * rideable.TICK, soft)


def _averaged(values, tracks):
    """Averages around each moment; near the ends over the time of rest beyond them, lest a start becomes abrupt."""
    before = np.clip(REACH * (tracks.length - tracks.grid), 0.0, WIDTH / 2)
    after = np.clip(REACH * tracks.grid, 0.0, WIDTH / 2)
    total = np.zeros_like(values)
    nodes = np.linspace(-1.0, 1.0, 17)[1:-1]
    weights = 1.0 - nodes * nodes
    for node, weight in zip(nodes, weights / weights.sum()):
        total += weight * np.interp(tracks.grid + node * np.where(node < 0.0, before, after), tracks.grid, values)
    return total
