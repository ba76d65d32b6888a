"""What the Python package costs: eight devices at 100 Hz into NumPy, live; and an hour's recording into arrays.

Usage: measure.py BINARY_FOLDER live [SECONDS]       footingd runs; eight simulated remotes send from another process
       measure.py BINARY_FOLDER recording FILE.mcap
       measure.py BINARY_FOLDER repeat FILE.mcap OUT.mcap HOURS     the chunks of a recording again and again, later each time
"""
import multiprocessing
import pathlib
import struct
import sys
import time
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "clients/python"), str(ROOT / "tests/scenarios")]
import footing  # noqa: E402
from footing import recording  # noqa: E402
from harness import Stage  # noqa: E402

DEVICES, RATE_HZ = 8, 100


def send(address, seconds, sent):
    own = [footing.device("wiimote", serial=f"02:00:00:00:00:{i:02x}", address=address) for i in range(DEVICES)]
    begin = time.monotonic()
    for number in range(round(seconds * RATE_HZ)):
        time.sleep(max(0, begin + number / RATE_HZ - time.monotonic()))
        for device in own:
            device.send_force((0.001 * number % 9, 1, -9.81))
        sent.value += DEVICES
    time.sleep(1)


def live(stage, seconds):
    stage.start("footingd", "--listen", stage.sensor, "--source", f"stream:{stage.devices}")
    stage.wait_for_socket(stage.devices)
    sent = multiprocessing.Value("q", 0)
    sender = multiprocessing.Process(target=send, args=(stage.devices, seconds, sent))
    sender.start()
    stage.wait_for_devices(DEVICES)
    with footing.connect(stage.sensor) as f:
        counts, first, last = 0, {}, {}
        cpu_s, begin_s = time.process_time(), time.monotonic()
        for block in f.blocks("motion", every_s=0.1, seconds=seconds - 4):
            counts += len(block)
            for device, count in zip(block["device"].tolist(), block["report_count"].tolist()):
                last[device] = count
                first.setdefault(device, count)
        cpu_s, took_s = time.process_time() - cpu_s, time.monotonic() - begin_s
        due = sum(last[device] - first[device] + 1 for device in last)
        print(f"live: {len(last)} devices, {counts} samples in {took_s:.1f} s, {due - counts} missing, {f.lost} ticks lost, "
              f"{100 * cpu_s / took_s:.1f} % of a core")
    sender.join()


def repeat(path, out, hours):
    """Chunks with later times; a chunk's own times and those of its messages move by whole recordings."""
    with recording.Recording(path) as source, open(out, "wb") as file:
        data, span_ns = source._data, int(source.duration_s * 1e9) + 10**7
        records = [(opcode, begin, end) for opcode, begin, end in recording._records(data, 8, len(data))]
        file.write(data[:8])
        for number in range(round(hours * 3600e9 / span_ns)):
            for opcode, begin, end in records:
                body = bytearray(data[begin:end])
                if opcode == recording._CHUNK:
                    head = 40  # Chunks without compression: times, sizes, CRC, an empty name.
                    struct.pack_into("<QQ", body, 0, *(t + number * span_ns for t in struct.unpack_from("<QQ", body)))
                    for inner, at, _ in recording._records(body, head, len(body)):
                        if inner == recording._MESSAGE:
                            log_ns = struct.unpack_from("<Q", body, at + 6)[0]
                            struct.pack_into("<Q", body, at + 6, log_ns + number * span_ns)
                    struct.pack_into("<I", body, 24, zlib.crc32(body[head:]))
                elif opcode != recording._INDEX and number > 0:
                    continue
                elif opcode in (recording._DATA_END, recording._FOOTER):
                    continue
                file.write(struct.pack("<BQ", opcode, len(body)) + body)


def read(path):
    for channel, fields in (("motion", None), ("motion", ["specific_force_mps2"]), ("characters", ["com_m", "gait_speed_mps"]),
                            ("features", None)):
        cpu_s, begin_s = time.process_time(), time.monotonic()
        with footing.read(path) as opened:
            table = opened.table(channel, fields=fields)
            print(f"{channel}, {'all fields' if fields is None else ', '.join(fields)}: {len(table)} rows, "
                  f"{len(table.columns)} columns of {opened.duration_s / 60:.0f} min in {time.monotonic() - begin_s:.1f} s "
                  f"({time.process_time() - cpu_s:.1f} s of CPU)", flush=True)


if __name__ == "__main__":
    binaries, kind, *words = sys.argv[1:]
    if kind == "live":
        with Stage(binaries) as own_stage:
            live(own_stage, float(words[0]) if words else 60)
    elif kind == "repeat":
        repeat(words[0], words[1], float(words[2]))
    else:
        read(words[0])
