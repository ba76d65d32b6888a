"""Addresses, sockets and frames of the protocol (docs/protocol.md): four bytes of length, then one message."""
import hashlib
import os
import re
import select
import socket
import ssl
import struct
import threading
from pathlib import Path
from typing import Optional

_LONGEST = 1 << 20  # Of a message to a client, bytes.


class FootingError(Exception):
    """Footing could not do what was asked; the text says what, why and what to do next."""


class NotRunning(FootingError):
    """No server answers at the address."""


class Refused(FootingError):
    """The server refused the session, the command or the device; the text is its reason."""


class ConnectionLost(FootingError):
    """The connection ended, and no new one came about in time."""


def default_address(name: str) -> str:
    """Address of this user's server, or of the installed service: "sensor", "simulation" or "devices"."""
    if not hasattr(socket, "AF_UNIX"):
        raise NotRunning("this system has no Unix sockets: pass an address, tls:HOST:PORT of a Linux host with Footing")
    runtime = os.environ.get("XDG_RUNTIME_DIR", "")
    folder = f"{runtime}/footing" if runtime.startswith("/") else f"/tmp/footing-{os.geteuid()}"
    own, service = f"{folder}/{name}.sock", f"/run/footing/{name}.sock"
    return f"unix:{service if not os.path.exists(own) and os.path.exists(service) else own}"


def read_token(token: Optional[str] = None) -> str:
    """The token itself, or the first line of the file that FOOTING_TOKEN_FILE names; empty without either."""
    path = os.environ.get("FOOTING_TOKEN_FILE", "")
    if token is not None or not path:
        return token or ""
    try:
        return Path(path).read_text(encoding="utf-8").split("\n")[0].strip()
    except OSError as error:
        raise FootingError(f"FOOTING_TOKEN_FILE: {error}") from error


def _known_servers() -> Path:
    named = os.environ.get("FOOTING_KNOWN_SERVERS")
    config = os.environ.get("XDG_CONFIG_HOME")
    return Path(named) if named else (Path(config) if config else Path.home() / ".config") / "footing/known_servers"


def _check_certificate(server: str, certificate: bytes) -> None:
    """Compares with the certificate of the first connection, which is remembered; nothing was sent before."""
    path, fingerprint = _known_servers(), "sha256:" + hashlib.sha256(certificate).hexdigest()
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    words = [line.split() for line in text.splitlines()]
    known = [line[1].lower().replace("sha256:", "").replace(":", "") for line in words if len(line) == 2 and line[0] == server]
    if not known:
        path.parent.mkdir(parents=True, exist_ok=True)
        with open(path, "a", encoding="utf-8", opener=lambda name, flags: os.open(name, flags, 0o600)) as file:
            file.write(f"{'' if text.endswith(chr(10)) or not text else chr(10)}{server} {fingerprint}\n")
    elif "sha256:" + known[-1] != fingerprint:
        raise Refused(f"tls:{server} shows another certificate than before, {fingerprint}: compare it with the one that "
                      f"`footing-ctl trust` prints on the server; if they agree, correct the line of {path}")


def _open_tls(host: str, port: int, timeout_s: float) -> socket.socket:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.minimum_version = ssl.TLSVersion.TLSv1_3
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE  # By fingerprint, below.
    own = _known_servers().parent / "client.pem"
    if own.exists():
        context.load_cert_chain(own)
    plain = socket.create_connection((host, port), timeout_s)
    try:
        secured = context.wrap_socket(plain)
        _check_certificate(f"[{host}]:{port}" if ":" in host else f"{host}:{port}", secured.getpeercert(True) or b"")
    except BaseException:
        plain.close()
        raise
    return secured


def _open(address: str, timeout_s: float) -> socket.socket:
    kind, _, place = address.partition(":")
    network = re.fullmatch(r"\[?([^\]]+)\]?:(\d+)", place)
    if kind == "tls" and network:
        return _open_tls(network[1], int(network[2]), timeout_s)
    if kind == "tcp" and network:
        return socket.create_connection((network[1], int(network[2])), timeout_s)
    if kind != "unix" or not place.startswith("/") or not hasattr(socket, "AF_UNIX"):
        raise FootingError(f"{address!r} is not an address here: unix:/PATH, tcp:HOST:PORT or tls:HOST:PORT")
    own = socket.socket(socket.AF_UNIX)
    try:
        own.settimeout(timeout_s)
        own.connect(place)
    except OSError:
        own.close()
        raise
    return own


class Wire:
    """One connection. Any thread may send; one receives."""

    def __init__(self, address: str, program: str, timeout_s: float = 10):
        self.address = address
        try:
            self._socket = _open(address, timeout_s)
        except PermissionError as error:
            raise Refused(f"{address}: permission denied; join the group that owns the socket, footing for that of the service: "
                          "sudo usermod -aG footing $USER, then log in again") from error
        except OSError as error:
            remedy = f"start {program}" if address.startswith("unix:") else f"start {program} there with --listen {address}"
            raise NotRunning(f"no {program} at {address} ({error}): {remedy}, or pass another address") from error
        self._socket.settimeout(timeout_s)
        self._lock = threading.Lock()
        self._rest = bytearray()

    def send(self, message) -> None:
        data = message.SerializeToString()
        with self._lock:
            self._socket.sendall(struct.pack("<I", len(data)) + data)

    def receive(self) -> bytes:
        """The next message; ConnectionError at the end, TimeoutError (OSError before Python 3.10) after silence."""
        head = self._take(4)
        size = struct.unpack("<I", head)[0]
        if size > _LONGEST:
            raise ConnectionError(f"{self.address} announces a message of {size} bytes: it is not a Footing server")
        return self._take(size)

    def waits(self) -> bool:
        """Whether a message, or part of one, is there."""
        return bool(self._rest) or bool(select.select([self._socket], [], [], 0)[0])

    def _take(self, size: int) -> bytes:
        while len(self._rest) < size:
            piece = self._read()
            if not piece:
                raise ConnectionError("the server closed the connection")
            self._rest += piece
        data = bytes(self._rest[:size])
        del self._rest[:size]
        return data

    def _read(self) -> bytes:
        if not isinstance(self._socket, ssl.SSLSocket):
            return self._socket.recv(1 << 16)
        # OpenSSL's object is not for two threads at once, so this one waits without the lock.
        try:
            if not self._socket.pending() and not select.select([self._socket], [], [], self._socket.gettimeout())[0]:
                raise socket.timeout("timed out")
        except ValueError as error:  # Another thread has closed it.
            raise ConnectionError("closed") from error
        with self._lock:
            return self._socket.recv(1 << 16)

    def close(self) -> None:
        try:
            self._socket.shutdown(socket.SHUT_RDWR)  # Wakes the thread that receives.
        except OSError:
            pass
        self._socket.close()
