"""The environment of a command: streams of limited encodings, home directories that cannot be written."""

from __future__ import annotations

import codecs
import io
import os
import sys
import unicodedata
from pathlib import Path

from catenary_fe.results.files import own_temporary_folder

SPELT = "catenary_fe.spelt"  # name of the error handler
_SIMILAR = str.maketrans(
    {"–": "-", "—": "-", "−": "-", "━": "-", "·": ".", "×": "x", "⁄": "/", "½": "1/2", "±": "+-", "≤": "<=",
     "≥": ">=", "→": "->", "√": "sqrt ", "“": '"', "”": '"', "„": '"', "‘": "'", "’": "'", "°": " deg",
     "ß": "ss"}
)  # fmt: skip


def prepare() -> None:
    """Keep limited encodings and unwritable home directories from ending the program."""
    codecs.register_error(SPELT, _spelt)
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:  # closed by the parent process
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115
        elif isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=SPELT)
    os.environ.pop("MPLBACKEND", None)  # no picture needs one; matplotlib refuses unknown ones
    os.environ["MATPLOTLIBRC"] = os.devnull  # pictures are the same whoever draws them
    folder = None if "MPLCONFIGDIR" in os.environ or _matplotlib_has_a_place() else own_temporary_folder()
    if folder:
        os.environ["MPLCONFIGDIR"] = os.path.join(folder, "matplotlib")


def leave() -> None:
    """Let Python end with the command's exit code, even where its last output cannot be written."""
    for name in ("stdout", "stderr"):
        try:
            getattr(sys, name).flush()
        except (OSError, ValueError):
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115


def writes_unicode(stream: object) -> bool:
    """Whether a stream can write every character."""
    encoding = getattr(stream, "encoding", None) or "ascii"
    return codecs.lookup(encoding).name.startswith("utf")


def readable(name: str) -> str:
    """A file's name as text, without the surrogates that stand for undecodable bytes."""
    try:
        return name.encode("utf-8", "surrogateescape").decode("utf-8", "replace")
    except UnicodeEncodeError:
        return name.encode("ascii", "replace").decode()


def _spelt(error: UnicodeError) -> tuple[str, int]:
    """Replace characters that the stream's encoding lacks by ASCII ones."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(_spelling, readable(error.object[error.start : error.end]))), error.end


def _spelling(character: str) -> str:
    """``2`` for ``²``, ``sigma`` for ``σ``, ``L`` for ``Ł``, or a question mark."""
    parts = unicodedata.normalize("NFKD", character.translate(_SIMILAR))
    return "".join(map(_ascii, parts)) or "?"


def _ascii(character: str) -> str:
    if character.isascii() or unicodedata.combining(character):
        return character if character.isascii() else ""
    kind, _, letter = unicodedata.name(character, "").partition(" LETTER ")
    if not (letter and kind.startswith(("LATIN", "GREEK"))):
        return "?"
    word = letter.split(" WITH ")[0]
    return word if "CAPITAL" in kind and len(word) == 1 else word.lower()


def _matplotlib_has_a_place() -> bool:
    """Whether matplotlib can make the folders in which it keeps fonts and looks for settings."""
    if not sys.platform.startswith(("linux", "freebsd")):
        return True
    homes = (("XDG_CONFIG_HOME", "~/.config"), ("XDG_CACHE_HOME", "~/.cache"))
    return all(_can_be_made(os.environ.get(name) or os.path.expanduser(usual)) for name, usual in homes)


def _can_be_made(folder: str) -> bool:
    path = Path(folder)
    there = next((p for p in (path, *path.parents) if os.path.exists(p)), path)
    return os.path.isdir(there) and os.access(there, os.W_OK)
