"""What the tables of keys are made of."""

from dataclasses import dataclass, field

import numpy as np

from ..tracks import HIT  # noqa: F401

# Keys for one period of a wave.
WAVE_KEYS = 16
# Channels that change sign in a mirror, without the side.
_FLIPPED = ("pelvis.x", "loin.side", "foot.x", "foot.yaw", "foot.roll")


@dataclass
class Table:
    """A clip's channels (see `clips/__init__.py`) and what its user has to know."""

    length: float
    channels: dict
    loops: bool = False
    # (name, seconds)
    markers: list = field(default_factory=list)
    # The ground under it: metres a second backwards, degrees a second to the left.
    speed: float | None = None
    turn: float = 0.0
    # Whether it begins in the idle's first pose (not in the rest pose).
    from_idle: bool = True
    # Whether feet and hands are settled on the ground by their skin.
    settles: bool = True
    # Whether knees and trunk may touch the ground; they are held up where they would sink into it.
    kneels: bool = False

    def __post_init__(self):
        self.markers = sorted(self.markers, key=lambda marker: marker[1])

    @property
    def blows(self):
        """Seconds of the impacts."""
        return [time for name, time in self.markers if name == "impact"]


def both(name, keys):
    """The same keys for both sides."""
    return {f"{name}.L": keys, f"{name}.R": keys}


def wave(length, size, count=1, late=0.0, rest=0.0):
    """Keys of a sine of `count` periods in a clip, its first peak at a quarter plus `late` periods."""
    step = length / count / WAVE_KEYS
    return [(i * step, rest + size * np.sin(2 * np.pi * (i / WAVE_KEYS - late))) for i in range(WAVE_KEYS * count)]


def burst(start, end, size, rate, late=0.0, grow=0.6, fall=0.8):
    """A sine of `rate` periods a second between two moments; it grows, then falls."""
    def values(times):
        up, down = np.clip((times - start) / grow, 0.0, 1.0), np.clip((end - times) / fall, 0.0, 1.0)
        envelope = (up * up * (3 - 2 * up)) * (down * down * (3 - 2 * down))
        return size * envelope * np.sin(2 * np.pi * (rate * (times - start) - late))

    return values


def arc(side, path):
    """Keys for the place of a held wrist from (time, bearing, distance): degrees outwards from the front, metres from the root."""
    angle = [(time, np.radians(bearing), distance) for time, bearing, distance in path]
    return {
        f"hand.x.{side}": [(time, distance * np.sin(bearing)) for time, bearing, distance in angle],
        f"hand.y.{side}": [(time, -distance * np.cos(bearing)) for time, bearing, distance in angle],
    }


def strike(active, recovery, *impacts):
    """Markers of an attack."""
    return [("wind_up", 0.0), ("active", active), ("recovery", recovery), *(("impact", time) for time in impacts)]


def mirrored(table):
    """The same clip with left and right exchanged."""
    channels = {}
    for name, keys in table.channels.items():
        base, side = (name[:-2], name[-2:]) if name[-2:] in (".L", ".R") else (name, "")
        flips = base in _FLIPPED or (not side and base.endswith((".yaw", ".roll")))
        other = base + {".L": ".R", ".R": ".L", "": ""}[side]
        channels[other] = _negated(keys) if flips else keys
    words = {"step_left": "step_right", "step_right": "step_left"}
    markers = [(words.get(name, name), time) for name, time in table.markers]
    return Table(table.length, channels, table.loops, markers, table.speed, -table.turn,
                 table.from_idle, table.settles, table.kneels)


def _negated(keys):
    if isinstance(keys, tuple):
        return tuple(_negated(part) for part in keys)
    if callable(keys):
        return lambda times: -keys(times)
    return [(key[0], -key[1], *key[2:]) for key in keys]
