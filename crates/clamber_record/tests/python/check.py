#!/usr/bin/env python3
"""Decodes a recording with third-party readers, and checks counts and fields.

pip install mcap mcap-protobuf-support
check.py FILE.mcap
"""

import struct
import sys
from collections import Counter

from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

WANTED = {
    "/tick": "tick.Tick",
    "/snapshot": "saved.Saved",
    "/transforms": "foxglove.FrameTransforms",
    "/figure": "foxglove.FrameTransforms",
    "/scene": "foxglove.SceneUpdate",
    "/scenery": "foxglove.SceneUpdate",
    "/skin": "foxglove.PointCloud",
    "/touched": "touched.Touched",
    "/log": "foxglove.Log",
}

# Modes that are attached to something: standing, holding, hanging, hanging from a ledge.
SUPPORTED = {1, 3, 4, 5}


def check(condition, what):
    if not condition:
        sys.exit(f"check.py: {what}")


def check_tick(message, count):
    check(message.tick == count, f"tick {message.tick} where {count} was expected")
    for name in ("position", "velocity", "heading"):
        v = getattr(message.state, name)
        check(all(abs(x) < 1e6 for x in (v.x, v.y, v.z)), f"tick {count}: {name} {v}")
    supported = message.state.mode in SUPPORTED
    check(supported == message.state.HasField("support"), f"tick {count}: mode and support")
    for name in ("stamina", "hit_points"):
        share = getattr(message.state, name)
        check(0 <= share <= 1, f"tick {count}: {name} {share}")
    pull_up = message.state.ledge_hanging.pull_up
    check(0 <= pull_up <= 1, f"tick {count}: pull_up {pull_up}")
    heading = message.state.heading
    length = heading.x**2 + heading.y**2 + heading.z**2
    check(abs(length - 1) < 1e-9, f"tick {count}: heading of length^2 {length}")
    check(message.palette_fingerprint != 0, f"tick {count}: no fingerprint")


def check_transforms(message):
    parents = {t.child_frame_id: t.parent_frame_id for t in message.transforms}
    if "creature" not in parents:
        # Ground, outcrop and rocks.
        check(set(parents.values()) == {"world"}, f"{parents}")
        return 0
    check(len(parents) == len(message.transforms), "two transforms with one name")
    check(parents.get("creature") == "world" == parents.get("climber"), f"{parents}")
    for t in message.transforms:
        q = t.rotation
        check(abs(q.x**2 + q.y**2 + q.z**2 + q.w**2 - 1) < 1e-6, f"{t.child_frame_id}: {q}")
    return len(parents) - 3


def check_figure(message):
    parents = {t.child_frame_id: t.parent_frame_id for t in message.transforms}
    check(len(parents) == len(message.transforms), "two joints of a figure with one name")
    check(parents.get("hero") == "world", f"{parents}")
    for child, parent in parents.items():
        known = parent in parents if child != "hero" else True
        check(known, f"{child}: its parent {parent} is no joint of the figure")
    for t in message.transforms:
        v = t.translation
        near = t.child_frame_id == "hero" or v.x**2 + v.y**2 + v.z**2 < 4
        check(near, f"{t.child_frame_id} is more than 2 m from its parent")
    return len(parents) - 1


def check_skin(message):
    check([f.name for f in message.fields] == ["x", "y", "z"], "fields of a point")
    check(len(message.data) % message.point_stride == 0, "an incomplete point")
    points = list(struct.iter_unpack("<fff", message.data))
    check(points and all(abs(x) < 1e4 for p in points for x in p), "no points, or points too far away")
    return len(points)


def check_scene(message):
    entities = {e.id: e for e in message.entities}
    check(set(entities) - {"touched"} == {"support", "climber"}, f"{list(entities)}")
    for entity in entities.values():
        for triangles in entity.triangles:
            check(len(triangles.indices) % 3 == 0, "an incomplete triangle")
            check(
                all(i < len(triangles.points) for i in triangles.indices),
                "a corner that is not a point",
            )
    touched = entities.get("touched")
    return len(touched.triangles[0].indices) // 3 if touched else 0


def check_scenery(message):
    """The meshes of the world: the ground, and in a climb the outcrop and the rocks."""
    corners = 0
    for entity in message.entities:
        check(entity.frame_id == entity.id, f"{entity.id} is in the frame {entity.frame_id}")
        for mesh in entity.triangles:
            check(mesh.indices and len(mesh.indices) % 3 == 0, f"{entity.id}: triangles")
            check(max(mesh.indices) < len(mesh.points), f"{entity.id}: a corner without a point")
            corners += len(mesh.indices)
    check("ground" in {e.id for e in message.entities}, "no ground")
    return corners // 3


def main(path):
    counts, most, last = Counter(), Counter(), 0
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        summary = reader.get_summary()
        check(len(summary.chunk_indexes) > 0, "no chunks")
        metadata = {m.name: m.metadata for m in reader.iter_metadata()}
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            topic = channel.topic
            check(schema.name == WANTED.get(topic), f"{topic} has schema {schema.name}")
            check(message.log_time >= last, f"{topic}: time goes back at {message.log_time}")
            last = message.log_time
            if topic == "/tick":
                check_tick(decoded, counts[topic])
            elif topic == "/transforms":
                most["joints"] = max(most["joints"], check_transforms(decoded))
            elif topic == "/figure":
                most["joints of the hero"] = max(most["joints of the hero"], check_figure(decoded))
            elif topic == "/skin":
                most["points"] = max(most["points"], check_skin(decoded))
            elif topic == "/scene":
                most["touched"] = max(most["touched"], check_scene(decoded))
            elif topic == "/scenery":
                most["world"] = max(most["world"], check_scenery(decoded))
            elif topic == "/touched":
                check(0 <= decoded.clusters_touched <= decoded.clusters, f"{decoded}")
                most["clusters"] = max(most["clusters"], decoded.clusters_touched)
            elif topic == "/log":
                check(decoded.message != "", "an empty log line")
            counts[topic] += 1
    for topic in WANTED:
        check(counts[topic] > 0, f"nothing on {topic}")
        stored = summary.statistics.channel_message_counts
        ids = [c.id for c in summary.channels.values() if c.topic == topic]
        check(stored.get(ids[0], 0) == counts[topic], f"{topic}: the index has another count")
    dt = float(metadata["clamber"]["tick_seconds"])
    check(abs(last * 1e-9 - (counts["/tick"] - 1) * dt) < 1e-6, "the last tick's time")
    check("seed" in metadata["settings"], "no seed")
    check(most["joints"] > 0 and most["touched"] > 0 and most["clusters"] > 0, f"{dict(most)}")
    check(most["joints of the hero"] > 20, f"{dict(most)}")
    print(f"{path}: {dict(counts)}; at most {dict(most)}; {metadata['clamber']['creature']}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
