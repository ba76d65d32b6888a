"""A reaction task: a word appears, the participant swings the remote of that side. Prints the reaction times.

With PsychoPy installed the words are in its window; without it they are printed, and nothing else changes.

Usage: psychopy_task.py [TRIALS]
"""
import random
import sys
import time

import footing

try:
    from psychopy import visual
    window = visual.Window(color="black")

    def show(text):
        visual.TextStim(window, text=text).draw()
        window.flip()
        return time.monotonic_ns()  # The flip returned at the frame's start.
except ImportError:
    def show(text):
        print(text, flush=True)
        return time.monotonic_ns()


def reaction(f, shown_ns, within_s=2):
    """Role of the first remote that is swung after the word, and the delay by the sensor's own clock."""
    for sample in f.samples("motion", seconds=within_s):
        force = sample.data.specific_force_mps2
        if sample.data.sampled_ns > shown_ns and force.x**2 + force.y**2 + force.z**2 > 15**2:
            return sample.role, (sample.data.sampled_ns - shown_ns) * 1e-9
    return "", float("nan")


with footing.connect(role="log") as f:
    for trial in range(int(sys.argv[1]) if len(sys.argv) > 1 else 10):
        time.sleep(random.uniform(0.5, 1.0))
        side = random.choice(["left", "right"])
        shown_ns = show(side)
        f.mark(side, trial + 1)  # In every recording, and in its exports.
        role, delay_s = reaction(f, shown_ns)
        print(f"trial {trial + 1}: {side}, answered {role or 'not'}, {delay_s:.3f} s", flush=True)
