"""What must hold of the result, checked on the file that was written and on the meshes."""

import numpy as np

from . import clips, feel, flesh, glb, motion, nets, reach, rideable, stone
from .skeleton import INDEX

VISUAL_VERTICES = (50_000, 100_000)
COLLISION_VERTICES = (5_000, 10_000)
MOST_BYTES = 8_500_000
# No skin may be deeper in the ground, in metres; no planted sole may slide faster over it, in metres a
# second (95 % of all moments); and what was at rest may not start with more than half of gravity.
DEEPEST, MOST_SLIDE, START_PULL = 0.10, 0.15, 4.9
# A loop may not be farther from closing, and a one-shot not farther from the idle's first pose.
CLOSED, SAME = 1e-9, 1e-3
# Seconds from the start of a blow to its active window: long enough to run, short enough to matter. Others
# (roars, shakes) take at most as long.
STOMP_WIND_UP, WIND_UP = (1.3, 1.6), (0.9, 1.6)
# How high a stomping foot is raised (metres), how far the head turns to it (degrees), and how close the
# sole is to the ground at an impact (metres).
STOMP_HEIGHT, STOMP_TURN, IMPACT_HEIGHT = 4.0, 15.0, 0.1
# A hand that strikes is at these heights (metres) for at least that share of the active window, in which it is
# never higher than LIFTED. It hits everybody on an arc (degrees) at such a distance (metres); so does a foot.
REACH, LEAST_LOW, LIFTED = (0.3, 0.9), 0.75, 1.5
ARC = {reach.HAND: (100.0, 10.0, 20.0), reach.FOOT: (60.0, 5.0, 12.0)}
# A planted leg keeps some bend (a share of its length): a game plants feet by IK, and drags them where a leg is
# too short.
MOST_STRETCH = 0.97
# Each blow's limb.
BLOWS = {
    "stomp": (reach.FOOT, ".R"), "stomp_left": (reach.FOOT, ".L"),
    "swipe": (reach.HAND, ".R"), "swipe_left": (reach.HAND, ".L"),
    "sweep_right": (reach.HAND, ".R"), "sweep_left": (reach.HAND, ".L"),
    "kick_right": (reach.FOOT, ".R"), "kick_left": (reach.FOOT, ".L"),
}
# The markers without which a game cannot use a clip.
_BLOW, _STEPS = {"wind_up", "active", "recovery"}, {"step_left", "step_right"}
MARKERS = {
    **{name: _BLOW | ({"impact"} if limb == reach.FOOT else set()) for name, (limb, _) in BLOWS.items()},
    **{name: _BLOW for name in ("shrug", "shake", "shake_head", "shake_arm_left", "shake_arm_right", "rage")},
    **{name: _BLOW for name in ("roar", "rub_left", "rub_right")},
    **{name: _STEPS for name in ("walk", "turn_left", "turn_right")},
    "expose": {"exposed", "covered", "impact"}, "stagger": {"impact"}, "die": {"impact"},
}
# Which clip shakes riders at which weak point (the right forearm has none, and shakes like the left one).
RIDES = (
    ("shrug", "weak_point_nape"), ("shake", "weak_point_nape"), ("shake_loop", "weak_point_nape"), ("rage", "weak_point_nape"),
    ("shake_head", "weak_point_head"), ("shake_arm_left", "weak_point_forearm.L"), ("shake_arm_right", "weak_point_forearm.R"),
)
# A shake throws for so long (seconds). It tires by so much (metres a second), of which 60 use up a fresh
# climber's stamina: two shakes can be survived, six cannot. It can be held out at such a pull, and a shrug
# only warns (metres a second squared).
LEAST_THROW, TIRING, HELD, SHRUG = 0.3, (10.0, 20.0), 10.5, (6.0, 10.0)
# Shakes of the nape may tire riders at these places by no more (metres a second).
SPARED, MOST_SPARED = ("weak_point_head", "weak_point_forearm.L", "weak_point_forearm.R"), 25.0
# What lies on the ground has skin this close to it, in metres.
LYING = 0.7
# Distance of the meshes, in metres: the median, and what 99.5 % of the vertices keep to. The rest sit
# in slots between stone and fur that the coarse grid closes.
MESH_GAP = (0.15, 0.75)
# Vertices of the visual mesh that lie deeper inside the creature are seen by nobody.
BURIED = 0.2


def check_file(path):
    """Joints, clips, extras and sizes of the written file."""
    document, binary = glb.read(path)
    size = path.stat().st_size
    assert size <= MOST_BYTES, f"{size} bytes"
    print(f"file: {size} bytes, {document['asset']}")
    joints = document["skins"][0]["joints"]
    assert len(document["skins"]) == 1 and len(joints) >= 40, f"{len(joints)} joints"
    print(f"skeleton: {len(joints)} joints")
    for role, limits in (("visual", VISUAL_VERTICES), ("collision", COLLISION_VERTICES)):
        _check_mesh(document, binary, role, limits)
    _check_clips(document, binary)
    weak = [node for node in document["nodes"] if "weak_point" in node.get("extras", {}).get("clamber", {})]
    parents = {child: node["name"] for node in document["nodes"] for child in node.get("children", ())}
    for node in weak:
        point = node["extras"]["clamber"]["weak_point"]
        assert type(point["major"]) is bool and point["hit_points"] > 0.0, point
        parent = parents[document["nodes"].index(node)]
        assert any(document["nodes"][joint]["name"] == parent for joint in joints), parent
        print(f"weak point: {node['name']} on {parent}: {node['extras']}")
    assert len(weak) == 3 and sum(node["extras"]["clamber"]["weak_point"]["major"] for node in weak) == 1


def _check_mesh(document, binary, role, limits):
    nodes = [node for node in document["nodes"] if node.get("extras", {}).get("clamber", {}).get("role") == role]
    assert len(nodes) == 1 and "skin" in nodes[0], f"{role}: {nodes}"
    vertices = triangles = 0
    corners, tags = [], {}
    for primitive in document["meshes"][nodes[0]["mesh"]]["primitives"]:
        points = glb.accessor(document, binary, primitive["attributes"]["POSITION"])
        index = glb.accessor(document, binary, primitive["indices"]).reshape(-1)
        weights = glb.accessor(document, binary, primitive["attributes"]["WEIGHTS_0"])
        assert "JOINTS_1" not in primitive["attributes"] and np.abs(weights.sum(axis=1) - 1.0).max() < 1e-4
        if role == "visual":
            assert {"NORMAL", "TEXCOORD_0", "COLOR_0"} <= primitive["attributes"].keys(), primitive
        vertices, triangles = vertices + len(points), triangles + len(index) // 3
        corners.append(points[index])
        material = document["materials"][primitive["material"]]
        tags[material["name"]] = material["extras"]
    _, welded = np.unique(np.concatenate(corners), axis=0, return_inverse=True)
    count = int(welded.max()) + 1
    assert limits[0] <= vertices <= limits[1], f"{role}: {vertices} vertices"
    print(f"{role}: {vertices} vertices ({count} welded), {triangles} triangles, {tags}")
    if role == "collision":
        assert limits[0] <= count <= limits[1], f"{count} welded vertices"
        assert nets.is_closed_manifold(welded.reshape(-1, 3)), "the collision mesh is not closed"


def _check_clips(document, binary):
    found = {}
    size = set()
    for animation in document["animations"]:
        times = {sampler["input"] for sampler in animation["samplers"]}
        found[animation["name"]] = max(document["accessors"][time]["max"][0] for time in times)
        size |= times | {sampler["output"] for sampler in animation["samplers"]}
    bytes_used = sum(glb.accessor(document, binary, number).nbytes for number in size)
    assert set(found) == set(clips.TABLES) and len(document["animations"]) == len(found), found
    print(f"clips: {found}, {bytes_used} bytes")


def check_shapes(coarse, fine):
    """Angles of the collision mesh, and how far it is from the visual mesh."""
    mesh = coarse.mesh
    assert nets.is_closed_manifold(mesh.triangles)
    angles = np.degrees(nets.smallest_angles(mesh.points, mesh.triangles))
    print(f"collision angles: smallest {angles.min():.1f} degrees, {(angles < 5.0).sum()} below 5")
    assert (angles < 5.0).mean() < 0.002
    points = fine.mesh.points[::2]
    seen = np.minimum(flesh.body(points), stone.smooth(points)) > -BURIED
    gap = distances(points[seen], mesh)
    median, most = np.percentile(gap, (50.0, 99.5))
    print(f"visual to collision mesh: median {median:.3f} m, 99.5 % {most:.3f} m, worst {gap.max():.3f} m")
    assert median < MESH_GAP[0] and most < MESH_GAP[1], (median, most)


def distances(points, mesh, cell=2.0):
    """Distances of points to a mesh, from samples of its triangles near each point."""
    steps = 9
    u, v = np.meshgrid(np.arange(steps + 1), np.arange(steps + 1))
    inside = u + v <= steps
    u, v = u[inside] / steps, v[inside] / steps
    a, b, c = (mesh.points[mesh.triangles[:, index]][:, None] for index in range(3))
    samples = (a * (1 - u - v)[None, :, None] + b * u[None, :, None] + c * v[None, :, None]).reshape(-1, 3)
    buckets = {}
    keys = (samples // cell).astype(int)
    order = np.lexsort(keys.T)
    change = np.flatnonzero(np.any(np.diff(keys[order], axis=0), axis=1)) + 1
    for group in np.split(order, change):
        buckets[tuple(keys[group[0]])] = samples[group]
    result = np.empty(len(points))
    keys = (points // cell).astype(int)
    order = np.lexsort(keys.T)
    change = np.flatnonzero(np.any(np.diff(keys[order], axis=0), axis=1)) + 1
    around = [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)]
    for group in np.split(order, change):
        key = keys[group[0]]
        near = [buckets[k] for k in (tuple(key + np.array(o)) for o in around) if k in buckets]
        if not near:
            result[group] = cell
            continue
        near = np.concatenate(near).astype(np.float32)
        for start in range(0, len(group), 64):
            part = group[start : start + 64]
            offset = points[part].astype(np.float32)[:, None] - near[None]
            result[part] = np.sqrt((offset * offset).sum(axis=2).min(axis=1))
    return result


def check_motion(moves, points, weights, fur):
    """Prints the figures of all clips, then fails if one is out of its limits; `fur` marks what can be gripped."""
    by_name = {clip.name: clip for clip in moves}
    faults = []

    def expect(holds, what):
        if not holds:
            faults.append(what)

    print(f"clip             length  lowest  slide   bend  start (limits: "
          f"{-DEEPEST} m, {MOST_SLIDE} m/s, {MOST_STRETCH}, {START_PULL} m/s^2)")
    for clip in moves:
        low, slide = feel.standing(clip, points, weights)
        pull, joint, time = feel.starts(clip)
        stretch = feel.stretch(clip, points, weights)
        print(f"{clip.name:16} {clip.length:6.2f} {low:7.2f} {slide:6.3f} {stretch:6.3f} {pull:6.2f}  {joint} at {time:.2f} s")
        if clip.loops:
            expect(_gap(clip, 0, clip, -1) < CLOSED, f"{clip.name} does not close")
        elif clip.name == "die":
            expect(_gap(clip, 0, by_name["idle"], 0) < SAME, f"{clip.name} does not start in the idle's first pose")
        else:
            for frame in (0, -1):
                expect(_gap(clip, frame, by_name["idle"], 0) < SAME, f"{clip.name} does not start and end as the idle does")
        expect(low > -DEEPEST, f"{clip.name}: skin at {low:.2f} m")
        # Feet are dragged along when the giant dies.
        expect(slide <= MOST_SLIDE or clip.name == "die", f"{clip.name}: soles slide at {slide:.3f} m/s")
        expect(stretch <= MOST_STRETCH, f"{clip.name}: a planted leg is stretched to {stretch:.3f}")
        expect(pull <= START_PULL, f"{clip.name}: {joint} starts with {pull:.2f} m/s^2 at {time:.2f} s")
        expect(all(0.0 <= time <= clip.length for _, time in clip.table.markers), f"{clip.name}: a marker is too late")
        expect({name for name, _ in clip.table.markers} >= MARKERS.get(clip.name, set()), f"{clip.name}: markers")
        wind_up = reach.markers(clip).get("active", 0.0)
        expect(wind_up <= WIND_UP[1], f"{clip.name}: winds up for {wind_up:.2f} s")
    print("felt at most, in m/s^2: chest, head, hands, forearms")
    for clip in moves:
        rideable.check(clip, expect)
    for name, (limb, side) in BLOWS.items():
        _check_blow(by_name[name], limb, side, points, weights, expect)
    print(f"rides: largest pull, seconds over {feel.THROWS}, excess over {feel.TIRES}, largest pull where one holds out")
    for name, sign in RIDES:
        peak, throw, tiring, held = feel.ride(by_name[name], sign, points, weights, fur)
        print(f"{name:16} {sign:22} {peak:6.1f} m/s^2 {throw:5.2f} s {tiring:6.1f} m/s {held:6.1f} m/s^2")
        if name == "shrug":
            expect(SHRUG[0] <= peak <= SHRUG[1], f"{name}: pulls with {peak:.1f} m/s^2")
        else:
            expect(throw >= LEAST_THROW, f"{name}: throws for {throw:.2f} s")
            expect(TIRING[0] <= tiring <= TIRING[1], f"{name}: tires by {tiring:.1f} m/s")
        expect(held <= HELD, f"{name}: {held:.1f} m/s^2 where one holds out")
    for name in ("shake", "shake_loop", "rage"):
        for sign in SPARED:
            peak, throw, tiring, _ = feel.ride(by_name[name], sign, points, weights, fur)
            print(f"{name:16} {sign:22} {peak:6.1f} m/s^2 {throw:5.2f} s {tiring:6.1f} m/s")
            expect(tiring <= MOST_SPARED, f"{name}: tires by {tiring:.1f} m/s at {sign}")
    _check_corpse(by_name["die"], points, weights, expect)
    assert not faults, "; ".join(faults)


def _gap(clip, frame, other, other_frame):
    """The largest difference of two poses: of matrices' entries, and of the pelvis's place in metres."""
    turns = np.abs(clip.poses.local[frame] - other.poses.local[other_frame]).max()
    return max(turns, np.abs(clip.poses.shift[frame] - other.poses.shift[other_frame]).max())


def _check_blow(clip, limb, side, points, weights, expect):
    """The times of a blow, and what it reaches."""
    time = reach.markers(clip)
    low = reach.lowest(clip, points, weights, limb, side)
    stomps = clip.name.startswith("stomp")
    limits = STOMP_WIND_UP if stomps else WIND_UP
    expect(limits[0] <= time["active"] <= limits[1], f"{clip.name}: winds up for {time['active']:.2f} s")
    if "impact" in time:
        height = low[round(time["impact"] * clips.RATE)]
        print(f"{clip.name:16} sole {height:.2f} m high at the impact")
        expect(abs(height) <= IMPACT_HEIGHT, f"{clip.name}: sole at {height:.2f} m at the impact")
    if stomps:
        high, turn = low[: round(time["active"] * clips.RATE) + 1].max(), reach.head_turn(clip, time["active"])
        print(f"{clip.name:16} winds up {time['active']:.2f} s, foot {high:.1f} m high, head turned {turn:.0f} degrees")
        expect(high >= STOMP_HEIGHT, f"{clip.name}: foot {high:.1f} m high")
        expect(turn >= STOMP_TURN, f"{clip.name}: head turned {turn:.0f} degrees")
    else:
        low = low[reach.window(clip)]
        share = ((low >= REACH[0]) & (low <= REACH[1])).mean()
        arc, distance = reach.arc(clip, limb, side, points, weights)
        print(f"{clip.name:16} winds up {time['active']:.2f} s, passes {low.min():.2f} to {low.max():.2f} m high, {share:.0%} low, "
              f"hits over {arc:.0f} degrees at {distance} m")
        expect(share >= LEAST_LOW and low.max() <= LIFTED, f"{clip.name}: {share:.0%} low, up to {low.max():.2f} m")
        widest, near, far = ARC[limb]
        expect(arc >= widest and near <= distance <= far, f"{clip.name}: {arc:.0f} degrees at {distance} m")


def _check_corpse(clip, points, weights, expect):
    """The last pose lies on the ground: trunk, arms and legs."""
    last = motion.skinned(points, weights, clip.poses.part(slice(-1, None)))[0, :, 2]
    joint = weights.argmax(axis=1)
    for names in (("chest", "spine", "pelvis", "loin"), ("hand", "forearm", "thumb", "index"), ("shin", "foot", "toe")):
        part = np.isin(joint, [number for name, number in INDEX.items() if name.startswith(names)])
        expect(last[part].min() < LYING, f"{clip.name}: {names[0]} ends {last[part].min():.2f} m over the ground")
