"""Records both servers live: ended by SIGINT the file is complete; killed it lacks a second at most.

Usage: record_scenario.py SCENARIOS_FOLDER BINARY_FOLDER NODE_FOLDER [SECONDS]
With SECONDS it measures what footing-log osc sends meanwhile.
"""
import select
import signal
import socket
import struct
import sys
import threading
import time

sys.path.insert(0, sys.argv[1])
import outside_readers  # noqa: E402
from harness import Stage  # noqa: E402


def check_missing(stage, info):
    """Nothing but what the servers left out themselves; a client of one of them has no more missing than both left out."""
    left_out = sum(stage.run_json("footing-ctl", "--connect", address, "status")["stats"]["ticks"]["left_out"]
                   for address in (stage.sensor, stage.simulation))
    assert info["missing_ticks"] <= left_out, (info, left_out)


def osc_messages(packet):
    """The messages of a bundle, by the specification of OSC 1.0: addresses and arguments."""
    assert len(packet) % 4 == 0 and packet[:16] == b"#bundle\0" + bytes(7) + b"\x01", packet[:16]

    def text(data, at):
        end = data.index(b"\0", at)
        after = end + 4 - end % 4
        assert not any(data[end:after]), "padding"
        return data[at:end].decode("ascii"), after

    at, messages = 16, []
    while at < len(packet):
        size = struct.unpack_from(">i", packet, at)[0]
        data = packet[at + 4:at + 4 + size]
        assert len(data) == size and size % 4 == 0
        address, here = text(data, 0)
        types, here = text(data, here)
        values = []
        for kind in types[1:]:
            if kind == "s":
                value, here = text(data, here)
            elif kind in "TF":
                value = kind == "T"
            else:
                value = struct.unpack_from({"f": ">f", "i": ">i", "d": ">d"}[kind], data, here)[0]
                here += 8 if kind == "d" else 4
            values.append(value)
        assert here == size, (address, types)
        messages.append((address, values))
        at += 4 + size
    return messages


def check_osc(stage):
    """Two receivers, one of which is not there; the other one gets every frame, in both formats."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        to = f"127.0.0.1:{receiver.getsockname()[1]}"
        for form, frame_end in (("vmc", "/VMC/Ext/T"), ("osc", "/footing/character/1/frame")):
            # The kernel keeps fewer datagrams than come in 2 s.
            packets, ended = [], threading.Event()

            def receive():
                while select.select([receiver], [], [], 0.2)[0] or not ended.is_set():
                    if select.select([receiver], [], [], 0)[0]:
                        packets.append(receiver.recv(65536))

            reader = threading.Thread(target=receive)
            reader.start()
            try:
                sent = stage.run_json("footing-log", "osc", "--connect", stage.simulation, "--to", to, "--to",
                                      "127.0.0.1:9", "--format", form, "--rate-hz", 50, "--seconds", 2)
            finally:
                ended.set()
                reader.join()
            times, bones = [], {}
            for address, values in (message for packet in packets for message in osc_messages(packet)):
                if address == frame_end:
                    times.append(values[0])
                elif address == "/VMC/Ext/Bone/Pos":
                    bones[values[0]] = values[1:]
            assert len(times) == sent["frames"] and all(b > a for a, b in zip(times, times[1:])), (sent, times)
            assert 30 <= sent["frames"] <= 110 and sent["refused_packets"] > 0, sent
            if form == "vmc":
                assert {"Hips", "LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "RightHand", "Head"} <= set(bones), bones
                assert all(abs(sum(v * v for v in bone[3:]) - 1) < 1e-5 for bone in bones.values()), bones


def sender(stage, rate_hz, seconds):
    return lambda to: stage.run_json("footing-log", "osc", "--connect", stage.simulation, "--to", to, "--rate-hz", rate_hz,
                                     "--seconds", seconds, timeout_s=seconds + 60)["frames"]


def check_outside_readers(stage, recording, node):
    """The biped in every format of bodies, and as an avatar's packets."""
    try:
        outside_readers.check_bodies(stage, recording, node, with_forces=False)
        outside_readers.check_osc(node, sender(stage, 50, 2))
    except outside_readers.NoNode as error:
        print(f"not checked by readers of others: {error}")


def measure(seconds):
    """The packets of a long walk, at footing-log's own rate, received by npm's osc."""
    rate_hz = 60
    with Stage(sys.argv[2]) as stage:
        stage.start_servers()
        stage.start("footing-stream", "user", "--interface", "wrist", "--see", stage.simulation, "--to", stage.devices)
        longest_s = outside_readers.check_osc(sys.argv[3], sender(stage, rate_hz, seconds))
    print(f"{seconds} s: no error, no frame lost, longest time between two {1e3 * longest_s:.1f} ms, "
          f"{longest_s * rate_hz:.2f} periods")


def main():
    with Stage(sys.argv[2]) as stage:
        stage.start_servers()
        stage.start("footing-stream", "user", "--script", "demo", "--interface", "wrist", "--to",
                    stage.devices)
        connect = ("--connect", stage.sensor, "--connect", stage.simulation)
        whole, killed, repaired = (stage.folder / f"{n}.mcap" for n in ("whole", "killed", "fixed"))
        started_s = {}
        for name, path in (("ended", whole), ("killed", killed)):
            stage.start("footing-log", "record", "--from-ring", *connect, "--out", path, name=name)
            started_s[name] = time.monotonic()
        stage.wait_for(lambda: killed.exists() and killed.stat().st_size > 200_000,
                       "a recording of some size", 30)
        killed_after_s = time.monotonic() - started_s["killed"]
        stage.stop("killed", signal.SIGKILL)
        assert stage.stop("ended", signal.SIGINT) == 0

        info = stage.run_json("footing-log", "info", whole)
        topics = {topic["topic"]: topic["messages"] for topic in info["topics"]}
        for topic in ("/footingd/status", "/footingd/motion", "/footingd/features",
                      "/footingd/raw", "/footing-sim/characters", "/footing-sim/skeletons",
                      "/footing-sim/track"):
            assert topics.get(topic, 0) > 0, (topic, topics)
        assert info["complete"] and info["simulated"] is True, info
        check_missing(stage, info)

        cut = stage.run("footing-log", "info", killed, "--json")
        assert cut.returncode == 4 and "repair" in cut.stderr, cut
        stage.run_json("footing-log", "repair", killed, "--out", repaired)
        kept_s = stage.run_json("footing-log", "info", repaired)["duration_s"]
        # Begun long after the servers, with and without what they hold of before.
        for ring, least_s, most_s in (((), 0.5, 2.5), (("--from-ring",), 2.6, 40)):
            late = stage.folder / f"late{len(ring)}.mcap"
            info = stage.run_json("footing-log", "record", *connect, "--out", late, "--seconds", 2, *ring)
            assert least_s <= info["duration_s"] <= most_s, (ring, info)
            check_missing(stage, info)

        check_osc(stage)
        check_outside_readers(stage, whole, sys.argv[3])

        # Start-up of the process and connecting are within the first 0.5 s.
        assert kept_s > killed_after_s - 1.5, (kept_s, killed_after_s)
        print(f"killed after {killed_after_s:.2f} s, kept {kept_s:.2f} s")


if __name__ == "__main__":
    measure(int(sys.argv[4])) if len(sys.argv) > 4 else main()
