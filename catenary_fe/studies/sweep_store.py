"""Records of a sweep's finished cases, one file each: whole, or not there."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from catenary_fe.layout import InputError
from catenary_fe.results.files import ASIDE, atomic_write, cannot_be_written, locked, write_text

Record = dict[str, Any]
_SUM = "sha256"


class Store:
    """A folder of records by key. A record that is damaged is not there."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def read(self, key: str) -> Record | None:
        """The record of a key, or None where none is there, or no whole one."""
        try:
            record: Record = json.loads(self._path(key).read_text(encoding="utf-8"))
            stored = record.pop(_SUM)
        except (OSError, ValueError, AttributeError, KeyError, TypeError):
            return None
        return record if stored == _checksum(record) else None

    def write(self, key: str, record: Record, run: bytes | None = None) -> None:
        """Keep a record, and the file of its run. Raises InputError where they cannot be written."""
        if run is not None:
            with atomic_write(self.run(key)) as aside:
                aside.write_bytes(run)
        text = json.dumps(record | {_SUM: _checksum(record)}, allow_nan=False, indent=1)
        write_text(self._path(key), text)

    def run(self, key: str) -> Path:
        """Where the file of a case's run is, if it was kept."""
        return self._folder / f"{key}.nc"

    def _path(self, key: str) -> Path:
        return self._folder / f"{key}.json"


@contextmanager
def open_store(folder: Path) -> Iterator[Store]:
    """Make the folder and keep other processes out of it. Raises InputError where that cannot be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(cannot_be_written(folder, error)) from None
    with locked(folder):
        for remains in folder.glob(f"{ASIDE}*"):  # of processes that were killed
            remains.unlink(missing_ok=True)
        yield Store(folder)


def _checksum(record: Record) -> str:
    return hashlib.sha256(json.dumps(record, sort_keys=True).encode()).hexdigest()
