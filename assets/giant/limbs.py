"""Arms and legs whose hands and feet are put somewhere: two-bone IK in closed form."""

import numpy as np

from .skeleton import HEADS, INDEX, PARENT
from .turns import between, frame, turned, turned_back

# From the ball of a foot to the end of its heel; and how high the toes hang free, in metres.
HEEL, TOES_FREE = 5.0, 5.0
# How far the flesh under the ball lifts a foot for each degree that its heel is raised, in metres.
BALL_ROLL = 0.02
# The last share of an arm's length, which a held wrist reaches only softly.
ARM_GIVE = 0.16
# Where a held arm's elbow points, in the chest's rest pose (left side).
ELBOW = np.array([0.75, 0.6, 0.3])
# The share of a leg's or an arm's length to which IK straightens it at most.
MOST_STRETCH = 0.9985


def reach(c, pose, side, sign):
    """Takes the wrist, by the share `hand.hold`, to a place and a turn in the model's axes.

    The elbow points aside and backwards, as far as the wrist is held.
    """
    first, second, end = (INDEX[name + side] for name in ("upper_arm", "forearm", "hand"))
    hold = c("hand.hold" + side)
    turn, place = pose.placed()
    goal = np.stack([sign * c("hand.x" + side), c("hand.y" + side), c("hand.z" + side)], axis=1)
    goal = (1 - hold[:, None]) * place[:, end] + hold[:, None] * goal
    upper, lower = place[:, second] - place[:, first], place[:, end] - place[:, second]
    normal = np.cross(upper, lower)
    before = frame(upper, normal), frame(lower, normal)
    long = np.linalg.norm(HEADS[second] - HEADS[first]), np.linalg.norm(HEADS[end] - HEADS[second])
    pole = turn[:, INDEX["chest"]] @ (ELBOW * (sign, 1.0, 1.0))
    out = (1 - hold[:, None]) * upper / long[0] + hold[:, None] * pole
    goal = _within(place[:, first], goal, sum(long), ARM_GIVE * hold[:, None])
    middle, target = _middle(place[:, first], goal, *long, out)
    upper, lower = middle - place[:, first], target - middle
    normal = np.cross(upper, lower)
    first_turn = frame(upper, normal) @ turned_back(before[0]) @ turn[:, first]
    second_turn = frame(lower, normal) @ turned_back(before[1]) @ turn[:, second]
    wanted = turned(c("hand.pitch" + side), sign * c("hand.yaw" + side), sign * c("hand.roll" + side))
    hand = between(second_turn @ pose.local[:, end], wanted, hold)
    pose.local[:, first] = turned_back(turn[:, PARENT[first]]) @ first_turn
    pose.local[:, second] = turned_back(first_turn) @ second_turn
    pose.local[:, end] = turned_back(second_turn) @ hand


def _within(root, goal, length, give):
    """The goal, or a place before it: an arm straightens the slower the straighter it is.

    `give` is the share of the length over which it does. Without it an elbow snaps when it stops to reach.
    """
    line = goal - root
    distance = np.linalg.norm(line, axis=1, keepdims=True)
    room = np.maximum(give, 1e-6) * length
    over = np.maximum(distance - (length - room), 0.0)
    return root + line * ((distance - over + room * (1.0 - np.exp(-over / room))) / distance)


def leg(c, pose, side, sign):
    """Puts a foot's ball where the channels say (from its place at rest) and bends the leg to it."""
    at = lambda name: c(f"foot.{name}{side}")
    ball, ankle = HEADS[INDEX["toe" + side]], HEADS[INDEX["foot" + side]]
    foot = turned(at("pitch"), at("yaw"), at("roll"))
    # Toes up: the foot stands on its heel, which raises the ball.
    height = at("z") + HEEL * np.sin(np.radians(np.maximum(-at("pitch"), 0.0)))
    height += BALL_ROLL * np.maximum(at("pitch"), 0.0)
    goal = ball + np.stack([sign * at("out") + at("x"), at("y"), height], axis=1) + foot @ (ankle - ball)
    bend(pose, ("thigh" + side, "shin" + side, "foot" + side), goal, foot)
    toe = -np.maximum(at("pitch"), 0.0) * np.clip(1.0 - at("z") / TOES_FREE, 0.3, 1.0)
    pose.local[:, INDEX["toe" + side]] = turned(toe + at("toe"))


def bend(pose, chain, goal, end_turn):
    """Turns chain[0] and chain[1] so that chain[2] is at `goal`, turned `end_turn`.

    The middle joint keeps to the side of the plane where it is at rest, as the parent turns.
    """
    first, second, end = (INDEX[name] for name in chain)
    turn, place = pose.placed()
    parent = turn[:, PARENT[first]]
    upper, lower = HEADS[second] - HEADS[first], HEADS[end] - HEADS[second]
    rest = HEADS[end] - HEADS[first]
    out = parent @ (upper - rest * (upper @ rest) / (rest @ rest))
    root = place[:, first]
    middle, target = _middle(root, goal, np.linalg.norm(upper), np.linalg.norm(lower), out)
    normal_rest, normal = np.cross(upper, lower), np.cross(middle - root, target - middle)
    first_turn = frame(middle - root, normal) @ frame(upper, normal_rest).T
    second_turn = frame(target - middle, normal) @ frame(lower, normal_rest).T
    pose.local[:, first] = turned_back(parent) @ first_turn
    pose.local[:, second] = turned_back(first_turn) @ second_turn
    pose.local[:, end] = turned_back(second_turn) @ end_turn


def _middle(root, goal, a, b, out):
    """Where a chain's middle and end are that begins at `root` and reaches for `goal` (law of cosines)."""
    line = goal - root
    length = np.linalg.norm(line, axis=1, keepdims=True)
    distance = np.clip(length, abs(a - b) * 1.05, (a + b) * MOST_STRETCH)
    direction = line / length
    out = out - direction * (out * direction).sum(axis=1, keepdims=True)
    out = out / np.linalg.norm(out, axis=1, keepdims=True)
    along = (a * a - b * b + distance * distance) / (2 * distance)
    middle = root + along * direction + np.sqrt(np.maximum(a * a - along * along, 0.0)) * out
    return middle, root + distance * direction
