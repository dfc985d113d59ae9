"""The state of a long run on disk, from which it goes on with the same result."""

from __future__ import annotations

import json
import tempfile
import time as clock
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import InputError
from catenary_fe.results.files import atomic_write, cannot_be_written

INTERVAL = 30.0  # [s] of work between two states on disk
_KEY = "key"


class Checkpoint:
    """A file that keeps the state of one run.

    path : of the file, written whole or not at all
    key : tells this run from others
    carried : arrays to be kept along with the run's own
    kept : arrays that were found in the file, or None

    Raises InputError for a file that is damaged, is something else, belongs to another run, or has no place.
    """

    def __init__(self, path: str | Path, key: dict[str, Any]) -> None:
        self._path, self._key = Path(path), json.dumps(key, sort_keys=True)
        self._saved = clock.monotonic()
        self.carried: dict[str, NDArray[Any]] = {}
        self.kept = self._load() if self._path.exists() else None
        self._check_place()

    def _load(self) -> dict[str, NDArray[Any]]:
        try:
            with np.load(self._path, allow_pickle=False) as file:
                arrays = dict(file)
            key = str(arrays.pop(_KEY))
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
            raise InputError(
                f"{self._path}: not a whole checkpoint: remove it to begin the run anew, or name another file"
            ) from None
        if key != self._key:
            raise InputError(
                f"{self._path}: checkpoint of another run ({_difference(key, self._key)}): remove it to begin"
                " anew, name another file, or give that run's inputs"
            )
        return arrays

    def _check_place(self) -> None:
        """Better now than after half a minute of work."""
        try:
            tempfile.TemporaryFile(dir=self._path.parent).close()
        except OSError as error:
            raise InputError(f"checkpoint {cannot_be_written(self._path, error)}") from None

    def save_when_due(self, arrays: Callable[[], Mapping[str, NDArray[Any]]]) -> None:
        """Write arrays if the last ones are ``INTERVAL`` old.

        Raises InputError if the file cannot be written.
        """
        if clock.monotonic() - self._saved >= INTERVAL:
            everything: dict[str, Any] = {_KEY: np.array(self._key), **self.carried, **arrays()}
            with atomic_write(self._path) as aside, aside.open("wb") as file:
                np.savez(file, **everything)
            self._saved = clock.monotonic()

    def begin(self, carried: dict[str, NDArray[Any]]) -> None:
        """Begin a run anew, with arrays to be kept along with its own."""
        self.carried, self.kept = carried, None

    def remove(self) -> None:
        """The run is over."""
        self._path.unlink(missing_ok=True)


def _difference(theirs: str, ours: str) -> str:
    """Names of what differs."""
    try:
        first, second = json.loads(theirs), json.loads(ours)
        names = sorted(name for name in {*first, *second} if first.get(name) != second.get(name))
    except (ValueError, AttributeError):
        names = []
    return "other " + ", ".join(names) if names else "unknown"
