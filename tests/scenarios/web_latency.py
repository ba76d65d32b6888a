"""From the motion of a phone on footing-web's page, in headless Chromium, to the character.

Usage: web_latency.py BINARY_FOLDER [--json] [--motions N] [--post]

A test moves the phone's sensor to a new value, N times at random moments. Of each motion it measures the time to the
report that footingd receives with it, and to the first frame of the character that footing-sim publishes after the
features of that report became its input. All clocks are this host's CLOCK_MONOTONIC; the network of a real phone comes on
top. --post: the page sends requests, as where a browser opens no WebSocket. Fails over a median of 60 ms, but with
--post.
"""
import argparse
import bisect
import json
import random
import sys
import threading
import time

import browser
import harness
import web_page

MOST_MEDIAN_MS = 60


def read(address, channel, found, end):
    for tick in harness.read_ticks(address, 600, channel):
        if not tick.get("snapshot"):
            found.append(tick)
        if end.is_set():
            return


def move(phone, motions, seed=1):
    """When each value was set."""
    draw, moved = random.Random(seed), {}
    for i in range(motions):
        value = round((i + 1) * 0.1 * (-1) ** i, 1)
        moved[value] = time.monotonic_ns()
        phone.feel(value, 0)
        time.sleep(draw.uniform(0.08, 0.14))
    time.sleep(0.5)
    return moved


def delays(moved, sensor, simulation):
    """The delays of each motion, ms: to footingd, to the character."""
    seen = {}
    for tick in sensor:
        for sample in tick.get("motion", {}).get("samples", []):
            # Ahead is y of the phone and of the sensor frame.
            seen.setdefault(round(sample["specific_force_mps2"]["y"], 1), (sample["received_ns"], tick["sequence"]))
    steps = [(one["sensor_sequence"], one["step"]) for tick in simulation for one in tick.get("inputs", {}).get("inputs", [])]
    frames = [(tick["characters"]["step"], tick["host_ns"]) for tick in simulation if "characters" in tick]
    for value, moved_ns in moved.items():
        if value not in seen:
            continue
        received_ns, sequence = seen[value]
        step = next((step for of, step in steps if of >= sequence), None)
        frame = bisect.bisect_left(frames, (step, 0)) if step is not None else len(frames)
        if frame < len(frames):
            yield (received_ns - moved_ns) * 1e-6, (frames[frame][1] - moved_ns) * 1e-6


def quantile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def measure(stage, motions, post):
    stage.start_servers()
    _, printed = web_page.serve(stage)
    with browser.Browser() as chromium:
        phone = web_page.Phone(chromium, printed["phone"].replace("/phone", "/phone?simulated" + ("&post" if post else "")), 2)
        stage.wait_for_devices(1)
        phone.page.wait_for("window.footing().signKnown")
        found, end = ([], []), threading.Event()
        threads = [threading.Thread(target=read, args=(address, channels, ticks, end)) for address, channels, ticks in
                   ((stage.sensor, ("motion",), found[0]), (stage.simulation, ("inputs", "characters"), found[1]))]
        for thread in threads:
            thread.start()
        stage.wait_for(lambda: found[0] and found[1], "ticks")
        moved = move(phone, motions)
        end.set()
        for thread in threads:
            thread.join()
    return list(delays(moved, *found))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binaries")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--motions", type=int, default=200)
    parser.add_argument("--post", action="store_true")
    arguments = parser.parse_args()
    if not browser.is_there():
        web_page.skip("chromium is missing; scripts/dependencies-web.txt lists what this needs")
    with harness.Stage(arguments.binaries) as stage:
        pairs = measure(stage, arguments.motions, arguments.post)
    assert len(pairs) >= 0.8 * arguments.motions, f"only {len(pairs)} of {arguments.motions} motions arrived"
    result = {"motions": len(pairs), **{f"{name}_{quantity}_ms": round(quantile([pair[i] for pair in pairs], share), 1)
                                        for i, name in enumerate(("to_footingd", "to_character"))
                                        for quantity, share in (("p50", 0.5), ("p95", 0.95))}}
    print(json.dumps(result) if arguments.json else "\n".join(f"{name}: {value}" for name, value in result.items()))
    return 0 if arguments.post or result["to_character_p50_ms"] <= MOST_MEDIAN_MS else 1


if __name__ == "__main__":
    sys.exit(main())
