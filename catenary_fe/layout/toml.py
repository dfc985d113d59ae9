"""TOML files as people of all countries and editors write them; what they slip on is named."""

from __future__ import annotations

import codecs
import json
import re
import tomllib
from pathlib import Path
from typing import Any

from catenary_fe.layout.errors import InputError

LARGEST_FILE = 4 * 2**20  # [bytes] a thousand mistuned spans stay below 1 MiB

_STRINGS = re.compile(r'"(?:[^"\\]|\\.)*"' + r"|'[^']*'|#.*")
_SLIPS = (
    (re.compile("[“”„‟«»‘’‚‛″′`]"), "typographic quote {0} ({1})", 'write " in its place'),
    (
        re.compile("[\u00a0\u1680\u2000-\u200b\u202f\u205f\u2060\u3000\ufeff]"),
        "no-break or other special blank ({1})",
        "write an ordinary one, or none",
    ),
    (re.compile("[‐‑‒–—−]"), "dash {0} ({1})", "write an ordinary hyphen in its place"),
)
_COMMA = re.compile(r"=\s*([+-]?\d[\d.]*),(\d+)")
_GAP = re.compile(r"=\s*([+-]?\d+(?: \d{3})+)\b")


def read_toml(path: Path, kind: str) -> dict[str, Any]:
    """A TOML file in UTF-8, with or without a byte order mark.

    kind : of file, as an error calls it

    Raises InputError where it cannot be read or is none, with the line and, where it is known, the slip.
    """
    text = read_text(path, kind)
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise InputError(f"{path}: not a TOML file: lists or tables too deep inside one another") from None
    except ValueError as error:  # of TOML, and of whole numbers of thousands of digits
        slip = _slip(text, str(error))
        raise InputError(f"{path}: {slip}" if slip else f"{path}: not a TOML file: {error}") from None


def read_text(path: Path, kind: str, most: int = LARGEST_FILE) -> str:
    """The text of a file in UTF-8, with or without a byte order mark.

    kind : of file, as an error calls it
    most : [bytes] that it may have

    Raises InputError where it cannot be read or is none, with the line.
    """
    content = read_bytes(path, kind, most)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: {_wrong_encoding(content, error)}") from None


def _wrong_encoding(content: bytes, error: UnicodeDecodeError) -> str:
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "a text in UTF-16 ('Unicode' in some editors), not in UTF-8; save it as UTF-8"
    line = content[: error.start].count(b"\n") + 1
    return f"not a text in UTF-8 (line {line}, byte {error.start}); save it as UTF-8"


def _slip(text: str, complaint: str) -> str | None:
    """What is wrong with the line that a TOML reader complains of, where it is one of the usual slips."""
    place, lines = re.search(r"at line (\d+)", complaint), text.split("\n")
    number = int(place[1]) if place else len(lines)
    line = _STRINGS.sub(lambda found: " " * len(found[0]), lines[number - 1])
    for pattern, name, remedy in _SLIPS:
        if found := pattern.search(line):
            named = name.format(found[0], f"U+{ord(found[0]):04X}")
            return f"line {number}, column {found.start() + 1}: {named}: {remedy}"
    if comma := _COMMA.search(line):
        whole, rest = comma.groups()
        return (
            f"line {number}: {whole},{rest} is a number with a comma: write a point before decimals"
            f" ({whole}.{rest}), and nothing between thousands ({whole}{rest})"
        )
    if gap := _GAP.search(line):
        return f"line {number}: {gap[1]} is a number with blanks: write {gap[1].replace(' ', '')}"
    return None


def read_bytes(path: Path, kind: str, most: int = LARGEST_FILE) -> bytes:
    """A file's content.

    kind : of file, as an error calls it
    most : [bytes] that it may have

    Raises InputError where it cannot be read, or is larger.
    """
    try:
        with path.open("rb") as file:
            content = file.read(most + 1)  # devices and pipes have no size, nor need they end
    except FileNotFoundError:
        raise InputError(f"{path}: no such {kind} file; check the name and the folder") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError:
        raise InputError(f"{str(path)!r}: no file can have this name; check it") from None
    if len(content) > most:
        raise InputError(f"{path}: larger than {most:,} bytes: that is not a {kind} file")
    return content


def toml_value(value: Any) -> str:
    """A value as TOML writes it, tables and lists in one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {toml_value(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, bool | int):
        return str(value).lower()
    return (
        json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
        if isinstance(value, str)
        else (repr(float(value)))
    )
