"""Each shipped gait table is what the command in its first lines writes, bit for bit (docs/tuning.md).
That of running is one that an earlier search found.

Usage: gait_tables.py BINARY_FOLDER [GAIT...]

Some twenty minutes of one free processor, eight of them for the style. A mathematical library that
rounds otherwise finds other tables.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLES = ROOT / "daemon/simulation/data/gaits"
COMMAND_LINE = 1
FOUND = ROOT / "daemon/offline/tune/start/found/run.csv"
GAITS = ("step", "walk", "jump", "style/walk", "paper/step", "paper/walk", "paper/jump", "paper/run")


def written(binaries, gait):
    """The table that its own command writes, started in a folder that has the sources in it."""
    program, *words = (TABLES / f"{gait}.csv").read_text().splitlines()[COMMAND_LINE].removeprefix("# ").split()
    assert program == "footing-tune", program
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(ROOT / "daemon", pathlib.Path(folder, "daemon"))
        done = subprocess.run([pathlib.Path(binaries, program).resolve(), *words], cwd=folder, capture_output=True,
                              text=True, check=False)
        assert done.returncode == 0, done.stderr
        return pathlib.Path(folder, words[words.index("--out") + 1]).read_text()


def gains(table):
    return [line for line in table.read_text().splitlines() if not line.startswith("#")]


def main():
    binaries, *gaits = sys.argv[1:]
    assert gains(TABLES / "run.csv") == gains(FOUND), f"run.csv is another table than {FOUND}"
    for gait in gaits or GAITS:
        assert written(binaries, gait) == (TABLES / f"{gait}.csv").read_text(), f"{gait}.csv is another table"
        print(gait, flush=True)


if __name__ == "__main__":
    sys.exit(main())
