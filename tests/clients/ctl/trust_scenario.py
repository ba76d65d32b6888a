"""footingd on a tls: address, with footing-ctl from another machine's point of view.

What the first connection remembers, what `trust` prints and enters, how a changed certificate and a
missing token are refused, and that nothing secret is in a log.

Usage: trust_scenario.py SCENARIOS_FOLDER BINARY_FOLDER
"""
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import time

sys.path.insert(0, sys.argv[1])
from harness import Stage  # noqa: E402
from service import Manager  # noqa: E402

TOKEN = "correct-horse-battery-staple"
SQUARES = "▀▄"  # Of a QR code in a terminal, two to a character.


def start_footingd(stage, port, name):
    """footingd on a TLS port; its address and the fingerprint that its log has."""
    stage.start("footingd", "--listen", f"tls:127.0.0.1:{port}", "--source",
                f"stream:{stage.devices}", "--set", f"token_file={stage.folder}/token", name=name)
    log = stage.folder / f"{name}.log"
    deadline = time.monotonic() + 30
    while time.monotonic() < deadline:
        found = re.search(r"listening on (tls:127\.0\.0\.1:\d+), certificate (sha256:\w{64})",
                          log.read_text())
        if found:
            return found.group(1), found.group(2)
        time.sleep(0.02)
    raise AssertionError(log.read_text())


def read_all(leader):
    """What a program wrote to the terminal whose leader this is."""
    shown = b""
    try:
        while piece := os.read(leader, 1 << 16):
            shown += piece
    except OSError:  # Its end, where the leader is read.
        os.close(leader)
    return shown.decode()


def check_server_side(stage, fingerprint):
    shown = stage.run_json("footing-ctl", "trust")
    assert shown["fingerprint"] == fingerprint, (shown, fingerprint)
    file = pathlib.Path(shown["file"])
    assert file.stat().st_mode & 0o777 == 0o600, file
    assert file.parent == stage.folder / "state/footing", file
    text = stage.run("footing-ctl", "trust").stdout
    assert fingerprint in text and "PRIVATE" not in text, text
    assert not any(square in text for square in SQUARES), "a QR code is for a person at a terminal"
    leader, terminal = os.openpty()
    subprocess.run([stage.binaries / "footing-ctl", "trust"], stdout=terminal, check=True, timeout=60)
    os.close(terminal)
    shown = read_all(leader)
    assert fingerprint in shown and all(square in shown for square in SQUARES), shown
    missing = stage.folder / "none/identity.pem"
    shown = stage.run("footing-ctl", "trust", "--identity", missing)
    assert shown.returncode == 1 and "when it first listens" in shown.stderr, shown
    assert not missing.parent.exists(), "showing makes nothing"
    both = stage.run("footing-ctl", "trust", "--client", "--identity", file)
    assert both.returncode == 2 and "excludes" in both.stderr, both


def check_client(stage, address, fingerprint):
    without = stage.run("footing-ctl", "--connect", address, "status")
    assert without.returncode == 1 and "FOOTING_TOKEN_FILE" in without.stderr, without
    assert f"trusting {address} from now on" in without.stderr, without
    assert fingerprint in without.stderr, (fingerprint, without)
    os.environ["FOOTING_TOKEN_FILE"] = f"{stage.folder}/token"
    status = stage.run_json("footing-ctl", "--connect", address, "status")
    assert status["granted_role"] == "ROLE_CONTROL", status


def check_changed(stage, address, first, second):
    refused = stage.run("footing-ctl", "--connect", address, "status")
    assert refused.returncode == 1, refused
    assert "THE CERTIFICATE HAS CHANGED" in refused.stderr, refused
    assert first in refused.stderr and second in refused.stderr, refused
    wrong = stage.run("footing-ctl", "trust", address, "sha256:12")
    assert wrong.returncode == 2 and "not a fingerprint" in wrong.stderr, wrong
    unencrypted = stage.run("footing-ctl", "trust", "tcp:127.0.0.1:1", second)
    assert unencrypted.returncode == 2 and "has no certificate" in unencrypted.stderr, unencrypted
    assert stage.run("footing-ctl", "trust", address, second).returncode == 0
    assert stage.run("footing-ctl", "--connect", address, "status").returncode == 0


def check_client_certificate(stage):
    first = stage.run_json("footing-ctl", "trust", "--client")
    again = stage.run_json("footing-ctl", "trust", "--client")
    assert first == again and first["line"].startswith(first["fingerprint"] + " view "), first
    clients = stage.folder / "clients"
    clients.write_text("# the lab\n" + first["line"] + "\n")
    clients.chmod(0o600)
    daemon = stage.start("footingd", "--listen", "tls:127.0.0.1:0", "--json", "--source",
                f"stream:unix:{stage.folder}/more.sock", "--set",
                f"clients_file={stage.folder}/clients", name="with_clients")
    log = stage.folder / "with_clients.log"
    deadline = time.monotonic() + 30
    while "listening_on" not in log.read_text() and time.monotonic() < deadline:
        time.sleep(0.02)
    line = next(line for line in log.read_text().splitlines() if line.startswith("{"))
    del os.environ["FOOTING_TOKEN_FILE"]
    address = json.loads(line)["listening_on"][0]
    status = stage.run_json("footing-ctl", "--connect", address, "status")
    assert status["granted_role"] == "ROLE_VIEW", status
    # The roles of sessions that come are what the file says now.
    clients.write_text(first["line"].replace(" view ", " control ") + "\n")
    daemon.send_signal(signal.SIGHUP)
    stage.wait_for(lambda: "config reloaded: contents of clients_file" in log.read_text(), "the reload")
    status = stage.run_json("footing-ctl", "--connect", address, "status")
    assert status["granted_role"] == "ROLE_CONTROL", status
    clients.write_text("Ada\n")
    daemon.send_signal(signal.SIGHUP)
    stage.wait_for(lambda: "config not reloaded: the one in force stays: " in log.read_text(), "the refusal")
    assert "line 1" in log.read_text(), log.read_text()


def check_passed_socket(stage):
    """A TCP socket of the service manager speaks TLS, as systemd/README.md sets it up."""
    folder = stage.folder / "service"
    folder.mkdir()
    manager = Manager(stage.binaries, folder)
    passed = socket.create_server(("127.0.0.1", 0))
    manager.sockets["sensor-tls"] = passed
    try:
        manager.start("--listen", "fd:sensor", "--listen", "fd:sensor-tls", "--set",
                      f"token_file={stage.folder}/token", names=("sensor", "devices", "sensor-tls"))
        manager.wait_for("READY=1", 60)
        address = f"tls:127.0.0.1:{passed.getsockname()[1]}"
        os.environ["FOOTING_TOKEN_FILE"] = f"{stage.folder}/token"
        status = stage.run_json("footing-ctl", "--connect", address, "status")
        assert status["granted_role"] == "ROLE_CONTROL", status
    finally:
        manager.close()


def main():
    with Stage(sys.argv[2]) as stage:
        os.environ["XDG_STATE_HOME"] = f"{stage.folder}/state"
        os.environ["XDG_CONFIG_HOME"] = f"{stage.folder}/config"
        os.environ.pop("FOOTING_TOKEN_FILE", None)
        token = stage.folder / "token"
        token.write_text(TOKEN + "\n")
        token.chmod(0o600)

        open_to_all = stage.run("footingd", "--listen", "tls:127.0.0.1:0")
        assert open_to_all.returncode == 2 and "token_file" in open_to_all.stderr, open_to_all
        in_clear = stage.run("footingd", "--listen", "tcp:0.0.0.0:0")
        assert in_clear.returncode == 2 and "use tls:HOST:PORT" in in_clear.stderr, in_clear

        address, first = start_footingd(stage, 0, "first")
        check_server_side(stage, first)
        check_client(stage, address, first)
        stage.stop("first")
        (stage.folder / "state/footing/identity.pem").unlink()
        again, second = start_footingd(stage, address.rsplit(":", 1)[1], "second")
        assert again == address and second != first, (again, second)
        check_changed(stage, address, first, second)
        check_client_certificate(stage)
        check_passed_socket(stage)
        for log in stage.folder.glob("*.log"):
            assert TOKEN not in log.read_text() and "PRIVATE" not in log.read_text(), log


if __name__ == "__main__":
    main()
