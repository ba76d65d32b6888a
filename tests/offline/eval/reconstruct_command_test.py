"""footing-eval reconstruct on a laboratory's trial: the files that it writes, and its table of errors.

Usage: reconstruct_command_test.py FOOTING_EVAL
"""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

EVAL = sys.argv.pop(1)
DATA = pathlib.Path(os.environ.get("FOOTING_TEST_DATA") or "/nowhere")
TRIALS = DATA / "forces" / "opencap_s4"
if not TRIALS.is_dir():
    print("skipped: FOOTING_TEST_DATA has no forces/opencap_s4")
    sys.exit(77)


def table(path):
    """The columns of a MOT file."""
    lines = path.read_text().split("endheader\n")[1].splitlines()
    rows = [[float(cell) for cell in line.split()] for line in lines[1:]]
    return dict(zip(lines[0].split(), zip(*rows)))


class Reconstruct(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def run_on(self, trial, *more, ik=None):
        return subprocess.run(
            [EVAL, "reconstruct", "--motion", TRIALS / "MarkerData" / f"{trial}.trc",
             "--still", TRIALS / "MarkerData" / "static1.trc", "--mass-kg", "60",
             "--ik", TRIALS / "IK" / f"{ik or trial}_ik.mot", "--out", self.folder, *map(str, more)],
            capture_output=True, text=True)

    def test_squats_on_plates_become_files_and_a_table_of_errors(self):
        done = self.run_on("squats1", "--forces", TRIALS / "ID" / "squats1_grf.mot", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads(done.stdout)
        self.assertEqual(
            sorted(pathlib.Path(path).name for path in report["files"]),
            sorted(["squats1_markers." + form for form in ("mot", "trc", "c3d", "bvh")] +
                   ["squats1_engine." + form for form in ("mot", "trc", "c3d", "bvh")] +
                   ["squats1_engine_grf.mot", "squats1_engine_angles.csv", "squats1_markers_angles.csv"]))
        # The change from standing of the fitted body is that of the laboratory's own model.
        errors = report["errors"]
        lab = errors["markers_against_ik"]["angles_since_standing"]
        for angle, most in (("pelvis_tilt", 3), ("hip_flexion", 5), ("hip_adduction", 5), ("knee_angle", 4)):
            self.assertLess(lab[angle]["rmse_deg"], most, angle)
        self.assertNotIn("known_share", lab["hip_flexion"])
        self.assertLess(lab["hip_rotation"]["known_share"], 1)
        own = errors["engine_against_markers"]
        self.assertLess(own["angles_since_standing"]["knee_angle"]["rmse_deg"], 20)
        self.assertIn("rmse_deg", errors["engine_against_ik"]["angles_since_standing"]["pelvis_tilt"])
        # The files are on the laboratory's clock and in its place: within 20 cm of the markers' pelvis.
        engine, markers = (table(self.folder / f"squats1_{name}.mot") for name in ("engine", "markers"))
        self.assertAlmostEqual(engine["time"][0], report["begin_s"], places=5)
        self.assertEqual(len(engine["time"]), report["frames"])
        for axis in ("pelvis_tx", "pelvis_ty", "pelvis_tz"):
            at = min(range(len(markers["time"])), key=lambda i: abs(markers["time"][i] - engine["time"][300]))
            self.assertLess(abs(engine[axis][300] - markers[axis][at]), 0.2, axis)
        # For plots: change from standing first, and nothing for the turn of a straight leg.
        with (self.folder / "squats1_markers_angles.csv").open() as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0])[:3], ["time_s", "valid", "pelvis_tilt_change_deg"])
        self.assertLess(abs(float(rows[5]["knee_angle_r_change_deg"])), 8)
        bent = max(rows, key=lambda row: float(row["knee_angle_r_deg"]))
        self.assertGreater(float(bent["hip_flexion_r_change_deg"]), 80)
        self.assertEqual((rows[5]["hip_rotation_r_deg"], rows[5]["hip_rotation_r_change_deg"]), ("", ""))
        self.assertNotEqual(bent["hip_rotation_r_change_deg"], "")
        forces = table(self.folder / "squats1_engine_grf.mot")
        self.assertEqual(forces["time"], engine["time"])
        mean_n = sum(forces["ground_force_r_vy"] + forces["ground_force_l_vy"]) / len(forces["time"])
        self.assertAlmostEqual(mean_n, 60 * 9.81, delta=20)
        # What was written is there, and is read again.
        again = self.run_on("squats1")
        self.assertEqual(again.returncode, 2, again.stderr)
        self.assertIn("--force", again.stderr)
        read = subprocess.run([EVAL, "reconstruct", "--motion", self.folder / "squats1_engine.bvh", "--out",
                               self.folder / "again", "--format", "mot"], capture_output=True, text=True)
        self.assertEqual(read.returncode, 0, read.stderr)

    def test_a_table_of_other_times_is_refused(self):
        done = self.run_on("STS1", "--format", "mot", ik="DJ1")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("do not cover the trial's", done.stderr)
        self.assertEqual(list(self.folder.glob("*")), [])


if __name__ == "__main__":
    unittest.main()
