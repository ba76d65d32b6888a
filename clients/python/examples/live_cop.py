"""Centre of pressure of a balance board, live: a plot where matplotlib is installed, else a line of text.

Usage: live_cop.py [SECONDS]
"""
import sys

import footing

try:
    import matplotlib.pyplot as plt
except ImportError:
    plt = None

with footing.connect() as f:
    if plt:
        line, = plt.plot([], [])
        plt.axis([-0.25, 0.25, -0.15, 0.15])
        plt.xlabel("to the right, m")
    for block in f.blocks("boards", every_s=0.1, seconds=float(sys.argv[1]) if len(sys.argv) > 1 else None):
        block = block.where(keep=block["cop_valid"])
        if plt and len(block):
            line.set_data(block["cop_x_m"], block["cop_y_m"])
            plt.pause(0.001)
        elif len(block):
            place = round((block["cop_x_m"][-1] + 0.25) * 120)
            picture = "o".rjust(max(1, min(60, place))).ljust(60)
            print(f"{block['time_s'][-1]:8.2f} s {block['total_n'][-1]:6.1f} N |{picture}|", flush=True)
