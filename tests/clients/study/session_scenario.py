"""footing-study with a simulated user of the wrist interface: a session that is killed and goes on, what it records, and
what is made of its journals.

Usage: session_scenario.py SCENARIOS_FOLDER BINARY_FOLDER
"""
import json
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, sys.argv[1])
from harness import Stage  # noqa: E402

PROTOCOL = {
    "version": 1, "name": "scenario", "participants": ["P01", "P02"], "interfaces": ["arm", "wrist"],
    "control": "arm", "seed": 5, "practice_s": 300, "rest_s": 60, "trial_limit_s": 4,
    "straight_tasks": ["walk_run", "walk_stop"], "straight_trials": 1, "test_tracks": ["1", "2"],
    "disk_mb": 1,
}


def journal(stage, participant):
    path = stage.folder / "s.study" / participant / "journal.jsonl"
    whole = path.read_text().split("\n")[:-1] if path.exists() else []  # The last line may be half written.
    return [json.loads(line) for line in whole]


def words(stage, participant, *more):
    return ("run", stage.folder / "s.json", "--participant", participant, "--sensor", stage.sensor, "--simulation",
            stage.simulation, *more)


def refused(stage, code, says, *command):
    done = stage.run("footing-study", *command)
    assert done.returncode == code and says in done.stderr, (command, done)


def check_refusals(stage):
    protocol = stage.folder / "s.json"
    for change, says in (({"practise_s": 1}, "unknown key"), ({"test_tracks": ["9"]}, "unknown track"),
                         ({"participants": ["P01", "P01"]}, "twice"), ({"straight_tasks": ["fly"]}, "does not have")):
        wrong = stage.folder / "wrong.json"
        wrong.write_text(json.dumps({**PROTOCOL, **change}))
        done = stage.run("footing-study", "check", wrong)
        assert done.returncode == 4 and says in done.stderr and "give the path" not in done.stderr, done
    refused(stage, 2, "PROTOCOL is missing", "check")
    schema = stage.run_json("footing-study", "check", "--schema")
    assert schema["required"][-1] == "seed" and "final_survey" in schema["properties"], schema
    plan = stage.run_json("footing-study", "check", protocol)
    assert [one["participant"] for one in plan["sessions"]] == PROTOCOL["participants"], plan
    short = stage.folder / "short.json"
    short.write_text(json.dumps({**PROTOCOL, "practice_s": 20, "rest_s": 5}))
    assert "of a session: 0.8 min." in stage.run("footing-study", "check", short).stdout  # 45 s.
    short.write_text(json.dumps({**PROTOCOL, "test_tracks": ["1", "endless"]}))
    remarks = [one for one in stage.run_json("footing-study", "check", short)["remarks"] if "finish line" in one]
    assert len(remarks) == 1 and remarks[0].startswith("test track endless has no"), remarks
    refused(stage, 2, "not in the protocol", *words(stage, "P09", "--unattended"))
    refused(stage, 3, "no footingd", *words(stage, "P01", "--unattended"))
    refused(stage, 1, "has no journal yet", "analyze", protocol)  # Nothing of it was begun.


def check_kill_and_resume(stage):
    """Killed in its first trial, a session goes on with a second attempt at it; meanwhile nobody else may run it."""
    running = stage.start("footing-study", *words(stage, "P01", "--unattended", "--seed", 3), name="study")
    stage.wait_for(lambda: any(one["event"] == "trial_started" for one in journal(stage, "P01")), "a trial", 60)
    running.send_signal(signal.SIGSTOP)  # However long the next command takes, the trial is not over before the kill.
    refused(stage, 1, f"process {running.pid}, participant P01", *words(stage, "P02", "--unattended"))
    stage.stop("study", signal.SIGKILL)
    path = stage.folder / "s.study/P01/journal.jsonl"
    with open(path, "a") as file:
        file.write('{"number": 99, "wa')
    before = len(path.read_text().splitlines()) - 1
    done = stage.run("footing-study", *words(stage, "P01", "--unattended", "--seed", 3), timeout_s=120)
    assert done.returncode == 0 and "was torn (18 bytes)" in done.stderr and "stopped in" in done.stderr, done
    events = journal(stage, "P01")
    assert [one["number"] for one in events] == list(range(1, len(events) + 1))
    assert events[before]["event"] == "session_resumed" and events[before]["torn_bytes"] == 18, events[before]
    trials = [one for one in events if one["event"] == "trial_started"]
    assert [one["attempt"] for one in trials] == [1, 2, 1, 1, 1], trials
    assert trials[0]["phase"] == trials[1]["phase"] and trials[1]["trial"] != trials[0]["trial"]
    finished = [one for one in events if one["event"] == "trial_finished"]
    assert len(finished) == 4 and all(one["outcome"] in ("timed_out", "finished") for one in finished), finished
    # Six ratings and the exertion for each interface, and six again at the end, within their scales and marked.
    ratings = [one for one in events if one["event"] in ("rating", "exertion")]
    assert len(ratings) == 2 * 7 + 2 * 6 and all(one["synthetic"] for one in ratings), ratings
    assert sorted({one["interface"] for one in ratings if one["at_end"]}) == ["arm", "wrist"], ratings
    assert all(1 <= one["value"] <= 5 for one in ratings if one["event"] == "rating"), ratings
    assert events[-1]["event"] == "session_finished", events[-1]
    active_s = sum(one["active_s"] for one in events if one["event"] == "phase_finished")
    passed_s = (events[-1]["wall_ns"] - events[0]["wall_ns"]) * 1e-9
    assert 4 < active_s < passed_s, (active_s, passed_s)  # In four trials of 4 s and more.
    refused(stage, 2, "has finished", *words(stage, "P01", "--unattended"))
    return trials, finished


def check_recordings(stage, trials, finished):
    for trial in trials[1:]:
        path = stage.folder / "s.study/P01" / trial["recording"]
        info = stage.run_json("footing-log", "info", path)
        text = json.dumps(info)
        assert "/footing-sim/characters" in text and "/footingd/raw" in text, text[:2000]
        assert "/footing-sim/skeletons" in text and "protocol.json" in text, text[:2000]
        assert trial["trial"] in path.read_bytes().decode("latin1"), trial
        assert path.stat().st_mode & 0o777 == 0o600
    cut = stage.folder / "s.study/P01" / trials[0]["recording"]
    assert stage.run("footing-log", "info", cut).returncode == 4  # Of the killed attempt: kept, repairable.
    # None was stopped before its time. How long the end takes is the machine's affair.
    assert all(one["wall_s"] >= PROTOCOL["trial_limit_s"] for one in finished if one["outcome"] == "timed_out"), finished


def check_recording_in_the_way(stage):
    """A recording that a crash has left without an event ends one attempt, not the session for good."""
    folder = stage.folder / "r.study/P01"
    folder.mkdir(parents=True)
    command = [*words(stage, "P01", "--unattended"), "--folder", folder.parent]
    plan = stage.run_json("footing-study", "check", stage.folder / "s.json")
    first = next(one["phase"] for one in plan["sessions"][0]["phases"] if "seed" in one)
    (folder / f"{first}.1.mcap").write_bytes(b"")
    refused(stage, 2, "exists", *command)
    lines = [json.loads(line) for line in (folder / "journal.jsonl").read_text().splitlines()]
    assert lines[-1]["outcome"] == "broken_off" and "exists" in lines[-1]["reason"], lines[-1]
    done = stage.run("footing-study", *command, timeout_s=120)
    assert done.returncode == 0 and f"{first}, attempt 1" in done.stderr, done


def trials_of(stage, participant):
    return [one for one in journal(stage, participant) if one["event"] == "trial_started"]


def check_interrupted(stage):
    """Ctrl-C in a trial: its recording is finished and the attempt has an outcome, which does not count."""
    running = stage.start("footing-study", *words(stage, "P02", "--unattended"), name="study")
    stage.wait_for(lambda: trials_of(stage, "P02"), "a trial", 60)
    running.send_signal(signal.SIGINT)
    assert running.wait(30) == 1
    trial, end = trials_of(stage, "P02")[0], journal(stage, "P02")[-1]
    assert end["event"] == "trial_finished" and end["outcome"] == "interrupted", end
    assert end["trial"] == trial["trial"] and "resumes the session" in end["reason"], end
    path = stage.folder / "s.study/P02" / trial["recording"]
    assert stage.run("footing-log", "info", path).returncode == 0, path
    assert '"interrupted"' in stage.run("footing-log", "info", path, "--json").stdout, path


def check_lost_device(stage):
    """Without its device a trial ends as lost, and the next run attempts it again."""
    running = stage.start("footing-study", *words(stage, "P02", "--unattended"), name="study")
    stage.wait_for(lambda: len(trials_of(stage, "P02")) == 2, "a second attempt", 60)
    resumed = next(one for one in journal(stage, "P02") if one["event"] == "session_resumed")
    assert resumed["interrupted_trial"] == trials_of(stage, "P02")[0]["trial"], resumed
    stage.stop("footing-stream")
    assert running.wait(60) == 3
    lost = journal(stage, "P02")[-1]
    assert lost["event"] == "trial_finished" and lost["outcome"] == "device_lost" and "hand" in lost["device"], lost
    stage.start_user("demo")
    done = stage.run("footing-study", *words(stage, "P02", "--unattended"), timeout_s=120)
    assert done.returncode == 0, done
    attempts = [one["attempt"] for one in trials_of(stage, "P02")]
    assert attempts == [1, 2, 3, 1, 1, 1], attempts


def check_withdrawal(stage):
    refused(stage, 2, "has failure 999", "run", stage.folder / "s.json", "--participant", "P02", "--undo-failure", "999")
    refused(stage, 0, "", "run", stage.folder / "s.json", "--participant", "P02", "--withdraw", "--reason", "asked")
    assert journal(stage, "P02")[-1]["event"] == "withdrawn"


def check_attended(stage):
    """The experimenter's side through a pipe: no consent, no session; with it, up to the device gate."""
    protocol = stage.folder / "a.json"
    protocol.write_text(json.dumps(PROTOCOL))
    command = [stage.binaries / "footing-study", "run", protocol, "--participant", "P01", "--sensor", stage.sensor,
               "--simulation", stage.simulation]
    done = subprocess.run(command, input="no\n", capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 1 and "without consent" in done.stderr, done
    done = subprocess.run(command, input="yes\n", capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 1 and "is simulated" in done.stderr and "Press Enter to check again" in done.stderr, done


def check_report(stage):
    protocol = stage.folder / "s.json"
    analysis = stage.run_json("footing-study", "analyze", protocol)
    assert analysis["synthetic"] and analysis["participants"] == 2 and analysis["withdrawn"] == 1, analysis
    found = {one["id"]: one for one in analysis["measures"]}
    expected = {"rating fun", "final_rating fun", "rating exertion", "test_failures_curve", "straight_oscillation_deg"}
    assert expected <= set(found), found
    assert [one["interface"] for one in found["rating fun"]["groups"]] == ["arm", "wrist"]
    wrote = stage.run_json("footing-study", "report", protocol)
    page, rows = (pathlib.Path(wrote[key]).read_text() for key in ("page", "csv"))
    assert "Synthetic:" in page and "http" not in page and page.count("<svg") > 8, page[:500]
    points = [row.split(",") for row in rows.splitlines()[1:] if ",point," in row]
    assert all(one[2] == "P01" for one in points), rows
    # Counts that are all zero are said in a sentence; every other measure has a figure.
    figures = {one[0] for one in points if "_failures_" not in one[0]}
    assert len([one for one in points if one[0] in figures]) <= page.count("<circle") <= len(points), rows
    assert "latency_without_contact_ms" in found and analysis["latency"][0]["stage"] == "decode", analysis["latency"]
    assert found["active_min"]["groups"][0]["mean"] > 0, found["active_min"]
    tested = stage.run_json("footing-study", "analyze", protocol, "--ties", "joint", "--method", "asymptotic",
                            "--alternative", "greater", "--seed", 5)
    assert tested["tests"] == {"alternative": "greater", "ties": "joint", "method": "asymptotic", "seed": 5}, tested["tests"]
    refused(stage, 2, "--method", "analyze", protocol, "--method", "guessed")
    refused(stage, 2, "exists", "report", protocol)
    other = stage.folder / "other.json"
    other.write_text(json.dumps({**PROTOCOL, "control": "wrist"}))
    for command in (("analyze",), ("report",), ("export", "--out", stage.folder / "o.bids")):
        refused(stage, 4, "the protocol differs", *command, other, "--folder", stage.folder / "s.study")
    assert stage.run("footing-study", "report", protocol, "--force").returncode == 0


def check_export(stage):
    """An anonymised data set: who has withdrawn is not in it, and neither is a code, a serial or a date."""
    protocol, out = stage.folder / "s.json", stage.folder / "s.bids"
    wrote = stage.run_json("footing-study", "export", protocol, "--out", out)
    assert wrote["participants"] == 1 and wrote["trials"] == 4 and not wrote["remarks"], wrote
    refused(stage, 2, "exists", "export", protocol, "--out", out)
    files = {str(path.relative_to(out)): path.read_text() for path in out.rglob("*") if path.is_file()}
    assert not any("P01" in text or "P02" in text or "synthetic answer" in text for text in files.values())
    assert not any("P01" in name for name in files), files.keys()
    longest_s = max(one["wall_s"] for one in journal(stage, "P01") if one["event"] == "trial_finished")
    motion = {name: text for name, text in files.items() if name.endswith("_motion.tsv")}
    assert len(motion) == 4 * 3, sorted(motion)  # Two remotes and the character.
    for name, text in motion.items():
        channels = [line.split("\t") for line in files[name.replace("_motion.tsv", "_channels.tsv")].splitlines()[1:]]
        rows = [line.split("\t") for line in text.splitlines()]
        assert all(len(row) == len(channels) for row in rows), name
        about = json.loads(files[name.replace(".tsv", ".json")])
        assert about["MotionChannelCount"] == len(channels) and 40 < about["SamplingFrequency"] < 110, (name, about)
        times_s = [float(row[0]) for row in rows]
        assert times_s == sorted(times_s) and 0 <= times_s[0] < 0.1 and 3 < times_s[-1] < longest_s + 2, (name, times_s[:2])
        assert f"{name.split('/', 1)[1]}\t1900-01-01T00:" in files["sub-01/sub-01_scans.tsv"], name
    events = [text for name, text in files.items() if name.endswith("_events.tsv")]
    assert len(events) == 4 and all("trial_ready" in text for text in events), events
    ends = [re.findall(r"trial_\w+", text)[-1] for text in events]
    assert all(end in ("trial_finished", "trial_stopped") for end in ends), ends
    configs = [json.loads(text) for name, text in files.items() if name.endswith("_config.json")]
    assert [(one["features"], one["settings"]["gaits"]) for one in configs] == [("paper", "best")] * 4, configs
    trials = [line.split("\t") for line in files["sourcedata/trials.tsv"].splitlines()]
    assert len(trials) == 1 + 5 and set(trials[0][1:]) == set(json.loads(files["sourcedata/trials.json"])), trials
    key = (stage.folder / "s.study/participant_key.csv")
    assert key.read_text() == "number,code\n1,P01\n" and key.stat().st_mode & 0o777 == 0o600
    check_faulty_recordings(stage)


def check_faulty_recordings(stage):
    """A recording of no trial, and one that is not there: named, and the rest is exported."""
    folder = stage.folder / "s.study/P01"
    marked = folder / "wrist.test.1.mcap"
    plain = stage.folder / "plain.mcap"
    done = stage.run("footing-log", "record", "--connect", stage.simulation, "--out", plain, "--seconds", 1)
    assert done.returncode == 0, done
    plain.replace(marked)
    (folder / "arm.test.1.mcap").unlink()
    wrote = stage.run_json("footing-study", "export", stage.folder / "s.json", "--out", stage.folder / "t.bids")
    assert wrote["trials"] == 2 and len(wrote["remarks"]) == 2, wrote
    assert any("no trial marks" in one for one in wrote["remarks"]), wrote


def main():
    with Stage(sys.argv[2]) as stage:
        (stage.folder / "s.json").write_text(json.dumps(PROTOCOL))
        check_refusals(stage)
        stage.start_servers("--features", "paper")
        stage.start_user("demo")
        trials, finished = check_kill_and_resume(stage)
        check_recordings(stage, trials, finished)
        check_recording_in_the_way(stage)
        check_attended(stage)
        check_interrupted(stage)
        check_lost_device(stage)
        check_withdrawal(stage)
        check_report(stage)
        check_export(stage)
    return 0


if __name__ == "__main__":
    sys.exit(main())
