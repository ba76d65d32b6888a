"""Runs one trial of the character and writes its path as CSV. The devices drive; with --walk this script does.

Usage: log_trial.py OUT.csv [--walk] [SECONDS]
"""
import csv
import sys

import footing

out, walks = sys.argv[1], "--walk" in sys.argv
numbers = [word for word in sys.argv[2:] if word != "--walk"]
with footing.connect(role="control") as f, open(out, "w", newline="") as file, f.lease("log_trial.py"):
    rows = csv.writer(file)
    rows.writerow(["time_s", "trial_time_s", "distance_m", "speed_mps", "lateral_offset_m"])
    f.start_trial("python-1", track="straight", seed=1)
    if walks:
        f.gait("walk", 1.3)
    phase = 0
    for tick in f.ticks("characters", seconds=float(numbers[0]) if numbers else None):
        character = tick.characters.characters[0]
        trial = character.trial
        if trial.phase == trial.PHASE_RUNNING:
            speed_mps = character.gait.speed_mps
            rows.writerow([round(tick.time_s, 4), trial.time_s, trial.distance_m, speed_mps, trial.lateral_offset_m])
        if trial.phase != phase:
            phase = trial.phase
            print(f"{tick.time_s:.2f} s: {trial.Phase.Name(phase)} at {trial.distance_m:.2f} m", flush=True)
        if phase in (trial.PHASE_FINISHED, trial.PHASE_STOPPED):
            break
    if phase not in (trial.PHASE_FINISHED, trial.PHASE_STOPPED):
        f.stop_trial()
