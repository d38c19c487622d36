"""From a handful of controls to the rotations of all joints.

Rotations here are in the model's axes: a joint's local rotation q turns it against its parent, and
`model rotation = parent's model rotation @ q`. Angles are radians (degrees in the clips' tables):
pitch about +X leans forward, yaw about +Z turns to the creature's left, roll about +Y leans to its
left.
"""

import numpy as np

from .skeleton import HEADS, INDEX, JOINTS, PARENT, TAILS

SPINE = ("spine.1", "spine.2", "spine.3", "chest")
FINGERS = ("index", "middle", "ring", "thumb")
# Delays, in seconds, with which the parts of the body follow the pelvis: what makes it heavy.
SPINE_LAG, NECK_LAG, HEAD_LAG, JAW_LAG = 0.05, 0.10, 0.16, 0.22
ELBOW_LAG, WRIST_LAG, FINGER_LAG = 0.08, 0.16, 0.22
LOIN_LAG = 0.25
# From the ball of a foot to the end of its heel; and how high the toes hang free, in metres.
HEEL, TOES_FREE = 5.0, 5.0
# How far the flesh under the ball lifts a foot for each degree that its heel is raised, in metres.
BALL_ROLL = 0.02
# The share of a leg's or an arm's length to which IK straightens it at most.
MOST_STRETCH = 0.9985


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


class Pose:
    """Rotations (joints, 3, 3) against the parents, and how far the pelvis is moved."""

    def __init__(self):
        self.local = np.tile(np.eye(3), (len(JOINTS), 1, 1))
        self.shift = np.zeros(3)

    def placed(self):
        """Model rotations and heads of all joints."""
        turn, place = np.empty_like(self.local), np.zeros_like(HEADS)
        for joint, parent in enumerate(PARENT):
            if parent < 0:
                turn[joint], place[joint] = self.local[joint], HEADS[joint]
                continue
            turn[joint] = turn[parent] @ self.local[joint]
            place[joint] = place[parent] + turn[parent] @ (HEADS[joint] - HEADS[parent])
            if JOINTS[joint].name == "pelvis":
                place[joint] += self.shift
        return turn, place


def turned(pitch=0.0, yaw=0.0, roll=0.0):
    """The rotation that rolls, then pitches, then yaws, by degrees."""
    p, y, r = np.radians([pitch, yaw, roll])
    about_x = np.array([[1, 0, 0], [0, np.cos(p), -np.sin(p)], [0, np.sin(p), np.cos(p)]])
    about_z = np.array([[np.cos(y), -np.sin(y), 0], [np.sin(y), np.cos(y), 0], [0, 0, 1]])
    about_y = np.array([[np.cos(r), 0, np.sin(r)], [0, 1, 0], [-np.sin(r), 0, np.cos(r)]])
    return about_z @ about_x @ about_y


def posed(c, t):
    """The pose that the curves `c` give at time `t`."""
    pose = Pose()

    def turn(joint, pitch=0.0, yaw=0.0, roll=0.0):
        pose.local[INDEX[joint]] = turned(pitch, yaw, roll)

    def angles(name, time):
        return [c(f"{name}.{kind}", time) for kind in ("pitch", "yaw", "roll")]

    pose.shift = np.array([c(f"pelvis.{axis}", t) for axis in "xyz"])
    turn("pelvis", *angles("pelvis", t))
    for number, joint in enumerate(SPINE):
        bend = np.array(angles("spine", t - SPINE_LAG * number)) / len(SPINE)
        if joint == "chest":
            bend[0] -= 0.6 * c("breath", t)
        turn(joint, *bend)
    neck = np.array(angles("neck", t - NECK_LAG))
    turn("neck.1", *(0.5 * neck))
    turn("neck.2", *(0.5 * neck))
    turn("head", *angles("head", t - HEAD_LAG))
    turn("jaw", c("jaw", t - JAW_LAG))
    lean = c("pelvis.pitch", t)
    turn("loin.front", min(-lean, 0.0) + c("loin", t - LOIN_LAG) + c("loin.front", t - LOIN_LAG), 0, c("loin.side", t - LOIN_LAG))
    turn("loin.back", max(-lean, 0.0) + c("loin", t - LOIN_LAG) + c("loin.back", t - LOIN_LAG), 0, c("loin.side", t - LOIN_LAG))
    for side, sign in ((".L", 1), (".R", -1)):
        _arm(c, t, pose, turn, side, sign)
    for side, sign in ((".L", 1), (".R", -1)):
        _leg(c, t, pose, side, sign)
    return pose


def _arm(c, t, pose, turn, side, sign):
    """Swing is forward, out is away from the body, across is towards the other side."""
    at = lambda name, lag=0.0: c(name + side, t - lag)
    turn("clavicle" + side, 0.0, -sign * at("shoulder.forward"), -sign * (at("shoulder.lift") + c("breath", t)))
    turn("upper_arm" + side, -at("arm.swing"), -sign * at("arm.across"), -sign * at("arm.out"))
    turn("forearm" + side, -at("elbow", ELBOW_LAG), -sign * at("forearm.in", ELBOW_LAG), 0.0)
    turn("hand" + side, -at("wrist", WRIST_LAG), 0.0, sign * at("wrist.in", WRIST_LAG))
    curl = at("curl", FINGER_LAG)
    for number, finger in enumerate(FINGERS):
        amount = curl * (1.0 + 0.08 * number)
        lean = -0.45 * amount if finger == "thumb" else 0.0
        turn(f"{finger}.1{side}", lean, 0.0, sign * amount)
        turn(f"{finger}.2{side}", lean, 0.0, sign * 0.9 * amount)


def _leg(c, t, pose, side, sign):
    """Puts a foot's ball where the curves say (from its place at rest) and bends the leg to it."""
    at = lambda name: c(f"foot.{name}{side}", t)
    ball, ankle = HEADS[INDEX["toe" + side]], HEADS[INDEX["foot" + side]]
    foot = turned(at("pitch"), at("yaw"), at("roll"))
    # Toes up: the foot stands on its heel, which raises the ball.
    height = at("z") + HEEL * np.sin(np.radians(max(-at("pitch"), 0.0)))
    height += BALL_ROLL * max(at("pitch"), 0.0)
    goal = ball + np.array([sign * at("out") + at("x"), at("y"), height]) + foot @ (ankle - ball)
    bend(pose, ("thigh" + side, "shin" + side, "foot" + side), goal, foot)
    toe = -max(at("pitch"), 0.0) * max(0.3, 1.0 - at("z") / TOES_FREE)
    pose.local[INDEX["toe" + side]] = turned(toe + at("toe"))


def bend(pose, chain, goal, end_turn, pole=None):
    """Two-bone IK: turns chain[0] and chain[1] so that chain[2] is at `goal`, turned `end_turn`.

    The middle joint keeps to the side of the plane where it is at rest, as the parent turns, or
    lies towards `pole`. Closed form, by the law of cosines.
    """
    first, second, end = (INDEX[name] for name in chain)
    turn, place = pose.placed()
    parent = turn[PARENT[first]]
    upper, lower = HEADS[second] - HEADS[first], HEADS[end] - HEADS[second]
    a, b = np.linalg.norm(upper), np.linalg.norm(lower)
    root = place[first]
    reach = goal - root
    distance = np.clip(np.linalg.norm(reach), abs(a - b) * 1.05, (a + b) * MOST_STRETCH)
    direction = reach / np.linalg.norm(reach)
    rest = HEADS[end] - HEADS[first]
    rest_out = upper - rest * (upper @ rest) / (rest @ rest)
    out = parent @ rest_out if pole is None else np.asarray(pole, float)
    out = out - direction * (out @ direction)
    out /= np.linalg.norm(out)
    along = (a * a - b * b + distance * distance) / (2 * distance)
    middle = root + along * direction + np.sqrt(max(a * a - along * along, 0.0)) * out
    target = root + distance * direction
    normal_rest, normal = np.cross(upper, lower), np.cross(middle - root, target - middle)
    first_turn = _frame(middle - root, normal) @ _frame(upper, normal_rest).T
    second_turn = _frame(target - middle, normal) @ _frame(lower, normal_rest).T
    pose.local[first] = parent.T @ first_turn
    pose.local[second] = first_turn.T @ second_turn
    pose.local[end] = second_turn.T @ end_turn


def _frame(direction, normal):
    x = direction / np.linalg.norm(direction)
    z = normal / np.linalg.norm(normal)
    return np.stack([x, np.cross(z, x), z], axis=1)


def skinned(points, weights, pose):
    """Points of the rest pose, moved by linear blend skinning."""
    turn, place = pose.placed()
    result = np.zeros_like(points)
    for joint in np.flatnonzero(weights.any(axis=0)):
        moved = (points - HEADS[joint]) @ turn[joint].T + place[joint]
        result += weights[:, joint, None] * moved
    return result


def quaternions(matrices):
    """Unit quaternions (w, x, y, z) of rotations (n, 3, 3)."""
    m = matrices
    trace = np.stack([
        1 + m[:, 0, 0] + m[:, 1, 1] + m[:, 2, 2],
        1 + m[:, 0, 0] - m[:, 1, 1] - m[:, 2, 2],
        1 - m[:, 0, 0] + m[:, 1, 1] - m[:, 2, 2],
        1 - m[:, 0, 0] - m[:, 1, 1] + m[:, 2, 2],
    ], axis=1)
    yz, zx, xy = m[:, 2, 1] - m[:, 1, 2], m[:, 0, 2] - m[:, 2, 0], m[:, 1, 0] - m[:, 0, 1]
    y_z, z_x, x_y = m[:, 2, 1] + m[:, 1, 2], m[:, 0, 2] + m[:, 2, 0], m[:, 1, 0] + m[:, 0, 1]
    rows = np.stack([
        np.stack([trace[:, 0], yz, zx, xy], axis=1),
        np.stack([yz, trace[:, 1], x_y, z_x], axis=1),
        np.stack([zx, x_y, trace[:, 2], y_z], axis=1),
        np.stack([xy, z_x, y_z, trace[:, 3]], axis=1),
    ], axis=1)
    best = rows[np.arange(len(m)), trace.argmax(axis=1)]
    return best / np.linalg.norm(best, axis=1, keepdims=True)
