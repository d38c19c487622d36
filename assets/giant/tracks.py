"""Channels of keys as smooth functions of time, for all frames of a clip at once.

A key is (time, value), or (time, value, HIT) for one that is reached at speed and left from rest: a
foot that slams down. A channel may also be a function of an array of times, or a tuple of such parts,
which are added. One-shots start from what the channels of another clip, `base`, are at its first
moment: all values count from there.
"""

import numpy as np

HIT = "hit"
# Samples a second of the smoothed channels, and how long before a clip's start they begin (the lags
# of `motion.py` look back).
GRID = 600
BEFORE = 1.0
# How much faster than on average a channel arrives at a HIT.
ARRIVAL = 1.9
# Around a HIT and around blows nothing is smoothed, for this long; and how long that fades, seconds.
SHARP, FADE = 0.05, 0.3


class Tracks:
    """Named channels at `times`; 0 where there is none. `extra` holds additions for each frame."""

    def __init__(self, length, loops, channels, times, base=None, softness=(0.0, 0.0, 0.0), blows=()):
        self.times, self.base, self.extra = np.asarray(times, float), base, {}
        self.grid = np.arange(-BEFORE * GRID, length * GRID + 1) / GRID
        self.tables = {}
        for name, channel in channels.items():
            self.tables[name] = np.zeros(len(self.grid))
            for keys in channel if isinstance(channel, tuple) else (channel,):
                values = _values(keys, self.grid, length, loops)
                if not loops and not callable(keys):
                    hits = [*blows, *(key[0] for key in keys if len(key) > 2)]
                    values = _smoothed(values, self.grid, softness, hits)
                self.tables[name] += values

    def __contains__(self, name):
        return name in self.tables

    def __call__(self, name, lag=0.0):
        result = np.zeros(len(self.times))
        if name in self.tables:
            result = np.interp(self.times - lag, self.grid, self.tables[name])
        if self.base is not None and name in self.base:
            start = self.tables[name][0] if name in self.tables else 0.0
            result = result + np.interp(-lag, self.base.grid, self.base.tables[name]) - start
        if lag == 0.0 and name in self.extra:
            result = result + self.extra[name]
        return result


def _values(keys, grid, length, loops):
    """A channel on the grid: cubic between keys, without overshoot (F. Fritsch and R. Carlson, 1980)."""
    if callable(keys):
        return keys(grid)
    keys = sorted(keys, key=lambda key: key[0])
    hits = np.array([len(key) > 2 for key in keys])
    times, values = np.array([key[0] for key in keys], float), np.array([key[1] for key in keys], float)
    if loops:
        times, values, hits = np.append(times, times[0] + length), np.append(values, values[0]), np.append(hits, hits[0])
        grid = times[0] + (grid - times[0]) % length
    elif len(times) == 1:
        return np.full(len(grid), values[0])
    before, after = _slopes(times, values, hits, loops)
    grid = np.clip(grid, times[0], times[-1])
    index = np.clip(np.searchsorted(times, grid, side="right") - 1, 0, len(times) - 2)
    step = np.diff(times)[index]
    s = (grid - times[index]) / step
    return (
        values[index] * (1 + 2 * s) * (1 - s) ** 2
        + after[index] * step * s * (1 - s) ** 2
        + values[index + 1] * s * s * (3 - 2 * s)
        + before[index + 1] * step * s * s * (s - 1)
    )


def _slopes(times, values, hits, loops):
    """Slopes with which each key is reached and left."""
    rise = np.diff(values) / np.diff(times)
    before, after = (np.roll(rise, 1), rise) if loops else (rise[:-1], rise[1:])
    same = before * after > 0.0
    middle = np.where(same, 2 * before * after / np.where(same, before + after, 1.0), 0.0)
    slopes = np.append(middle, middle[0]) if loops else np.concatenate([[0.0], middle, [0.0]])
    reached = np.where(hits, ARRIVAL * np.concatenate([[0.0], rise]), slopes)
    return reached, np.where(hits, 0.0, slopes)


def _smoothed(values, grid, softness, hits):
    """Rounds off how a one-shot's channels start to move: widths early and late, and when they change."""
    early, late, change = softness
    share = np.clip((change + FADE / 2 - grid) / FADE, 0.0, 1.0)
    share = share * share * (3 - 2 * share)
    result = share * _rounded(values, early) + (1 - share) * _rounded(values, late)
    for hit in hits:
        keep = np.clip((np.abs(grid - hit) - SHARP) / FADE, 0.0, 1.0)
        keep = keep * keep * (3 - 2 * keep)
        result = keep * result + (1 - keep) * values
    return result


def _rounded(values, width):
    """Averages over a window of `width` seconds, most in its middle."""
    half = round(width * GRID / 2)
    if half < 1:
        return values
    window = np.hanning(2 * half + 3)[1:-1]
    padded = np.pad(values, half, mode="edge")
    return np.convolve(padded, window / window.sum(), mode="valid")
