"""All clips: their tables, sampled to poses, with markers and with what equipment they show."""

from dataclasses import dataclass, field

import numpy as np

from . import air, climbing, ground, locomotion, weapons
from .motion import Channels, posed
from .skeleton import GEAR, INDEX

# Keys a second, at least.
RATE = 30
# What is seen if a clip does not say otherwise.
AT_REST = ("scabbard", "sword_sheathed", "bow_back", "quiver")


@dataclass
class Clip:
    """Poses at even times, and what a game must know of them."""

    name: str
    loops: bool
    length: float
    poses: list
    markers: list
    # Ground speed in m/s along +Z and +X, and turn to the left in degrees per second, for locomotion.
    travel: tuple = (0.0, 0.0, 0.0)
    # Which feet stand at which times: (side, start, end) in seconds; for the checks.
    stands: list = field(default_factory=list)

    # Joints whose scale says whether they are seen.
    seen_by_scale = GEAR

    @property
    def times(self):
        """When the poses are, in seconds."""
        return np.linspace(0.0, self.length, len(self.poses))

    @property
    def speed(self):
        """The ground's speed, or None if the clip does not travel."""
        return float(np.hypot(*self.travel[:2])) or None


def all_clips():
    """Every clip, in the order of the file."""
    tables = {}
    for module in (locomotion, air, climbing, ground, weapons):
        tables |= module.TABLES
    return [_sampled(name, make()) for name, make in tables.items()]


def _sampled(name, made):
    """Poses of a clip from its table: (length, loops, channels, extras)."""
    length, loops, table, more = made
    channels = Channels(length, loops, table)
    frames = int(np.ceil(length * RATE - 1e-6))
    poses = []
    for frame in range(frames + 1):
        time = length * (frame % frames if loops else frame) / frames
        pose = posed(channels, time)
        _show(pose, time, more.get("shown", [(0.0, AT_REST)]))
        poses.append(pose)
    markers = [{"name": marker, "time": round(time, 4)} for time, marker in sorted(more.get("markers", ()))]
    return Clip(name, loops, length, poses, markers, more.get("travel", (0.0, 0.0, 0.0)), more.get("stands", []))


def _show(pose, time, shown):
    """Sets the scales of the equipment: 1 for what is seen from a time on, else 0."""
    seen = [pieces for start, pieces in shown if start <= time + 1e-9][-1]
    for name in GEAR:
        pose.scale[INDEX[name]] = float(name in seen or name == "bow_string")
