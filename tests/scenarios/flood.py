"""Sessions that send as fast as they can: what is left of the ticks for everybody else.

Usage: flood.py BINARY_FOLDER [--json] [--seconds S] [--kind KIND]... [--sessions N]... [--real-time]

For each kind of message (ping, subscribe, replay: subscribe from the ring's start, command: one that
is stored on disk, attach: devices that come and go on the device socket) and number of flooding
sessions a healthy session in a process of its own measures the rate of ticks, the largest hole, and
the delay of each tick from its stamp to its arrival. Fails when one gets fewer than 98 ticks a second,
or a 99th percentile of more than twice that without a flood (or more than 20 ms, where that is
longer), five times in a row: other work on the machine may disturb a run, a starved server never
recovers. Where the session without a flood gets fewer ticks, too, it is measured again, and the
bar is 98 % of its rate. Fails when the floods write more than 100 kB to the log.

--real-time measures what the server does to its healthy sessions, and not how a machine with few cores
shares them among its programs: the server and, above it, the healthy session run at real-time priority
(which needs the right to set it), the flood does not; each flood is paired with a run without one right
before it, and the bar is twice that run's 99th percentile. The table has the median pair of the tries.
"""
import argparse
import json
import multiprocessing
import os
import selectors
import struct
import sys
import time

import decode_stream
import harness
from ports import free_port

BLOCK_BYTES = 64 << 10
TICK_RATE_HZ = 100
LEAST_HZ = 98
MOST_P99_RATIO = 2
# Below this a ratio of tails says more about the scheduler of a machine with few cores.
P99_FLOOR_MS = 20
TRIES = 5
MOST_LOG_BYTES = 100_000
VIEW, CONTROL = 1, 3
SERVER_PRIORITY, HEALTHY_PRIORITY = 11, 12
# More are held off before they can send.
MOST_SESSIONS = {"command": 20, "attach": 20}


def set_priority(real_time):
    """Of this process, and of those that it starts from now on; 0: an ordinary one."""
    policy = os.SCHED_FIFO if real_time else os.SCHED_OTHER
    os.sched_setscheduler(0, policy, os.sched_param(real_time))


def frame(number, message):
    envelope = decode_stream.bytes_field(number, message)
    return struct.pack("<I", len(envelope)) + envelope


def flood_frames(kind, epoch):
    """A block of frames of one kind; commands have an id each, or they would be answered from memory."""
    field = decode_stream.number_field
    if kind == "ping":
        one = [frame(6, field(1, 7) + field(2, 1))]
    elif kind == "subscribe":
        one = [frame(4, field(3, 2))]
    elif kind == "replay":
        one = [frame(4, field(3, 2) + field(5, 1) + field(6, epoch))]
    elif kind == "attach":
        attach = field(1, 1) + field(2, 5) + field(3, 0x057e) + field(4, 0x0306)
        attach += decode_stream.bytes_field(5, b"Nintendo RVL-CNT-01")
        attach += decode_stream.bytes_field(6, b"comes-and-goes")
        one = [frame(1, attach), frame(5, field(1, 1))]
    else:
        tare = decode_stream.bytes_field(1, b"nobody") + field(3, 1)  # Forget its tare.
        one = [frame(8, field(1, i + 1) + decode_stream.bytes_field(14, tare)) for i in range(2000)]
    block = b"".join(one)
    return block * max(1, BLOCK_BYTES // len(block))


def connect(address, role):
    """A session that has been welcomed, and the epoch of its server."""
    stream = decode_stream.Stream(address, 10)
    stream.send(1, decode_stream.number_field(1, 1) + decode_stream.number_field(3, role) +
                decode_stream.bytes_field(5, b"flood"))
    while True:
        message = stream.receive()
        assert "refused" not in message, message
        if "welcome" in message:
            return stream.socket, message["welcome"]["epoch"]


def flood(addresses, kind, sessions, ready, end):
    """Sends and reads on all sockets until the end; one that the server ends is dialled again."""
    selector = selectors.DefaultSelector()
    address, role = (addresses["unix"], CONTROL) if kind == "command" else (addresses["tcp"], VIEW)

    def add():
        if kind == "attach":
            connection, epoch = decode_stream.Stream(addresses["devices"], 10).socket, 0
        else:
            connection, epoch = connect(address, role)
        connection.setblocking(False)
        data = flood_frames(kind, epoch)
        selector.register(connection, selectors.EVENT_READ | selectors.EVENT_WRITE, [data, 0])

    for _ in range(sessions):
        add()
    ready.set()
    while not end.is_set():
        for key, events in selector.select(0.1):
            try:
                if events & selectors.EVENT_READ and not key.fileobj.recv(1 << 18):
                    raise ConnectionError
                if events & selectors.EVENT_WRITE:
                    data, at = key.data
                    key.data[1] = (at + key.fileobj.send(data[at:at + BLOCK_BYTES])) % len(data)
            except BlockingIOError:
                pass
            except OSError:
                selector.unregister(key.fileobj)
                key.fileobj.close()
                add()
        time.sleep(0.001)  # The machine's cores are the server's as well.


def measure(address, seconds, results, priority=0):
    measure_ticks(harness.read_ticks(address, seconds, ["status"]), results, priority)


def measure_ticks(ticks, results, priority=0):
    """Ticks a second, the largest hole, and quantiles of the delay, of one healthy session."""
    if priority:
        set_priority(priority)
    delays_ms, arrivals = [], []
    for tick in ticks:
        if tick.get("snapshot"):
            continue
        now_ns = time.monotonic_ns()
        arrivals.append(now_ns)
        delays_ms.append((now_ns - tick["host_ns"]) * 1e-6)
    holes_ms = [(b - a) * 1e-6 for a, b in zip(arrivals, arrivals[1:])]
    delays_ms.sort()
    results.put({
        "hz": (len(arrivals) - 1) / (arrivals[-1] - arrivals[0]) * 1e9,
        "hole_ms": max(holes_ms),
        "p50_ms": delays_ms[len(delays_ms) // 2],
        "p99_ms": delays_ms[int(len(delays_ms) * 0.99)],
    })


def one_run(addresses, kind, sessions, seconds, priority=0):
    ready, end, results = multiprocessing.Event(), multiprocessing.Event(), multiprocessing.Queue()
    flooder = multiprocessing.Process(target=flood, args=(addresses, kind, sessions, ready, end))
    if sessions:
        flooder.start()
        assert ready.wait(30), "the flood did not begin"
    measuring = multiprocessing.Process(target=measure, args=(addresses["unix"], seconds, results, priority))
    measuring.start()
    try:
        result = results.get(timeout=seconds + 30)
    finally:
        end.set()
        for process in (measuring, flooder) if sessions else (measuring,):
            process.join(5)
            if process.is_alive():
                process.kill()
    return {"kind": kind, "sessions": sessions, **result}


def is_good(run, quiet):
    bar_ms = max(MOST_P99_RATIO * quiet["p99_ms"], P99_FLOOR_MS)
    return run["hz"] >= LEAST_HZ * min(1, quiet["hz"] / TICK_RATE_HZ) and run["p99_ms"] <= bar_ms


def one_pair(addresses, kind, sessions, seconds):
    """A flood, and the delays of the same healthy session right before it."""
    quiet = one_run(addresses, "none", 0, seconds, HEALTHY_PRIORITY)
    run = one_run(addresses, kind, sessions, seconds, HEALTHY_PRIORITY)
    return run | {"quiet_p50_ms": quiet["p50_ms"], "quiet_p99_ms": quiet["p99_ms"],
                  "p99_ratio": run["p99_ms"] / quiet["p99_ms"]}


def measure_pairs(addresses, cases, seconds):
    runs = []
    for kind, sessions in cases:
        pairs = [one_pair(addresses, kind, sessions, seconds) for _ in range(TRIES)]
        median = sorted(pairs, key=lambda pair: pair["p99_ratio"])[TRIES // 2]
        runs.append(median | {"good": median["hz"] >= LEAST_HZ and median["p99_ratio"] <= MOST_P99_RATIO})
    return runs


def measure_all(addresses, cases, seconds):
    quiet = one_run(addresses, "none", 0, seconds)
    runs = [quiet | {"good": True}]
    for kind, sessions in cases:
        for _ in range(TRIES):
            run = one_run(addresses, kind, sessions, seconds)
            run["good"] = is_good(run, quiet)
            if run["good"]:
                break
            quiet = one_run(addresses, "none", 0, seconds)  # The machine may be busier than it was.
        runs.append(run)
    return runs


def ratio_text(run):
    return f", {run['p99_ratio']:.2f} x {run['quiet_p99_ms']:.2f} ms" if "p99_ratio" in run else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binaries")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--seconds", type=float, default=4)
    parser.add_argument("--kind", action="append", default=[])
    parser.add_argument("--sessions", action="append", type=int, default=[])
    parser.add_argument("--real-time", action="store_true")
    arguments = parser.parse_args()
    kinds = arguments.kind or ["ping", "subscribe", "replay", "command", "attach"]
    cases = [(kind, sessions) for kind in kinds for sessions in
             sorted({min(count, MOST_SESSIONS.get(kind, 1000)) for count in arguments.sessions or [1, 20, 200]})]
    with harness.Stage(arguments.binaries) as stage:
        addresses = {"unix": stage.sensor, "tcp": f"tcp:127.0.0.1:{free_port()}",
                     "devices": stage.devices}
        if arguments.real_time:
            set_priority(SERVER_PRIORITY)
        stage.start("footingd", "--listen", stage.sensor, "--listen", addresses["tcp"],
                    "--source", f"stream:{stage.devices}", "--set", "max_sessions_per_host=224")
        if arguments.real_time:
            set_priority(0)
        stage.wait_for_socket(stage.devices)
        stage.start_user("walk", "--seconds", 600)
        stage.wait_for_devices()
        time.sleep(1)  # The ring gets going.
        measured = measure_pairs if arguments.real_time else measure_all
        runs = measured(addresses, cases, arguments.seconds)
        assert stage.processes["footingd"].poll() is None, "footingd ended"
        log_bytes = (stage.folder / "footingd.log").stat().st_size
    if arguments.json:
        print(json.dumps({"runs": runs, "log_bytes": log_bytes}))
    for run in [] if arguments.json else runs:
        print(f"{run['sessions']:4} x {run['kind']:9}: {run['hz']:6.1f} Hz, largest hole "
              f"{run['hole_ms']:6.1f} ms, delay p50 {run['p50_ms']:5.2f} p99 {run['p99_ms']:6.2f} ms"
              f"{ratio_text(run)}{'' if run['good'] else '   <- over the bar'}", flush=True)
    print(f"{log_bytes} bytes of log", file=sys.stderr)
    return 0 if all(run["good"] for run in runs) and log_bytes <= MOST_LOG_BYTES else 1


if __name__ == "__main__":
    sys.exit(main())
