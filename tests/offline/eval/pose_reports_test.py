"""footing-eval pose --claims, --ablations and --figures on a CMU clip, with models of other people.

Usage: pose_reports_test.py FOOTING_EVAL FOOTING_TRAIN
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

EVAL, TRAIN = sys.argv.pop(1), sys.argv.pop(1)
DATA = pathlib.Path(os.environ.get("FOOTING_TEST_DATA", "")) / "mocap" / "cmu_amc"
CLIP = ["--motion", DATA / "13_30.amc", "--skeleton", DATA / "13_reconstructed.asf", "--rate-hz", "30"]


def run(program, *arguments):
    done = subprocess.run([program, *map(str, arguments), "--json"], capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return json.loads(done.stdout)


class Reports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.folder.name)
        for kind in ("basis", "com"):
            run(TRAIN, kind, "--motions", DATA, "--exclude", "13", "--out", folder / f"{kind}.fmodel")
        cls.models = ["--model", folder / "basis.fmodel", "--model", folder / "com.fmodel"]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_claims(self):
        claims = run(EVAL, "pose", *CLIP, "--claims")["claims"]
        rows = claims["constant_velocity"]["rows"]
        for axes in ("vertical_percent", "all_axes_percent"):
            shares = [row[axes] for row in rows]
            self.assertEqual(shares, sorted(shares), "a wider limit counts no less")
            self.assertTrue(all(0 <= share <= 100 for share in shares))
        for row in claims["outlier"]["standing"]:
            # 50 N for 1/30 s on 75 kg leave 2.22 cm/s.
            free = 50 / 75 / 30 * 100 * row["after_s"]
            if row["decay"]:
                # It goes on for 0.05 s and the time constant of 0.5 s, however long one waits.
                self.assertLess(abs(row["drift_cm"]), 0.6 * free / row["after_s"])
            else:
                self.assertAlmostEqual(row["drift_cm"], free, delta=0.1 * free)

    def test_ablations(self):
        rows = run(EVAL, "pose", *CLIP, *self.models, "--ablations")["ablations"]
        terms = ["nothing", "angular_momentum", "momentum", "cleanup", "basis"]
        self.assertEqual([(row["mode"], row["without"]) for row in rows],
                         [("best", term) for term in terms + ["posture"]] +
                         [("paper", term) for term in terms + ["horizontal_network"]])
        self.assertTrue(all(row["finite"] for row in rows))
        self.assertTrue(all(0 < row["mpjpe_cm"] < 200 for row in rows))
        paper = {row["without"]: row for row in rows if row["mode"] == "paper"}
        self.assertAlmostEqual(paper["angular_momentum"]["mpjpe_cm"], paper["nothing"]["mpjpe_cm"], delta=1,
                               msg="L by equation (3) costs nothing")
        self.assertNotEqual(paper["horizontal_network"]["com_horizontal_rms_cm"],
                            paper["nothing"]["com_horizontal_rms_cm"])

    def test_figures(self):
        with tempfile.TemporaryDirectory() as folder:
            names = run(EVAL, "pose", *CLIP, *self.models, "--no-baselines", "--figures", folder)["figures"]
            self.assertEqual(len(names), 9)
            for name in names:
                root = xml.etree.ElementTree.parse(pathlib.Path(folder) / name).getroot()
                self.assertTrue(root.tag.endswith("svg"))
                self.assertNotIn("nan", (pathlib.Path(folder) / name).read_text())

    def test_insoles(self):
        walk = ["--motion", DATA.parent / "cmu_amc2" / "walk_03.amc", "--skeleton",
                DATA.parent / "cmu_amc2" / "walk.asf", "--boards", "insoles", "--loop-minutes", "0.25"]
        judged = run(EVAL, "pose", *walk, *self.models)
        self.assertGreater(judged["walked_m"], 8)
        self.assertTrue(judged["finite"])
        self.assertGreater(judged["contact_f1"], 0.97)
        self.assertLess(judged["mpjpe_root_relative_cm"],
                        0.8 * judged["baselines"]["mean_pose"]["mpjpe_root_relative_cm"])
        self.assertLess(judged["root_p95_cm"], 40)


if __name__ == "__main__":
    if not DATA.is_dir():
        print("skipped: FOOTING_TEST_DATA is not set")
        sys.exit(77)
    unittest.main()
