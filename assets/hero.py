"""Builds the hero, the climber of the examples, and writes `hero.glb` beside this file.

    blender -b --python-exit-code 1 -P assets/hero.py
    blender -b --python-exit-code 1 -P assets/hero.py -- --pictures DIR

Made for Blender 3.4; needs no window. The second form also renders pictures. Two runs write the same
bytes: the work is done in a second Blender that has only one thread, as for the colossus. Clothes and
limbs are tubes drawn onto signed distance fields; head, hair and mantle are such fields, meshed;
`hero/` holds the parts. Licence of the result: CC0 1.0.
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

from hero import check, clips, figure, write  # noqa: E402

ONE_THREAD = "--one-thread"


def build(arguments):
    """Builds, writes and checks the hero, and renders him if asked to."""
    started = time.monotonic()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    shape = figure.figure()
    moves = clips.all_clips()
    path = HERE / "hero.glb"
    write.write(path, shape, moves)
    check.check(path, shape, moves)
    print(f"built in {time.monotonic() - started:.0f} s")
    if "--pictures" in arguments:
        from hero import pictures

        folder = Path(arguments[arguments.index("--pictures") + 1])
        pictures.render_all(folder, shape, moves)


def restart(arguments):
    """Runs this script in a Blender with one thread."""
    command = [bpy.app.binary_path, "-b", "-t", "1", "--python-exit-code", "1", "-P", __file__]
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    subprocess.run([*command, "--", ONE_THREAD, *arguments], check=True, env=environment)


given = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
build(given) if ONE_THREAD in given else restart(given)
