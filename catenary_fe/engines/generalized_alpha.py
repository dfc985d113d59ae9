"""Generalised-α (Arnold and Brüls 2007), the time integration of the compiled engines."""

from __future__ import annotations

from typing import Any, NamedTuple

from catenary_fe.engines.arrays import SLOTS, Floats, Wires
from catenary_fe.engines.compiled import compiled
from catenary_fe.engines.lanes import load_eight, store_eight
from catenary_fe.engines.settings import TimeSettings


class Scheme(NamedTuple):
    """Generalised-α of a fixed time step h (Arnold and Brüls 2007), which has one more state c a coordinate.

    With x the accelerations at the step's end, there q = q* + b x and v = v* + g x. The next step has
    q* + h v* + qx x + qc c, then v* + vx x + vc c, and cx x + cc c.
    The method's own accelerations are s x + c.
    """

    h: float
    b: float
    g: float
    qx: float
    qc: float
    vx: float
    vc: float
    cx: float
    cc: float
    s: float


def make_scheme(time: TimeSettings) -> Scheme:
    """Coefficients of the generalised-α method that Exudyn uses.

    With a the method's own accelerations, (1 - αm) a' + αm a = (1 - αf) x' + αf x; c is the part of a' that
    does not come from x'.
    """
    h, rho = time.step, time.spectral_radius
    am, af = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
    gamma = 0.5 - am + af
    beta = (gamma + 0.5) ** 2 / 4
    s = (1 - af) / (1 - am)
    b, g = h * h * beta * s, h * gamma * s
    cx, cc = (af - am * s) / (1 - am), -am / (1 - am)
    return Scheme(
        h=h,
        b=b,
        g=g,
        qx=b + h * g + h * h * ((0.5 - beta) * s + beta * cx),
        qc=h * h * (0.5 - beta + beta * cc),
        vx=g + h * ((1 - gamma) * s + gamma * cx),
        vc=h * (1 - gamma + gamma * cc),
        cx=cx,
        cc=cc,
        s=s,
    )


@compiled
def advance(scheme: Scheme, q: Any, v: Any, c: Any, x: Any) -> tuple[Any, Any, Any]:
    """q*, v* and c of the next step."""
    return (
        q + scheme.h * v + scheme.qx * x + scheme.qc * c,
        v + scheme.vx * x + scheme.vc * c,
        scheme.cx * x + scheme.cc * c,
    )


@compiled
def predict(scheme: Scheme, beta: float, wires: Wires) -> None:
    """State of the next step in place; of any number of coordinates and slots that eight divides."""
    for i in range(0, wires.x.size, SLOTS):
        q, v, c = advance(
            scheme,
            load_eight(wires.q, i),
            load_eight(wires.v, i),
            load_eight(wires.c, i),
            load_eight(wires.x, i),
        )
        store_eight(wires.q, i, q)
        store_eight(wires.v, i, v)
        store_eight(wires.c, i, c)
        store_eight(wires.w, i, q + beta * v)


def at_start(scheme: Scheme, q: Floats, v: Floats, x: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """q*, v*, c and x of a state with these coordinates, velocities and accelerations."""
    return q - scheme.b * x, v - scheme.g * x, (1 - scheme.s) * x, x
