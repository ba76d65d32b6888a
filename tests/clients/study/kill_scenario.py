"""kill -9 of footing-sim and footingd at instants from a seed: nothing of the journal is lost, the trial that was cut is
marked and attempted again, and the session finishes.

Usage: kill_scenario.py SCENARIOS_FOLDER BINARY_FOLDER
"""
import json
import random
import signal
import subprocess
import sys

sys.path.insert(0, sys.argv[1])
from harness import Stage  # noqa: E402

PROTOCOL = {
    "version": 1, "name": "kills", "participants": ["P01"], "interfaces": ["arm", "wrist"], "control": "arm", "seed": 5,
    "straight_tasks": ["walk_run"], "straight_trials": 2, "test_tracks": ["1", "2"], "trial_limit_s": 3, "disk_mb": 1,
}
SEED, KILLS, LATEST_KILL_S, MOST_RUNS = 11, 6, 4.0, 8
CUT = "broken_off"


def start_server(stage, program):
    if program == "footingd":
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
    else:
        stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation)
        stage.wait_for_socket(stage.simulation)


def check_prefix(lines, path):
    """What the journal held before is there still, each line whole; returns its lines."""
    now = path.read_text().splitlines() if path.exists() else []
    assert now[:len(lines)] == lines, (lines[-1:], now[-1:])
    assert [json.loads(one)["number"] for one in now] == list(range(1, len(now) + 1))
    return now


def run_with_kill(stage, command, program, after_s):
    """Runs the session, with a kill of that program; returns the exit code."""
    process = stage.start("footing-study", *command, name="study")
    try:
        process.wait(after_s)
    except subprocess.TimeoutExpired:
        stage.stop(program, signal.SIGKILL)
    code = process.wait(60)
    if program not in stage.processes:
        start_server(stage, program)
    return code


def check_events(events):
    trials = [one for one in events if one["event"] == "trial_started"]
    ends = {one["trial"]: one["outcome"] for one in events if one["event"] == "trial_finished"}
    assert len({one["trial"] for one in trials}) == len(trials), trials
    assert set(ends) == {one["trial"] for one in trials}, (trials, ends)  # No attempt is without its end.
    cut = [one for one in trials if ends[one["trial"]] in (CUT, "device_lost")]
    assert any(ends[one["trial"]] == CUT for one in cut), ends
    phases = {one["phase"] for one in trials}
    assert len(phases) == 6, phases
    for phase in phases:  # The last attempt counts, and those before it were cut.
        attempts = [one for one in trials if one["phase"] == phase]
        assert [one["attempt"] for one in attempts] == list(range(1, len(attempts) + 1)), attempts
        assert [one in cut for one in attempts] == [True] * (len(attempts) - 1) + [False], attempts
    for kind, count in (("rating", 12), ("exertion", 2)):
        answers = [(one["interface"], one["item"]) for one in events if one["event"] == kind]
        assert len(answers) == len(set(answers)) == count, answers


def main():
    draw = random.Random(SEED)
    with Stage(sys.argv[2]) as stage:
        (stage.folder / "s.json").write_text(json.dumps(PROTOCOL))
        command = ("run", stage.folder / "s.json", "--participant", "P01", "--sensor", stage.sensor, "--simulation",
                   stage.simulation, "--unattended")
        stage.start_servers()
        stage.start_user("demo")
        path, lines, code = stage.folder / "s.study/P01/journal.jsonl", [], None
        for kill in range(KILLS):
            program = ("footing-sim", "footingd")[kill % 2]
            code = run_with_kill(stage, command, program, draw.uniform(0.2, LATEST_KILL_S))
            lines = check_prefix(lines, path)
            assert code in (1, 3), (code, (stage.folder / "study.log").read_text())
        for _ in range(MOST_RUNS - KILLS):
            if code != 0:
                code = stage.run("footing-study", *command, timeout_s=60).returncode
                lines = check_prefix(lines, path)
        events = [json.loads(one) for one in lines]
        assert code == 0 and events[-1]["event"] == "session_finished", events[-1]
        check_events(events)
    return 0


if __name__ == "__main__":
    sys.exit(main())
