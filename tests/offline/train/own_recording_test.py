"""footing-train on a recording of boards beside motion capture: what it aligns, writes and refuses.

Usage: own_recording_test.py FOOTING_TRAIN WRITE_OWN_RECORDING
"""
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

WRITER = sys.argv.pop()
PROGRAM = sys.argv.pop()


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)


class OwnRecording(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.made.cleanup)
        subprocess.run([WRITER, cls.made.name], check=True)

    def setUp(self):
        self.holder = tempfile.TemporaryDirectory()
        self.addCleanup(self.holder.cleanup)
        self.folder, made = pathlib.Path(self.holder.name), pathlib.Path(self.made.name)
        self.recording, self.motion = made / "me.mcap", made / "me_01.bvh"
        self.out = self.folder / "me.fmodel"
        self.pair = ["--recording", self.recording, "--motion", self.motion]

    def other(self, name):
        """The pair with another recording."""
        return ["--recording", self.recording.with_stem(name), "--motion", self.motion]

    def train(self, kind, *more, pair=None):
        done = run(kind, *(pair or self.pair), "--out", self.out, "--seed", 3, "--json", *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout), done.stderr

    def refused(self, code, words, *arguments):
        done = run(*arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(done.stdout, "")
        errors = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
        self.assertEqual(len(errors), 1, done.stderr)
        self.assertIn(words, errors[0])
        self.assertFalse(self.out.exists())

    def test_aligns_and_trains_all_three_kinds(self):
        for kind, warned in (("basis", "90 s for the basis"), ("com", "180 s for the horizontal COM"),
                             ("pose", "90 s for the basis")):
            report, told = self.train(kind, "--force")
            self.assertEqual(report["subjects"], ["me"])
            self.assertEqual(report["own"]["weight"], 1)
            take = report["own"]["takes"][0]
            self.assertEqual((take["recording"], take["motion"]), ("me.mcap", "me_01.bvh"))
            # Counted from the first reading, a few ms after the boards' start.
            self.assertAlmostEqual(take["offset_s"], 1.5, delta=0.006)
            self.assertLess(abs(take["drift_ppm"] - 60), 150)  # 27 s tell no more.
            self.assertLess(take["residual_ms"], 4)
            self.assertEqual(take["stomps_both"], 3)
            self.assertGreater(take["correlation"], 0.95)
            self.assertAlmostEqual(take["mass_kg"], 70, delta=0.3)
            self.assertEqual(take["hands"], "recorded")
            self.assertIn("the paper took " + warned, told)
            self.assertIn("3 stomps in both", told)
            written = self.out.read_bytes()
            for file in (self.recording, self.motion):
                self.assertIn(hashlib.sha256(file.read_bytes()).digest(), written)
                self.assertIn(file.name.encode(), written)

    def test_the_same_seed_gives_the_same_bits(self):
        self.train("pose")
        first = self.out.read_bytes()
        self.train("pose", "--force")
        self.assertEqual(self.out.read_bytes().replace(b" --force", b"")[-2000:-34], first[-2000:-34])

    def test_beside_others_it_counts_for_its_share(self):
        others = self.folder / "others"
        others.mkdir()
        text = self.motion.read_text()
        for name in ("2_01", "2_02", "3_01"):  # Not the same file: a motion counts once.
            (others / (name + ".bvh")).write_text(text + "\n" * int(name[-1]))
        (others / "me_01.bvh").write_text(text)
        alone = self.train("basis")[0]["poses"]
        report, _ = self.train("basis", "--motions", others, "--own-share", 0.5, "--force")
        self.assertEqual(report["subjects"], ["2", "3", "me"])
        self.assertEqual(report["own"]["weight"], 3)
        self.assertEqual(report["poses"], 6 * alone)

    def test_what_is_wrong_with_a_recording_is_said(self):
        for fault, words in (("no_boards", "no boards channel in it; record footingd's"),
                             ("two_people", "boards of 2 people (rigs main, other); say whose"),
                             ("three_hours", "span 180 minutes, more than two hours"),
                             ("uncalibrated", "without its calibration"),
                             ("no_stomps", "no_stomps.mcap: 0 stomps found in")):
            self.refused(4, words, "pose", *self.other(fault), "--out", self.out)
        self.refused(4, "is not a recording", "com", "--recording", self.motion, "--motion", self.motion,
                     "--out", self.out)

    def test_one_of_two_people_can_be_chosen(self):
        two = self.other("two_people")
        report, _ = self.train("basis", "--rig", "other", pair=two)
        self.assertEqual(report["own"]["takes"][0]["hands"], "made")
        self.out.unlink()
        self.refused(4, "no rig third with two boards; there are main, other", "basis", *two,
                     "--rig", "third", "--out", self.out)

    def test_wrong_command_lines_are_refused(self):
        self.refused(2, "nothing to train on: give --motions DIR, or --recording", "pose", "--out", self.out)
        self.refused(2, "--recording is given 1 times and --motion 0 times", "com", "--recording",
                     self.recording, "--out", self.out)
        self.refused(1, "cannot open", "basis", *self.other("none"), "--out", self.out)


if __name__ == "__main__":
    unittest.main()
