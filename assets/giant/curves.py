"""Channels of keys as smooth functions of time, one moment at a time: for the hero's clips."""

import numpy as np


class Curves:
    """Named channels of keys (time, value), smooth and without overshoot; 0 where there is none."""

    def __init__(self, length, loops, channels):
        self.length, self.loops = length, loops
        self.keys = {name: _with_slopes(sorted(keys), length, loops) for name, keys in channels.items()}

    def __call__(self, name, time):
        if name not in self.keys:
            return 0.0
        times, values, slopes = self.keys[name]
        if self.loops:
            time = times[0] + (time - times[0]) % self.length
        time = min(max(time, times[0]), times[-1])
        index = min(max(int(np.searchsorted(times, time, side="right")) - 1, 0), len(times) - 2)
        step = times[index + 1] - times[index]
        s = (time - times[index]) / step
        return (
            values[index] * (1 + 2 * s) * (1 - s) ** 2
            + slopes[index] * step * s * (1 - s) ** 2
            + values[index + 1] * s * s * (3 - 2 * s)
            + slopes[index + 1] * step * s * s * (s - 1)
        )


def _with_slopes(keys, length, loops):
    """Times, values and monotone slopes (F. Fritsch and R. Carlson, 1980)."""
    if loops:
        keys = [*keys, (keys[0][0] + length, keys[0][1])]
    elif len(keys) == 1:
        keys = [*keys, (keys[0][0] + 1.0, keys[0][1])]
    times, values = (np.array(column, float) for column in zip(*keys))
    rise = np.diff(values) / np.diff(times)
    before, after = (np.roll(rise, 1), rise) if loops else (rise[:-1], rise[1:])
    same = before * after > 0.0
    middle = np.where(same, 2 * before * after / np.where(same, before + after, 1.0), 0.0)
    slopes = np.append(middle, middle[0]) if loops else np.concatenate([[0.0], middle, [0.0]])
    return times, values, slopes
