"""Runs every example of every program's --help as it stands, and the commands of README.md, beside
simulated devices. The files that they read are written by `footing-stream sample`.

An example passes when it ends with 0, or still runs after a few seconds; what cannot end with 0 here
is listed in EXPECTED with its reason. Exit code 2 (usage) never passes.

Usage: examples.py BINARY_FOLDER [PROGRAM]...
"""
import os
import pathlib
import re
import shlex
import signal
import subprocess
import sys

from harness import Stage

README = pathlib.Path(__file__).resolve().parents[2] / "README.md"
PROGRAMS = ("footing-stream", "footing-ctl", "footing-view", "footing-log", "footingd", "footing-sim",
            "footing-eval", "footing-train", "footing-tune", "footing-bench")
RUNS_FOR_S = 4
# Start of an example, the codes besides 0 that it may end with, and why.
EXPECTED = (
    ("footing-ctl pair", {1, 3}, "needs Bluetooth and a device"),
    ("footing-ctl doctor", {1}, "reports the faults of the host that the test runs on"),
    ("footing-ctl setup", {1}, "waits for a person"),
    ("footing-ctl layout --preset", {1}, "waits for a person"),
    ("footing-ctl assign --gesture", {1}, "waits for a person"),
    ("footing-ctl acceptance --replay", {1, 4}, "reads the recording of a whole acceptance"),
    ("footing-ctl acceptance", {1}, "takes minutes, with a person"),
    ("footing-ctl assign 00:", {3}, "names a device of one's own by its serial"),
    ("footing-ctl led 00:", {3}, "names a device of one's own by its serial"),
    ("footing-ctl led head", {3}, "needs a PS Move on the head"),
    ("footing-ctl trust", {2}, "is not built"),
    ("footing-log repair", {4}, "needs a recording that was cut off"),
    ("footing-eval pose --motion squats", {4}, "needs a recording of force plates"),
    ("footing-tune --gait walk --speeds 0.5 --from", {1, 4}, "reads a table of an earlier run"),
    ("footing-train com", {1, 4}, "needs motion capture of several people"),
    ("footing-train basis", {1, 4}, "needs motion capture of several people"),
    ("footing-train pose", {1, 4}, "needs motion capture of several people"),
    ("footing-train arm", {1, 4}, "needs motion capture of several people"),
)


class Line(Stage):
    """A stage whose servers have the default addresses of a user of their own."""

    def __init__(self, binaries):
        super().__init__(binaries)
        run = self.folder / "run"
        run.mkdir(mode=0o700)
        os.environ.update(XDG_RUNTIME_DIR=str(run), XDG_STATE_HOME=str(self.folder / "state"),
                          PATH=f"{self.binaries}:{os.environ['PATH']}")
        os.environ.pop("DISPLAY", None)
        os.environ.pop("WAYLAND_DISPLAY", None)
        self.sensor = f"unix:{run}/footing/sensor.sock"
        self.devices = f"unix:{run}/footing/devices.sock"
        self.simulation = f"unix:{run}/footing/simulation.sock"

    def sample(self):
        done = self.run("footing-stream", "sample", self.folder)
        assert done.returncode == 0, done

    def start_sensor(self):
        self.start("footingd")
        self.wait_for_socket(self.sensor)
        self.wait_for_socket(self.devices)

    def start_simulation(self, engine):
        self.start("footing-sim", "--engine", engine)
        self.wait_for_socket(self.simulation)

    def start_devices(self):
        """Two Wiimotes and a board."""
        self.start("footing-stream", "user", name="user")
        self.start("footing-stream", "corners", "--left", self.folder / "corners.csv",
                   "--seed", "2", name="board")
        self.wait_for(lambda: self.run("footing-ctl", "devices", "--json").stdout.count('"live"') == 3,
                      "three live devices", 30)

    def example(self, command):
        """Runs one as a shell does; returns its exit code, 0 when it had to be stopped."""
        process = subprocess.Popen(["bash", "-c", "exec " + command], cwd=self.folder,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)
        try:
            return process.communicate(timeout=RUNS_FOR_S), process.returncode
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGINT)
        try:
            return process.communicate(timeout=RUNS_FOR_S), 0
        except subprocess.TimeoutExpired:
            process.kill()
            return process.communicate(), 0


def help_of(stage, *words):
    done = stage.run(*words, "--help")
    assert done.returncode == 0, (words, done)
    return done.stdout


def examples_in(text):
    """The commands below the heading Examples, joined where a line ends with a backslash."""
    after = re.split(r"^Examples?:\s*\n", text, flags=re.M)[1:]
    if not after:
        return []
    lines = re.sub(r"\\\n\s*", "", after[-1]).splitlines()
    return [line.strip() for line in lines if re.match(r"\s+(sudo )?footing", line)]


def examples_of(stage, program):
    text = help_of(stage, program)
    found = examples_in(text)
    part = re.search(r"^Subcommands:\n((?:.+\n)+)", text, re.M)
    for name in re.findall(r"^  (\S+)", part[1] if part else "", re.M):
        found += examples_in(help_of(stage, program, name))
    assert found, f"{program} --help has no example"
    return list(dict.fromkeys(found))


def readme_commands():
    """What README's fences run of our programs, without the comment and the final &."""
    fences = re.findall(r"^```\n(.*?)^```", README.read_text(), re.M | re.S)
    lines = [line.split("#")[0].strip().rstrip("&").strip() for text in fences
             for line in text.splitlines()]
    return [line for line in lines if re.match(r"(build/release/bin/)?footing(d|-[a-z]+)( |$)", line)]


def allowed(command):
    for start, codes, _ in EXPECTED:
        if command.startswith(start):
            return codes
    return set()


def run_all(stage, commands):
    failures = []
    for command in commands:
        bare = command.removeprefix("sudo ").removeprefix("build/release/bin/")
        output, code = stage.example(bare)
        if code != 0 and code not in allowed(bare):
            failures.append(f"{command}: exit code {code}\n    {(output[0] or '').strip()[-500:]}")
    return failures


def check_clients(binaries, programs):
    """Beside the whole line; those of the pose engine beside that engine."""
    wanted = [name for name in ("footing-ctl", "footing-view", "footing-log") if name in programs]
    failures, pose = [], []
    with Line(binaries) as stage:
        stage.sample()
        stage.start_sensor()
        stage.start_simulation("gait")
        stage.start_devices()
        for program in wanted:
            examples = examples_of(stage, program)
            of_pose = [one for one in examples if re.search(r" (t-pose|subject) ?", one)]
            pose += of_pose
            failures += run_all(stage, [one for one in examples if one not in of_pose])
    if pose:
        with Line(binaries) as stage:
            stage.sample()
            stage.start_sensor()
            stage.start_simulation("pose")
            failures += run_all(stage, pose)
    return failures


def check_servers(binaries, programs):
    """Each server and device simulator beside what it needs, one example at a time."""
    failures = []
    commands = []
    for program in ("footingd", "footing-sim", "footing-stream"):
        if program in programs:
            with Line(binaries) as stage:
                commands += examples_of(stage, program)
    for command in commands:
        with Line(binaries) as stage:
            stage.sample()
            if not command.startswith("footingd"):
                stage.start_sensor()
            failures += run_all(stage, [command])
    return failures


def check_offline(binaries, programs):
    failures = []
    for program in ("footing-eval", "footing-train", "footing-tune", "footing-bench"):
        if program not in programs:
            continue
        with Line(binaries) as stage:
            stage.sample()
            failures += run_all(stage, examples_of(stage, program))
    return failures


def check_readme(binaries):
    commands = readme_commands()
    assert len(commands) >= 3, commands
    failures = []
    for command in commands:
        program = pathlib.Path(shlex.split(command)[0]).name
        assert (pathlib.Path(binaries) / program).exists(), f"README runs {program}"
        with Line(binaries) as stage:
            stage.sample()
            if program != "footingd":
                stage.start_sensor()
            if program in ("footing-view", "footing-log"):
                stage.start_simulation("gait")
            failures += run_all(stage, [command])
    return failures


def main(binaries, *programs):
    missing = [name for name in PROGRAMS if not (pathlib.Path(binaries) / name).exists()]
    assert programs or not missing, f"not built: {missing}"
    programs = programs or PROGRAMS
    failures = check_servers(binaries, programs)
    failures += check_clients(binaries, programs)
    failures += check_offline(binaries, programs)
    failures += check_readme(binaries)
    for failure in failures:
        print(failure)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
