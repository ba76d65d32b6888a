#!/usr/bin/env python3
"""Shows that each fault test can fail: takes the handling of one fault out of the programs by a patch,
and expects the test of that fault to go red.

A patch is tests/mutation/FaultNN.patch: one sentence on what it takes away, then a diff of product
code (daemon, common, clients), against the tree as it stands. It is applied in a copy of the tree,
where only the programs are built anew: the fault tests stay as they are. Before, all fault tests must
be green there. With each patch the programs must still work otherwise: one of three control tests
has to stay green, so that a program that does not even start proves nothing.

What is done is kept in results.json, so that a run that was cut goes on where it ended. A result
counts while neither its patch nor the tree has changed.

Usage: run_mutation.py [--folder build/mutation] [--only NN]... [--fresh]
       run_mutation.py --check   whether every patch is there and applies to the tree; builds nothing
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
PATCHES = ROOT / "tests" / "mutation"
# What a build of the programs and the fault tests needs.
SOURCES = ("CMakeLists.txt", "CMakePresets.json", "clients", "common", "daemon", "proto", "scripts",
           "systemd", "tests", "docs")
# What decides a result.
JUDGED = ("CMakeLists.txt", "CMakePresets.json", "clients/log", "common", "daemon", "proto", "systemd",
          "tests/device_faults")
PRODUCT = ("daemon/", "common/", "clients/")
PROGRAMS = ("footingd", "footing-log")
# In a second each: devices without sense in their memory, a board's forces, a Wiimote's.
CONTROLS = (19, 52, 55)
# These break footingd's end, with which every fault test ends.
WITHOUT_CONTROL = (61, 62)
TEST_LIMIT_S = 120
BUILD_LIMIT_S = 900


def faults():
    """The numbers of the faults that have a test."""
    tests = (ROOT / "tests" / "device_faults").glob("*_test.cc")
    return sorted({int(number) for test in tests for number in re.findall(r"\(Fault(\d\d)", test.read_text())})


FAULTS = faults()


def run(words, folder, limit_s):
    """A finished process; one that takes too long counts as failed."""
    try:
        return subprocess.run(words, cwd=folder, capture_output=True, text=True, errors="replace",
                              timeout=limit_s, check=False)
    except subprocess.TimeoutExpired as late:
        said = late.stdout.decode(errors="replace") if isinstance(late.stdout, bytes) else ""
        return subprocess.CompletedProcess(words, 1, said, f"no end within {limit_s} s")


def files_of(name):
    base = ROOT / name
    found = [base] if base.is_file() else sorted(base.rglob("*"))
    return [path for path in found if path.is_file() and "__pycache__" not in path.parts]


def tree_digest():
    digest = hashlib.sha256()
    for name in JUDGED:
        for path in files_of(name):
            digest.update(str(path.relative_to(ROOT)).encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


def copy_file(path, copy):
    """Files that did not change keep their time, so that they are not built anew."""
    target = copy / path.relative_to(ROOT)
    if target.is_file() and target.read_bytes() == path.read_bytes():
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(path, target)
    shutil.copymode(path, target)


def copy_tree(copy):
    """Brings the copy to the tree's state."""
    wanted = set()
    for name in SOURCES:
        for path in files_of(name):
            wanted.add(copy / path.relative_to(ROOT))
            copy_file(path, copy)
        for path in (copy / name).rglob("*"):
            if path.is_file() and path not in wanted:
                path.unlink()


def build(copy, targets):
    words = ["cmake", "--build", "--preset", "release", "--target", *targets]
    return run(words, copy, BUILD_LIMIT_S)


def ctest(copy, numbers, jobs, limit_s):
    """The numbers of the fault tests that passed, of those that failed, and what they said."""
    which = "|".join(f"{number:02}" for number in numbers)
    done = run(["ctest", "--preset", "release", "-R", f"^Fault({which})", "-j", str(jobs), "--timeout",
                str(TEST_LIMIT_S)], copy, limit_s)
    passed, failed = set(), set()
    for name, end in re.findall(r"Test +#\d+: Fault(\d\d)\S* \.*(.*)", done.stdout):
        (passed if re.match(r" +Passed", end) else failed).add(int(name))
    return passed - failed, failed, done.stdout + done.stderr


def touched(patch):
    return re.findall(r"^\+\+\+ b/(\S+)", patch.read_text(), re.MULTILINE)


def judge(copy, number, patch):
    """The outcome, and what to show when it is not "red"."""
    if not patch.is_file():
        return "no patch", ""
    files = touched(patch)
    if not files or any(not file.startswith(PRODUCT) for file in files):
        return "not a patch of product code", " ".join(files)
    try:
        applied = run(["patch", "-p1", "--forward", "--batch", "-i", str(patch)], copy, 60)
        if applied.returncode != 0:
            return "patch does not apply", applied.stdout
        built = build(copy, PROGRAMS)
        if built.returncode != 0:
            return "does not build", built.stdout + built.stderr
        passed, failed, said = ctest(copy, [number], 1, TEST_LIMIT_S + 60)
        if not passed and not failed:
            return "no test", said
        if number not in failed:
            return "green", said
        if number not in WITHOUT_CONTROL:
            passed, _, said = ctest(copy, [one for one in CONTROLS if one != number], 2,
                                    2 * TEST_LIMIT_S)
            if not passed:
                return "breaks the controls too", said
        return "red", ""
    finally:
        for file in files:
            for leftover in (".orig", ".rej"):
                (copy / (file + leftover)).unlink(missing_ok=True)
            if (ROOT / file).is_file():
                copy_file(ROOT / file, copy)


def check():
    bad = []
    for number in FAULTS:
        patch = PATCHES / f"Fault{number:02}.patch"
        tried = run(["patch", "-p1", "--forward", "--batch", "--dry-run", "-i", str(patch)], ROOT, 60)
        if tried.returncode != 0:
            bad.append(f"{patch.name} does not apply to {' '.join(touched(patch)) if patch.is_file() else 'anything'}")
    for line in bad:
        print("mutation: " + line)
    print(f"mutation: {len(FAULTS) - len(bad)} of {len(FAULTS)} patches apply")
    return 1 if bad else 0


def prepare(copy, folder, digest, numbers):
    """Builds the unpatched tree and runs its fault tests; returns those that are not green there."""
    data = os.environ.get("FOOTING_TEST_DATA", "")
    configured = run(["cmake", "--preset", "release", f"-DFOOTING_TEST_DATA={data}"], copy, 300)
    built = configured
    if configured.returncode == 0:
        built = run(["cmake", "--build", "--preset", "release", "--target", *PROGRAMS, "fault_tests"],
                    copy, 3600)
    if built.returncode != 0:
        sys.exit(f"error: the tree does not build in {copy}\n{(built.stdout + built.stderr)[-3000:]}")
    store = folder / "unpatched.json"
    known = json.loads(store.read_text()) if store.is_file() else {}
    green = set(known.get("green", [])) if known.get("digest") == digest else set()
    wanted = [number for number in {*numbers, *CONTROLS} if number not in green]
    if wanted:
        print(f"mutation: {len(wanted)} fault tests on the unpatched tree", flush=True)
        passed, _, said = ctest(copy, wanted, os.cpu_count() or 1, 3600)
        (folder / "unpatched.log").write_text(said)
        for _ in range(2):  # Once more each, one by one; and those that a busy machine held up again.
            for number in sorted(set(wanted) - passed):
                passed |= ctest(copy, [number], 1, TEST_LIMIT_S + 60)[0]
        green |= passed
        store.write_text(json.dumps({"digest": digest, "green": sorted(green)}))
    return {number for number in numbers if number not in green}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build" / "mutation")
    parser.add_argument("--only", type=int, action="append", metavar="NN")
    parser.add_argument("--fresh", action="store_true", help="forget earlier results")
    parser.add_argument("--check", action="store_true", help="build nothing, only try every patch")
    options = parser.parse_args()
    if options.check:
        return check()
    folder = options.folder.resolve()
    copy, store = folder / "tree", folder / "results.json"
    copy.mkdir(parents=True, exist_ok=True)
    if options.fresh:
        (folder / "unpatched.json").unlink(missing_ok=True)
    results = json.loads(store.read_text()) if store.is_file() and not options.fresh else {}
    numbers = options.only or list(FAULTS)
    begin = time.monotonic()
    copy_tree(copy)
    digest = tree_digest()
    not_green = prepare(copy, folder, digest, numbers)
    outcomes = {}
    for place, number in enumerate(numbers, 1):
        patch = PATCHES / f"Fault{number:02}.patch"
        mark = digest + (hashlib.sha256(patch.read_bytes()).hexdigest() if patch.is_file() else "")
        known = results.get(str(number))
        since_s = time.monotonic()
        if number in not_green:
            outcome, said = "not green without a patch", "see " + str(folder / "unpatched.log")
        elif known and known["mark"] == mark and known["outcome"] == "red":
            outcome, said = "red", ""
        else:
            outcome, said = judge(copy, number, patch)
            results[str(number)] = {"mark": mark, "outcome": outcome}
            store.write_text(json.dumps(results, indent=1))
        outcomes[number] = outcome
        print(f"[{place}/{len(numbers)}] Fault{number:02}: {outcome} "
              f"({time.monotonic() - since_s:.0f} s)", flush=True)
        if said:
            print(said[-1500:], flush=True)
    others = [f"Fault{number:02} {outcome}" for number, outcome in outcomes.items() if outcome != "red"]
    for line in others:
        print("mutation: " + line)
    print(f"mutation: {len(numbers) - len(others)} of {len(numbers)} red, "
          f"{time.monotonic() - begin:.0f} s")
    return 1 if others else 0


if __name__ == "__main__":
    sys.exit(main())
