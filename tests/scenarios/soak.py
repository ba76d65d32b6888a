"""Hours in small: eight simulated devices and 50 viewers, a fifth of them behind links that fail in turn. Memory and
descriptors of both servers stay what they were, nobody is lost, and no sanitizer reports anything.

Usage: soak.py BINARY_FOLDER [--seconds S] [--viewers N] [--seed N] [--no-slope] [--json]

Without --seconds for FOOTING_SOAK_S, or for 1800 s; at least 120. The first half of the time is left out: the
ring of 30 s fills, and under each fault in turn every buffer takes its size. --no-slope is for
builds with sanitizers, which keep freed memory for a while.
"""
import argparse
import json
import math
import os
import random
import selectors
import struct
import sys
import threading
import time

import decode_stream
from fault_proxy import FaultProxy
from harness import Stage

FAULTS = ("delay", "stall", "split", "dribble", "reset", "half_close")
FAULT_S, PAUSE_S = 4, 4
LOOK_EVERY_S = 1
LEAST_SECONDS = 120
BLOCKS = 12  # Of which each gives one mean: neighbouring samples say the same.
MOST_GROWTH_BYTES = 1 << 20
SILENT_S = 15  # A viewer without a tick for so long, its link being whole, is lost.
REPORTS = ("ERROR: AddressSanitizer", "WARNING: ThreadSanitizer", "ERROR: LeakSanitizer", "runtime error:")
REPORT_LINES = 60
# Of Student's distribution with BLOCKS - 2 degrees of freedom, 97.5 %.
STUDENT = 2.228


class Viewers(threading.Thread):
    """Reads every stream and answers its pings; who is cut off comes back after a second."""

    def __init__(self, addresses):
        super().__init__(daemon=True)
        self.addresses = addresses
        self.ending = False
        self.heard = [time.monotonic()] * len(addresses)
        self.bytes = self.connections = 0
        self._selector = selectors.DefaultSelector()
        self._due = {i: 0.0 for i in range(len(addresses))}

    def _dial(self, index):
        stream = decode_stream.Stream(self.addresses[index], 5)
        stream.send(1, decode_stream.number_field(1, 1) + decode_stream.number_field(3, 1))
        wish = decode_stream.number_field(3, 2) + decode_stream.number_field(4, 256)
        stream.send(4, b"\x11" + struct.pack("<d", 100.0 if index % 5 == 0 else 30.0) + wish)
        stream.socket.setblocking(False)
        self._selector.register(stream.socket, selectors.EVENT_READ, [index, b"", stream])
        self.connections += 1

    def _lose(self, key):
        self._selector.unregister(key.fileobj)
        key.fileobj.close()
        self._due[key.data[0]] = time.monotonic() + 1

    def _take(self, key):
        index, pending, stream = key.data
        data = key.fileobj.recv(1 << 18)
        if not data:
            raise ConnectionError
        self.bytes += len(data)
        self.heard[index] = time.monotonic()
        pending += data
        while len(pending) >= 4:
            size = 4 + struct.unpack_from("<I", pending)[0]
            if len(pending) < size:
                break
            if pending[4] == 0x32:  # A Ping: one byte of length, then its fields as they are.
                now = time.monotonic_ns()
                body = pending[6:size] + decode_stream.number_field(3, now) + decode_stream.number_field(4, now)
                answer = decode_stream.bytes_field(7, body)
                key.fileobj.send(struct.pack("<I", len(answer)) + answer)
            pending = pending[size:]
        key.data[1] = pending

    def run(self):
        while not self.ending:
            now = time.monotonic()
            for index, due in list(self._due.items()):
                if due > now:
                    continue
                try:
                    self._dial(index)
                    del self._due[index]
                except OSError:
                    self._due[index] = now + 1
            for key, _ in self._selector.select(0.2):
                try:
                    self._take(key)
                except BlockingIOError:
                    pass
                except OSError:
                    self._lose(key)


def usage_of(process):
    """Resident bytes and open descriptors."""
    status = open(f"/proc/{process.pid}/statm").read().split()
    return int(status[1]) * os.sysconf("SC_PAGESIZE"), len(os.listdir(f"/proc/{process.pid}/fd"))


def slope(samples):
    """Of (seconds, bytes): bytes a second, the half width of its 95 % interval, and the means of blocks in MB."""
    size = max(1, len(samples) // BLOCKS)
    blocks = [samples[i:i + size] for i in range(0, size * BLOCKS, size)]
    points = [tuple(sum(column) / len(column) for column in zip(*block)) for block in blocks if block]
    n = len(points)
    mean_t, mean_v = (sum(column) / n for column in zip(*points))
    spread = sum((t - mean_t) ** 2 for t, _ in points)
    rise = sum((t - mean_t) * (v - mean_v) for t, v in points) / spread
    rest = sum((v - mean_v - rise * (t - mean_t)) ** 2 for t, v in points)
    return rise, STUDENT * math.sqrt(rest / (n - 2) / spread), [round(v / 1e6, 2) for _, v in points]


def soak(stage, options):
    stage.start_servers()
    for seed in range(1, 5):
        stage.start("footing-stream", "user", "--script", "walk", "--interface", "wrist", "--nunchuk", "--to",
                    stage.devices, "--seed", seed, "--seconds", options.seconds + 600, name=f"user{seed}")
    targets = [stage.sensor, stage.simulation]
    proxies = [FaultProxy(f"unix:{stage.folder}/proxy{i}.sock", targets[i % 2], options.seed + i).start() for i in range(4)]
    addresses = [f"unix:{stage.folder}/proxy{i % 4}.sock" if i % 5 == 4 else targets[i % 2]
                 for i in range(options.viewers)]
    viewers = Viewers(addresses)
    viewers.start()
    draw = random.Random(options.seed)
    servers = {name: stage.processes[name] for name in ("footingd", "footing-sim")}
    warm_s = options.seconds / 2
    samples = {name: [] for name in servers}
    descriptors = {name: [] for name in servers}
    begin = time.monotonic()
    until, fault = begin + PAUSE_S, None
    while (now := time.monotonic()) < begin + options.seconds:
        for name, process in servers.items():
            assert process.poll() is None, f"{name} has ended"
            resident, opened = usage_of(process)
            if now - begin >= warm_s:
                samples[name].append((now - begin, resident))
                if fault is None and now > until - 1:
                    descriptors[name].append(opened)
        if now > until:
            fault = draw.choice(FAULTS) if fault is None else None
            for proxy in proxies:
                proxy.set(fault) if fault else proxy.clear()
            until = now + (FAULT_S if fault else PAUSE_S + 2)
        time.sleep(LOOK_EVERY_S)
    for proxy in proxies:
        proxy.clear()
    stage.wait_for(lambda: all(time.monotonic() - heard < 2 for heard in viewers.heard), "every viewer's ticks", SILENT_S)
    devices = stage.run_json("footing-ctl", "--connect", stage.sensor, "devices")
    viewers.ending = True
    viewers.join(5)
    for proxy in proxies:
        proxy.stop()
    return samples, descriptors, viewers, devices


def first_report(log):
    """Of a sanitizer, with the lines that follow: the log is gone once the programs have ended."""
    lines = log.read_text(errors="replace").splitlines()
    at = next((i for i, line in enumerate(lines) if any(report in line for report in REPORTS)), None)
    return [] if at is None else ["\n".join([f"{log.name}: {lines[at]}", *lines[at + 1:at + REPORT_LINES]])]


def judge(stage, options, samples, descriptors, viewers, devices):
    results = {"seconds": options.seconds, "viewers": options.viewers, "connections": viewers.connections,
               "megabytes": viewers.bytes / 1e6, "devices": len(devices["devices"])}
    problems = [] if len(devices["devices"]) == 8 else [f"{len(devices['devices'])} devices, not 8"]
    for name, of in samples.items():
        rise, half, blocks_mb = slope(of)
        span_s = of[-1][0] - of[0][0]
        results[name] = {"resident_mb": blocks_mb, "slope_bytes_per_s": rise, "slope_half_width": half,
                         "descriptors": [min(descriptors[name]), max(descriptors[name])]}
        if not options.no_slope and rise - half > 0 and rise * span_s > MOST_GROWTH_BYTES:
            problems.append(f"{name} grows by {rise:.0f} +- {half:.0f} bytes a second")
        # Links that have just come back, or are still to go, are a few.
        if max(descriptors[name]) - min(descriptors[name]) > options.viewers / 5:
            problems.append(f"{name} has from {min(descriptors[name])} to {max(descriptors[name])} descriptors")
    for name in list(stage.processes):
        code = stage.stop(name, timeout_s=30)
        if name in samples and code != 0:
            problems.append(f"{name} ended with {code}")
    problems += [report for log in sorted(stage.folder.glob("*.log")) for report in first_report(log)]
    return results, problems


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("binaries")
    parser.add_argument("--seconds", type=float, default=float(os.environ.get("FOOTING_SOAK_S", 1800)))
    parser.add_argument("--viewers", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--no-slope", action="store_true")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    if options.seconds < LEAST_SECONDS:
        parser.error(f"--seconds: at least {LEAST_SECONDS}")
    with Stage(options.binaries) as stage:
        results, problems = judge(stage, options, *soak(stage, options))
    print(json.dumps(results, indent=None if options.json else 2))
    for problem in problems:
        print(f"failed: {problem}")
    sys.exit(1 if problems else 0)


main()
