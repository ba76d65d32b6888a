"""Thousands of viewers at the edge of footing-relay: what they get, how late, and what it costs.

Usage: relay_load.py BINARY_FOLDER CROWD [--viewers N]... [--edges N] [--seconds S] [--json]

footingd with two simulated remotes, footing-relay publish, nats-server and the edges run on this machine beside the
crowd (CROWD is scenario_crowd), so cores are shared and only figures of one run compare. Counted are ticks made within
the time; a lag is from the server's stamp until the viewer has read the tick. CPU is percent of one core, from
/proc/PID/stat. Fails when less than 99.9 % of the ticks reach the viewers, three times in a row.
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import time

import brokers
import relay
from harness import Stage
from ports import free_port

LEAST_DELIVERED = 0.999
TRIES = 3
SPARE_DESCRIPTORS = 200


def cpu_s(process):
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def memory_mb(process):
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    return int(status.split("VmRSS:")[1].split()[0]) / 1024


def one_run(crowd, addresses, viewers, seconds, processes):
    words = [word for address in addresses for word in ("--connect", address)]
    command = [crowd, *words, "--viewers", str(viewers), "--seconds", str(seconds)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        processes = {**processes, "viewers": [process]}

        def all_cpu_s():
            return {name: sum(map(cpu_s, group)) for name, group in processes.items()}

        try:
            marks = []
            for word in ("begin", "end"):
                line = process.stdout.readline()
                assert line.strip() == word, process.communicate(timeout=10)[1]
                marks.append((time.monotonic(), all_cpu_s()))
            memory = max(memory_mb(edge) for edge in processes["edge"])
            descriptors = max(len(list(pathlib.Path(f"/proc/{edge.pid}/fd").iterdir())) for edge in processes["edge"])
            output, errors = process.communicate(timeout=seconds + 30)
        finally:
            process.kill()
    assert process.returncode == 0, errors
    (begin_s, before), (end_s, after) = marks
    result = json.loads(output)
    result["delivered_percent"] = 100 * result["delivered"] / result["expected"]
    result["cpu_percent"] = {name: 100 * (after[name] - before[name]) / (end_s - begin_s) for name in after}
    result["edge_mb"], result["edge_descriptors"] = memory, descriptors
    result["us_per_delivery"] = 1e6 * (after["edge"] - before["edge"]) / (result["delivered"] or 1)
    result["load_average"] = os.getloadavg()[0]
    return result


def show(run):
    cpu = run["cpu_percent"]
    print(f"{run['viewers']:5} viewers: {run['delivered_percent']:.3f} % of {run['expected']} delivered, "
          f"{run['rate_hz']:.1f} Hz, lag p50 {run['lag_p50_ms']:.1f} p99 {run['lag_p99_ms']:.1f} ms, CPU edge "
          f"{cpu['edge']:.0f} % ({run['us_per_delivery']:.1f} us a tick), nats-server {cpu['nats']:.0f} %, publisher "
          f"{cpu['publisher']:.0f} %, viewers {cpu['viewers']:.0f} %, edge {run['edge_mb']:.0f} MB, "
          f"{run['edge_descriptors']} descriptors, load {run['load_average']:.1f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binaries")
    parser.add_argument("crowd")
    parser.add_argument("--viewers", type=int, action="append", default=[])
    parser.add_argument("--edges", type=int, default=1)
    parser.add_argument("--rate-hz", type=float, default=30)
    parser.add_argument("--seconds", type=float, default=8)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    brokers.skip_without("nats-server")
    counts = arguments.viewers or [100, 300, 1000, 3000, 5000]
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    if most < max(counts) + SPARE_DESCRIPTORS:
        print(f"skipped: ulimit -Hn is {most}, {max(counts) + SPARE_DESCRIPTORS} are needed")
        return brokers.SKIPPED
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
    runs, right = [], True
    with Stage(arguments.binaries) as stage, brokers.nats(stage.folder) as nats:
        relay.start_footingd(stage)
        stage.start_user("walk", "--seconds", 3600)
        relay.start_publisher(stage, nats)
        addresses = [f"tcp:127.0.0.1:{free_port()}" for _ in range(arguments.edges)]
        edges = [stage.start("footing-relay", "serve", "--nats", f"tcp:127.0.0.1:{nats.port}", "--site", relay.SITE,
                             "--listen", address, "--rate-hz", arguments.rate_hz, name=f"edge{number}")
                 for number, address in enumerate(addresses)]
        for number in range(arguments.edges):
            stage.wait_for(lambda log=stage.folder / f"edge{number}.log": "serving footingd" in log.read_text(),
                           "the edge to listen")
        time.sleep(2)  # The devices attach.
        processes = {"edge": edges, "nats": [nats.process], "publisher": [stage.processes["publisher"]],
                     "footingd": [stage.processes["footingd"]]}
        for viewers in counts:
            for _ in range(TRIES):
                run = one_run(arguments.crowd, addresses, viewers, arguments.seconds, processes)
                show(run) if not arguments.json else print(run["viewers"], file=sys.stderr)
                if run["delivered_percent"] >= 100 * LEAST_DELIVERED:
                    break
            right = right and run["delivered_percent"] >= 100 * LEAST_DELIVERED
            runs.append(run)
    if arguments.json:
        print(json.dumps({"runs": runs}))
    return 0 if right else 1


if __name__ == "__main__":
    sys.exit(main())
