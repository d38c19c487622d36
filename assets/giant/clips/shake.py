"""Shaking riders off: shoulders, the whole body, the head, an arm, and a rage.

A rider is thrown off where the skin accelerates, and the spot next to it should hold: what is shaken turns
about an axis close to the weak point, and nothing else moves that point fast. So the trunk twists and
neither rolls nor nods, the head turns about its own joint, and an arm shakes from the elbow on.
"""

from .keys import Table, both, burst, strike, wave

# Periods a second of a twist of the whole body.
TWIST_RATE = 1.6
# A twist's channels: degrees, periods by which each is late, and seconds by which its growth is late. The
# trunk twists; neck and arms turn against it as much as keeps the head and the forearms still in space, where
# other riders sit. The hands flap. Arms have opposite signs on both sides.
TWIST = {
    "pelvis.yaw": (2.0, 0.0, 0.0), "spine.yaw": (10.9, 0.0, 0.0),
    "neck.yaw": (-18.5, -0.02, -0.03), "neck.roll": (-5.3, -0.05, -0.03),
    "head.yaw": (6.0, 0.1, -0.09), "head.roll": (1.8, -0.05, -0.09), "jaw": (5.0, 0.2, 0.0), "loin.side": (11.0, 0.15, 0.0),
    "shoulder.forward": (9.6, 0.0, 0.075), "arm.swing": (3.4, -0.1, 0.075), "arm.out": (-0.75, 0.0, 0.075),
    "forearm.in": (4.8, -0.1, 0.0), "wrist": (10.0, 0.4, 0.0), "curl": (8.0, 0.3, 0.0),
}
_ARMS = ("shoulder", "arm", "forearm", "wrist", "curl")


def twist(wave_of, keys):
    """Adds a twist to a clip's keys; `wave_of(size, late, seconds)` makes the waves."""
    result = dict(keys)
    for name, (size, late, seconds) in TWIST.items():
        sides = ((".L", 1.0), (".R", -1.0)) if name.split(".")[0] in _ARMS else (("", 1.0),)
        for side, sign in sides:
            part = wave_of(sign * size, late, seconds)
            result[name + side] = (*_parts(keys.get(name + side)), part)
    return result


def _parts(channel):
    return channel if isinstance(channel, tuple) else () if channel is None else (channel,)


def shake_loop():
    """The whole body shakes, without beginning and end."""
    t, fast, share = 2.6, 4, 0.75
    return Table(t, twist(lambda size, late, seconds: wave(t, share * size, fast, late + seconds * fast / t), {
        "pelvis.z": [(0, -0.9)], "pelvis.y": [(0, 0.3)], "pelvis.pitch": [(0, 2.0)], "spine.pitch": [(0, 1.0)],
        "neck.pitch": [(0, 4.0)], "head.pitch": [(0, 1.0)], "jaw": [(0, 14.0)],
        **both("arm.swing", [(0, 5.0)]), **both("arm.out", [(0, 12.0)]), **both("elbow", [(0, 18.0)]), **both("curl", [(0, 20.0)]),
        "loin": [(0, -2.0)], "loin.front": [(0, -6.0)], **both("foot.out", [(0, 0.7)]),
    }), loops=True)


def shrug():
    """Rolls its shoulders: a mild shake of the upper back. The arms hang still below."""
    t, start, end = 2.8, 0.8, 2.0
    roll = lambda size, late, seconds=0.0: burst(start - 0.15 + seconds, end + 0.15 + seconds, size, TWIST_RATE, late, 0.5, 0.5)
    lifted = [(0, 0), (0.9, 6.4), (1.7, 5.6), (t, 0)]
    return Table(t, twist(lambda size, late, seconds: roll(0.38 * size, late, seconds), {
        "pelvis.z": [(0, 0), (0.9, -0.3), (1.9, -0.25), (t, 0)], "spine.pitch": [(0, 0), (1.0, 2), (1.8, 1.5), (t, 0)],
        "neck.pitch": [(0, 0), (1.0, 3), (1.7, 3), (t, 0)], "head.pitch": [(0, 0), (1.0, 5), (1.7, 4), (t, 0)], "jaw": [(0, 0), (1.1, 5), (t, 0)],
        "shoulder.lift.L": (lifted, roll(4.0, 0.0)), "shoulder.lift.R": (lifted, roll(-4.0, 0.0)),
        "arm.out.L": roll(-4.0, 0.0), "arm.out.R": roll(4.0, 0.0),
        **both("elbow", [(0, 0), (1.0, 9), (1.8, 8), (t, 0)]), **both("curl", [(0, 0), (1.0, 10), (t, 0)]),
    }), markers=strike(start, end))


def shake():
    """Crouches and breathes in, then twists the whole body to and fro like a wet dog; head and arms stay behind."""
    t, start, end = 4.5, 1.27, 3.17
    rattle = lambda size, late, seconds: burst(start - 0.1 + seconds, end + 0.1 + seconds, 1.18 * size, TWIST_RATE, late, 0.8, 0.9)
    return Table(t, twist(rattle, {
        "pelvis.z": [(0, 0), (1.6, -0.9), (2.9, -0.9), (t, 0)], "pelvis.pitch": [(0, 0), (1.5, 2), (3.0, 2), (t, 0)],
        "spine.pitch": [(0, 0), (1.5, -2), (3.0, -2), (t, 0)], "breath": [(0, 0), (1.07, 4), (1.87, 0), (3.07, -1.5), (t, 0)],
        "neck.pitch": [(0, 0), (1.5, 5), (2.9, 4), (t, 0)], "head.pitch": [(0, 0), (1.4, 5), (2.9, 3), (t, 0)],
        "jaw": [(0, 0), (1.9, 14), (2.97, 12), (t, 0)],
        **both("arm.swing", [(0, 0), (2.1, 4), (2.9, 4), (t, 0)]), **both("arm.out", [(0, 0), (2.0, 10), (2.9, 10), (t, 0)]),
        **both("elbow", [(0, 0), (2.0, 14), (2.9, 14), (t, 0)]), **both("curl", [(0, 0), (1.2, 18), (3.07, 16), (t, 0)]),
        "loin.front": [(0, 0), (1.17, -6), (3.07, -6), (t, 0)],
    }), markers=strike(start, end))


def shake_head():
    """Lowers its head, then throws it from side to side; shoulders and jaw follow."""
    t, start, end = 3.8, 1.0, 2.7
    rattle = lambda size, late=0.0: burst(start - 0.1, end + 0.1, size, 1.7, late, 0.6, 0.7)
    return Table(t, {
        "pelvis.z": [(0, 0), (1.2, -0.3), (2.6, -0.3), (t, 0)],
        "neck.pitch": [(0, 0), (1.2, 7), (2.6, 6), (t, 0)], "head.yaw": rattle(16.0), "head.pitch": [(0, 0), (1.2, 3), (2.6, 3), (t, 0)],
        "jaw": ([(0, 0), (0.9, 2), (1.6, 12), (2.5, 10), (t, 0)], rattle(6.0, 0.3)),
        "shoulder.lift.L": ([(0, 0), (1.0, 6), (2.5, 5), (t, 0)], rattle(3.0, 0.2)), "shoulder.lift.R": ([(0, 0), (1.0, 6), (2.5, 5), (t, 0)], rattle(-3.0, 0.2)),
        "shoulder.forward.L": rattle(4.0, 0.1), "shoulder.forward.R": rattle(-4.0, 0.1),
        **both("arm.out", [(0, 0), (1.2, 10), (2.6, 9), (t, 0)]), **both("elbow", ([(0, 0), (1.2, 16), (2.6, 14), (t, 0)], rattle(3.0, 0.3))),
        **both("curl", [(0, 0), (1.2, 14), (2.6, 12), (t, 0)]),
    }, markers=strike(start, end))


def shake_arm_left():
    """Raises the left forearm, looks at it, and flings the hand to and fro."""
    t, start, end = 5.2, 1.6, 3.2
    fling = lambda size, late=0.0: burst(start - 0.1, end + 0.1, size, 1.7, late, 0.6, 0.7)
    return Table(t, {
        "pelvis.z": [(0, 0), (1.6, -0.4), (3.3, -0.4), (t, 0)],
        "neck.yaw": [(0, 0), (1.2, 14), (3.0, 12), (t, 0)], "head.yaw": ([(0, 0), (1.1, 18), (3.0, 16), (t, 0)], fling(3.0, 0.3)),
        "neck.pitch": [(0, 0), (1.3, 6), (3.0, 5), (t, 0)], "head.pitch": [(0, 0), (1.3, 10), (3.0, 7), (t, 0)], "jaw": [(0, 0), (2.2, 10), (t, 0)],
        "arm.swing.L": [(0, 0), (1.9, 8), (3.3, 8), (t, 0)], "arm.out.L": [(0, 0), (1.9, 11), (3.3, 11), (t, 0)],
        "elbow.L": ([(0, 0), (1.7, 44), (3.3, 40), (t, 0)], fling(9.0)), "forearm.in.L": fling(4.0, 0.2),
        "wrist.L": ([(0, 0), (1.5, 14), (3.2, 4), (t, 0)], fling(24.0, 0.2)), "curl.L": ([(0, 0), (1.5, 34), (2.2, 6), (3.2, 8), (t, 0)], fling(16.0, 0.3)),
        "arm.swing.R": [(0, 0), (1.6, -6), (3.2, -6), (t, 0)], "arm.out.R": [(0, 0), (1.6, 12), (3.2, 12), (t, 0)], "elbow.R": [(0, 0), (1.6, 18), (3.2, 18), (t, 0)],
        "shoulder.lift.R": [(0, 0), (1.6, 5), (3.2, 4), (t, 0)],
    }, markers=strike(start, end))


def rage():
    """Twists to and fro with all it has, roars with raised fists, and calms down."""
    t, start, end = 9.0, 1.3, 5.8
    rattle = lambda size, late, seconds: burst(1.2 + seconds, 3.2 + seconds, 0.98 * size, TWIST_RATE, late, 0.7, 0.7)
    tremble = lambda size, late=0.0: burst(4.5, 6.1, size, 4.0, late, 0.5, 0.6)
    return Table(t, twist(rattle, {
        "pelvis.z": [(0, 0), (1.8, -0.9), (3.1, -1.0), (5.0, -0.2), (5.8, -0.3), (t, 0)],
        "pelvis.pitch": [(0, 0), (1.7, 2), (3.1, 2), (4.9, 0), (5.6, 0), (t, 0)],
        "spine.pitch": [(0, 0), (1.7, -1), (3.1, 1), (5.0, -5), (5.8, -4), (t, 0)],
        "breath": [(0, 0), (1.2, 3), (2.0, 0), (3.6, 4), (4.6, 4), (5.8, -2), (t, 0)],
        "neck.pitch": [(0, 0), (1.6, 4), (3.0, 5), (5.0, -13), (5.8, -12), (t, 0)],
        "head.pitch": [(0, 0), (1.5, 3), (3.0, 5), (4.9, -16), (5.7, -13), (7.3, 2), (t, 0)],
        "jaw": [(0, 0), (1.9, 16), (3.3, 4), (4.7, 31), (5.8, 30), (6.6, 8), (t, 0)],
        **both("arm.swing", [(0, 0), (3.1, 3), (5.1, 4), (5.8, 4), (t, 0)]), **both("arm.out", [(0, 0), (2.0, 5), (2.9, 6), (5.3, 21), (6.0, 21), (t, 0)]),
        **both("elbow", [(0, 0), (2.0, 8), (3.0, 14), (5.2, 68), (5.9, 70), (7.8, 18), (t, 0)]),
        **both("curl", [(0, 0), (1.5, 28), (3.1, 36), (4.7, 6), (5.8, 24), (6.8, 16), (t, 0)]),
        **both("shoulder.forward", [(0, 0), (3.1, 3), (5.2, -4), (5.9, -4), (t, 0)]), **both("shoulder.lift", [(0, 0), (3.1, 2), (5.2, 5), (5.9, 5), (t, 0)]),
        "head.yaw": tremble(2.0), "loin": [(0, 0), (3.3, 0), (4.9, 5), (5.8, -3), (t, 0)],
        "loin.front": [(0, 0), (1.4, -8), (3.1, -8), (4.9, -2), (t, 0)],
    }), markers=strike(start, end))
