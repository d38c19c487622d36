"""Shaking riders off: shoulders, the whole body, the head, an arm, and a rage.

A rider is thrown off where the skin accelerates, and the spot next to it should hold: what is shaken turns
about an axis close to the weak point, and nothing else moves that point fast. So the trunk twists and
neither rolls nor nods, the head turns about its own joint, and an arm shakes from the elbow on.
"""

from .keys import Table, both, burst, strike, wave


def shake_loop():
    """The whole body shakes, without beginning and end."""
    t, fast = 2.6, 4
    return Table(t, {
        "pelvis.z": [(0, -1.0)], "pelvis.y": [(0, 0.3)], "pelvis.pitch": [(0, 2.0)], "pelvis.yaw": wave(t, 2.4, fast),
        "spine.pitch": [(0, 1.0)], "spine.yaw": wave(t, 7.8, fast, 0.02),
        "neck.yaw": wave(t, 7.0, fast, 0.10), "neck.pitch": wave(t, 2.0, 2, 0.2, 4.0), "neck.roll": wave(t, 5.0, fast, 0.2),
        "head.yaw": wave(t, 14.0, fast, 0.14), "head.roll": wave(t, 10.0, fast, 0.25), "head.pitch": wave(t, 3.0, 2, 0.1, -2.0),
        "jaw": wave(t, 6.0, fast, 0.2, 14.0),
        "arm.swing.L": wave(t, 12.0, fast, 0.22, 6.0), "arm.swing.R": wave(t, -12.0, fast, 0.22, 6.0),
        **both("arm.out", wave(t, 4.0, fast, 0.2, 18.0)), **both("elbow", wave(t, 9.0, fast, 0.3, 30.0)),
        **both("curl", wave(t, 8.0, 2, 0.2, 26.0)), **both("wrist", wave(t, 7.0, fast, 0.4)),
        "shoulder.lift.L": wave(t, 2.5, fast, 0.2, 4.0), "shoulder.lift.R": wave(t, -2.5, fast, 0.2, 4.0),
        "loin": [(0, -2.0)], "loin.front": [(0, -6.0)], "loin.side": wave(t, -9.0, fast, 0.05),
        **both("foot.out", [(0, 0.7)]),
    }, loops=True)


def shrug():
    """Rolls its shoulders: a mild shake of the upper back."""
    t, start, end = 2.8, 0.8, 2.0
    roll = lambda size, late=0.0: burst(start - 0.15, end + 0.15, size, 1.6, late, 0.5, 0.5)
    return Table(t, {
        "pelvis.z": [(0, 0), (0.9, -0.3), (1.9, -0.25), (t, 0)],
        "spine.pitch": [(0, 0), (1.0, 2), (1.8, 1.5), (t, 0)], "spine.yaw": roll(3.6), "chest.yaw": roll(2.6, 0.05),
        "neck.yaw": roll(-2.5, 0.2), "neck.pitch": [(0, 0), (0.8, 6), (1.7, 5), (t, 0)],
        "head.yaw": roll(-3.0, 0.25), "head.pitch": [(0, 0), (0.8, 7), (1.7, 5), (t, 0)], "head.roll": roll(4.0, 0.3),
        "jaw": [(0, 0), (1.1, 5), (t, 0)],
        "shoulder.lift.L": ([(0, 0), (0.8, 7), (1.7, 6), (t, 0)], roll(6.0)), "shoulder.lift.R": ([(0, 0), (0.8, 7), (1.7, 6), (t, 0)], roll(-6.0)),
        "shoulder.forward.L": roll(7.0, 0.25), "shoulder.forward.R": roll(-7.0, 0.25),
        "arm.swing.L": roll(5.0, 0.3), "arm.swing.R": roll(-5.0, 0.3), **both("arm.out", [(0, 0), (0.9, 8), (1.8, 8), (t, 0)]),
        **both("elbow", [(0, 0), (0.9, 12), (1.8, 12), (t, 0)]), **both("curl", [(0, 0), (1.0, 10), (t, 0)]),
    }, markers=strike(start, end))


def shake():
    """Crouches and breathes in, then twists the whole body to and fro like a wet dog."""
    t, start, end = 4.5, 1.27, 3.17
    rattle = lambda size, late=0.0: burst(start - 0.1, end + 0.1, size, 1.6, late, 0.8, 0.9)
    return Table(t, {
        "pelvis.z": [(0, 0), (1.27, -1.0), (3.07, -0.9), (t, 0)], "pelvis.yaw": rattle(3.7), "pelvis.pitch": [(0, 0), (1.37, 2), (3.07, 2), (t, 0)],
        "spine.pitch": [(0, 0), (1.37, -2), (3.07, -2), (t, 0)], "spine.yaw": rattle(11.2, 0.02),
        "breath": [(0, 0), (1.07, 4), (1.87, 0), (3.07, -1.5), (t, 0)],
        "neck.yaw": rattle(8.0, 0.15), "neck.pitch": [(0, 0), (1.3, 8), (1.8, 5), (3.07, 5), (t, 0)], "neck.roll": rattle(5.0, 0.2),
        "head.yaw": rattle(14.0, 0.2), "head.roll": rattle(11.0, 0.3), "head.pitch": [(0, 0), (1.3, 8), (1.85, 0), (3.07, 2), (t, 0)],
        "jaw": ([(0, 0), (1.9, 14), (2.97, 12), (t, 0)], rattle(5.0, 0.2)),
        "arm.swing.L": ([(0, 0), (1.17, 6), (3.07, 6), (t, 0)], rattle(13.0, 0.2)), "arm.swing.R": ([(0, 0), (1.17, 6), (3.07, 6), (t, 0)], rattle(-13.0, 0.2)),
        **both("arm.out", [(0, 0), (1.07, 8), (1.77, 20), (2.97, 18), (3.67, 5), (t, 0)]),
        **both("elbow", ([(0, 0), (1.07, 28), (3.07, 26), (t, 0)], rattle(8.0, 0.3))),
        **both("curl", [(0, 0), (1.07, 18), (3.07, 16), (t, 0)]), **both("wrist", rattle(9.0, 0.4)),
        "shoulder.lift.L": rattle(3.0, 0.2), "shoulder.lift.R": rattle(-3.0, 0.2),
        "loin.front": [(0, 0), (1.17, -6), (3.07, -6), (t, 0)], "loin.side": rattle(11.0, 0.15),
    }, markers=strike(start, end))


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
    t, start, end = 5.2, 1.7, 3.3
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
    """Twists to and fro with all it has, roars with raised arms, and calms down."""
    t, start, end = 6.3, 1.3, 5.1
    rattle = lambda size, late=0.0: burst(1.2, 3.3, size, 1.6, late, 0.8, 0.8)
    tremble = lambda size, late=0.0: burst(3.6, 5.0, size, 4.0, late, 0.5, 0.6)
    return Table(t, {
        "pelvis.z": [(0, 0), (1.4, -1.2), (3.1, -1.2), (4.5, -0.3), (4.9, -0.3), (t, 0)], "pelvis.yaw": rattle(3.7),
        "pelvis.pitch": [(0, 0), (1.5, 2), (3.1, 2), (4.5, 0), (4.9, 0), (t, 0)],
        "spine.pitch": [(0, 0), (1.5, -2), (3.1, -1), (4.5, -4), (5.0, -4), (t, 0)], "spine.yaw": rattle(11.2, 0.02),
        "breath": [(0, 0), (1.2, 4), (2.0, 0), (3.3, 5), (4.1, 4), (5.0, -2), (t, 0)],
        "neck.yaw": rattle(10.0, 0.15), "neck.roll": rattle(6.0, 0.2), "neck.pitch": [(0, 0), (1.34, 10), (3.1, 14), (4.0, -22), (4.7, -18), (5.4, 6), (t, 0)],
        "head.yaw": (rattle(16.0, 0.2), tremble(3.0)), "head.roll": (rattle(12.0, 0.3), tremble(2.5, 0.2)),
        "head.pitch": [(0, 0), (1.34, 8), (1.9, 2), (3.1, 12), (4.0, -24), (4.7, -16), (5.4, 6), (t, 0)],
        "jaw": ([(0, 0), (1.9, 16), (3.1, 4), (3.9, 31), (4.7, 30), (5.3, 8), (t, 0)], tremble(3.0)),
        "arm.swing.L": ([(0, 0), (1.2, 12), (3.1, 24), (4.1, 14), (4.7, 14), (5.4, 12), (t, 0)], rattle(15.0, 0.2)),
        "arm.swing.R": ([(0, 0), (1.2, 12), (3.1, 24), (4.1, 14), (4.7, 14), (5.4, 12), (t, 0)], rattle(-15.0, 0.2)),
        **both("arm.out", ([(0, 0), (1.2, 8), (1.9, 26), (3.0, 14), (4.1, 98), (4.7, 94), (5.5, 20), (t, 0)], tremble(1.5, 0.1))),
        **both("elbow", ([(0, 0), (1.2, 30), (3.1, 54), (4.1, 32), (4.7, 36), (5.4, 26), (t, 0)], rattle(10.0, 0.3))),
        **both("curl", [(0, 0), (1.2, 28), (3.1, 42), (4.1, 30), (4.7, 36), (5.4, 16), (t, 0)]), **both("wrist", rattle(10.0, 0.4)),
        **both("shoulder.lift", ([(0, 0), (1.2, 3), (3.1, 3), (4.1, 17), (4.7, 15), (5.4, -2), (t, 0)])),
        **both("shoulder.forward", [(0, 0), (3.1, 8), (4.1, -8), (4.7, -6), (t, 0)]),
        "loin.front": [(0, 0), (1.2, -8), (3.1, -8), (4.1, -2), (t, 0)], "loin.side": rattle(11.0, 0.15), "loin": [(0, 0), (3.1, 0), (4.1, 5), (4.8, -3), (5.5, -4), (t, 0)],
    }, markers=strike(start, end))
