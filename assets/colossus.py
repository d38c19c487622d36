"""Builds the colossus, the creature of the examples, and writes `colossus.glb` beside this file.

    blender -b --python-exit-code 1 -P assets/colossus.py
    blender -b --python-exit-code 1 -P assets/colossus.py -- --pictures DIR

Made for Blender 3.4; needs no window. The second form also renders pictures. Two runs write the same
bytes: Blender sums normals in an order that depends on its threads, so the work is done in a second
Blender that has only one. The shape is a signed distance field that is meshed twice, finely with
fur, carving and colours, and coarsely as the collision mesh; `giant/` holds the parts. Licence of
the result: CC0 1.0.
"""

import os
import subprocess
import sys
import time
from pathlib import Path

import bpy

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.dont_write_bytecode = True

from giant import blender, check, clips, glb, shell, visual, weights  # noqa: E402

ONE_THREAD = "--one-thread"


def build(arguments):
    """Builds, exports and checks the creature, and renders it if asked to."""
    started = time.monotonic()
    blender.start()
    coarse, fine = visual.collision(), visual.visual(blender.thinned)
    coarse_weights, fine_weights = (
        weights.rigid(weights.weights(dressed.mesh.points), visual.of_shell(dressed), shell.JOINT)
        for dressed in (coarse, fine)
    )
    moves = [clips.sampled(name, coarse.mesh.points, coarse_weights) for name in clips.TABLES]

    rig = blender.armature()
    materials = blender.materials()
    blender.skinned_object("collision", "collision", coarse, coarse_weights, rig, materials)
    shown = blender.skinned_object("visual", "visual", fine, fine_weights, rig, materials)
    blender.weak_points(rig, visual.height_at)
    for move in moves:
        blender.animate(rig, move)

    path = HERE / "colossus.glb"
    blender.export(str(path))
    glb.tidy(path, moves)
    check.check_file(path)
    check.check_shapes(coarse, fine)
    check.check_motion(moves, coarse.mesh.points, coarse_weights, visual.furry(coarse))
    print(f"built in {time.monotonic() - started:.0f} s")
    if "--pictures" in arguments:
        from giant import pictures

        folder = Path(arguments[arguments.index("--pictures") + 1])
        pictures.render_all(folder, rig, shown, moves)


def restart(arguments):
    """Runs this script in a Blender with one thread."""
    command = [bpy.app.binary_path, "-b", "-t", "1", "--python-exit-code", "1", "-P", __file__]
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    subprocess.run([*command, "--", ONE_THREAD, *arguments], check=True, env=environment)


given = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
build(given) if ONE_THREAD in given else restart(given)
