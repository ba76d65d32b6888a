"""Ports that scenarios take beside each other are all different, and none is one that the kernel gives out.

Usage: ports_test.py
"""
import multiprocessing
import socket
import sys

import ports

PROCESSES, EACH = 2, 300


def take(results, end):
    results.put([ports.free_port() for _ in range(EACH)])
    end.wait()


def main():
    results, end = multiprocessing.Queue(), multiprocessing.Event()
    takers = [multiprocessing.Process(target=take, args=(results, end)) for _ in range(PROCESSES)]
    for taker in takers:
        taker.start()
    taken = [port for _ in takers for port in results.get()]
    end.set()
    for taker in takers:
        taker.join()
    assert len(set(taken)) == PROCESSES * EACH, "a port was taken twice"
    with open("/proc/sys/net/ipv4/ip_local_port_range", encoding="ascii") as text:
        low, high = (int(word) for word in text.read().split())
    if low > ports.LOWEST + 1000:  # As everywhere where nobody has changed it.
        assert not [port for port in taken if low <= port <= high], "the kernel may give it to a connection"
    with socket.socket() as listening:  # Somebody who did not ask here.
        listening.bind(("127.0.0.1", 0))
        listening.listen()
        port = listening.getsockname()[1]
        assert not ports.is_free(port) and ports.is_free(taken[0])
    return 0


if __name__ == "__main__":
    sys.exit(main())
