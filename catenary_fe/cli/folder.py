"""Folders of results: checked before the work, filled after it, whole or not at all; what repeats a run."""

from __future__ import annotations

import hashlib
import json
import os
import re
import shlex
import shutil
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import InputError
from catenary_fe.layout.conditions import conditions_text
from catenary_fe.layout.files import layout_bytes
from catenary_fe.layout.receptance import receptance_table_of
from catenary_fe.layout.toml import read_toml
from catenary_fe.results.export import write_csv
from catenary_fe.results.files import ASIDE, STRAY, atomic_write, cannot_be_written, locked, replace_all

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from catenary_fe.results import Run


PARTIAL = "partial"  # folder inside an output folder, for what there is of a run that was stopped


class Folder:
    """Files written aside, to be moved into place together.

    path : where to write them
    kept : whether files were moved into place already
    """

    def __init__(self, aside: Path) -> None:
        self.path = aside
        self.kept = False

    def keep(self) -> None:
        """Move what is written so far into place, so that a later failure does not remove it."""
        replace_all(self.path, self.path.parent)
        self.kept = True

    def forget(self, *patterns: str) -> None:
        """Remove files that earlier commands derived from results which have been replaced."""
        for file in [file for pattern in patterns for file in self.path.parent.glob(pattern)]:
            file.unlink(missing_ok=True)

    def json(self, name: str, value: Any) -> None:
        """Write a JSON file."""
        text = json.dumps(value, indent=2, allow_nan=False, ensure_ascii=False)
        (self.path / name).write_text(text + "\n", encoding="utf-8", errors=STRAY)

    def table(self, name: str, rows: Sequence[Mapping[str, Any]], columns: Sequence[str] = ()) -> None:
        """Write rows as CSV, with the digits that the columns' units are worth.

        columns : their names; unset: the first row's
        """
        columns = columns or list(rows[0] if rows else [])
        write_csv(self.path / name, columns, ([row[column] for column in columns] for row in rows))

    def text(self, name: str, text: str) -> None:
        """Write a text file."""
        (self.path / name).write_text(text, encoding="utf-8", errors=STRAY)

    def picture(self, name: str, ax: Axes) -> None:
        """Write a picture as PNG."""
        save_picture(self.path / name, ax)


def save_picture(path: Path, picture: Axes | NDArray[np.uint8]) -> None:
    """Write axes, or pixels of shape (height, width, 3), in the format of the file's ending.

    Raises InputError where that cannot be.
    """
    try:
        with atomic_write(path) as aside:
            if isinstance(picture, np.ndarray):
                from PIL import Image

                Image.fromarray(picture).save(aside)
            else:
                figure = picture.get_figure(root=True)
                assert figure is not None
                figure.savefig(aside, dpi=130, metadata={"Software": None} if path.suffix == ".png" else None)
    except InputError:
        raise
    except ValueError as error:  # an unknown format
        raise InputError(f"{path}: {str(error).splitlines()[0]}") from None


@contextmanager
def output_folder(path: str | None) -> Iterator[Folder | None]:
    """Make sure that the folder can be written before the work starts; move the files there after it.

    Meanwhile no other process writes there. Raises InputError if the folder cannot be written or is taken. If
    the work fails, nothing is left behind but what was kept before.
    """
    if path is None:
        yield None
        return
    target = _named(path)
    missing = [p for p in (target, *target.parents) if not p.exists()]
    folder = None
    try:
        target.mkdir(parents=True, exist_ok=True)
        with locked(target):
            for remains in target.glob(f"{ASIDE}*"):  # of processes that were killed
                _remove(remains)
            folder = Folder(Path(tempfile.mkdtemp(prefix=ASIDE, dir=target)))
            try:
                yield folder
                folder.keep()
            finally:
                _remove(folder.path)
    except OSError as error:
        raise InputError(f"output folder {cannot_be_written(path, error)}") from None
    finally:
        if folder is None or not folder.kept:
            _unmake(missing)


def writable_folder(path: str) -> Path:
    """Make a folder whose files are replaced one by one, before the work. Raises InputError if it cannot."""
    folder = _named(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        raise InputError(f"output folder {cannot_be_written(path, error)}") from None
    return folder


def _named(path: str) -> Path:
    if not path.strip():
        raise InputError("output folder '': has no name; give one, or '.' for the folder you are in")
    return Path(path)


def folder_of(path: str | Path) -> Path:
    """A run's folder, or that of a file in it."""
    return Path(path) if Path(path).is_dir() else Path(path).parent


def run_in(path: str | Path) -> Run:
    """The run in a folder that ``catenary-fe run -o`` wrote, or in a file of it. Raises InputError."""
    from catenary_fe.results import load_run

    path = Path(path)
    if path.is_dir() and not (path / "run.nc").is_file():
        if (path / PARTIAL / "run.nc").is_file():
            raise InputError(
                f"{path}: holds no whole run; what there is of one that was stopped is in {path / PARTIAL}:"
                " give that folder"
            )
        raise InputError(f"{path}: holds no run.nc; give a folder that 'catenary-fe run ... -o DIR' wrote")
    return load_run(path / "run.nc" if path.is_dir() else path)


def read_record(path: Path) -> dict[str, Any]:
    """What a command wrote into a run's folder as JSON; empty where that is not there any more.

    Raises InputError where it is damaged.
    """
    try:
        found = json.loads(path.read_text(encoding="utf-8-sig"))  # editors may put a mark before it
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"{path}: damaged: not JSON ({str(error).splitlines()[0]}); take a copy, or remove it to go on"
            " without"
        ) from None
    if not isinstance(found, dict):
        raise InputError(f"{path}: damaged: not a JSON object; take a copy, or remove it to go on without")
    return found


def keep_file(source: str | Path, target: Path) -> None:
    """A file under a second name, on the same disk without a copy of its content."""
    with suppress(OSError):
        os.link(source, target)
    if not target.exists():
        shutil.copyfile(source, target)


def _unmake(folders: Sequence[Path]) -> None:
    """Remove folders that were created in vain, innermost first, unless something is in them."""
    with suppress(OSError):
        for folder in folders:
            folder.rmdir()


def _remove(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)


@dataclass(frozen=True)
class InputFiles:
    """The user's files as they were when the run began.

    layout : bytes of the layout file
    pantographs : names in the library, or bytes of files
    tables : of each pantograph, bytes of the table of receptances that its file names, if it does
    conditions : bytes of their file, if there is one
    """

    layout: bytes
    pantographs: tuple[str | bytes, ...]
    tables: tuple[bytes | None, ...] = ()
    conditions: bytes | None = None

    @classmethod
    def read(cls, layout: str, pantographs: Sequence[str], conditions: str | None = None) -> InputFiles:
        """Read the files named on the command line; names that are no files are the library's.

        Raises InputError for a layout that comes through a pipe, which was read already.
        """
        if not Path(layout).is_file():
            raise InputError(
                f"{layout}: a run with -o keeps its layout, which a pipe has only once; give a file"
            )
        found = [_pantograph_file(number, name) for number, name in enumerate(pantographs, start=1)]
        return cls(
            layout_bytes(layout),
            tuple(file for file, _ in found),
            tuple(table for _, table in found),
            conditions_text(conditions) if conditions else None,
        )

    def keep(self, folder: Folder, run: Run, options: Sequence[str]) -> None:
        """Write the files, the command that repeats the run from them, and all inputs as interpreted.

        options : of the command, besides layout and pantographs
        """
        words, sums = self.write(folder.path)
        command = shlex.join(["catenary-fe", "run", *words, *options])
        folder.json("inputs.json", {"command": command, "files_sha256": sums} | recorded_inputs(run))

    def write(self, folder: Path) -> tuple[list[str], dict[str, str]]:
        """Write the files; what a command in their folder is told of them, and checksums by name."""
        files, words = {"layout.toml": self.layout}, ["layout.toml"]
        for number, table in enumerate(self.tables, start=1):
            if table is not None:
                files[_table_name(number)] = table
        for number, given in enumerate(self.pantographs, start=1):
            name = f"pantograph_{number}.toml" if isinstance(given, bytes) else given
            if isinstance(given, bytes):
                files[name] = given
            words += ["--pantograph", name]
        if self.conditions is not None:
            files["conditions.toml"] = self.conditions
            words += ["--conditions", "conditions.toml"]
        for name, content in files.items():
            (folder / name).write_bytes(content)
        return words, {name: hashlib.sha256(content).hexdigest() for name, content in files.items()}


def _table_name(number: int) -> str:
    return f"pantograph_{number}_receptance.csv"


def _pantograph_file(number: int, name: str) -> tuple[str | bytes, bytes | None]:
    """A name of the library, or a file's bytes; and those of the table that it names, by the kept name."""
    path = Path(name)
    if not path.is_file():
        return name, None
    text = path.read_bytes()
    table = receptance_table_of(path, read_toml(path, "pantograph"))
    if table is None:
        return text, None
    named = re.compile(rb"^(\s*receptance\s*=\s*)([\"'])" + re.escape(table.name.encode()) + rb"\2", re.M)
    kept, count = named.subn(rf'\g<1>"{_table_name(number)}"'.encode(), text)
    if count != 1:
        raise InputError(f'{path}: receptance: write it on a line of its own, receptance = "{table.name}"')
    return kept, table.read_bytes()


def changed_files(folder: Path) -> list[str]:
    """Names of the kept files that are not as the run found them; none without a record of them.

    Raises InputError where the record is damaged.
    """
    sums = read_record(folder / "inputs.json").get("files_sha256", {})
    if not isinstance(sums, dict):
        raise InputError(
            f"{folder / 'inputs.json'}: damaged: files_sha256 is no table; take a copy, or remove it to go on"
            " without"
        )
    return [
        name
        for name, before in sums.items()
        if (folder / name).is_file() and hashlib.sha256((folder / name).read_bytes()).hexdigest() != before
    ]


def recorded_inputs(run: Run) -> dict[str, Any]:
    """What a run was computed from, library values filled in, ready for JSON."""
    attrs = run.data.attrs
    return {
        "speed_kmh": round(3.6 * run.speed, 9),
        "method": run.method,
        "conditions": json.loads(attrs["conditions"]) if "conditions" in attrs else None,
        "positions_m": run.data["position"].values[:, 0].tolist(),
        "catenary": json.loads(attrs["catenary"]),
        "pantographs": json.loads(attrs["pantographs"]),
        "settings": json.loads(attrs["settings"]),
        "versions": json.loads(attrs["versions"]),
        "input_sha256": attrs["input_sha256"],
    }
