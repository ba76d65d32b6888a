"""footing-ctl sway with simulated boards: a whole protocol, a subject who steps off, a board that is lost, and the
same figures from the recording.

Usage: sway_scenario.py SCENARIOS_FOLDER BINARY_FOLDER
"""
import csv
import json
import math
import signal
import subprocess
import sys

sys.path.insert(0, sys.argv[1])
from harness import PATIENCE_S, Stage  # noqa: E402

MASS_KG = 70
SECONDS = 2
# Sway of the subject, mm and Hz, to the side and to the front.
ML, AP = ((6, 0.7), (2, 1.3)), ((8, 0.6), (3, 1.1))
OFF_S = (6.0, 7.5)  # The subject is off the board once, for longer than the pause between two trials.


def position(tones, t):
    return sum(size * math.sin(2 * math.pi * hz * t) for size, hz in tones)


def corners(path, seconds, share=1.0, off=(0, 0)):
    """Loads of a swaying person on one board, of whose weight it bears a share."""
    rows = ["time_s,tl_kg,tr_kg,bl_kg,br_kg"]
    for k in range(int(seconds * 100)):
        t = k / 100
        right, front = position(ML, t) / 433, position(AP, t) / 238
        kg = 0 if off[0] <= t < off[1] else MASS_KG * share
        cells = (kg * (0.5 - right) * (0.5 + front), kg * (0.5 + right) * (0.5 + front),
                 kg * (0.5 - right) * (0.5 - front), kg * (0.5 + right) * (0.5 - front))
        rows.append(",".join(map(str, (t, *cells))))
    path.write_text("\n".join(rows) + "\n")
    return path


def sway_words(stage, out, *words):
    return ("--connect", stage.sensor, "sway", "--script", "--json", "--seconds", SECONDS, "--settle-s", "0.3",
            "--wait-s", "20", "--out", stage.folder / out, *words)


def check_refusals(stage):
    none = stage.run("footing-ctl", *sway_words(stage, "none"))
    assert none.returncode == 3 and "has no board" in none.stderr and "pair board" in none.stderr, none
    assert not list(stage.folder.glob("none*")), "files of a session that never began"
    for words, says in ((("--feet", "sideways"), "tandem"), (("--repeats", "0"), "--repeats"),
                        (("--surface", "firm,foam", "--feet", "together,shoulder,tandem"), "12 conditions"),
                        (("--cutoff-hz", "40"), "0.36")):
        done = stage.run("footing-ctl", *sway_words(stage, "none", *words))
        assert done.returncode == 2 and says in done.stderr, (words, done)


def check_protocol(stage):
    """Two conditions, two trials each; while one is measured the subject steps off."""
    stage.start("footing-stream", "corners", "--left", corners(stage.folder / "one.csv", 60, off=OFF_S), "--to",
                stage.devices)
    stage.wait_for_devices(1)
    done = stage.run("footing-ctl", *sway_words(stage, "p01", "--repeats", 2, "--subject", "p01", "--notes", "after <lunch>"))
    assert done.returncode == 0, done
    out = json.loads(done.stdout)
    assert stage.stop("footing-stream") == 0
    counted = [trial for trial in out["trials"] if trial["counts"]]
    assert [(one["eyes"], one["repeat"]) for one in counted] == [("open", 1), ("open", 2), ("closed", 1), ("closed", 2)], out
    rejected = [trial for trial in out["trials"] if not trial["counts"]]
    assert len(rejected) == 1 and rejected[0]["rejected"] == "the subject stepped off", rejected
    assert done.stderr.count("DONE: ") == 4 and done.stderr.count("REJECTED: ") == 1, done.stderr
    assert "close the eyes" in done.stderr and ", again" in done.stderr, done.stderr
    check_measures(out, counted)
    check_files(stage, out, counted)
    return out


def check_measures(out, counted):
    # Mean speed of the true path over a common period of its tones.
    steps = [(position(ML, k / 1000), position(AP, k / 1000)) for k in range(10001)]
    speed_mm_s = sum(math.dist(a, b) for a, b in zip(steps, steps[1:])) / 10
    for trial in counted:
        assert abs(trial["mass_kg"] - MASS_KG) < 0.7 and trial["left_load_percent"] is None, trial
        # Two seconds are not a whole number of periods.
        assert 0.6 * speed_mm_s < trial["mean_velocity_mm_s"] < 1.5 * speed_mm_s, (trial, speed_mm_s)
        assert SECONDS - 0.1 < trial["duration_s"] <= SECONDS and trial["median_frequency_ml_hz"] is None, trial
        assert trial["sample_entropy_ap"] > 0, trial
    assert (out["rate_hz"], out["cutoff_hz"], out["simulated"], out["missing"]) == (50, 10, True, 0), out
    means = {one["eyes"]: one["mean"]["path_length_mm"] for one in out["conditions"]}
    assert math.isclose(out["romberg"][0]["path_ratio"], means["closed"] / means["open"]), out
    said = "; ".join(out["warnings"])
    assert "simulated" in said and "too short" in said and "not tared" in said, said


def check_files(stage, out, counted):
    with open(out["files"]["csv"], newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 5 and [row["counts"] for row in rows].count("true") == 4, rows
    assert float(next(row for row in rows if row["counts"] == "true")["path_length_mm"]) == counted[0]["path_length_mm"]
    page = open(out["files"]["report"], encoding="utf-8").read()
    assert "after &lt;lunch&gt;" in page and page.count("<svg") == 4 and "50 Hz" in page, page[:3000]
    # The COP in its file has the same measures for footing-eval.
    number = out["trials"].index(counted[-1]) + 1
    with open(out["files"]["cop"], newline="") as file:
        cop = [row for row in csv.DictReader(file) if int(row["trial"]) == number]
    table = stage.folder / "cop.csv"
    table.write_text("time_s,x_mm,y_mm\n" + "".join(f"{row['time_s']},{row['x_mm']},{row['y_mm']}\n" for row in cop))
    again = stage.run_json("footing-eval", "board", "--cop", table, "--min-seconds", "1")
    for key in set(counted[-1]) & set(again) - {"gaps", "recorded_rate_hz"}:
        assert again[key] == counted[-1][key] or math.isclose(again[key], counted[-1][key], rel_tol=1e-9), (key, again)


def check_recording(stage, live):
    recording = stage.folder / "p01.mcap"
    again = stage.run_json("footing-ctl", "sway", "--from", recording)
    for key in ("trials", "conditions", "romberg", "boards", "subject", "notes", "warnings"):
        assert again[key] == live[key], (key, again[key], live[key])
    other = stage.run_json("footing-ctl", "sway", "--from", recording, "--cutoff-hz", "3", "--out", stage.folder / "smooth")
    assert other["conditions"][0]["mean"]["path_length_mm"] < live["conditions"][0]["mean"]["path_length_mm"], other
    assert (stage.folder / "smooth.html").exists() and not (stage.folder / "smooth.mcap").exists()
    twice = stage.run("footing-ctl", "sway", "--from", recording, "--out", stage.folder / "smooth")
    assert twice.returncode == 2 and "--force" in twice.stderr, twice
    # A trial is a pair of markers for every other reader.
    done = stage.run("footing-log", "export", recording, "--format", "csv", "--out", stage.folder / "csv")
    assert done.returncode == 0, done
    events = (stage.folder / "csv" / "footingd_events.csv").read_text()
    assert events.count("begin sway ") == events.count("end sway ") == 5 and "rejected sway " in events, events
    # A session that was cut off is mended with the trials until then.
    cut = stage.folder / "cut.mcap"
    cut.write_bytes(recording.read_bytes()[:-3000])
    refused = stage.run("footing-ctl", "sway", "--from", cut)
    assert refused.returncode == 4 and "footing-log repair" in refused.stderr, refused
    mended = stage.folder / "mended.mcap"
    assert stage.run("footing-log", "repair", cut, "--out", mended).returncode == 0
    repaired = json.loads(stage.run("footing-ctl", "sway", "--from", mended, "--json").stdout)
    assert repaired["trials"] and repaired["trials"] == live["trials"][:len(repaired["trials"])], repaired["trials"]
    other = stage.folder / "csv" / "footingd_events.csv"
    assert stage.run("footing-ctl", "sway", "--from", other).returncode == 4


def check_lost_board(stage):
    """Two boards of which one is lost in mid-trial: that attempt is rejected, and made again once it is back."""
    def start():
        stage.start("footing-stream", "corners", "--left", corners(stage.folder / "l.csv", 30, 0.6), "--right",
                    corners(stage.folder / "r.csv", 30, 0.4), "--to", stage.devices)

    start()
    stage.wait_for_devices(2)
    log = stage.folder / "footing-ctl.log"
    sway = stage.start("footing-ctl", *sway_words(stage, "two", "--eyes", "open", "--repeats", 1))
    begun = "PROMPT: Stand still."
    stage.wait_for(lambda: begun in log.read_text(), "the trial")
    stage.stop("footing-stream", signal.SIGKILL)
    stage.wait_for(lambda: "press its button" in log.read_text(), "the board to be missed")
    start()
    assert sway.wait(PATIENCE_S) == 0, log.read_text()
    text = log.read_text()
    out = json.loads(next(line for line in text.splitlines() if line.startswith("{")))
    assert "sent nothing for 1 s" in out["trials"][0]["rejected"] or begun in text.split("press its button")[1], text
    trial = out["trials"][-1]
    assert trial["counts"] and abs(trial["left_load_percent"] - 60) < 1 and len(out["boards"]) == 2, out
    assert stage.run_json("footing-ctl", "sway", "--from", stage.folder / "two.mcap")["trials"] == out["trials"]
    # Ctrl-C ends a session; what was measured stays.
    stage.start("footing-ctl", *sway_words(stage, "stopped", "--repeats", 5))
    stage.wait_for(lambda: "DONE: " in log.read_text(), "a trial")
    assert stage.stop("footing-ctl", signal.SIGINT) == 1
    kept = subprocess.run([stage.binaries / "footing-ctl", "sway", "--from", stage.folder / "stopped.mcap", "--json"],
                          capture_output=True, text=True, check=False)
    assert kept.returncode == 1 and "9 of 10 trials are missing" in kept.stderr, kept
    assert sum(trial["counts"] for trial in json.loads(kept.stdout)["trials"]) == 1, kept
    assert stage.stop("footing-stream") == 0


if __name__ == "__main__":
    with Stage(sys.argv[2]) as the_stage:
        the_stage.start("footingd", "--listen", the_stage.sensor, "--source", f"stream:{the_stage.devices}")
        the_stage.wait_for_socket(the_stage.sensor)
        the_stage.wait_for_socket(the_stage.devices)
        check_refusals(the_stage)
        check_recording(the_stage, check_protocol(the_stage))
        check_lost_board(the_stage)
        assert the_stage.stop("footingd") == 0
