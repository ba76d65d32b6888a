"""Debian's nats-server and mosquitto on free ports of loopback, for scenarios that need a broker.

Installed they are system services; here each is a process of the scenario's own, with files in the
scenario's folder. scripts/dependencies-scale.txt names the packages.
"""
import os
import shutil
import signal
import socket
import subprocess
import time

from ports import free_port

SKIPPED = 77


def find(program):
    """The program's path, or None. Debian has servers where an ordinary user's PATH does not look."""
    return shutil.which(program, path=os.environ.get("PATH", "") + os.pathsep + "/usr/sbin")


def skip_without(*programs):
    missing = [program for program in programs if find(program) is None]
    if missing:
        print(f"skipped: not installed: {', '.join(missing)}; "
              "scripts/install-dependencies scripts/dependencies-scale.txt")
        raise SystemExit(SKIPPED)


class Broker:
    def __init__(self, folder, command, port):
        self.port, self.command = port, command
        self.log = folder / f"{os.path.basename(command[0])}-{port}.log"
        self.process = None
        self.start()

    def start(self):
        with open(self.log, "ab") as log:
            self.process = subprocess.Popen(self.command, stdout=log, stderr=log, stdin=subprocess.DEVNULL)
        deadline = time.monotonic() + 10
        while time.monotonic() < deadline:
            try:
                socket.create_connection(("127.0.0.1", self.port), 1).close()
                return
            except OSError:
                time.sleep(0.02)
        raise AssertionError(f"{self.command[0]} does not listen:\n{self.log.read_text()[-2000:]}")

    def stop(self, how=signal.SIGKILL):
        if self.process.poll() is None:
            self.process.send_signal(how)
        self.process.wait(10)

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        self.stop()


def nats(folder, *words, port=None):
    port = port or free_port()
    return Broker(folder, [find("nats-server"), "-a", "127.0.0.1", "-p", str(port), *words], port)


def mosquitto(folder, *lines, port=None):
    port = port or free_port()
    config = folder / f"mosquitto-{port}.conf"
    config.write_text("\n".join([f"listener {port} 127.0.0.1", "allow_anonymous true", "persistence false",
                                 *lines]) + "\n")
    return Broker(folder, [find("mosquitto"), "-c", str(config)], port)


class MqttReader:
    """A subscriber of MQTT 3.1.1, QoS 0, with nothing but sockets."""

    def __init__(self, port, topic, timeout_s=10):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout_s)
        self.send(0x10, self.text(b"MQTT") + b"\x04\x02\x00\x00" + self.text(f"reader-{os.getpid()}".encode()))
        kind, body = self.receive()
        assert kind == 0x20 and body[1] == 0, (kind, body)
        self.send(0x82, b"\x00\x01" + self.text(topic.encode()) + b"\x00")

    @staticmethod
    def text(data):
        return len(data).to_bytes(2, "big") + data

    def send(self, kind, body):
        length, left = bytearray(), len(body)
        while True:
            length.append(left % 128 | (0x80 if left >= 128 else 0))
            left //= 128
            if not left:
                break
        self.socket.sendall(bytes([kind]) + bytes(length) + body)

    def exactly(self, size):
        data = bytearray()
        while len(data) < size:
            piece = self.socket.recv(size - len(data))
            if not piece:
                raise EOFError("the broker closed the connection")
            data += piece
        return bytes(data)

    def receive(self):
        kind, size, shift = self.exactly(1)[0], 0, 0
        while True:
            byte = self.exactly(1)[0]
            size |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return kind, self.exactly(size)

    def messages(self, seconds):
        """(topic, payload, whether the broker had kept it) for so long."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            self.socket.settimeout(max(0.01, deadline - time.monotonic()))
            try:
                kind, body = self.receive()
            except TimeoutError:
                return
            if kind & 0xF0 == 0x30:
                size = int.from_bytes(body[:2], "big")
                yield body[2:2 + size].decode(), body[2 + size:], bool(kind & 1)
