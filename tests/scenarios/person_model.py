"""Two guided minutes on simulated boards with more sensors: footing-ctl motions records them, footing-train person learns
from them, and footing-sim loads what was learned for this subject, for no other.

Usage: person_model.py BINARY_FOLDER
"""
import json
import sys

from harness import Stage


def main(binaries):
    with Stage(binaries) as stage:
        subject = stage.folder / "p07.json"
        subject.write_text(json.dumps({"code": "p07", "height_m": 1.75}))
        own, recording = stage.folder / "p07.fmodel", stage.folder / "p07.mcap"
        stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
        stage.wait_for_socket(stage.sensor)
        stage.wait_for_socket(stage.devices)
        engine = ("footing-sim", "--engine", "pose", "--subject", subject, "--sensor", stage.sensor, "--listen",
                  stage.simulation)
        stage.start(*engine)
        stage.wait_for_socket(stage.simulation)
        stage.start("footing-stream", "boards", "--motion", "own_motion", "--hands", "move", "--head", "sphere",
                    "--worn", "pelvis,left_thigh,right_thigh", "--to", stage.devices)
        guided = stage.run_json("footing-ctl", "motions", "--connect", stage.simulation, "--script", "--out", recording,
                                timeout_s=500)
        assert guided["subject"] == "p07" and guided["valid_share"] > 0.8, guided
        report = stage.run_json("footing-train", "person", "--recording", recording, "--subject", "p07", "--out", own,
                                timeout_s=500)
        print(report)
        assert report["subject"] == "p07" and 90 < report["seconds"] < 125, report
        likely = report["likely"]
        assert likely["left_out_error"] < 0.8 * likely["left_out_error_before"], report
        # The next start of this subject has it; a file of this name that is of another subject is refused.
        stage.stop("footing-sim")
        stage.start(*engine)
        stage.wait_for_socket(stage.simulation)
        next_subject = stage.folder / "p08.json"
        next_subject.write_text(json.dumps({"code": "p08", "height_m": 1.8}))
        assert stage.run("footing-ctl", "subject", next_subject, "--connect", stage.simulation).returncode == 0
        (stage.folder / "p08.fmodel").write_bytes(own.read_bytes())
        refused = stage.run("footing-ctl", "subject", next_subject, "--connect", stage.simulation)
        assert refused.returncode != 0 and "p08.fmodel: is of p07, not of p08" in refused.stderr, refused


if __name__ == "__main__":
    main(sys.argv[1])
