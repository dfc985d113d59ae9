"""Memory and disk that runs will take, known before they start.

Measured peaks (resident set of `run -o`, Exudyn 1.13, Python 3.11) beside what is predicted here, in MB:

========== ===== ======= ============ ======== =========
method     spans step    wires stored measured predicted
========== ===== ======= ============ ======== =========
exudyn     3     4 ms    none         306      328
exudyn     3     1 ms    1 ms         309      346
exudyn     10    2 ms    10 ms        313      375
linearised 10    1 ms    10 ms        373      377
linearised 10    0.1 ms  0.2 ms       1234     1358
========== ===== ======= ============ ======== =========

The size of run.nc is predicted to 2 %.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from catenary_fe.fe.mesh import Mesh
from catenary_fe.layout import AnyPantograph, Catenary, InputError

PROGRAM = 320e6  # [bytes] of the program itself with its libraries
A_NODE = 2e4  # [bytes] of a node in the model and its factors
COPIES = {
    "exudyn": 3.0,
    "nonlinear": 2.5,
    "linearised": 2.5,
}  # of the histories, in double precision, at the end of a run
SHARE = 0.9  # of the memory that is free


@dataclass(frozen=True)
class Demand:
    """What a run takes.

    memory : [bytes] at its peak
    output : [bytes] of run.nc
    """

    memory: float
    output: float


def demand(
    catenary: Catenary,
    mesh: Mesh,
    pantographs: Sequence[AnyPantograph],
    steps: int,
    shapes: int,
    method: str,
    slots: int = 1,
) -> Demand:
    """Predict what a run takes.

    shapes : stored shapes of the whole wires
    slots : runs side by side in one process
    """
    masses = max(len(p.masses) for p in pantographs)
    each = len(pantographs) * (3 + max(masses, 1)) + len(catenary.droppers) + len(catenary.supports) + 1
    nodes = int(mesh.first_nodes[-1])
    histories, wires = 8.0 * each * (steps + 1), 4.0 * nodes * shapes
    in_memory = COPIES[method] * (slots * histories + 2 * wires)
    return Demand(PROGRAM + A_NODE * nodes + in_memory, histories + wires)


def check_memory(found: Demand, what: str, workers: int = 1) -> None:
    """Refuse what the machine has no memory for, before it comes to an end over it.

    Raises InputError with the estimate, what is free, and what to do.
    """
    free = free_memory()
    if free is not None and workers * found.memory > SHARE * free:
        at_once = f"{workers} processes of " if workers > 1 else ""
        fewer = ", fewer processes (--jobs)" if workers > 1 else ""
        raise InputError(
            f"{what}: would take {at_once}{_in_gb(found.memory)} of memory, and {_in_gb(found.output)} on"
            f" disk for each run; {_in_gb(free)} of memory are free: store wires less often or not at all,"
            f" take a larger time step{fewer} or fewer spans"
        )


def workers_that_fit(found: Demand, most: int) -> int:
    """How many processes the memory has room for, from 1 to the most."""
    free = free_memory()
    return most if free is None else max(1, min(most, int(SHARE * free / found.memory)))


def free_memory() -> float | None:
    """[bytes] that programs may still take, or None where the system does not say."""
    found = [value for value in (_of_machine(), _of_group()) if value is not None]
    return min(found) if found else None


def _of_machine() -> float | None:
    try:
        for line in Path("/proc/meminfo").read_text().splitlines():
            if line.startswith("MemAvailable:"):
                return 1024.0 * int(line.split()[1])
    except (OSError, ValueError, IndexError):
        pass
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return None


def _of_group(folder: Path = Path("/sys/fs/cgroup")) -> float | None:
    """What a container leaves."""
    try:
        limit = (folder / "memory.max").read_text().strip()
        used = int((folder / "memory.current").read_text())
        return None if limit == "max" else max(0.0, float(int(limit) - used))
    except (OSError, ValueError):
        return None


def _in_gb(size: float) -> str:
    return f"{size / 1e9:.3g} GB"
