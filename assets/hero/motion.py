"""From named channels to the rotations of all joints: spine, arms, legs, equipment.

Rotations here are in the model's axes: a joint's local rotation q turns it against its parent, and
`model rotation = parent's model rotation @ q`. Angles are degrees: pitch about +X leans forward, yaw
about +Y turns to the hero's left, roll leans to his left. Hands and feet are put where the channels say
by a two-bone IK, or the limbs are turned directly, or something between.
"""

import numpy as np
from giant.curves import Curves
from giant.field import smooth_step
from giant.turns import quaternions

from .skeleton import (
    ALONG,
    FRAMES,
    HEADS,
    INDEX,
    JOINTS,
    LOWER,
    MIRROR,
    PALM_SIDE,
    PARENT,
    THUMB_SIDE,
)

# The share of an arm's or a leg's length to which IK straightens it at most.
MOST_STRETCH = 0.9985
# The shoulder lifts by this much for a hand that is straight above it, and comes forward for one in front; degrees.
SHOULDER_LIFT, SHOULDER_FORWARD = 27.0, 12.0
# The share of the hand's twist that the forearm takes.
FOREARM_TWIST = 0.55
# The contact points of the left foot at rest: the end of the heel; the ball is the toe's joint.
HEEL, TOE_END = np.array([0.098, 0.0, -0.085]), np.array([0.114, 0.0, 0.185])
# From the mouth of the scabbard to its end, and how high its end is kept; metres.
SCABBARD, SCABBARD_CLEAR = 0.92, 0.05
# How high bow and quiver are kept, in metres.
BACK_CLEAR = 0.012
# Points of the trunk that touch the ground when he lies, and the joints that they follow.
BACK = tuple(
    (joint, (sign * x, y, z))
    for joint, x, y, z in (
        ("hips", 0.09, 0.92, -0.130),
        ("hips", 0.12, 0.86, -0.155),
        ("spine", 0.10, 1.10, -0.115),
        ("chest", 0.11, 1.36, -0.158),
        ("chest", 0.20, 1.38, -0.095),
        ("head", 0.03, 1.66, -0.125),
        ("chest", 0.08, 1.25, -0.140),
    )
    for sign in (1.0, -1.0)
)
SIDES = ((".L", 1.0), (".R", -1.0))


class Channels:
    """Values of named channels at a time; 0 where there is none.

    A channel is a number, a function of the time, or keys (time, value). Values of three numbers become
    the channels `name.x`, `name.y` and `name.z`.
    """

    def __init__(self, length, loops, table):
        self.functions, keys = {}, {}
        for name, value in table.items():
            if callable(value):
                self.functions[name] = value
                continue
            value = [(0.0, value)] if isinstance(value, (int, float, tuple)) else value
            if isinstance(value[0][1], (tuple, np.ndarray)):
                for axis in range(3):
                    keys[f"{name}.{'xyz'[axis]}"] = [(time, float(v[axis])) for time, v in value]
            else:
                keys[name] = value
        for name, track in keys.items():
            times = [time for time, _ in track]
            assert all(one < two for one, two in zip(times, times[1:])), f"{name}: keys at {times}"
        self.curves = Curves(length, loops, keys)

    def __call__(self, name, time):
        return self.functions[name](time) if name in self.functions else self.curves(name, time)

    def has(self, name):
        """Whether the channel is in the table."""
        return name in self.functions or name in self.curves.keys or f"{name}.x" in self.curves.keys

    def vector(self, name, time, default=(0.0, 0.0, 0.0)):
        """A channel of three numbers."""
        if f"{name}.x" not in self.curves.keys:
            return np.asarray(default, float)
        return np.array([self.curves(f"{name}.{axis}", time) for axis in "xyz"])


class Pose:
    """Rotations (joints, 3, 3), shifts (joints, 3) and scales (joints,) against the rest pose."""

    def __init__(self):
        self.local = np.tile(np.eye(3), (len(JOINTS), 1, 1))
        self.shift = np.zeros((len(JOINTS), 3))
        self.scale = np.ones(len(JOINTS))

    def placed(self):
        """Model rotations and places of all joints."""
        turn, place = np.empty_like(self.local), np.zeros_like(HEADS)
        for joint, parent in enumerate(PARENT):
            if parent < 0:
                turn[joint], place[joint] = self.local[joint], HEADS[joint] + self.shift[joint]
                continue
            turn[joint] = turn[parent] @ self.local[joint]
            place[joint] = place[parent] + turn[parent] @ (HEADS[joint] - HEADS[parent] + self.shift[joint])
        return turn, place

    def turn_of(self, name):
        """The model rotation and the place of one joint."""
        turn, place = self.placed()
        return turn[INDEX[name]], place[INDEX[name]]


def about(axis, degrees):
    """The rotation about an axis."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    angle = np.radians(degrees)
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew


X_AXIS, Y_AXIS, Z_AXIS = np.eye(3)


def turned(pitch=0.0, yaw=0.0, roll=0.0):
    """The rotation that rolls, then pitches, then yaws."""
    return about(Y_AXIS, yaw) @ about(X_AXIS, pitch) @ about(Z_AXIS, -roll)


def posed(channels, time):
    """The pose of all joints but the equipment's scales."""
    c, pose = lambda name: channels(name, time), Pose()
    pose.shift[INDEX["hips"]] = c("hips.x"), c("hips.y"), c("hips.z")
    three = lambda name: np.array([c(f"{name}.pitch"), c(f"{name}.yaw"), c(f"{name}.roll")])
    pose.local[INDEX["hips"]] = turned(*three("hips"))
    spine, breath = three("spine"), c("breath")
    pose.local[INDEX["spine"]] = turned(*(0.45 * spine))
    pose.local[INDEX["chest"]] = turned(*(0.55 * spine - (breath, 0.0, 0.0)))
    pose.local[INDEX["neck"]] = turned(*three("neck") + (0.6 * breath, 0.0, 0.0))
    pose.local[INDEX["head"]] = turned(*three("head") + (0.4 * breath, 0.0, 0.0))
    if channels.has("floor"):
        _trunk_on_floor(pose)
    for side, sign in SIDES:
        _leg(channels, time, pose, side, sign)
        _arm(channels, time, pose, side, sign)
        _fingers(c, pose, side, sign)
        if channels.has("floor"):
            _arm_on_floor(pose, side)
    _carry(channels, time, pose)
    return pose


def _sided(axis, sign):
    """An axis of the left side, for a turn in the same sense on the other side."""
    return np.asarray(axis, float) if sign > 0 else np.asarray(axis, float) * (1.0, -1.0, -1.0)


def _arm(channels, time, pose, side, sign):
    c = lambda name: channels(name + side, time)
    shoulder, upper, lower, hand = (INDEX[name + side] for name in ("shoulder", "upper_arm", "forearm", "hand"))
    lift, forward = c("shoulder.lift") + 1.2 * channels("breath", time), c("shoulder.forward")
    if channels.has("hand" + side):
        goal, hand_turn = _hand_goal(channels, time, pose, side, sign)
        turn, place = pose.turn_of("chest")
        reach = turn.T @ (goal - place) - (HEADS[upper] - HEADS[INDEX["chest"]])
        reach = reach / np.linalg.norm(reach)
        share = 1.0 - c("loose")
        lift += share * SHOULDER_LIFT * smooth_step(0.0, 1.0, reach[1])
        forward += share * SHOULDER_FORWARD * reach[2]
    pose.local[shoulder] = about(_sided(Y_AXIS, sign), -forward) @ about(_sided(Z_AXIS, sign), lift)
    # Hanging straight down is 50 degrees below the rest pose.
    pose.local[upper] = (
        about(X_AXIS, -c("arm.swing"))
        @ about(_sided(Z_AXIS, sign), c("arm.out") - 50.0 - lift)
        @ about(_sided(ALONG, sign), c("arm.twist"))
    )
    pose.local[lower] = about(_sided(PALM_SIDE, sign), c("elbow")) @ about(
        _sided(LOWER, sign), FOREARM_TWIST * c("turn")
    )
    pose.local[hand] = (
        about(_sided(LOWER, sign), (1 - FOREARM_TWIST) * c("turn"))
        @ about(_sided(-THUMB_SIDE, sign), c("wrist"))
        @ about(_sided(PALM_SIDE, sign), c("wrist.side"))
    )
    if channels.has("hand" + side) and c("loose") < 1.0:
        free = pose.local[[upper, lower, hand]]
        pole = channels.vector("elbow.to" + side, time, (0.55 * sign, -0.75, -0.35))
        bend(pose, (upper, lower, hand), goal, hand_turn, pole)
        _share_twist(pose, lower, hand, LOWER if sign > 0 else LOWER * MIRROR)
        pose.local[[upper, lower, hand]] = [
            between(reached, loose, c("loose")) for reached, loose in zip(pose.local[[upper, lower, hand]], free)
        ]


def _hand_goal(channels, time, pose, side, sign):
    """Where the wrist goes and how the hand is turned: from the model's or from the chest's channels."""
    wrist = channels.vector("hand" + side, time)
    fingers = channels.vector("fingers" + side, time, (0.0, 0.0, 1.0))
    palm = channels.vector("palm" + side, time, (-sign, 0.0, 0.0))
    flip = np.array([sign, 1.0, 1.0])
    hand_turn = _frame(fingers, palm) @ _frame(flip * LOWER, flip * PALM_SIDE).T
    if channels("of_chest" + side, time) > 0.5:
        turn, place = pose.turn_of("chest")
        wrist = place + turn @ (wrist - HEADS[INDEX["chest"]])
        hand_turn = turn @ hand_turn
    return wrist, hand_turn


def _share_twist(pose, lower, hand, axis):
    """Gives the forearm its share of the hand's twist about it."""
    turn = pose.local[hand]
    w, x, y, z = quaternions(turn[None])[0]
    twist = 2.0 * np.arctan2(np.dot((x, y, z), axis), w)
    twist = (twist + np.pi) % (2 * np.pi) - np.pi
    part = about(axis, np.degrees(FOREARM_TWIST * twist))
    pose.local[lower] = pose.local[lower] @ part
    pose.local[hand] = part.T @ turn


def _fingers(c, pose, side, sign):
    curl, thumb = c("curl" + side), c("thumb" + side)
    axis = _sided(-THUMB_SIDE, sign)
    for name, more in (("index", 0.92), ("fingers", 1.08)):
        pose.local[INDEX[f"{name}.01{side}"]] = about(axis, more * curl)
        pose.local[INDEX[f"{name}.02{side}"]] = about(axis, more * 1.15 * curl)
    for name, share in (("thumb.01", 0.4), ("thumb.02", 0.7)):
        joint = INDEX[name + side]
        pose.local[joint] = about(FRAMES[joint][:, 0], share * (0.5 * curl + thumb))


def _leg(channels, time, pose, side, sign):
    """Puts a foot where the channels say, from its place at rest, or turns the leg's joints."""
    c = lambda name: channels(name + side, time)
    thigh, shin, foot, toe = (INDEX[name + side] for name in ("thigh", "shin", "foot", "toe"))
    free = [
        about(X_AXIS, -c("thigh.swing"))
        @ about(_sided(Z_AXIS, sign), c("thigh.out"))
        @ about(_sided(Y_AXIS, sign), c("thigh.twist")),
        about(FRAMES[shin][:, 0], c("knee")),
        about(X_AXIS, c("ankle")),
    ]
    pitch = c("foot.pitch")
    yaw = about(_sided(Y_AXIS, sign), c("foot.yaw"))
    turn = yaw @ about(X_AXIS, pitch) @ about(Z_AXIS, -c("foot.roll"))
    # A raised heel leaves the toes' joint in its place; raised toes leave the heel there.
    flip = np.array([sign, 1.0, 1.0])
    pivot = HEADS[toe] if pitch >= 0.0 or channels.has("on_wall") else HEEL * flip
    standing = HEADS[toe] + yaw @ (pivot - HEADS[toe])
    goal = (
        standing
        + turn @ (HEADS[foot] - pivot)
        + np.array([sign * c("foot.out") + c("foot.x"), c("foot.y"), c("foot.z")])
    )
    share = c("leg.free")
    if share < 1.0:
        hips = pose.turn_of("hips")[0]
        facing = about(Y_AXIS, sign * c("knee.out")) @ (hips @ Z_AXIS)
        pole = channels.vector("knee.to" + side, time, facing)
        bend(pose, (thigh, shin, foot), goal, turn, pole)
    pose.local[[thigh, shin, foot]] = [between(a, b, share) for a, b in zip(pose.local[[thigh, shin, foot]], free)]
    if channels.has("floor") and share > 0.0:
        _on_floor(pose, (thigh, shin, foot), flip)
    flat = smooth_step(0.10, 0.0, c("foot.y")) * (1.0 - share)
    pose.local[toe] = about(X_AXIS, -max(pitch, 0.0) * (0.25 + 0.75 * flat) * (1.0 - share) + c("toe"))


def _trunk_on_floor(pose):
    """Raises the hips where the back, the seat or the head would be in the ground."""
    turn, place = pose.placed()
    low = min(
        (place[INDEX[joint]] + turn[INDEX[joint]] @ (np.array(point) - HEADS[INDEX[joint]]))[1] for joint, point in BACK
    )
    pose.shift[INDEX["hips"]][1] += max(-low, 0.0)


def _arm_on_floor(pose, side):
    """Lifts an arm that would be in the ground."""
    upper = INDEX["upper_arm" + side]
    for _ in range(12):
        turn, place = pose.placed()
        ends = [
            (place[INDEX[name + side]], thick)
            for name, thick in (
                ("forearm", 0.052),
                ("hand", 0.035),
                ("fingers.01", 0.022),
                ("fingers.02", 0.012),
                ("index.02", 0.012),
            )
        ]
        point, short = min(((end, end[1] - thick) for end, thick in ends), key=lambda pair: pair[1])
        if short > -1e-3:
            return
        lever = np.cross(point - place[upper], Y_AXIS)
        size = np.linalg.norm(lever)
        step = about(lever / size, np.degrees(-0.8 * short / size))
        parent = turn[PARENT[upper]]
        pose.local[upper] = parent.T @ step @ parent @ pose.local[upper]


def _on_floor(pose, chain, flip):
    """Lifts a foot that would be in the ground."""
    turn, place = pose.placed()
    foot = chain[2]
    low = min((place[foot] + turn[foot] @ (point * flip - HEADS[foot]))[1] for point in (HEEL, TOE_END))
    if low < 0.0:
        pole = place[chain[1]] - (place[chain[0]] + place[foot]) / 2 + 0.02 * (turn[PARENT[chain[0]]] @ Z_AXIS)
        bend(pose, chain, place[foot] - (0.0, low, 0.0), turn[foot], pole)


def bend(pose, chain, goal, end_turn, pole):
    """Two-bone IK: turns chain[0] and chain[1] so that chain[2] is at `goal`, turned `end_turn`.

    The middle joint lies towards `pole`. Closed form, by the law of cosines.
    """
    first, second, end = chain
    turn, place = pose.placed()
    parent = turn[PARENT[first]]
    upper, lower = HEADS[second] - HEADS[first], HEADS[end] - HEADS[second]
    a, b = np.linalg.norm(upper), np.linalg.norm(lower)
    root = place[first]
    reach = goal - root
    direction = reach / np.linalg.norm(reach)
    distance = np.clip(np.linalg.norm(reach), abs(a - b) * 1.05, (a + b) * MOST_STRETCH)
    out = np.asarray(pole, float)
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
    """Axes along a direction and a second one, made square to it, as columns."""
    x = np.asarray(direction, float) / np.linalg.norm(direction)
    z = normal - x * (np.asarray(normal, float) @ x)
    z = z / np.linalg.norm(z)
    return np.stack([x, np.cross(z, x), z], axis=1)


def between(first, second, share):
    """The rotation a share of the way from one to another."""
    if share <= 0.0 or share >= 1.0:
        return second if share >= 1.0 else first
    w, *axis = quaternions((first.T @ second)[None])[0]
    axis = np.array(axis) * (1.0 if w >= 0.0 else -1.0)
    size = np.linalg.norm(axis)
    if size < 1e-9:
        return first
    return first @ about(axis, np.degrees(2.0 * np.arctan2(size, abs(w)) * share))


def _carry(channels, time, pose):
    """Equipment: the sword's grip, the arrow on the string, the scabbard clear of the ground."""
    c = lambda name: channels(name, time)
    sword = INDEX["sword"]
    # A sword held the other way round points from the little finger's side.
    pose.local[sword] = about(FRAMES[sword][:, 0], 180.0 * c("sword.flip"))
    scabbard = INDEX["scabbard"]
    pose.local[scabbard] = about(X_AXIS, c("scabbard")) @ about(Z_AXIS, c("scabbard.out"))
    turn, place = pose.placed()
    for _ in range(24):
        tip = place[scabbard] + turn[PARENT[scabbard]] @ pose.local[scabbard] @ (SCABBARD * FRAMES[scabbard][:, 1])
        short = SCABBARD_CLEAR - tip[1]
        if short <= 1e-4:
            break
        lever = np.cross(tip - place[scabbard], Y_AXIS)
        lever /= max(np.linalg.norm(lever), 1e-6)
        step = about(turn[PARENT[scabbard]].T @ lever, np.degrees(0.5 * min(short, 0.1) / SCABBARD))
        pose.local[scabbard] = step @ pose.local[scabbard]
    if channels.has("floor"):
        _back_on_floor(pose, turn, place)
    nocked = c("nocked")
    if nocked > 0.0:
        arrow, bow, string = INDEX["arrow"], INDEX["bow"], INDEX["bow_string"]
        rest = turn[bow] @ FRAMES[bow]
        aim = place[bow] + 0.022 * rest[:, 1] - place[arrow]
        hand = turn[PARENT[arrow]]
        wanted = hand.T @ _frame(aim, rest[:, 1]) @ _frame(FRAMES[arrow][:, 1], -FRAMES[arrow][:, 2]).T
        pose.local[arrow] = between(np.eye(3), wanted, nocked)
        pulled = turn[bow].T @ (place[arrow] - place[bow]) - (HEADS[string] - HEADS[bow])
        pose.shift[string] = c("string") * pulled


def _back_on_floor(pose, turn, place):
    """Pushes bow and quiver up where he lies on them."""
    chest = turn[INDEX["chest"]]
    for name, points in (
        ("bow_back", ((0.0, 0.6, -0.12), (0.0, 0.0, 0.01), (0.0, -0.6, -0.12))),
        ("quiver", ((0.045, 0.0, 0.0), (0.05, 0.45, 0.0))),
    ):
        joint = INDEX[name]
        low = min((place[joint] + turn[joint] @ FRAMES[joint] @ np.array(point))[1] for point in points)
        pose.shift[joint] += chest.T @ np.array([0.0, max(BACK_CLEAR - low, 0.0), 0.0])


def skinned(figure, pose):
    """Points and normals of the rest pose, moved by linear blend skinning."""
    turn, place = pose.placed()
    scale = pose.scale.copy()
    for joint, parent in enumerate(PARENT):
        if parent >= 0 and scale[parent] == 0.0:
            # What hangs on a hidden piece is hidden in it.
            scale[joint], place[joint] = 0.0, place[parent]
    points, normals = np.zeros_like(figure.points), np.zeros_like(figure.normals)
    for joint in np.flatnonzero(figure.weights.any(axis=0)):
        rows = np.flatnonzero(figure.weights[:, joint])
        weight = figure.weights[rows, joint, None]
        points[rows] += weight * ((figure.points[rows] - HEADS[joint]) @ (scale[joint] * turn[joint]).T + place[joint])
        normals[rows] += weight * (figure.normals[rows] @ turn[joint].T)
    return points, normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
