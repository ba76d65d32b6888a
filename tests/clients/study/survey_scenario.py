"""The survey on the participant's own screen: whichever program is killed meanwhile, no answer is lost or given twice.

Usage: survey_scenario.py SCENARIOS_FOLDER BINARY_FOLDER
"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, sys.argv[1])
from attended_scenario import Experimenter  # noqa: E402
from harness import Stage, read_ticks  # noqa: E402

PROTOCOL = {
    "version": 1, "name": "survey", "participants": ["P01"], "interfaces": ["wrist"], "seed": 2, "practice_s": 0,
    "straight_trials": 0, "test_tracks": [],
    "survey": {"ratings": ["fun", "stress"], "questions": ["good"], "exertion": True},
    "final_survey": {"ratings": ["like", "ease"], "questions": [], "overall": ["preferred interface"]}, "devices": {"allow_simulated": True},
    "disk_mb": 1,
}


def answers(stage):
    lines = (stage.folder / "s.study/P01/journal.jsonl").read_text().splitlines()
    return [one.get("value", one.get("text")) for one in map(json.loads, lines)
            if one["event"] in ("rating", "exertion", "answer")]


def shown(stage, phase):
    """Where the study says that it stands, for the experimenter's viewer, once it is in the phase."""
    for tick in read_ticks(stage.simulation, 30, ("study", "characters")):
        if tick.get("study", {}).get("phase") == phase:
            return tick["study"]
    raise AssertionError("no study")


def main():
    with Stage(sys.argv[2]) as stage:
        (stage.folder / "s.json").write_text(json.dumps(PROTOCOL))
        stage.start_servers()
        stage.start_user("demo")
        address = f"unix:{stage.folder}/survey.sock"
        command = ("run", stage.folder / "s.json", "--participant", "P01", "--sensor", stage.sensor, "--simulation",
                   stage.simulation, "--survey", address)

        def start():
            return Experimenter(stage, *command)

        def screen():
            return Experimenter(stage, "survey", "--connect", address, name="screen")

        experimenter = start()
        experimenter.answer("Type yes to confirm", "yes")
        experimenter.answer("show all commands", "")
        experimenter.read("fun: on the participant's screen, which is not there yet")
        state = shown(stage, "wrist.survey")
        assert (state["participant"], state["next"], state["number"]) == ("P01", "final_survey", 4), state
        participant = screen()
        participant.answer("1 of 4(?s:.*)fun(?s:.*)1 very little, 5 very much", "6")
        participant.answer("Type a number from 1 to 5", "4")
        participant.read("2 of 4(?s:.*)stress")
        assert answers(stage) == [4], answers(stage)  # On the disk before the next question.
        participant.process.kill()
        participant.process.wait()
        participant = screen()
        participant.answer("2 of 4(?s:.*)stress", "2")
        participant.answer("3 of 4(?s:.*)exertion(?s:.*)10 extremely strong", "10")
        participant.read("4 of 4(?s:.*)good(?s:.*)one line")
        experimenter.process.kill()
        experimenter.process.wait()
        participant.read("Waiting for the experimenter")
        participant.type("1\n")  # Nobody has asked.
        experimenter = start()
        experimenter.read("goes on with question 4 of 4")  # What was answered is not asked again.
        participant.answer("4 of 4(?s:.*)good(?s:.*)press Enter", "it walks")
        participant.answer("Looking back: interface wrist(?s:.*)1 of 3(?s:.*)like(?s:.*)press Enter", "5")
        participant.read("2 of 3(?s:.*)ease")
        experimenter.process.kill()
        experimenter.process.wait()
        experimenter = start()
        experimenter.read("Survey at the end(?s:.*)goes on with question 2 of 3")
        participant.answer("Looking back: interface wrist(?s:.*)2 of 3(?s:.*)ease(?s:.*)press Enter", "3")
        participant.answer("3 of 3(?s:.*)preferred interface(?s:.*)1  wrist(?s:.*)press Enter", "none")
        participant.read("Type one of them: the number or the name")
        experimenter.read("preferred interface: on the participant's screen(?s:.*)Press t to ask here")
        experimenter.type("t")
        experimenter.answer(r"preferred interface \(1 wrist\):", "WRIST")
        participant.read("Please answer the experimenter(?s:.*)Thank you")
        assert experimenter.process.wait(60) == 0
        assert answers(stage) == [4, 2, 10, "it walks", 5, 3, "wrist"], answers(stage)
        shown(stage, "")  # It is over.
        done = stage.run("footing-study", "run", stage.folder / "s.json", "--participant", "P01", "--survey",
                         "tcp:0.0.0.0:4711")
        assert done.returncode == 2 and "ssh -L" in done.stderr, done
    return 0


if __name__ == "__main__":
    sys.exit(main())
