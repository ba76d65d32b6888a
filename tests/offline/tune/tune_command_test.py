"""footing-tune stopped after one iteration goes on to what an unbroken run writes; its table is
read by footing-eval; a state of another run is refused by name."""
import json
import pathlib
import subprocess
import sys
import tempfile

TUNE, EVAL = sys.argv[1:3]


def run(program, *arguments):
    return subprocess.run([program, *arguments], capture_output=True, text=True)


def tune(out, iterations, *more):
    return run(TUNE, "--gait", "step", "--speeds", "0", "--trials", "1", "--seed", "5", "--out",
               str(out), "--iterations", str(iterations), "--json", *more)


def without_comment(path):
    return [line for line in path.read_text().splitlines() if not line.startswith("#")]


with tempfile.TemporaryDirectory() as folder:
    broken, unbroken = pathlib.Path(folder, "a.csv"), pathlib.Path(folder, "b.csv")
    first, second = tune(broken, 1), tune(broken, 2)
    for done in (first, second, tune(unbroken, 2, "--threads", "1")):
        assert done.returncode == 0, done.stderr
    assert "resuming from" not in first.stderr and "resuming from" in second.stderr
    assert "step 0 m/s: scoring 8 new trials\n" in first.stderr, first.stderr
    assert without_comment(broken) == without_comment(unbroken)
    assert "--seed 5" in broken.read_text() and "seed 5" in broken.read_text().splitlines()[0]
    assert broken.with_suffix(".svg").read_text().count("<polyline") == 2
    assert json.loads(second.stdout)["sets"][0]["before"]["trials"] == 8

    kept = tune(pathlib.Path(folder, "c.csv"), 1, "--keep", "0.5")
    assert kept.returncode == 0, kept.stderr
    rows = [line.split(",")[:3] for line in without_comment(pathlib.Path(folder, "c.csv"))[2:]]
    assert rows == [["step", "all", "0"], ["step", "kept1", "0.5"]], rows

    refused = run(TUNE, "--gait", "step", "--speeds", "0", "--trials", "1", "--seed", "6", "--out",
                  str(broken))
    assert refused.returncode == 4 and "another seed" in refused.stderr, refused.stderr
    assert run(TUNE, "--gait", "step", "--speeds", "0").returncode == 2
    assert run(TUNE, "--gait", "walk", "--speeds", "1,1", "--out", "x").returncode == 2
    fast = run(TUNE, "--gait", "walk", "--speeds", "1,3", "--iterations", "0", "--trials", "1")
    assert fast.returncode == 2 and "--speeds: 3 m/s" in fast.stderr, fast.stderr
    assert "walk, 1.75 m/s" in fast.stderr, fast.stderr
    still = run(TUNE, "--gait", "walk", "--speeds", "0", "--iterations", "0", "--trials", "12")
    assert still.returncode == 0, still.stderr  # Its pits are at the start of the track.
    assert run(TUNE, "--gait", "hop", "--speeds", "1", "--out", "x").returncode == 2

    styled = pathlib.Path(folder, "style.csv")
    searched = run(TUNE, "--gait", "walk", "--speeds", "1.2", "--style", "--trials", "1", "--iterations", "1", "--out",
                   str(styled), "--json")
    assert searched.returncode == 0, searched.stderr
    found = json.loads(searched.stdout)["sets"][0]
    assert 0 < found["before"]["style"]["transport"] < 1 and "style.bob_share" in found["gains"], found
    assert "style.pelvis_roll_rad" in styled.read_text()
    plain = run(TUNE, "--gait", "walk", "--speeds", "1.2", "--trials", "1", "--out", str(styled))
    assert plain.returncode == 4 and "is of a run with another" in plain.stderr, plain.stderr
    still = run(TUNE, "--gait", "step", "--speeds", "0", "--style", "--out", "x")
    assert still.returncode == 2 and "walk and run have a style" in still.stderr, still.stderr

    evaluated = run(EVAL, "gait", "--gait", "step", "--seconds", "2", "--gains", str(broken),
                    "--json")
    assert evaluated.returncode == 0, evaluated.stderr
