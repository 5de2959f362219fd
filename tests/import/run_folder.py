"""What a run itself says of its exports: metrics, dumped arrays, tables of poses."""
import csv
import os

import numpy as np


def metrics(exports):
    """The columns of metrics.csv, a row per frame."""
    with open(os.path.join(exports, "..", "metrics.csv"), newline="") as stream:
        rows = list(csv.DictReader(stream))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def dumped(exports, name):
    return np.load(os.path.join(exports, "..", name + ".npy")).ravel()


def places(exports, frame):
    """Where each body is, from the table of poses, by name."""
    with open(os.path.join(exports, f"bodies_{frame:04}.csv"), newline="") as stream:
        return {row["name"]: np.array([float(row[axis]) for axis in "xyz"]) for row in csv.DictReader(stream)}


def own_bounds(exports, body):
    """Of a body's mesh in its own axes."""
    with open(os.path.join(exports, f"body_{body:03}.obj")) as stream:
        points = np.array([[float(part) for part in line.split()[1:]] for line in stream if line.startswith("v ")])
    return points.min(0), points.max(0)
