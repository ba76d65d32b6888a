"""A synthetic person is sent by OSC, and footingd publishes its joints where they are: the whole line
from UDP to the channel `hands`, with the camera's place found from the person's stand.

Usage: skeleton.py BINARY_FOLDER
"""
import json
import sys
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


def main():
    with harness.Stage(sys.argv[1]) as stage:
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
        stage.wait_for_socket(stage.devices)
        check(*play(stage, "footing"), (0, 60))
        check(*play(stage, "sensebloom"), (60, 140))  # Without a time: the assumed 67 ms.
        check_faulty_link(stage)


if __name__ == "__main__":
    main()
