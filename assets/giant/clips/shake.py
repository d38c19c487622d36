"""Shaking riders off: shoulders, the whole body, the head, an arm, and a rage."""

from .keys import Table, both, burst, strike, wave


def shake_loop():
    """The whole body shakes, without beginning and end."""
    t = 2.6
    fast = 2
    return Table(t, {
        "pelvis.z": wave(t, 0.15, 2 * fast, 0.1, -1.3), "pelvis.x": wave(t, 0.28, fast, -0.06), "pelvis.y": [(0, 0.3)],
        "pelvis.yaw": wave(t, 1.4, fast), "pelvis.roll": wave(t, 0.9, fast, 0.1), "pelvis.pitch": wave(t, 1.0, 1, 0.0, 5.0),
        "spine.yaw": wave(t, 4.6, fast, 0.04), "spine.roll": wave(t, 1.5, fast, 0.2), "spine.pitch": wave(t, 1.0, 2, 0.2, 10.0),
        "neck.yaw": wave(t, 7.0, fast, 0.10), "neck.pitch": wave(t, 2.0, 2, 0.2, 4.0), "neck.roll": wave(t, 5.0, fast, 0.2),
        "head.yaw": wave(t, 15.0, fast, 0.14), "head.roll": wave(t, 10.0, fast, 0.25), "head.pitch": wave(t, 3.0, 2, 0.1, -2.0),
        "jaw": wave(t, 6.0, 2 * fast, 0.2, 14.0), "breath": wave(t, 0.4, 2),
        "arm.swing.L": wave(t, 12.0, fast, 0.22, 6.0), "arm.swing.R": wave(t, -12.0, fast, 0.22, 6.0),
        **both("arm.out", wave(t, 5.0, 2 * fast, 0.2, 15.0)), **both("elbow", wave(t, 9.0, fast, 0.3, 30.0)),
        **both("curl", wave(t, 8.0, 2, 0.2, 26.0)), **both("wrist", wave(t, 7.0, fast, 0.4)),
        "shoulder.lift.L": wave(t, 2.5, fast, 0.2, 4.0), "shoulder.lift.R": wave(t, -2.5, fast, 0.2, 4.0),
        "loin": [(0, -2.0)], "loin.front": [(0, -6.0)], "loin.side": wave(t, -9.0, fast, 0.05),
        **both("foot.out", [(0, 0.7)]),
    }, loops=True)


def shrug():
    """Rolls its shoulders: a mild shake of the upper back."""
    t, start, end = 2.26, 0.71, 1.76
    roll = lambda size, late=0.0: burst(start - 0.15, end + 0.15, size, 1.6, late, 0.5, 0.5)
    return Table(t, {
        "pelvis.z": [(0, 0), (0.66, -0.35), (1.76, -0.3), (t, 0)],
        "spine.pitch": [(0, 0), (0.71, 5), (1.76, 4), (t, 0)], "spine.yaw": roll(2.2), "spine.roll": roll(1.4, 0.2),
        "chest.yaw": roll(2.0, 0.1), "neck.yaw": roll(-2.5, 0.2), "neck.pitch": [(0, 0), (0.71, 5), (1.66, 4), (t, 0)],
        "head.yaw": roll(-3.0, 0.25), "head.pitch": [(0, 0), (0.71, 6), (1.66, 4), (t, 0)], "head.roll": roll(3.0, 0.3),
        "jaw": [(0, 0), (1.06, 5), (t, 0)],
        "shoulder.lift.L": ([(0, 0), (0.76, 6), (1.66, 5), (t, 0)], roll(5.0)), "shoulder.lift.R": ([(0, 0), (0.76, 6), (1.66, 5), (t, 0)], roll(-5.0)),
        "shoulder.forward.L": roll(6.0, 0.25), "shoulder.forward.R": roll(-6.0, 0.25),
        "arm.swing.L": roll(4.0, 0.3), "arm.swing.R": roll(-4.0, 0.3), **both("arm.out", [(0, 0), (0.86, 6), (1.66, 6), (t, 0)]),
        **both("elbow", [(0, 0), (0.86, 10), (1.66, 10), (t, 0)]), **both("curl", [(0, 0), (0.96, 10), (t, 0)]),
    }, markers=strike(start, end))


def shake():
    """Crouches and breathes in, then shakes the whole body like a wet dog."""
    t, start, end = 3.59, 0.79, 2.79
    rattle = lambda size, late=0.0: burst(start - 0.1, end + 0.1, size, 1.5, late, 0.9, 0.9)
    quick = lambda size, late=0.0: burst(start - 0.1, end + 0.1, size, 3.0, late, 0.9, 0.9)
    return Table(t, {
        "pelvis.z": ([(0, 0), (0.79, -1.3), (1.39, -0.9), (2.59, -0.9), (3.09, -0.6), (t, 0)], quick(0.05)),
        "pelvis.x": rattle(0.12, 0.5), "pelvis.y": [(0, 0), (0.89, 0.3), (2.69, 0.3), (t, 0)],
        "pelvis.yaw": rattle(2.0), "pelvis.pitch": [(0, 0), (0.79, 5), (2.69, 4), (t, 0)],
        "spine.pitch": [(0, 0), (0.79, 9), (1.49, 6), (2.69, 6), (t, 0)], "spine.yaw": rattle(8.0, 0.04), "spine.roll": rattle(0.8, 0.2),
        "breath": [(0, 0), (0.79, 4), (1.59, 0), (2.79, -1.5), (t, 0)],
        "neck.yaw": rattle(7.0, 0.15), "neck.pitch": [(0, 0), (0.79, 8), (1.59, 4), (2.69, 4), (t, 0)], "neck.roll": rattle(4.0, 0.2),
        "head.yaw": rattle(11.0, 0.2), "head.roll": rattle(8.0, 0.3), "head.pitch": [(0, 0), (0.79, 9), (1.59, 0), (2.79, 2), (t, 0)],
        "jaw": ([(0, 0), (0.79, 2), (1.49, 14), (2.59, 12), (t, 0)], quick(5.0, 0.2)),
        "arm.swing.L": ([(0, 0), (0.99, 6), (2.69, 6), (t, 0)], rattle(9.0, 0.2)), "arm.swing.R": ([(0, 0), (0.99, 6), (2.69, 6), (t, 0)], rattle(-9.0, 0.2)),
        **both("arm.out", [(0, 0), (0.79, 6), (1.39, 17), (2.59, 15), (3.09, 4), (t, 0)]), **both("elbow", ([(0, 0), (0.89, 26), (2.69, 24), (t, 0)], rattle(6.0, 0.3))),
        **both("curl", [(0, 0), (0.89, 18), (2.69, 16), (t, 0)]), **both("wrist", rattle(7.0, 0.4)),
        "shoulder.lift.L": rattle(2.0, 0.2), "shoulder.lift.R": rattle(-2.0, 0.2),
        "loin.front": [(0, 0), (0.89, -6), (2.69, -6), (t, 0)], "loin.side": rattle(9.0, 0.15),
    }, markers=strike(start, end))


def shake_head():
    """Head and neck alone: the head rolls about a line below the crown, and swings to the sides."""
    t, start, end = 2.8, 0.7, 2.3
    rattle = lambda size, late=0.0: burst(start - 0.1, end + 0.1, size, 1.7, late, 0.7, 0.7)
    return Table(t, {
        "pelvis.z": [(0, 0), (0.7, -0.5), (2.2, -0.4), (t, 0)], "spine.pitch": [(0, 0), (0.7, 4), (2.2, 3), (t, 0)],
        "spine.yaw": rattle(-1.0, 0.1), "chest.roll": rattle(-0.3, 0.1),
        "neck.pitch": [(0, 0), (0.7, 10), (1.4, 5), (2.3, 4), (t, 0)], "neck.roll": rattle(-2.0), "neck.yaw": rattle(4.0, 0.1),
        "head.pitch": [(0, 0), (0.7, 10), (1.4, 2), (2.3, 2), (t, 0)], "head.roll": rattle(10.0), "head.yaw": rattle(14.0, 0.25),
        "jaw": ([(0, 0), (0.7, 2), (1.4, 12), (2.2, 10), (t, 0)], rattle(5.0, 0.3)),
        "shoulder.lift.L": ([(0, 0), (0.8, 4), (2.2, 3), (t, 0)], rattle(1.0, 0.2)), "shoulder.lift.R": ([(0, 0), (0.8, 4), (2.2, 3), (t, 0)], rattle(-1.0, 0.2)),
        **both("arm.out", [(0, 0), (1.0, 7), (2.2, 6), (t, 0)]), **both("elbow", [(0, 0), (1.0, 12), (2.2, 10), (t, 0)]),
    }, markers=strike(start, end))


def shake_arm_left():
    """Draws the left arm in, looks at it, and flings it out."""
    t, start, end = 3.09, 0.94, 2.39
    fling = lambda size, late=0.0: burst(start - 0.1, end + 0.1, size, 1.7, late, 0.6, 0.6)
    return Table(t, {
        "pelvis.x": ([(0, 0), (0.89, -0.5), (2.29, -0.4), (t, 0)], fling(0.12, 0.1)), "pelvis.z": [(0, 0), (0.89, -0.6), (2.29, -0.5), (t, 0)],
        "pelvis.yaw": [(0, 0), (0.89, 3), (2.29, 2), (t, 0)],
        "spine.yaw": ([(0, 0), (0.89, 5), (2.39, 4), (t, 0)], fling(1.5, 0.1)), "spine.roll": ([(0, 0), (0.89, -3), (2.29, -4), (t, 0)], fling(0.8, 0.2)),
        "spine.pitch": [(0, 0), (0.89, 5), (2.29, 3), (t, 0)],
        "neck.yaw": [(0, 0), (0.84, 14), (2.29, 12), (t, 0)], "head.yaw": ([(0, 0), (0.79, 16), (2.29, 14), (t, 0)], fling(3.0, 0.3)),
        "head.pitch": [(0, 0), (0.89, 8), (2.29, 6), (t, 0)], "jaw": [(0, 0), (1.49, 10), (t, 0)],
        "shoulder.lift.L": ([(0, 0), (0.99, 7), (2.29, 6), (t, 0)], fling(1.5)), "shoulder.forward.L": [(0, 0), (0.99, 6), (2.29, 4), (t, 0)],
        "arm.swing.L": ([(0, 0), (0.99, 24), (1.69, 32), (2.39, 28), (t, 0)], fling(-3.0, 0.1)), "arm.out.L": ([(0, 0), (0.99, 22), (1.69, 34), (2.39, 30), (t, 0)], fling(3.0, 0.05)),
        "elbow.L": ([(0, 0), (0.94, 52), (1.59, 36), (2.39, 30), (2.79, 8), (t, 0)], fling(12.0)), "forearm.in.L": fling(5.0, 0.2),
        "wrist.L": ([(0, 0), (0.99, 14), (2.39, 4), (t, 0)], fling(22.0, 0.2)), "curl.L": ([(0, 0), (0.99, 34), (1.59, 6), (2.39, 8), (t, 0)], fling(16.0, 0.3)),
        "arm.swing.R": [(0, 0), (0.99, -6), (2.29, -6), (t, 0)], "arm.out.R": [(0, 0), (0.99, 10), (2.29, 10), (t, 0)], "elbow.R": [(0, 0), (0.99, 16), (2.29, 16), (t, 0)],
    }, markers=strike(start, end))


def rage():
    """Shakes with all it has, roars with raised arms, and calms down."""
    t, start, end = 5.13, 0.93, 4.13
    rattle = lambda size, late=0.0: burst(0.83, 2.63, size, 1.5, late, 0.8, 0.7)
    tremble = lambda size, late=0.0: burst(2.53, 4.03, size, 4.0, late, 0.5, 0.6)
    return Table(t, {
        "pelvis.z": [(0, 0), (0.83, -1.7), (1.43, -1.0), (2.43, -1.8), (3.03, 0.1), (3.73, -0.3), (4.23, -1.1), (t, 0)],
        "pelvis.x": rattle(0.3, 0.5), "pelvis.y": [(0, 0), (0.83, 0.6), (2.43, 0.5), (3.03, 0.3), (4.23, -0.6), (t, 0)],
        "pelvis.yaw": rattle(3.0), "pelvis.roll": rattle(2.0, 0.2), "pelvis.pitch": [(0, 0), (0.83, 7), (2.43, 8), (3.03, -5), (3.73, -4), (4.23, 5), (t, 0)],
        "spine.pitch": [(0, 0), (0.83, 13), (1.43, 8), (2.43, 17), (3.03, -17), (3.73, -13), (4.23, 12), (t, 0)],
        "spine.yaw": (rattle(9.0, 0.04), tremble(0.8)), "spine.roll": rattle(4.0, 0.2),
        "breath": [(0, 0), (0.83, 4), (1.63, 0), (2.43, 5), (3.13, 4), (4.03, -2), (t, 0)],
        "neck.yaw": rattle(9.0, 0.15), "neck.roll": rattle(5.0, 0.2), "neck.pitch": [(0, 0), (0.83, 12), (2.43, 14), (3.03, -26), (3.63, -20), (4.13, 10), (t, 0)],
        "head.yaw": (rattle(16.0, 0.2), tremble(3.0)), "head.roll": (rattle(11.0, 0.3), tremble(2.5, 0.2)),
        "head.pitch": [(0, 0), (0.83, 10), (1.43, 2), (2.43, 12), (3.03, -24), (3.63, -16), (4.13, 8), (t, 0)],
        "jaw": ([(0, 0), (0.83, 4), (1.43, 16), (2.33, 4), (2.93, 31), (3.73, 30), (4.23, 10), (t, 0)], tremble(3.0)),
        "arm.swing.L": ([(0, 0), (0.83, 12), (2.43, 24), (3.13, 14), (3.73, 14), (4.33, 12), (t, 0)], rattle(13.0, 0.2)),
        "arm.swing.R": ([(0, 0), (0.83, 12), (2.43, 24), (3.13, 14), (3.73, 14), (4.33, 12), (t, 0)], rattle(-13.0, 0.2)),
        **both("arm.out", ([(0, 0), (0.83, 8), (1.43, 26), (2.43, 12), (3.13, 98), (3.73, 94), (4.33, 22), (t, 0)], tremble(1.5, 0.1))),
        **both("elbow", ([(0, 0), (0.83, 30), (2.43, 54), (3.13, 32), (3.73, 36), (4.33, 26), (t, 0)], rattle(9.0, 0.3))),
        **both("curl", [(0, 0), (0.83, 28), (2.43, 42), (3.13, 30), (3.73, 36), (4.33, 16), (t, 0)]), **both("wrist", rattle(9.0, 0.4)),
        **both("shoulder.lift", [(0, 0), (0.83, 3), (2.43, 3), (3.13, 17), (3.73, 15), (4.33, -2), (t, 0)]),
        **both("shoulder.forward", [(0, 0), (2.43, 8), (3.13, -8), (3.73, -6), (t, 0)]),
        "loin.front": [(0, 0), (0.83, -8), (2.43, -8), (3.13, -2), (t, 0)], "loin.side": rattle(10.0, 0.15), "loin": [(0, 0), (2.43, 0), (3.13, 6), (3.73, -3), (4.33, -5), (t, 0)],
    }, markers=strike(start, end))
