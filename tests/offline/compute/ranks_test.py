"""Two ranks of MPI come to the same bits as one process: ranks_test.py FOOTING_TUNE FOOTING_TRAIN."""
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

TUNE, TRAIN = sys.argv[1:3]
# Inside a container everything may run as root, and there may be fewer processors than ranks.
RANKS = ["mpirun", "--oversubscribe", "-n"]
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def run(ranks, *command):
    launcher = [*RANKS, str(ranks)] if ranks else []
    return subprocess.run([*launcher, *map(str, command)], capture_output=True, text=True,
                          env=ENVIRONMENT)


def tune(ranks, out, iterations):
    return run(ranks, TUNE, "--gait", "step", "--speeds", "0", "--trials", "1", "--iterations", iterations,
               "--threads", "1", "--out", out, "--json")


JOINTS = [("Hips", None, (0, 95, 0)), ("Spine", "Hips", (0, 20, 0)), ("Neck", "Spine", (0, 30, 0))]
for side, sign in (("Left", 1), ("Right", -1)):
    JOINTS += [(side + "UpLeg", "Hips", (9 * sign, -5, 0)), (side + "Leg", side + "UpLeg", (0, -42, 0)),
               (side + "Foot", side + "Leg", (0, -42, 0)), (side + "ToeBase", side + "Foot", (0, -5, 14)),
               (side + "Arm", "Spine", (18 * sign, 28, 0)), (side + "ForeArm", side + "Arm", (28 * sign, 0, 0)),
               (side + "Hand", side + "ForeArm", (26 * sign, 0, 0))]


def bvh(person, frames=200):
    """Someone who sways at a rhythm of their own and bends the trunk."""
    def joint(name, offset, depth):
        children = [one for one in JOINTS if one[1] == name]
        channels = "3 Zrotation Xrotation Yrotation" if depth else (
            "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation")
        end = "" if children else "End Site\n{\nOFFSET 0 5 0\n}\n"
        return (f"{'JOINT' if depth else 'ROOT'} {name}\n{{\nOFFSET {offset[0]} {offset[1]} {offset[2]}\n"
                f"CHANNELS {channels}\n" + "".join(joint(one[0], one[2], depth + 1) for one in children)
                + end + "}\n")

    def order(name):
        return [name] + [n for one in JOINTS if one[1] == name for n in order(one[0])]

    rows = []
    for t in range(frames):
        sway, bend = math.sin(t * (0.02 + 0.01 * person)), math.sin(t * 0.03 * person)
        row = [2 * sway, 95, 1.5 * bend, 0, 0, 0]
        for name in order("Hips")[1:]:
            row += [0, 6 * bend if name == "Spine" else 0, 0]
        rows.append(" ".join(f"{value:.5f}" for value in row))
    return ("HIERARCHY\n" + joint("Hips", (0, 95, 0), 0)
            + f"MOTION\nFrames: {frames}\nFrame Time: 0.0166667\n" + "\n".join(rows) + "\n")


def same_table(folder):
    alone, shared = folder / "alone.csv", folder / "shared.csv"
    outcomes = [tune(0, alone, 1), tune(2, shared, 1)]
    for outcome in outcomes:
        assert outcome.returncode == 0, outcome.stderr
    assert outcomes[0].stdout == outcomes[1].stdout.replace("shared", "alone"), outcomes
    lines = [[line for line in path.read_text().splitlines() if not line.startswith("#")]
             for path in (alone, shared)]
    assert lines[0] == lines[1] and len(lines[0]) > 2
    states = [pathlib.Path(f"{path}.state.json").read_bytes() for path in (alone, shared)]
    assert states[0] == states[1]
    # What ranks kept a single process goes on with, and the other way round.
    again = [tune(2, alone, 2), tune(0, shared, 2)]
    for outcome in again:
        assert outcome.returncode == 0 and outcome.stderr.count("resuming from") == 1, outcome.stderr
    assert again[0].stdout.replace("alone", "shared") == again[1].stdout


def same_scores(folder):
    for person in (1, 2, 3):
        (folder / f"{person}_01.bvh").write_text(bvh(person))
    people = (TRAIN, "people", "--motions", folder, "--json")
    alone, shared = run(0, *people), run(2, *people)
    assert alone.returncode == 0, alone.stderr
    assert shared.returncode == 0, shared.stderr
    assert alone.stdout == shared.stdout and '"3"' in alone.stdout
    refused = run(2, TRAIN, "basis", "--motions", folder, "--out", folder / "x")
    assert refused.returncode != 0 and "only footing-train people" in refused.stderr, refused


def main():
    if shutil.which("mpirun") is None:
        print("skipped: there is no mpirun (Debian: openmpi-bin)")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        probe = tune(1, folder / "probe.csv", 0)
        if "built without MPI" in probe.stderr:
            print("skipped: built without MPI (Debian: libopenmpi-dev)")
            sys.exit(77)
        failed = tune(2, folder / "no" / "such.csv", 1)
        assert failed.returncode != 0 and "such.csv" in failed.stderr, failed
        same_table(folder)
        (folder / "motions").mkdir()
        same_scores(folder / "motions")


main()
