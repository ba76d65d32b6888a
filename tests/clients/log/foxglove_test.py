"""Lets readers that are not ours take what an export for Foxglove has: @mcap/core the file, Foxglove's own schemas
(npm's @foxglove/schemas, compiled by protoc) the messages.

Usage: foxglove_test.py WRITE_SAMPLE_RECORDING FOOTING_LOG SCENARIOS_FOLDER NODE_FOLDER
Ends with 77 (skipped) where node, npm, protoc or Python's protobuf is missing or the packages cannot be installed.
"""
import base64
import json
import pathlib
import shutil
import subprocess
import sys

sys.path.insert(0, sys.argv[3])
import outside_readers  # noqa: E402


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


try:
    from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
except ImportError:
    skip("Python's protobuf is not installed")

TOPICS = {"/foxglove/footing-sim/transforms": "FrameTransforms", "/foxglove/footing-sim/body": "SceneUpdate",
          "/foxglove/footing-sim/forces": "SceneUpdate", "/foxglove/footing-sim/track": "SceneUpdate",
          "/foxglove/footing-sim/joints": "PointCloud", "/foxglove/footing-sim/log": "Log",
          "/foxglove/footingd/transforms": "FrameTransforms", "/foxglove/footingd/boards": "SceneUpdate",
          "/foxglove/footingd/log": "Log"}


def shape(message):
    """Everything of a message type that decides what its bytes mean."""
    fields = sorted((f.name, f.number, f.type, f.label, f.type_name) for f in message.field)
    enums = sorted((e.name, [(v.name, v.number) for v in e.value]) for e in message.enum_type)
    return fields, enums


def types_of(descriptors):
    return {f"{file.package}.{message.name}": message for file in descriptors.file for message in file.message_type}


def foxglove_types(folder):
    """The pool of Foxglove's own schemas, and their descriptors by name."""
    done = subprocess.run(["protoc", "-I", folder, "--include_imports", f"--descriptor_set_out={folder}/all.bin",
                           *sorted((folder / "foxglove").glob("*.proto"))], check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    descriptors = descriptor_pb2.FileDescriptorSet.FromString((folder / "all.bin").read_bytes())
    pool = descriptor_pool.DescriptorPool()
    for file in descriptors.file:
        pool.Add(file)
    return pool, types_of(descriptors)


def check_rises(topic, messages):
    times = [int(time) for time, _ in messages]
    assert all(later > earlier for earlier, later in zip(times, times[1:])), f"{topic}: times do not rise"


def check_tree(frames):
    """Every frame has one parent, and each way up ends at the world."""
    for child in frames:
        seen, frame = set(), child
        while frame != "world":
            assert frame in frames and frame not in seen, f"{child} does not hang on the world"
            seen.add(frame)
            frame = frames[frame]


def decode(topics, pool, theirs):
    """The messages by topic, by Foxglove's schemas, which the file's own must equal."""
    decoded = {}
    for topic, channel in topics.items():
        assert channel["encoding"] == "protobuf" and channel["schema"] == "foxglove." + TOPICS[topic], channel["schema"]
        own = types_of(descriptor_pb2.FileDescriptorSet.FromString(base64.b64decode(channel["descriptors"])))
        for name, message in own.items():
            if name.startswith("foxglove."):
                assert shape(message) == shape(theirs[name]), f"{name} is not Foxglove's"
        kind = message_factory.MessageFactory(pool).GetPrototype(pool.FindMessageTypeByName(channel["schema"]))
        check_rises(topic, channel["messages"])
        decoded[topic] = [kind.FromString(base64.b64decode(data)) for _, data in channel["messages"]]
        for message in decoded[topic]:
            before = message.SerializeToString()
            message.DiscardUnknownFields()
            assert message.SerializeToString() == before, f"{topic} has fields that Foxglove does not know"
    return decoded


def check(topics, pool, theirs):
    assert topics.keys() == TOPICS.keys(), sorted(topics)
    decoded = decode(topics, pool, theirs)
    frames = {}
    for topic in TOPICS:
        for message in decoded[topic] if topic.endswith("/transforms") else []:
            for one in message.transforms:
                assert frames.setdefault(one.child_frame_id, one.parent_frame_id) == one.parent_frame_id
    check_tree(frames)
    for topic, kind in TOPICS.items():
        for message in decoded[topic] if kind == "SceneUpdate" else []:
            for entity in message.entities:
                assert entity.frame_id == "world" or entity.frame_id in frames, entity.frame_id
    texts = [log.message for server in ("footingd", "footing-sim") for log in decoded[f"/foxglove/{server}/log"]]
    assert texts == ["stimulus on 3", "again", "KIND_FALL: fell"], texts
    print({topic: len(messages) for topic, messages in decoded.items()}, "frames:", sorted(frames))


def main(writer, footing_log, work):
    if shutil.which("protoc") is None:
        skip("protoc is not installed")
    try:
        folder = outside_readers.node_folder(work)
    except outside_readers.NoNode as error:
        skip(error)
    recording = folder / "scene.mcap"
    subprocess.run([writer, recording, "scene"], check=True)
    exported = subprocess.run([footing_log, "export", recording, "--format", "foxglove", "--out", folder, "--force", "--json"],
                              check=True, capture_output=True, text=True)
    summary = json.loads(exported.stdout)
    protos = folder / "protos"
    topics = outside_readers.run_node(folder, "foxglove.mjs", summary["files"][0]["path"], protos)
    counts = {one["topic"]: one["messages"] for one in summary["topics"]}
    assert counts == {topic: len(channel["messages"]) for topic, channel in topics.items()}, counts
    check(topics, *foxglove_types(protos))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[4]))
