"""Standing clips: idle, breathing, a roar, and the pause of exhaustion."""

from .keys import HIT, Table, both, burst, strike, wave


def idle():
    t = 6.0
    return Table(t, {
        "pelvis.x": wave(t, 0.55), "pelvis.z": wave(t, 0.12, 2, 0.1, -0.45), "pelvis.y": wave(t, 0.15, 1, 0.3),
        "pelvis.roll": wave(t, 1.4), "pelvis.yaw": wave(t, 1.5, 1, 0.2),
        "spine.pitch": wave(t, 2.0, 2, 0.2, 3.0), "spine.roll": wave(t, -2.8, 1, 0.05), "spine.yaw": wave(t, 3.0, 1, 0.25),
        "breath": wave(t, 1.7, 2, 0.0),
        "neck.yaw": [(0, 0), (1.2, 8), (2.2, 9), (4.0, -8), (5.0, -8)],
        "neck.pitch": wave(t, 2.0, 2, 0.3, 2.0),
        "head.yaw": [(0, 0), (1.0, 17), (2.2, 18), (3.7, -16), (4.9, -17)],
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
    t = 5.4
    return Table(t, {
        "pelvis.z": [(0, 0), (1.3, -1.3), (2.2, 0.1), (3, -0.7), (3.8, -0.6), (t, 0)],
        "pelvis.y": [(0, 0), (1.3, 0.0), (2.2, 0.4), (3.08, -0.9), (3.8, -0.7), (t, 0)],
        "pelvis.pitch": [(0, 0), (1.3, 5), (2.2, -5), (3.08, 5), (t, 0)],
        "spine.pitch": [(0, 0), (1.3, 15), (2.2, -17), (3.08, 9), (3.8, 6), (t, 0)],
        "neck.pitch": [(0, 0), (1.24, 14), (2.2, -26), (3, 10), (3.8, 6), (t, 0)],
        "head.pitch": [(0, 0), (1.24, 12), (2.12, -24), (2.93, -6), (3.8, -4), (t, 0)],
        "head.yaw": burst(2.0, 4.0, 3.0, 4.0), "head.roll": burst(2.0, 4.0, 2.0, 3.0, 0.2),
        "jaw": ([(0, 0), (1.24, -3), (1.98, 30), (3.48, 32), (4.4, 6), (t, 0)], burst(2.0, 3.9, 3.0, 5.0)),
        "breath": [(0, 0), (1.38, 5), (2.27, 4), (3.64, -2), (t, 0)],
        **both("arm.out", [(0, 0), (1.3, 6), (2.27, 58), (3.08, 52), (3.8, 38), (t, 0)]),
        **both("arm.swing", [(0, 0), (1.3, 20), (2.27, -22), (3.08, -14), (3.8, -6), (t, 0)]),
        **both("elbow", [(0, 0), (1.3, 48), (2.27, 26), (3.08, 40), (3.8, 30), (t, 0)]),
        **both("shoulder.lift", [(0, 0), (1.3, 3), (2.27, 10), (3.08, 7), (t, 0)]),
        **both("shoulder.forward", [(0, 0), (1.3, 10), (2.27, -12), (3.08, -8), (t, 0)]),
        **both("curl", [(0, 0), (1.3, 34), (2.27, -4), (3.48, 16), (t, 0)]),
        **both("wrist", [(0, 0), (1.3, 12), (2.27, -14), (3.48, 6), (t, 0)]),
        "loin": [(0, 0), (1.3, 2), (2.27, 6), (3.16, -6), (4.2, 2), (t, 0)],
    }, markers=strike(1.55, 3.8))


def expose():
    """Tired out: steps back, sinks on its right knee and its left hand, pants, and rises."""
    t, down, up = 11.8, 2.6, 7.7
    pant = lambda size, late=0.0, rest=0.0: burst(2.7, 7.7, size, 0.75, late, 0.9, 0.9)
    hold = [(0, 0), (1.23, 0), (2.37, 1), (up + 0.1, 1), (up + 0.7, 0.985), (10.1, 0), (t, 0)]
    return Table(t, {
        "pelvis.z": ([(0, 0), (1.1, -0.7), (1.9, -2.9), (down, -4.75), (2.9, -4.5), (3.4, -4.65), (up, -4.6), (9.93, -2.0), (t, 0)],
                     pant(0.10)),
        "pelvis.y": [(0, 0), (1, 0.6), (down, -2.2), (up, -2.2), (9.76, -0.6), (t, 0)],
        "pelvis.x": [(0, 0), (1.11, 0.9), (1.91, 0.7), (down, 0.2), (up, 0.3), (9.59, 0.8), (t, 0)],
        "pelvis.pitch": [(0, 0), (1, -2), (down, 20), (3, 23), (up, 23), (9.93, 12), (t, 0)],
        "pelvis.roll": [(0, 0), (down, -4), (up, -4), (t, 0)], "pelvis.yaw": [(0, 0), (down, -8), (up, -8), (t, 0)],
        "spine.pitch": ([(0, 0), (0.9, -1), (down, 34), (3.1, 44), (up, 44), (9.93, 22), (t, 0)], pant(2.4)),
        "spine.yaw": [(0, 0), (down, -12), (3.1, -14), (up, -14), (t, 0)], "spine.roll": [(0, 0), (down, 6), (3.1, 8), (up, 8), (t, 0)],
        "neck.pitch": ([(0, 0), (1, -6), (down, 10), (3.3, 18), (up, 16), (9.42, -6), (t, 0)], pant(2.0, 0.15)),
        "head.pitch": ([(0, 0), (1, -4), (down, 6), (3.4, 12), (up, 10), (9.59, -8), (t, 0)], pant(2.5, 0.2)),
        "head.roll": [(0, 0), (1, 5), (3.3, -6), (5.51, 4), (up, -3), (t, 0)], "head.yaw": [(0, 0), (3.5, 8), (5.71, -6), (up, 4), (t, 0)],
        "jaw": ([(0, 0), (1, 14), (2.7, 18), (7.42, 15), (9.08, 6), (t, 0)], pant(6.0, 0.3)),
        "breath": pant(3.0, 0.1),
        "hand.hold.L": hold, "hand.x.L": [(0, 8.6)], "hand.y.L": [(0, -13.4)],
        "hand.z.L": [(0, 5.0), (1.91, 4.0), (down + 0.1, 0.0, HIT), (up + 0.1, 0.0), (up + 0.9, 0.1), (9.93, 4.5)],
        "hand.yaw.L": [(0, -100)], "hand.roll.L": [(0, -86)], "hand.pitch.L": [(0, 0)],
        "arm.swing.L": [(0, 0), (1.11, 20), (2.26, 40), (up, 40), (9.93, 32), (t, 0)], "arm.out.L": [(0, 0), (2.26, 18), (up, 18), (t, 0)],
        "elbow.L": [(0, 0), (1.23, 24), (2.26, 20), (up, 20), (9.59, 52), (t, 0)], "curl.L": [(0, 0), (2.03, -8), (2.9, 0), (up, 0), (t, 0)],
        "arm.swing.R": ([(0, 0), (1.11, -6), (down, 30), (3.2, 36), (up, 36), (9.93, 12), (t, 0)], pant(2.0, 0.4)),
        "arm.out.R": [(0, 0), (down, 16), (up, 14), (t, 0)], "elbow.R": [(0, 0), (1.23, 10), (down, 34), (up, 34), (t, 0)],
        "wrist.R": [(0, 0), (down, -14), (up, -12), (t, 0)], "curl.R": [(0, 0), (down, 18), (up, 24), (t, 0)],
        "shoulder.lift.L": [(0, 0), (down, 4), (3, 9), (up, 9), (t, 0)], "shoulder.forward.L": [(0, 0), (down, 14), (up, 14), (t, 0)],
        "shoulder.lift.R": [(0, 0), (down, -3), (up, -3), (t, 0)],
        "foot.z.R": [(0, 0), (0.46, 0), (1.11, 0.25), (1.46, 0.8), (1.97, 0), (up + 0.7, 0), (9.59, 0.25), (10.28, 0.8), (11.13, 0), (t, 0)],
        "foot.y.R": [(0, 0), (0.46, 0), (1.17, 0.7), (1.97, 4.6), (up + 0.7, 4.6), (9.59, 3.9), (11.04, 0), (t, 0)],
        "foot.pitch.R": [(0, 0), (0.28, 0), (1, 6), (1.97, 38), (down, 72), (up, 74), (9.59, 36), (10.79, 5), (11.3, 0), (t, 0)],
        "loin.front": [(0, 0), (1.11, -4), (down, -40), (3.1, -34), (up, -34), (9.93, -10), (t, 0)],
        "loin.back": [(0, 0), (down, 10), (3, -6), (up, -4), (t, 0)],
    }, markers=[("impact", down), ("impact", down + 0.1), ("exposed", 3.1), ("covered", up)], kneels=True)
