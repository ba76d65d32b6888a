"""A person's own ranges, from the measurement to the trial: measured live and from a recording, merged into a group's,
put in force, stamped into recordings with all values, run again from them, and used by a study.

Usage: ranges_scenario.py SCENARIOS_FOLDER BINARY_FOLDER
"""
import json
import pathlib
import signal
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, sys.argv[1])
from attended_scenario import Experimenter  # noqa: E402
from harness import Stage, read_ticks  # noqa: E402

PROTOCOL = {
    "version": 1, "name": "own ranges", "participants": ["P01"], "interfaces": ["wrist", "arm"], "seed": 2,
    "practice_s": 0, "rest_s": 0, "straight_trials": 0, "test_tracks": ["3"], "trial_limit_s": 3,
    "survey": {"ratings": [], "questions": [], "exertion": False}, 
    "final_survey": {"ratings": [], "questions": [], "overall": []},
    "devices": {"allow_simulated": True}, "disk_mb": 1, "personal_ranges": True,
}
# Slowest, fastest, Hz; inclination, degrees.
ANN, BEN = (0.7, 3.0, 26), (1.0, 4.0, 40)


def script(stage, name, slow_hz, fast_hz, incline_deg):
    """Who swings slowly and fast, together low and high, and inclines to both sides: 20 s, again and again."""
    path = stage.folder / f"{name}.json"
    path.write_text(json.dumps([
        {"duration_s": 5, "frequency_hz": slow_hz, "phase_deg": 180, "amplitude_mps2": 8},
        {"duration_s": 4, "frequency_hz": fast_hz, "phase_deg": 180, "amplitude_mps2": 14},
        {"duration_s": 3, "frequency_hz": 1.8, "amplitude_mps2": 9},
        {"duration_s": 3, "frequency_hz": 1.8, "amplitude_mps2": 18},
        {"duration_s": 2.5, "roll_deg": -incline_deg}, {"duration_s": 2.5, "roll_deg": incline_deg}]))
    return path


def measure(stage, out, *words, interface="wrist", person="P01"):
    return stage.run("footing-study", "ranges", "--interface", interface, "--participant", person, "--sensor",
                     stage.sensor, "--out", out, "--json", *words)


def close(value, true, share=0.08):
    assert abs(value - true) < share * true, (value, true)


def check_person(table, slow_hz, fast_hz, incline_deg):
    close(table["walk_frequency_min_hz"], slow_hz)
    close(table["run_frequency_max_hz"], fast_hz)
    close(table["turn_above_deg"], 0.625 * incline_deg)
    close(table["jump_amplitude_min_mps2"], 9, 0.2)
    close(table["jump_amplitude_max_mps2"], 18, 0.2)


def check_measurement(stage):
    """Of two people, live; of one also from a recording made meanwhile. Returns both tables' paths."""
    tables = []
    for name, person in (("P01", ANN), ("P02", BEN)):
        stage.start_user(script(stage, name, *person))
        stage.wait_for_devices()
        recording = stage.folder / f"{name}.mcap"
        stage.start("footing-log", "record", "--connect", stage.sensor, "--out", recording, "--seconds", 23)
        out = stage.folder / f"{name}_wrist.json"
        done = measure(stage, out, "--now", person=name)
        assert done.returncode == 0 and "[1/6] Swing in turns" in done.stderr, done
        table = json.loads(out.read_text())
        check_person(table, *person)
        measured = table["measured"]
        assert measured == json.loads(done.stdout)["measured"], done
        assert measured["participants"] == [name] and measured["how"] == "live" and measured["simulated"], measured
        assert measured["by"].startswith("footing-study ") and measured["when"].endswith("Z"), measured
        assert stage.processes.pop("footing-log").wait(60) == 0
        stage.stop("footing-stream")
        done = measure(stage, stage.folder / f"{name}_recorded.json", "--recording", recording, person=name)
        assert done.returncode == 0, done
        check_person(json.loads(done.stdout)["table"], *person)
        tables.append(out)
    return tables


def board_person():
    """Rows of time, load, share on the right foot and COP forward, m, of who does the motions of boards: steps slowly and
    fast, rises on the toes gently and hard, leans while stepping and while standing."""
    phase = 0.0
    # Duration, steps a second, push, lean of the steps, lean of standing.
    for duration_s, step_hz, push, step_lean, lean in ((8, 1.2, 0, 0, 0), (4, 3.6, 0, 0, 0), (5, 0, 0.2, 0, 0),
                                                       (5, 0, 0.5, 0, 0), (4, 2, 0, -0.3, 0), (4, 2, 0, 0.3, 0),
                                                       (3, 0, 0, 0, -0.4), (3, 0, 0, 0, 0.4)):
        for i in range(int(60 * duration_s)):
            phase = (phase + step_hz / 120) % 1
            border = 0.5 * (1 + step_lean)
            away = min(1, min(phase, abs(phase - border), 1 - phase) / 0.05)
            right = (0.5 + (0.49 if phase < border else -0.49) * away) if step_hz else 0.5 + lean / 2
            rise = i / 60 % 1.6 - 1  # Seconds since the heels began to rise; each stands for 1 s before.
            rises = push > 0 and 0 <= rise < 0.3
            yield 75 * (1 + push * (rises and rise < 0.2)), right, 0.09 * rises


def write_boards(folder):
    """What both boards weigh, kg, by their corners; power buttons outwards."""
    for side in ("left", "right"):
        with open(folder / f"{side}.csv", "w", encoding="utf-8") as file:
            file.write("time_s,tl_kg,tr_kg,bl_kg,br_kg\n")
            rows = list(board_person()) * 2  # Live measuring begins a few seconds late.
            for i, (load_kg, right, forward_m) in enumerate(rows):
                part_kg = load_kg * (right if side == "right" else 1 - right) / 2
                front = 0.5 + forward_m / 0.433  # Of the left board towards its plate's left side.
                left_kg, right_kg = (part_kg * front, part_kg * (1 - front))[::1 if side == "left" else -1]
                file.write(f"{i / 60},{left_kg},{right_kg},{left_kg},{right_kg}\n")


def check_boards(stage):
    """The same of two boards, live and from a recording."""
    write_boards(stage.folder)
    recording = stage.folder / "boards.mcap"
    stage.start("footing-log", "record", "--connect", stage.sensor, "--out", recording, "--seconds", 42)
    # It waits for Enter, so that its start does not shift it against the motions; then it looks at the devices for 1.5 s,
    # and the first motion goes on for 3 s longer than it is measured.
    out = stage.folder / "live_boards.json"
    live = Experimenter(stage, "ranges", "--interface", "boards", "--participant", "P01", "--sensor", stage.sensor,
                        "--out", out, name="ranges")
    live.read("Press Enter to begin")
    begin_s = time.monotonic()
    stage.start("footing-stream", "corners", "--left", stage.folder / "left.csv", "--right", stage.folder / "right.csv",
                "--to", stage.devices)
    stage.wait_for(lambda: time.monotonic() > begin_s + 1.4, "the boards' first samples")
    live.type("\n")
    live.read(r"\[3/8\] Stand. Rise quickly")
    assert live.process.wait(60) == 0, live.process.stderr.read()
    assert stage.processes.pop("footing-log").wait(60) == 0
    recorded = measure(stage, stage.folder / "boards.json", "--recording", recording, interface="boards")
    assert recorded.returncode == 0, recorded
    for table in (json.loads(out.read_text()), json.loads(recorded.stdout)["table"]):
        close(table["walk_frequency_min_hz"], 0.6)
        close(table["run_frequency_max_hz"], 1.8)
        close(table["jump_overshoot_min"], 0.2, 0.25)
        close(table["jump_overshoot_max"], 0.5, 0.2)
        close(table["turn_above"], 0.625 * 0.3, 0.15)
        close(table["standing_turn_above"], 0.625 * 0.4, 0.15)
        assert table["measured"]["simulated"], table["measured"]
    stage.stop("footing-stream")


def live_roles(stage):
    devices = stage.run_json("footing-ctl", "--connect", stage.sensor, "devices")["devices"]
    return {one["role"] for one in devices if one["state"] == "live"}


def check_legs(stage):
    """Of a synthetic user who performs the prompted motions with the whole body."""
    # Other serials than those of the hands, which keep their roles.
    stage.start("footing-stream", "user", "--interface", "leg", "--ranges", "--tempo", "0.8", "--seed", 5, "--to",
                stage.devices)
    stage.wait_for(lambda: live_roles(stage) == {"left_leg", "right_leg", "head"}, "the legs and the head")
    out = stage.folder / "P01_leg.json"
    done = measure(stage, out, "--now", interface="leg")
    assert done.returncode == 0, done
    table = json.loads(out.read_text())
    close(table["walk_frequency_min_hz"], 0.8 * 0.75, 0.12)  # The ends of common/virtual/people/person.cc.
    close(table["run_frequency_max_hz"], 0.8 * 3.0, 0.12)
    stage.stop("footing-stream")
    for words, says in ((["--ranges", "--interface", "joystick"], "has no range of its own"),
                        (["--ranges", "--see", stage.simulation], "excludes"),
                        (["--tempo", "0.8"], "--tempo requires --see or --ranges")):
        done = stage.run("footing-stream", "user", *words, "--to", stage.devices)
        assert done.returncode == 2 and says in done.stderr, done


def check_refusals(stage, tables):
    recording = stage.folder / "P01.mcap"
    for code, says, words in (
            (1, "exists", ["--recording", recording]),
            (1, "too small or too short", ["--recording", recording, "--to", 2, "--force"]),
            (3, "left_leg, right_leg, head are missing", ["--recording", recording, "--force", "--interface", "leg"]),
            (3, "left_board, right_board are missing", ["--recording", recording, "--force", "--interface", "boards"]),
            (2, "not of \"voice\"", ["--interface", "voice"]),
            (4, "not an MCAP file", ["--recording", tables[0]])):
        done = stage.run("footing-study", "ranges", "--participant", "P01", "--out", tables[0],
                         *(() if "--interface" in words else ("--interface", "wrist")), *words)
        assert done.returncode in (code, 2) and says in done.stderr, (says, done)
    done = measure(stage, stage.folder / "none.json", "--now")
    assert done.returncode == 3 and "left_hand, right_hand are missing" in done.stderr, done
    assert not (stage.folder / "none.json").exists()


def check_group(stage, tables):
    out = stage.folder / "group.json"
    done = stage.run("footing-study", "ranges", "--group", *tables, "--out", out)
    assert done.returncode == 0, done
    group = json.loads(out.read_text())
    assert group["measured"]["participants"] == ["P01", "P02"], group["measured"]
    close(group["run_frequency_max_hz"], (ANN[1] + BEN[1]) / 2)
    done = stage.run("footing-study", "ranges", "--group", tables[0], tables[0], "--out", out, "--force")
    assert done.returncode == 2 and "P01 comes twice" in done.stderr, done


def config_of(stage):
    for tick in read_ticks(stage.simulation, 30, ("config",)):
        if "config" in tick:
            return json.loads(tick["config"]["json"])
    raise AssertionError("no config")


def check_in_force(stage, table):
    """A simulation that begins with one table and goes over to another: both are in its recording, which runs again."""
    stage.stop("footing-sim")
    recording = stage.folder / "run.mcap"
    stage.start("footing-log", "record", "--from-ring", "--connect", stage.sensor, "--connect", stage.simulation,
                "--out", recording, "--seconds", 9)  # However late it finds the simulation.
    stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation, "--set",
                f"mapping_table={stage.folder}/group.json")
    stage.wait_for_socket(stage.simulation)
    stage.start_user("demo")
    config = config_of(stage)
    assert config["interface"]["table"] == json.loads((stage.folder / "group.json").read_text()), config
    assert config["settings"]["mapping_table"].endswith("group.json") and len(config["sha256"]) == 9, config
    changed = json.loads(table.read_text())
    changed["walk_speed_max_mps"] = 0.9
    table.write_text(json.dumps(changed))
    stage.wait_for(lambda: stage.run("footing-ctl", "interface", "wrist", "--table", table, "--connect",
                                     stage.simulation).returncode == 0, "the interface")
    stage.wait_for(lambda: config_of(stage)["interface"]["number"] == 1, "the change")  # With the next frame.
    shown = config_of(stage)["interface"]
    assert shown["table"] == changed and shown["number"] == 1 and shown["table_by"] == "footing-ctl", shown
    changed["walk_frequency_min_hz"] = 9
    (stage.folder / "wrong.json").write_text(json.dumps(changed))
    done = stage.run("footing-ctl", "interface", "wrist", "--table", stage.folder / "wrong.json", "--connect",
                     stage.simulation)
    assert done.returncode == 1 and "must lie under its partner" in done.stderr, done
    assert stage.processes.pop("footing-log").wait(60) == 0
    info = stage.run_json("footing-log", "info", recording)
    assert info["configs"][0]["interface"]["table"]["walk_speed_max_mps"] == 0.9, info["configs"]
    text = stage.run("footing-log", "info", recording).stdout
    assert "interface wrist, its table: footing-ctl, measured of [\"P01\"]" in text, text
    # footingd ran before the recording began, so its features are another matter.
    replayed = stage.run("footing-eval", "replay", recording)
    assert replayed.stdout, replayed
    result = json.loads(replayed.stdout)
    assert result["frames_equal"] == result["frames_compared"] > 400, result


def check_study(stage):
    """The phase of 20 s and more; what it measured is in force in the trial, also after a crash, and not in the next one's."""
    stage.stop("footing-stream")
    stage.start_user(script(stage, "slow", *ANN))
    (stage.folder / "o.json").write_text(json.dumps(PROTOCOL))
    command = ("run", stage.folder / "o.json", "--participant", "P01", "--sensor", stage.sensor, "--simulation",
               stage.simulation)
    experimenter = Experimenter(stage, *command)
    experimenter.answer("Type yes to confirm", "yes")
    first = json.loads((stage.folder / "o.study/P01/journal.jsonl").read_text().splitlines()[0])["interfaces"][0]
    journal = []
    for interface in (first, "arm" if first == "wrist" else "wrist"):
        experimenter.answer("show all commands", "")
        experimenter.answer(f"own ranges, {22 if interface == 'arm' else 20} s", "")
        if interface == "arm":  # Hands that swing from the wrist are no bent arms.
            experimenter.read("was recognised for")
            experimenter.answer("type b to go on", "b")
        else:
            experimenter.read("Measured: .*alternate_hz")
        experimenter.read("Press Enter to begin:")
        if interface == "wrist":  # A simulation that is started again, and a session too.
            experimenter.process.kill()
            experimenter.process.wait()
            stage.stop("footing-sim", signal.SIGKILL)
            stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation)
            stage.wait_for_socket(stage.simulation)
            experimenter = Experimenter(stage, *command)
            experimenter.read("Press Enter to begin:")
        experimenter.type("\n")
        experimenter.read(f"{interface}.test: .*\n")
        journal.append(config_of(stage)["interface"])
        experimenter.answer("r to repeat", "")
    assert experimenter.process.wait(60) == 0
    check_study_journal(stage, {one["name"]: one for one in journal})


def check_study_journal(stage, in_force):
    events = [json.loads(line) for line in (stage.folder / "o.study/P01/journal.jsonl").read_text().splitlines()]
    ranges = {one["interface"]: one for one in events if one["event"] == "ranges"}
    own = ranges["wrist"]
    assert own["by"] == "measured" and own["table"]["measured"]["participants"] == ["P01"], own
    close(own["table"]["run_frequency_max_hz"], ANN[1])
    assert in_force["wrist"]["table"] == own["table"] and in_force["wrist"]["table_by"] == "footing-study", in_force
    assert ranges["arm"]["by"] == "built-in" and ranges["arm"]["table"] is None, ranges["arm"]
    assert "recognised" in ranges["arm"]["reason"] and in_force["arm"]["table_by"] == "built-in", ranges["arm"]
    trial = [one for one in events if one["event"] == "trial_started" and one["interface"] == "wrist"][-1]
    info = stage.run_json("footing-log", "info", stage.folder / "o.study/P01" / trial["recording"])
    assert info["configs"][-1]["interface"]["table"] == own["table"], info["configs"]
    done = stage.run("footing-study", "export", stage.folder / "o.json", "--out", stage.folder / "bids")
    assert done.returncode == 0, done
    exported = sorted((stage.folder / "bids/sourcedata/config").glob("*wristtest*_config.json"))
    assert exported, list((stage.folder / "bids").rglob("*config*"))
    config = json.loads(exported[-1].read_text())
    assert config["interface"]["table"]["run_frequency_max_hz"] == own["table"]["run_frequency_max_hz"], config
    for said in ("P01", str(stage.folder), "participants", "footing-study,"):
        assert said not in exported[-1].read_text(), (said, config)


def main():
    with Stage(sys.argv[2]) as stage:
        stage.start_servers()
        tables = check_measurement(stage)
        check_refusals(stage, tables)
        check_legs(stage)
        check_boards(stage)
        check_group(stage, tables)
        check_in_force(stage, tables[0])
        check_study(stage)
    return 0


if __name__ == "__main__":
    sys.exit(main())
