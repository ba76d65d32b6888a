"""Faulty links in front of every client: each comes back within 2 s of the end of the fault, resumes by sequence, and reports
what it missed.

Usage: faults.py BINARY_FOLDER [--seed N] [--fault NAME]...

Between the programs stand fault proxies: footing-log, footing-ctl watch and footing-sim before footingd, footing-view before
footing-sim, footing-stream before the device socket. Each fault lies on all of them at once.
"""
import argparse
import csv
import random
import signal
import sys
import time

from fault_proxy import FaultProxy
from harness import Stage

FAULTS = ("delay", "stall", "split", "dribble", "reset", "half_close")
FAULT_S = 3.5  # Longer than the 3 s after which a silent link is stale.
LONG_STALL_S = 11.5  # Longer than the 10 s after which it is dead.
MOST_RETURN_S = 2
GIVE_UP_S = 15
# Of reports of devices, which have no time by which they could be told apart from those that waited.
SIGN_BYTES = 2048


class Links:
    def __init__(self, stage, seed):
        self.stage = stage
        self.proxies = {}
        self.addresses = {}
        for name, target in (("log", stage.sensor), ("ctl", stage.sensor), ("sim", stage.sensor),
                             ("view", stage.simulation), ("devices", stage.devices)):
            self.addresses[name] = f"unix:{stage.folder}/proxy-{name}.sock"
            self.proxies[name] = FaultProxy(self.addresses[name], target, seed + len(self.proxies)).start()

    def apply(self, fault, seconds):
        for proxy in self.proxies.values():
            proxy.set(fault)
        time.sleep(seconds)
        for proxy in self.proxies.values():
            proxy.clear()

    def returns(self):
        """Seconds until each client got a tick that was made after the end of the fault."""
        took = {name: proxy.seconds_to_fresh_tick(GIVE_UP_S) for name, proxy in self.proxies.items()
                if name != "devices"}
        devices = self.proxies["devices"]
        took["devices"] = devices.seconds_until(lambda: devices.passed["up"] >= SIGN_BYTES, GIVE_UP_S)
        return took

    def stop(self):
        for proxy in self.proxies.values():
            proxy.stop()


def start_daemon(stage):
    stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
    stage.wait_for_socket(stage.devices)


def start_programs(stage, links):
    start_daemon(stage)
    stage.start("footing-sim", "--sensor", links.addresses["sim"], "--listen", stage.simulation)
    stage.wait_for_socket(stage.simulation)
    stage.start("footing-stream", "user", "--script", "walk", "--interface", "wrist", "--to", links.addresses["devices"],
                "--seconds", 600)
    stage.wait_for(lambda: len(stage.run_json("footing-ctl", "--connect", stage.sensor, "status")["devices"]) == 2,
                   "both devices", 20)
    stage.start("footing-log", "record", "--connect", links.addresses["log"], "--out", stage.folder / "all.mcap")
    stage.start("footing-ctl", "--connect", links.addresses["ctl"], "watch")
    stage.start("footing-view", "--connect", links.addresses["view"], "--text")
    for name in ("log", "ctl", "view"):
        stage.wait_for(lambda: links.proxies[name].fresh_ns is not None, f"{name} to be served")


def sequences(stage, recording):
    """Of the ticks that have features, as recorded."""
    folder = stage.folder / "csv"
    done = stage.run("footing-log", "export", recording, "--format", "csv", "--out", folder)
    assert done.returncode == 0, done.stderr
    with open(folder / "footingd_features.csv", encoding="utf-8") as file:
        return [int(row["sequence"]) for row in csv.DictReader(file)]


def check_return(links, fault, worst):
    took = links.returns()
    print(f"{fault:10}: " + ", ".join(f"{name} {'never' if s is None else format(s, '.2f')} s" for name, s in took.items()),
          flush=True)
    for name, seconds in took.items():
        assert seconds is not None and seconds <= MOST_RETURN_S, f"{name} after {fault}: {seconds} s"
        worst[name] = max(worst.get(name, 0), seconds)


def check_recording(stage):
    """Nothing is missing: every fault was shorter than the server's ring."""
    assert stage.stop("footing-log", signal.SIGINT) == 0
    info = stage.run_json("footing-log", "info", stage.folder / "all.mcap")
    assert info["complete"] and info["missing_ticks"] == 0, info
    recorded = sequences(stage, stage.folder / "all.mcap")
    steps = {b - a for a, b in zip(recorded, recorded[1:]) if b != a}  # A rig has a row each.
    assert steps == {1}, f"sequences advance by {sorted(steps)}"
    print(f"{len(recorded)} rows of features, without a hole, over {len(set(recorded))} ticks")


def check_gap(stage, links):
    """A server that was killed comes back with a new epoch: the recording says that something is missing."""
    path = stage.folder / "gap.mcap"
    stage.start("footing-log", "record", "--connect", links.addresses["log"], "--out", path)
    log = stage.folder / "footing-log.log"
    stage.wait_for(lambda: "connected to footingd" in log.read_text(), "the recorder")
    stage.stop("footingd", signal.SIGKILL)
    time.sleep(FAULT_S)
    start_daemon(stage)
    began_s = time.monotonic()
    stage.wait_for(lambda: log.read_text().count("connected to footingd") == 2, "the recorder's return")
    took_s = time.monotonic() - began_s
    assert took_s <= MOST_RETURN_S, took_s
    time.sleep(0.5)
    assert stage.stop("footing-log", signal.SIGINT) == 0
    info = stage.run_json("footing-log", "info", path)
    assert info["gaps"] >= 1, info
    print(f"kill -9: back after {took_s:.2f} s, {info['gaps']} gap reported")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binaries")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--fault", action="append", choices=FAULTS, default=[])
    arguments = parser.parse_args()
    faults = arguments.fault or list(FAULTS)
    random.Random(arguments.seed).shuffle(faults)
    worst = {}
    with Stage(arguments.binaries) as stage:
        links = Links(stage, arguments.seed)
        try:
            start_programs(stage, links)
            for fault in faults:
                links.apply(fault, FAULT_S)
                check_return(links, fault, worst)
            if not arguments.fault:
                links.apply("stall", LONG_STALL_S)
                check_return(links, "long stall", worst)
            check_recording(stage)
            for name in ("footing-ctl", "footing-view", "footing-sim", "footing-stream"):
                assert stage.processes[name].poll() is None, f"{name} ended"
            check_gap(stage, links)
        finally:
            links.stop()
    print("at most: " + ", ".join(f"{name} {seconds:.2f} s" for name, seconds in worst.items()))


if __name__ == "__main__":
    sys.exit(main())
