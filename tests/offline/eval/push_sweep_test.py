"""Sweeps of pushes: light ones are survived from every side, a push of 90 N s throws over. Random commands that
were too short to judge have no tracked fraction."""
import json
import subprocess
import sys


def sweep(gait, push_ns, *more):
    command = [sys.argv[1], "gait", "--gait", gait, "--push", str(push_ns), "--push-directions", "4",
               "--push-phases", "2", "--seed", "11", "--json", *more]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


problems = []
for gait, speed in (("step", 0), ("walk", 1.2), ("jump", 0.5)):
    report = sweep(gait, 10, "--speed", str(speed))
    if report["pushes"] != 8 or report["falls"] != 0 or report["largest_survived_ns"] < 10:
        problems.append(f"{gait}, 10 N s: {report}")
report = sweep("step", 90)
if report["falls"] < 4 or report["falls"] != sum(report["falls_by_direction"]):
    problems.append(f"step, 90 N s: {report}")
if not 10 <= report["largest_survived_ns"] < 90:
    problems.append(f"largest push survived while stepping: {report['largest_survived_ns']} N s")
done = subprocess.run([sys.argv[1], "monkey", "--seconds", "2", "--json"], check=True, capture_output=True, text=True)
report = json.loads(done.stdout)
if report["commands_of_3_s"] != 0 or report["commands_tracked_fraction"] is not None:
    problems.append(f"monkey of 2 s: {report}")
sys.exit("\n".join(problems) or 0)
