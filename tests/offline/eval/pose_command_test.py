"""footing-eval pose on recorded people: what it reports, what it refuses, and that models help.

Usage: pose_command_test.py FOOTING_EVAL FOOTING_TRAIN
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

EVAL, TRAIN = sys.argv.pop(1), sys.argv.pop(1)
DATA = pathlib.Path(os.environ.get("FOOTING_TEST_DATA") or "/nowhere") / "mocap" / "cmu_amc"
if not DATA.is_dir():
    print("skipped: FOOTING_TEST_DATA has no mocap/cmu_amc")
    sys.exit(77)

FIELDS = ("frames rate_hz mpjpe_cm mpjpe_p95_cm mpjpe_root_relative_cm mpjpe_legs_cm mpjpe_torso_cm "
          "mpjpe_arms_cm joint_angle_error_deg com_vertical_rms_cm com_horizontal_rms_cm "
          "com_vertical_drift_cm_per_min com_horizontal_drift_cm_per_min foot_skate_cm_per_s "
          "foot_position_rms_cm contact_f1 landing_delay_ms solve_us_p50 solve_us_p99 hip_swing_deg "
          "hip_twist_deg hip_twist_bent_deg hip_about_mean_deg hip_flexion_deg hip_abduction_deg "
          "hip_rotation_deg pelvis_deg thigh_direction_deg joint_angles "
          "link_orientations bent_frames baselines").split()


def run(*arguments):
    return subprocess.run([*map(str, arguments)], capture_output=True, text=True)


class Pose(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.models = {}
        # One clip to learn from, of another person than the one that is judged.
        clips = pathlib.Path(cls.folder.name) / "clips"
        clips.mkdir()
        for name in ("13_31.amc", "13_reconstructed.asf"):
            shutil.copy(DATA / name, clips)
        for kind in ("basis", "pose"):
            cls.models[kind] = pathlib.Path(cls.folder.name) / f"{kind}.fmodel"
            done = run(TRAIN, kind, "--motions", clips, "--out", cls.models[kind])
            assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def judge(self, kind, *flags, motion="11_01", skeleton="11"):
        done = run(EVAL, "pose", "--motion", DATA / f"{motion}.amc", "--skeleton",
                   DATA / f"{skeleton}.asf", "--model", self.models[kind], "--json", *flags)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def test_reports_every_field_as_a_finite_number(self):
        for mode in ("best", "paper"):
            report = self.judge("pose", "--mode", mode)
            for field in FIELDS:
                self.assertIn(field, report)
            self.assertTrue(report["finite"])
            self.assertNotIn("NaN", json.dumps(report))
            self.assertNotIn("null", json.dumps(report))
            # Nobody has shown this model a walk, and the best mode says so.
            unsure = report["invalid_frames"] / report["frames"]
            self.assertTrue(0 < unsure < 0.5 if mode == "best" else unsure == 0, unsure)
            self.assertAlmostEqual(report["valid_fraction"], 1 - unsure)
            self.assertLessEqual(report["longest_invalid_s"] * report["rate_hz"], report["invalid_frames"] + 1e-6)

    def test_fits_another_skeleton_to_the_layout_of_the_model(self):
        done = run(EVAL, "pose", "--motion", DATA.parent / "mass_bvh" / "walk.bvh", "--model", self.models["pose"],
                   "--no-baselines", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("fitted to the standard layout", done.stderr)
        self.assertGreater(json.loads(done.stdout)["frames"], 30)

    def test_boards_and_hands_tell_more_than_hands_and_feet_and_those_more_than_a_mean(self):
        report = self.judge("pose")
        ik = report["baselines"]["hands_feet_ik"]["mpjpe_cm"]
        self.assertLess(report["mpjpe_cm"], ik)
        self.assertLess(ik, report["baselines"]["mean_pose"]["mpjpe_cm"])

    def test_the_truth_in_place_of_an_estimate_makes_the_pose_better(self):
        without = self.judge("pose", "--no-baselines")["mpjpe_cm"]
        known = self.judge("pose", "--no-baselines", "--oracle", "com", "--oracle", "feet")["mpjpe_cm"]
        self.assertLess(known, 0.8 * without)

    def test_a_tracked_head_makes_the_pose_better_and_not_the_baselines(self):
        without = self.judge("pose")
        more = self.judge("pose", "--head", "sphere", "--belt")
        self.assertLess(more["mpjpe_torso_cm"], 0.9 * without["mpjpe_torso_cm"])
        self.assertEqual(more["baselines"], without["baselines"])
        self.assertEqual((more["head"], more["belt"]), ("sphere", True))

    def test_refuses_a_head_where_there_is_another_or_no_use_of_it(self):
        clip = ["--motion", DATA / "11_01.amc", "--skeleton", DATA / "11.asf"]
        for flags in (["--head", "sphere", "--hands", "kinect"], ["--belt", "--mode", "paper"]):
            done = run(EVAL, "pose", *clip, *flags)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("--head", done.stderr)

    def test_parts_of_the_hips_error_are_parts_of_it(self):
        for flags in ((), ("--oracle", "com", "--oracle", "feet")):
            report = self.judge("pose", "--no-baselines", *flags)
            hip = report["joint_angle_error_deg"]["hip"]
            swing, twist = report["hip_swing_deg"], report["hip_twist_deg"]
            # A turn moves no direction by more than its angle, and is no more than both together.
            self.assertGreaterEqual(hip, swing)
            self.assertLessEqual(hip, swing + twist)
            self.assertLessEqual(swing, report["pelvis_deg"] + report["thigh_direction_deg"])
            self.assertGreater(twist, 1)

    def test_every_exported_angle_has_its_error(self):
        report = self.judge("pose", "--no-baselines")
        self.assertEqual(sorted(report["joint_angles"]), sorted(
            "pelvis_tilt pelvis_list pelvis_rotation hip_flexion hip_adduction hip_rotation knee_angle ankle_angle "
            "lumbar_extension lumbar_bending lumbar_rotation arm_flex arm_add arm_rot elbow_flex".split()))
        self.assertEqual(sorted(report["link_orientations"]),
                         sorted("pelvis chest head upper_arm forearm hand thigh shank foot".split()))
        bent = report["bent_frames"] / report["frames"]
        self.assertTrue(0 < bent < 1, bent)  # A walk and a kick.
        for angle in [*report["joint_angles"].values(), *report["link_orientations"].values()]:
            self.assertGreater(angle["rmse_deg"], 0.5)
            parts = (1 - bent) * angle["rmse_upright_deg"] ** 2 + bent * angle["rmse_bent_deg"] ** 2
            self.assertAlmostEqual(angle["rmse_deg"] ** 2, parts, places=6)
            self.assertGreater(angle["rmse_valid_deg"], 0)
        knee = report["joint_angles"]["knee_angle"]
        self.assertGreater(knee["true_range_deg"], 40)
        self.assertLessEqual(abs(knee["mean_error_deg"]), knee["rmse_deg"])
        # A true knee has no error but that of the hips and feet about it.
        self.assertLess(self.judge("pose", "--no-baselines", "--oracle", "com", "--oracle", "feet")
                        ["joint_angles"]["knee_angle"]["rmse_deg"], knee["rmse_deg"])

    def test_wrong_boards_make_it_worse(self):
        right = self.judge("pose", "--no-baselines")
        wrong = self.judge("pose", "--no-baselines", "--gap-error-m", "0.1", "--yaw-error-deg", "20")
        self.assertGreater(wrong["mpjpe_cm"], right["mpjpe_cm"])
        self.assertGreater(wrong["foot_position_rms_cm"], right["foot_position_rms_cm"] + 2)

    def test_a_wrong_weight_is_found(self):
        right = self.judge("pose", "--no-baselines")["mass_kg"]
        heavy = self.judge("pose", "--no-baselines", "--mass-error", "0.02")["mass_kg"]
        self.assertAlmostEqual(heavy, right, delta=0.3 * 0.02 * right)

    def test_slow_motion_lasts_longer(self):
        leave = 90  # Frames in which the T-pose is left, at any speed.
        fast, slow = (self.judge("pose", "--speed", speed)["frames"] - leave for speed in ("1", "0.5"))
        self.assertAlmostEqual(slow, 2 * fast, delta=3)
        refused = run(EVAL, "pose", "--motion", DATA / "11_01.amc", "--skeleton", DATA / "11.asf", "--speed", "0.5",
                      "--boards", "forces", "--forces", "plates.mot")
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("--speed", refused.stderr)

    def test_the_same_seed_gives_the_same_and_another_does_not(self):
        first, again = (self.judge("pose", "--no-baselines", "--seed", "3")["mpjpe_cm"] for _ in "ab")
        self.assertEqual(first, again)
        self.assertNotEqual(first, self.judge("pose", "--no-baselines", "--seed", "4")["mpjpe_cm"])

    def test_refuses_a_model_of_the_same_person(self):
        done = run(EVAL, "pose", "--motion", DATA / "13_29.amc", "--skeleton",
                   DATA / "13_reconstructed.asf", "--model", self.models["pose"], "--json")
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(done.stdout, "")
        self.assertIn("13", done.stderr)

    def test_refuses_a_take_that_trained_the_model_under_any_name(self):
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder) / "99_01.amc"
            shutil.copy(DATA / "13_31.amc", copy)
            done = run(EVAL, "pose", "--motion", copy, "--skeleton", DATA / "13_reconstructed.asf", "--model",
                       self.models["pose"])
        self.assertEqual(done.returncode, 4)
        self.assertIn("99_01.amc itself", done.stderr)

    def test_judges_a_persons_own_model_on_another_take_only(self):
        own = (EVAL, "pose", "--skeleton", DATA / "13_reconstructed.asf", "--model", self.models["pose"],
               "--same-person", "--no-baselines", "--json", "--motion")
        done = run(*own, DATA / "13_30.amc")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(json.loads(done.stdout)["frames"], 1000)
        done = run(*own, DATA / "13_31.amc")
        self.assertEqual(done.returncode, 4)
        self.assertIn("13_31.amc itself", done.stderr)

    def test_says_what_is_not_there(self):
        base = (EVAL, "pose", "--motion", DATA / "11_01.amc", "--skeleton", DATA / "11.asf")
        for flags, said in ((("--hands", "wiimote"), "footing-train arm"), (("--boards", "forces"), "forces"),
                            (("--constant", "width=3"), "prior_weight"),
                            (("--mode", "paper", "--lag-ms", "100"), "lag"),
                            (("--model", self.models["basis"], "--model", self.models["pose"]),
                             "give one of the two")):
            more = () if "--model" in map(str, flags) else ("--model", self.models["pose"])
            done = run(*base, *more, *flags)
            self.assertNotEqual(done.returncode, 0, flags)
            self.assertIn(said, done.stderr)
        idle = run(*base, "--model", self.models["pose"], "--still", "static.trc")
        self.assertEqual(idle.returncode, 2)
        self.assertIn("--still static.trc would have no effect", idle.stderr)
        nothing = run(EVAL, "pose", "--motion", "demo")
        self.assertEqual(nothing.returncode, 2)
        self.assertIn("or a script, .json", nothing.stderr)


if __name__ == "__main__":
    unittest.main()
