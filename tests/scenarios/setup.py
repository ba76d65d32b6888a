"""The guided set-up and the acceptance, driven end to end by a made person.

Usage: setup.py BINARIES PERSON

footing-ctl's prompts go to the person, whose devices move accordingly: nobody presses a key. Then the
faults: swapped boards, a turned board, a slipped mounting and an exhausted battery, each to be named.
"""
import json
import os
import pathlib
import subprocess
import sys
import threading

import harness

# What the person does at a prompt: its beginning, then words for the person.
DOES = [
    ("Step off the boards", ["still", "off"]),
    ("Step on the left board", ["left"]),
    ("Step on the right board", ["right"]),
    ("Shake the left wrist", ["shake left"]),
    ("Shake the right wrist", ["shake right"]),
    ("Stand on the left board alone", ["left"]),
    ("Stand on the right board alone", ["right"]),
    ("Stand upright", ["still", "both"]),
    ("Stand still", ["still", "both"]),
    ("Lean forward", ["lean"]),
    ("Put the devices on", ["still"]),
    ("Now take three steps", ["steps", 2.3, "still"]),
    ("Walk in place", ["walk"]),
    ("Run in place", ["run"]),
    ("Swing left and right together", ["jump"]),
    ("Switch one device off", ["still", "replug"]),
]


class Person:
    def __init__(self, stage, program, *words):
        environment = dict(os.environ)
        self.process = subprocess.Popen([program, stage.devices, *words], stdin=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL, text=True, env=environment)
        stage.processes["person"] = self.process
        self.timers = []

    def tell(self, words):
        self.process.stdin.write(words + "\n")
        self.process.stdin.flush()

    def follow(self, prompt):
        for timer in self.timers:
            timer.cancel()
        self.timers = []
        after_s = 0.0
        if prompt.startswith("Step off the boards, wait"):  # Off and on again.
            for i in range(20):
                self.later(1.5 * i, "off" if i % 2 == 0 else "both")
            return
        for beginning, deeds in DOES:
            if prompt.startswith(beginning):
                for deed in deeds:
                    if isinstance(deed, float):
                        after_s += deed
                    else:
                        self.later(after_s, deed)
                return

    def later(self, after_s, words):
        if after_s == 0:
            self.tell(words)
            return
        timer = threading.Timer(after_s, self.tell, [words])
        timer.daemon = True
        timer.start()
        self.timers.append(timer)


def control(stage, person, *words, timeout_s=100):
    """Runs footing-ctl with the person at its prompts; its exit code and JSON."""
    process = subprocess.Popen(
        [stage.binaries / "footing-ctl", "--connect", stage.sensor, *map(str, words), "--script",
         "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL,
        text=True)
    stage.processes["footing-ctl"] = process
    killer = threading.Timer(timeout_s, process.kill)
    killer.start()
    heard = []
    for line in process.stderr:
        heard.append(line)
        if line.startswith("PROMPT: "):
            person.follow(line.removeprefix("PROMPT: "))
    out = process.stdout.read()
    code = process.wait()
    killer.cancel()
    assert out, f"footing-ctl {words} ended with {code} and no JSON:\n{''.join(heard)}"
    return code, json.loads(out), "".join(heard)


def start(stage, program, *words):
    stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}",
                "--set", f"state_directory={stage.folder}/state")
    stage.wait_for_socket(stage.devices)
    person = Person(stage, program, *words)

    def all_live():
        done = stage.run("footing-ctl", "--connect", stage.sensor, "devices", "--json")
        devices = json.loads(done.stdout)["devices"] if done.stdout else []
        return len(devices) == 4 and all(device["state"] == "live" for device in devices)

    stage.wait_for(all_live, "four live devices")
    return person


def item(result, name, serial=None):
    found = [one for one in result["items"]
             if one["name"] == name and (serial is None or one["serial"] == serial)]
    assert found, f"no item {name}: {result}"
    return found[-1]


def failed_checks(verdict):
    return {check["name"].split(" ")[0]: check["note"] for check in verdict["checks"]
            if not check["passed"]}


def good(binaries, program):
    with harness.Stage(binaries) as stage:
        person = start(stage, program)
        code, result, heard = control(stage, person, "setup", "--mass-kg", 70, "--patience", 20)
        assert code == 0 and result["ready"], f"{json.dumps(result, indent=1)}\n{heard}"
        assert all(one["passed"] and one["date"] for one in result["items"]), result
        mass_kg = float(item(result, "weigh")["note"].split(" ")[0])
        assert abs(mass_kg - 70) < 1, result
        print("setup:", [(one["name"], round(one["residual"], 2), one["unit"])
                         for one in result["items"]])

        recording = stage.folder / "acceptance.mcap"
        code, verdict, heard = control(stage, person, "acceptance", "--minutes", 0.6, "--out",
                                       recording)
        assert code == 0 and verdict["verdict"] == "pass", f"{failed_checks(verdict)}\n{heard}"
        again = stage.run_json("footing-ctl", "acceptance", "--replay", recording)
        assert again["checks"] == verdict["checks"], "the replay's figures differ"
        print("acceptance:", len(verdict["checks"]), "checks pass, live and replayed")

        person.tell("swap")
        code, result, _ = control(stage, person, "layout", "--check")
        assert code == 1 and "swapped" in result["check"]["note"], result
        person.tell("swap")
        person.tell("turn right")
        code, result, _ = control(stage, person, "layout", "--check")
        assert code == 1 and "right board is turned" in result["check"]["note"], result
        person.tell("turn right")
        print("layout: swapped and turned boards are named")

        person.tell("slip 45")
        person.tell("walk")

        def slipped():
            devices = stage.run_json("footing-ctl", "--connect", stage.sensor, "devices")
            return any(device["slipped"] for device in devices["devices"])

        stage.wait_for(slipped, "the slip alarm", 20)
        code, result, _ = control(stage, person, "setup", "--only", "checks", "--tries", 1)
        assert code == 1 and any("slipped" in one["note"] for one in result["items"]), result
        print("mounting: a slip of 45 degrees is named")


def exhausted(binaries, program):
    with harness.Stage(binaries) as stage:
        person = start(stage, program, "--low-battery")
        code, result, _ = control(stage, person, "setup", "--only", "checks", "--tries", 1)
        bad = [one for one in result["items"] if not one["passed"]]
        assert code == 1 and len(bad) == 1 and "change the batteries" in bad[0]["note"], result
        print("checks: an exhausted battery is named")


def main():
    binaries, program = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    exhausted(binaries, program)
    good(binaries, program)


if __name__ == "__main__":
    main()
