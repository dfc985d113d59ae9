"""Compilation of hot loops with numba."""

from __future__ import annotations

import hashlib
import inspect
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from types import ModuleType
from typing import Any, TypeVar, cast

from catenary_fe.results.files import own_temporary_folder

numba: Any = import_module("numba")  # its types are not complete
_event: Any = import_module("numba.core.event")
_Function = TypeVar("_Function", bound=Callable[..., Any])


class _Compilation(_event.Listener):  # type: ignore[misc]
    """The time that this process has compiled; what is compiled within something else counts once.

    seconds : [s]
    told : called when it begins next, that once; unset: nothing is
    """

    def __init__(self) -> None:
        self.seconds = 0.0
        self.told: Callable[[], None] | None = None
        self._depth, self._begin = 0, 0.0

    def on_start(self, event: Any) -> None:
        if not self._depth:
            self._begin = time.perf_counter()
            told, self.told = self.told, None
            if told:
                told()
        self._depth += 1

    def on_end(self, event: Any) -> None:
        self._depth -= 1
        if not self._depth:
            self.seconds += time.perf_counter() - self._begin


compilation = _Compilation()
_event.register("numba:compile", compilation)


def run_clock() -> float:
    """[s] from some moment on, which stands while code is compiled: that is no part of a run."""
    return time.perf_counter() - compilation.seconds


def compiled(function: _Function) -> _Function:
    """Compile on first use, for other compiled functions alone: Python must call :func:`plain` of it.

    No compiled function may make an array, nor assign one to a part of another.
    """
    return _compiled(function, keep=False)


def apart(function: _Function) -> _Function:
    """Likewise, for what works so long that a call costs nothing beside it: no part of those that call it."""
    return _compiled(function, keep=False, inline=False)


def plain(function: _Function) -> _Function:
    """The Python function behind a compiled one."""
    return cast(_Function, getattr(function, "py_func", function))


def kept(function: _Function) -> _Function:
    """Compile on first use and keep the machine code, with that of all compiled functions it calls.

    It is kept beside the source, where that cannot be written in the user's cache folder, else in a folder of
    the user's for temporary files; where there is no such place either, it is compiled in each process. What
    is kept is found by the function's file and the values it closes over. Changes in the functions that
    it calls go unseen otherwise: let it close over their :func:`stamp`.
    """
    return _compiled(function, keep=True)


def stamp(*modules: ModuleType) -> str:
    """Changes when the source of a module does."""
    return hashlib.sha256("".join(map(inspect.getsource, modules)).encode()).hexdigest()


def _compiled(function: _Function, keep: bool, inline: bool = True) -> _Function:
    # to unpack Python arguments takes longer to compile than most functions that only others call, and to
    # hand over tuples of twenty arrays takes longer than what many of them do
    inner = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True, "forceinline": inline}
    options = {} if keep else inner
    # the caller holds all arrays and nothing is allocated: to count who refers to each takes a fifth of the
    # time to compile, and in contacts nine tenths of that to run
    options["_nrt"] = False
    made = numba.njit(fastmath={"contract"}, error_model="numpy", **options)(function)
    if keep and made is not function:  # numba may be told to compile nothing
        _keep(made)
    return cast(_Function, made)


def _keep(made: Any) -> None:
    """Let numba keep the machine code of a function, wherever there is a place for it."""
    try:
        made.enable_caching()
    except RuntimeError:  # neither the program's folder nor the user's own can be written
        with _cached_in(own_temporary_folder()), suppress(RuntimeError):
            made.enable_caching()
    made._cache = _Forgiving(made._cache)


@contextmanager
def _cached_in(folder: str | None) -> Iterator[None]:
    """Let numba look for its files in this folder, too."""
    config = numba.config
    before = config.CACHE_DIR
    config.CACHE_DIR = folder or before
    try:
        yield
    finally:
        config.CACHE_DIR = before


class _Forgiving:
    """numba's store of machine code, whose faults (a full disk, a damaged file) only cost time."""

    def __init__(self, store: Any) -> None:
        self._store = store

    def __getattr__(self, name: str) -> Any:
        return getattr(self._store, name)

    def load_overload(self, *arguments: Any) -> Any:
        with suppress(Exception):  # what unpickling may raise has no end
            return self._store.load_overload(*arguments)

    def save_overload(self, *arguments: Any) -> None:
        with suppress(Exception):
            self._store.save_overload(*arguments)


@contextmanager
def vectorising() -> Iterator[None]:
    """Let what is compiled inside make vectors of neighbouring scalars: twice as fast here."""
    config = numba.config
    before = config.SLP_VECTORIZE
    config.SLP_VECTORIZE = 1
    try:
        yield
    finally:
        config.SLP_VECTORIZE = before
