"""Channels of keys as smooth functions of time, for all frames of a clip at once.

A key is (time, value), or (time, value, HIT) for one that is reached at speed and left from rest: a
foot that slams down. A channel may also be a function of an array of times, or a tuple of such parts,
which are added. One-shots start from the first values of another clip's channels, `base`: their keys
count from there.
"""

import numpy as np

HIT = "hit"
# Samples a second of the smoothed channels, and how long before a clip's start they begin (the lags
# of `motion.py` look back).
GRID = 600
BEFORE = 1.0
# How much faster than on average a channel arrives at a HIT.
ARRIVAL = 1.9
# Corners of one-shots are averaged over this time; not around a HIT, a blow, the start and the end, for
# so long, and how long that fades; seconds.
SOFTNESS, SHARP, FADE = 0.16, 0.05, 0.2
# Seconds at the end of a one-shot in which what lags catches up.
CATCH_UP = 0.6
# A giant never starts abruptly. A channel that leaves its rest first grows exponentially with the rate
# GROWTH (per second), then follows a cubic. The faster it must become, the longer it grows: FIRST_SPEED
# (metres a second) is about what it starts with. The growth takes between these shares of the time to the
# next key. Larger shares end more abruptly; smaller ones break the limit that `check.py` sets for starts.
GROWTH, FIRST_SPEED, LEAST_GROWING, MOST_GROWING = 10.0, 0.008, 0.25, 0.75
# A channel counts as resting before a key if it is slower there than this share of its speed after it.
DRIFT = 0.08
# How far a degree takes the end of what it turns, in metres. A hand that is held moves already.
LEVERS = {
    "pelvis": 0.35, "spine": 0.35, "chest": 0.25, "neck": 0.12, "head": 0.08, "jaw": 0.05, "arm": 0.35, "elbow": 0.25,
    "forearm": 0.25, "wrist": 0.12, "curl": 0.06, "shoulder": 0.3, "breath": 0.1, "swell": 0.1, "loin": 0.1, "foot": 0.06,
    "hand": 0.0,
}


class Tracks:
    """Named channels at `times`; 0 where there is none. `extra` holds additions for each frame."""

    def __init__(self, length, loops, channels, times, base=None, blows=()):
        self.times, self.length, self.loops = np.asarray(times, float), length, loops
        self.base, self.extra = base, {}
        self.grid = np.arange(-BEFORE * GRID, length * GRID + 1) / GRID
        self.tables = {}
        for name, channel in channels.items():
            self.tables[name] = np.zeros(len(self.grid))
            for keys in channel if isinstance(channel, tuple) else (channel,):
                self.tables[name] += self._table(name, keys, blows)

    def _table(self, name, keys, blows):
        if callable(keys):
            return keys(self.grid)
        if self.loops:
            # Only feet rest in a loop; the rest of the body never stops.
            return _values(keys, self.grid, _lever(name) if name.startswith("foot") else None, self.length)
        values = _values(keys, self.grid, _lever(name))
        hits = [0.0, self.length, *blows, *(key[0] for key in keys if len(key) > 2)]
        return _smoothed(values, self.grid, hits)

    def __contains__(self, name):
        return name in self.tables

    def __call__(self, name, lag=0.0):
        result = np.zeros(len(self.times))
        if name in self.tables:
            result = np.interp(self.times - self._lags(lag), self.grid, self.tables[name])
        if self.base is not None and name in self.base:
            start = self.tables[name][0] if name in self.tables else 0.0
            result = result + np.interp(-lag, self.base.grid, self.base.tables[name]) - start
        if lag == 0.0 and name in self.extra:
            result = result + self.extra[name]
        return result

    def _lags(self, lag):
        """The lag at each time; it fades at the end of a one-shot, which arrives with all its parts."""
        if self.loops:
            return lag
        return lag * eased((self.length - self.times) / CATCH_UP)


def _lever(name):
    """Metres by which a unit of a channel moves the end of what it moves."""
    base, *kinds = name.removesuffix(".L").removesuffix(".R").split(".")
    is_place = base in ("pelvis", "foot") and kinds[0] in ("x", "y", "z", "out")
    return 1.0 if is_place else LEVERS[base]


def _values(keys, grid, lever, cycle=None):
    """A channel on the grid: cubic between keys, without overshoot (F. Fritsch and R. Carlson, 1980)."""
    keys = sorted(keys, key=lambda key: key[0])
    hits = np.array([len(key) > 2 for key in keys])
    times, values = np.array([key[0] for key in keys], float), np.array([key[1] for key in keys], float)
    if cycle:
        times, values, hits = np.append(times, times[0] + cycle), np.append(values, values[0]), np.append(hits, hits[0])
        grid = times[0] + (grid - times[0]) % cycle
    elif len(times) == 1:
        return np.full(len(grid), values[0])
    before, after = _slopes(times, values, hits, cycle)
    grid = np.clip(grid, times[0], times[-1])
    index = np.clip(np.searchsorted(times, grid, side="right") - 1, 0, len(times) - 2)
    result = _cubic(grid, times[index], times[index + 1], values[index], values[index + 1], after[index], before[index + 1])
    if lever is None:
        return result
    speed = np.abs(np.diff(values) / np.diff(times))
    earlier = np.roll(speed, 1) if cycle else np.append(0.0, speed[:-1])
    for number in np.flatnonzero((earlier <= DRIFT * speed) | hits[:-1]):
        there = index == number
        part = (times[number], times[number + 1], values[number + 1] - values[number], before[number + 1])
        result[there] = values[number] + _departed(grid[there], *part, lever)
    return result


def _cubic(time, start, end, first, last, leaves, arrives):
    """Cubics with given values and slopes at both ends."""
    step = end - start
    s = (time - start) / step
    return (
        first * (1 + 2 * s) * (1 - s) ** 2
        + leaves * step * s * (1 - s) ** 2
        + last * s * s * (3 - 2 * s)
        + arrives * step * s * s * (s - 1)
    )


def _departed(time, start, end, rise, arrives, lever):
    """From rest to `rise`: exponential growth, then a cubic that goes on with the same acceleration."""
    fast = abs(rise) * lever / (end - start) / FIRST_SPEED
    grows = np.clip(np.log(max(fast, 1.0)) / GROWTH, LEAST_GROWING * (end - start), MOST_GROWING * (end - start))
    rest = GROWTH * (end - start - grows)
    share = 6.0 / (rest * rest + 4.0 * rest + 6.0)
    size = share * rise / (np.exp(GROWTH * grows) - 1.0 - GROWTH * grows)
    turn = start + grows
    slope = size * GROWTH * (np.exp(GROWTH * grows) - 1.0)
    since = GROWTH * np.minimum(time - start, grows)
    later = _cubic(np.maximum(time, turn), turn, end, share * rise, rise, slope, arrives)
    return np.where(time < turn, size * (np.exp(since) - 1.0 - since), later)


def _slopes(times, values, hits, loops):
    """Slopes with which each key is reached and left."""
    rise = np.diff(values) / np.diff(times)
    before, after = (np.roll(rise, 1), rise) if loops else (rise[:-1], rise[1:])
    same = before * after > 0.0
    middle = np.where(same, 2 * before * after / np.where(same, before + after, 1.0), 0.0)
    slopes = np.append(middle, middle[0]) if loops else np.concatenate([[0.0], middle, [0.0]])
    reached = np.where(hits, ARRIVAL * np.concatenate([[0.0], rise]), slopes)
    return reached, np.where(hits, 0.0, slopes)


def _smoothed(values, grid, hits):
    """Rounds off corners of a one-shot's channels, but not near the hits."""
    result = _rounded(values, SOFTNESS)
    for hit in hits:
        keep = eased((np.abs(grid - hit) - SHARP) / FADE)
        result = keep * result + (1 - keep) * values
    return result


def eased(share):
    """From 0 to 1, smoothly."""
    share = np.clip(share, 0.0, 1.0)
    return share * share * (3 - 2 * share)


def _rounded(values, width):
    """Averages over a window of `width` seconds, most in its middle."""
    half = round(width * GRID / 2)
    if half < 1:
        return values
    window = np.hanning(2 * half + 3)[1:-1]
    padded = np.pad(values, half, mode="edge")
    return np.convolve(padded, window / window.sum(), mode="valid")
