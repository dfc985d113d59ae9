"""Runs that a script steers step by step, for active pantographs and co-simulation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from io import BytesIO
from types import TracebackType
from typing import Self
from zipfile import BadZipFile

import numpy as np
from numpy.typing import ArrayLike, NDArray

from catenary_fe.engines.history import FEWEST, History
from catenary_fe.engines.nonlinear.run import NonlinearEngine, NonlinearRun
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.engines.tension import INTERVAL
from catenary_fe.layout import AnyPantograph, InputError
from catenary_fe.layout.arguments import checked, number, numbers, whole
from catenary_fe.layout.conditions import Conditions, Effect
from catenary_fe.layout.pantograph import check_pantographs
from catenary_fe.layout.substructure import Substructure
from catenary_fe.results import Run
from catenary_fe.results.balances import BY_A_SCRIPT
from catenary_fe.statics import Shape, settle
from catenary_fe.studies.checks import check_speed, plan_run
from catenary_fe.studies.linearised import MeanForce, aimed
from catenary_fe.studies.record import as_partial, make_run

Floats = NDArray[np.float64]

STEERED = (
    "computed step by step, with forces or speeds that a script set: they are not in this record; to repeat"
    " the run, repeat the script"
)
HIGHEST = 3.0  # [m] by which a base may move: the way of a frame
STRONGEST = 5000.0  # [N] of an uplift: beyond it the number is in another unit


@checked
def stepping(
    shape: Shape,
    pantographs: Sequence[AnyPantograph],
    *,
    speed: float,
    positions: Sequence[float] | None = None,
    time: TimeSettings | None = None,
    duration: float | None = None,
    conditions: Conditions | Sequence[Effect] | None = None,
    uplift_force: ArrayLike | None = None,
    base_height: ArrayLike | None = None,
) -> Session:
    """A nonlinear run that goes on step by step, by what a script asks for: see :class:`Session`.

    Where nothing is asked for it is the run of :func:`simulate`, to the last bit; of pantographs with a mean
    force it is that with the uplift that linearised runs find for it.

    speed : [m/s] at the start
    positions : [m] along the line at the start, one a pantograph; unset (for one): near the first support
    time : settings of the time integration
    duration : [s] that the session may last; unset: until the line's end is reached at this speed
    conditions : the line is settled under them first, or effects
    uplift_force : [N] in static contact at the start and then until a step has another one, one for all
        pantographs or one each; unset: their own
    base_height : [m] by which the bases are lifted there, likewise; unset: 0

    Raises InputError as :func:`simulate` does, SolverError without static contact.
    """
    check_pantographs(pantographs)
    if conditions is not None:
        shape = settle(shape, conditions)
    time = time or TimeSettings()
    case = plan_run(shape, pantographs, speed, positions, time, pantographs)
    steps = case.steps(time.step)
    if duration is not None:
        steps = int(np.ceil(number("duration", duration, "s", least=FEWEST * time.step) / time.step - 1e-9))
    if uplift_force is not None:
        uplifts = _one_each("uplift_force", uplift_force, len(pantographs), STRONGEST, "N")
    else:
        force = MeanForce(pantographs, speed)
        uplifts = (aimed(shape, case, time) if force.sought else force).uplifts
    bases = None
    if base_height is not None:
        _refuse_moving_bases(shape, "base_height")
        bases = _one_each("base_height", base_height, len(pantographs), HIGHEST, "m")
    run = NonlinearEngine(shape.system, time).begin(case, uplifts, steps, bases)

    def label(history: History, *, steered: bool) -> Run:
        warnings = [*case.warnings, *([STEERED] if steered else [])]
        by = BY_A_SCRIPT if steered else ""
        return make_run(shape, case, uplifts, time, history, warnings, "nonlinear", scripted=by)

    given = uplift_force is not None or base_height is not None
    return Session(run, steps, time.step, shape, label, steered=given)


def _one_each(name: str, values: ArrayLike, count: int, most: float, unit: str) -> Floats:
    """Shape (count,), of one for all pantographs or one each, within a bound. Raises InputError."""
    found = numbers(name, values)
    if found.shape not in ((), (count,)):
        raise InputError(f"{name}: shape {found.shape} for {count} pantographs; give one for all or one each")
    if np.abs(found).max() > most:
        raise InputError(
            f"{name} = {found.tolist()} {unit}: must be within ±{most:g} {unit}; look at the unit"
        )
    return np.full(count, found)


def _refuse_moving_bases(shape: Shape, what: str) -> None:
    if shape.system.base_line.motions:
        raise InputError(
            f"{what}: the conditions move the bases already, by the speed at the start; leave their base"
            f" motion out, or {what}"
        )


class Session:
    """A run under way, from :func:`stepping`. Its values are those at the end of the last step.

    time : [s] since the start
    position, speed : [m], shape (pantographs,), along the line; [m/s] of all of them
    contact_force, wire_height : [N], [m], shape (pantographs,), of all strips and wires; above the rail
    heights, velocities, accelerations : [m], [m/s], [m/s²], of each pantograph shape (coordinates,): its
        masses from the head down, above the nominal contact wire height, then rolls [rad]
    uplift_force : [N], shape (pantographs,), on the lowest masses
    duration : [s] that the session may last
    bodies : what each pantograph is made of, see :class:`catenary_fe.layout.substructure.Substructure`
    finished : whether the session has come to its end
    """

    def __init__(
        self,
        run: NonlinearRun,
        steps: int,
        step: float,
        shape: Shape,
        label: Callable[..., Run],
        *,
        steered: bool = False,
    ) -> None:
        self._run, self._steps, self._step, self._shape, self._label = run, steps, step, shape, label
        self._interval = max(1, round(INTERVAL / step))
        self._steered = steered
        self._placed = run.placed
        self.speed = run.speed
        self.uplift_force: Floats = np.array([placed.uplift for placed in self._placed])
        self._positions = np.zeros((len(self._placed), steps + 1))
        self._positions[:, 0] = [placed.position for placed in self._placed]

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Nothing is open: a session needs no end."""

    @property
    def time(self) -> float:
        """[s] since the start."""
        return self._step * self._run.done

    @property
    def duration(self) -> float:
        """[s] that the session may last."""
        return self._step * self._steps

    @property
    def bodies(self) -> list[Substructure]:
        """What each pantograph is made of: its coordinates are those of heights."""
        return [placed.body for placed in self._placed]

    @property
    def finished(self) -> bool:
        """Whether the session has come to its end."""
        return self._run.done >= self._steps

    @property
    def position(self) -> Floats:
        """[m], shape (pantographs,), along the line."""
        return self._positions[:, self._run.done].copy()

    @property
    def contact_force(self) -> Floats:
        """[N], shape (pantographs,), of all strips on all wires."""
        return self._run.contact_forces()

    @property
    def wire_height(self) -> Floats:
        """[m], shape (pantographs,), above the rail, of the wire over each head; the lower of several."""
        return self._shape.catenary.contact_wire_height + self._run.wire_heights()

    @property
    def heights(self) -> list[Floats]:
        """[m], of each pantograph shape (coordinates,)."""
        return self._run.heads_in_motion()[0]

    @property
    def velocities(self) -> list[Floats]:
        """[m/s], of each pantograph shape (coordinates,)."""
        return self._run.heads_in_motion()[1]

    @property
    def accelerations(self) -> list[Floats]:
        """[m/s²], of each pantograph shape (coordinates,)."""
        return self._run.heads_in_motion()[2]

    @checked
    def step(
        self,
        steps: int = 1,
        *,
        uplift_force: ArrayLike | None = None,
        base_height: ArrayLike | None = None,
        speed: float | None = None,
    ) -> Floats:
        """Take steps, and return the contact forces [N] at their end, shape (pantographs,).

        uplift_force : [N] on the lowest masses from now on, one for all pantographs or one each; below 0 it
            pulls the head down; unset: as before
        base_height : [m] by which the bases are lifted, at the end of the first of these steps and from then
            on, one for all pantographs or one each; their rate in that step is the difference over the step,
            and acts through the damper of the lowest stage. Unset: as before
        speed : [m/s] from now on, 0 to stand still; unset: as before

        Raises InputError for values in another unit and behind the session's end, SolverError where a step
        does not converge.
        """
        steps = whole("steps", steps, least=1)
        if self._run.done + steps > self._steps:
            raise InputError(
                f"step: {steps} more would end at {self._step * (self._run.done + steps):.4g} s, and the"
                f" session lasts {self._step * self._steps:.4g} s; give stepping a longer duration"
            )
        if uplift_force is not None:
            self._push(uplift_force)
        if base_height is not None:
            self._lift(base_height)
        if speed is not None and speed != self.speed:
            self._drive(speed)
        for _ in range(steps):
            before = self._positions[:, self._run.done]
            self._positions[:, self._run.done + 1] = before + self.speed * self._step
            self._check_place(self._positions[:, self._run.done + 1])
            self._run.advance(1, read=(self._run.done + 1) % self._interval == 0)
        return self.contact_force

    def state(self) -> bytes:
        """All that the next steps depend on, to the last bit, and what was recorded until now.

        For :meth:`restore`, in this session or in another one that began in the same way, also in another
        process of the same installation. It grows with the steps taken.
        """
        known = {
            "of": self._kind(),
            "positions": self._positions[:, : self._run.done + 1],
            "speed": np.array(self.speed),
            "uplift_force": self.uplift_force,
            "steered": np.array(self._steered),
        }
        stream = BytesIO()
        np.savez(stream, **self._run.arrays(), **self._run.steered(), **known)  # type: ignore[arg-type]
        return stream.getvalue()

    def restore(self, state: bytes) -> None:
        """Go back, or forward, to a state. Raises InputError for what is none, or of another session."""
        try:
            with np.load(BytesIO(state), allow_pickle=False) as file:
                kept = dict(file)
            of = kept["of"]
        except (OSError, ValueError, KeyError, EOFError, TypeError, BadZipFile):
            raise InputError("restore: not a state of a session; give what its state() returned") from None
        if not np.array_equal(of, self._kind()):
            raise InputError(
                "restore: the state of a session with another line, start, time step or duration; begin this"
                " one in the same way"
            )
        self._run.go_on(kept)
        self._run.steer(kept)
        self._positions[:, : self._run.done + 1] = kept["positions"]
        self.speed, self.uplift_force = float(kept["speed"]), kept["uplift_force"]
        self._steered = bool(kept["steered"])

    def _kind(self) -> Floats:
        """What two sessions have in common whose states fit each other."""
        start = [self._run.speed, *(v for p in self._placed for v in (p.position, p.uplift, *p.heights))]
        return np.array([self._steps, self._step, self._shape.system.size, *start])

    def run(self) -> Run:
        """What was computed until now, as :func:`simulate` returns it: statistics, pictures, files.

        Where that is a part of the session, or not all evaluated spans were passed, it is a partial run.

        Raises InputError where that is less than 50 steps.
        """
        if self._run.done < FEWEST:
            raise InputError(f"run: {self._run.done} steps are too few to be judged; take at least {FEWEST}")
        history = self._run.history()
        if self._run.done < self._steps:
            part = history.until(self._run.done)
            assert part
            history = part
        if self._steered:  # energies count the work of the uplift that the run began with
            none = np.array([])
            own = self._positions[:, : history.time.size]
            history = replace(history, position=own, energy=none, lost_work=None)
        run = self._label(history, steered=self._steered)
        end = run.data["support_position"].values[max(run.evaluated_spans)]
        if self.finished and (run.data["position"].values[:, -1] >= end).all():
            return run
        return as_partial(run, "a script stepped so far", self._steps * self._step)

    def _push(self, uplift_force: ArrayLike) -> None:
        given = _one_each("uplift_force", uplift_force, len(self._placed), STRONGEST, "N")
        if (given != self.uplift_force).any():
            self._steered, self.uplift_force = True, given
            self._run.push(given)

    def _lift(self, base_height: ArrayLike) -> None:
        given = _one_each("base_height", base_height, len(self._placed), HIGHEST, "m")
        _refuse_moving_bases(self._shape, "base_height")
        if (given != self._run.base_curves()[:, self._run.done, 0]).any():
            self._steered = True
            self._run.move_base(given)

    def _drive(self, speed: float) -> None:
        speed = number("speed", speed, "m/s", least=0.0)
        if speed:
            check_speed(speed)
        _refuse_moving_bases(self._shape, "speed")
        self._steered, self.speed = True, speed
        self._run.drive(speed)

    def _check_place(self, position: Floats) -> None:
        last = float(self._shape.catenary.length)
        if position.max() > last:
            raise InputError(
                f"step: the first pantograph would be at {position.max():.2f} m, beyond the line's end at"
                f" {last:g} m; stop before, or slow down"
            )
