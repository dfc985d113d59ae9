"""Compilation of hot loops with numba where it is installed; without it they stay plain Python."""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import Any, TypeVar, cast

numba: Any
try:
    import numba
except ImportError:
    numba = None

COMPILED = numba is not None
_Function = TypeVar("_Function", bound=Callable[..., Any])


def compiled(function: _Function) -> _Function:
    """Compile on first use, for other compiled functions alone: Python must call :func:`plain` of it."""
    return _compiled(function, keep=False)


def plain(function: _Function) -> _Function:
    """The Python function behind a compiled one."""
    return cast(_Function, getattr(function, "py_func", function))


def kept(function: _Function) -> _Function:
    """Compile on first use and keep the machine code beside the source, with all compiled functions it calls.

    What is kept is found by the function's file and the values it closes over. Changes in the functions that
    it calls go unseen otherwise: let it close over their :func:`stamp`.
    """
    return _compiled(function, keep=True)


def stamp(*modules: ModuleType) -> str:
    """Changes when the source of a module does."""
    return hashlib.sha256("".join(map(inspect.getsource, modules)).encode()).hexdigest()


def _compiled(function: _Function, keep: bool) -> _Function:
    if numba is None:
        return function
    # to unpack Python arguments takes longer to compile than most functions that only others call
    options = {"cache": True} if keep else {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    return cast(_Function, numba.njit(fastmath={"contract"}, error_model="numpy", **options)(function))


@contextmanager
def vectorising() -> Iterator[None]:
    """Let what is compiled inside make vectors of neighbouring scalars: twice as fast here."""
    if numba is None:
        yield
        return
    config = numba.config
    before = config.SLP_VECTORIZE
    config.SLP_VECTORIZE = 1
    try:
        yield
    finally:
        config.SLP_VECTORIZE = before
