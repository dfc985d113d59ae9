"""Everything that a run needs to be repeated, kept in its folder."""

from __future__ import annotations

import hashlib
import json
import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from catenary_fe.cli.folder import Folder, read_record
from catenary_fe.layout import InputError
from catenary_fe.results import Run


@dataclass(frozen=True)
class InputFiles:
    """The user's files as they were when the run began.

    layout : bytes of the layout file
    pantographs : names in the library, or bytes of files
    """

    layout: bytes
    pantographs: tuple[str | bytes, ...]

    @classmethod
    def read(cls, layout: str, pantographs: Sequence[str]) -> InputFiles:
        """Read the files named on the command line; names that are no files are the library's.

        Raises InputError for a layout that comes through a pipe, which was read already.
        """
        if not Path(layout).is_file():
            raise InputError(
                f"{layout}: a run with -o keeps its layout, which a pipe has only once; give a file"
            )
        paths = [Path(name) for name in pantographs]
        return cls(
            Path(layout).read_bytes(),
            tuple(
                path.read_bytes() if path.is_file() else name
                for path, name in zip(paths, pantographs, strict=True)
            ),
        )

    def keep(self, folder: Folder, run: Run, options: Sequence[str]) -> None:
        """Write the files, the command that repeats the run from them, and all inputs as understood.

        options : of the command, besides layout and pantographs
        """
        files, words = {"layout.toml": self.layout}, ["catenary-fe", "run", "layout.toml"]
        for number, given in enumerate(self.pantographs, start=1):
            name = f"pantograph_{number}.toml" if isinstance(given, bytes) else given
            if isinstance(given, bytes):
                files[name] = given
            words += ["--pantograph", name]
        for name, content in files.items():
            (folder.path / name).write_bytes(content)
        sums = {name: hashlib.sha256(content).hexdigest() for name, content in files.items()}
        command = shlex.join([*words, *options])
        folder.json("inputs.json", {"command": command, "files_sha256": sums} | recorded_inputs(run))


def changed_files(folder: Path) -> list[str]:
    """Names of the kept files that are not as the run found them; none where no record of them is left.

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
        "positions_m": run.data["position"].values[:, 0].tolist(),
        "catenary": json.loads(attrs["catenary"]),
        "pantographs": json.loads(attrs["pantographs"]),
        "settings": json.loads(attrs["settings"]),
        "versions": json.loads(attrs["versions"]),
        "input_sha256": attrs["input_sha256"],
    }
