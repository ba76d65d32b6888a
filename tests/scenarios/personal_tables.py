"""What a person's own mapping table is worth, far from the mean tempo or amplitude: `footing-study ranges` measures a
synthetic user of each kind live. Then others of the same tempo and amplitude run along a track, with the built-in table
and with this one, at the same seeds.

Usage: personal_tables.py BINARY_FOLDER FOLDER [--users N] [--seed S] [--track NAME] [--only INTERFACE]
       personal_tables.py BINARY_FOLDER FOLDER --table COMMIT

The first form writes one table and two JSON files into FOLDER for each interface and kind of user; interrupted, it goes
on where it was. The second form writes docs/measurements/personal-tables.csv from them; then run scripts/measurements.
"""
import argparse
import csv
import datetime
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from harness import Stage  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEVICES = {"wrist": 2, "arm": 2, "leg": 3, "boards": 2}
# Tempo and amplitude as shares of an ordinary person's.
KINDS = {"slow": (0.7, 1), "fast": (1.3, 1), "small": (1, 0.6), "large": (1, 1.5)}
STYLE_SEED = 5


def style(kind):
    return "--tempo", KINDS[kind][0], "--amplitude", KINDS[kind][1]


def measure_table(binaries, interface, kind, path):
    """Returns why there is no table, empty where there is one."""
    with Stage(binaries) as stage:
        stage.start_servers()
        stage.start("footing-stream", "user", "--interface", interface, "--ranges", *style(kind), "--style-seed",
                    STYLE_SEED, "--to", stage.devices)
        stage.wait_for_devices(DEVICES[interface])
        done = stage.run("footing-study", "ranges", "--interface", interface, "--participant", kind, "--sensor",
                         stage.sensor, "--out", path, "--now")
        return "" if done.returncode == 0 else done.stderr.strip().splitlines()[-1]


def run_track(binaries, arguments, interface, kind, table):
    words = ["tracks", "--interface", interface, "--track", arguments.track, "--trials", arguments.users, "--seed",
             arguments.seed, *style(kind)]
    with Stage(binaries) as stage:
        return stage.run_json("footing-eval", *words, *(["--table", table] if table else []), timeout_s=1200)


def measure(arguments):
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for interface in DEVICES:
        for kind in KINDS:
            if arguments.only not in ("", interface):
                continue
            stem = arguments.folder / f"{interface}.{kind}"
            table, refusal = pathlib.Path(f"{stem}.table"), pathlib.Path(f"{stem}.refused")
            if not table.exists() and not refusal.exists():
                why = measure_table(arguments.binaries, interface, kind, table)
                if why:
                    refusal.write_text(why)
                    print(f"{interface}, {kind}: {why}", flush=True)
            for name, own in (("built-in", None), ("own", table)):
                out = pathlib.Path(f"{stem}.{name}.json")
                if out.exists() or (own and not own.exists()):
                    continue
                result = run_track(arguments.binaries, arguments, interface, kind, own)
                out.write_text(json.dumps(result))
                print(f"{interface}, {kind}, {name}: {cells_of(result)}", flush=True)


def cells_of(result):
    failures = ", ".join(f"{kind} {count}" for kind, count in result["failures"].items() if count) or "0"
    return (f"{100 * result['gait_agreement']:.1f} %", failures,
            f"{result['completed']} of {result['trials']}, {result['median_time_s']:.0f} s")


def rows_of(folder):
    for interface in DEVICES:
        for kind, (tempo, amplitude) in KINDS.items():
            for name in ("built-in", "own"):
                path = folder / f"{interface}.{kind}.{name}.json"
                what = f"{interface}, tempo {tempo}, amplitude {amplitude}, {name} table"
                if name == "own" and (folder / f"{interface}.{kind}.refused").exists():
                    yield f"{what} @ gait agreement", "none: refused", ""
                if not path.exists():
                    continue
                result = json.loads(path.read_text())
                for column, cell in zip(("gait agreement", "failures", "finished, median time"), cells_of(result)):
                    yield f"{what} @ {column}", cell, result["seed"]


def tabulate(folder, commit):
    columns = ["what", "value", "unit", "command", "commit", "date", "seed", "note"]
    command = "tests/scenarios/personal_tables.py build/release/bin FOLDER"
    with open(ROOT / "docs/measurements/personal-tables.csv", "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(columns)
        for what, value, seed in rows_of(folder):
            out.writerow([what, value, "", command, commit, datetime.date.today().isoformat(), seed, ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binaries", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--users", type=int, default=3)
    parser.add_argument("--seed", type=int, default=927501)
    parser.add_argument("--track", default="4")
    parser.add_argument("--only", default="", choices=("", *DEVICES))
    parser.add_argument("--table", metavar="COMMIT")
    arguments = parser.parse_args()
    if arguments.table:
        tabulate(arguments.folder, arguments.table)
    else:
        measure(arguments)


if __name__ == "__main__":
    main()
