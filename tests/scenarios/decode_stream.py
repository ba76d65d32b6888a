#!/usr/bin/env python3
"""Reads a live stream with nothing but Python's own library and docs/protocol.md.

Usage: decode_stream.py ADDRESS [--ticks N] [--seconds S] [--max-hz HZ] [--channel NAME]...

ADDRESS is unix:PATH or tcp:HOST:PORT. Prints one JSON object a line: first {"welcome": ...}, then
{"gap": ...} and ticks {"sequence", "host_ns", "snapshot", "channels", and each channel's content}.
Exit codes: 0 the wanted ticks came, 1 they did not (the reason is on standard error), 2 usage.
"""
import argparse
import json
import socket
import struct
import sys
import time

MAX_MESSAGE_BYTES = 1 << 20

# The messages needed here: field number -> (name, kind). A kind is a key of SCHEMAS, or "uint",
# "int" (two's complement of 64 bits), "bool", "double", "text", "bytes"; "*" in front: repeated.
SCHEMAS = {
    "vector3": {1: ("x", "double"), 2: ("y", "double"), 3: ("z", "double")},
    "device": {
        1: ("device", "uint"), 2: ("serial", "text"), 3: ("kind", "uint"), 4: ("state", "uint"),
        5: ("rig", "text"), 6: ("role", "uint"), 7: ("simulated", "bool"),
        9: ("report_rate_hz", "double"), 11: ("reports", "uint"), 21: ("name", "text")},
    "status": {1: ("devices", "*device")},
    "motion_sample": {
        1: ("device", "uint"), 2: ("report_count", "uint"), 3: ("received_ns", "int"),
        4: ("sampled_ns", "int"), 5: ("specific_force_mps2", "vector3"),
        6: ("filtered_mps2", "vector3"), 7: ("clipped_axes", "uint"), 8: ("repeated", "bool"),
        9: ("uncalibrated", "bool"), 10: ("simulated", "bool"), 11: ("buttons", "uint")},
    "motion": {1: ("samples", "*motion_sample")},
    "device_features": {
        1: ("device", "uint"), 2: ("moving", "bool"), 3: ("frequency_valid", "bool"),
        4: ("frequency_hz", "double"), 5: ("amplitude_valid", "bool"),
        6: ("amplitude_mps2", "double"), 7: ("inclination_valid", "bool"),
        8: ("roll_rad", "double"), 9: ("pitch_rad", "double")},
    "pair": {1: ("left_device", "uint"), 2: ("right_device", "uint"), 3: ("phase_valid", "bool"),
             4: ("phase_rad", "double")},
    "rig": {1: ("rig", "text"), 2: ("devices", "*device_features"), 3: ("pairs", "*pair")},
    "features": {1: ("rigs", "*rig")},
    "board_sample": {
        1: ("device", "uint"), 2: ("report_count", "uint"), 3: ("received_ns", "int"),
        4: ("sampled_ns", "int"), 5: ("top_left_n", "double"), 6: ("top_right_n", "double"),
        7: ("bottom_left_n", "double"), 8: ("bottom_right_n", "double"), 9: ("total_n", "double"),
        10: ("cop_valid", "bool"), 11: ("cop_x_m", "double"), 12: ("cop_y_m", "double"),
        13: ("contact", "bool"), 16: ("simulated", "bool")},
    "boards": {1: ("samples", "*board_sample")},
    "raw_report": {1: ("device", "uint"), 2: ("received_ns", "int"), 3: ("report", "bytes"),
                   4: ("to_device", "bool"), 5: ("simulated", "bool")},
    "raw": {1: ("reports", "*raw_report")},
    "hand_sample": {
        1: ("rig", "text"), 2: ("role", "uint"), 3: ("received_ns", "int"),
        4: ("sampled_ns", "int"), 5: ("position_m", "vector3"), 6: ("sd_m", "vector3"),
        7: ("confidence", "double"), 8: ("simulated", "bool"), 9: ("tracker", "text"),
        10: ("covariance_m2", "vector3"), 11: ("saturated", "bool"), 12: ("occluded", "bool"), 14: ("joint", "int")},
    "hands": {1: ("samples", "*hand_sample")},
    "applied_input": {1: ("step", "uint"), 3: ("sensor_sequence", "uint"), 15: ("push_number", "uint"), 16: ("push_x_ns", "double"),
                      17: ("push_y_ns", "double")},
    "inputs": {1: ("inputs", "*applied_input")},
    "reference_pose": {1: ("rig", "text"), 2: ("sampled_ns", "int"),
                       4: ("positions_m", "*vector3"), 5: ("com_m", "vector3")},
    "reference": {1: ("poses", "*reference_pose")},
    "contact_cell": {1: ("x_m", "double"), 2: ("y_m", "double"), 3: ("z_m", "double"),
                     4: ("load_n", "double")},
    "contact_sample": {
        1: ("rig", "text"), 2: ("source", "text"), 3: ("body", "uint"), 4: ("received_ns", "int"),
        5: ("sampled_ns", "int"), 6: ("cells", "*contact_cell"), 7: ("simulated", "bool")},
    "contacts": {1: ("samples", "*contact_sample")},
    "geometry": {1: ("plate_x_m", "double"), 2: ("plate_y_m", "double"),
                 3: ("sensor_distance_x_m", "double"), 4: ("sensor_distance_y_m", "double")},
    "layout": {5: ("preset", "text"), 6: ("left_geometry", "geometry"),
               7: ("right_geometry", "geometry")},
    "rig_setup": {1: ("rig", "text"), 2: ("layout", "layout")},
    "setup": {1: ("rigs", "*rig_setup")},
    "gait": {
        1: ("gait", "uint"), 2: ("commanded_gait", "uint"), 3: ("pending", "bool"),
        4: ("phase", "text"), 5: ("commanded_speed_mps", "double"), 8: ("speed_mps", "double"),
        10: ("steps", "uint"), 11: ("falls", "uint"), 12: ("distance_m", "double"),
        13: ("commanded_by_stream", "bool"), 16: ("failures", "failure_counts"),
        17: ("operator_put_backs", "uint")},
    "failure_counts": {1: ("simulation", "uint"), 2: ("curve", "uint"), 3: ("jump", "uint"),
                       4: ("straightness", "uint"), 5: ("transition", "uint")},
    "failure": {1: ("number", "uint"), 2: ("cause", "uint"), 3: ("trial", "text"),
                4: ("trial_time_s", "double"), 5: ("distance_m", "double"),
                6: ("lateral_offset_m", "double"), 7: ("heading_error_rad", "double"),
                8: ("position_m", "vector3"), 9: ("withdrawn", "bool")},
    "trial": {1: ("trial", "text"), 2: ("number", "uint"), 3: ("phase", "uint"),
              4: ("track", "text"), 5: ("seed", "uint"), 6: ("time_s", "double"),
              7: ("distance_m", "double"), 8: ("finish_m", "double"),
              9: ("lateral_offset_m", "double"), 10: ("heading_error_rad", "double"),
              11: ("on_track", "bool"), 12: ("failures", "failure_counts"),
              13: ("failed_attempts", "uint"), 14: ("withdrawn_failures", "uint"),
              15: ("operator_put_backs", "uint"), 16: ("task", "text"),
              17: ("task_phase", "uint"), 18: ("to_mark_m", "double"),
              19: ("instruction", "text")},
    "character": {1: ("character", "uint"), 2: ("rig", "text"), 3: ("valid", "bool"),
                  6: ("com_m", "vector3"), 7: ("com_velocity_mps", "vector3"), 8: ("gait", "gait"),
                  4: ("links", "*link_pose"), 9: ("simulated_input", "bool"), 10: ("body", "body"),
                  16: ("trial", "trial")},
    "quaternion": {1: ("w", "double"), 2: ("x", "double"), 3: ("y", "double"), 4: ("z", "double")},
    "link_pose": {1: ("position_m", "vector3"), 2: ("orientation", "quaternion")},
    "body_foot": {1: ("contact", "bool"), 2: ("valid", "bool"), 3: ("position_m", "vector3"),
                  4: ("variance_m2", "vector3"), 5: ("load_n", "double"),
                  6: ("cop_valid", "bool"), 7: ("cop_m", "vector3"), 8: ("airborne_s", "double")},
    "body": {1: ("subject", "text"), 2: ("mode", "text"), 3: ("calibrated", "bool"),
             4: ("calibration_progress", "double"), 6: ("mass_kg", "double"),
             7: ("height_m", "double"), 8: ("lag_s", "double"), 9: ("momentum_valid", "bool"),
             14: ("feet", "*body_foot"), 15: ("resets", "uint"), 17: ("note", "text"),
             20: ("contact_source", "text"), 22: ("hands_source", "text"),
             23: ("left_out", "*text")},
    "character_frame": {1: ("world", "text"), 2: ("step", "uint"), 3: ("time_s", "double"),
                        4: ("characters", "*character"), 5: ("overruns", "uint")},
    "response": {
        1: ("from", "uint"), 2: ("to", "uint"), 3: ("report_received_ns", "int"),
        4: ("decoded_ns", "int"), 5: ("features_computed_ns", "int"),
        6: ("features_received_ns", "int"), 7: ("command_ns", "int"), 8: ("contact_ns", "int"),
        9: ("first_frame_ns", "int")},
    "event": {1: ("kind", "uint"), 2: ("host_ns", "int"), 4: ("text", "text"),
              6: ("response", "response"), 8: ("failure_cause", "uint"), 9: ("by_operator", "bool"),
              16: ("failure", "failure"), 17: ("trial", "trial")},
    "events": {1: ("events", "*event")},
    "command_result": {1: ("id", "uint"), 2: ("ok", "bool"), 3: ("message", "text")},
    "tick": {
        1: ("epoch", "uint"), 2: ("sequence", "uint"), 3: ("host_ns", "int"),
        4: ("snapshot", "bool"), 5: ("refilled", "bool"), 16: ("status", "status"),
        17: ("motion", "motion"), 18: ("features", "features"), 19: ("boards", "boards"),
        20: ("raw", "raw"), 24: ("skeletons", "bytes"), 25: ("track", "bytes"),
        26: ("characters", "character_frame"), 27: ("events", "events"), 28: ("inputs", "inputs"),
        29: ("setup", "setup"), 30: ("hands", "hands"), 31: ("reference", "reference"), 32: ("contacts", "contacts"),
        34: ("config", "config"), 35: ("study", "study")},
    "config": {1: ("json", "text")},
    "study": {1: ("study", "text"), 2: ("participant", "text"), 3: ("interface", "text"), 4: ("phase", "text"),
              5: ("number", "uint"), 6: ("phases", "uint"), 7: ("doing", "text"), 8: ("next", "text"),
              9: ("keys", "text"), 10: ("left_s", "double"), 11: ("active_s", "double"), 12: ("attempt", "uint"),
              13: ("activity", "uint")},
    "welcome": {1: ("server_id", "text"), 2: ("epoch", "uint"), 3: ("protocol_major", "uint"),
                4: ("protocol_minor", "uint"), 5: ("granted_role", "uint"),
                7: ("channels", "*text"), 11: ("version", "text")},
    "refused": {1: ("reason", "uint"), 2: ("message", "text")},
    "subscribed": {1: ("channels", "*text"), 2: ("max_hz", "double"), 3: ("policy", "uint"),
                   4: ("queue_ticks", "uint"), 5: ("first_sequence", "uint"),
                   6: ("unknown_channels", "*text")},
    "ping": {1: ("id", "uint"), 2: ("t0_ns", "int")},
    "goodbye": {1: ("reason", "text")},
    "gap": {1: ("from_sequence", "uint"), 2: ("to_sequence", "uint"), 3: ("reason", "uint")},
    "envelope": {9: ("command_result", "command_result"), 2: ("welcome", "welcome"), 3: ("refused", "refused"),
                 5: ("subscribed", "subscribed"), 6: ("ping", "ping"), 10: ("goodbye", "goodbye"),
                 16: ("tick", "tick"), 17: ("gap", "gap")},
}
ZEROS = {"uint": 0, "int": 0, "bool": False, "double": 0.0, "text": "", "bytes": ""}


def read_varint(data, at):
    value = shift = 0
    while True:
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value & (1 << 64) - 1, at
        shift += 7
        if shift > 63:
            raise ValueError("a varint of more than ten bytes")


def read_field(data, at):
    """(number, wire type, value, where the next one begins)"""
    tag, at = read_varint(data, at)
    wire_type = tag & 7
    if wire_type == 0:
        value, at = read_varint(data, at)
    elif wire_type == 1:
        value, at = data[at:at + 8], at + 8
    elif wire_type == 2:
        size, at = read_varint(data, at)
        value, at = data[at:at + size], at + size
    elif wire_type == 5:
        value, at = data[at:at + 4], at + 4
    else:
        raise ValueError(f"wire type {wire_type} is not in use")
    if at > len(data):
        raise ValueError("a field ends beyond its message")
    return tag >> 3, wire_type, value, at


def convert(kind, value):
    if kind == "int":
        return value - (1 << 64) if value >> 63 else value
    if kind == "bool":
        return value != 0
    if kind == "double":
        return struct.unpack("<d", value)[0]
    if kind == "text":
        return value.decode("utf-8")
    if kind == "bytes":
        return value.hex()
    return decode(kind, value) if kind in SCHEMAS else value


def decode(kind, data):
    """A message as a dict. Missing scalars are zero, missing messages are left out."""
    fields = SCHEMAS[kind]
    message = {}
    for name, field_kind in fields.values():
        if field_kind.startswith("*"):
            message[name] = []
        elif field_kind in ZEROS and kind != "tick":
            message[name] = ZEROS[field_kind]
    at = 0
    while at < len(data):
        number, _, value, at = read_field(data, at)
        if number not in fields:
            continue  # Of a later minor version, or of no interest here.
        name, field_kind = fields[number]
        if field_kind.startswith("*"):
            message[name].append(convert(field_kind[1:], value))
        else:
            message[name] = convert(field_kind, value)
    return message


def varint(value):
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes(out + bytes([value]))


def number_field(number, value):
    return varint(number << 3) + varint(value) if value else b""


def bytes_field(number, value):
    return varint(number << 3 | 2) + varint(len(value)) + value


class Stream:
    def __init__(self, address, timeout_s):
        if address.startswith("unix:"):
            self.socket = socket.socket(socket.AF_UNIX)
            target = address[5:]
        else:
            host, _, port = address[4:].rpartition(":")
            self.socket = socket.socket(socket.AF_INET)
            target = (host, int(port))
        self.socket.settimeout(timeout_s)
        self.socket.connect(target)

    def send(self, number, message):
        envelope = bytes_field(number, message)
        self.socket.sendall(struct.pack("<I", len(envelope)) + envelope)

    def read_exactly(self, size):
        data = bytearray()
        while len(data) < size:
            piece = self.socket.recv(size - len(data))
            if not piece:
                raise EOFError("the server closed the connection")
            data += piece
        return bytes(data)

    def receive(self):
        size = struct.unpack("<I", self.read_exactly(4))[0]
        if size > MAX_MESSAGE_BYTES:
            raise ValueError(f"a message of {size} bytes was announced")
        return decode("envelope", self.read_exactly(size))


def subscribe(arguments):
    message = b"".join(bytes_field(1, name.encode()) for name in arguments.channel)
    if arguments.max_hz:
        message += varint(2 << 3 | 1) + struct.pack("<d", arguments.max_hz)
    return message + number_field(3, 2) + number_field(4, 1024)  # Drop the oldest beyond 1024.


def tick_line(tick):
    channels = [name for number, (name, _) in SCHEMAS["tick"].items()
                if number >= 16 and name in tick]
    head = {"sequence": tick.get("sequence", 0), "host_ns": tick.get("host_ns", 0),
            "epoch": tick.get("epoch", 0), "snapshot": tick.get("snapshot", False),
            "channels": channels}
    return {**head, **{name: tick[name] for name in channels}}


def run(arguments):
    stream = Stream(arguments.address, arguments.seconds)
    # Hello: protocol 1.0, role view.
    stream.send(1, number_field(1, 1) + number_field(3, 1) + bytes_field(5, b"decode_stream"))
    deadline = time.monotonic() + arguments.seconds
    ticks = 0
    while ticks < arguments.ticks and time.monotonic() < deadline:
        message = stream.receive()
        if "refused" in message:
            raise ConnectionError("refused: " + message["refused"]["message"])
        if "goodbye" in message:
            raise ConnectionError("goodbye: " + message["goodbye"]["reason"])
        if "welcome" in message:
            print(json.dumps({"welcome": message["welcome"]}), flush=True)
            stream.send(4, subscribe(arguments))
        elif "ping" in message:
            now_ns = time.monotonic_ns()
            ping = message["ping"]
            stream.send(7, number_field(1, ping["id"]) + number_field(2, ping["t0_ns"]) +
                        number_field(3, now_ns) + number_field(4, now_ns))
        elif "gap" in message:
            print(json.dumps({"gap": message["gap"]}), flush=True)
        elif "tick" in message:
            print(json.dumps(tick_line(message["tick"])), flush=True)
            ticks += 0 if message["tick"].get("snapshot") else 1
    return ticks


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("address", help="unix:PATH or tcp:HOST:PORT")
    parser.add_argument("--ticks", type=int, default=10, help="end after so many")
    parser.add_argument("--seconds", type=float, default=10, help="give up after so long")
    parser.add_argument("--max-hz", type=float, default=0)
    parser.add_argument("--channel", action="append", default=[])
    arguments = parser.parse_args()
    if not arguments.address.startswith(("unix:", "tcp:")):
        parser.error("ADDRESS is unix:PATH or tcp:HOST:PORT")
    try:
        ticks = run(arguments)
    except (OSError, EOFError, ValueError) as error:
        print(f"error: {arguments.address}: {error}", file=sys.stderr)
        return 1
    if ticks < arguments.ticks:
        print(f"error: {ticks} ticks in {arguments.seconds} s", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
