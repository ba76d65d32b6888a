"""Faulty links in front of footing-study, footing-game, footing-relay, footing-skeleton and footing-camera: each client is back
within 2 s of the end of a fault, misses nothing that its server still has, and reports what it missed.

Usage: client_faults.py BINARY_FOLDER study|game|relay|trackers

faults.py does the same to footing-log, footing-ctl, footing-sim, footing-view and devices.
"""
import json
import sys
import time

import brokers
from fault_proxy import FaultProxy
from harness import Stage
from ports import free_port
from relay import Viewer, missing, returned_after

MOST_RETURN_S = 2
GIVE_UP_S = 30
TRIES = 3  # Other work on the machine may delay one return.
FALL, RESPONSE, TRIAL = 1, 4, 16  # Events.
RUNNING, STOPPED = 2, 4  # Phases of a trial.
GAITS = {1: "step", 2: "walk", 3: "run", 4: "jump"}
PROTOCOL = {
    "version": 1, "name": "faults", "participants": ["P01"], "interfaces": ["wrist"], "seed": 3, "practice_s": 0,
    "straight_trials": 0, "test_tracks": ["3"], "trial_limit_s": 20, "disk_mb": 1,
}


# Gait changes every second: each is a response that a fault could swallow.
HURRIED = [{"duration_s": 1, "frequency_hz": hz, "phase_deg": degrees, "amplitude_mps2": amplitude}
           for hz, degrees, amplitude in ((1.3, 180, 7), (3, 180, 13), (2, 0, 14))]


class Proxies:
    """One link or several, on all of which each fault lies at once."""

    def __init__(self, stage, **targets):
        self.addresses = {name: f"unix:{stage.folder}/proxy-{name}.sock" for name in targets}
        self.proxies = [FaultProxy(self.addresses[name], target, seed).start()
                        for seed, (name, target) in enumerate(targets.items())]

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        for proxy in self.proxies:
            proxy.stop()

    def __getitem__(self, name):
        return self.addresses[name]

    def fault(self, name, seconds):
        """Seconds from its end until each link had a tick that was made after it."""
        for proxy in self.proxies:
            proxy.set(name)
        time.sleep(seconds)
        for proxy in self.proxies:
            proxy.clear()
        took = [proxy.seconds_to_fresh_tick(GIVE_UP_S) for proxy in self.proxies]
        print(f"{name:8}: back after {took} s", flush=True)
        assert None not in took, f"{name}: not back within {GIVE_UP_S} s"
        return max(took)

    def check(self, name, seconds):
        for attempt in range(TRIES):
            took = self.fault(name, seconds)
            if took <= MOST_RETURN_S:
                return
        assert took <= MOST_RETURN_S, f"{name}: {took} s"


def journal(stage):
    path = stage.folder / "s.study/P01/journal.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def events_of(viewer):
    return [event for tick in viewer.ticks() for event in tick.get("events", {}).get("events", [])]


def study(stage):
    """A trial goes on over breaks of both links: every failure and response is in the journal."""
    (stage.folder / "s.json").write_text(json.dumps(PROTOCOL))
    stage.start_servers()
    (stage.folder / "hurried.json").write_text(json.dumps([{"duration_s": 1}, *HURRIED * 20]))
    stage.start_user(stage.folder / "hurried.json")
    stage.wait_for_devices()
    with Proxies(stage, sensor=stage.sensor, simulation=stage.simulation) as links:
        direct = Viewer(stage.simulation)
        process = stage.start("footing-study", "run", stage.folder / "s.json", "--participant", "P01", "--sensor",
                              links["sensor"], "--simulation", links["simulation"], "--unattended")
        # After a demonstration, which is a trial of footing-sim's, too.
        stage.wait_for(lambda: any(one["kind"] == TRIAL and one["trial"]["trial"].endswith("test.1") for one in events_of(direct)), "the trial to begin", 60)
        for fault, seconds in (("stall", 1), ("reset", 0.5), ("dribble", 0.5), ("reset", 0.2)):
            links.check(fault, seconds)
        assert process.wait(120) == 0, "the study ended"
        check_journal(journal(stage), events_of(direct))
        direct.stopping = True


def check_journal(events, published):
    """What footing-sim published to a client beside the faulty link."""
    of = lambda kind: [one for one in events if one["event"] == kind]
    started, finished = of("trial_started"), of("trial_finished")
    assert [one["outcome"] for one in finished] == ["timed_out"] and len(started) == 1, (started, finished)
    assert finished[0]["link_breaks"] >= 2, finished
    trial = started[0]["trial"]
    failures = [one["failure"]["number"] for one in published if one["kind"] == FALL and
                one.get("failure", {}).get("trial") == trial]
    assert [one["failure"] for one in of("failure")] == failures, (of("failure"), failures)
    phases = [(i, one["trial"]["phase"]) for i, one in enumerate(published) if one["kind"] == TRIAL and
              one["trial"]["trial"] == trial]
    begun, over = (next(i for i, phase in phases if phase == wanted) for wanted in (RUNNING, STOPPED))
    changes = lambda some: [GAITS[one["response"]["to"]] for one in some if one["kind"] == RESPONSE]
    noted = [one["to"] for one in of("response")]
    print(f"{len(failures)} failures; gaits in the journal {noted}, published in the trial {changes(published[begun:over])}")
    # A response on the way to the start line counts, too, and one between the trial's end and that of its recording may.
    within, all_of_it = changes(published[begun:over]), changes(published[phases[0][0]:])
    assert within and "".join(within) in "".join(noted) and "".join(noted) in "".join(all_of_it), all_of_it


def game(stage):
    """A game is led on over a stall; a round in which its connection broke is played again. Its scores are the recording's."""
    stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
    stage.wait_for_socket(stage.sensor)
    stage.wait_for_socket(stage.devices)
    stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation, "--track", "build")
    stage.wait_for_socket(stage.simulation)
    stage.start("footing-stream", "runner", "--watch", stage.simulation, "--to", stage.devices, name="runner")
    stage.start("footing-stream", "builder", "--to", stage.devices, "--seed", 1, name="builder")
    recording = stage.folder / "game.mcap"
    stage.start("footing-log", "record", "--from-ring", "--connect", stage.simulation, "--out", recording)
    with Proxies(stage, sensor=stage.sensor, simulation=stage.simulation) as links:
        process = stage.start("footing-game", "--sensor", links["sensor"], "--simulation", links["simulation"], "--rounds", 1,
                              "--round-s", 12, "--countdown-s", 1, "--json")
        log = stage.folder / "footing-game.log"
        stage.wait_for(lambda: "round" in log.read_text(), "a round", 30)
        links.check("stall", 1)
        links.check("dribble", 0.5)
        links.check("reset", 0.3)
        assert process.wait(120) == 0, "the game ended"
    assert stage.stop("footing-log") == 0
    published = json.loads(log.read_text().splitlines()[-1])
    assert published["phase"] == "over" and len(published["rounds"]) == 1, published
    counted = stage.run_json("footing-game", "--recording", recording)  # Fails when it has other scores.
    assert counted["rounds"] == published["rounds"], (counted, published)
    assert counted["rounds"][0]["distance_m"] > 2, counted


def unreported(viewer):
    """Sequences that neither a tick nor a Gap has, of a session that gets every tick."""
    last, missing = None, []
    for _, message in list(viewer.messages):
        if "gap" in message:
            first, to = message["gap"]["from_sequence"], message["gap"]["to_sequence"]
        elif "tick" in message and not message["tick"].get("snapshot"):
            first = to = message["tick"]["sequence"]
        else:
            continue
        if last is not None and first > last + 1:
            missing.append((last + 1, first - 1))
        last = to
    return missing


def check_edge(edge, links, fault, seconds):
    """The link has ticks again, and so has the edge's viewer."""
    for _ in range(TRIES):
        for proxy in links:
            proxy.set(fault)
        time.sleep(seconds)
        since_s = time.monotonic()
        for proxy in links:
            proxy.clear()
        while (took_s := returned_after(edge, since_s)) is None and time.monotonic() < since_s + GIVE_UP_S:
            time.sleep(0.01)
        print(f"{fault:8}: at the edge after {took_s} s", flush=True)
        assert took_s is not None and edge.ended is None, (fault, edge.ended)
        if took_s <= MOST_RETURN_S:
            break
    assert took_s <= MOST_RETURN_S, (fault, took_s)
    assert not unreported(edge), unreported(edge)


def relay(stage):
    """footingd's ticks of a fault come to the edge after all; those that NATS could not carry are a Gap there."""
    brokers.skip_without("nats-server")
    stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
    stage.wait_for_socket(stage.devices)
    stage.start_user("walk", "--seconds", 600)
    ports = [free_port() for _ in range(2)]
    with brokers.nats(stage.folder) as nats, Proxies(stage, source=stage.sensor) as source:
        broker = f"tcp:127.0.0.1:{nats.port}"
        to_nats = [FaultProxy(f"tcp:127.0.0.1:{port}", broker, port).start() for port in ports]
        listen = f"unix:{stage.folder}/edge.sock"
        stage.start("footing-relay", "publish", "--connect", source["source"], "--nats", f"tcp:127.0.0.1:{ports[0]}", "--site", "a",
                    name="publisher")
        stage.start("footing-relay", "serve", "--nats", f"tcp:127.0.0.1:{ports[1]}", "--site", "a", "--listen", listen,
                    "--rate-hz", 0, name="edge")
        stage.wait_for_socket(listen)
        edge = Viewer(listen)
        stage.wait_for(edge.ticks, "ticks at the edge")
        try:
            for fault, seconds in (("stall", 1), ("reset", 0.3), ("dribble", 0.5)):
                check_edge(edge, source.proxies, fault, seconds)
            before = missing(edge)
            stage.check_missing(stage.sensor, before)  # It has all other ticks of the last 30 s.
            check_edge(edge, to_nats[:1], "reset", 0.5)
            check_edge(edge, to_nats[1:], "reset", 0.5)
            assert missing(edge) > before, "what was published meanwhile is lost, and said"
            check_edge(edge, to_nats, "stall", 1)
        finally:
            edge.stopping = True
            for proxy in to_nats:
                proxy.stop()


def newest_hands_ns(viewer, tracker):
    """Of when the newest sample is that footingd got from a tracker; 0: from none."""
    hands = [sample for tick in viewer.ticks()[-300:] for sample in tick.get("hands", {}).get("samples", [])]
    return max((sample["sampled_ns"] for sample in hands if sample["tracker"] == tracker), default=0)


def trackers(stage):
    """Hands of both programs that find them are published again after each fault, and come as they are, one by one."""
    names = ("skeleton", "camera")
    stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}", "--set", "state_directory=none")
    stage.wait_for_socket(stage.devices)
    frames, port = stage.folder / "frames", free_port()
    stage.run_json("footing-eval", "spheres", "--distance-m", "1.5", "--frames", 2, "--out", frames, "--seed", 3)
    with Proxies(stage, **dict.fromkeys(names, stage.devices)) as links:
        stage.start("footing-skeleton", "--listen", f"127.0.0.1:{port}", "--to", links["skeleton"])
        stage.start("footing-skeleton", "send", "--to", f"127.0.0.1:{port}", "--dialect", "footing", "--seconds", 300, name="send")
        stage.start("footing-camera", "--camera", frames / "camera.json", "--frames", frames, "--repeat",
                    "--simulated", "--to", links["camera"])
        viewer = Viewer(stage.sensor)
        stage.wait_for(lambda: all(newest_hands_ns(viewer, name) for name in names), "hands of both")

        def returned_s(fault, seconds):
            for proxy in links.proxies:
                proxy.set(fault)
            time.sleep(seconds)
            since_s = time.monotonic()
            for proxy in links.proxies:
                proxy.clear()
            took_s = {}
            while len(took_s) < len(names) and time.monotonic() < since_s + GIVE_UP_S:
                for name in names:
                    if newest_hands_ns(viewer, name) > since_s * 1e9:
                        took_s.setdefault(name, round(time.monotonic() - since_s, 2))
                time.sleep(0.01)
            print(f"{fault:10}: hands again after {took_s} s", flush=True)
            assert len(took_s) == len(names), f"{fault}: not back within {GIVE_UP_S} s"
            return max(took_s.values())

        for fault, seconds in (("stall", 3.5), ("reset", 0.5), ("split", 1), ("dribble", 1), ("half_close", 0.5), ("delay", 1)):
            took_s = next((took_s for _ in range(TRIES) if (took_s := returned_s(fault, seconds)) <= MOST_RETURN_S), None)
            assert took_s is not None, f"{fault}: late {TRIES} times"
        viewer.stopping = True
    assert "connection closed" not in (stage.folder / "footingd.log").read_text(), "nothing that makes no sense has arrived"


def main():
    with Stage(sys.argv[1]) as stage:
        {"study": study, "game": game, "relay": relay, "trackers": trackers}[sys.argv[2]](stage)
    return 0


if __name__ == "__main__":
    sys.exit(main())
