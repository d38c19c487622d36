"""Pictures of the hero: one beauty shot, sheets of sides and close-ups, sheets of all clips."""

import math

import bpy
import numpy as np
from mathutils import Vector

from . import motion
from .climbing import WALL
from .palette import MATERIALS

SKY = (0.62, 0.74, 0.86, 1.0)
BEAUTY, BEAUTY_SAMPLES = (1120, 840), 48
SHEET_SAMPLES = 10
# Figures of a sheet stand this far apart, in metres; pixels for each metre.
STEP_X, STEP_Y, PIXELS = 1.75, 2.55, 105
TIMES = 4
CLIPS_A_SHEET = 4
# Steps of each colour in the files: fewer make them smaller, and noise hides the difference.
SHADES = 63
# A picture's name, the eye, the target (glTF's frame), the width shown in metres.
CLOSE = (
    ("face", (0.0, 1.64, 3.0), (0.0, 1.62, 0.0), 0.42),
    ("face_three_quarter", (1.6, 1.75, 2.6), (0.0, 1.62, 0.0), 0.42),
    ("face_side", (3.0, 1.64, 0.0), (0.0, 1.62, 0.0), 0.42),
    ("head_back", (-1.6, 2.1, -2.6), (0.0, 1.60, 0.0), 0.5),
    ("hand_back", (1.5, 2.2, 2.2), (0.66, 1.02, 0.03), 0.40),
    ("hand_palm", (-1.2, -0.4, 1.6), (0.66, 1.02, 0.03), 0.40),
)


def render_all(folder, figure, moves):
    """Writes `hero.png` and the sheets into the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    prepare()
    sides(folder, figure)
    closeups(folder, figure)
    for start in range(0, len(moves), CLIPS_A_SHEET):
        clip_sheet(folder / f"clips_{start // CLIPS_A_SHEET}.png", figure, moves[start : start + CLIPS_A_SHEET])
    beauty(folder / "hero.png", figure, {move.name: move for move in moves})


def prepare():
    """Light, sky and a camera."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.max_bounces = 3
    scene.cycles.seed = 0
    scene.render.dither_intensity = 0.0
    scene.view_settings.view_transform = "Filmic"
    scene.view_settings.look = "Medium High Contrast"
    world = scene.world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = SKY
    background.inputs["Strength"].default_value = 0.7
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle, sun.color = 3.6, math.radians(1.5), (1.0, 0.93, 0.80)
    _linked("sun", sun).rotation_euler = (math.radians(50), 0.0, math.radians(-38))
    scene.camera = _linked("camera", bpy.data.cameras.new("camera"))
    scene.camera.data.clip_end = 1000.0


def _linked(name, data):
    thing = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(thing)
    return thing


def _in_blender(points):
    """From glTF's frame to Blender's."""
    return np.stack([points[..., 0], -points[..., 2], points[..., 1]], axis=-1)


def _materials():
    made = []
    for name, (roughness, metallic) in MATERIALS.items():
        material = bpy.data.materials.get(name)
        if material is None:
            material = bpy.data.materials.new(name)
            material.use_nodes = True
            tree = material.node_tree
            shader = tree.nodes["Principled BSDF"]
            shader.inputs["Roughness"].default_value = roughness
            shader.inputs["Metallic"].default_value = metallic
            shader.inputs["Specular"].default_value = 0.25
            attribute = tree.nodes.new("ShaderNodeAttribute")
            attribute.attribute_name = "COLOR_0"
            tree.links.new(attribute.outputs["Color"], shader.inputs["Base Color"])
        made.append(material)
    return made


def add_figure(figure, pose=None, at=(0, 0, 0), turn=0.0):
    """A copy of the figure in a pose, `turn` degrees to its left, at a place (glTF's frame)."""
    points, normals = figure.points, figure.normals
    if pose is not None:
        points, normals = motion.skinned(figure, pose)
    angle = math.radians(turn)
    about = np.array([[math.cos(angle), 0, math.sin(angle)], [0, 1, 0], [-math.sin(angle), 0, math.cos(angle)]])
    points, normals = _in_blender(points @ about.T + np.asarray(at, float)), _in_blender(normals @ about.T)
    data = bpy.data.meshes.new("hero")
    data.from_pydata(points.tolist(), [], figure.triangles.tolist())
    for material in _materials():
        data.materials.append(material)
    data.polygons.foreach_set("material_index", figure.materials.astype(np.int32))
    data.polygons.foreach_set("use_smooth", np.ones(len(data.polygons), bool))
    colours = data.color_attributes.new("COLOR_0", "FLOAT_COLOR", "POINT")
    colours.data.foreach_set("color", np.concatenate([figure.colours, np.ones((len(points), 1))], axis=1).reshape(-1))
    data.use_auto_smooth = True
    data.normals_split_custom_set_from_vertices(normals.tolist())
    return _linked("hero", data)


def beauty(path, figure, moves):
    """The hero with his sword, and beside it climbing a block of stone."""
    camera = bpy.context.scene.camera
    _slab((-60.0, -1.0, -60.0), (60.0, 0.0, 60.0), (0.30, 0.33, 0.24))
    add_figure(figure, moves["unsheathe"].poses[-1], (0.56, 0.0, 0.45), -36.0)
    climber, turn = (-0.74, 0.50, -0.30), 172.0
    add_figure(figure, moves["climb"].poses[0], climber, turn)
    angle = math.radians(turn)
    # The wall's face is as far in front of the climber as the clip says.
    _rock(np.array(climber) + WALL * np.array([math.sin(angle), 0.0, math.cos(angle)]), turn)
    camera.data.type, camera.data.lens = "PERSP", 58.0
    _aim((-0.75, 1.30, 5.6), (-0.10, 1.0, 0.0))
    _write(path, _shoot(path.with_name("tile.png"), BEAUTY, BEAUTY_SAMPLES))
    path.with_name("tile.png").unlink()
    _clear()


# Joints between the blocks of each course, in metres from the middle of the wall.
_COURSES = ((-0.95, -0.2, 0.7, 1.1), (-0.95, -0.5, 0.30, 1.1), (-0.95, 0.05, 0.75), (-0.95, -0.35, 0.55), (-0.80, 0.1))
COURSE, COURSE_DEPTH = 0.52, 0.9


def _rock(face, turn):
    """Courses of stone blocks with their face at a place: the ruin of a wall."""
    angle, number = math.radians(turn), 0
    core = _slab((-0.75, 0.0, 0.1), (0.5, (len(_COURSES) - 1) * COURSE, COURSE_DEPTH - 0.05), (0.12, 0.115, 0.10))
    core.location, core.rotation_euler = _in_blender(np.asarray(face) * (1.0, 0.0, 1.0)), (0.0, 0.0, angle)
    for course, joints in enumerate(_COURSES):
        for left, right in zip(joints, joints[1:]):
            number += 1
            set_back = 0.020 * ((number * 7) % 5) / 4.0
            tone = 0.27 + 0.05 * ((number * 5) % 4) / 3.0
            low, high = course * COURSE, (course + 1) * COURSE - 0.012
            slab = _slab(
                (left + 0.006, low, set_back), (right - 0.006, high, COURSE_DEPTH), (tone, 0.94 * tone, 0.82 * tone)
            )
            slab.location = _in_blender(np.asarray(face) * (1.0, 0.0, 1.0))
            slab.rotation_euler = (0.0, 0.0, angle)
            bevel = slab.modifiers.new("bevel", "BEVEL")
            bevel.width, bevel.segments = 0.022, 3


def _slab(low, high, colour):
    """A box between two corners (glTF's frame)."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    data = bpy.data.meshes.new("slab")
    data.from_pydata(_in_blender(low + corners * (high - low)).tolist(), [], faces)
    material = bpy.data.materials.new("slab")
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*colour, 1.0)
    material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 1.0
    data.materials.append(material)
    return _linked("slab", data)


def _clear():
    for thing in list(bpy.data.objects):
        if thing.type == "MESH":
            data = thing.data
            bpy.data.objects.remove(thing)
            bpy.data.meshes.remove(data)


def sides(folder, figure):
    """The rest pose from six sides."""
    for number, turn in enumerate((0, 40, 90, 180, 220, -90)):
        add_figure(figure, at=((number % 6) * STEP_X, 0, 0), turn=turn)
    _flat((2.5 * STEP_X, 0.93), 6 * STEP_X, 2.2, 190)
    _save(folder / "sides.png")
    _clear()


def closeups(folder, figure):
    """Face and hands."""
    add_figure(figure)
    tiles = []
    for _, eye, target, width in CLOSE:
        _aim(eye, target)
        bpy.context.scene.camera.data.type = "ORTHO"
        bpy.context.scene.camera.data.ortho_scale = width
        tiles.append(_shoot(folder / "tile.png", (420, 420), 24))
    (folder / "tile.png").unlink()
    _write(folder / "close.png", np.concatenate([np.concatenate(tiles[:3], 1), np.concatenate(tiles[3:], 1)], 0))
    _clear()


def clip_sheet(path, figure, moves):
    """Four times of each clip, from the front and from its left."""
    for row, move in enumerate(moves):
        for column in range(2 * TIMES):
            number = column % TIMES
            last = len(move.poses) - 1
            frame = last * number // TIMES if move.loops else last * number // (TIMES - 1)
            at = np.array([column * STEP_X, -row * STEP_Y, 0.0])
            add_figure(figure, move.poses[frame], at, (18.0, -72.0)[column // TIMES])
        _slab((-1.0, -row * STEP_Y - 0.02, -0.5), (2 * TIMES * STEP_X - 1.0, -row * STEP_Y, 0.5), (0.25, 0.27, 0.2))
    count = len(moves)
    _flat(((TIMES - 0.5) * STEP_X, 1.05 - (count - 1) / 2 * STEP_Y), 2 * TIMES * STEP_X, count * STEP_Y, PIXELS)
    print("sheet", path.name, [move.name for move in moves])
    _save(path)
    _clear()


def _flat(middle, width, height, pixels):
    """An orthographic view along -Z."""
    camera = bpy.context.scene.camera
    _aim((middle[0], middle[1] + 0.5, 20.0), (middle[0], middle[1], 0.0))
    camera.data.type, camera.data.ortho_scale = "ORTHO", max(width, height)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = int(width * pixels), int(height * pixels)
    scene.cycles.samples, scene.cycles.use_denoising = SHEET_SAMPLES, False


def _aim(eye, target):
    camera = bpy.context.scene.camera
    eye, target = Vector(_in_blender(np.asarray(eye, float))), Vector(_in_blender(np.asarray(target, float)))
    camera.location = eye
    camera.rotation_euler = (target - eye).to_track_quat("-Z", "Y").to_euler()


def _save(path):
    scene = bpy.context.scene
    scene.render.image_settings.file_format, scene.render.image_settings.color_mode = "PNG", "RGB"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)


def _shoot(path, size, samples):
    """Renders the view to a file and returns its pixels, top row first."""
    scene = bpy.context.scene
    scene.cycles.samples, scene.cycles.use_denoising = samples, False
    scene.render.resolution_x, scene.render.resolution_y = size
    _save(path)
    image = bpy.data.images.load(str(path))
    pixels = np.empty(size[0] * size[1] * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(size[1], size[0], 4)[::-1]


def _write(path, pixels):
    sheet = np.round(pixels * SHADES) / SHADES
    image = bpy.data.images.new("sheet", sheet.shape[1], sheet.shape[0])
    image.pixels.foreach_set(np.ascontiguousarray(sheet[::-1]).reshape(-1))
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    bpy.data.images.remove(image)
