"""Files that are whole or not there, folders with one writer at a time, checksums of what is stored."""

from __future__ import annotations

import hashlib
import json
import os
import socket
import stat
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from errno import EACCES, EAGAIN, EDEADLK, EDQUOT, EFBIG, EISDIR, ENOSPC
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from catenary_fe.layout import InputError

if TYPE_CHECKING:
    import xarray as xr

ASIDE = ".part-"  # begins the names of what is not whole yet
LOCK = ".lock"
ATTRIBUTE = "content_sha256"  # where a stored dataset keeps its checksum
STRAY = "backslashreplace"  # for what is no text in a file's name, which a text may hold: JSON's own escapes
_FULL = ENOSPC, EDQUOT, EFBIG
_TAKEN = EACCES, EAGAIN, EDEADLK
_BEHIND = 1 << 30  # place of the locked byte, beyond the text: Windows lets nobody read a locked byte


@contextmanager
def atomic_write(path: str | Path) -> Iterator[Path]:
    """A name beside ``path`` to write a file under; the file is moved to ``path`` when it is whole.

    Where it does not get that far, what stood at ``path`` before stays. Raises InputError for a path that
    cannot be written.
    """
    path = Path(path)
    if not path.name:
        raise InputError(f"{str(path)!r}: no file can have this name; check it")
    aside = path.with_name(f"{ASIDE}{os.getpid()}-{path.name}")
    try:
        yield aside
        settle(aside)
        os.replace(aside, path)
    except OSError as error:
        raise InputError(cannot_be_written(path, error)) from None
    finally:
        with suppress(OSError):
            aside.unlink(missing_ok=True)


def write_text(path: str | Path, text: str) -> None:
    """Write a whole file or none. Raises InputError for a path that cannot be written."""
    with atomic_write(path) as aside:
        aside.write_text(text, encoding="utf-8", errors=STRAY)


def replace_all(source: Path, target: Path) -> None:
    """Move all files of a folder into another one on the same disk, over what is there.

    Raises OSError before the first one is moved where it can be known that one of them cannot be.
    """
    files = sorted(file for file in source.iterdir() if not file.name.startswith(ASIDE))
    for file in files:
        if (target / file.name).is_dir():
            raise OSError(EISDIR, f"{file.name} there is a folder")
        settle(file)
    for file in files:
        os.replace(file, target / file.name)


def settle(file: Path) -> None:
    """Flush a file to the disk, so that it is whole even after a power cut."""
    with file.open("rb+") as opened:
        os.fsync(opened.fileno())


def own_temporary_folder() -> str | None:
    """A temporary folder that only this user can write to, or None where there is none.

    Others may make what has its name before us: a folder that is not ours alone is not taken.
    """
    number = 0 if sys.platform == "win32" else os.getuid()  # there, temporary files are the user's own
    try:
        path = os.path.join(tempfile.gettempdir(), f"catenary_fe-{number}")
        with suppress(FileExistsError):
            os.mkdir(path, 0o700)
        found = os.lstat(path)
    except OSError:
        return None
    alone = sys.platform == "win32" or (found.st_uid == number and not found.st_mode & 0o022)
    return path if alone and stat.S_ISDIR(found.st_mode) else None


def cannot_be_written(path: str | Path, error: OSError) -> str:
    """One line on what went wrong, with its remedy."""
    remedy = "free some space there, or " if error.errno in _FULL else ""
    return f"{path}: cannot be written: {error.strerror or error}; {remedy}choose another folder"


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep other processes from writing into an existing folder meanwhile.

    The lock is the system's own: it ends with its process, however that ends. On file systems without
    locks there is none. Raises InputError, with the other's process number, where the folder is taken.
    """
    path = folder / LOCK
    try:
        descriptor = _take(path)
    except OSError as error:
        raise InputError(cannot_be_written(path, error)) from None
    if descriptor is None:
        raise InputError(
            f"{folder}: {_owner(path)} is writing there; wait until it has ended, or choose another folder"
        )
    try:
        os.ftruncate(descriptor, 0)
        os.write(descriptor, f"{os.getpid()} {socket.gethostname()}\n".encode())
    except OSError as error:
        _leave(path, descriptor)
        raise InputError(cannot_be_written(path, error)) from None
    try:
        yield
    finally:
        _leave(path, descriptor)


def _take(path: Path) -> int | None:
    """Descriptor of the locked file, or None where another process holds it."""
    while True:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
        try:
            _lock(descriptor)
        except OSError as error:
            if error.errno in _TAKEN:
                os.close(descriptor)
                return None
        with suppress(FileNotFoundError):
            if os.path.samestat(os.fstat(descriptor), path.stat()):
                return descriptor
        os.close(descriptor)  # its last owner has just removed it: once more


def _lock(descriptor: int) -> None:
    if sys.platform == "win32":
        import msvcrt

        os.lseek(descriptor, _BEHIND, os.SEEK_SET)
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        os.lseek(descriptor, 0, os.SEEK_SET)
    else:
        import fcntl

        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _leave(path: Path, descriptor: int) -> None:
    with suppress(OSError):  # an open file cannot be removed everywhere; an unlocked one does no harm
        path.unlink()
    os.close(descriptor)


def _owner(path: Path) -> str:
    try:
        number, machine = path.read_text(encoding="utf-8").split()
    except (OSError, ValueError):
        return "another process"
    return f"process {number}" + (f" on {machine}" if machine != socket.gethostname() else "")


def checksum(data: xr.Dataset) -> str:
    """SHA-256 of all values, names, dimensions and attributes, but for one that holds a checksum."""
    found = hashlib.sha256()
    for name in sorted(map(str, data.variables)):
        variable = data[name]
        found.update(repr((name, variable.dims, variable.shape)).encode())
        found.update(_attributes(variable.attrs))
        values = np.asarray(variable.values)
        if values.dtype.kind == "f":
            found.update(np.ascontiguousarray(values, dtype=f"<f{values.dtype.itemsize}").data)
        elif values.dtype.kind in "iu":  # netCDF's classic format has widths of its own
            found.update(np.ascontiguousarray(values, dtype="<i8").data)
        else:
            found.update(json.dumps([str(v) for v in values.ravel()]).encode())
    found.update(_attributes({k: v for k, v in data.attrs.items() if k != ATTRIBUTE}))
    return found.hexdigest()


def _attributes(attributes: Mapping[Any, Any]) -> bytes:
    texts = {str(k): v if isinstance(v, str) else repr(np.asarray(v).tolist()) for k, v in attributes.items()}
    return json.dumps(texts, sort_keys=True).encode()
