"""Standing clips: idle, breathing, a roar, and the pause of exhaustion."""

from .keys import HIT, Table, both, burst, strike, wave


def idle():
    t = 6.0
    return Table(t, {
        "pelvis.x": wave(t, 0.55), "pelvis.z": wave(t, 0.12, 2, 0.1, -0.45), "pelvis.y": wave(t, 0.15, 1, 0.3),
        "pelvis.roll": wave(t, 1.4), "pelvis.yaw": wave(t, 1.5, 1, 0.2),
        "spine.pitch": wave(t, 2.4, 2, 0.2, 3.0), "spine.roll": wave(t, -2.8, 1, 0.05), "spine.yaw": wave(t, 3.0, 1, 0.25),
        "breath": wave(t, 1.7, 2, 0.0),
        "neck.yaw": [(0, 0), (1.0, 14), (2.2, 16), (3.4, -12), (4.8, -15), (5.5, -4)],
        "neck.pitch": wave(t, 3.0, 2, 0.3, 2.0),
        "head.yaw": [(0, 0), (0.9, 12), (2.2, 13), (3.3, -12), (4.7, -13), (5.5, -3)],
        "head.pitch": [(0, 0), (1.4, -5), (3.0, 4), (4.6, -3)], "head.roll": wave(t, 3.0, 1, 0.15),
        "jaw": wave(t, 3.0, 2, 0.15, 4.0),
        "arm.swing.L": wave(t, 2.2, 2, 0.25, 3.0), "arm.swing.R": wave(t, 2.2, 2, 0.35, 2.0),
        "arm.out.L": wave(t, 1.6, 1, 0.2, 2.0), "arm.out.R": wave(t, 1.6, 1, 0.7, 2.0),
        **both("elbow", wave(t, 2.5, 2, 0.3, 6.0)), **both("wrist", wave(t, 3.0, 2, 0.3)),
        "curl.L": wave(t, 7.0, 1, 0.1, 12.0), "curl.R": wave(t, 7.0, 1, 0.55, 12.0),
        "loin": wave(t, 1.5, 2, 0.2), "loin.side": wave(t, -1.5, 1, 0.1),
    }, loops=True)


def breathe():
    """Chest, upper spine and collarbones alone, from the rest pose: to be added to other clips."""
    t = 5.0
    air = [(0, 0), (0.5, 0.12), (2.0, 1.0), (2.5, 0.96), (4.2, 0.12)]
    channels = {"breath": [(time, 2.6 * share) for time, share in air], "swell": [(time, -1.6 * share) for time, share in air]}
    return Table(t, channels, loops=True, from_idle=False, settles=False)


def roar():
    """Breathes in and cowers, rears up with its arms out, then thrusts the head forward."""
    t = 3.36
    return Table(t, {
        "pelvis.z": [(0, 0), (0.91, -1.3), (1.51, 0.1), (2.06, -0.7), (2.56, -0.6), (t, 0)],
        "pelvis.y": [(0, 0), (0.91, 0.5), (1.51, 0.4), (2.11, -0.9), (2.56, -0.7), (t, 0)],
        "pelvis.pitch": [(0, 0), (0.91, 5), (1.51, -5), (2.11, 5), (t, 0)],
        "spine.pitch": [(0, 0), (0.91, 15), (1.51, -17), (2.11, 9), (2.56, 6), (t, 0)],
        "neck.pitch": [(0, 0), (0.86, 14), (1.51, -26), (2.06, 10), (2.56, 6), (t, 0)],
        "head.pitch": [(0, 0), (0.86, 12), (1.46, -24), (2.01, -6), (2.56, -4), (t, 0)],
        "head.yaw": burst(1.36, 2.66, 3.0, 4.0), "head.roll": burst(1.36, 2.66, 2.0, 3.0, 0.2),
        "jaw": ([(0, 0), (0.86, -3), (1.36, 30), (2.36, 32), (2.86, 6), (t, 0)], burst(1.36, 2.56, 3.0, 5.0)),
        "breath": [(0, 0), (0.96, 5), (1.56, 4), (2.46, -2), (t, 0)],
        **both("arm.out", [(0, 0), (0.91, 6), (1.56, 58), (2.11, 52), (2.56, 38), (t, 0)]),
        **both("arm.swing", [(0, 0), (0.91, 20), (1.56, -22), (2.11, -14), (2.56, -6), (t, 0)]),
        **both("elbow", [(0, 0), (0.91, 48), (1.56, 26), (2.11, 40), (2.56, 30), (t, 0)]),
        **both("shoulder.lift", [(0, 0), (0.91, 3), (1.56, 10), (2.11, 7), (t, 0)]),
        **both("shoulder.forward", [(0, 0), (0.91, 10), (1.56, -12), (2.11, -8), (t, 0)]),
        **both("curl", [(0, 0), (0.91, 34), (1.56, -4), (2.36, 16), (t, 0)]),
        **both("wrist", [(0, 0), (0.91, 12), (1.56, -14), (2.36, 6), (t, 0)]),
        "loin": [(0, 0), (0.91, 2), (1.56, 6), (2.16, -6), (2.76, 2), (t, 0)],
    }, markers=strike(1.26, 2.56))


def expose():
    """Tired out: steps back, sinks on its right knee and its left hand, pants, and rises."""
    t, down, up = 9.7, 2.2, 7.3
    pant = lambda size, late=0.0, rest=0.0: burst(2.3, 7.3, size, 0.75, late, 0.9, 0.9)
    hold = [(0, 0), (1.0, 0), (2.0, 1), (up + 0.1, 1), (8.7, 0), (t, 0)]
    return Table(t, {
        "pelvis.z": ([(0, 0), (0.8, -0.7), (1.5, -3.2), (down, -6.3), (2.5, -6.0), (3.0, -6.2), (up, -6.1), (8.6, -2.0), (t, 0)],
                     pant(0.10)),
        "pelvis.y": [(0, 0), (0.8, 0.6), (down, -2.2), (up, -2.2), (8.5, -0.6), (t, 0)],
        "pelvis.x": [(0, 0), (0.9, 0.9), (1.6, 0.7), (down, 0.2), (up, 0.3), (8.4, 0.8), (t, 0)],
        "pelvis.pitch": [(0, 0), (0.8, -2), (down, 20), (2.6, 23), (up, 23), (8.6, 12), (t, 0)],
        "pelvis.roll": [(0, 0), (down, -4), (up, -4), (t, 0)], "pelvis.yaw": [(0, 0), (down, -8), (up, -8), (t, 0)],
        "spine.pitch": ([(0, 0), (0.8, -3), (down, 34), (2.7, 44), (up, 44), (8.6, 22), (t, 0)], pant(2.4)),
        "spine.yaw": [(0, 0), (down, -12), (2.7, -14), (up, -14), (t, 0)], "spine.roll": [(0, 0), (down, 6), (2.7, 8), (up, 8), (t, 0)],
        "neck.pitch": ([(0, 0), (0.8, -6), (down, 10), (2.9, 18), (up, 16), (8.3, -6), (t, 0)], pant(2.0, 0.15)),
        "head.pitch": ([(0, 0), (0.8, -4), (down, 6), (3.0, 12), (up, 10), (8.4, -8), (t, 0)], pant(2.5, 0.2)),
        "head.roll": [(0, 0), (0.8, 5), (2.9, -6), (5.1, 4), (up, -3), (t, 0)], "head.yaw": [(0, 0), (3.1, 8), (5.3, -6), (up, 4), (t, 0)],
        "jaw": ([(0, 0), (0.8, 14), (2.3, 18), (7.0, 15), (8.1, 6), (t, 0)], pant(6.0, 0.3)),
        "breath": pant(3.0, 0.1),
        "hand.hold.L": hold, "hand.x.L": [(0, 8.6)], "hand.y.L": [(0, -13.4)],
        "hand.z.L": [(0, 5.0), (1.6, 4.0), (down + 0.1, 0.0, HIT), (up + 0.1, 0.0), (8.6, 4.5)],
        "hand.yaw.L": [(0, -100)], "hand.roll.L": [(0, -86)], "hand.pitch.L": [(0, 0)],
        "arm.swing.L": [(0, 0), (0.9, 20), (1.9, 40), (up, 40), (8.6, 32), (t, 0)], "arm.out.L": [(0, 0), (1.9, 18), (up, 18), (t, 0)],
        "elbow.L": [(0, 0), (1.0, 24), (1.9, 20), (up, 20), (8.4, 52), (t, 0)], "curl.L": [(0, 0), (1.7, -8), (2.5, 0), (up, 0), (t, 0)],
        "arm.swing.R": ([(0, 0), (0.9, -6), (down, 30), (2.8, 36), (up, 36), (8.6, 12), (t, 0)], pant(2.0, 0.4)),
        "arm.out.R": [(0, 0), (down, 16), (up, 14), (t, 0)], "elbow.R": [(0, 0), (1.0, 10), (down, 34), (up, 34), (t, 0)],
        "wrist.R": [(0, 0), (down, -14), (up, -12), (t, 0)], "curl.R": [(0, 0), (down, 18), (up, 24), (t, 0)],
        "shoulder.lift.L": [(0, 0), (down, 4), (2.6, 9), (up, 9), (t, 0)], "shoulder.forward.L": [(0, 0), (down, 14), (up, 14), (t, 0)],
        "shoulder.lift.R": [(0, 0), (down, -3), (up, -3), (t, 0)],
        "foot.z.R": [(0, 0), (0.35, 0), (0.9, 0.25), (1.2, 0.8), (1.65, 0), (up + 0.45, 0), (8.4, 0.25), (8.8, 0.8), (9.3, 0), (t, 0)],
        "foot.y.R": [(0, 0), (0.35, 0), (0.95, 0.7), (1.65, 4.6), (up + 0.45, 4.6), (8.4, 3.9), (9.25, 0), (t, 0)],
        "foot.pitch.R": [(0, 0), (0.2, 0), (0.8, 6), (1.65, 38), (down, 72), (up, 74), (8.4, 36), (9.1, 5), (9.4, 0), (t, 0)],
        "loin.front": [(0, 0), (0.9, -4), (down, -40), (2.7, -34), (up, -34), (8.6, -10), (t, 0)],
        "loin.back": [(0, 0), (down, 10), (2.6, -6), (up, -4), (t, 0)],
    }, markers=[("impact", down), ("impact", down + 0.1), ("exposed", 2.7), ("covered", up)], kneels=True)
