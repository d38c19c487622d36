"""Everything that talks to Blender: objects, armature, actions, export."""

import math

import bpy
import numpy as np
from mathutils import Matrix, Vector

from . import clips, nets, visual
from .signs import SIGNS
from .skeleton import JOINTS
from .turns import quaternions

# Stone edges sharper than this, in degrees, are shaded as edges.
CREASE = 38.0
# Exported influences below this are dropped.
LEAST_WEIGHT = 1e-4
# A joint that turns less than this in a whole clip has no channel there.
STILL = 1e-9


def start():
    """An empty scene with one tick of the clips a frame."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = clips.RATE


def thinned(mesh, share):
    """A mesh with a share of its triangles, those that matter least to the shape gone."""
    data = _mesh_data("thinned", mesh)
    thing = bpy.data.objects.new("thinned", data)
    bpy.context.collection.objects.link(thing)
    modifier = thing.modifiers.new("thin", "DECIMATE")
    modifier.ratio = share
    result = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    result.calc_loop_triangles()
    points, triangles = np.empty(3 * len(result.vertices)), np.empty(3 * len(result.loop_triangles), np.int32)
    result.vertices.foreach_get("co", points)
    result.loop_triangles.foreach_get("vertices", triangles)
    bpy.data.objects.remove(thing)
    bpy.data.meshes.remove(data)
    return nets.Mesh(points.reshape(-1, 3), triangles.reshape(-1, 3).astype(np.int64))


def materials():
    """All materials, with their tags."""
    made = []
    for name, (surface, user, colour, roughness, glow) in visual.MATERIALS.items():
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        shader = material.node_tree.nodes["Principled BSDF"]
        shader.inputs["Base Color"].default_value = (*colour, 1.0)
        shader.inputs["Roughness"].default_value = roughness
        shader.inputs["Metallic"].default_value = 0.0
        if glow:
            shader.inputs["Emission"].default_value = (*glow, 1.0)
            shader.inputs["Emission Strength"].default_value = 1.0
        material["clamber"] = {"surface": surface, "user": user} if user else {"surface": surface}
        made.append(material)
    return made


def armature():
    """The bones in their rest pose."""
    data = bpy.data.armatures.new("colossus")
    thing = bpy.data.objects.new("colossus", data)
    bpy.context.collection.objects.link(thing)
    bpy.context.view_layer.objects.active = thing
    bpy.ops.object.mode_set(mode="EDIT")
    for joint in JOINTS:
        bone = data.edit_bones.new(joint.name)
        bone.head, bone.tail = joint.head, joint.tail
        bone.parent = data.edit_bones[joint.parent] if joint.parent else None
    bpy.ops.object.mode_set(mode="OBJECT")
    for bone in thing.pose.bones:
        bone.rotation_mode = "QUATERNION"
    return thing


def skinned_object(name, role, dressed, weights, rig, all_materials):
    """A mesh bound to the armature."""
    data = _mesh_data(name, dressed.mesh)
    used = np.unique(dressed.materials)
    for number in used:
        data.materials.append(all_materials[number])
    data.polygons.foreach_set("material_index", np.searchsorted(used, dressed.materials))
    data.polygons.foreach_set("use_smooth", np.ones(len(data.polygons), bool))
    if dressed.uvs is not None:
        layer = data.uv_layers.new(name="UVMap")
        layer.data.foreach_set("uv", dressed.uvs.reshape(-1))
        colours = data.color_attributes.new("COLOR_0", "FLOAT_COLOR", "POINT")
        colours.data.foreach_set("color", dressed.colours.reshape(-1))
        data.use_auto_smooth = True
        data.auto_smooth_angle = math.pi
        _mark_creases(data, dressed)
    data.update()
    thing = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(thing)
    thing["clamber"] = {"role": role}
    for number in np.flatnonzero(weights.any(axis=0)):
        group = thing.vertex_groups.new(name=JOINTS[number].name)
        for vertex in np.flatnonzero(weights[:, number] > LEAST_WEIGHT):
            group.add([int(vertex)], float(weights[vertex, number]), "REPLACE")
    thing.modifiers.new("armature", "ARMATURE").object = rig
    thing.parent = rig
    return thing


def _mesh_data(name, mesh):
    data = bpy.data.meshes.new(name)
    data.vertices.add(len(mesh.points))
    data.vertices.foreach_set("co", mesh.points.reshape(-1))
    count = len(mesh.triangles)
    data.loops.add(3 * count)
    data.loops.foreach_set("vertex_index", mesh.triangles.reshape(-1))
    data.polygons.add(count)
    data.polygons.foreach_set("loop_start", np.arange(0, 3 * count, 3))
    data.polygons.foreach_set("loop_total", np.full(count, 3))
    data.update(calc_edges=True)
    return data


def _mark_creases(data, dressed):
    """Sharp edges where two stone faces meet at an angle."""
    rigid = np.isin(dressed.materials, [visual.NAMES.index(name) for name in ("stone", "stone_ledge")])
    normal = nets.normals(dressed.mesh)
    faces = {}
    for face in np.flatnonzero(rigid):
        a, b, c = (int(corner) for corner in dressed.mesh.triangles[face])
        for edge in ((a, b), (b, c), (c, a)):
            faces.setdefault((min(edge), max(edge)), []).append(face)
    limit = math.cos(math.radians(CREASE))
    for edge in data.edges:
        pair = faces.get((min(edge.vertices), max(edge.vertices)), ())
        if len(pair) == 2 and normal[pair[0]] @ normal[pair[1]] < limit:
            edge.use_edge_sharp = True


def weak_points(rig, surface_height):
    """Empties on the joints, at the sigils; `surface_height(sign)` tells how far to move along it."""
    for sign in SIGNS:
        empty = bpy.data.objects.new(sign.name, None)
        bpy.context.collection.objects.link(empty)
        empty.parent, empty.parent_type, empty.parent_bone = rig, "BONE", sign.joint
        bpy.context.view_layer.update()
        place = Vector(sign.place) + surface_height(sign) * Vector(sign.normal)
        right = Vector(np.cross(sign.up, sign.normal))
        # Y is up in glTF: there the empty's +Y axis points away from the skin.
        frame = Matrix((right, Vector(sign.up), Vector(sign.normal))).transposed().to_4x4()
        frame.translation = place
        empty.matrix_world = frame
        empty["clamber"] = {"weak_point": {"hit_points": sign.hit_points, "major": sign.major, "radius": sign.size}}


def animate(rig, clip):
    """One action for a clip, on an NLA track of its name."""
    action = bpy.data.actions.new(clip.name)
    frames = np.arange(len(clip.poses), dtype=float)
    for number, joint in enumerate(JOINTS):
        local = clip.poses.local[:, number]
        if np.abs(local - np.eye(3)).max() < STILL:
            continue
        turns = _bone_turns(rig.data.bones[joint.name], local)
        for index in range(1, len(turns)):
            if turns[index] @ turns[index - 1] < 0.0:
                turns[index] = -turns[index]
        _add_curves(action, joint.name, "rotation_quaternion", frames, turns)
    _add_curves(action, "pelvis", "location", frames, clip.poses.shift @ _rest(rig.data.bones["pelvis"]))
    rig.animation_data_create()
    track = rig.animation_data.nla_tracks.new()
    track.name = clip.name
    track.strips.new(clip.name, 0, action)
    track.mute = True


def _rest(bone):
    return np.array(bone.matrix_local.to_3x3())


def _bone_turns(bone, local):
    """Rotations (frames, 3, 3) in the model's axes, as quaternions in the bone's own axes."""
    return quaternions(_rest(bone).T @ local @ _rest(bone))


def _add_curves(action, bone, kind, frames, values):
    for index in range(values.shape[1]):
        curve = action.fcurves.new(f'pose.bones["{bone}"].{kind}', index=index, action_group=bone)
        curve.keyframe_points.add(len(frames))
        curve.keyframe_points.foreach_set("co", np.stack([frames, values[:, index]], axis=1).reshape(-1))
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def pose(rig, clip, frame):
    """Puts the armature into the pose of a clip's frame, for pictures."""
    poses = clip.poses.part(slice(frame, frame + 1))
    for number, joint in enumerate(JOINTS):
        bone = rig.pose.bones[joint.name]
        bone.rotation_quaternion = _bone_turns(bone.bone, poses.local[:, number])[0]
    rig.pose.bones["pelvis"].location = poses.shift[0] @ _rest(rig.data.bones["pelvis"])


def export(path):
    """Writes the GLB."""
    for track in bpy.data.objects["colossus"].animation_data.nla_tracks:
        track.mute = False
    bpy.ops.export_scene.gltf(
        filepath=path,
        export_format="GLB",
        export_copyright="CC0 1.0",
        export_yup=True,
        export_extras=True,
        export_colors=True,
        export_normals=True,
        export_tangents=False,
        export_cameras=False,
        export_lights=False,
        export_def_bones=False,
        export_animations=True,
        export_nla_strips=True,
        export_force_sampling=False,
        export_optimize_animation_size=True,
        export_morph=False,
        export_all_influences=False,
    )
