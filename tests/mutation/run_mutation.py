#!/usr/bin/env python3
"""Shows that each fault test can fail: applies one patch that removes the handling of one fault, builds
and expects the test of that fault to go red.

A patch is tests/mutation/FaultNN.patch, against the tree as it stands. The tree is copied once; what
is done is kept in results.json, so a run that was cut goes on where it ended (a result counts while
neither its patch nor the tree has changed).

Usage: run_mutation.py [--folder build/mutation] [--only NN]... [--fresh]
"""
import argparse
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
FAULTS = range(1, 65)
SOURCES = ("CMakeLists.txt", "CMakePresets.json", "clients", "common", "daemon", "proto", "scripts",
           "systemd", "tests", "docs")


def run(words, folder, timeout_s=900):
    return subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=timeout_s,
                          check=False)


def tree_digest():
    digest = hashlib.sha256()
    for name in SOURCES:
        base = ROOT / name
        files = [base] if base.is_file() else sorted(base.rglob("*"))
        for path in files:
            if path.is_file() and "mutation" not in path.parts and "__pycache__" not in path.parts:
                digest.update(str(path.relative_to(ROOT)).encode())
                digest.update(path.read_bytes())
    return digest.hexdigest()


def copy_tree(copy):
    """Brings the copy to the tree's state; files that did not change keep their time."""
    copy.mkdir(parents=True, exist_ok=True)
    for name in SOURCES:
        base = ROOT / name
        for path in [base] if base.is_file() else base.rglob("*"):
            if not path.is_file() or "__pycache__" in path.parts:
                continue
            target = copy / path.relative_to(ROOT)
            if target.is_file() and target.read_bytes() == path.read_bytes():
                continue
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, target)
            shutil.copymode(path, target)


def build(copy):
    targets = [name for name in ("footingd", "footing-log", "footing-ctl", "fault_tests") if name]
    return run(["cmake", "--build", "--preset", "release", "--target", *targets], copy)


def test(copy, number):
    done = run(["ctest", "--preset", "release", "-R", f"^Fault{number:02}", "--timeout", "120"], copy)
    ran = re.search(r"out of (\d+)", done.stdout)
    if not ran or int(ran.group(1)) == 0:
        return "absent", done.stdout
    return ("green" if done.returncode == 0 else "red"), done.stdout


def judge(copy, number, patch):
    if not patch.is_file():
        return "no patch", ""
    applied = run(["patch", "-p1", "--forward", "--batch", "-i", str(patch)], copy)
    try:
        if applied.returncode != 0:
            return "patch does not apply", applied.stdout
        built = build(copy)
        if built.returncode != 0:
            return "does not build", (built.stdout + built.stderr)[-2000:]
        return test(copy, number)
    finally:
        copy_tree(copy)
        for leftover in [*copy.rglob("*.rej"), *copy.rglob("*.orig")]:
            leftover.unlink()


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build" / "mutation")
    parser.add_argument("--only", type=int, action="append")
    parser.add_argument("--fresh", action="store_true", help="forget earlier results")
    options = parser.parse_args()
    copy, store = options.folder / "tree", options.folder / "results.json"
    digest = tree_digest()
    results = json.loads(store.read_text()) if store.is_file() and not options.fresh else {}
    copy_tree(copy)
    data = os.environ.get("FOOTING_TEST_DATA", "")
    configured = run(["cmake", "--preset", "release", f"-DFOOTING_TEST_DATA={data}"], copy)
    built = build(copy) if configured.returncode == 0 else configured
    if built.returncode != 0:
        print(f"error: the tree does not build in {copy}\n{(built.stdout + built.stderr)[-3000:]}")
        return 1
    numbers = options.only or list(FAULTS)
    for number in numbers:
        patch = ROOT / "tests" / "mutation" / f"Fault{number:02}.patch"
        mark = digest + (hashlib.sha256(patch.read_bytes()).hexdigest() if patch.is_file() else "")
        known = results.get(str(number))
        if known and known["mark"] == mark and known["outcome"] == "red":
            continue
        begin = time.monotonic()
        outcome, output = judge(copy, number, patch)
        results[str(number)] = {"mark": mark, "outcome": outcome}
        store.write_text(json.dumps(results, indent=1))
        print(f"Fault{number:02}: {outcome} ({time.monotonic() - begin:.0f} s)", flush=True)
        if outcome not in ("red", "no patch", "green"):
            print(output[-1500:])
    build(copy)
    red = sum(results[str(n)]["outcome"] == "red" for n in numbers if str(n) in results)
    print(f"mutation: {red} of {len(numbers)} red")
    return 0 if red == len(numbers) else 1


if __name__ == "__main__":
    sys.exit(main())
