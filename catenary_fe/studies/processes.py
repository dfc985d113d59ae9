"""Processes that share the work of a sweep, of this machine or of a Dask cluster, and how they end."""

from __future__ import annotations

import signal
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from catenary_fe.layout import InputError


def _leave_interrupts() -> None:
    """Ctrl-C goes to all processes of a terminal: the one that started the others ends them."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def manager_may_stumble() -> Iterator[None]:
    """Say nothing where work that is taken away at an interruption trips up the thread that hands it out.

    Nor that it is taken away.
    """
    usual = threading.excepthook

    def hook(caught: threading.ExceptHookArgs) -> None:
        if not (type(caught.thread).__name__ == "_ExecutorManagerThread" and caught.exc_type is KeyError):
            usual(caught)

    threading.excepthook = hook
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=".*tasks which were still being processed")
            yield
    finally:
        threading.excepthook = usual


def deadly(scheduler: str | None) -> tuple[type[Exception], ...]:
    """What is raised where a worker process dies."""
    from joblib.externals.loky.process_executor import TerminatedWorkerError

    if scheduler is None:
        return (TerminatedWorkerError,)
    from dask.distributed import KilledWorker

    return TerminatedWorkerError, KilledWorker


def _end_workers() -> None:
    """At once: they would go on with their cases, and hold what they inherited for minutes."""
    from joblib.externals.loky import get_reusable_executor

    get_reusable_executor(reuse=True).shutdown(wait=False, kill_workers=True)


@contextmanager
def processes_of(scheduler: str | None) -> Iterator[None]:
    """Let joblib work on this machine, or on the cluster at an address. Raises InputError without one."""
    import joblib

    if scheduler is None:
        with joblib.parallel_config("loky", initializer=_leave_interrupts):
            try:
                yield
            except (KeyboardInterrupt, GeneratorExit):
                _end_workers()
                raise
        return

    try:
        from dask.distributed import Client
    except ImportError:
        raise InputError(
            f"scheduler {scheduler}: Dask is not installed here; install catenary_fe with the extra 'cluster'"
        ) from None
    try:
        client = Client(scheduler, timeout=5)  # type: ignore[no-untyped-call]
    except (OSError, ValueError, TimeoutError) as error:
        raise InputError(f"scheduler {scheduler}: no Dask cluster answers there ({error})") from None
    with client, joblib.parallel_config("dask"):
        yield
