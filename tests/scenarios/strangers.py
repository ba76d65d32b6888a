"""Connections that never become sessions, and what the sessions that there are notice of them.

Usage: strangers.py BINARY_FOLDER [--json] [--real-time]

Before a footingd with devices stand 5000 connections that say nothing, 20 that announce 256 MB before they have said who they
are, and 200 half-open ones (half a Hello, then nothing). A healthy session's 99th percentile of delay stays within twice that
without them (or 20 ms, where that is longer), memory within 8 MB, and half-open ones are cut at 3 s. Three tries, since other
work on the machine may disturb one. --real-time is as in flood.py: priorities, pairs, and a bar of twice without the 20 ms.
"""
import argparse
import json
import multiprocessing
import os
import resource
import selectors
import socket
import struct
import sys
import time

import flood
from harness import Stage
from ports import free_port

IDLE, DECLARING, HALF_OPEN = 5000, 20, 200
DECLARED_BYTES = 256 << 20
MOST_GROWTH_BYTES = 8 << 20
HELLO_DEADLINE_S, MOST_LATE_S = 3, 1
SECONDS = 4
TRIES = 3


def resident_bytes(process):
    return int(open(f"/proc/{process.pid}/statm").read().split()[1]) * os.sysconf("SC_PAGESIZE")


def hold(target, count, first_bytes, results, end):
    """So many connections, until the server has closed them all or is late with it, and the measuring has ended."""
    selector = selectors.DefaultSelector()
    ages, refused = [], 0

    def look(wait_s):
        for key, _ in selector.select(wait_s) if selector.get_map() else ():
            try:
                gone = not key.fileobj.recv(4096)
            except OSError:
                gone = True
            if gone:
                ages.append(time.monotonic() - key.data)
                selector.unregister(key.fileobj)
                key.fileobj.close()

    for made in range(count):
        connection = socket.socket(socket.AF_INET)
        try:
            connection.settimeout(5)
            connection.connect(target)
            connection.sendall(first_bytes)
            connection.setblocking(False)
            selector.register(connection, selectors.EVENT_READ, time.monotonic())
        except OSError:
            refused += 1
            connection.close()
        if made % 20 == 0:
            look(0)
    give_up = time.monotonic() + HELLO_DEADLINE_S + MOST_LATE_S + 1
    while not end.is_set() or (selector.get_map() and time.monotonic() < give_up):
        look(0.1)
        time.sleep(0.01)
    results.put({"refused": refused, "ages_s": ages, "left": len(selector.get_map())})


def one_run(stage, target, kind, count, first_bytes, priority=0):
    server = stage.processes["footingd"]
    before = resident_bytes(server)
    end, held, measured = multiprocessing.Event(), multiprocessing.Queue(), multiprocessing.Queue()
    holding = multiprocessing.Process(target=hold, args=(target, count, first_bytes, held, end))
    if count:
        holding.start()
    measuring = multiprocessing.Process(target=flood.measure, args=(stage.sensor, SECONDS, measured, priority))
    measuring.start()
    most = before
    while measuring.is_alive() and measured.empty():
        most = max(most, resident_bytes(server))
        time.sleep(0.05)
    result = {"kind": kind, "count": count, **measured.get(timeout=30), "growth_mb": (most - before) / 1e6}
    measuring.join()
    end.set()
    if count:
        result |= held.get(timeout=60)
        holding.join()
        ages = sorted(result.pop("ages_s"))
        result |= {"closed": len(ages), "oldest_s": ages[-1] if ages else 0}
    return result


def with_ratio(run, quiet):
    return run | {"quiet_p99_ms": quiet["p99_ms"], "p99_ratio": run["p99_ms"] / quiet["p99_ms"]}


def problems_of(run, quiet):
    found = []
    if not flood.within_bar(run, quiet):
        found.append(f"{run['hz']:.1f} Hz, p99 {run['p99_ms']:.1f} ms beside {quiet['p99_ms']:.1f}")
    if run["growth_mb"] * 1e6 > MOST_GROWTH_BYTES:
        found.append(f"memory grew by {run['growth_mb']:.1f} MB")
    if run["left"] > 0:
        found.append(f"{run['left']} connections were not closed")
    if run["oldest_s"] > HELLO_DEADLINE_S + MOST_LATE_S:
        found.append(f"one was left open for {run['oldest_s']:.1f} s")
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("binaries")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--real-time", action="store_true")
    options = parser.parse_args()
    priority = flood.HEALTHY_PRIORITY if options.real_time else 0
    hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard if hard < 1 << 20 else 1 << 20, hard))
    kinds = [("idle", IDLE, b""), ("declaring", DECLARING, struct.pack("<I", DECLARED_BYTES) + bytes(64)),
             ("half-open", HALF_OPEN, struct.pack("<I", 20) + b"\x0a\x12")]
    failed = []
    with Stage(options.binaries) as stage:
        port = free_port()
        if priority:
            flood.set_priority(flood.SERVER_PRIORITY)
        stage.start("footingd", "--listen", stage.sensor, "--listen", f"tcp:127.0.0.1:{port}", "--source",
                    f"stream:{stage.devices}")
        if priority:
            flood.set_priority(0)
        stage.wait_for_socket(stage.devices)
        stage.start_user("walk", "--seconds", 600)
        time.sleep(2)  # The ring and the devices get going.
        quiet = one_run(stage, None, "none", 0, b"", priority)
        runs = [quiet]
        for kind, count, first_bytes in kinds:
            for _ in range(TRIES):
                if priority and len(runs) > 1:
                    quiet = one_run(stage, None, "none", 0, b"", priority)
                run = one_run(stage, ("127.0.0.1", port), kind, count, first_bytes, priority)
                if priority:
                    run = with_ratio(run, quiet)
                found = problems_of(run, quiet)
                if not found:
                    break
            runs.append(run)
            failed += [f"{count} x {kind}: {problem}" for problem in found]
        assert stage.processes["footingd"].poll() is None, "footingd ended"
    if options.json:
        print(json.dumps({"runs": runs}))
    else:
        for run in runs:
            print(run)
    for problem in failed:
        print(f"failed: {problem}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
