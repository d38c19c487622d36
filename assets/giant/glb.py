"""Reading a GLB's parts, and three corrections to what Blender's exporter writes."""

import json
import struct

import numpy as np

_TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def read(path):
    """The JSON and the binary chunk."""
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), data[28 + length :]


def write(path, document, binary):
    """Writes both chunks, padded as the format asks."""
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    total = 28 + len(text) + len(binary)
    path.write_bytes(
        struct.pack("<4sII", b"glTF", 2, total)
        + struct.pack("<I4s", len(text), b"JSON") + text
        + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    )


def accessor(document, binary, number):
    """An accessor's values as an array."""
    entry = document["accessors"][number]
    view = document["bufferViews"][entry["bufferView"]]
    kind, width = np.dtype(_TYPES[entry["componentType"]]), _WIDTHS[entry["type"]]
    start = view.get("byteOffset", 0) + entry.get("byteOffset", 0)
    values = np.frombuffer(binary, kind, entry["count"] * width, start)
    return values.reshape(entry["count"], width)


def tidy(path, moves):
    """Turns the flags that Blender stores as 0 and 1 into booleans, and writes the clips' extras."""
    document, binary = read(path)
    for entry in document["nodes"] + document["materials"]:
        tag = entry.get("extras", {}).get("clamber")
        if tag and "weak_point" in tag:
            tag["weak_point"]["major"] = bool(tag["weak_point"]["major"])
    extras = {move.name: move.extras for move in moves}
    for animation in document["animations"]:
        animation["extras"] = {"clamber": extras[animation["name"]]}
    write(path, document, binary)
