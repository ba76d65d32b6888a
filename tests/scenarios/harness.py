"""Starts whole programs for a scenario on sockets of its own and ends every one of them.

Usage in a scenario: `with Stage(binary_folder) as stage: stage.start("footingd", ...)`.
"""
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time

import decode_stream

# Of a wait for what comes at once on an idle machine: a stall of the machine must not end it.
PATIENCE_S = 30
ACCEPTS = 1 << 16  # __SO_ACCEPTCON of the kernel: the socket listens.


def is_listening(path):
    """Whether a program listens on the Unix socket. Its file is there before that, and after a program that was killed."""
    with open("/proc/net/unix", encoding="utf-8") as table:
        rows = [line.split(maxsplit=7) for line in table]
    return any(len(row) == 8 and row[7].strip() == str(path) and int(row[3], 16) & ACCEPTS for row in rows[1:])


def read_ticks(address, seconds, channels=()):
    """The ticks of a server for so long, with the project's independent decoder."""
    stream = decode_stream.Stream(address, seconds + 5)
    stream.send(1, decode_stream.number_field(1, 1) + decode_stream.number_field(3, 1))
    wish = b"".join(decode_stream.bytes_field(1, name.encode()) for name in channels)
    stream.send(4, wish + decode_stream.number_field(3, 2) + decode_stream.number_field(4, 1024))
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        message = stream.receive()
        if "ping" in message:
            now_ns, ping = time.monotonic_ns(), message["ping"]
            stream.send(7, b"".join(decode_stream.number_field(i + 1, value) for i, value in
                                    enumerate((ping["id"], ping["t0_ns"], now_ns, now_ns))))
        assert "refused" not in message and "goodbye" not in message, message
        if "tick" in message:
            yield message["tick"]


class Stage:
    def __init__(self, binaries):
        self.binaries = pathlib.Path(binaries)
        self.processes = {}
        self._folder = tempfile.TemporaryDirectory(prefix="footing-scenario.")
        self.folder = pathlib.Path(self._folder.name)
        self.sensor = f"unix:{self.folder}/sensor.sock"
        self.devices = f"unix:{self.folder}/devices.sock"
        self.simulation = f"unix:{self.folder}/simulation.sock"

    def __enter__(self):
        return self

    def __exit__(self, kind, value, traceback):
        for process in self.processes.values():
            if process.poll() is None:
                process.kill()
            process.wait()
        if kind is not None:
            for log in sorted(self.folder.glob("*.log")):
                print(f"--- {log.name}\n{log.read_text()[-2000:]}")
        self._folder.cleanup()

    def start(self, program, *words, name=None):
        name = name or program
        environment = dict(os.environ, XDG_STATE_HOME=f"{self.folder}/state")
        with open(self.folder / f"{name}.log", "w") as log:
            process = subprocess.Popen([self.binaries / program, *map(str, words)], stdout=log,
                                       stderr=log, stdin=subprocess.DEVNULL,
                                       env=environment)
        self.processes[name] = process
        return process

    def stop(self, name, how=signal.SIGTERM, timeout_s=PATIENCE_S):
        """Ends a program and returns its exit code."""
        process = self.processes.pop(name)
        process.send_signal(how)
        return process.wait(timeout_s)

    def run(self, program, *words, timeout_s=120):
        return subprocess.run([self.binaries / program, *map(str, words)], capture_output=True,
                              text=True, timeout=timeout_s, stdin=subprocess.DEVNULL, check=False)

    def run_json(self, program, *words, timeout_s=120):
        done = self.run(program, *words, "--json", timeout_s=timeout_s)
        assert done.returncode == 0, f"{program} {words}: {done.returncode}\n{done.stdout}\n{done.stderr}"
        return json.loads(done.stdout)

    def wait_for(self, condition, what, timeout_s=PATIENCE_S):
        """Polls until the condition holds; the one place where a scenario waits for a state."""
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            value = condition()
            if value:
                return value
            time.sleep(0.02)
        raise AssertionError(f"waited {timeout_s} s for {what}")

    def wait_for_socket(self, address, timeout_s=PATIENCE_S):
        self.wait_for(lambda: is_listening(address.removeprefix("unix:")), f"{address} to open", timeout_s)

    def wait_for_devices(self, count=2):
        """Until footingd has so many devices and all of them deliver."""
        def all_live():
            done = self.run("footing-ctl", "--connect", self.sensor, "devices", "--json")
            devices = json.loads(done.stdout)["devices"] if done.stdout else []
            return len(devices) == count and all(one["state"] == "live" for one in devices) and devices

        return self.wait_for(all_live, f"{count} live devices")

    def check_missing(self, address, missing):
        """Fails when more ticks of a server are missing than it says it left out, because the machine did not let it run."""
        def left_out():
            return self.run_json("footing-ctl", "--connect", address, "status")["stats"]["ticks"]["left_out"]

        # It counts once a second.
        self.wait_for(lambda: left_out() >= missing, f"{address} to explain that {missing} of its ticks are missing", 5)

    def start_servers(self, *words, interface="wrist"):
        self.start("footingd", "--listen", self.sensor, "--source", f"stream:{self.devices}", *words)
        self.wait_for_socket(self.sensor)
        self.wait_for_socket(self.devices)
        self.start("footing-sim", "--sensor", self.sensor, "--listen", self.simulation,
                   "--interface", interface)
        self.wait_for_socket(self.simulation)

    def start_user(self, script, *words, seed=1, interface="wrist"):
        return self.start("footing-stream", "user", "--script", script, "--interface", interface,
                          "--to", self.devices, "--seed", seed, *words)
