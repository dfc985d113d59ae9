"""Output folders: checked before the work, filled after it, whole or not at all."""

from __future__ import annotations

import csv
import json
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from catenary_fe.system import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from catenary_fe.results import Run


class Folder:
    """Files written aside, to be moved into place together."""

    def __init__(self, aside: Path) -> None:
        self.path = aside

    def json(self, name: str, value: Any) -> None:
        """Write a JSON file."""
        text = json.dumps(value, indent=2, allow_nan=False, ensure_ascii=False)
        (self.path / name).write_text(text + "\n", encoding="utf-8")

    def table(self, name: str, rows: Sequence[Mapping[str, Any]]) -> None:
        """Write rows as CSV; the first row names the columns."""
        with (self.path / name).open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, fieldnames=list(rows[0]) if rows else [])
            writer.writeheader()
            writer.writerows(rows)

    def text(self, name: str, text: str) -> None:
        """Write a text file."""
        (self.path / name).write_text(text, encoding="utf-8")

    def picture(self, name: str, ax: Axes) -> None:
        """Write a picture as PNG."""
        save_picture(self.path / name, ax)


def save_picture(path: Path, ax: Axes) -> None:
    """Write a picture in the format of the file's ending. Raises InputError where that cannot be."""
    figure = ax.get_figure(root=True)
    assert figure is not None
    try:
        metadata = {"Software": None} if path.suffix == ".png" else None
        figure.savefig(path, dpi=130, metadata=metadata)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None
    except ValueError as error:  # an unknown format
        raise InputError(f"{path}: {str(error).splitlines()[0]}") from None


@contextmanager
def output_folder(path: str | None) -> Iterator[Folder | None]:
    """Make sure that the folder can be written before the work starts; move the files there after it.

    Raises InputError if the folder cannot be written. If the work fails, nothing is left behind.
    """
    if path is None:
        yield None
        return
    target = _named(path)
    made = _first_missing(target)
    try:
        target.mkdir(parents=True, exist_ok=True)
        aside = Path(tempfile.mkdtemp(prefix=".part-", dir=target))
    except OSError as error:
        _remove(made)
        reason = error.strerror or str(error)
        raise InputError(
            f"output folder {path}: cannot be written ({reason}); choose another folder"
        ) from None
    try:
        yield Folder(aside)
        for file in sorted(aside.iterdir()):
            os.replace(file, target / file.name)
    except OSError as error:
        _remove(aside)
        _remove(made)
        raise InputError(f"output folder {path}: {error.strerror or error}") from None
    except BaseException:
        _remove(aside)
        _remove(made)
        raise
    aside.rmdir()


def writable_folder(path: str) -> Path:
    """Make a folder whose files are replaced one by one, before the work. Raises InputError if it cannot."""
    folder = _named(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(
            f"output folder {path}: cannot be written ({reason}); choose another folder"
        ) from None
    return folder


def _named(path: str) -> Path:
    if not path.strip():
        raise InputError("output folder '': has no name; give one, or '.' for the folder you are in")
    return Path(path)


def run_in(path: str | Path) -> Run:
    """The run in a folder that ``catenary-fe run -o`` wrote, or in a file of it. Raises InputError."""
    from catenary_fe.results import load_run

    path = Path(path)
    if path.is_dir() and not (path / "run.nc").is_file():
        raise InputError(f"{path}: holds no run.nc; give a folder that 'catenary-fe run ... -o DIR' wrote")
    return load_run(path / "run.nc" if path.is_dir() else path)


def _first_missing(path: Path) -> Path | None:
    """The outermost folder that will have to be made, or None if the whole path exists."""
    missing = [p for p in (path, *path.parents) if not p.exists()]
    return missing[-1] if missing else None


def _remove(path: Path | None) -> None:
    if path is not None:
        shutil.rmtree(path, ignore_errors=True)
