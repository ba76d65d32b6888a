"""The biped's acceptance table: thousands of trials of footing-eval on fresh seeds, each row with its
bar and its 95 % interval. Part of `scripts/test --long biped`; it can be cut and goes on where it was.

What is done stands in results.json of its folder and counts while the programs are the same. The
first run draws the seed, or takes --seed. Ends with 1 when a row misses its bar, and when the time
was over before all was done.

Usage: biped_table.py BINARY_FOLDER [--folder DIR] [--seed N] [--minutes 38] [--only WORD]
                      [--share 1.0] [--jobs 2]
"""
import argparse
import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import time

DATA = pathlib.Path(__file__).resolve().parents[2] / "daemon" / "simulation" / "data"
PAIRS = [(a, b) for a in ("step", "walk", "run", "jump") for b in ("step", "walk", "run", "jump")
         if a != b and (a, b) != ("jump", "run")]
WALKS = (0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75)
RUNS = (1, 2, 3, 4, 5, 6)
JUMPS = (0, 1, 2)
GAITS = ([("step", 0)] + [("walk", v) for v in WALKS] + [("run", v) for v in RUNS] +
         [("jump", v) for v in JUMPS])


def binomial_tail(count, trials, chance):
    """Chance of at most `count` in `trials`."""
    if chance <= 0:
        return 1.0
    if chance >= 1:
        return 1.0 if count >= trials else 0.0
    terms = (math.lgamma(trials + 1) - math.lgamma(k + 1) - math.lgamma(trials - k + 1) +
             k * math.log(chance) + (trials - k) * math.log1p(-chance) for k in range(count + 1))
    return min(1.0, math.fsum(math.exp(term) for term in terms))


def solve(function):
    """Where a falling function of [0, 1] crosses zero."""
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if function(middle) > 0 else (low, middle)
    return (low + high) / 2


def interval(count, trials):
    """Clopper and Pearson's 95 % interval of a rate; one-sided where none or all happened."""
    alpha = 0.05 if count in (0, trials) else 0.025
    low = 0.0 if count == 0 else solve(lambda p: alpha - 1 + binomial_tail(count - 1, trials, p))
    high = 1.0 if count == trials else solve(lambda p: binomial_tail(count, trials, p) - alpha)
    return low, high


def falls(rows, allowed=0):
    count, trials = sum(r["falls"] for r in rows), sum(r["trials"] for r in rows)
    low, high = interval(count, trials)
    return f"{count} falls of {trials} ({100 * low:.2f} to {100 * high:.2f} %)", count <= allowed


def constant(rows):
    text, ok = falls(rows)
    error = max(abs(r["speed_mean_mps"] - r["speed_mps"]) for r in rows)
    return f"{text}, speed off by {error:.4f} m/s", ok and error <= 0.01


def transitions(rows):
    good, trials = sum(r["succeeded"] for r in rows), sum(r["trials"] for r in rows)
    low, _ = interval(good, trials)
    return f"{good} of {trials}, lower bound {100 * low:.2f} %", low >= 0.997


def median(bar):
    def judge(rows):
        value = sum(r["median_latency_s"] for r in rows) / len(rows)
        return f"{value:.2f} s, {falls(rows)[0]}", value <= bar and falls(rows)[1]
    return judge


def whole_range(rows):
    """Commands of every accepted speed, height and turn: at most one fall in 20 h. Many ask for a speed
    that takes longer than they last."""
    count, hours = sum(r["falls"] for r in rows), sum(r["simulated_s"] for r in rows) / 3600
    return f"{count} falls in {hours:.1f} h", count <= max(1, hours / 20)


def monkey(rows):
    """Ordinary ones, which are also followed."""
    count, hours = sum(r["falls"] for r in rows), sum(r["simulated_s"] for r in rows) / 3600
    share = (sum(r["commands_tracked_fraction"] * r["commands_of_3_s"] for r in rows) /
             sum(r["commands_of_3_s"] for r in rows))
    return (f"{count} falls in {hours:.1f} h, {100 * share:.1f} % tracked",
            count <= hours / 5 and share >= 0.95)


class Row:
    def __init__(self, name, bar, judge, words, trials, chunk):
        self.name, self.bar, self.judge, self.words = name, bar, judge, words
        self.trials, self.chunk = trials, chunk

    def chunks(self, share):
        count = max(1, math.ceil(self.trials * share / self.chunk))
        return [(f"{self.name}#{i}", self.words, self.chunk) for i in range(count)]


def pushes(rows):
    count, trials = sum(r["falls"] for r in rows), sum(r["pushes"] for r in rows)
    low, high = interval(count, trials)
    return (f"{count} falls of {trials} ({100 * low:.2f} to {100 * high:.2f} %), all survive "
            f"{min(r['largest_survived_ns'] for r in rows):.1f} N s"), count == 0


def course(obstacle, bar):
    """Obstacles passed before a trial's end; each fall is one that was not."""
    def judge(rows):
        met, passed = sum(r[obstacle] for r in rows), sum(r["crossed"] for r in rows)
        low, high = interval(passed, met)
        text = f"{passed} of {met} ({100 * low:.2f} to {100 * high:.2f} %), {falls(rows)[0]}"
        return text, met > 0 and passed / met >= bar
    return judge


def apex(rows):
    text, ok = falls(rows)
    off_m = max(abs(r["apex_height_m"] - r["height_m"]) for r in rows)
    return f"{text}, apex off by {100 * off_m:.1f} cm", ok and off_m <= 0.02


def track(rows):
    done, trials = sum(r["completed"] for r in rows), sum(r["trials"] for r in rows)
    heading = max(math.degrees(r["heading_error_rms_rad"]) for r in rows)
    failures = {cause: sum(r["failures"][cause] for r in rows)
                for cause in ("simulation", "curve", "jump")}
    return f"{done} of {trials}, heading {heading:.1f} deg rms, {failures}", done == trials and heading <= 5


def table():
    def gait(name, speed, *words):
        return ["gait", "--gait", name, "--speed", speed, *words]

    rows = []
    for name, speed, impulse in (("step", 0, 16), ("walk", 0.8, 16), ("walk", 1.75, 16),
                                 ("run", 2, 26), ("run", 4, 26), ("run", 6, 26), ("jump", 0.5, 16)):
        rows.append(Row(f"push {impulse} N s, {name} {speed} m/s", "0 falls", pushes,
                        gait(name, speed, "--push", impulse, "--push-directions", 8,
                             "--push-phases", 12), 1, 1))
    for width, bar in ((1.0, 1), (1.5, 0.95)):
        rows.append(Row(f"pits of {width} m, run 3 m/s", f"{100 * bar:.0f} %", course("pits", bar),
                        gait("run", 3, "--pit", width, "--seconds", 60), 16, 4))
    for width in (0.1, 0.3):
        for speed in (0.25, 0.8, 1.75):
            rows.append(Row(f"pits of {width} m, walk {speed} m/s", "all", course("pits", 1),
                            gait("walk", speed, "--pit", width, "--seconds", round(45 / speed)), 20, 5))
    rows.append(Row("pits of 0.5 m, walk 1.75 m/s: stops", "0 falls", falls,
                    gait("walk", 1.75, "--pit", 0.5, "--seconds", 26), 20, 10))
    for name, speed in (("walk", 0.25), ("walk", 1), ("walk", 1.75), ("run", 1), ("run", 2), ("run", 3),
                        ("jump", 0.5), ("jump", 1), ("jump", 2)):
        rows.append(Row(f"steps of 0.1 m, {name} {speed} m/s", "1000 of 1000", course("steps", 1),
                        gait(name, speed, "--step", 0.1, "--seconds", 60 if speed >= 1 else 120),
                        {"run": 20, "jump": 40}.get(name, 60), 10))
    for slope in (5, -5, 10, -10):
        for name, speed in GAITS:
            if abs(slope) == 10 and not (name == "walk" or (name == "run" and speed <= 2.5)):
                continue
            rows.append(Row(f"slope {slope} degrees, {name} {speed} m/s", "0 falls", falls,
                            gait(name, speed, "--slope", slope, "--seconds", 30), 20, 20))
    for name, speed in GAITS:
        rows.append(Row(f"5 degrees a step, {name} {speed} m/s", "0 falls", falls,
                        gait(name, speed, "--turn", 5, "--seconds", 30), 20, 20))
    for name in ("curves", "corners", "pits", "hills", "straight"):
        rows.append(Row(f"track {name}, wrist", "all, heading <= 5 deg rms", track,
                        ["tracks", "--interface", "wrist", "--track", name], 8, 2))
    for height in (0.05, 0.1, 0.3, 0.5, 0.7):
        for speed in (0, 1) if height == 0.7 else (0, 1, 2):
            rows.append(Row(f"jump {height} m, {speed} m/s", "0 falls, apex within 2 cm", apex,
                            gait("jump", speed, "--height", height, "--seconds", 30), 20, 10))
    rows.append(Row("run 3 m/s to walk, latency", "<= 1.2 s", median(1.2),
                    ["transitions", "--from", "run", "--to", "walk", "--from-speed", 3], 200, 100))
    rows.append(Row("run to jump, latency", "<= 0.7 s", median(0.7),
                    ["transitions", "--from", "run", "--to", "jump"], 200, 100))
    rows.append(Row("random commands of the whole range", "20 h, <= 1 fall", whole_range,
                    ["monkey", "--whole-range", "--seconds", 3600], 20, 1))
    rows.append(Row("random commands", "5 h, <= 1 fall, 95 % tracked", monkey,
                    ["monkey", "--seconds", 3600], 5, 1))
    for start, goal in PAIRS:
        rows.append(Row(f"{start} to {goal}", "lower bound >= 99.7 %", transitions,
                        ["transitions", "--from", start, "--to", goal], 1000, 50))
    for name, speed in GAITS:
        rows.append(Row(f"600 s, {name} {speed} m/s", "0 falls, 0.01 m/s", constant,
                        gait(name, speed, "--seconds", 600), 20, 2))
    return rows


def stamp(binaries):
    digest = hashlib.sha256((binaries / "footing-eval").read_bytes())
    for path in sorted(DATA.rglob("*")):
        if path.is_file():
            digest.update(path.read_bytes())
    return digest.hexdigest()


class Results:
    def __init__(self, folder, binaries, seed):
        self.path = folder / "results.json"
        folder.mkdir(parents=True, exist_ok=True)
        kept = json.loads(self.path.read_text()) if self.path.exists() else {}
        if kept.get("programs") != stamp(binaries) or seed not in (None, kept.get("seed")):
            kept = {"programs": stamp(binaries), "chunks": {},
                    "seed": random.SystemRandom().randrange(1, 10**6) if seed is None else seed}
        self.kept = kept

    def add(self, key, row):
        self.kept["chunks"][key] = row
        self.path.with_suffix(".new").write_text(json.dumps(self.kept))
        os.replace(self.path.with_suffix(".new"), self.path)


def chunk_seed(base, key):
    return int.from_bytes(hashlib.sha256(f"{base} {key}".encode()).digest()[:5], "big")


def run_chunk(binaries, base, key, words, trials):
    command = [binaries / "footing-eval", *map(str, words), "--trials", str(trials), "--seed",
               str(chunk_seed(base, key)), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: {done.stderr}")
    return {"trials": trials, **json.loads(done.stdout)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("binaries", type=pathlib.Path)
    parser.add_argument("--folder", type=pathlib.Path)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--minutes", type=float, default=38)
    parser.add_argument("--only", default="", help="rows whose name holds this word")
    parser.add_argument("--share", type=float, default=1, help="of each row's trials")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    results = Results(options.folder or options.binaries.parent / "biped", options.binaries,
                      options.seed)
    rows = [row for row in table() if options.only in row.name]
    work = [chunk for row in rows for chunk in row.chunks(options.share)
            if chunk[0] not in results.kept["chunks"]]
    print(f"seed {results.kept['seed']}, {len(work)} parts to do", flush=True)
    deadline = time.monotonic() + 60 * options.minutes
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        def do(chunk):
            if time.monotonic() < deadline:
                return chunk[0], run_chunk(options.binaries, results.kept["seed"], *chunk)
            return chunk[0], None
        for count, (key, row) in enumerate(pool.map(do, work), 1):
            if row is None:
                continue
            results.add(key, row)
            print(f"[{count}/{len(work)}] {key}", file=sys.stderr, flush=True)
    missed = unfinished = 0
    for row in rows:
        parts = [results.kept["chunks"].get(key) for key, _, _ in row.chunks(options.share)]
        if None in parts:
            unfinished += 1
            continue
        text, ok = row.judge(parts)
        missed += not ok
        print(f"{'ok    ' if ok else 'MISSED'} {row.name}: {text} (bar: {row.bar})")
    print(f"{len(rows)} rows, {missed} missed, {unfinished} unfinished; the same command goes on")
    return 1 if missed or unfinished else 0


if __name__ == "__main__":
    sys.exit(main())
