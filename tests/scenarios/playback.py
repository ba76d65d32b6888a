"""Two trials on the track straight with simulated devices, recorded and then played: marks and states of the
playback are those that were published live, one trial plays alone, two side by side, a cut file as far as it goes.

Usage: playback.py BINARY_FOLDER
"""
import sys

from harness import Stage
from trial import CORRECTION, FALL, FINISHED, RUN, RUNNING, TASK, TRIAL, WALK, Operator

FIRST, SECOND = "p07-1", "p07-2"


def run_trials(operator):
    """One with a failure, another one that is withdrawn, and its task; a faster one without."""
    operator.drive(RUN, 3)
    assert operator.start(FIRST, "straight", "run_walk")["ok"]
    for failures in (1, 2):
        operator.until(lambda t: t["phase"] == RUNNING and t["on_track"] and
                       t["distance_m"] > 6 * failures and abs(t["lateral_offset_m"]) < 0.3, 20)
        operator.drive(RUN, 3, 0.05)
        operator.until(lambda t: t["failed_attempts"] == failures, 20)
        operator.drive(RUN, 3)
    assert operator.correct(2)["ok"]
    operator.until(lambda t: t["distance_m"] > 30 and t["withdrawn_failures"] == 1, 30)
    operator.drive(WALK, 1.5)
    operator.until(lambda t: t["task_phase"] == 3, 15)
    operator.drive(RUN, 4)
    operator.until(lambda t: t["phase"] == FINISHED, 30)
    operator.until(lambda t: t["distance_m"] > 63, 10)
    assert operator.start(SECOND, "straight", "run_walk")["ok"]
    operator.until(lambda t: t["trial"] == SECOND and t["phase"] == RUNNING, 20)
    operator.until(lambda t: t["time_s"] > 4, 20)


def published(operator):
    """What the operator saw, in seconds from the first start line."""
    def instant(event):
        return 1e-9 * event["host_ns"]
    trials = {(e["trial"]["trial"], e["trial"]["phase"]): e for e in operator.of_kind(TRIAL)}
    zero_s = instant(trials[FIRST, RUNNING])
    return {"zero_s": zero_s,
            "falls": [(instant(e) - zero_s, e["failure"]) for e in operator.of_kind(FALL)],
            "task_s": instant(operator.of_kind(TASK)[0]) - zero_s,
            "finish_s": instant(trials[FIRST, FINISHED]) - zero_s,
            "finish_time_s": trials[FIRST, FINISHED]["trial"]["time_s"],
            "second_start_s": instant(trials[SECOND, RUNNING]) - zero_s,
            "withdrawn": [e["failure"]["number"] for e in operator.of_kind(CORRECTION)]}


def record(stage):
    recording = stage.folder / "study.mcap"
    stage.start_servers()
    stage.start_user("demo")
    stage.start("footing-log", "record", "--from-ring", "--connect", stage.sensor, "--connect", stage.simulation, "--out", recording)
    operator = Operator(stage.simulation)
    run_trials(operator)
    assert stage.stop("footing-log") == 0
    for name in ("footing-stream", "footing-sim", "footingd"):
        stage.stop(name)
    return recording, published(operator)


def near(a, b):
    return abs(a - b) < 1e-6


def check_trial(stage, recording, live):
    """The first trial alone, at its end: every mark where it was published."""
    shown = stage.run_json("footing-view", "--recording", recording, "--trial", FIRST, "--text", "--at",
                           live["finish_s"] + 0.5)
    playback = shown["playback"]
    trial, = playback["trials"]
    assert playback["trial"] == trial["trial"] == FIRST and trial["track"] == "straight", playback
    assert near(trial["start_s"], 0) and near(trial["end_s"], live["finish_s"]), (trial, live)
    assert trial["phase"] == "finished" and trial["time_s"] == live["finish_time_s"], (trial, live)
    assert [task["task"] for task in playback["tasks"]] == ["run_walk"], playback
    assert near(playback["tasks"][0]["at_s"], live["task_s"]), (playback, live)
    assert len(playback["failures"]) == len(live["falls"]) == 2, (playback, live)
    for mark, (at_s, failure) in zip(playback["failures"], live["falls"]):
        assert near(mark["at_s"], at_s) and mark["cause"] == "straightness", (mark, at_s)
        assert mark["trial"] == FIRST and mark["trial_time_s"] == failure["trial_time_s"], mark
        assert mark["withdrawn"] == (failure["number"] in live["withdrawn"]), (mark, live)
    assert trial["failures"]["straightness"] == 1, trial
    text = stage.run("footing-view", "--recording", recording, "--trial", FIRST, "--text", "--at", 0).stdout
    assert f"trial {FIRST} crosses the start line" in text and "failure: straightness" in text, text
    # The state behind a seek is the one of the last frame before.
    assert shown["trial"]["phase"] == "finished" and shown["simulated"], shown
    assert shown["trial"]["time_s"] == live["finish_time_s"], (shown["trial"], live)
    assert shown["trial"]["failures"]["straightness"] == 1 and shown["trial"]["withdrawn_failures"] == 1, shown


def check_seek(stage, recording, live):
    """Playing to a time and seeking to it show the same trial."""
    at_s = live["falls"][1][0] + 0.2
    sought = stage.run_json("footing-view", "--recording", recording, "--trial", FIRST, "--text", "--at", at_s)
    played = stage.run_json("footing-view", "--recording", recording, "--trial", FIRST, "--text", "--speed", 8,
                            "--seconds", 120)
    trial = sought["trial"]
    assert trial["failures"]["straightness"] + trial["withdrawn_failures"] == 2, trial
    assert played["playback"]["position_s"] == played["playback"]["end_s"] and played["playback"]["ended"], played
    assert played["frames_received"] > 1000 and played["failures"]["straightness"] == 2, played
    assert played["trial"]["trial"] == FIRST and played["trial"]["phase"] == "finished", played["trial"]


def check_beside(stage, recording, live):
    """Both trials from their start lines: the second one is over first."""
    shown = stage.run_json("footing-view", "--recording", recording, "--trial", FIRST, "--beside",
                           f"{recording}:{SECOND}", "--text", "--at", 3)
    assert shown["trial"]["trial"] == FIRST and shown["beside"]["trial"]["trial"] == SECOND, shown
    for side in (shown, shown["beside"]):
        # Frames are a hundredth of a second apart, but for those that a server leaves out on a machine that stalls.
        assert abs(side["trial"]["time_s"] - 3) < 0.2, side["trial"]
    end_s = live["finish_s"]
    later = stage.run_json("footing-view", "--recording", recording, "--trial", FIRST, "--beside",
                           f"{recording}:{SECOND}", "--text", "--at", end_s)
    assert later["beside"]["playback"]["ended"] and not later["playback"]["ended"], later
    picture = stage.folder / "beside.png"
    done = stage.run("footing-view", "--recording", recording, "--trial", FIRST, "--beside", f"{recording}:{SECOND}",
                     "--screenshot", picture, "--at", end_s, "--width", 640, "--height", 400)
    assert done.returncode == 0 and picture.read_bytes()[:4] == b"\x89PNG", done


def check_refusals(stage, recording):
    done = stage.run("footing-view", "--recording", recording, "--trial", "p08", "--text")
    assert done.returncode == 2 and FIRST in done.stderr and SECOND in done.stderr, done
    for words in (("--trial", FIRST), ("--recording", recording, "--speed", 9),
                  ("--recording", recording, "--beside", recording, "--align", "noon"),
                  ("--recording", recording, "--text", "--at", 1e5)):
        done = stage.run("footing-view", *words)
        assert done.returncode == 2, done
    cut = stage.folder / "cut.mcap"
    cut.write_bytes(recording.read_bytes()[:recording.stat().st_size // 2])
    shown = stage.run_json("footing-view", "--recording", cut, "--text", "--at", 1)
    assert "footing-log repair" in shown["playback"]["limits"], shown
    assert shown["playback"]["end_s"] > 3 and shown["frames_received"] > 0, shown
    nothing = stage.folder / "nothing.mcap"
    nothing.write_bytes(b"nothing")
    done = stage.run("footing-view", "--recording", nothing, "--text")
    assert done.returncode == 4 and "not an MCAP file" in done.stderr, done


def main(binaries):
    with Stage(binaries) as stage:
        recording, live = record(stage)
        check_trial(stage, recording, live)
        check_seek(stage, recording, live)
        check_beside(stage, recording, live)
        check_refusals(stage, recording)


if __name__ == "__main__":
    main(sys.argv[1])
