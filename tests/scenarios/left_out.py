"""Poses of people whom no model has seen: footing-eval pose over recordings, with models of all other people.

Used by scripts/measure-pose, which writes tables of docs/measurements, and by pose_table.py, which holds the pose
engine against its aims. Recordings are those of the folder FOOTING_TEST_DATA.
"""
import concurrent.futures
import functools
import json
import subprocess
import sys
import threading

SEED = 1
TAKES = {"squat": "squat1Reps", "grab high": "grabHighR", "elbow to knee": "elbowToKnee1RepsLelbowStart",
         "throw": "throwBasketball"}
# Of CMU, by subject; of each person of HDM05 the first of each of TAKES.
CMU = {"13": ("13_29", "13_30", "13_31"), "14": ("14_14",)}
HDM05 = ("bd", "bk", "dg")
BASELINES = ("--baselines",)
PAPER = ("--mode", "paper")
WITHOUT_L = ("--mode", "paper", "--ablate", "angular_momentum")
WRONG_WEIGHTS = {"weighed 5 % too heavy": ("--mass-error", "0.05"), "weighed 5 % too light": ("--mass-error", "-0.05")}
WRONG_CELLS = {"5 N of hysteresis": ("--hysteresis-n", "5"), "gains 3 %, 3 N slow, 5 N of hysteresis":
               ("--gain-error", "0.03", "--slow-force-n", "3", "--hysteresis-n", "5")}
SEEDS = (1, 2, 3)
FIVE_MINUTES = ("--loop-minutes", "5")
CELL_ERRORS = ("--gain-error", "0.01", "--slow-force-n", "1.06")
LEARNED = "baselines.hands_feet_learned.mpjpe_cm"  # The error of hands and feet alone, in a row.


def once(function):
    """Calls it once for the same arguments; other threads wait for that."""
    results, lock = {}, threading.Lock()

    @functools.wraps(function)
    def kept(*arguments, **options):
        key = arguments, tuple(sorted(options.items()))
        with lock:
            mine = key not in results
            result = results.setdefault(key, concurrent.futures.Future())
        if mine:
            try:
                result.set_result(function(*arguments, **options))
            except BaseException as error:
                result.set_exception(error)
        return result.result()
    return kept


class Bench:
    """Runs programs of the folder `binaries`, each command once, `jobs` at a time; `models` is the folder of the
    models, which are trained where they are not there yet (a minute each). A clip is (left out, motion, skeleton)."""

    def __init__(self, binaries, data, models, jobs):
        self.binaries, self.data, self.models = binaries, data, models
        self.pool = concurrent.futures.ThreadPoolExecutor(jobs)

    def run(self, program, *words):
        done = subprocess.run([self.binaries / program, *map(str, words), "--json"], capture_output=True, text=True,
                              check=False)
        if done.returncode != 0:
            raise SystemExit(f"error: {program} {' '.join(map(str, words))}: {done.stderr}")
        return json.loads(done.stdout)

    def motions(self, few=False):
        return [word for name in ("cmu_amc", "cmu_amc3", "hdm05")[:1 if few else 3]
                for word in ("--motions", self.data / "mocap" / name)]

    @once
    def model(self, person, kind, few=False):
        """Of all others, or of the few of CMU 1, 11, 13 and 14, trained where it is not there yet."""
        out = self.models / f"{kind}-{person}{'-few' if few else ''}.fmodel"
        if not out.exists():
            print(f"training {out}", file=sys.stderr, flush=True)
            self.run("footing-train", kind, *self.motions(few), "--exclude", person, "--seed", 1, "--out", out)
        return out

    @once
    def one_left_out(self):
        """Every person in turn, with all clips in place, and with true values (ten minutes)."""
        return self.run("footing-train", "people", *self.motions(), "--ablations")

    def cmu(self, clip):
        subject, folder = clip.split("_")[0], self.data / "mocap/cmu_amc"
        return (subject, folder / f"{clip}.amc", folder / f"{subject}_reconstructed.asf")

    def hdm05(self, person, activity):
        folder = self.data / "mocap/hdm05"
        take = sorted(folder.glob(f"HDM_{person}_{TAKES[activity]}_*.amc"))[0]
        return (f"HDM_{person}", take, folder / f"HDM_{person}.asf")

    def people(self):
        """Name -> clips of those people."""
        return {"CMU 13": [self.cmu(clip) for clip in CMU["13"]], "CMU 14": [self.cmu(clip) for clip in CMU["14"]],
                "HDM05": [self.hdm05(person, activity) for person in HDM05 for activity in TAKES]}

    @once
    def pose(self, clip, *words, few=False):
        person, motion, skeleton = clip
        kinds = ["pose"]
        if PAPER[1] in words or "--ablations" in words:
            kinds.append("com")
        if "wiimote" in words:
            kinds.append("arm")
        models = [word for kind in kinds for word in ("--model", self.model(person, kind, few))]
        baselines = () if "--baselines" in words else ("--no-baselines",)
        return self.run("footing-eval", "pose", "--motion", motion, "--skeleton", skeleton, *models, "--seed", SEED,
                        *baselines, *words)

    @once
    def momentum(self, clip, *words):
        """From the loads alone, so no model is left out."""
        _, motion, skeleton = clip
        return self.run("footing-eval", "momentum", "--motion", motion, "--skeleton", skeleton, "--cell-noise-kg", 0.05,
                        "--unlimited", "--seed", SEED, *words)

    @once
    def travel(self, clip, skeleton, *words):
        folder = self.data / "mocap/cmu_amc2"
        return self.run("footing-eval", "pose", "--motion", folder / f"{clip}.amc", "--skeleton", folder / skeleton,
                        "--seed", SEED, "--no-baselines", *words)

    @once
    def markers(self, clip, *words):
        """A person of another laboratory, whom the built-in model has not seen."""
        return self.run("footing-eval", "pose", "--motion", self.data / f"mocap/c3d/{clip}.c3d", "--seed", SEED,
                        "--no-baselines", *words)

    @once
    def plates(self, trial, *words, seed=SEED, still_forces=False):
        folder = self.data / "forces/opencap_s4"
        forces = folder / "ID"
        placed = ("--still-forces", forces / "static1_grf.mot") if still_forces else ()
        return self.run("footing-eval", "pose", "--motion", folder / f"MarkerData/{trial}.trc", "--still",
                        folder / "MarkerData/static1.trc", "--mass-kg", 60, "--boards", "forces", "--forces",
                        forces / f"{trial}_grf.mot", "--seed", seed, *placed, *words)

    def rows(self, clips, words=()):
        return list(self.pool.map(lambda clip: self.pose(clip, *words), clips))

    def plates_of_seeds(self, trial, *words):
        return list(self.pool.map(lambda seed: self.plates(trial, *words, seed=seed), SEEDS))


def field(row, path):
    for part in path.split("."):
        row = row[part]
    return row


def mean(rows, path):
    """Over frames, so that a long clip counts more."""
    total = sum(row["frames"] for row in rows)
    return sum(row["frames"] * field(row, path) for row in rows) / total
