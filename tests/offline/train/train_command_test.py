"""footing-train on made tables: what it reports, what it writes, what it refuses.

Usage: train_command_test.py FOOTING_TRAIN
"""
import hashlib
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1)


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)


# Name, parent, offset in cm (x left, y up, z ahead): the least that is a person.
JOINTS = [("Hips", None, (0, 95, 0)), ("Spine", "Hips", (0, 20, 0)), ("Neck", "Spine", (0, 30, 0))]
for side, sign in (("Left", 1), ("Right", -1)):
    JOINTS += [(side + "UpLeg", "Hips", (9 * sign, -5, 0)), (side + "Leg", side + "UpLeg", (0, -42, 0)),
               (side + "Foot", side + "Leg", (0, -42, 0)), (side + "ToeBase", side + "Foot", (0, -5, 14)),
               (side + "Arm", "Spine", (18 * sign, 28, 0)), (side + "ForeArm", side + "Arm", (28 * sign, 0, 0)),
               (side + "Hand", side + "ForeArm", (26 * sign, 0, 0))]


def bvh(seed, frames=400):
    """Someone who leans, sways and bends the trunk, at 60 Hz."""
    lines, order = ["HIERARCHY"], []

    def write(name, parent, offset, depth):
        pad = "  " * depth
        order.append(name)
        channels = "3 Zrotation Xrotation Yrotation"
        if parent is None:
            channels = "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
        lines.extend([f"{pad}{'ROOT' if parent is None else 'JOINT'} {name}", pad + "{",
                      f"{pad}  OFFSET {offset[0]} {offset[1]} {offset[2]}", f"{pad}  CHANNELS {channels}"])
        children = [joint for joint in JOINTS if joint[1] == name]
        for child in children:
            write(*child, depth + 1)
        if not children:
            lines.extend([pad + "  End Site", pad + "  {", f"{pad}    OFFSET 0 5 0", pad + "  }"])
        lines.append(pad + "}")

    write(*JOINTS[0], 0)
    lines += ["MOTION", f"Frames: {frames}", "Frame Time: 0.0166667"]
    draw = random.Random(seed)
    waves = [[(draw.uniform(0.1, 0.8), draw.uniform(0, 6.28)) for _ in range(3)] for _ in range(3)]
    for t in range(frames):
        side, ahead, bend = (sum(math.sin(6.28 * f * t / 60 + p) for f, p in wave) for wave in waves)
        row = [2 * side, 95, 1.5 * ahead, 0, 0, 0]
        for name in order[1:]:
            row += [0, 6 * bend if name == "Spine" else 0, 0]
        lines.append(" ".join(f"{value:.5f}" for value in row))
    return "\n".join(lines) + "\n"


class Train(unittest.TestCase):
    def setUp(self):
        self.holder = tempfile.TemporaryDirectory()
        self.addCleanup(self.holder.cleanup)
        self.folder = pathlib.Path(self.holder.name)
        self.data = self.folder / "curve.csv"
        draw = random.Random(1)
        rows = ["# made", "a,b,y"]
        for _ in range(600):
            a, b = draw.uniform(-1, 1), draw.uniform(-1, 1)
            rows.append(f"{a:.6f},{b:.6f},{math.sin(3 * a) + a * b:.6f}")
        self.data.write_text("\n".join(rows) + "\n")
        self.out = self.folder / "curve.fmodel"

    def train(self, kind, *more):
        return run(kind, "--data", self.data, "--inputs", 2, "--out", self.out, *more)

    def refused(self, code, words, *arguments):
        result = run(*arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertIn(words, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertNotIn("\n", result.stderr.strip())

    def test_cascade_reports_and_repeats_its_bits(self):
        result = self.train("cascade", "--seed", 7, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(result.stdout)
        self.assertEqual(
            list(report), ["hidden_units", "epochs", "train_mse", "validation_mse", "seconds"])
        self.assertGreaterEqual(report["hidden_units"], 3)
        self.assertLess(report["validation_mse"], 1e-3)  # The best plane leaves 0.2.
        first = self.out.read_bytes()
        # The last 34 bytes are the checksum of the rest, with its head.
        self.assertEqual(first[-32:], hashlib.sha256(first[:-34]).digest())
        self.assertIn(hashlib.sha256(self.data.read_bytes()).digest(), first)
        self.assertIn(b"--seed 7", first)
        again = self.train("cascade", "--seed", 7, "--json", "--force")
        self.assertEqual(json.loads(again.stdout)["epochs"], report["epochs"])
        self.assertEqual(self.out.read_bytes().replace(b" --force", b"")[-400:-34], first[-400:-34])

    def test_mlp_stops_at_an_equal_error(self):
        result = self.train("mlp", "--mse-goal", 0.02, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(result.stdout)
        self.assertTrue(report["goal_reached"])
        self.assertLessEqual(report["validation_mse"], 0.02)
        self.assertGreater(report["epochs"], 0)

    def test_noise_on_fed_back_columns_raises_the_error(self):
        clean = json.loads(self.train("cascade", "--json").stdout)
        noisy = json.loads(
            self.train("cascade", "--feedback", "a", "--noise", 0.1, "--json", "--force").stdout)
        self.assertGreater(noisy["train_mse"], 3 * clean["train_mse"])

    def test_an_existing_model_is_not_overwritten(self):
        self.out.write_text("precious")
        result = self.train("cascade")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--force", result.stderr)
        self.assertEqual(self.out.read_text(), "precious")

    def test_bad_tables_are_refused_by_line(self):
        for text, words in (("a,b,y\n1,2,3\n1,2\n", "line 3: 2 cells where 3 belong"),
                            ("a,b,y\n1,2,3\n1,nan,2\n", "line 3: not a number within"),
                            ("a,b,a\n1,2,3\n", "line 1: the first line must name every column"),
                            ("a,b,y\n", "no rows"),
                            ("a,b,y\n1,2,3\n", "at least 10 are needed")):
            self.data.write_text(text)
            self.refused(4, words, "cascade", "--data", self.data, "--inputs", 2, "--out", self.out)
            self.assertFalse(self.out.exists())

    def test_wrong_command_lines_are_refused(self):
        base = ["cascade", "--data", self.data, "--out", self.out]
        self.refused(2, "leaves 0 of the 3 columns", *base, "--inputs", 3)
        self.refused(2, "y is none of the first 2 columns", *base, "--inputs", 2, "--feedback", "y",
                     "--noise", 1)
        self.refused(1, "cannot open", "cascade", "--data", self.folder / "none.csv", "--inputs", 2,
                     "--out", self.out)
        self.refused(4, "--sigmoid outputs lie within", *base, "--inputs", 2, "--sigmoid")

    def motions(self):
        folder = self.folder / "motions"
        folder.mkdir()
        for name in ("1_01", "1_02", "2_01"):
            (folder / (name + ".bvh")).write_text(bvh(name))
        return folder

    def test_com_leaves_out_whom_it_is_judged_on(self):
        folder = self.motions()
        result = run("com", "--motions", folder, "--exclude", "002", "--out", self.out, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(result.stdout)
        self.assertEqual(report["subjects"], ["1"])
        self.assertEqual(report["clips"], 2)
        self.assertEqual([network["axis"] for network in report["networks"]], ["x", "y"])
        self.assertIn(report["noise_m"], (0.01, 0.02, 0.04, 0.08))
        judged = report["excluded"]
        for loop, cop in zip(judged["closed_loop_rms_m"], judged["cop_rms_m"]):
            self.assertLess(loop, cop)
            self.assertLess(loop, 0.05)  # It sways by 2 to 3 cm.
        # With a perfect past one step is nearly nothing, and the closed loop runs away.
        result = run("com", "--motions", folder, "--exclude", 2, "--noise", 0, "--rounds", 0,
                     "--out", self.out,
                     "--force", "--json")
        judged = json.loads(result.stdout)["excluded"]
        self.assertLess(max(judged["one_step_rms_m"]), 0.001)
        self.assertGreater(max(judged["closed_loop_rms_m"]), 0.05)
        written = self.out.read_bytes()
        self.assertIn(b"1_02.bvh", written)
        self.assertNotIn(b"2_01.bvh", written)

    def test_com_has_as_many_hidden_units_as_are_asked_for(self):
        folder = self.motions()
        result = run("com", "--motions", folder, "--exclude", 2, "--noise", 0.02, "--rounds", 0, "--hidden-min", 2,
                     "--hidden-max", 2, "--out", self.out, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        networks = json.loads(result.stdout)["networks"]
        self.assertEqual([network["hidden_units"] for network in networks], [2, 2])
        self.refused(2, "--hidden-min 3 is above --hidden-max 0", "com", "--motions", folder, "--hidden-min", 3,
                     "--out", self.out)

    def test_basis_of_someone_who_moves_in_three_ways_has_three_components(self):
        result = run("basis", "--motions", self.motions(), "--out", self.out, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(result.stdout)
        self.assertEqual(report["subjects"], ["1", "2"])
        self.assertEqual(report["components_9999"], 3)
        self.assertEqual(report["poses"], 2400)  # And their mirror images.

    def test_files_of_several_layouts_are_fitted_to_the_standard_one(self):
        folder = self.motions()
        other = (folder / "1_01.bvh").read_text().replace("Spine", "Chest")
        (folder / "3_01.bvh").write_text(other)
        result = run("basis", "--motions", folder, "--out", self.out, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ("1_01.bvh", "2_01.bvh", "3_01.bvh"):
            self.assertIn(f"fitted {name} to the standard layout", result.stderr)
        report = json.loads(result.stdout)
        self.assertEqual(report["subjects"], ["1", "2", "3"])
        self.assertEqual(report["dof"], 56)

    def test_markers_are_the_person_who_stands_still_beside_them(self):
        data = os.environ.get("FOOTING_TEST_DATA")
        recorded = pathlib.Path(data or "/nonexistent", "forces/vua_stoop")
        if not recorded.is_dir():
            self.skipTest("FOOTING_TEST_DATA has no forces/vua_stoop")
        folder = self.folder / "markers"
        folder.mkdir()
        stoop, = recorded.glob("stoop1_*.c3d")
        neutral, = recorded.glob("neu_*.c3d")
        (folder / "vua_stoop1.c3d").write_bytes(stoop.read_bytes())
        means = []
        for still in (False, True):
            if still:
                (folder / "vua_still.c3d").write_bytes(neutral.read_bytes())
            result = run("basis", "--motions", folder, "--out", self.out, "--force", "--json")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(json.loads(result.stdout)["subjects"], ["vua"])
            written = self.out.read_bytes()
            self.assertIn(b"vua_stoop1.c3d", written)
            self.assertNotIn(b"vua_still.c3d", written)
            means.append(written)
        self.assertNotEqual(*means)

    def test_bad_motions_are_refused_by_name(self):
        folder = self.motions()
        self.refused(2, "--exclude 7: no file of that subject is there; there are 1, 2", "basis", "--motions",
                     folder, "--exclude", 7, "--out", self.out)
        self.refused(2, "--only 7: no motion of that subject that stays in place is there; there are 1, 2",
                     "people", "--motions", folder, "--only", 7)
        (folder / "3_01.bvh").write_text("HIERARCHY\nnonsense")
        self.refused(4, "3_01.bvh", "basis", "--motions", folder, "--out", self.out)
        self.refused(1, "cannot list", "com", "--motions", folder / "none", "--out", self.out)
        self.assertFalse(self.out.exists())

    def test_a_clip_without_a_still_t_pose_is_left_out_by_name(self):
        folder = self.motions()
        text = (folder / "2_01.bvh").read_text()
        # Feet that touch, and a long arm to the left: the right foot carries too little in the T-pose.
        for old, new in (("9 -5 0", "3 -5 0"), (" 28 0 0", " 125 0 0"), (" 26 0 0", " 125 0 0")):
            text = text.replace(old, new)
        (folder / "1_03.bvh").write_text(text)
        result = run("pose", "--motions", folder, "--out", self.out, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1_03.bvh: its T-pose never stands still on the boards", result.stderr)
        self.assertNotIn("1_02.bvh: its T-pose", result.stderr)
        self.assertTrue(self.out.exists())

    def test_people_are_each_judged_by_a_model_without_them(self):
        folder = self.motions()
        result = run("people", "--motions", folder, "--seed", 1, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(result.stdout)
        self.assertEqual(sorted(report["people"]), ["1", "2"])
        frames = [person["frames"] for person in report["people"].values()]
        self.assertEqual(report["all"]["frames"], sum(frames))
        for person in report["people"].values():
            best, learned = person["best"]["mpjpe_cm"], person["hands_feet_learned"]["mpjpe_cm"]
            self.assertAlmostEqual(person["gain_over_learned"], 1 - best / learned)
            self.assertGreater(person["hands_feet_ik"]["mpjpe_cm"], 0)
            for way in ("best", "hands_feet_learned", "hands_feet_ik"):
                for part in ("hip_swing_deg", "hip_twist_deg"):
                    self.assertLessEqual(person[way][part], person[way]["hip_deg"] + 1e-9)
                # A thigh's direction is off by no more than both of its angles together.
                angles = [person[way][f"hip_{name}_deg"] for name in ("flexion", "abduction", "rotation")]
                self.assertGreater(min(angles), 0)
                self.assertLessEqual(person[way]["hip_swing_deg"], angles[0] + angles[1])
            self.assertLess(person["hip_about_person_rms_deg"], person["hip_rms_deg"])
            self.assertGreaterEqual(person["hip_rms_deg"], person["best"]["hip_deg"])
            self.assertLessEqual(person["invalid_share"], 1)
        # The means of two people are taken off one by one.
        squares = [person["hip_about_person_rms_deg"] ** 2 for person in report["people"].values()]
        mean = sum(n * square for n, square in zip(frames, squares)) / sum(frames)
        self.assertAlmostEqual(report["all"]["hip_about_person_rms_deg"], mean ** 0.5)
        only = run("people", "--motions", folder, "--only", 2, "--seed", 1, "--json")
        self.assertEqual(json.loads(only.stdout)["people"]["2"], report["people"]["2"])
        known = run("people", "--motions", folder, "--only", 2, "--seed", 1, "--ablations", "--json")
        ways = json.loads(known.stdout)["people"]["2"]
        self.assertEqual(ways["best"], report["people"]["2"]["best"])
        more = run("people", "--motions", folder, "--only", 2, "--seed", 1, "--sensors", "--json")
        sensors = json.loads(more.stdout)["people"]["2"]
        self.assertEqual(sensors["best"], ways["best"], "other sensors change nothing for boards and hands")
        # These people never turn the pelvis, so a belt alone adds no more than its slip.
        for way in ("head", "head_kinect", "head_belt", "hands_feet_learned_head_belt"):
            self.assertNotEqual(sensors[way]["mpjpe_cm"], ways["best"]["mpjpe_cm"])
            self.assertNotIn(way, ways)
        self.assertAlmostEqual(sensors["belt"]["mpjpe_cm"], ways["best"]["mpjpe_cm"], delta=0.05)
        for way in ("true_com", "true_momentum", "true_feet"):
            self.assertGreater(ways[way]["mpjpe_cm"], ways["true_all"]["mpjpe_cm"])
        self.assertGreater(ways["best"]["knee_deg"], ways["true_all"]["knee_deg"])
        (folder / "2_01.bvh").unlink()
        self.refused(2, "a single person", "people", "--motions", folder)

    def test_arm_leaves_out_a_person_at_a_time(self):
        folder = self.motions()
        result = run("arm", "--motions", folder, "--out", self.out, "--seed", 3, "--licence",
                     "1, 2: CC0", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(b"1, 2: CC0", self.out.read_bytes())
        report = json.loads(result.stdout)
        self.assertEqual((report["subjects"], report["folds"]), (["1", "2"], 2))
        # Their arms stay level while the trunk bends.
        self.assertLess(report["left_out_error"], report["spread"])
        self.assertIn(b"2_01.bvh", self.out.read_bytes())
        alone = run("arm", "--motions", folder, "--exclude", 2, "--out", self.out, "--force", "--json")
        self.assertEqual(json.loads(alone.stdout)["folds"], 5)
        self.assertNotIn(b"2_01.bvh", self.out.read_bytes())


if __name__ == "__main__":
    unittest.main()
