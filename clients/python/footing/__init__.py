"""Footing from Python: live samples, recordings, commands, simulated devices (docs/python.md).

    import footing
    with footing.connect() as f:
        for sample in f.samples("motion", seconds=10):
            print(sample.role, sample.time_s, sample.data.specific_force_mps2.x)
"""
from footing.bids import BidsRun, read_bids
from footing.columns import FieldError, Table
from footing.devices import Device, Tracker, device, tracker
from footing.recording import DamagedRecording, Recording, read
from footing.session import Client, Sample, Tick, connect
from footing.wire import ConnectionLost, FootingError, NotRunning, Refused

__version__ = "0.1.0"
