"""Wind as it was measured, beside its mean, in runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from catenary_fe.layout.conditions.effect import Effect, Floats, Signal, WirePart
from catenary_fe.layout.conditions.ice import Ice
from catenary_fe.layout.conditions.wind import Wind
from catenary_fe.layout.conditions.wind_record import WindRecord
from catenary_fe.layout.errors import InputError


@dataclass(frozen=True)
class _Product:
    """The product of the speeds at two stations, less that of their means [m²/s²]."""

    record: WindRecord
    first: int
    second: int

    def __call__(self, times: Floats) -> Floats:
        """Shape (times,), at times [s] of a run, which begins with the record."""
        record, i, j = self.record, self.first, self.second
        if times.max(initial=0.0) > (lasts := record.end - record.begin):
            raise InputError(
                f"wind.speed: the record has {lasts:g} s, and the run lasts longer; give a longer record, or"
                " run a shorter way"
            )
        more: Floats = record.at(i, times) * record.at(j, times) - record.means[i] * record.means[j]
        return more


@dataclass(frozen=True)
class MeasuredWindLoads(Effect):
    """What the drag of measured wind has more than that of its mean: k (v² - v̄²).

    The speed at a place is made of its two stations' ones, its square of their products, exactly.
    """

    wind: Wind
    ice: Ice | None = None
    _signals: dict[tuple[int, int], _Product] = field(default_factory=dict, compare=False)

    def in_time(self, part: WirePart) -> Sequence[tuple[Floats, Signal]]:
        """Loads [N/m], shape (3, places), each with its product of speeds."""
        record, share = self.wind.record, self.wind.across_share
        assert record
        shares = record.shares(part.x)
        drag = self.wind.resistance(part, self.ice) * share * abs(share)
        found = []
        for i in range(record.x.size):
            for j in range(i, min(i + 2, record.x.size)):
                load = part.nothing
                load[1] = drag * shares[i] * shares[j] * (1 if i == j else 2)
                if load.any():
                    signal = self._signals.setdefault((i, j), _Product(record, i, j))
                    found.append((load, signal))
        return found
