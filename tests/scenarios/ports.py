"""Ports that are free and stay so, for scenarios whose programs must be told a port before they run.

The kernel gives out ports of its ephemeral range (net.ipv4.ip_local_port_range) to whoever asks for any: one
that was free a moment ago may be somebody's outgoing connection by now. So a port from below that range is
taken, and reserved against other scenarios until this process ends, by an abstract Unix socket of its name.
Those belong to a network namespace, as ports do.
"""
import random
import socket

LOWEST = 10_000
TRIES = 10_000
_reservations = []


def _ephemeral_from():
    with open("/proc/sys/net/ipv4/ip_local_port_range", encoding="ascii") as text:
        return int(text.read().split()[0])


def _reserve(port):
    """The socket that holds the port's name; None: another process has it."""
    holder = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        holder.bind(f"\0footing-scenario-port-{port}")
    except OSError:
        holder.close()
        return None
    return holder


def is_free(port):
    for kind in (socket.SOCK_STREAM, socket.SOCK_DGRAM):
        with socket.socket(socket.AF_INET, kind) as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                return False
    return True


def free_port():
    """A port of loopback, for TCP or UDP, that no other call returns while this process runs."""
    above = max(LOWEST + 1000, _ephemeral_from())
    for _ in range(TRIES):
        port = random.randrange(LOWEST, above)
        holder = _reserve(port)
        if holder is None:
            continue
        if is_free(port):
            _reservations.append(holder)
            return port
        holder.close()
    raise AssertionError("no free port on this host")
