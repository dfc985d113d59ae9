"""Which engine a case is computed with."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Literal, cast

Engine = Literal["nonlinear", "linearised", "exudyn"]
ENGINES: tuple[Engine, ...] = ("nonlinear", "linearised", "exudyn")
_engine: ContextVar[str] = ContextVar("engine", default="nonlinear")


def engine() -> Engine:
    """The engine that the case being computed runs with."""
    return cast(Engine, _engine.get())


@contextmanager
def on(name: str) -> Iterator[None]:
    """Compute what is inside with an engine."""
    token = _engine.set(name)
    try:
        yield
    finally:
        _engine.reset(token)
