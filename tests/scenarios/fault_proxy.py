#!/usr/bin/env python3
"""A link that misbehaves on demand: stands between clients and a server on stream sockets, and passes their bytes on with the
fault that is set. The same seed gives the same jitter and the same pieces. UdpFaultProxy does it to datagrams, one way.

Usage: fault_proxy.py LISTEN TARGET [--seed N] [--fault NAME] [--seconds S]

LISTEN and TARGET are unix:PATH or tcp:HOST:PORT. Faults, of both directions: none; delay (0.2 s and up to 0.1 s of jitter,
in order); stall (nothing passes); split (each byte is written by itself); dribble (1 to 64 bytes every 10 ms); reset (every
connection, and every new one, is reset); half_close (the server's side is closed for the client once, the other way stays
open). Without --seconds the fault stays until the program is ended.
"""
import argparse
import asyncio
import random
import socket
import struct
import sys
import threading
import time

FAULTS = ("none", "delay", "stall", "split", "dribble", "reset", "half_close")
CHUNK_BYTES = 16 << 10
DELAY_S = 0.2
JITTER_S = 0.1
DRIBBLE_BYTES = 64
DRIBBLE_EVERY_S = 0.01
LOOK_EVERY_S = 0.005  # A stalled direction looks this often whether it may go on.


def parse_address(text):
    kind, _, rest = text.partition(":")
    if kind == "unix":
        return socket.AF_UNIX, rest
    host, _, port = rest.rpartition(":")
    return socket.AF_INET, (host, int(port))


class FaultProxy:
    """Runs on a thread of its own, from start() to stop()."""

    def __init__(self, listen, target, seed=1):
        self.listen, self.target = parse_address(listen), parse_address(target)
        self.fault = "none"
        self.cleared_ns = 0  # When the last fault ended, CLOCK_MONOTONIC.
        self.passed = {"up": 0, "down": 0}  # Bytes that were sent and have passed since the last fault ended.
        self.fresh_ns = None  # When the first tick had passed that was made after that.
        self.accepted = 0
        self._random = random.Random(seed)
        self._loop = asyncio.new_event_loop()
        self._links = set()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)

    def start(self):
        family, where = self.listen
        listening = socket.socket(family)
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(where)
        listening.listen(64)
        listening.setblocking(False)
        self._thread.start()
        self._listening = listening
        self._serving = asyncio.run_coroutine_threadsafe(self._serve(), self._loop)
        return self

    def stop(self):
        self._call(self._close_all)
        self._thread.join(5)
        self._loop.close()

    def set(self, fault):
        assert fault in FAULTS, fault
        self._call(self._set, fault)

    def clear(self):
        self.set("none")

    def seconds_until(self, condition, within_s):
        """How long after the end of the fault the condition held; None: not within the time."""
        while (passed_s := (time.monotonic_ns() - self.cleared_ns) * 1e-9) < within_s:
            if condition():
                return passed_s
            time.sleep(LOOK_EVERY_S)
        return None

    def seconds_to_fresh_tick(self, within_s):
        """How long after the end of the fault a tick had come that was made after it, on a clock of this host."""
        if self.seconds_until(lambda: self.fresh_ns is not None, within_s) is None:
            return None
        return (self.fresh_ns - self.cleared_ns) * 1e-9

    def _call(self, function, *words):
        done = threading.Event()
        self._loop.call_soon_threadsafe(lambda: (function(*words), done.set()))
        assert done.wait(5), "the proxy does not answer"

    def _set(self, fault):
        self.fault = fault
        if fault == "none":
            self.cleared_ns = time.monotonic_ns()
            self.passed = {"up": 0, "down": 0}
            self.fresh_ns = None
        for link in list(self._links):
            if fault == "reset":
                link.reset()
            elif fault == "half_close":
                link.half_close()

    def _close_all(self):
        self._serving.cancel()
        for link in list(self._links):
            link.reset()
        self._loop.call_later(0.05, self._end)

    def _end(self):
        self._listening.close()
        self._loop.stop()

    async def _serve(self):
        while True:
            client, _ = await self._loop.sock_accept(self._listening)
            self.accepted += 1
            if self.fault == "reset":
                abort(client)
                continue
            self._loop.create_task(self._connect(client))

    async def _connect(self, client):
        family, where = self.target
        server = socket.socket(family)
        server.setblocking(False)
        client.setblocking(False)
        try:
            await self._loop.sock_connect(server, where)
        except OSError:
            abort(client)
            server.close()
            return
        link = Link(self, client, server, self._loop)
        self._links.add(link)
        await link.run()
        self._links.discard(link)


def abort(connection):
    """RST in place of FIN where there is such a thing."""
    if connection.family == socket.AF_INET:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    connection.close()


def varint(data, at):
    value = shift = 0
    while True:
        value |= (data[at] & 0x7f) << shift
        shift += 7
        at += 1
        if data[at - 1] < 0x80:
            return value, at


class TickWatch:
    """Finds the ticks in a server's stream of frames, and when each was made; see docs/protocol.md."""

    def __init__(self):
        self.bytes = b""

    def feed(self, piece):
        """The newest host_ns among the ticks that are whole now; 0: none."""
        self.bytes += piece
        newest_ns = 0
        while len(self.bytes) >= 4:
            size = struct.unpack_from("<I", self.bytes)[0]
            if len(self.bytes) < 4 + size:
                break
            newest_ns = max(newest_ns, self.made_ns(self.bytes[4:4 + size]))
            self.bytes = self.bytes[4 + size:]
        return newest_ns

    @staticmethod
    def made_ns(envelope):
        if envelope[:2] != b"\x82\x01":  # Field 16, a message: the tick.
            return 0
        _, at = varint(envelope, 2)
        while at < len(envelope):
            key, at = varint(envelope, at)
            if key & 7 != 0:
                return 0  # The head's fields are varints and come first.
            value, at = varint(envelope, at)
            if key == 3 << 3:
                return value
        return 0


class Link:
    """One client's connection, and the one to the server."""

    def __init__(self, proxy, client, server, loop):
        self.proxy, self.client, self.server, self.loop = proxy, client, server, loop
        self.down_closed = False
        self.watch = TickWatch()
        self.tasks = []
        for connection in (client, server):
            if connection.family == socket.AF_INET:
                connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    async def run(self):
        self.tasks = [self.loop.create_task(self.carry(self.client, self.server, "up")),
                      self.loop.create_task(self.carry(self.server, self.client, "down"))]
        # The client ends a connection; the server's end is passed on to it, and it answers by its own.
        await asyncio.wait(self.tasks[:1])
        for task in self.tasks:
            task.cancel()
        await asyncio.gather(*self.tasks, return_exceptions=True)
        self.client.close()
        self.server.close()

    def reset(self):
        for task in self.tasks:
            task.cancel()
        abort(self.client)
        abort(self.server)

    def half_close(self):
        self.down_closed = True
        try:
            self.client.shutdown(socket.SHUT_WR)
        except OSError:
            pass  # It is closed already.

    async def carry(self, source, sink, direction):
        try:
            while data := await self.loop.sock_recv(source, CHUNK_BYTES):
                await self.pass_on(data, sink, direction, time.monotonic_ns())
            sink.shutdown(socket.SHUT_WR)
        except OSError:
            pass  # One of them is gone; the link ends.

    async def pass_on(self, data, sink, direction, read_ns):
        chance = self.proxy._random
        if self.proxy.fault == "delay":  # What comes meanwhile waits behind it: order is kept.
            await asyncio.sleep(DELAY_S + chance.uniform(0, JITTER_S))
        while data:
            while self.proxy.fault == "stall":
                await asyncio.sleep(LOOK_EVERY_S)
            size = len(data)
            if self.proxy.fault == "split":
                size = 1
            elif self.proxy.fault == "dribble":
                size = chance.randint(1, DRIBBLE_BYTES)
                await asyncio.sleep(DRIBBLE_EVERY_S)
            piece, data = data[:size], data[size:]
            if direction == "down" and self.down_closed:
                continue
            await self.loop.sock_sendall(sink, piece)
            self.note(piece, direction, read_ns)

    def note(self, piece, direction, read_ns):
        proxy = self.proxy
        made_ns = self.watch.feed(piece) if direction == "down" else 0
        if proxy.fault != "none":
            return
        if read_ns > proxy.cleared_ns:
            proxy.passed[direction] += len(piece)
        if made_ns > proxy.cleared_ns and proxy.fresh_ns is None:
            proxy.fresh_ns = time.monotonic_ns()


class UdpFaultProxy:
    """Passes datagrams on to a port of this host, on a thread of its own: a share is lost, a share comes twice, and a share
    comes late, so that others overtake it."""

    LATE_S = (0.02, 0.12)

    def __init__(self, port, target_port, seed=1, loss=0.0, duplicate=0.0, reorder=0.0):
        self.lost = self.doubled = self.late = self.passed = 0
        self._shares = (loss, duplicate, reorder)
        self._random = random.Random(seed)
        self._target = ("127.0.0.1", target_port)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", port))
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)

    def start(self):
        self._socket.setblocking(False)
        self._loop.add_reader(self._socket, self._read)
        self._thread.start()
        return self

    def stop(self):
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(5)
        self._loop.close()
        self._socket.close()

    def _read(self):
        data = self._socket.recv(1 << 16)
        loss, duplicate, reorder = self._shares
        if self._random.random() < loss:
            self.lost += 1
            return
        if self._random.random() < duplicate:
            self.doubled += 1
            self._send(data)
        if self._random.random() < reorder:
            self.late += 1
            self._loop.call_later(self._random.uniform(*self.LATE_S), self._send, data)
        else:
            self._send(data)

    def _send(self, data):
        self.passed += 1
        try:
            self._socket.sendto(data, self._target)
        except OSError:
            pass  # Nobody listens yet, or any more.


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("listen")
    parser.add_argument("target")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--fault", choices=FAULTS, default="none")
    parser.add_argument("--seconds", type=float, default=0)
    arguments = parser.parse_args()
    proxy = FaultProxy(arguments.listen, arguments.target, arguments.seed).start()
    proxy.set(arguments.fault)
    try:
        if arguments.seconds:
            time.sleep(arguments.seconds)
            proxy.clear()
        threading.Event().wait()
    except KeyboardInterrupt:
        proxy.stop()


if __name__ == "__main__":
    sys.exit(main())
