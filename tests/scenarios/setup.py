"""The guided set-up and the acceptance, driven end to end by a made person.

Usage: setup.py BINARIES PART PERSON

footing-ctl's prompts go to the person, whose devices move accordingly: nobody presses a key. PART is a
function of this file: a good run, or one fault that has to be caught and named.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import threading

import harness

TRIES = 4
LINK_CHECKS = ("clock ", "gaps ", "jitter ", "rate ", "repeats ")
# What the person does at a prompt: its beginning, then words for the person, and pauses in seconds.
DOES = [
    ("Plug in a Bluetooth adapter", ["on"]),
    ("Switch on every device", ["on"]),
    ("Step off the boards, wait", ["off", 1.5, "both", 1.5] * 10),
    ("Step off the boards", ["still", "off"]),
    ("Hold everything still", ["still"]),
    ("Step on the left board", ["left"]),
    ("Step on the right board", ["right"]),
    ("Shake the left", ["shake left"]),
    ("Shake the right", ["shake right"]),
    ("Stand on the left board alone", ["left"]),
    ("Stand on the right board alone", ["right"]),
    ("Stand upright", ["still", "both"]),
    ("Stand still", ["still", "both"]),
    ("Lean forward", ["lean"]),
    ("Put the devices on", ["still"]),
    ("Now take three steps", ["walk", 2.3, "still"]),
    ("Walk in place", ["walk"]),
    ("Run in place", ["run"]),
    ("Swing left and right together", ["jump"]),
    ("Switch one device off", ["still", "replug"]),
]


class Person:
    def __init__(self, stage, program, *words):
        self.process = subprocess.Popen([program, stage.devices, *words], stdin=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL, text=True, env=dict(os.environ))
        stage.processes["person"] = self.process
        self.timers = []

    def tell(self, words):
        self.process.stdin.write(words + "\n")
        self.process.stdin.flush()

    def follow(self, prompt):
        for timer in self.timers:
            timer.cancel()
        self.timers = []
        deeds = next((deeds for beginning, deeds in DOES if prompt.startswith(beginning)), [])
        after_s = 0.0
        for deed in deeds:
            if isinstance(deed, float):
                after_s += deed
            elif after_s == 0:
                self.tell(deed)
            else:
                timer = threading.Timer(after_s, self.tell, [deed])
                timer.daemon = True
                timer.start()
                self.timers.append(timer)


class Rig(harness.Stage):
    """footingd, a person with devices, and footing-ctl between them."""

    def __init__(self, program, *words):
        super().__init__(pathlib.Path(sys.argv[1]))
        self.program, self.words = program, words

    def __enter__(self):
        super().__enter__()
        self.start_footingd()
        self.person = Person(self, self.program, *self.words) if self.program else None
        return self

    def start_footingd(self):
        self.start("footingd", "--listen", self.sensor, "--source", f"stream:{self.devices}",
                   "--set", f"state_directory={self.folder}/state")
        self.wait_for_socket(self.sensor)
        self.wait_for_socket(self.devices)

    def list(self):
        done = self.run("footing-ctl", "--connect", self.sensor, "devices", "--json")
        return json.loads(done.stdout)["devices"] if done.stdout else []

    def switch_on(self):
        self.person.tell("on")

        def all_live():
            devices = self.list()
            return len(devices) == 4 and all(device["state"] == "live" for device in devices)

        self.wait_for(all_live, "four live devices")

    def holder(self, role):
        return next(device for device in self.list() if device["role"] == role)

    def control(self, *words, timeout_s=400):
        """Runs footing-ctl with the person at its prompts; its exit code, JSON and words."""
        process = subprocess.Popen(
            [self.binaries / "footing-ctl", "--connect", self.sensor, *map(str, words), "--script",
             "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL,
            text=True)
        self.processes["footing-ctl"] = process
        killer = threading.Timer(timeout_s, process.kill)
        killer.start()
        heard = ""
        for line in process.stderr:
            heard += line
            if self.person and line.startswith("PROMPT: "):
                self.person.follow(line.removeprefix("PROMPT: "))
        out = process.stdout.read()
        code = process.wait()
        killer.cancel()
        assert out, f"footing-ctl {words} ended with {code} and no JSON:\n{heard}"
        return code, json.loads(out), heard

    def findings(self):
        (self.folder / "host").mkdir(exist_ok=True)
        done = self.run("footing-ctl", "--connect", self.sensor, "doctor", "--json", "--root",
                        self.folder / "host")
        return {one["id"]: one for one in json.loads(done.stdout)["findings"]}


def check_ready(result, heard, items):
    assert result["ready"] and not result["missing"], f"{json.dumps(result, indent=1)}\n{heard}"
    for one in result["items"]:
        assert one["passed"] and not one["stale"], one
        assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", one["date"]), one
    assert {one["name"] for one in result["items"]} == set(items), result
    print("set-up:", [(one["name"], round(one["residual"], 2), one["unit"])
                      for one in result["items"]])


ITEMS = ["adapter", "pairing", "roles", "layout", "tare", "mounting", "weigh", "checks"]


def accept(rig):
    """The acceptance's recording and verdict: again where the machine's other work made the links late."""
    for number in range(TRIES):
        recording = rig.folder / f"acceptance{number}.mcap"
        code, verdict, heard = rig.control("acceptance", "--minutes", 0.6, "--out", recording)
        bad = [check for check in verdict["checks"] if not check["passed"]]
        if not bad or not all(check["name"].startswith(LINK_CHECKS) for check in bad):
            break
        print("again:", bad)
    assert code == 0 and verdict["verdict"] == "pass", f"{bad}\n{heard}"
    return recording, verdict


def ready_rig(program):
    """From nothing to a ready rig with remotes on the wrists; then the acceptance and its replay."""
    with Rig(program, "--jumbled") as rig:
        code, result, heard = rig.control("setup", "--worn", "left_hand,right_hand", "--mass-kg", 70,
                                          "--patience", 20)
        assert code == 0, f"{code}: {json.dumps(result, indent=1)}\n{heard}"
        check_ready(result, heard, ITEMS)
        weigh = next(one for one in result["items"] if one["name"] == "weigh")
        assert abs(float(weigh["note"].split(" ")[0]) - 70) < 1, weigh
        # The devices asked for the other side's roles; the gestures put them right.
        assert heard.count("PROMPT: Shake ") == 2 and heard.count("PROMPT: Step on ") == 2, heard
        lamps = {device["role"]: device["leds"] for device in rig.list()}
        assert lamps["left_hand"] == "1000" and lamps["right_hand"] == "0100", lamps
        assert lamps["left_board"] == "1000" and lamps["right_board"] == "0000", lamps

        recording, verdict = accept(rig)
        again = rig.run_json("footing-ctl", "acceptance", "--replay", recording)
        assert again["verdict"] == "pass", again
        assert again["checks"] == verdict["checks"], "the replay's figures differ"
        print("acceptance:", len(verdict["checks"]), "checks pass, live and replayed")

        # What was set up is there after a restart, and nothing of it is to be done again.
        assert rig.stop("footingd") == 0
        rig.start_footingd()
        rig.switch_on()
        status = rig.run_json("footing-ctl", "--connect", rig.sensor, "status")
        items = status["setup"][0]["items"]
        assert len(items) == len(result["items"]) and all(one["passed"] for one in items), status
        assert all(device["tared"] or device["mounted"] for device in rig.list()), rig.list()
        print("restart:", len(items), "items kept")


def rehearse(_):
    """footing-stream performs what the setup asks for: held remotes and boards, then remotes on the shins."""
    held = [item for item in ITEMS if item != "mounting"]
    shins = ["adapter", "pairing", "roles", "mounting", "checks"]
    for items, person, setup in (
            (held, ("--jumbled",), ("--mass-kg", 70)),
            (shins, ("--interface", "leg"), ("--worn", "left_leg,right_leg"))):
        with Rig(None) as rig:
            rehearsal = rig.start("footing-stream", "-q", "rehearse", "--once", "--json", "--to", rig.devices,
                                  "--watch", rig.sensor, *person)
            code, result, heard = rig.control("setup", "--patience", 20, *setup)
            assert code == 0, f"{code}: {json.dumps(result, indent=1)}\n{heard}"
            check_ready(result, heard, items)
            # Remotes in the hands are held as they should be: nothing is to be measured by steps.
            assert ("three steps" in heard) == ("mounting" in items), heard
            assert rehearsal.wait(harness.PATIENCE_S) == 0
            summary = json.loads((rig.folder / "footing-stream.log").read_text().splitlines()[-1])
            prompts = re.findall("^PROMPT: (.*)", heard, re.MULTILINE)
            assert [row["prompt"] for row in summary["rows"]] == prompts, (summary, heard)
            idle = [row["item"] for row in summary["rows"] if not row["performed"]]
            assert summary["setups"] == 1 and idle == ["checks"], summary
            print("performed:", [f"{row['gesture']} {row['role']}" for row in summary["rows"]])


def slipped_shin(program):
    """Remotes on the shins; one strap turns; the alarm; mounting alone is redone."""
    with Rig(program, "--shins", "--jumbled") as rig:
        code, result, heard = rig.control("setup", "--worn", "left_leg,right_leg")
        assert code == 0, f"{code}: {json.dumps(result, indent=1)}\n{heard}"
        check_ready(result, heard, ITEMS)
        rig.person.tell("slip right 70")
        rig.person.tell("walk")
        rig.wait_for(lambda: rig.holder("right_leg")["slipped"], "the slip alarm", 60)
        serial = rig.holder("right_leg")["serial"]
        assert not rig.holder("left_leg")["slipped"]
        finding = rig.findings()["mounting_slipped"]
        assert serial in finding["where"] and "--only mounting" in finding["remedy"], finding
        code, result, _ = rig.control("setup", "--only", "checks", "--tries", 1)
        bad = [one for one in result["items"] if one["name"] == "checks" and not one["passed"]]
        assert code == 1 and len(bad) == 1 and bad[0]["serial"] == serial, result
        assert "slipped" in bad[0]["note"], bad
        assert not result["ready"], result
        code, result, heard = rig.control("setup", "--only", "mounting", "--only", "checks")
        assert code == 0 and result["ready"], f"{json.dumps(result, indent=1)}\n{heard}"
        assert not rig.holder("right_leg")["slipped"]
        print("a strap that turned by 70 degrees is named, and put right by the mounting alone")


def loose_strap(program):
    """A strap that turns to and fro gives no mounting."""
    with Rig(program) as rig:
        code, _, heard = rig.control("setup", "--only", "tare")
        assert code == 3 and "nothing done" in heard, f"{code}: {heard}"  # All is switched off.
        rig.switch_on()
        rig.person.tell("loose right")
        code, result, heard = rig.control("setup", "--only", "mounting", "--tries", 2)
        serial = rig.holder("right_hand")["serial"]
        bad = [one for one in result["items"] if not one["passed"]]
        assert code == 1 and [one["serial"] for one in bad] == [serial], f"{result}\n{heard}"
        assert "tight" in bad[0]["note"], bad
        assert heard.count("(Again, because") >= 1, heard
        print("a loose strap is refused:", bad[0]["note"])


def check_layout(program, fault, words):
    with Rig(program) as rig:
        rig.switch_on()
        code, result, heard = rig.control("layout", "--preset", "one_foot_each", "--check")
        assert code == 0 and result["check"]["passed"], f"{result}\n{heard}"
        rig.person.tell(fault)
        code, result, heard = rig.control("layout", "--check")
        assert code == 1 and not result["check"]["passed"], f"{result}\n{heard}"
        assert words in result["check"]["note"], result
        print(fault, "is named:", result["check"]["note"])


def swapped_boards(program):
    check_layout(program, "swap", "the boards are swapped")


def turned_board(program):
    check_layout(program, "turn right", "the right board is turned by half a turn")


def exhausted_battery(program):
    with Rig(program, "--low-battery") as rig:
        rig.switch_on()
        serial = rig.holder("right_hand")["serial"]
        code, result, heard = rig.control("setup", "--only", "checks", "--tries", 1)
        bad = [one for one in result["items"] if not one["passed"]]
        assert code == 1 and [one["serial"] for one in bad] == [serial], f"{result}\n{heard}"
        assert "change the batteries" in bad[0]["note"], bad
        finding = rig.findings()["battery_low"]
        assert serial in finding["where"] and "two AA" in finding["remedy"], finding
        print("an exhausted battery is named:", bad[0]["note"])


if __name__ == "__main__":
    globals()[sys.argv[2]](sys.argv[3])
