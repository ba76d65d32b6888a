#!/usr/bin/env python3
"""Every example of every --help, and every command in README and docs, runs as it stands.

Usage: examples.py BINARY_FOLDER [--only TEXT] [--list]

The examples run in their own folder and with sockets of their own (XDG_RUNTIME_DIR), beside a footingd and a
footing-sim with simulated controllers and boards, as a reader would run them. A command that ends by itself must end
with 0. One that runs until Ctrl-C, or long, is interrupted after a few seconds and must not have failed until then.
What cannot run here is listed below with its reason, and each of those reasons must still apply to a command.
"""
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from harness import Stage

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = ["README.md", "systemd/README.md", *sorted(str(page.relative_to(ROOT)) for page in ROOT.glob("docs/**/*.md"))]
PROGRAMS = ["footingd", "footing-sim", "footing-stream", "footing-view", "footing-log", "footing-ctl", "footing-eval",
            "footing-train", "footing-tune", "footing-bench", "footing-study", "footing-game", "footing-skeleton",
            "footing-camera", "footing-relay"]
SECONDS_TO_WATCH = 3
SECONDS_TO_STOP = 60
# A pattern of commands, and why they cannot run here.
NOT_HERE = {
    r"^footing-ctl (pair|setup|assign|acceptance|sway|tare|layout .*--check)": "asks a person; scenarios setup_* and scenarios.sway run them",
    r"--calibrate-camera": "asks a person; tests/clients/view/pose_calibration_test.cc has one",
    r"^footing-ctl motions|p07\.mcap": "takes two minutes; scenario person_model runs it",
    r"layout --preset single|stand/footingd_boards": "needs one board alone, with a person on it",
    r"^footing-ctl led (00:|head)": "needs that device",
    r"^footing-ctl interface leg": "needs remotes on the legs; scenario joystick_line changes interfaces",
    r"^footing-ctl trial withdraw": "needs a failure; scenario trial runs it",
    r"^footing-ctl doctor": "judges the whole machine, with the daemons of other tests; scenarios.ctl runs it",
    r"^footing-log recalibrate|--hands camera": "needs a recording of a camera; tests/clients/log has one",
    r"^footing-eval sphere|^footing-camera": "renders frames, or reads them; scenario camera_line runs them",
    r"^sudo ": "as root",
    r"\.\.\.": "stands for the words before it",
    r"\b[A-Z]{2,}\b(?!=)": "has a word to fill in",
    r"mocap|\.asf|\.amc|\.trc|squats\.c3d|me\.mcap|me\.bvh|me/|other\.bvh": "reads motion capture of one's own; tests/offline runs it on recordings",
    r"tcp:|tls:": "needs an address of this host, or a server on another one",
    r"/etc/footing/": "reads the administrator's settings",
    r"0\.0\.0\.0|sensors --listen 192": "would listen to other hosts",
    r"wave\.csv": "reads a Kinect's recording; tests/clients/skeleton does",
    r"^footing-ctl discover": "needs the system bus and Avahi; scenario discovery has both",
    r"study\.mcap": "reads recorded trials; scenario playback runs it",
    r"^footing-study (run|analyze|report|export)": "needs whole sessions; tests/clients/study/session_scenario.py runs them",
    r"^footing-study (ranges|survey)|interface .* --table": "needs a person; tests/clients/study/*_scenario.py have one",
    r"short\.study/P01": "plays a trial of a whole session; tests/clients/study/simulate_scenario.py has some",
    r"again\.mcap|first\.mcap|body\.mcap|game\.mcap": "reads what a command above would have recorded",
}
# Those that connect to a pose engine, or read what was recorded of one.
POSE_ENGINE = re.compile(r"^footing-ctl (t-pose|subject|mode)|--next-subject|(session|smooth)\.mcap")


def commands_of_text(text):
    """Commands at the start of a line, with their continuation lines, without prompts, comments and '&'."""
    text = text.replace("\\\n", " ")
    for line in text.splitlines():
        line = line.strip().removeprefix("$ ")
        for part in line.split(" & "):
            part = re.sub(r"(\s#.*|\s&)\s*$", "", re.sub(r"\s+#\s.*$", "", part)).strip()
            if re.match(r"(sudo )?(%s)( |$)" % "|".join(PROGRAMS), part):
                yield re.sub(r"\s+", " ", part)


def commands_of_page(page):
    """Commands in fences and in lines indented by four spaces."""
    fenced = False
    lines = []
    for line in page.read_text().splitlines():
        if line.startswith("```"):
            fenced = not fenced
        elif fenced or line.startswith("    "):
            lines.append(line)
    return commands_of_text("\n".join(lines))


def help_of(binaries, *words):
    return subprocess.run([binaries / words[0], *words[1:], "--help"], capture_output=True, text=True, check=True).stdout


def examples_of(text):
    _, found, examples = text.partition("Example")
    return commands_of_text(examples) if found else []


def all_commands(binaries):
    """Command to where it stands, in the order of their first appearance."""
    found = {}
    for program in PROGRAMS:
        text = help_of(binaries, program)
        for command in examples_of(text):
            found.setdefault(command, f"{program} --help")
        listed = re.search(r"^Subcommands:\n((?:  .*\n)+)", text, re.M)
        for name in re.findall(r"^  ([a-z][\w-]*)", listed.group(1), re.M) if listed else []:
            for command in examples_of(help_of(binaries, program, name)):
                found.setdefault(command, f"{program} {name} --help")
    for page in PAGES:
        for command in commands_of_page(ROOT / page):
            found.setdefault(command, page)
    return found


def run(stage, command, environment, folder):
    """None when it ran as it should, or what went wrong."""
    words = shlex.split(command)
    words[0] = str(stage.binaries / words[0])
    process = subprocess.Popen(words, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True)
    try:
        text, _ = process.communicate(timeout=SECONDS_TO_WATCH)
        return None if process.returncode == 0 else f"exit code {process.returncode}: {text[-600:]}"
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGINT)
    try:
        text, _ = process.communicate(timeout=SECONDS_TO_STOP)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return f"did not end within {SECONDS_TO_STOP} s of Ctrl-C"
    failed = process.returncode not in (0, -signal.SIGINT, 130) or "error:" in text
    return f"interrupted, exit code {process.returncode}: {text[-600:]}" if failed else None


def record(folder, environment, binaries, name, seconds):
    subprocess.run([binaries / "footing-log", "record", "--from-ring", "--seconds", str(seconds), "--out", name], cwd=folder,
                   env=environment, check=True, capture_output=True)


def start_walk(stage):
    stage.start("footingd", "--set", "state_directory=none")
    stage.start("footing-sim", "--engine", "gait")
    stage.wait_for_socket(stage.simulation)
    stage.start("footing-stream", "user", "--script", "demo", "--interface", "wrist", name="user")
    stage.wait_for_devices()
    time.sleep(2)  # Something to record.


def stop_all(stage):
    for name in list(stage.processes):
        stage.stop(name)


def clear_outputs(folder, command):
    """An output of an earlier example is in the way of a later one; a recording would not be overwritten."""
    words = shlex.split(command)
    for flag, name in zip(words, words[1:]):
        path = folder / name
        if flag == "--out" and path.exists():
            shutil.rmtree(path) if path.is_dir() else path.unlink()


def main():
    binaries = pathlib.Path(sys.argv[1]).resolve()
    only = sys.argv[sys.argv.index("--only") + 1] if "--only" in sys.argv else ""
    commands = {command: place for command, place in all_commands(binaries).items() if only in command}
    skipped = {command: reason for command in commands for pattern, reason in NOT_HERE.items()
               if re.search(pattern, command)}
    unused = [pattern for pattern in NOT_HERE if not only and not any(re.search(pattern, one) for one in commands)]
    assert not unused, f"no command needs these exceptions: {unused}"
    if "--list" in sys.argv:
        for command, place in commands.items():
            print(f"{'-' if command in skipped else '+'} {place}: {command}")
        return 0
    failed = []
    with Stage(binaries) as stage, tempfile.TemporaryDirectory(prefix="footing-examples.") as name:
        folder = pathlib.Path(name)
        runtime = stage.folder / "run"
        runtime.mkdir(mode=0o700)
        stage.sensor, stage.simulation = (f"unix:{runtime}/footing/{name}.sock" for name in ("sensor", "simulation"))
        environment = dict(os.environ, XDG_RUNTIME_DIR=str(runtime), XDG_STATE_HOME=str(stage.folder / "state"),
                           PATH=f"{binaries}:{os.environ['PATH']}")
        environment.pop("DISPLAY", None)
        os.environ.update(environment)
        # What the examples read beside the files of footing-stream sample: recordings, one of them cut, and a table.
        subprocess.run([binaries / "footing-stream", "sample", "."], cwd=folder, check=True, env=environment)
        for protocol in ("study.json", "short-study.json", "latency.json"):
            shutil.copy(ROOT / "docs/examples" / protocol, folder)
        for config in ("footingd.json", "sim.json"):
            (folder / config).write_text("{}  // All defaults.\n")
        start_walk(stage)
        record(folder, environment, binaries, "walk.mcap", 4)
        stop_all(stage)
        whole = (folder / "walk.mcap").read_bytes()
        (folder / "a.mcap").write_bytes(whole)
        (folder / "cut.mcap").write_bytes(whole[:len(whole) * 2 // 3])

        def try_out(command):
            clear_outputs(folder, command)
            if "walk.csv" in command:  # The search that writes it takes longer than this watches.
                shutil.copy(ROOT / "daemon/simulation/data/gaits/walk.csv", folder)
            problem = run(stage, command, environment, folder)
            if problem:
                failed.append((commands[command], command, problem))

        servers = ("footingd", "footing-sim", "footing-stream")
        runnable = [one for one in commands if one not in skipped]
        for command in [one for one in runnable if one.split()[0] in servers]:
            if command.startswith("footing-stream"):
                stage.start("footingd", "--set", "state_directory=none")
                stage.wait_for_socket(stage.sensor)
            try_out(command)
            stop_all(stage)
        start_walk(stage)
        subprocess.run([binaries / "footing-ctl", "layout", "--preset", "one_foot_each"], env=environment, check=True,
                       capture_output=True)
        for command in [one for one in runnable if one.split()[0] not in servers and not POSE_ENGINE.search(one)]:
            try_out(command)
        stage.stop("footing-sim")
        stage.stop("user")
        stage.start("footing-sim", "--engine", "pose")
        stage.wait_for_socket(stage.simulation)
        stage.start("footing-stream", "boards", "--motion", "demo", "--hands", "move")
        # On a busy machine a view may end before a server has answered it: with 3, and then the next one asks.
        stage.wait_for(lambda: json.loads(subprocess.run(
            [binaries / "footing-view", "--text", "--seconds", "2", "--json"], env=environment, check=False,
            capture_output=True, text=True).stdout or "{}").get("calibrated"), "the T-pose", timeout_s=90)
        record(folder, environment, binaries, "session.mcap", 3)
        for command in [one for one in runnable if POSE_ENGINE.search(one)]:
            try_out(command)
    for place, command, problem in failed:
        print(f"{place}: {command}\n  {problem}")
    ran = len(commands) - len(skipped)
    print(f"{ran - len(failed)} of {ran} examples ran; {len(skipped)} cannot run here")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
