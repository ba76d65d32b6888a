"""footing-eval pose on trials with measured force plates, by activity, and after lift-offs.

Usage: pose_plates_test.py FOOTING_EVAL FOOTING_TRAIN
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

EVAL, TRAIN = sys.argv.pop(1), sys.argv.pop(1)
DATA = pathlib.Path(os.environ.get("FOOTING_TEST_DATA") or "/nowhere")
TRIALS = DATA / "forces" / "opencap_s4"
if not TRIALS.is_dir():
    print("skipped: FOOTING_TEST_DATA has no forces/opencap_s4")
    sys.exit(77)


def judge(*flags):
    return subprocess.run([EVAL, "pose", "--no-baselines", "--cell-noise-kg", "0.05", "--json", *map(str, flags)],
                          capture_output=True, text=True)


def trial(name):
    return ("--motion", TRIALS / "MarkerData" / f"{name}.trc", "--still", TRIALS / "MarkerData" / "static1.trc",
            "--mass-kg", "60")


def plates(name):
    return ("--boards", "forces", "--forces", TRIALS / "ID" / f"{name}_grf.mot")


class Plates(unittest.TestCase):
    def report(self, *flags):
        done = judge(*flags)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("NaN", done.stdout)
        self.assertNotIn("null", done.stdout)
        return json.loads(done.stdout), done.stderr

    def refused(self, code, said, *flags):
        done = judge(*flags)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertEqual(done.stderr.count("\n"), 1)
        self.assertIn(said, done.stderr)

    def test_drive_the_boards_under_squats(self):
        report, said = self.report(*trial("squats1"), *plates("squats1"))
        self.assertEqual(said, "")
        told = report["plates"]
        feet = {use["plate"]: use for use in told["of_feet"]}
        # The lab's first plate is at the subject's right, the second at the left, the third behind.
        self.assertGreater(feet["ground_force_1_"]["right_s"], 13)
        self.assertEqual(feet["ground_force_1_"]["left_s"], 0)
        self.assertGreater(feet["ground_force_2_"]["left_s"], 13)
        self.assertEqual(feet["ground_force_3_"]["left_s"] + feet["ground_force_3_"]["right_s"], 0)
        self.assertAlmostEqual(told["mass_kg"], 60.1, delta=0.1)
        self.assertEqual(told["carried_share"], 1)
        self.assertLess(told["force_rms_percent"], 1.7)
        self.assertLessEqual(told["force_own_mass_rms_percent"], told["force_rms_percent"])
        self.assertLess(report["mpjpe_cm"], 7)
        self.assertLess(abs(report["mpjpe_cm"] - told["simulated"]["mpjpe_cm"]), 1)
        self.assertLess(report["com_vertical_rms_cm"], 4)  # Of 11.5 cm that the squats are deep.
        self.assertLess(told["offline"]["com_vertical_rms_cm"], 2)
        self.assertLess(report["com_lateral_rms_cm"], 1)
        self.assertNotEqual(report["com_vertical_rms_cm"], told["simulated"]["com_vertical_rms_cm"])
        # The plates' own force needs no masses of segments: forwards it is where the estimate is, and 2.6 cm
        # behind the COM of the markers.
        by_force = told["by_force"]
        self.assertLess(by_force["com_forward_rms_cm"], 2)
        self.assertLess(abs(by_force["com_forward_bias_cm"]), 0.2)
        self.assertAlmostEqual(by_force["markers_bias_cm"][0], 2.6, delta=0.2)
        self.assertLess(by_force["markers_rms_cm"][1], 0.2)
        self.assertLess(by_force["markers_rms_cm"][2], 1)
        squats = {row["activity"]: row for row in report["by_activity"]}
        self.assertGreater(squats["bent"]["frames"] + squats.get("crouched", {"frames": 0})["frames"], 200)
        self.assertEqual(report["lift_offs"], 0)
        # The change from the person's own standing; nothing of the arms, which have no such change.
        since = report["angles_since_standing"]
        self.assertNotIn("arm_flex", since)
        self.assertLess(since["hip_adduction"]["rmse_deg"], 8)
        self.assertLess(since["hip_rotation"]["known_share"], 1)
        self.assertNotIn("known_share", since["knee_angle"])
        belt, _ = self.report(*trial("squats1"), *plates("squats1"), "--belt")
        self.assertLess(belt["angles_since_standing"]["pelvis_tilt"]["rmse_deg"], 5)
        self.assertLess(belt["angles_since_standing"]["pelvis_tilt"]["rmse_deg"], since["pelvis_tilt"]["rmse_deg"] / 3)

    def test_are_put_under_the_body_by_standing_still(self):
        squats = (*trial("squats1"), *plates("squats1"))
        still = ("--still-forces", TRIALS / "ID" / "static1_grf.mot")
        before, _ = self.report(*squats)
        after, _ = self.report(*squats, *still)
        # static1 has C 1.7 cm ahead of the plates' COP.
        moved = after["plates"]["cop_forward_bias_cm"] - before["plates"]["cop_forward_bias_cm"]
        self.assertAlmostEqual(moved, 1.7, delta=0.1)
        self.assertLess(abs(after["com_forward_bias_cm"]), abs(before["com_forward_bias_cm"]) - 1)
        self.assertLess(after["com_forward_rms_cm"], before["com_forward_rms_cm"])
        moving = TRIALS / "MarkerData" / "squats1.trc"
        self.refused(4, "moves", "--motion", moving, "--still", moving, *plates("squats1"), "--still-forces",
                     TRIALS / "ID" / "squats1_grf.mot", "--mass-kg", "60")
        self.refused(2, "goes with", *trial("squats1"), *still)

    def test_say_what_a_chair_carries(self):
        report, said = self.report(*trial("STS1"), *plates("STS1"))
        self.assertLess(report["plates"]["carried_share"], 0.8)
        self.assertIn("chair", said)
        self.assertIn("chair", report["plates"]["warnings"][0])

    def test_carry_a_body_that_comes_out_of_the_air(self):
        report, _ = self.report(*trial("DJ1"), *plates("DJ1"))
        self.assertLess(report["mpjpe_cm"], 15)
        # Nobody is on the boards before, and the smoothers integrate.
        self.assertEqual(list(report["plates"]["offline"]), ["left_out"])

    def test_are_refused_where_they_cannot_be_of_the_trial(self):
        squats = trial("squats1")
        self.refused(4, "cannot open", *squats, "--boards", "forces", "--forces", "nowhere.mot")
        self.refused(4, "no ground forces", *squats, "--boards", "forces", "--forces",
                     TRIALS / "IK" / "squats1_ik.mot")
        self.refused(2, "go together", *squats, "--boards", "forces")
        self.refused(2, "go together", *squats, *plates("squats1")[2:])
        self.refused(2, "loop", *squats, *plates("squats1"), "--loop-minutes", "1")
        self.refused(4, "nearer foot", *trial("walking1"), *plates("squats1"))
        with tempfile.TemporaryDirectory() as folder:
            head, rows = (TRIALS / "ID" / "squats1_grf.mot").read_text().split("endheader\n")
            lines = rows.splitlines()
            moved = [lines[0]] + ["\t".join([str(float(line.split()[0]) + 500), *line.split()[1:]]) for line in lines[1:]]
            later = pathlib.Path(folder) / "later.mot"
            later.write_text(head + "endheader\n" + "\n".join(moved) + "\n")
            self.refused(4, "in common", *squats, "--boards", "forces", "--forces", later)


class Activities(unittest.TestCase):
    CLIP = ("--motion", DATA / "mocap" / "cmu_amc" / "13_31.amc", "--skeleton",
            DATA / "mocap" / "cmu_amc" / "13_reconstructed.asf")

    def test_rules_and_lift_offs(self):
        with tempfile.TemporaryDirectory() as folder:
            labels = pathlib.Path(folder) / "labels.csv"
            labels.write_text("begin_s,end_s,activity\n1,3,first\n3,5,second\n")
            model = ("--model", self.model(folder))
            ruled = json.loads(self.checked(*self.CLIP, *model))
            labelled = json.loads(self.checked(*self.CLIP, *model, "--activities", labels))
            bad = pathlib.Path(folder) / "bad.csv"
            bad.write_text("begin_s,end_s,activity\n3,1,first\n")
            done = judge(*self.CLIP, *model, "--activities", bad)
            self.assertEqual(done.returncode, 4)
            self.assertIn("line 2", done.stderr)
        names = {row["activity"] for row in ruled["by_activity"]}
        self.assertLessEqual({"airborne", "one_foot", "bent", "crouched", "arms", "still"}, names)
        self.assertEqual(sum(row["frames"] for row in ruled["by_activity"]), ruled["frames"])
        mean = sum(row["frames"] * row["mpjpe_cm"] for row in ruled["by_activity"]) / ruled["frames"]
        self.assertAlmostEqual(mean, ruled["mpjpe_cm"], delta=1e-6)
        self.assertEqual([(row["activity"], row["frames"]) for row in labelled["by_activity"]],
                         [("first", 120), ("second", 120)])
        rows = ruled["lift_off"]
        self.assertEqual([row["after_s"] for row in rows], [0.25, 0.5, 1, 2])
        self.assertGreater(rows[0]["count"], 3)
        self.assertGreaterEqual(ruled["lift_offs"], rows[0]["count"])
        self.assertGreaterEqual(rows[0]["count"], rows[1]["count"])
        self.assertGreater(rows[1]["foot_sd_cm"], rows[0]["foot_sd_cm"], "the longer in the air the less sure")
        self.assertGreater(ruled["aloft"]["nees"], 0.3)
        self.assertLess(ruled["aloft"]["nees"], 2)
        self.assertGreater(ruled["kick"]["kicks"], 0)

    def model(self, folder):
        """Of people other than the one who is judged."""
        out = pathlib.Path(folder) / "pose.fmodel"
        done = subprocess.run([TRAIN, "pose", "--motions", DATA / "mocap" / "cmu_amc", "--exclude", "13", "--out", out],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return out

    def checked(self, *flags):
        done = judge(*flags)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout


if __name__ == "__main__":
    unittest.main()
