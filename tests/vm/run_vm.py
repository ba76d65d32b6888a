#!/usr/bin/env python3
"""The kernel machine: the shipped footingd on Debian's own kernel, with hid-wiimote and real hidraw.

  run_vm.py run --build build/release --results FILE    boots it, measures, shows every bar
  run_vm.py judge BAR --results FILE                    one bar of the results that are there
      --only steady,boards                              these scenarios; the other bars fail
  run_vm.py list                                        the bars

Exit codes: 0 it ran to its end, or the bar holds; 1 not; 77 it cannot be made here (and why).
"""
import argparse
import json
import pathlib
import sys

import bars
import machine

SKIPPED = 77
SOURCE = pathlib.Path(__file__).resolve().parents[2]


def rule_text():
    lines = (SOURCE / "systemd/70-footing.rules").read_text().splitlines()
    return next(line for line in lines if line and not line.startswith("#"))


def judge(name, results):
    """True when it holds; prints it as GoogleTest would."""
    print(f"[ RUN      ] KernelMachine.{name}")
    try:
        line = bars.BARS[name](results)
    except (AssertionError, KeyError, TypeError) as error:
        print(f"{type(error).__name__}: {error}")
        print(f"[  FAILED  ] KernelMachine.{name}")
        return False
    print(f"             {line}")
    print(f"[       OK ] KernelMachine.{name}", flush=True)
    return True


def run(build, results_file, only):
    results_file.unlink(missing_ok=True)
    try:
        text, accelerator = machine.run_machine(build, SOURCE, only)
    except machine.Missing as missing:
        print(f"skipped: {missing}")
        return SKIPPED
    (build / "vm/console.txt").write_text(text)
    if machine.BEGIN not in text or machine.END not in text:
        print(text[-4000:])
        print("error: the machine ended without results")
        return 1
    results = json.loads(text.split(machine.BEGIN)[1].split(machine.END)[0])
    results["accelerator"] = accelerator
    results["udev_rule"] = rule_text()
    results_file.write_text(json.dumps(results, indent=1))
    print(f"Linux {results['kernel']}, {accelerator}; console in {build / 'vm/console.txt'}")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("what", choices=("run", "judge", "list"))
    parser.add_argument("bar", nargs="?", choices=list(bars.BARS))
    parser.add_argument("--build", type=pathlib.Path)
    parser.add_argument("--results", type=pathlib.Path)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    if arguments.what == "list":
        print("\n".join(bars.BARS))
        return 0
    if arguments.what == "run":
        code = run(arguments.build.resolve(), arguments.results.resolve(), arguments.only)
        if code != 0:
            return code
    if not arguments.results.exists():
        print("skipped: the machine did not run")
        return SKIPPED
    results = json.loads(arguments.results.read_text())
    if arguments.what == "judge":
        return 0 if judge(arguments.bar, results) else 1
    # The bars are tests of their own; here their lines only, for who runs the machine by hand.
    for name in bars.BARS:
        judge(name, results)
    return 0


if __name__ == "__main__":
    sys.exit(main())
