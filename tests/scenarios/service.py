"""footingd and footing-sim under a service manager: passed sockets, readiness, watchdog, farewell, restart.

Usage: service.py BINARY_FOLDER

The scenario plays systemd's part: it opens the listening sockets, passes them by LISTEN_FDS, and
reads what comes to NOTIFY_SOCKET.
"""
import fcntl
import os
import pathlib
import signal
import socket
import subprocess
import sys
import termios
import time
import urllib.request

import decode_stream
import harness

SOCKETS = ("sensor", "devices")
WATCHDOG_S = 1.0
FIRST_DESCRIPTOR = 3  # SD_LISTEN_FDS_START


class Manager:
    def __init__(self, binaries, folder, program="footingd", sockets=SOCKETS):
        self.program = pathlib.Path(binaries) / program
        self.folder = folder
        self.log = folder / f"{program}.log"
        self.sockets = {}
        for name in sockets:
            listening = socket.socket(socket.AF_UNIX)
            listening.bind(str(folder / f"{name}.sock"))
            listening.listen(16)
            self.sockets[name] = listening
        self.notices = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.notify = folder / f"notify-{program}"
        self.notices.bind(str(self.notify))
        self.process = None

    def start(self, *words, watchdog_s=0.0, names=SOCKETS):
        """As systemd does: the child's own process id must stand in its environment."""
        process = os.fork()
        if process != 0:
            self.process = process
            return
        try:
            environment = {**os.environ, "LISTEN_FDS": str(len(names)),
                           "LISTEN_FDNAMES": ":".join(names), "LISTEN_PID": str(os.getpid()),
                           "NOTIFY_SOCKET": str(self.notify)}
            if watchdog_s:
                environment.update(WATCHDOG_USEC=str(int(watchdog_s * 1e6)),
                                   WATCHDOG_PID=str(os.getpid()))
            log = os.open(self.log, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
            os.dup2(log, 1)
            os.dup2(log, 2)
            # Out of the way first: one of them may stand where another one goes.
            copies = [fcntl.fcntl(self.sockets[name], fcntl.F_DUPFD, 100) for name in names]
            for i, copy in enumerate(copies):
                os.dup2(copy, FIRST_DESCRIPTOR + i)
            os.closerange(FIRST_DESCRIPTOR + len(names), 256)
            os.execve(self.program, [str(self.program), *words], environment)
        finally:
            os._exit(127)

    def notice(self, timeout_s):
        """The lines of the next notice; none when it does not come in time."""
        self.notices.settimeout(timeout_s)
        try:
            return self.notices.recv(4096).decode().split("\n")
        except socket.timeout:
            return []

    def wait_for(self, line, timeout_s):
        deadline = time.monotonic() + timeout_s
        while (left_s := deadline - time.monotonic()) > 0:
            notice = self.notice(left_s)
            if line in notice:
                return notice
        raise AssertionError(f"{line} did not come within {timeout_s} s")

    def wait_for_exit(self, timeout_s=60):
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            ended, status = os.waitpid(self.process, os.WNOHANG)
            if ended:
                self.process = None
                return os.waitstatus_to_exitcode(status)
            time.sleep(0.02)
        raise AssertionError(f"footingd did not end within {timeout_s} s")

    def close(self):
        if self.process:
            os.kill(self.process, signal.SIGKILL)
            os.waitpid(self.process, 0)


class Caller:
    """A client that says hello at once, whether or not somebody listens yet."""

    def __init__(self, address):
        self.stream = decode_stream.Stream(address, 60)
        self.stream.send(1, decode_stream.number_field(1, 1) + decode_stream.number_field(3, 1))

    def welcome(self):
        while True:
            message = self.stream.receive()
            assert "refused" not in message and "goodbye" not in message, message
            if "welcome" in message:
                return message["welcome"]


def check_start(manager, address):
    early = Caller(address)  # Before the service is there: the manager's socket takes it.
    manager.start(watchdog_s=WATCHDOG_S)
    notice = manager.wait_for("READY=1", 60)
    assert "STATUS=listening on fd:sensor" in notice, notice
    # Ready means that it serves: who waited, and who comes now.
    epoch = early.welcome()["epoch"]
    assert Caller(address).welcome()["epoch"] == epoch
    return epoch


def check_watchdog(manager):
    """Twice in each interval: more than one and not many more than two on average, on a machine that stalls, too."""
    began_s, beats = time.monotonic(), 0
    while (intervals := (time.monotonic() - began_s) / WATCHDOG_S) < 5:
        beats += "WATCHDOG=1" in manager.notice(WATCHDOG_S)
    assert intervals < beats < 2 * intervals + 3, f"{beats} beats in {intervals} intervals"


def check_hangs_show(manager):
    """A daemon that stands still does not beat."""
    os.kill(manager.process, signal.SIGSTOP)
    while manager.notice(0.1):
        pass  # Sent before it stopped.
    assert not manager.notice(1.5 * WATCHDOG_S), "it beats while it stands still"
    os.kill(manager.process, signal.SIGCONT)
    manager.wait_for("WATCHDOG=1", 30)


def check_devices(stage, sensor):
    """A stand-in on the passed socket for devices reaches a client on the other one."""
    stage.start_user("walk", "--seconds", 120)
    for tick in harness.read_ticks(sensor, 60, ["motion"]):
        if tick.get("motion", {}).get("samples"):
            break
    else:
        raise AssertionError("no sample of the stand-in within 60 s")
    stage.stop("footing-stream")


def check_reload(manager):
    os.kill(manager.process, signal.SIGHUP)
    notice = manager.wait_for("RELOADING=1", 30)
    assert any(line.startswith("MONOTONIC_USEC=") for line in notice), notice
    manager.wait_for("READY=1", 30)
    assert "config reloaded: nothing has changed" in manager.log.read_text()


def check_farewell(manager):
    os.kill(manager.process, signal.SIGTERM)
    manager.wait_for("STOPPING=1", 30)
    code = manager.wait_for_exit()
    assert code == 0, f"exit code {code}"


def check_terminal(stage, words, ends):
    """A reload at a terminal, and what the end of the terminal does."""
    leader, terminal = os.openpty()
    log = stage.folder / f"terminal-{'ends' if ends else 'nohup'}.log"
    # A shell is the terminal's own process, as where a person types.
    with open(log, "w") as output:
        shell = subprocess.Popen(
            ["sh", "-c", 'trap "" HUP; "$@" & echo $!; wait', "sh", *map(str, words)] if not ends else
            ["sh", "-c", '"$@" & echo $!; wait', "sh", *map(str, words)],
            stdin=terminal, stdout=subprocess.PIPE, stderr=output, start_new_session=True, text=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))
    os.close(terminal)
    server = int(shell.stdout.readline())
    try:
        stage.wait_for(lambda: handles_hangup(server), "the server at its terminal")
        os.kill(server, signal.SIGHUP)
        stage.wait_for(lambda: "nothing has changed" in log.read_text(), "the reload")
        os.close(leader)  # The window is closed: the kernel takes the terminal away,
        os.kill(server, signal.SIGHUP)  # and an interactive shell passes its SIGHUP on.
        if ends:
            stage.wait_for(lambda: is_gone(server), "the server to end with its terminal")
        else:
            stage.wait_for(lambda: log.read_text().count("nothing has changed") >= 2, "the second reload")
            assert not is_gone(server), "nohup: it stays"
    finally:
        if not is_gone(server):
            os.kill(server, signal.SIGKILL)
        shell.kill()
        shell.communicate()


def handles_hangup(process):
    """Whether it has said what a SIGHUP does: the lowest bit of the signals that it catches."""
    status = pathlib.Path(f"/proc/{process}/status").read_text()
    return int(status.split("SigCgt:")[1].split()[0], 16) & 1 != 0


def is_gone(process):
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z"
    except FileNotFoundError:
        return True


def check_wrong_sockets(manager):
    """A socket that is not passed ends the start, with its name, and nobody is told it is ready."""
    manager.start("--listen", "fd:sensor", "--source", "stream:fd:tracker", names=("sensor",))
    code = manager.wait_for_exit()
    assert code == 2, f"exit code {code}"
    assert not manager.notice(0.2), "it said it was ready"
    assert "no socket was passed under the name tracker" in manager.log.read_text()


def check_metrics(manager):
    """Metrics on a passed socket of loopback speak in clear, to whoever reaches it; beyond loopback they are refused.
    Devices of other hosts come over a passed socket of TCP within TLS."""
    manager.sockets["metrics"] = socket.create_server(("127.0.0.1", 0))
    host, port = manager.sockets["metrics"].getsockname()
    words = ("--listen", "fd:sensor", "--source", "stream:fd:devices", "--metrics", "fd:metrics")
    manager.sockets["far"] = socket.create_server(("127.0.0.1", 0))
    token = manager.folder / "token"
    token.write_text("0123456789abcdef")
    token.chmod(0o600)
    manager.start(*words, "--source", "stream:fd:far", "--set", f"token_file={token}", names=(*SOCKETS, "metrics", "far"))
    manager.wait_for("READY=1", 60)
    text, port_of_far = manager.log.read_text(), manager.sockets["far"].getsockname()[1]
    assert f"listening on tls:127.0.0.1:{port_of_far}" in text and "devices of clients with the role control" in text, text
    with urllib.request.urlopen(f"http://{host}:{port}/metrics", timeout=30) as answer:
        assert b"footing_uptime_seconds" in answer.read()
    check_farewell(manager)
    manager.sockets["metrics"] = socket.create_server(("0.0.0.0", 0))
    manager.start(*words, names=(*SOCKETS, "metrics"))
    assert manager.wait_for_exit() == 2
    assert "passed as fd:metrics: it is not encrypted" in manager.log.read_text(), manager.log.read_text()[-500:]


def main(binaries):
    with harness.Stage(binaries) as stage:
        manager = Manager(binaries, stage.folder)
        try:
            check_start_to_end(stage, manager)
            check_metrics(manager)
        finally:
            manager.close()
        words = (stage.binaries / "footingd", "--listen", f"unix:{stage.folder}/t.sock", "--source",
                 f"stream:unix:{stage.folder}/td.sock")
        check_terminal(stage, words, ends=True)
        check_terminal(stage, words, ends=False)
        simulation = Manager(binaries, stage.folder, "footing-sim", ("simulation",))
        try:
            check_simulation(stage, simulation)
        finally:
            simulation.close()


def check_simulation(stage, manager):
    """The same of footing-sim, which is ready before any footingd is there."""
    early = Caller(stage.simulation)
    manager.start("--sensor", stage.sensor, watchdog_s=WATCHDOG_S, names=("simulation",))
    notice = manager.wait_for("READY=1", 60)
    assert "STATUS=engine gait" in notice, notice
    early.welcome()
    check_watchdog(manager)
    check_reload(manager)
    check_farewell(manager)


def check_start_to_end(stage, manager):
    address = stage.sensor
    files = {name: os.stat(stage.folder / f"{name}.sock").st_ino for name in SOCKETS}
    first = check_start(manager, address)
    check_watchdog(manager)
    check_hangs_show(manager)
    check_devices(stage, address)
    check_reload(manager)
    check_farewell(manager)
    for name, number in files.items():
        assert os.stat(stage.folder / f"{name}.sock").st_ino == number, f"{name}.sock was replaced"

    between = Caller(address)  # Nobody is there, and yet it is not refused.
    manager.start()
    manager.wait_for("READY=1", 60)
    second = between.welcome()["epoch"]
    assert second != first, "a restart is a new epoch"
    assert not manager.notice(1.5 * WATCHDOG_S), "beats that no manager asked for"
    check_farewell(manager)
    check_wrong_sockets(manager)
    print("sockets passed, ready, alive, standing still seen, stopped, restarted on the same sockets")


if __name__ == "__main__":
    main(sys.argv[1])
