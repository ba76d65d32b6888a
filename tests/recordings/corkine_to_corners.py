"""Turns a log of corkine/BalanceBoardDataAnalysis into the corner CSV that footing-eval reads.

Usage: corkine_to_corners.py LOG [CSV]   (without CSV: standard output)

A line of the log is: milliseconds, TL, TR, BL, BR in kg, then two scaled COP values and the total,
separated by blanks. The order TL, TR, BL, BR was inferred from the two COP columns (x * 25, y * 15);
the total is checked against the corners' sum.
"""
import sys


def convert(lines, out):
    out.write("time_s,tl_kg,tr_kg,bl_kg,br_kg\n")
    rows = 0
    for number, line in enumerate(lines, 1):
        cells = line.split()
        if not cells:
            continue
        if len(cells) != 8:
            sys.exit(f"error: line {number}: {len(cells)} cells where 8 belong")
        corners = [float(cell) for cell in cells[1:5]]
        if abs(sum(corners) - float(cells[7])) > 0.01:
            sys.exit(f"error: line {number}: the corners do not add up to the total")
        out.write(f"{int(cells[0]) / 1000:.3f},{','.join(cells[1:5])}\n")
        rows += 1
    return rows


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="ascii") as log:
        if len(sys.argv) == 3:
            with open(sys.argv[2], "w", encoding="ascii") as csv:
                count = convert(log, csv)
        else:
            count = convert(log, sys.stdout)
    print(f"{count} rows", file=sys.stderr)
