"""Writes the figure, its joints and its clips as a GLB."""

import numpy as np
from giant import glb
from giant.turns import quaternions

from .motion import Pose
from .palette import MATERIALS
from .skeleton import FRAMES, HEADS, INDEX, JOINTS, NAMES, PARENT

_FLOAT, _SHORT, _BYTE = 5126, 5123, 5121
_VERTICES, _TRIANGLES = 34962, 34963
# A joint's rotation, place or scale that stays within this of one value is written as one.
STILL = 1e-6
MOST_INFLUENCES = 4
# Values below this are rounding noise, and written as 0: it would decide the file's bytes.
NOISE = 1e-12


class _File:
    """A document and its binary chunk, as they grow."""

    def __init__(self):
        self.document = {
            "asset": {"version": "2.0", "generator": "assets/hero.py", "copyright": "CC0 1.0"},
            "accessors": [],
            "bufferViews": [],
            "buffers": [{}],
        }
        self.binary = b""

    def add(self, values, kind, shape, target=None, limits=False, normalized=False):
        """Adds an accessor and returns its number."""
        types = {_FLOAT: np.float32, _SHORT: np.uint16, _BYTE: np.uint8}
        values = np.asarray(values)
        values = np.ascontiguousarray(np.where(np.abs(values) < NOISE, 0, values), types[kind])
        self.binary += b"\0" * (-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": values.nbytes}
        if target:
            view["target"] = target
        self.binary += values.tobytes()
        self.document["bufferViews"].append(view)
        entry = {
            "bufferView": len(self.document["bufferViews"]) - 1,
            "componentType": kind,
            "count": len(values),
            "type": shape,
        }
        if normalized:
            entry["normalized"] = True
        if limits:
            flat = values.reshape(len(values), -1)
            entry["min"], entry["max"] = flat.min(axis=0).tolist(), flat.max(axis=0).tolist()
        self.document["accessors"].append(entry)
        return len(self.document["accessors"]) - 1


def write(path, figure, moves):
    """Writes the file."""
    file = _File()
    document = file.document
    document["scene"], document["scenes"] = 0, [{"name": "hero", "nodes": [len(JOINTS) + 1]}]
    document["nodes"] = _joint_nodes()
    document["nodes"] += [
        {"name": "hero_mesh", "mesh": 0, "skin": 0},
        {"name": "hero", "children": [INDEX["root"], len(JOINTS)]},
    ]
    document["materials"] = [
        {
            "name": name,
            "pbrMetallicRoughness": {
                "baseColorFactor": [1.0, 1.0, 1.0, 1.0],
                "metallicFactor": metallic,
                "roughnessFactor": roughness,
            },
        }
        for name, (roughness, metallic) in MATERIALS.items()
    ]
    document["meshes"] = [{"name": "hero", "primitives": _primitives(file, figure)}]
    inverse = np.stack([_inverse_bind(joint) for joint in range(len(JOINTS))])
    # Matrices are stored column by column.
    bind = file.add(inverse.transpose(0, 2, 1).reshape(-1, 16), _FLOAT, "MAT4")
    document["skins"] = [
        {"name": "hero", "joints": list(range(len(JOINTS))), "skeleton": INDEX["root"], "inverseBindMatrices": bind}
    ]
    document["animations"] = [_animation(file, move) for move in moves]
    document["buffers"][0]["byteLength"] = len(file.binary) + -len(file.binary) % 4
    glb.write(path, document, file.binary)


def _inverse_bind(joint):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = FRAMES[joint].T, -FRAMES[joint].T @ HEADS[joint]
    return matrix


def _joint_nodes():
    """The joints in their rest pose."""
    turns, places = local_transforms(Pose())
    nodes = []
    for joint, name in enumerate(NAMES):
        node = {"name": name, "translation": _numbers(places[joint]), "rotation": _numbers(turns[joint])}
        children = [child for child, parent in enumerate(PARENT) if parent == joint]
        if children:
            node["children"] = children
        nodes.append(node)
    return nodes


def _numbers(values):
    values = np.asarray(values)
    return [float(value) for value in np.where(np.abs(values) < NOISE, 0.0, values).astype(np.float32)]


def local_transforms(pose):
    """Quaternions (x, y, z, w) and translations of all joints in their parents' axes."""
    turns, places = np.empty((len(JOINTS), 3, 3)), np.empty((len(JOINTS), 3))
    for joint, parent in enumerate(PARENT):
        frame = FRAMES[parent] if parent >= 0 else np.eye(3)
        start = HEADS[parent] if parent >= 0 else np.zeros(3)
        turns[joint] = frame.T @ pose.local[joint] @ FRAMES[joint]
        places[joint] = frame.T @ (HEADS[joint] - start + pose.shift[joint])
    return np.roll(quaternions(turns), -1, axis=1), places


def _primitives(file, figure):
    """One primitive for each material."""
    result = []
    for material in range(len(MATERIALS)):
        faces = figure.triangles[figure.materials == material]
        used, index = np.unique(faces, return_inverse=True)
        weights = figure.weights[used]
        joints = np.argsort(-weights, axis=1, kind="stable")[:, :MOST_INFLUENCES]
        share = np.take_along_axis(weights, joints, axis=1)
        share = (share / share.sum(axis=1, keepdims=True)).astype(np.float32)
        joints = np.where(share > 0.0, joints, 0)
        colours = np.concatenate([np.clip(figure.colours[used], 0.0, 1.0), np.ones((len(used), 1))], axis=1)
        attributes = {
            "POSITION": file.add(figure.points[used], _FLOAT, "VEC3", _VERTICES, limits=True),
            "NORMAL": file.add(figure.normals[used], _FLOAT, "VEC3", _VERTICES),
            "COLOR_0": file.add(np.round(colours * 65535.0), _SHORT, "VEC4", _VERTICES, normalized=True),
            "JOINTS_0": file.add(joints, _BYTE, "VEC4", _VERTICES),
            "WEIGHTS_0": file.add(share, _FLOAT, "VEC4", _VERTICES),
        }
        indices = file.add(index.reshape(-1), _SHORT, "SCALAR", _TRIANGLES)
        result.append({"attributes": attributes, "indices": indices, "material": material})
    return result


def _animation(file, move):
    """All channels of a clip that differ from the rest pose; scales of equipment always."""
    times = np.asarray(move.times, np.float32)
    moments = [local_transforms(pose) for pose in move.poses]
    turns, places = np.stack([m[0] for m in moments]), np.stack([m[1] for m in moments])
    scales = np.stack([pose.scale for pose in move.poses])
    rest_turns, rest_places = local_transforms(Pose())
    for frame in range(1, len(turns)):
        flip = (turns[frame] * turns[frame - 1]).sum(axis=1) < 0.0
        turns[frame, flip] *= -1.0
    all_times = file.add(times, _FLOAT, "SCALAR", limits=True)
    two_times = file.add(times[[0, -1]], _FLOAT, "SCALAR", limits=True)
    samplers, channels = [], []

    def add(joint, path, values, shape, interpolation="LINEAR"):
        still = np.abs(values - values[0]).max() < STILL
        values = values[[0, -1]] if still else values
        output = file.add(values, _FLOAT, shape)
        samplers.append({"input": two_times if still else all_times, "output": output, "interpolation": interpolation})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": joint, "path": path}})

    for joint, name in enumerate(NAMES):
        if name == "root":
            continue
        add(joint, "rotation", turns[:, joint], "VEC4")
        if name == "hips" or np.abs(places[:, joint] - rest_places[joint]).max() > STILL:
            add(joint, "translation", places[:, joint], "VEC3")
        if name in move.seen_by_scale:
            add(joint, "scale", np.repeat(scales[:, joint, None], 3, axis=1), "VEC3", "STEP")
    tag = {"markers": move.markers}
    if move.speed is not None:
        tag["speed"] = move.speed
    return {"name": move.name, "samplers": samplers, "channels": channels, "extras": {"clamber": tag}}
