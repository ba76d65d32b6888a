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

    def stop(self, name, how=signal.SIGTERM, timeout_s=10):
        """Ends a program and returns its exit code."""
        process = self.processes.pop(name)
        process.send_signal(how)
        return process.wait(timeout_s)

    def run(self, program, *words, timeout_s=60):
        return subprocess.run([self.binaries / program, *map(str, words)], capture_output=True,
                              text=True, timeout=timeout_s, stdin=subprocess.DEVNULL, check=False)

    def run_json(self, program, *words, timeout_s=60):
        done = self.run(program, *words, "--json", timeout_s=timeout_s)
        assert done.returncode == 0, f"{program} {words}: {done.returncode}\n{done.stdout}\n{done.stderr}"
        return json.loads(done.stdout)

    def wait_for(self, condition, what, timeout_s=10.0):
        """Polls until the condition holds; the one place where a scenario waits for a state."""
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            value = condition()
            if value:
                return value
            time.sleep(0.02)
        raise AssertionError(f"waited {timeout_s} s for {what}")

    def wait_for_socket(self, address, timeout_s=10.0):
        path = pathlib.Path(address.removeprefix("unix:"))
        self.wait_for(path.is_socket, f"{address} to open", timeout_s)

    def start_servers(self, interface="wrist"):
        self.start("footingd", "--listen", self.sensor, "--source", f"stream:{self.devices}")
        self.wait_for_socket(self.sensor)
        self.wait_for_socket(self.devices)
        self.start("footing-sim", "--sensor", self.sensor, "--listen", self.simulation,
                   "--interface", interface)
        self.wait_for_socket(self.simulation)

    def start_user(self, script, *words, seed=1, interface="wrist"):
        return self.start("footing-stream", "user", "--script", script, "--interface", interface,
                          "--to", self.devices, "--seed", seed, *words)
