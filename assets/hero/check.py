"""What must hold of the result, checked on the file that was written and on the clips.

Poses are read back from the file: joints, skin and clips are worked out as a game would do it.
"""

import numpy as np
from giant import glb

from .skeleton import GEAR, INDEX, JOINTS, NAMES, PARENT

MOST_TRIANGLES = 12_000
MOST_BYTES = 4_000_000
HEIGHT, HEIGHT_ERROR = 1.75, 0.01
# A loop's last pose may differ from its first by this much, in radians and in metres.
LOOP_GAP = 1e-3
# Where a loop closes, a joint's speed may change by this much (rad/s), or by this share of
# the largest change of any joint elsewhere: feet that plant change their speed.
LOOP_JOLT, LOOP_JOLT_SHARE = 0.5, 1.1
# A standing foot may slide by this much in a second, and sink by this much, in metres.
FOOT_SLIDE, FOOT_SINK = 0.03, 0.01
# A part of the sole touches the ground if it is lower than this, in metres.
TOUCHES = 0.0015
# Right and left may differ by this much in the rest pose.
MIRROR_ERROR = 1e-5
# Points of the left sole at rest, and the joint that each follows.
SOLE = (("foot", (0.098, 0.0, -0.085)), ("toe", (0.112, 0.0, 0.115)), ("toe", (0.114, 0.0, 0.170)))
CLIPS = """idle walk run walk_back strafe_left strafe_right turn_left turn_right jump fall land_soft land_hard tumble climb
hang ledge mantle crouch get_up lie die crushed stab_raise stab_hold stab_strike swing draw aim loose unsheathe sheathe""".split()
LENGTHS = {
    "idle": 4.0,
    "jump": 0.35,
    "land_soft": 0.5,
    "land_hard": 0.9,
    "mantle": 1.2,
    "tumble": 0.8,
    "get_up": 1.2,
    "die": 1.5,
    "stab_raise": 0.5,
    "stab_strike": 0.35,
    "swing": 0.6,
    "draw": 0.6,
    "loose": 0.3,
    "unsheathe": 0.5,
    "sheathe": 0.5,
}
MARKERS = {
    "walk": ["step_left", "step_right"],
    "run": ["step_left", "step_right"],
    "walk_back": ["step_left", "step_right"],
    "jump": ["take_off"],
    "land_soft": ["land"],
    "land_hard": ["land"],
    "stab_strike": ["hit"],
    "swing": ["hit"],
    "loose": ["loose"],
    "unsheathe": ["unsheathed"],
    "sheathe": ["sheathed"],
}
SPEEDS = {"walk": 1.4, "run": 4.0, "walk_back": 1.2, "strafe_left": 1.2, "strafe_right": 1.2}
# Clips during which no part of the body may sink into the ground.
GROUNDED = """idle walk run walk_back strafe_left strafe_right turn_left turn_right land_soft land_hard crouch crushed get_up lie
die stab_raise stab_hold stab_strike swing draw aim loose unsheathe sheathe""".split()
# A clip that ends as another one begins may differ by this much, in metres and in axes.
JOINED_GAP = 2e-3
# How deep the skin may be in the ground, in metres: cloth and flesh give way.
BODY_SINK = 0.03


class Played:
    """The joints of the file and its clips, evaluated as glTF says."""

    def __init__(self, document, binary):
        self.document, self.binary = document, binary
        self.nodes = document["nodes"]
        self.joints = document["skins"][0]["joints"]
        self.order = {self.nodes[node]["name"]: node for node in self.joints}
        self.parent = {child: number for number, node in enumerate(self.nodes) for child in node.get("children", ())}
        self.clips = {animation["name"]: self._tracks(animation) for animation in document["animations"]}

    def _tracks(self, animation):
        tracks = {}
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            values = glb.accessor(self.document, self.binary, sampler["output"]).astype(float)
            times = glb.accessor(self.document, self.binary, sampler["input"]).reshape(-1).astype(float)
            assert len(times) == len(values) and (np.diff(times) > 0.0).all(), animation["name"]
            assert np.isfinite(values).all(), f"{animation['name']}: not a number"
            tracks[channel["target"]["node"], channel["target"]["path"]] = (times, values, sampler["interpolation"])
        return tracks

    def local(self, clip, node, time):
        """Translation, quaternion and scale of a node."""
        rest = self.nodes[node]
        result = []
        for path, default in (("translation", (0, 0, 0)), ("rotation", (0, 0, 0, 1)), ("scale", (1, 1, 1))):
            track = self.clips[clip].get((node, path)) if clip else None
            result.append(np.asarray(rest.get(path, default), float) if track is None else _sampled(track, time))
        result[1] = result[1] / np.linalg.norm(result[1])
        return result

    def matrices(self, clip=None, time=0.0):
        """Model matrices of all joints by name."""
        done = {}

        def matrix(node):
            if node not in done:
                place, turn, scale = self.local(clip, node, time)
                own = np.eye(4)
                own[:3, :3], own[:3, 3] = _rotation(turn) * scale, place
                done[node] = matrix(self.parent[node]) @ own if node in self.parent else own
            return done[node]

        return {name: matrix(node) for name, node in self.order.items()}

    def length(self, clip):
        """The time of the last key."""
        return max(times[-1] for times, _, _ in self.clips[clip].values())


def _sampled(track, time):
    times, values, interpolation = track
    index = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(times) - 1))
    if interpolation == "STEP" or index == len(times) - 1:
        return values[index]
    share = np.clip((time - times[index]) / (times[index + 1] - times[index]), 0.0, 1.0)
    return values[index] + share * (values[index + 1] - values[index])


def _rotation(quaternion):
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def check(path, figure, moves):
    """All checks; the first one that fails ends the build."""
    document, binary = glb.read(path)
    size = path.stat().st_size
    assert size <= MOST_BYTES, f"the file has {size} bytes, more than {MOST_BYTES}"
    played = Played(document, binary)
    _check_joints(played)
    skin = _check_mesh(document, binary, played)
    _check_mirror(played)
    _check_clips(document, played, moves)
    for move in moves:
        if move.loops:
            _check_loop(played, move)
        _check_feet(played, move)
        if move.name in GROUNDED:
            _check_ground(played, move, skin)
    print(f"file: {size} bytes, {len(JOINTS)} joints, {len(moves)} clips")


def _check_joints(played):
    missing = set(NAMES) - set(played.order)
    assert not missing, f"joints are missing: {sorted(missing)}"
    for joint in JOINTS:
        parent = played.nodes[played.parent[played.order[joint.name]]]["name"]
        assert parent == (joint.parent or "hero"), f"{joint.name} hangs on {parent}"
    assert PARENT[0] == -1 and NAMES[0] == "root"


def _check_mesh(document, binary, played):
    """Triangles, influences and height; returns positions, joints and weights of all vertices."""
    parts, triangles = [], 0
    for primitive in document["meshes"][0]["primitives"]:
        attributes = primitive["attributes"]
        assert "JOINTS_1" not in attributes, "more than four influences"
        points, normals, joints, weights = (
            glb.accessor(document, binary, attributes[name]) for name in ("POSITION", "NORMAL", "JOINTS_0", "WEIGHTS_0")
        )
        index = glb.accessor(document, binary, primitive["indices"]).reshape(-1)
        assert index.max() < len(points), "an index without a vertex"
        assert np.isfinite(points).all() and np.isfinite(normals).all() and np.isfinite(weights).all(), (
            "a vertex is not a number"
        )
        assert np.abs(np.linalg.norm(normals, axis=1) - 1.0).max() < 1e-3, "a normal is not a unit vector"
        assert (weights >= 0.0).all() and np.abs(weights.sum(axis=1) - 1.0).max() < 1e-5, "weights do not sum to 1"
        triangles += len(index) // 3
        parts.append((points, joints, weights))
    points, joints, weights = (np.concatenate(column) for column in zip(*parts))
    assert triangles < MOST_TRIANGLES, f"{triangles} triangles, the limit is {MOST_TRIANGLES}"
    gear = np.isin(joints[:, 0], [INDEX[name] for name in GEAR])
    low, high = points[~gear, 1].min(), points[~gear, 1].max()
    assert abs(low) < 1e-3, f"the soles are at {low:.4f} m"
    assert abs(high - HEIGHT) <= HEIGHT_ERROR, f"he is {high:.3f} m tall"
    print(f"mesh: {triangles} triangles, {len(points)} vertices, {high:.3f} m tall")
    rest = played.matrices()
    inverse = (
        glb.accessor(document, binary, document["skins"][0]["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
    )
    for number, name in enumerate(NAMES):
        error = np.abs(rest[name] @ inverse[number] - np.eye(4)).max()
        assert error < 1e-5, f"{name}: the rest pose is not the pose of the skin, by {error}"
    return points[~gear], joints[~gear], weights[~gear], inverse


def _check_mirror(played):
    rest = played.matrices()
    flip = np.diag([-1.0, 1.0, 1.0])
    for name in NAMES:
        if not name.endswith(".L"):
            continue
        left, right = rest[name], rest[name[:-1] + "R"]
        # The mirror image of a frame, with +X turned round so that it stays right-handed.
        image = flip @ left[:3, :3] @ flip
        error = max(np.abs(image - right[:3, :3]).max(), np.abs(flip @ left[:3, 3] - right[:3, 3]).max())
        assert error < MIRROR_ERROR, f"{name} is not the mirror image of its other side, by {error}"


def _check_clips(document, played, moves):
    names = [animation["name"] for animation in document["animations"]]
    assert sorted(names) == sorted(CLIPS), f"clips that are missing or too many: {sorted(set(names) ^ set(CLIPS))}"
    for animation in document["animations"]:
        name, tag = animation["name"], animation["extras"]["clamber"]
        length = played.length(name)
        assert abs(length - LENGTHS.get(name, length)) < 1e-5, f"{name} lasts {length} s"
        found = [marker["name"] for marker in tag["markers"]]
        assert set(MARKERS.get(name, ())) <= set(found), f"{name} has the markers {found}"
        assert all(0.0 <= marker["time"] <= length for marker in tag["markers"]), (
            f"{name}: a marker is outside the clip"
        )
        assert abs(tag.get("speed", 0.0) - SPEEDS.get(name, 0.0)) < 1e-6, f"{name}: speed {tag.get('speed')}"
        moved = {node for node, _ in played.clips[name]}
        assert played.order["root"] not in moved, f"{name} moves the root"
    for first, second in (("die", "lie"), ("jump", "fall")):
        _check_joined(played, first, second)


def _check_joined(played, first, second):
    """One clip ends in the pose in which another one begins."""
    end, start = played.matrices(first, played.length(first)), played.matrices(second, 0.0)
    for joint in NAMES:
        if joint not in GEAR:
            gap = np.abs(end[joint] - start[joint]).max()
            assert gap < JOINED_GAP, f"{first} does not end as {second} begins: {joint} differs by {gap:.3f}"


def _check_loop(played, move):
    """The last pose is the first one, and the motion goes on as it was."""
    length, inside, worst, where = played.length(move.name), 0.0, 0.0, ""
    for name, node in played.order.items():
        first, last = (played.local(move.name, node, time) for time in (0.0, length))
        gap = 2.0 * np.arccos(np.clip(abs(first[1] @ last[1]), 0.0, 1.0))
        assert gap < LOOP_GAP and np.abs(first[0] - last[0]).max() < LOOP_GAP, (
            f"{move.name} does not close: {name} differs by {gap:.4f} rad"
        )
        assert np.abs(first[2] - last[2]).max() == 0.0, f"{move.name} does not close: the scale of {name}"
        times = np.linspace(0.0, length, len(move.poses))
        turns = [played.local(move.name, node, time)[1] for time in times]
        speeds = [_speed(one, two) / times[1] for one, two in zip(turns, turns[1:])]
        jolts = [np.linalg.norm(two - one) for one, two in zip(speeds, [*speeds[1:], speeds[0]])]
        inside = max(inside, *jolts[:-1])
        if jolts[-1] > worst:
            worst, where = jolts[-1], name
    assert worst < max(LOOP_JOLT, LOOP_JOLT_SHARE * inside), (
        f"{move.name} jolts where it closes: {where} by {worst:.2f} rad/s"
    )


def _speed(first, last):
    """The rotation vector from one quaternion to another."""
    turn = _rotation(last) @ _rotation(first).T
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    size = np.linalg.norm(axis)
    return axis / max(size, 1e-12) * np.arctan2(size, np.trace(turn) - 1.0)


def _soles(played, rest, clip, time):
    """Places of the soles' points: {side: (points, 3)}."""
    matrices = played.matrices(clip, time)
    result = {}
    for side, sign in ((".L", 1.0), (".R", -1.0)):
        points = []
        for joint, place in SOLE:
            name = joint + side
            local = np.linalg.inv(rest[name]) @ np.append(np.multiply(place, (sign, 1.0, 1.0)), 1.0)
            points.append((matrices[name] @ local)[:3])
        result[side] = np.array(points)
    return result


def _check_feet(played, move):
    """Standing feet go with the ground and do not sink."""
    if not move.stands:
        return
    rest, worst_slide, worst_sink = played.matrices(), 0.0, 0.0
    steps = len(move.poses) - 1
    times = np.linspace(0.0, move.length, steps + 1)
    soles = [_soles(played, rest, move.name, time) for time in times]
    step = move.length / steps
    forward, left, turn = move.travel[1], move.travel[0], np.radians(move.travel[2])
    for first, last, time in zip(soles, soles[1:], times):
        for side, start, end in move.stands:
            if time < start - 1e-9 or time + step > end + 1e-9:
                continue
            lowest = first[side][:, 1].min()
            assert lowest < TOUCHES, (
                f"{move.name}: the foot {side[1]} is in the air at {time:.2f} s, lowest {lowest:.4f} m"
            )
            worst_sink = max(worst_sink, float(-lowest))
            low = (first[side][:, 1] < TOUCHES) & (last[side][:, 1] < TOUCHES)
            if not low.any():
                # It rolls from the heel to the ball.
                continue
            middle = (first[side] + last[side]) / 2
            # The ground goes backwards, and round against the turn.
            ground = np.array([-left, 0.0, -forward]) - turn * np.stack(
                [middle[:, 2], 0 * middle[:, 0], -middle[:, 0]], axis=1
            )
            slide = ((last[side] - first[side]) / step - ground)[low][:, [0, 2]]
            worst_slide = max(worst_slide, float(np.linalg.norm(slide, axis=1).max()))
    print(
        f"{move.name}: standing feet slide by at most {100 * worst_slide:.2f} cm/s and sink by {100 * worst_sink:.2f} cm"
    )
    assert worst_slide < FOOT_SLIDE, f"{move.name}: a standing foot slides by {worst_slide:.3f} m/s"
    assert worst_sink < FOOT_SINK, f"{move.name}: a standing foot sinks by {worst_sink:.3f} m"


def _check_ground(played, move, skin):
    """No part of the body is in the ground."""
    points, joints, weights, inverse = skin
    flat = np.concatenate([points, np.ones((len(points), 1))], axis=1)
    for time in np.linspace(0.0, move.length, 9):
        matrices = played.matrices(move.name, time)
        palette = np.stack([matrices[name] for name in NAMES]) @ inverse
        height = np.zeros(len(points))
        for slot in range(4):
            height += weights[:, slot] * (palette[joints[:, slot], 1] * flat).sum(axis=1)
        low = int(height.argmin())
        assert height[low] > -BODY_SINK, (
            f"{move.name}: at {time:.2f} s the skin of {NAMES[joints[low, 0]]} is {-height[low]:.3f} m in the ground"
        )
