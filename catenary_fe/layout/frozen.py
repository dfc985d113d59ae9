"""Objects that are never changed in place, and say how to make a changed copy."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import fields
from typing import Any, NoReturn, TypeVar

from catenary_fe.layout.errors import InputError

_Class = TypeVar("_Class", bound=type)


def refuse_change(owner: object, name: str, known: Iterable[str], copy: str) -> NoReturn:
    """Raises InputError for an assignment to an attribute.

    copy : how to make a changed copy
    """
    kind, known = type(owner).__name__, list(known)
    if name in known:
        raise InputError(f"{kind}.{name} cannot be changed in place; make a changed copy with {copy}")
    if hasattr(type(owner), name):
        raise InputError(f"{kind}.{name} follows from the fields, and cannot be set; change those in a copy")
    near = difflib.get_close_matches(name, known, n=1)
    hint = f"did you mean '{near[0]}'?" if near else f"it has {', '.join(known)}"
    raise InputError(f"{kind} has no '{name}', and cannot be changed in place; {hint}")


def changed_by_copy(cls: _Class) -> _Class:
    """For a frozen dataclass: its refusal of a change is an :class:`InputError` with the remedy."""

    def refuse(self: Any, name: str, _: object = None) -> NoReturn:
        copy = f"dataclasses.replace(..., {name}=...)"
        refuse_change(self, name, (field.name for field in fields(self)), copy)

    made: Any = cls
    made.__setattr__ = made.__delattr__ = refuse
    return cls
