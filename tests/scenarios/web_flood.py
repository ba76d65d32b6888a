"""Many pages of footing-web at once: what is left of the ticks for everybody else.

Usage: web_flood.py BINARY_FOLDER [--json] [--seconds S] [--kind KIND]... [--pages N] [--real-time]

For each kind of crowd (connect: pages that load, begin a session and leave, hang: pages that subscribe as the live page
does and never read, flood: pages that send as fast as they can) two healthy clients measure footingd's ticks, as flood.py
does: one that footing-web has no part in, and a page that reads. Each crowd is paired with the same clients without it
right before; the table has the median pair of five. Fails when one gets fewer than 98 ticks a second, or the 99th
percentile of the client's delay is more than twice that without the crowd. A page waits for its turn among the others in
footing-web: its 99th percentile has to stay below one tick, 10 ms. --real-time: as in flood.py.
"""
import argparse
import json
import multiprocessing
import selectors
import sys
import time

import decode_stream
import flood
import harness
import web_page

# As the live page does.
CHANNELS = ("status", "motion", "features", "boards", "setup", "study")
PAGE_HZ = 60
MOST_PAGE_P99_MS = 10


def page_bytes(number, message):
    """A page's WebSocket message, masked with zeros."""
    payload = decode_stream.bytes_field(number, message)
    assert len(payload) < 126
    return bytes([0x82, 0x80 | len(payload)]) + b"\0\0\0\0" + payload


def open_page(port, kind):
    page = web_page.WebSocket(port, "/session/0")
    assert page.status == 101, page.head
    page.hello()
    if kind != "flood":
        page.subscribe(*CHANNELS, max_hz=PAGE_HZ)
    page.stream.setblocking(False)
    return page.stream


def come_and_go(port, pages, end):
    """Each page asks for two files, begins a session, and leaves when the next ones have come."""
    there = []
    while not end.is_set():
        try:
            web_page.ask(port, "/")
            web_page.ask(port, "/live.js")
            there.append(open_page(port, "connect"))
        except (OSError, AssertionError):
            time.sleep(0.01)  # There is no place for it now.
        while len(there) > pages // 4:
            there.pop(0).close()
    for stream in there:
        stream.close()


def crowd(port, kind, pages, ready, end):
    if kind == "connect":
        ready.set()
        return come_and_go(port, pages, end)
    selector = selectors.DefaultSelector()
    ping = page_bytes(6, decode_stream.number_field(1, 7) + decode_stream.number_field(2, 1))
    block = ping * (flood.BLOCK_BYTES // len(ping))
    events = 0 if kind == "hang" else selectors.EVENT_READ | selectors.EVENT_WRITE

    def add():
        stream = open_page(port, kind)
        if events:
            selector.register(stream, events, [0])
        return stream

    hanging = [add() for _ in range(pages)]
    ready.set()
    while not end.is_set():
        if not events:
            end.wait(0.1)
            continue
        for key, happened in selector.select(0.1):
            try:
                if happened & selectors.EVENT_READ and not key.fileobj.recv(1 << 18):
                    raise ConnectionError
                if happened & selectors.EVENT_WRITE:
                    at = key.data[0]
                    key.data[0] = (at + key.fileobj.send(block[at:])) % len(block)
            except BlockingIOError:
                pass
            except OSError:
                selector.unregister(key.fileobj)
                key.fileobj.close()
                hanging.append(add())
        time.sleep(0.001)  # The machine's cores are the server's as well.


def page_ticks(port, seconds):
    page = web_page.WebSocket(port, "/session/0")
    page.hello()
    page.subscribe("status")
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        yield page.until("tick")["tick"]
    page.close()


def measure_page(port, seconds, results, priority):
    flood.measure_ticks(page_ticks(port, seconds), results, priority)


def one_run(addresses, kind, pages, seconds, priority):
    """Times of a client of footingd and of a page, beside a crowd."""
    ready, end = multiprocessing.Event(), multiprocessing.Event()
    results = {"client": multiprocessing.Queue(), "page": multiprocessing.Queue()}
    processes = [multiprocessing.Process(target=flood.measure, args=(addresses["unix"], seconds, results["client"], priority)),
                 multiprocessing.Process(target=measure_page, args=(addresses["port"], seconds, results["page"], priority))]
    if pages:
        processes.append(multiprocessing.Process(target=crowd, args=(addresses["port"], kind, pages, ready, end)))
        processes[-1].start()
        assert ready.wait(60), "the crowd did not come"
    for process in processes[:2]:
        process.start()
    try:
        return {name: queue.get(timeout=seconds + 30) for name, queue in results.items()}
    finally:
        end.set()
        for process in processes:
            process.join(5)
            if process.is_alive():
                process.kill()


def measure_pairs(addresses, kind, pages, seconds, priority):
    """The median pair of each client."""
    pairs = {"client": [], "page": []}
    for _ in range(flood.TRIES):
        quiet = one_run(addresses, kind, 0, seconds, priority)
        busy = one_run(addresses, kind, pages, seconds, priority)
        for name, found in pairs.items():
            ratio = busy[name]["p99_ms"] / quiet[name]["p99_ms"]
            found.append({"kind": kind, "pages": pages, "of": name, **busy[name], "quiet_hz": quiet[name]["hz"],
                          "quiet_p99_ms": quiet[name]["p99_ms"], "p99_ratio": ratio})
    medians = [sorted(found, key=lambda pair: pair["p99_ratio"])[flood.TRIES // 2] for found in pairs.values()]
    return [one | {"good": is_good(one)} for one in medians]


def is_good(one):
    prompt = one["p99_ratio"] <= flood.MOST_P99_RATIO if one["of"] == "client" else one["p99_ms"] < MOST_PAGE_P99_MS
    return one["hz"] >= flood.LEAST_HZ and prompt


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binaries")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--seconds", type=float, default=3)
    parser.add_argument("--kind", action="append", default=[])
    parser.add_argument("--pages", type=int, default=200)
    parser.add_argument("--real-time", action="store_true")
    arguments = parser.parse_args()
    with harness.Stage(arguments.binaries) as stage:
        if arguments.real_time:
            flood.set_priority(flood.SERVER_PRIORITY)
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.devices)
        port = web_page.free_port()
        stage.start("footing-web", "--listen", f"tcp:127.0.0.1:{port}", "--connect", stage.sensor, "--devices", stage.devices)
        if arguments.real_time:
            flood.set_priority(0)
        stage.start_user("walk", "--seconds", 600)
        stage.wait_for_devices()
        priority = flood.HEALTHY_PRIORITY if arguments.real_time else 0
        runs = [run for kind in arguments.kind or ["connect", "hang", "flood"] for run in measure_pairs(
            {"unix": stage.sensor, "port": port}, kind, arguments.pages, arguments.seconds, priority)]
        assert all(stage.processes[name].poll() is None for name in ("footingd", "footing-web")), "a server ended"
        log_bytes = (stage.folder / "footing-web.log").stat().st_size
    if arguments.json:
        print(json.dumps({"runs": runs, "log_bytes": log_bytes}))
    for run in [] if arguments.json else runs:
        print(f"{run['pages']:4} x {run['kind']:8} {run['of']:7}: {run['hz']:6.1f} Hz, largest hole {run['hole_ms']:6.1f} ms, "
              f"delay p50 {run['p50_ms']:5.2f} p99 {run['p99_ms']:6.2f} ms{flood.ratio_text(run)}"
              f"{'' if run['good'] else '   <- over the bar'}", flush=True)
    return 0 if all(run["good"] for run in runs) and log_bytes <= flood.MOST_LOG_BYTES else 1


if __name__ == "__main__":
    sys.exit(main())
