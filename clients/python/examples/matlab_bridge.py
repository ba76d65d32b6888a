"""What MATLAB calls through `py.`: plain functions, numbers as arrays of doubles.

    pyenv(Version="/usr/bin/python3"); insert(py.sys.path, int32(0), "FOLDER OF THIS FILE");
    s = py.matlab_bridge.read("walk.mcap", "boards", "left_board", {"cop_x_m", "cop_y_m"}, 100);
    t = double(s{"time_s"}); plot(t, double(s{"cop_x_m"}))
    live = py.matlab_bridge.Live("boards"); pause(1); s = live.take(); live.close()
"""
import array
import sys
import threading

import footing


def _doubles(table, fields):
    return {name: array.array("d", map(float, table[name])) for name in ["time_s", *fields]}


def read(path, channel, role, fields, rate_hz=0):
    """Columns of a recording by name; an even rate if rate_hz is not 0."""
    with footing.read(str(path)) as recording:
        table = recording.table(str(channel), role=str(role) or None)
    return _doubles(table.resample(float(rate_hz)) if rate_hz else table, list(map(str, fields)))


class Live:
    """Gathers a channel in the background; take() hands over what came since the last call."""

    def __init__(self, channel, address=None):
        self._client = footing.connect(str(address) if address else None)
        self._blocks, self._open = [], True
        self._thread = threading.Thread(target=self._run, args=(str(channel),), daemon=True)
        self._thread.start()

    def _run(self, channel):
        for block in self._client.blocks(channel, every_s=0.05):
            self._blocks.append(block)
            if not self._open:
                return

    def take(self):
        blocks, self._blocks = [one for one in self._blocks if len(one)], []
        names = [name for name in (blocks[0].names if blocks else []) if not isinstance(blocks[0][name][0], (str, bytes))]
        return {name: array.array("d", [float(value) for one in blocks for value in one[name]]) for name in names}

    def close(self):
        self._open = False
        self._thread.join()
        self._client.close()


if __name__ == "__main__":  # As MATLAB would: matlab_bridge.py RECORDING.mcap CHANNEL ROLE FIELD...
    columns = read(sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:], 100)
    print(", ".join(f"{name}: {len(values)}" for name, values in columns.items()))
