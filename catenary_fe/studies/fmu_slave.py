"""What an FMU begins with: its variables and steps, as pythonfmu asks for them."""

from __future__ import annotations

from functools import partial
from importlib.metadata import version
from typing import Any

from pythonfmu import DefaultExperiment, Fmi2Causality, Fmi2Slave, Fmi2Variability, Real
from pythonfmu.enums import Fmi2Status

from catenary_fe.layout import CatenaryError
from catenary_fe.studies.fmu import CoupledCatenary, Record, guid_of


class CatenaryFmu(Fmi2Slave):  # type: ignore[misc]
    """A catenary with the pantographs' heads, or with whole pantographs."""

    def __init__(self, **given: Any) -> None:
        super().__init__(**given)
        record = Record.read(self.resources)
        self._coupled = coupled = CoupledCatenary(record)
        self._values: dict[str, float] = {}
        self._initialised = False
        self._times: tuple[float, float | None] = (0.0, None)
        self.guid, self.version = guid_of(record), record.version
        self.description = f"{record.catenary['name']}, catenary_fe, cut: {record.cut}"
        self.default_experiment = DefaultExperiment(0.0, record.duration, record.time_step)
        for name, words in coupled.inputs.items():
            self._settable(name, words, Fmi2Causality.input, Fmi2Variability.continuous)
        words = "[s] of the time integration; communication steps are whole numbers of it"
        self._settable("time_step", words, Fmi2Causality.parameter, Fmi2Variability.fixed)
        kinds = {"causality": Fmi2Causality.output, "variability": Fmi2Variability.continuous}
        for name, words in coupled.outputs.items():
            self.register_variable(Real(name, description=words, getter=partial(self._read, name), **kinds))

    def _settable(self, name: str, words: str, causality: Any, variability: Any) -> None:
        access = {"getter": partial(self._coupled.values.get, name), "setter": partial(self._set, name)}
        kinds = {"causality": causality, "variability": variability}
        self.register_variable(Real(name, description=words, **access, **kinds))

    def _set(self, name: str, value: float) -> None:
        self._coupled.values[name] = value
        if not self._initialised:
            self._values.clear()  # outputs of another static contact

    def _read(self, name: str) -> float:
        if not self._values:  # asked for while it is initialised
            self._start()
        return self._values[name]

    def _start(self) -> None:
        try:
            self._coupled.begin(*self._times)
        except CatenaryError as error:
            self.log(str(error), Fmi2Status.error)
            raise
        self._values |= self._coupled.read()

    def setup_experiment(self, start_time: float, stop_time: float | None, tolerance: float | None) -> None:
        """Remember how long it lasts."""
        self._times = start_time, stop_time

    def exit_initialization_mode(self) -> None:
        """Static contact."""
        if (here := version("catenary_fe")) != self._coupled.record.version:
            text = f"made by catenary_fe {self._coupled.record.version}, run by {here}: numbers may differ"
            self.log(text, Fmi2Status.warning)
        if not self._values:
            self._start()
        self._initialised = True

    def do_step(self, current_time: float, step_size: float) -> bool:
        """A communication step; false, with the reason in the log, where it is refused or fails."""
        try:
            self._coupled.step(current_time, step_size)
        except CatenaryError as error:
            self.log(str(error), Fmi2Status.error)
            return False
        self._values |= self._coupled.read()
        return True

    def _get_fmu_state(self) -> dict[str, Any]:
        return {"state": self._coupled.state()}

    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        self._coupled.restore(state["state"])
        self._values |= self._coupled.read()

    @staticmethod
    def _fmu_state_to_bytes(state: dict[str, Any]) -> bytes:
        return bytes(state["state"])

    @staticmethod
    def _fmu_state_from_bytes(state: bytes) -> dict[str, Any]:
        return {"state": state}
