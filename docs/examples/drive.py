#!/usr/bin/env python3
"""Drives the character of footing-sim: commands on standard input, its motion on standard output.

Usage: drive.py [ADDRESS] < COMMANDS

A command is a line GAIT SPEED [TURN [HEIGHT]]: step, walk, run or jump, m/s, degrees a step (left is
positive), and of a jump m. It holds until the next one. At the end of the input the devices drive
again. Rows are time_s,gait,speed_mps,distance_m, twice a second. Needs Python 3 and client.py
beside it; docs/writing-a-client.md explains it.
"""
import argparse
import math
import select
import struct
import sys

from client import (GOODBYE, HELLO, PING, REFUSED, SUBSCRIBE, TICK, WELCOME, Connection, bytes_field,
                    default_address, exit_code_of, fields, message, number_field)

COMMAND, RESULT, ROLE_CONTROL = 8, 9, 3  # Of Envelope, and the role that may send commands.
DIRECT_GAIT, CHARACTERS = 13, 26         # Fields of Command and of Tick.
GAITS = {"step": 1, "walk": 2, "run": 3, "jump": 4}


def double_field(number, value):
    return bytes([number << 3 | 1]) + struct.pack("<d", value)


def direct_gait(line):
    """The body of a DirectGait."""
    words = line.split()
    if not words or words[0] not in GAITS or len(words) > 4:
        raise ValueError(f"{line!r} is not a command: GAIT SPEED [TURN [HEIGHT]] with GAIT {', '.join(GAITS)}")
    speed, turn_deg, height = ([float(word) for word in words[1:]] + [0.0] * 3)[:3]
    return (number_field(3, GAITS[words[0]]) + double_field(4, speed) + double_field(5, height) +
            double_field(6, math.radians(turn_deg)))


class Driver:
    def __init__(self, address):
        self.connection = Connection(address)
        self.commands = 0
        # Over TCP or TLS the role needs the server's token in field 4.
        self.connection.send(HELLO, number_field(1, 1) + number_field(3, ROLE_CONTROL) +
                             bytes_field(5, b"example driver"))

    def command(self, body):
        self.commands += 1
        self.connection.send(COMMAND, number_field(1, self.commands) + bytes_field(DIRECT_GAIT, body))

    def handle(self):
        """Takes one message; an answer that is an error is raised."""
        number, body = self.connection.receive()
        if number == WELCOME:
            self.connection.send(SUBSCRIBE, bytes_field(1, b"characters") + double_field(2, 2.0))
        elif number == PING:
            self.connection.answer(body)
        elif number == RESULT:
            result = message(body)
            if not result.get(2, 0):
                raise ValueError(result[3].decode())
        elif number == REFUSED:
            raise ConnectionError(message(body)[2].decode())
        elif number == GOODBYE:
            raise ConnectionError(message(body).get(1, b"").decode())
        elif number == TICK:
            for channel, frame in fields(body):
                if channel == CHARACTERS:
                    self.print_row(message(frame))
        return number

    @staticmethod
    def print_row(frame):
        gait = message(message(frame[4])[8])  # Of the only character.
        name = next(name for name, value in GAITS.items() if value == gait[1])
        print(f"{frame.get(3, 0.0):.2f},{name},{gait.get(8, 0.0):.2f},{gait.get(12, 0.0):.2f}", flush=True)


def run(address):
    driver = Driver(address)
    while driver.handle() != WELCOME:
        pass
    while True:
        for ready in select.select([driver.connection.socket, sys.stdin.buffer], [], [])[0]:
            if ready is not sys.stdin.buffer:
                driver.handle()
                continue
            line = sys.stdin.buffer.raw.readline().decode()
            if not line:
                return  # The server releases the character when this session ends.
            if line.strip():
                driver.command(direct_gait(line))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("address", nargs="?", default=default_address("simulation"),
                        help="address of footing-sim (default %(default)s)")
    arguments = parser.parse_args()
    return exit_code_of(arguments.address, "footing-sim", lambda: run(arguments.address))


if __name__ == "__main__":
    sys.exit(main())
