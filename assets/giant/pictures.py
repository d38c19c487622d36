"""Pictures of the colossus: one beauty shot and a sheet of sides and poses."""

import math

import bmesh
import bpy
import numpy as np
from mathutils import Matrix, Vector

from . import blender

# A climber's height and radius, in metres, for scale.
HUMAN, HUMAN_RADIUS = 1.8, 0.3
SKY = (0.62, 0.74, 0.86, 1.0)
BEAUTY = (1120, 840)
BEAUTY_SAMPLES = 32
TILE = (280, 280)
TILE_SAMPLES = 6
COLUMNS = 6
# Steps of each colour in the files: fewer make them smaller, and noise hides the difference.
SHADES = 63
# name: (eye, target, focal length in mm)
SIDES = {
    "three_quarter": ((-46, -82, 13), (0, -1, 20.2), 52),
    "front": ((0, -95, 18), (0, 0, 20), 60),
    "side": ((95, 0, 20), (0, -1, 20), 60),
    "back": ((38, 75, 36), (0, 1, 20), 52),
    "top": ((14, 22, 100), (0, 0, 20), 62),
    "head": ((-12, -38, 37), (0, -8, 34), 50),
    "shoulder": ((28, -24, 43), (9.5, 0, 34.4), 50),
}


def render_all(folder, rig, shown, moves):
    """Writes `colossus.png` and `sheet.png` into the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    prepare(rig, shown)
    by_name = {move.name: move for move in moves}
    blender.pose(rig, by_name["idle"], 30)
    save(folder / "colossus.png", [shoot(folder / "tile.png", "three_quarter", BEAUTY, BEAUTY_SAMPLES)], 1)
    tiles = []
    for view in ("front", "side", "back", "top", "head", "shoulder"):
        tiles.append(shoot(folder / "tile.png", view, TILE, TILE_SAMPLES))
    for name in ("walk", "shake", "swipe", "stomp", "stagger", "die"):
        tiles += strip(folder, rig, by_name[name], COLUMNS)
    (folder / "tile.png").unlink()
    save(folder / "sheet.png", tiles, COLUMNS)


def strip(folder, rig, move, count, view="three_quarter"):
    """Tiles of a clip, evenly spread over its length."""
    tiles = []
    for number in range(count):
        last = len(move.poses) - 1
        frame = last * number // count if move.loops else last * number // (count - 1)
        blender.pose(rig, move, frame)
        tiles.append(shoot(folder / "tile.png", view, TILE, TILE_SAMPLES))
    return tiles


def prepare(rig, shown):
    """Light, sky, ground, humans on the shoulders, and colours in the materials."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 3
    scene.cycles.seed = 0
    scene.render.dither_intensity = 0.0
    scene.view_settings.view_transform = "Filmic"
    scene.view_settings.look = "Medium High Contrast"
    for track in rig.animation_data.nla_tracks:
        track.mute = True
    bpy.data.objects["collision"].hide_render = True
    world = scene.world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = SKY
    background.inputs["Strength"].default_value = 0.7
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle, sun.color = 3.6, math.radians(1.5), (1.0, 0.93, 0.80)
    light = _linked("sun", sun)
    light.rotation_euler = (math.radians(52), 0.0, math.radians(-58))
    scene.camera = _linked("camera", bpy.data.cameras.new("camera"))
    scene.camera.data.clip_end = 1000.0
    _add_ground()
    _add_human(rig)
    for material in shown.data.materials:
        _show_colours(material)


def _linked(name, data):
    thing = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(thing)
    return thing


def _plain(name, colour):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = colour
    shader.inputs["Roughness"].default_value = 1.0
    return material


def _add_ground():
    data = bpy.data.meshes.new("ground")
    data.from_pydata([(-400, -400, 0), (400, -400, 0), (400, 400, 0), (-400, 400, 0)], [], [(0, 1, 2, 3)])
    data.materials.append(_plain("ground", (0.30, 0.33, 0.24, 1.0)))
    _linked("ground", data)


def _add_human(rig):
    """Capsules of a climber's size that stand on the shoulder plates."""
    data = bpy.data.meshes.new("human")
    shape = bmesh.new()
    bmesh.ops.create_uvsphere(shape, u_segments=16, v_segments=12, radius=HUMAN_RADIUS)
    for vertex in shape.verts:
        vertex.co.z += HUMAN - HUMAN_RADIUS if vertex.co.z > 1e-6 else HUMAN_RADIUS
    shape.to_mesh(data)
    shape.free()
    data.materials.append(_plain("human", (0.85, 0.10, 0.04, 1.0)))
    for suffix, sign in ((".R", -1.0), (".L", 1.0)):
        human = _linked("human" + suffix, data)
        human.parent, human.parent_type, human.parent_bone = rig, "BONE", "clavicle" + suffix
        bpy.context.view_layer.update()
        human.matrix_world = Matrix.Translation((sign * 9.0, -1.6, 35.0))


def _show_colours(material):
    """Multiplies the base colour by the vertex colours, as glTF does by itself."""
    tree = material.node_tree
    shader = tree.nodes["Principled BSDF"]
    attribute = tree.nodes.new("ShaderNodeAttribute")
    attribute.attribute_name = "COLOR_0"
    mix = tree.nodes.new("ShaderNodeMixRGB")
    mix.blend_type = "MULTIPLY"
    mix.inputs["Fac"].default_value = 1.0
    mix.inputs["Color1"].default_value = shader.inputs["Base Color"].default_value
    tree.links.new(attribute.outputs["Color"], mix.inputs["Color2"])
    tree.links.new(mix.outputs["Color"], shader.inputs["Base Color"])
    shader.inputs["Specular"].default_value = 0.15
    if material.name == "glow":
        shader.inputs["Emission Strength"].default_value = 4.0


def shoot(path, view, size, samples):
    """Renders one view to a file and returns its pixels, top row first."""
    scene = bpy.context.scene
    eye, target, focal = SIDES[view]
    camera = scene.camera
    camera.location = eye
    camera.rotation_euler = (Vector(target) - Vector(eye)).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens = focal
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.image_settings.compression = 100
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(path))
    pixels = np.empty(size[0] * size[1] * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(size[1], size[0], 4)[::-1]


def save(path, tiles, columns):
    """Writes tiles as one picture."""
    rows = [np.concatenate(tiles[start : start + columns], axis=1) for start in range(0, len(tiles), columns)]
    sheet = np.round(np.concatenate(rows, axis=0) * SHADES) / SHADES
    image = bpy.data.images.new("sheet", sheet.shape[1], sheet.shape[0])
    image.pixels.foreach_set(np.ascontiguousarray(sheet[::-1]).reshape(-1))
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    bpy.data.images.remove(image)
