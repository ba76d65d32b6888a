"""Data sets in the form of BIDS-motion, as `footing-log export --format bids` writes them, and others."""
import csv
import json
import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Optional, Union

from footing.columns import Table, np
from footing.wire import FootingError


@dataclass
class BidsRun:
    """One tracking system in one task of one subject."""
    subject: str
    task: str
    tracksys: str
    path: Path
    units: Dict[str, str]    # By channel.
    about: Dict[str, Any]    # Contents of motion.json.

    def table(self) -> Table:
        """The channels by name; `time_s` is the channel latency, else it follows from the sampling rate. n/a is NaN."""
        with open(self.path, encoding="utf-8") as file:
            rows = [[float("nan") if cell in ("n/a", "") else float(cell) for cell in line.split("\t")]
                    for line in file.read().splitlines() if line.strip()]
        names = list(self.units)
        if any(len(row) != len(names) for row in rows):
            raise FootingError(f"{self.path} has rows of other than the {len(names)} cells that its channels.tsv describes")
        columns = {name: [row[i] for row in rows] for i, name in enumerate(names)}
        rate_hz = self.about.get("SamplingFrequency") or 0
        time_s = columns.get("latency") or [i / rate_hz if rate_hz else float("nan") for i in range(len(rows))]
        columns = {"time_s": time_s, **columns}
        return Table({name: np.array(values) for name, values in columns.items()} if np is not None else columns)

    def events(self) -> List[Dict[str, str]]:
        """Rows of the task's events.tsv: onset in s, and what happened; empty without the file."""
        found = sorted(self.path.parent.glob(f"sub-{self.subject}*task-{self.task}*_events.tsv"))
        if not found:
            return []
        with open(found[0], encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file, delimiter="\t"))


def read_bids(folder: Union[str, "os.PathLike[str]"], subject: Optional[str] = None, task: Optional[str] = None,
              tracksys: Optional[str] = None) -> List[BidsRun]:
    """The motion tables of a data set, all of them or those of a subject, task or tracking system."""
    runs = []
    for path in sorted(Path(folder).rglob("*_motion.tsv")):
        labels = dict(re.findall(r"([a-z]+)-([A-Za-z0-9]+)", path.name))
        wanted = {"sub": subject, "task": task, "tracksys": tracksys}
        if any(value not in (None, labels.get(key)) for key, value in wanted.items()):
            continue
        stem = str(path)[:-len("_motion.tsv")]
        with open(stem + "_channels.tsv", encoding="utf-8", newline="") as file:
            units = {row["name"]: row["units"] for row in csv.DictReader(file, delimiter="\t")}
        about = json.loads(Path(stem + "_motion.json").read_text(encoding="utf-8"))
        runs.append(BidsRun(labels.get("sub", ""), labels.get("task", ""), labels.get("tracksys", ""), path, units, about))
    if not runs:
        raise FootingError(f"{folder} has no such *_motion.tsv: is it a data set of footing-log export --format bids?")
    return runs
