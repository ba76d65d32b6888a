#!/usr/bin/env python3
"""Prints the samples of every controller and board that footingd reads, one CSV row per sample.

Usage: client.py [ADDRESS] [--samples N]

ADDRESS is unix:PATH or tcp:HOST:PORT; by default footingd of this user. Needs Python 3 and nothing
else; docs/writing-a-client.md explains each step.
"""
import argparse
import os
import socket
import struct
import sys
import time

# Field numbers of proto/footing/v1/*.proto, as far as this client uses them.
HELLO, WELCOME, REFUSED, SUBSCRIBE, SUBSCRIBED, PING, PONG, GOODBYE, TICK, GAP = 1, 2, 3, 4, 5, 6, 7, 10, 16, 17
STATUS, MOTION, BOARDS = 16, 17, 19  # Channels: fields of Tick.
ROLE_VIEW = 1


# --- Protocol Buffers: a message is a list of fields (tag, value) ---------------------------------
def varint(number):
    out = bytearray()
    while number > 0x7F:
        out.append(number & 0x7F | 0x80)
        number >>= 7
    return bytes(out + bytes([number]))


def number_field(number, value):
    return varint(number << 3) + varint(value)


def bytes_field(number, value):
    return varint(number << 3 | 2) + varint(len(value)) + value


def read_varint(data, at):
    value = shift = 0
    while data[at] & 0x80:
        value |= (data[at] & 0x7F) << shift
        at, shift = at + 1, shift + 7
    return value | data[at] << shift, at + 1


def fields(data):
    """Yields (field number, value): an int, a float, or bytes (a text or a message)."""
    at = 0
    while at < len(data):
        tag, at = read_varint(data, at)
        kind = tag & 7
        if kind == 0:
            value, at = read_varint(data, at)
        elif kind == 1:
            value, at = struct.unpack_from("<d", data, at)[0], at + 8
        elif kind == 2:
            size, at = read_varint(data, at)
            value, at = data[at:at + size], at + size
        else:
            raise ValueError(f"wire type {kind} is not used by this protocol")
        yield tag >> 3, value


def message(data):
    """A message whose fields occur once, as a dict. A field that is missing is zero."""
    return dict(fields(data))


# --- The connection: four bytes of length, then one Envelope ---------------------------------------
class Connection:
    def __init__(self, address):
        kind, _, place = address.partition(":")
        if kind == "unix":
            self.socket = socket.socket(socket.AF_UNIX)
            self.socket.connect(place)
        elif kind != "tcp":
            raise ValueError("not unix:PATH or tcp:HOST:PORT, which is all that this example speaks")
        else:
            host, _, port = place.rpartition(":")
            self.socket = socket.create_connection((host, int(port)))
        self.socket.settimeout(10)  # The server sends a ping every second.

    def send(self, number, body):
        envelope = bytes_field(number, body)
        self.socket.sendall(struct.pack("<I", len(envelope)) + envelope)

    def answer(self, ping):
        """Answers the body of a ping: a client that is silent for 10 s is dropped."""
        asked, now_ns = message(ping), time.monotonic_ns()
        self.send(PONG, number_field(1, asked.get(1, 0)) + number_field(2, asked.get(2, 0)) +
                  number_field(3, now_ns) + number_field(4, now_ns))

    def receive(self):
        """(field number, body) of the next envelope."""
        size = struct.unpack("<I", self.read(4))[0]
        return next(fields(self.read(size)))

    def read(self, size):
        data = b""
        while len(data) < size:
            piece = self.socket.recv(size - len(data))
            if not piece:
                raise ConnectionError("the server closed the connection")
            data += piece
        return data


# --- The client ------------------------------------------------------------------------------------
def vector(data):
    parts = message(data)
    return [parts.get(axis, 0.0) for axis in (1, 2, 3)]


def rows(tick, serials):
    """Rows (time_s, serial, kind, three numbers) of one tick."""
    for channel, body in fields(tick):
        samples = [message(value) for number, value in fields(body) if number == 1] \
            if channel in (STATUS, MOTION, BOARDS) else []
        for sample in samples:
            device = sample.get(1, 0)
            if channel == STATUS:
                serials[device] = sample.get(2, b"").decode()
                continue
            time_s = sample.get(4, 0) * 1e-9  # sampled_ns: the host's monotonic clock.
            serial = serials.get(device, str(device))
            if channel == MOTION:
                yield time_s, serial, "force_mps2", vector(sample.get(5, b""))
            elif sample.get(10, 0):  # cop_valid
                yield time_s, serial, "cop_n_m_m", [sample.get(i, 0.0) for i in (9, 11, 12)]


def run(address, wanted):
    connection = Connection(address)
    connection.send(HELLO, number_field(1, 1) + number_field(3, ROLE_VIEW) +
                    bytes_field(5, b"example client"))
    serials, printed = {}, 0
    while printed < wanted:
        number, body = connection.receive()
        if number == WELCOME:
            channels = [bytes_field(1, name) for name in (b"status", b"motion", b"boards")]
            connection.send(SUBSCRIBE, b"".join(channels))
        elif number == SUBSCRIBED:
            unknown = [value.decode() for field, value in fields(body) if field == 6]
            if "motion" in unknown:
                raise ConnectionError(f"this server has no channels {', '.join(unknown)}; is it footingd?")
        elif number == PING:
            connection.answer(body)
        elif number == REFUSED:
            raise ConnectionError(message(body)[2].decode())
        elif number == GOODBYE:
            raise ConnectionError(message(body).get(1, b"").decode())
        elif number == GAP:
            print("some ticks are missing: this client reads too slowly", file=sys.stderr)
        elif number == TICK:
            for time_s, serial, kind, values in rows(body, serials):
                print(f"{time_s:.6f},{serial},{kind}," + ",".join(f"{v:.4f}" for v in values), flush=True)
                printed += 1
                if printed == wanted:
                    break


def default_address(server):
    """Of this user's footingd ("sensor") or footing-sim ("simulation")."""
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    folder = f"{runtime}/footing" if runtime else f"/tmp/footing-{os.getuid()}"
    return f"unix:{folder}/{server}.sock"


def exit_code_of(address, program, work):
    """Does the work until its end or Ctrl-C; an error is printed."""
    try:
        work()
    except (FileNotFoundError, ConnectionRefusedError):
        print(f"error: {address}: no server listens there; start {program}, or name its address", file=sys.stderr)
        return 1
    except (OSError, ValueError) as error:
        print(f"error: {address}: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        pass
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("address", nargs="?", default=default_address("sensor"),
                        help="address of footingd (default %(default)s)")
    parser.add_argument("--samples", type=int, default=1 << 62,
                        help="number of rows to print (default: until Ctrl-C)")
    arguments = parser.parse_args()
    return exit_code_of(arguments.address, "footingd", lambda: run(arguments.address, arguments.samples))


if __name__ == "__main__":
    sys.exit(main())
