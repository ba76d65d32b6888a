"""footing-eval arm and pose --hands wiimote on a recorded person whom no model has seen.

Usage: arm_command_test.py FOOTING_EVAL FOOTING_TRAIN
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

JUDGED = ("--motion", DATA / "13_30.amc", "--skeleton", DATA / "13_reconstructed.asf")


def run(*arguments):
    return subprocess.run([*map(str, arguments)], capture_output=True, text=True)


class Arm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.folder.name)
        clips = folder / "clips"
        clips.mkdir()
        for name in ("14_14.amc", "14_reconstructed.asf"):
            shutil.copy(DATA / name, clips)
        for kind in ("arm", "pose"):
            done = run(TRAIN, kind, "--motions", clips, "--out", folder / f"{kind}.fmodel")
            assert done.returncode == 0, done.stderr
        cls.arm, cls.pose = folder / "arm.fmodel", folder / "pose.fmodel"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def report(self, *arguments):
        done = run(EVAL, *arguments, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def test_arms_of_another_person(self):
        report = self.report("arm", *JUDGED, "--model", self.arm)
        mean = report["baselines"]["mean_arm"]
        self.assertTrue(report["finite"])
        self.assertLess(report["hand_position_rms_cm"], 30)
        self.assertLess(report["hand_position_rms_cm"], 0.6 * mean["hand_position_rms_cm"])
        self.assertLess(report["shoulder_error_deg"], 0.8 * mean["shoulder_error_deg"])
        self.assertLess(report["elbow_error_deg"], 25)
        self.assertLess(report["inclination_error_deg"], 8)
        other = self.report("arm", *JUDGED, "--model", self.arm, "--seed", 2)
        self.assertNotEqual(other["hand_position_rms_cm"], report["hand_position_rms_cm"])

    def test_straps_on_both_segments_meet_the_aims_without_a_model(self):
        report = self.report("arm", *JUDGED, "--devices", "upper_arm,forearm")
        self.assertLess(report["hand_position_rms_cm"], 6)
        self.assertLess(report["shoulder_error_deg"], 8)
        self.assertLess(report["elbow_error_deg"], 8)
        self.assertGreater(report["nees"], 0.3)
        self.assertLess(report["nees"], 1.5)
        self.assertNotIn("kinematic", report["baselines"])
        perfect = self.report("arm", *JUDGED, "--devices", "upper_arm,forearm", "--perfect")
        self.assertLess(perfect["attitude_error_deg"], 1)
        self.assertLess(perfect["hand_position_rms_cm"], report["hand_position_rms_cm"])

    def test_what_a_fist_does_not_observe_no_better_device_does(self):
        report, perfect, strapped = (self.report("arm", *JUDGED, "--model", self.arm, *more) for more in (
            (), ("--perfect",), ("--devices", "fist,upper_arm")))
        self.assertLess(perfect["attitude_error_deg"], 0.5 * report["attitude_error_deg"])
        self.assertGreater(perfect["hand_position_rms_cm"], 0.8 * report["hand_position_rms_cm"])
        self.assertLess(strapped["hand_position_rms_cm"], 0.85 * report["hand_position_rms_cm"])
        self.assertLess(report["hand_position_rms_cm"], report["baselines"]["kinematic"]["hand_position_rms_cm"])

    def test_what_devices_leave_open_is_measured_where_moments_are_alike(self):
        fist, straps = (self.report("arm", *JUDGED, "--model", self.arm, "--devices", devices)["observability"]
                        for devices in ("fist", "upper_arm,forearm"))
        for open_to in (fist, straps):
            self.assertGreater(open_to["alike_share"], 0.1)
        self.assertGreater(fist["least"]["hand_position_rms_cm"], 3)
        self.assertLess(fist["least"]["hand_position_rms_cm"], 17)
        self.assertLess(fist["observable_share"], 0.9)
        self.assertGreater(straps["observable_share"], 0.95)
        self.assertLess(straps["least"]["hand_position_rms_cm"], 2)
        self.assertLess(straps["in_observable"]["hand_position_rms_cm"], 6)
        self.assertLess(straps["in_observable"]["shoulder_error_deg"], 8)
        self.assertLess(straps["in_observable"]["elbow_error_deg"], 8)

    def test_deviations_stay_right_over_minutes(self):
        report = self.report("arm", *JUDGED, "--model", self.arm, "--loop-minutes", 4)
        self.assertNotIn("observability", report)  # The motion repeats itself.
        quarters = report["nees_quarters"]
        self.assertEqual(len(quarters), 4)
        self.assertLess(max(quarters), 3)  # Of one person who trained.
        self.assertLessEqual(quarters[3], quarters[0])

    def test_devices_that_are_no_arm_are_refused(self):
        for devices in ("forearm", "wrist", "upper_arm"):
            done = run(EVAL, "arm", *JUDGED, "--devices", devices)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("upper_arm", done.stderr)

    def test_wiimotes_help_the_pose_and_a_kinect_more(self):
        error = {}
        for hands in ("none", "wiimote", "straps", "kinect"):
            report = self.report("pose", *JUDGED, "--model", self.pose, "--model", self.arm, "--hands",
                                 hands, "--no-baselines")
            self.assertTrue(report["finite"])
            error[hands] = report["mpjpe_cm"]
        self.assertLess(error["wiimote"], 0.85 * error["none"])
        self.assertLess(error["kinect"], error["wiimote"])
        self.assertLess(error["straps"], 0.9 * error["wiimote"])

    def test_networks_that_receive_their_own_estimates_are_compared(self):
        folder = pathlib.Path(self.folder.name)
        names = []
        for kind in ("paper", "residual"):
            name = folder / f"{kind}.fmodel"
            done = run(TRAIN, "arm", "--kind", kind, "--motions", folder / "clips", "--out", name)
            self.assertEqual(done.returncode, 0, done.stderr)
            names += ["--network", name]
        report = self.report("arm", *JUDGED, "--model", self.arm, *names)
        networks = report["networks"]
        self.assertEqual(set(networks), {"arm_paper", "arm_residual"})
        for scores in (*networks.values(), report, report["baselines"]["mean_arm"]):
            self.assertEqual(len(scores["hand_position_rms_halves_cm"]), 2)
        self.assertLess(networks["arm_residual"]["hand_position_rms_cm"],
                        networks["arm_paper"]["hand_position_rms_cm"])
        self.assertLess(report["hand_position_rms_cm"], networks["arm_residual"]["hand_position_rms_cm"])
        done = run(EVAL, "arm", "--motion", DATA / "13_30.amc", "--skeleton", DATA / "13_reconstructed.asf",
                   "--model", self.arm, "--network", self.arm)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("kind", done.stderr)

    def test_is_never_judged_on_whom_it_was_trained_on(self):
        done = run(EVAL, "arm", "--motion", DATA / "14_14.amc", "--skeleton",
                   DATA / "14_reconstructed.asf", "--model", self.arm)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("14", done.stderr)
        done = run(EVAL, "arm", *JUDGED, "--model", self.pose)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("kind", done.stderr)


if __name__ == "__main__":
    unittest.main()
