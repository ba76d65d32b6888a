"""footing-eval fusion on recorded squats: boards help where a camera loses the legs.

The built-in model has seen these people, so one is trained on others.

Usage: fusion_command_test.py FOOTING_EVAL FOOTING_TRAIN
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from xml.etree import ElementTree

EVAL, TRAIN = sys.argv.pop(1), sys.argv.pop(1)
DATA = pathlib.Path(os.environ.get("FOOTING_TEST_DATA") or "/nowhere") / "mocap" / "hdm05"
if not DATA.is_dir():
    print("skipped: FOOTING_TEST_DATA has no mocap/hdm05")
    sys.exit(77)


def run(person, clip, *arguments):
    arguments = ("--model", Fusion.model, *arguments)
    done = subprocess.run([EVAL, "fusion", "--motion", DATA / f"HDM_{person}_squat1Reps_{clip}_120.amc", "--skeleton",
                           DATA / f"HDM_{person}.asf", "--json", *map(str, arguments)],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


class Fusion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.model = pathlib.Path(cls.folder.name) / "others.fmodel"
        done = subprocess.run([TRAIN, "pose", "--motions", DATA.parent / "cmu_amc", "--out", cls.model],
                              capture_output=True, text=True)
        assert done.returncode == 0, done.stderr

    def test_boards_help_where_the_legs_are_lost_over_three_people(self):
        ways = ("skeleton", "skeleton_solved", "boards_and_hands", "fused")
        hips, hidden = dict.fromkeys(ways, 0), dict.fromkeys(ways, 0)
        clips = (("bd", "007"), ("bk", "019"), ("dg", "031"), ("bd", "001"))
        for seed, (person, clip) in enumerate(clips, 1):
            report = run(person, clip, "--seed", seed)
            self.assertGreater(report["squat_frames"], 30)
            for way in ways:
                hips[way] += report[way]["hip_cm"]
                hidden[way] += report[way]["hidden_cm"]
        self.assertLess(hips["fused"], 0.5 * hips["skeleton"])
        self.assertLess(hidden["fused"], 0.75 * hidden["skeleton"])
        self.assertLess(hips["fused"], 0.75 * hips["boards_and_hands"])

    def test_from_the_side_one_limb_hides_the_other(self):
        report = run("bd", "007", "--camera-yaw-deg", 90, "--squat-share", 0.3)
        self.assertGreater(report["hidden_joints"], 100)
        self.assertLess(report["hidden_ratio"], 1)

    def test_boards_do_not_cost_what_crossed_arms_hide(self):
        done = subprocess.run([EVAL, "fusion", "--motion", pathlib.Path(__file__).parent / "crossed_arms.json", "--json"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads(done.stdout)
        self.assertEqual(report["squat_frames"], 0)
        self.assertGreater(report["hidden_joints"], 100)
        self.assertLess(report["hidden_ratio"], 0.5)

    def test_figure_7_has_the_skeleton_alone_beside_the_fused_pose(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "figure7.svg"
            run("bd", "007", "--figure", path)
            figure = path.read_text()
            run("bd", "007", "--figure", path)
            self.assertEqual(path.read_text(), figure)  # Same seed, same bits.
        ElementTree.fromstring(figure)
        self.assertIn("Kinect alone", figure)
        self.assertIn("with the boards", figure)
        self.assertNotIn("nan", figure)

    def test_no_frame_is_a_squat_below_a_height_that_nobody_reaches(self):
        report = run("bd", "001", "--squat-share", 0.3)
        self.assertEqual(report["squat_frames"], 0)
        self.assertEqual(report["hip_ratio"], 0)

    def test_a_motion_that_is_missing_is_said(self):
        done = subprocess.run([EVAL, "fusion", "--motion", "none.bvh"], capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("none.bvh", done.stderr)


if __name__ == "__main__":
    unittest.main()
