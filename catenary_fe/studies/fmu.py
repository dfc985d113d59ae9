"""The catenary for a co-simulation: with the pantographs' heads, or with whole pantographs, as an FMU.

A co-simulation exchanges values once a step, so that a spring between its parts acts as if with a delay. Of a
spring k and a step dt this is about a damper of −k·dt/2, which feeds energy into the coupling. At the contact
(50 kN/m, 1 ms) it is −25 N s/m, as much as half a head's own damper; below the head (7 kN/m) it is
−3.5 N s/m. Therefore the cut is below the head, which stays with the wire.
"""

from __future__ import annotations

import json
import re
import sys
import tempfile
import zipfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Literal, get_args
from uuid import NAMESPACE_URL, uuid5

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.settings import TimeSettings
from catenary_fe.layout import AnyPantograph, Catenary, InputError, read_catenary, recorded_pantograph
from catenary_fe.layout.conditions import Conditions
from catenary_fe.layout.pantograph import Pantograph
from catenary_fe.results.files import atomic_write
from catenary_fe.statics import Shape, find_form, settle
from catenary_fe.studies.stepping import Session, stepping

Floats = NDArray[np.float64]
Cut = Literal["head", "none"]
RECORD = "catenary.json"  # what the FMU carries of the line
SCRIPT = "fmu_slave"  # the module that an FMU begins with
_DATE = re.compile(rb' generationDateAndTime="[^"]*"')

_AT_RUN_TIME = {
    "position": "[m] along the line",
    "contact_force": "[N] of all strips on all wires",
    "wire_height": "[m] of the wire over the head, above the nominal contact wire height",
    "head_height": "[m] of the head, above the nominal contact wire height",
}
INPUTS: dict[Cut, dict[str, str]] = {
    "head": {
        "frame_height": "[m] of what the head's spring stands on: 0 where this spring is force-free with the"
        " head at the nominal contact wire height",
        "frame_velocity": "[m/s] with which the frame goes on during the step; 0: frame_height is that at the"
        " step's end",
    },
    "none": {
        "uplift_force": "[N] on the lowest mass",
        "base_height": "[m] by which the base is lifted, at the step's end",
    },
}
OUTPUTS: dict[Cut, dict[str, str]] = {
    "head": _AT_RUN_TIME | {"frame_force": "[N] upward, of the head's spring and damper on the frame"},
    "none": _AT_RUN_TIME
    | {
        "frame_height": "[m] of the lowest mass, above the nominal contact wire height",
        "frame_velocity": "[m/s] upward, of the lowest mass",
    },
}


@dataclass(frozen=True)
class Record:
    """What an FMU carries: enough to begin anywhere, and no paths.

    speed : [m/s] at the start
    positions : [m], of the pantographs at the start
    duration : [s] until the line's end at this speed
    starts : values of each pantograph's inputs at the start, in the order of :data:`INPUTS`
    """

    cut: Cut
    catenary: dict[str, Any]
    pantographs: list[dict[str, Any]]
    conditions: dict[str, Any] | None
    speed: float
    positions: list[float]
    duration: float
    time_step: float
    starts: list[list[float]]
    version: str

    @property
    def text(self) -> str:
        """As JSON."""
        return json.dumps(asdict(self), ensure_ascii=False, allow_nan=False)

    @classmethod
    def read(cls, folder: str | Path) -> Record:
        """From an FMU's resources."""
        return cls(**json.loads((Path(folder) / RECORD).read_text(encoding="utf-8")))


def record_of(
    catenary: Catenary,
    pantographs: Sequence[AnyPantograph],
    *,
    cut: Cut,
    speed: float,
    positions: Sequence[float] | None = None,
    conditions: Conditions | None = None,
    time: TimeSettings | None = None,
) -> Record:
    """Check what an FMU is to carry, and find where its inputs start: in static contact.

    Raises InputError for what cannot be run or cut, SolverError without static contact.
    """
    if cut not in get_args(Cut):
        raise InputError(f"cut = {cut!r}: must be one of {', '.join(get_args(Cut))}")
    for pantograph in pantographs:
        _check_cut(pantograph, cut)
    if conditions and conditions.base:
        raise InputError(
            "conditions: base has no effect in an FMU, whose inputs move the bases; leave it out"
        )
    time = time or TimeSettings()
    shape = find_form(catenary)
    shape = settle(shape, conditions) if conditions else shape
    whole = stepping(shape, pantographs, speed=speed, positions=positions, time=time)
    if cut == "head":
        starts = [
            [float(y[p.assemble(spatial=False).joints[0].lower]), 0.0]
            for p, y in zip(pantographs, whole.heights, strict=True)
        ]
    else:
        starts = [[force, 0.0] for force in whole.uplift_force.tolist()]
    return Record(
        cut=cut,
        catenary=catenary.model_dump(mode="json"),
        pantographs=[p.model_dump(mode="json") for p in pantographs],
        conditions=conditions.model_dump(mode="json", exclude_unset=True) if conditions else None,
        speed=speed,
        positions=whole.position.tolist(),
        duration=whole.duration,
        time_step=time.step,
        starts=starts,
        version=version("catenary_fe"),
    )


def _check_cut(pantograph: AnyPantograph, cut: Cut) -> None:
    if not pantograph.masses:
        raise InputError(f"{pantograph.name}: an FMU needs a pantograph of masses")
    if cut == "head" and (not isinstance(pantograph, Pantograph) or len(pantograph.stages) < 2):
        raise InputError(
            f"{pantograph.name}: cut = 'head' needs a pantograph of two stages or more, whose first one is"
            " the head; take cut = 'none', which has the whole pantograph inside"
        )


class CoupledCatenary:
    """What an FMU does, without FMI: values in, a step, values out.

    values : of inputs and parameters by name, to be set in place
    """

    def __init__(self, record: Record) -> None:
        self.record = record
        self.values = {"speed": record.speed, "time_step": record.time_step}
        for p, starts in enumerate(record.starts, start=1):
            named = zip(INPUTS[record.cut], starts, strict=True)
            self.values |= {_name(p, key): value for key, value in named}
        self._session: Session | None = None
        self._begin, self._base = 0.0, np.zeros(len(record.pantographs))

    @cached_property
    def _shape(self) -> Shape:
        record, shape = self.record, find_form(read_catenary(self.record.catenary))
        return settle(shape, Conditions.model_validate(record.conditions)) if record.conditions else shape

    @property
    def inputs(self) -> dict[str, str]:
        """Names of the inputs, and what they are."""
        words = {"speed": "[m/s] of all pantographs along the line"}
        count = len(self.record.pantographs)
        return words | {_name(p + 1, k): w for p in range(count) for k, w in INPUTS[self.record.cut].items()}

    @property
    def outputs(self) -> dict[str, str]:
        """Names of the outputs, and what they are."""
        count = len(self.record.pantographs)
        return {_name(p + 1, k): w for p in range(count) for k, w in OUTPUTS[self.record.cut].items()}

    def begin(self, start: float = 0.0, stop: float | None = None) -> None:
        """Find static contact with the inputs as they are.

        start, stop : [s] of the co-simulation; unset: until the line's end is reached at this speed

        Raises InputError for values in another unit, SolverError without static contact.
        """
        record, heads = self.record, self.record.cut == "head"
        first, second = self._inputs()
        pantographs = [recorded_pantograph(p) for p in record.pantographs]
        if heads:
            pantographs = [_head_of(p) for p in pantographs]
        self._session = stepping(
            self._shape,
            pantographs,
            speed=self.values["speed"],
            positions=record.positions,
            time=TimeSettings(step=self.values["time_step"]),
            duration=stop - start if stop is not None and np.isfinite(stop) else None,
            uplift_force=0.0 if heads else first,
            base_height=first if heads else second,
        )
        self._begin, self._base = start, first if heads else second

    def step(self, time: float, size: float) -> None:
        """Go on from a time [s] by a communication step [s].

        Bases go straight to where they are to be at its end. Raises InputError for a step that is no whole
        number of time steps, or begins at another time; SolverError where it does not converge.
        """
        session, h = self._running(), self.values["time_step"]
        count = round(size / h)
        if count < 1 or abs(size - count * h) > 1e-6 * h:
            raise InputError(
                f"communication step of {size:g} s: must be a whole number of time steps, {h:g} s each;"
                " change one of them"
            )
        now = self._begin + session.time
        if abs(time - now) > 1e-3 * h:
            raise InputError(
                f"step from {time:g} s: it is {now:g} s here; restore a state to go back, and do not skip any"
            )
        first, second = self._inputs()
        heads = self.record.cut == "head"
        before, after = self._base, first + size * second if heads else second
        for part in np.arange(1, count + 1) / count:
            session.step(
                uplift_force=None if heads else first,
                base_height=before + part * (after - before) if (before != after).any() else None,
                speed=self.values["speed"],
            )
        self._base = after

    def read(self) -> dict[str, float]:
        """Outputs at the end of the last step; none before the beginning."""
        found: dict[str, float] = {}
        session, nominal = self._session, self.record.catenary["contact_wire_height"]
        if session is None:
            return found
        parts = zip(session.heights, session.velocities, session.accelerations, session.bodies, strict=True)
        for p, (y, w, a, body) in enumerate(parts):
            strips, contact = len(body.strips), float(session.contact_force[p])
            values = {
                "position": session.position[p],
                "contact_force": contact,
                "wire_height": session.wire_height[p] - nominal,
                "head_height": y[:strips].mean(),
                "frame_force": -contact - body.mass[:strips, :strips].sum(axis=0) @ a[:strips],
                "frame_height": y[len(body.bodies) - 1],
                "frame_velocity": w[len(body.bodies) - 1],
            }
            found |= {_name(p + 1, key): float(values[key]) for key in OUTPUTS[self.record.cut]}
        return found

    def state(self) -> bytes:
        """All that the next steps depend on."""
        head = {"values": self.values, "begin": self._begin, "base": self._base.tolist()}
        return json.dumps(head).encode() + b"\n" + (self._session.state() if self._session else b"")

    def restore(self, state: bytes) -> None:
        """Go back, or forward, to a state. Raises InputError for what is none."""
        head, _, session = state.partition(b"\n")
        found = json.loads(head)
        if session:
            self._running().restore(session)
        self.values |= found["values"]
        self._begin, self._base = found["begin"], np.array(found["base"])

    def _running(self) -> Session:
        if self._session is None:
            raise InputError("the co-simulation has not begun; leave the initialization mode first")
        return self._session

    def _inputs(self) -> list[Floats]:
        """Each shape (pantographs,): the pantographs' first inputs, and their second ones."""
        numbers = range(1, len(self.record.pantographs) + 1)
        return [np.array([self.values[_name(p, key)] for p in numbers]) for key in INPUTS[self.record.cut]]


def _name(pantograph: int, key: str) -> str:
    return f"pantograph[{pantograph}].{key}"


def _head_of(pantograph: AnyPantograph) -> Pantograph:
    """The head alone on its spring and damper, whose base is the frame."""
    assert isinstance(pantograph, Pantograph)
    return pantograph.replace(stages=pantograph.stages[:1], base="rail")


def check_fmu_packages() -> None:
    """Raises InputError where the package that makes FMUs is not there."""
    if find_spec("pythonfmu") is None:
        raise InputError('an FMU needs the package pythonfmu: pip install "catenary_fe[fmu]"')


def write_fmu(path: str | Path, record: Record) -> None:
    """Write an FMU (FMI 2.0, co-simulation); the same bytes each time.

    Raises InputError where pythonfmu is missing or the file cannot be written.
    """
    check_fmu_packages()
    from pythonfmu import FmuBuilder

    known = sys.path.copy()
    with tempfile.TemporaryDirectory() as folder, atomic_write(path) as aside:
        script, carried = Path(folder) / f"{SCRIPT}.py", Path(folder) / RECORD
        script.write_bytes((Path(__file__).parent / script.name).read_bytes())
        carried.write_text(record.text, encoding="utf-8")
        built = Path(folder) / "built.fmu"
        try:
            FmuBuilder.build_FMU(
                script, built, [carried], canGetAndSetFMUstate=True, canSerializeFMUstate=True
            )
        finally:
            sys.path[:] = known
            sys.modules.pop(SCRIPT, None)
        with zipfile.ZipFile(built) as made, zipfile.ZipFile(aside, "w", zipfile.ZIP_DEFLATED) as file:
            for name in sorted(made.namelist()):
                content = made.read(name)
                if name == "modelDescription.xml":
                    content = _DATE.sub(b"", content)
                file.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_DEFLATED)


def guid_of(record: Record) -> str:
    """What tells FMUs apart whose contents differ."""
    return str(uuid5(NAMESPACE_URL, record.text))
