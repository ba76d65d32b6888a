"""Records both servers live: ended by SIGINT the file is complete; killed it lacks a second at most.

Usage: record_scenario.py SCENARIOS_FOLDER BINARY_FOLDER
"""
import signal
import sys
import time

sys.path.insert(0, sys.argv[1])
from harness import Stage  # noqa: E402


def check_missing(stage, info):
    """Nothing but what the servers left out themselves; a client of one of them has no more missing than both left out."""
    left_out = sum(stage.run_json("footing-ctl", "--connect", address, "status")["stats"]["ticks"]["left_out"]
                   for address in (stage.sensor, stage.simulation))
    assert info["missing_ticks"] <= left_out, (info, left_out)


def main():
    with Stage(sys.argv[2]) as stage:
        stage.start_servers()
        stage.start("footing-stream", "user", "--script", "demo", "--interface", "wrist", "--to",
                    stage.devices)
        connect = ("--connect", stage.sensor, "--connect", stage.simulation)
        whole, killed, repaired = (stage.folder / f"{n}.mcap" for n in ("whole", "killed", "fixed"))
        started_s = {}
        for name, path in (("ended", whole), ("killed", killed)):
            stage.start("footing-log", "record", "--from-ring", *connect, "--out", path, name=name)
            started_s[name] = time.monotonic()
        stage.wait_for(lambda: killed.exists() and killed.stat().st_size > 200_000,
                       "a recording of some size", 30)
        killed_after_s = time.monotonic() - started_s["killed"]
        stage.stop("killed", signal.SIGKILL)
        assert stage.stop("ended", signal.SIGINT) == 0

        info = stage.run_json("footing-log", "info", whole)
        topics = {topic["topic"]: topic["messages"] for topic in info["topics"]}
        for topic in ("/footingd/status", "/footingd/motion", "/footingd/features",
                      "/footingd/raw", "/footing-sim/characters", "/footing-sim/skeletons",
                      "/footing-sim/track"):
            assert topics.get(topic, 0) > 0, (topic, topics)
        assert info["complete"] and info["simulated"] is True, info
        check_missing(stage, info)

        cut = stage.run("footing-log", "info", killed, "--json")
        assert cut.returncode == 4 and "repair" in cut.stderr, cut
        stage.run_json("footing-log", "repair", killed, "--out", repaired)
        kept_s = stage.run_json("footing-log", "info", repaired)["duration_s"]
        # Begun long after the servers, with and without what they hold of before.
        for ring, least_s, most_s in (((), 0.5, 2.5), (("--from-ring",), 2.6, 40)):
            late = stage.folder / f"late{len(ring)}.mcap"
            info = stage.run_json("footing-log", "record", *connect, "--out", late, "--seconds", 2, *ring)
            assert least_s <= info["duration_s"] <= most_s, (ring, info)
            check_missing(stage, info)

        # Start-up of the process and connecting are within the first 0.5 s.
        assert kept_s > killed_after_s - 1.5, (kept_s, killed_after_s)
        print(f"killed after {killed_after_s:.2f} s, kept {kept_s:.2f} s")


if __name__ == "__main__":
    main()
