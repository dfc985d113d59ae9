"""A span: from one support to the next, with its droppers."""

from __future__ import annotations

from typing import Self

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationInfo, field_validator, model_validator

from catenary_fe.layout.parameters import Number, Parameters, Positive, refuse
from catenary_fe.layout.wire import Dropper

SHARPEST_CURVE = 50.0  # [m] tramways; an assumption
CLOSEST = 0.01  # [m] between clamps: closer ones are a slip of the pen, and no mesh


class Span(Parameters):
    """From one support to the next, with its droppers in order."""

    length: Positive
    """[m] between the supports"""
    droppers: tuple[Dropper, ...]
    """in order of their positions"""
    pre_sag: Number = 0.0
    """[m] design sag of the contact wire at mid-span, a parabola between the outermost droppers"""
    curve_radius: Number | None = None
    """[m] of the track, positive in a curve to the left (centre at +y); unset or 0: straight"""

    @model_validator(mode="after")
    def _curve_is_a_track(self) -> Self:
        if self.curve_radius and abs(self.curve_radius) < SHARPEST_CURVE:
            raise ValueError(
                f"curve_radius = {self.curve_radius:g} m: no track with a catenary curves more sharply than"
                f" {SHARPEST_CURVE:g} m; leave it out where the track is straight"
            )
        return self

    @property
    def curvature(self) -> float:
        """[1/m] of the track, positive to the left."""
        return 1 / self.curve_radius if self.curve_radius else 0.0

    @field_validator("droppers")
    @classmethod
    def _droppers_in_order(cls, droppers: tuple[Dropper, ...], info: ValidationInfo) -> tuple[Dropper, ...]:
        length = info.data.get("length", np.inf)  # a faulty one is reported by itself
        faults, previous = [], 0.0
        for number, dropper in enumerate(droppers, start=1):
            x = dropper.position
            if not 0 < x < length:
                faults.append(
                    f"dropper {number} at {x:g} m lies outside the {length:g} m span;"
                    f" positions count from the span's first support, between 0 and {length:g} m"
                )
            elif x <= previous:
                faults.append(
                    f"dropper {number} at {x:g} m does not come after the one before it at {previous:g} m;"
                    " list the droppers in order, each position once"
                )
            elif min(x - previous, length - x) < CLOSEST:
                faults.append(
                    f"dropper {number} at {x:.6g} m is less than {CLOSEST:g} m from the next clamp or support"
                    "; move it, or make one dropper of two"
                )
            else:
                previous = x
        refuse(faults)
        return droppers

    def height_offsets(self) -> NDArray[np.float64]:
        """[m], shape (droppers,): design height of the contact wire at each dropper above the nominal one."""
        x = np.array([d.position for d in self.droppers])
        if x.size == 0:
            return x
        first, last = x[0], x[-1]
        xi = (x - first) / (last - first) if last > first else np.full_like(x, 0.5)
        sag = -4 * self.pre_sag * xi * (1 - xi)
        own = [np.nan if d.height_offset is None else d.height_offset for d in self.droppers]
        return np.where(np.isnan(own), sag, own)
