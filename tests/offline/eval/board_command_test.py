"""footing-eval board: its JSON, its exit codes, and the whole real recording.

Usage: board_command_test.py FOOTING_EVAL CORKINE_TO_CORNERS [TEST_DATA]
With TEST_DATA left out the part on the real recording is left out too; with "--real" as a fourth
word only that part runs, and without data it ends with 77 (skipped).
"""
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile


def swaying(seconds, rate_hz, noise_kg, without=(0, 0)):
    """Corners of a person of 70 kg who sways slowly, with noise in each cell, and the COP without noise, mm."""
    chance, cop = random.Random(1), []
    rows = ["time_s,tl_kg,tr_kg,bl_kg,br_kg"]
    for k in range(int(seconds * rate_hz)):
        t = k / rate_hz
        x, y = (sum(size * math.sin(2 * math.pi * hz * t) for size, hz in zip((4, 2.8, 1.4, 0.6), tones))
                for tones in ((0.11, 0.29, 0.61, 1.07), (0.13, 0.23, 0.53, 0.97)))
        if without[0] < t < without[1]:
            continue
        cop.append((x, y))
        right, front = x / 433, y / 238  # Shares of the weight beyond one half; 433 x 238 mm between the cells.
        shares = ((0.5 - right) * (0.5 + front), (0.5 + right) * (0.5 + front), (0.5 - right) * (0.5 - front),
                  (0.5 + right) * (0.5 - front))
        rows.append(f"{t}," + ",".join(repr(70 * share + noise_kg * chance.gauss(0, 1)) for share in shares))
    return "\n".join(rows) + "\n", sum(math.dist(a, b) for a, b in zip(cop, cop[1:]))


def runner(program, folder):
    def run(text, *words, kind="--cop", name="made.csv"):
        path = folder / name
        path.write_text(text)
        return subprocess.run([program, "board", kind, path, *words, "--json"],
                              capture_output=True, text=True, check=False)
    return run


def filtered(run):
    """What is measured by default, what it is filtered with, and what it says about its input."""
    for rate_hz in (60, 100):
        noisy, true_mm = swaying(30, rate_hz, 0.02)
        out = json.loads(run(noisy, kind="--corners").stdout)
        assert math.isclose(out["path_length_mm"], true_mm, rel_tol=0.05), (out["path_length_mm"], true_mm)
        assert (out["rate_hz"], out["cutoff_hz"]) == (50, 10) and "Butterworth" in out["filter"], out
        raw = json.loads(run(noisy, "--rate-hz", "recorded", kind="--corners").stdout)
        assert raw["path_length_mm"] > 1.4 * true_mm and raw["filter"] == "none" and raw["cutoff_hz"] is None, raw
        assert any("not filtered" in line for line in raw["warnings"]), raw
        assert out["warnings"] == [] and out["gaps"]["count"] == 0, out
    only = json.loads(run(noisy, "--rate-hz", "25", kind="--corners").stdout)
    assert only["cutoff_hz"] is None and "Butterworth" not in only["filter"], only
    for words, said in ((("--cutoff-hz", "20"), "0.36"), (("--rate-hz", "recorded", "--cutoff-hz", "10"), "--rate-hz"),
                        (("--cutoff-hz", "low"), "or none"), (("--rate-hz", "0"), "1 to 1000 Hz")):
        done = run(noisy, *words, kind="--corners")
        assert done.returncode == 2 and said in done.stderr, done

    # 0.39 s without samples: the person moved meanwhile, and nothing is measured across.
    cut, _ = swaying(30, 60, 0, without=(10.01, 10.39))
    out = json.loads(run(cut, kind="--corners").stdout)
    assert out["stretches"] == 2 and out["gaps"]["count"] == 1, out
    assert 0.38 < out["gaps"]["longest_s"] == out["gaps"]["seconds"] < 0.42, out
    assert out["duration_s"] < 29.7 and any("1 gap" in line for line in out["warnings"]), out

    short, _ = swaying(0.6, 60, 0)
    done = run(short, kind="--corners")
    assert done.returncode == 4 and "need 20 s" in done.stderr and "--min-seconds" in done.stderr, done
    assert json.loads(run(short, "--min-seconds", "0.5", kind="--corners").stdout)["duration_s"] > 0.5
    just = json.loads(run(swaying(20, 60, 0)[0], kind="--corners").stdout)
    assert 19.9 < just["duration_s"] < 20, just
    # A plain table says nothing about its board.
    assert [just[name] for name in ("simulated", "tared", "calibrated", "missing_ticks")] == [None] * 4, just


def marked(run, folder):
    """An export says of what kind its samples are, and the files beside it what is missing."""
    def export(simulated, tared, uncalibrated):
        return ("log_time_ns,sequence,device,sampled_ns,top_left_n,top_right_n,bottom_left_n,bottom_right_n,"
                "uncalibrated,simulated,tared,device_role\n") + "".join(
            f"{k},{k},3,{20_000_000 * k},150,150,150,150,{uncalibrated},{simulated},{tared},left_board\n"
            for k in range(1100))
    board = {"kind": "--corners", "name": "footingd_boards.csv"}
    out = json.loads(run(export(1, 0, 1), **board).stdout)
    assert (out["simulated"], out["tared"], out["calibrated"], out["missing_ticks"]) == (True, False, False, None), out
    said = "; ".join(out["warnings"])
    assert all(word in said for word in ("simulated", "not tared", "calibration")), said
    (folder / "footingd_status.csv").write_text("log_time_ns\n")
    out = json.loads(run(export(0, 1, 0), **board).stdout)
    assert (out["simulated"], out["tared"], out["calibrated"], out["missing_ticks"]) == (False, True, True, 0), out
    assert out["warnings"] == [], out
    (folder / "footingd_gaps.csv").write_text(
        "log_time_ns,from_sequence,to_sequence,reason\n1,5,9,REASON_RING_PASSED\n2,1,900,REASON_NEW_EPOCH\n"
        "3,20,20,REASON_DAMAGED\n")
    out = json.loads(run(export(0, 1, 0), **board).stdout)
    assert out["missing_ticks"] == 6 and any("6 ticks" in line for line in out["warnings"]), out


def made(program, folder):
    run = runner(program, folder)
    filtered(run)
    marked(run, folder)

    turn = 2 * math.pi / 100
    circle = "time_s,x_mm,y_mm\n" + "".join(
        f"{k / 100},{10 * math.cos(turn * k)!r},{10 * math.sin(turn * k)!r}\n" for k in range(3000))
    out = json.loads(run(circle).stdout)
    # 2999 chords of 2 r sin(pi / 100); r / sqrt 2; the covariance is r^2/2 n/(n-1).
    assert math.isclose(out["path_length_mm"], 2999 * 20 * math.sin(turn / 2), rel_tol=1e-9), out
    assert math.isclose(out["rms_ml_mm"], 10 / math.sqrt(2), rel_tol=1e-9), out
    assert math.isclose(out["ellipse95_area_chi2_mm2"],
                        -2 * math.pi * math.log(0.05) * 50 * 3000 / 2999, rel_tol=1e-9), out
    assert "Schubert" in out["ellipse95_definition"] and out["filter"] == "none", out
    even = json.loads(run(circle, "--rate-hz", "50").stdout)
    assert even["rate_hz"] == 50 and "SWARII" in even["filter"], even
    assert math.isclose(even["rms_ml_mm"], 10 / math.sqrt(2), rel_tol=5e-3), even

    corners = "time_s,tl_kg,tr_kg,bl_kg,br_kg\n" + "".join(
        f"{k / 100},15,20,15,20\n" for k in range(2001))
    out = json.loads(run(corners, kind="--corners").stdout)
    assert math.isclose(out["mass_kg"], 70, rel_tol=1e-12) and out["path_length_mm"] < 1e-9, out

    for text, said in (("", "empty"), ("t,x\n", "line 1"), ("time_s,x_mm,y_mm\n0,0\n", "line 2"),
                       ("time_s,x_mm,y_mm\n0,0,0\n1,nan,0\n", "line 3"),
                       ("time_s,x_mm,y_mm\n0,0,0\n1,1e400,0\n", "line 3"),
                       ("time_s,x_mm,y_mm\n1,0,0\n0,0,0\n", "goes back"),
                       ("time_s,x_mm,y_mm\n0,0,0\n", "3 samples")):
        done = run(text)
        assert done.returncode == 4 and said in done.stderr and not done.stdout, (text, done)
    # The export of footing-log: two boards, forces in N, times in ns.
    export = ("log_time_ns,publish_time_ns,sequence,device,sampled_ns,top_left_n,top_right_n,"
              "bottom_left_n,bottom_right_n,wall_time,device_role\n") + "".join(
        f"{k},{k},{k},{device},{90_000_000_000_000 + 10_000_000 * k},{9.80665 * kg},{9.80665 * kg},"
        f"{9.80665 * kg},{9.80665 * kg},,{role}\n" for k in range(2000)
        for device, kg, role in ((3, 15, "left_board"), (4, 20, "right_board")))
    for board, mass_kg in (("left_board", 60), ("4", 80)):
        out = json.loads(run(export, "--board", board, kind="--corners").stdout)
        assert math.isclose(out["mass_kg"], mass_kg, rel_tol=1e-9), out
        assert math.isclose(out["duration_s"], 19.98, abs_tol=0.02), out
    for words in ((), ("--board", "head")):
        done = run(export, *words, kind="--corners")
        assert done.returncode == 2 and "left_board (3), right_board (4)" in done.stderr, done
    one = "\n".join(line for line in export.split("\n") if "right_board" not in line)
    assert math.isclose(json.loads(run(one, kind="--corners").stdout)["mass_kg"], 60), one
    broken = run(export.replace("147.", "x"), "--board", "3", kind="--corners")
    assert broken.returncode == 4 and "not a number" in broken.stderr, broken
    assert run(corners, "--board", "3", kind="--corners").returncode == 2
    missing = run("device,top_left_n\n1,2\n", kind="--corners")
    assert missing.returncode == 4 and "sampled_ns" in missing.stderr, missing

    nobody = run("time_s,tl_kg,tr_kg,bl_kg,br_kg\n0,0,0,0,0\n", kind="--corners")
    assert nobody.returncode == 4 and "nobody" in nobody.stderr, nobody
    newtons = run(corners.replace("15,20,15,20", "150,200,150,200"), kind="--corners")
    assert newtons.returncode == 4 and "add up to 700 kg" in newtons.stderr, newtons
    idle = run(circle, "--window-s", "0.1")
    assert idle.returncode == 2 and "--rate-hz" in idle.stderr, idle
    twice = run("device,device,sampled_ns,top_left_n,top_right_n,bottom_left_n,bottom_right_n\n", kind="--corners")
    assert twice.returncode == 4 and "two columns are named device" in twice.stderr, twice
    long = run("time_s,x_mm,y_mm\n0,0,0\n1e9,0,0\n1e9,1,1\n", "--rate-hz", "1000")
    assert long.returncode == 4 and "seconds" in long.stderr, long


def real(program, converter, folder, data):
    log = pathlib.Path(data or "/nonexistent") / "devices/wbb_corkine/subject01_scr.log"
    if not log.exists():
        print("skipped: no recording; set FOOTING_TEST_DATA")
        sys.exit(77)
    csv = folder / "corners.csv"
    subprocess.run([sys.executable, converter, log, csv], check=True)
    for words in ((), ("--rate-hz", "25")):
        done = subprocess.run([program, "board", "--corners", csv, *words, "--json"],
                              capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        out = json.loads(done.stdout)
        assert out["samples_read"] == 63559 and out["gaps"]["count"] > 0, out
        # One standing adult, and a COP that stays on the board (433 x 238 mm between the cells).
        assert 35 < out["mass_kg"] < 120, out
        assert out["range_ml_mm"] <= 433 and out["range_ap_mm"] <= 238, out
        assert all(math.isfinite(v) for v in out.values() if isinstance(v, (int, float))), out


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="footing-board.") as name:
        if "--real" in sys.argv:
            real(sys.argv[1], sys.argv[2], pathlib.Path(name), sys.argv[3])
        else:
            made(sys.argv[1], pathlib.Path(name))
