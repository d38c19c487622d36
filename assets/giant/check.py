"""What must hold of the result, checked on the file that was written and on the meshes."""

import numpy as np

from . import clips, flesh, glb, nets, stone

VISUAL_VERTICES = (50_000, 100_000)
COLLISION_VERTICES = (5_000, 10_000)
MOST_BYTES = 8_500_000
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
        ledge = material["extras"]["clamber"].get("ledge")
        assert ledge is None or ledge is True, material
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


def check_motion(moves, points, weights):
    """Loops close; prints what riders will feel."""
    for clip in moves:
        if clip.loops:
            assert np.abs(clip.poses.local[0] - clip.poses.local[-1]).max() < 1e-9, clip.name
