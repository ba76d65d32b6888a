"""A synthetic person is sent by OSC, and footingd publishes its joints where they are: the whole line
from UDP to the channel `hands`, with the camera's place found from the person's stand. So is a person as three other
programs send it, whose packets are written here by the programs' own lists of joints.

Usage: skeleton.py BINARY_FOLDER
"""
import json
import signal
import socket
import struct
import sys
import threading
import time
from statistics import median

import harness
from fault_proxy import UdpFaultProxy
from ports import free_port


def play(stage, dialect, name=None, send_port=None, port=None):
    """The hands of a clip sent in a dialect, as (role, sample), and the receiver's statistics."""
    name = name or dialect
    port = port or free_port()
    stage.start("footing-skeleton", "--listen", f"127.0.0.1:{port}", "--to", stage.devices, "--seconds", 30,
                "--json", name=name)
    stage.wait_for(lambda: "connected to footingd" in (stage.folder / f"{name}.log").read_text(),
                   "the device socket")
    stage.start("footing-skeleton", "send", "--to", f"127.0.0.1:{send_port or port}", "--dialect", dialect,
                "--seconds", 6, name=f"send-{name}")
    samples = []
    for tick in harness.read_ticks(stage.sensor, 40, ("hands",)):
        samples += tick.get("hands", {}).get("samples", [])
        if stage.processes[f"send-{name}"].poll() is not None and not tick.get("hands"):
            break  # footingd has published what came before its end.
    assert stage.stop(f"send-{name}") == 0
    assert stage.stop(name) == 0
    return samples, json.loads((stage.folder / f"{name}.log").read_text().splitlines()[-1])


def check_faulty_link(stage):
    """A fifth of the datagrams lost, a fifth twice, a fifth overtaken by others: what is published is right and runs forwards."""
    port, send_port = free_port(), free_port()
    proxy = UdpFaultProxy(send_port, port, seed=3, loss=0.2, duplicate=0.2, reorder=0.2).start()
    try:
        samples, statistics = play(stage, "footing", "faulty", send_port, port)
    finally:
        proxy.stop()
    assert min(proxy.lost, proxy.doubled, proxy.late) > 20, vars(proxy)
    check(samples, statistics, (0, 200), share=0.5)
    instants = {}
    for sample in samples:
        joint = (sample.get("role"), sample.get("joint"))
        assert sample["sampled_ns"] > instants.get(joint, 0), f"{joint} goes back by {instants[joint] - sample['sampled_ns']} ns"
        instants[joint] = sample["sampled_ns"]


def check(samples, statistics, age_ms, share=1):
    assert statistics["people"][0]["advice"] == "", statistics
    assert abs(statistics["camera"]["x_m"] - 2.4) < 0.02, statistics
    assert statistics["published"] > 100 * share and statistics["dropped_hand_frames"] == 0, statistics
    seen = [sample for sample in samples if sample.get("confidence", 0) > 0]
    left = [sample for sample in seen if sample.get("role") == 1]
    right = [sample for sample in seen if sample.get("role") == 2]
    assert min(len(left), len(right)) > 60 * share, (len(left), len(right))
    ages_ms = []
    # The left hand hangs beside the hip while the right one waves above the shoulder.
    for sample in left:
        place = sample["position_m"]
        assert abs(place["y"] - 0.26) < 0.05 and abs(place["z"] - 0.77) < 0.08, sample
        assert abs(sample["sd_m"]["x"] - 0.0427) < 0.001 and sample["tracker"] == "skeleton", sample
        ages_ms.append((sample["received_ns"] - sample["sampled_ns"]) / 1e6)
    # The median, as a machine that stalls delays some of them.
    assert min(ages_ms) >= age_ms[0] and median(ages_ms) <= age_ms[1], sorted(ages_ms)
    assert max(sample["position_m"]["z"] for sample in right) > 1.3
    # Every joint that has no role, by its number, 13 of them.
    joints = {number: [sample for sample in samples if sample.get("joint") == number] for number in range(1, 14)}
    assert all(len(of) > 60 * share for of in joints.values()), {number: len(of) for number, of in joints.items()}
    assert all(not sample.get("role") for of in joints.values() for sample in of)
    knee = [sample for sample in joints[10] if sample.get("confidence", 0) > 0][0]  # The left one.
    assert abs(knee["position_m"]["z"] - 0.5) < 0.1 and knee["position_m"]["y"] > 0, knee


# A person 2.4 m before the camera: metres to the camera's left and up. The left hand is beside the head.
PERSON = {"head": (0, 0.65), "neck": (0, 0.45), "torso": (0, 0.15), "waist": (0, -0.1)} | {
    f"{side}_{joint}": (-sign * x, y) for side, sign, arm in (("left", 1, ((0.35, 0.2), (0.31, 0.4), (0.3, 0.45))),
                                                              ("right", -1, ((0.22, 0.12), (0.25, -0.08), (0.25, -0.13))))
    for joint, (x, y) in zip(("shoulder", "elbow", "wrist", "hand", "hip", "knee", "ankle", "foot"),
                             ((0.18, 0.4), *arm, (0.1, -0.1), (0.1, -0.5), (0.1, -0.92), (0.12, -0.95)))}
AWAY_M, CAMERA_M = 2.4, (2.4, 0, 1)
KINECT_V2 = ("SpineBase SpineMid Neck Head ShoulderLeft ElbowLeft WristLeft HandLeft ShoulderRight ElbowRight WristRight "
             "HandRight HipLeft KneeLeft AnkleLeft FootLeft HipRight KneeRight AnkleRight FootRight SpineShoulder HandTipLeft "
             "ThumbLeft HandTipRight ThumbRight").split()
AZURE = ("Pelvis SpineNavel SpineChest Neck ClavicleLeft ShoulderLeft ElbowLeft WristLeft HandLeft HandTipLeft ThumbLeft "
         "ClavicleRight ShoulderRight ElbowRight WristRight HandRight HandTipRight ThumbRight HipLeft KneeLeft AnkleLeft "
         "FootLeft HipRight KneeRight AnkleRight FootRight Head Nose EyeLeft EarLeft EyeRight EarRight").split()
TRUNK = {"SpineBase": "waist", "Pelvis": "waist", "SpineMid": "torso", "SpineNavel": "torso", "SpineChest": "torso",
         "SpineShoulder": "neck", "Neck": "neck", "Head": "head", "Nose": "head"}


def place(name):
    """Where a joint with this name of Microsoft's is; thumbs, ears and such are where nothing must look for them."""
    side = "left" if name.endswith("Left") else "right"
    return PERSON.get(TRUNK.get(name, f"{side}_{name.removesuffix('Left').removesuffix('Right').lower()}"), (1, 1))


def osc(address, *arguments):
    def text(word):
        return word.encode() + b"\0" * (4 - len(word) % 4)

    kinds = {int: ("i", lambda value: struct.pack(">i", value)), float: ("f", lambda value: struct.pack(">f", value)),
             str: ("s", text)}
    types = "".join(kinds[type(value)][0] for value in arguments)
    return text(address) + text("," + types) + b"".join(kinds[type(value)][1](value) for value in arguments)


def bundle(*messages):
    return b"#bundle\0" + struct.pack(">Q", 1) + b"".join(struct.pack(">I", len(one)) + one for one in messages)


def of_nite2():
    """AIam's tracker: millimetres, x to the camera's right."""
    names = [name for name in PERSON if name != "waist" and not name.endswith(("wrist", "ankle"))]
    joints = {name: PERSON[name.replace("foot", "ankle")] for name in names}
    return [bundle(osc("/begin_frame", 12.5)), bundle(*(
        osc("/joint", 1, name, -1e3 * x, 1e3 * y, 1e3 * AWAY_M, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0) for name, (x, y) in joints.items()))]


def of_kinect_v2():
    """KinectV2-OSC: metres, x to the camera's left; a packet a joint, then the hands."""
    person = "/bodies/72057594037928017"
    return [osc(f"{person}/joints/{name}", float(place(name)[0]), float(place(name)[1]), AWAY_M, "Tracked")
            for name in KINECT_V2] + [osc(f"{person}/hands/{side}", "Open", "High") for side in ("Left", "Right")]


def of_azure():
    """azure-kinect-osc: millimetres, x to the camera's right, y down; a packet a joint, by its number."""
    return [osc(f"/bodies/0/joints/{number}", -1e3 * place(name)[0], -1e3 * place(name)[1], 1e3 * AWAY_M)
            for number, name in enumerate(AZURE)]


def check_sender(stage, dialect, packets):
    port = free_port()
    stage.start("footing-skeleton", "--listen", f"127.0.0.1:{port}", "--to", stage.devices, "--json", "--camera-m",
                ",".join(map(str, CAMERA_M)), name=dialect)
    log = stage.folder / f"{dialect}.log"
    stage.wait_for(lambda: "connected to footingd" in log.read_text(), "the device socket")

    def send():
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for _ in range(40):
                for packet in packets:
                    sender.sendto(packet, ("127.0.0.1", port))
                time.sleep(0.03)

    sending = threading.Thread(target=send)
    sending.start()
    samples = [sample for tick in harness.read_ticks(stage.sensor, 1.5, ("hands",))
               for sample in tick.get("hands", {}).get("samples", [])]
    sending.join()
    assert stage.stop(dialect, signal.SIGINT) == 0
    statistics = json.loads(log.read_text().splitlines()[-1])
    person = statistics["people"][0]
    assert len(statistics["people"]) == 1 and person["dialect"] == dialect and person["advice"] == "", statistics
    assert statistics["unknown_messages"] + statistics["rejected_joints"] == 0 and person["joints"] == 15 * person["skeletons"], statistics
    for role, name in ((1, "left_hand"), (2, "right_hand")):
        of_hand = [sample["position_m"] for sample in samples if sample.get("role") == role]
        assert len(of_hand) > 20, (dialect, len(of_hand))
        for got in of_hand:  # The camera looks at the person, who looks along W's x.
            wanted = {"x": CAMERA_M[0] - AWAY_M, "y": -PERSON[name][0], "z": CAMERA_M[2] + PERSON[name][1]}
            assert all(abs(got.get(axis, 0) - wanted[axis]) < 1e-3 for axis in "xyz"), (dialect, name, got, wanted)


def main():
    with harness.Stage(sys.argv[1]) as stage:
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
        stage.wait_for_socket(stage.devices)
        check(*play(stage, "footing"), (0, 60))
        check(*play(stage, "sensebloom"), (60, 140))  # Without a time: the assumed 67 ms.
        check_faulty_link(stage)
        for dialect, packets in (("nite2", of_nite2()), ("kinect-v2-osc", of_kinect_v2()), ("azure-kinect-osc", of_azure())):
            check_sender(stage, dialect, packets)


if __name__ == "__main__":
    main()
