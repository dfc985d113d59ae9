"""Base of all parameter objects: frozen, keyword-only, checked, with errors an engineer can read."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, Annotated, Any, NoReturn, Self, TypeVar, cast

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError
from pydantic_core import ErrorDetails

from catenary_fe.layout.errors import InputError

GRAVITY = 9.81  # [m/s²]
LARGEST = 1e15  # in SI units: beyond it, and below its inverse, products of some leave the range of floats
SMALLEST = 1 / LARGEST
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


def _not_tiny(value: float) -> float:
    if value < SMALLEST:
        raise ValueError(f"{value!r} is below {SMALLEST:g}; look for a wrong unit")
    return value


Number = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-LARGEST, le=LARGEST)]
Positive = Annotated[
    float, Field(strict=True, allow_inf_nan=False, gt=0, le=LARGEST), AfterValidator(_not_tiny)
]
Lateral = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-10, le=10)]  # [m]; refuses mm
Temperature = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-100, le=150)]  # [°C]; refuses K
NonNegative = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=LARGEST)]
Share = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=1)]
Text = Annotated[str, Field(strict=True)]


class FaultsError(ValueError):
    """FaultsError of one field, found together; each line says itself what it is about."""

    def __init__(self, lines: Sequence[str]) -> None:
        self.lines = tuple(lines)
        super().__init__("\n".join(lines))


def refuse(faults: Sequence[str]) -> None:
    """Raises :class:`FaultsError` if there are any."""
    if faults:
        raise FaultsError(faults)


def _not_empty(items: tuple[Any, ...]) -> tuple[Any, ...]:
    if not items:
        raise ValueError("is empty; at least one is needed")
    return items


# pydantic's own min_length would report "too short" beside each fault of an item
NonEmpty = AfterValidator(_not_empty)


if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)


class _ReadableErrors(ModelMetaclass):
    """Catches pydantic's report where an object is made by hand; nested ones keep their place in it."""

    def __call__(cls, *args: Any, **data: Any) -> Any:  # noqa: N805 a metaclass
        model = cast(type[BaseModel], cls)
        if args:
            names = ", ".join(f"{name}=..." for name in list(model.model_fields)[:2])
            raise InputError(f"{cls.__name__}({shorten(args[0])}): give its values by name: {names}")
        try:
            return super().__call__(**data)
        except ValidationError as error:
            raise InputError(*problem_lines(error, model)) from None


class Parameters(BaseModel, metaclass=_ReadableErrors):
    """Base of what an engineer writes down. Raises :class:`InputError` with one line for each fault."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    def __eq__(self, other: object) -> bool:
        """By fields alone: pydantic's own looks at cached arrays too, and fails on them."""
        if type(self) is not type(other):
            return NotImplemented
        return all(getattr(self, name) == getattr(other, name) for name in type(self).model_fields)

    def __setattr__(self, name: str, value: object) -> None:
        """Raises InputError: :meth:`replace` makes a changed copy."""
        refuse_change(self, name, type(self).model_fields, f".replace({name}=...)")

    def __delattr__(self, name: str) -> None:
        """Raises InputError: :meth:`replace` makes a changed copy."""
        refuse_change(self, name, type(self).model_fields, f".replace({name}=...)")

    def replace(self, **changes: Any) -> Self:
        """A copy with some fields changed, checked like a new object."""
        fields = {name: getattr(self, name) for name in type(self).model_fields}
        return type(self)(**(fields | changes))


def problem_lines(error: ValidationError, model: type[BaseModel], where: str = "") -> list[str]:
    """Turn pydantic's report into lines of: place, value, rule, remedy."""
    details = error.errors(include_url=False)
    lines = [line for detail in details for line in _detail_lines(detail, model)]
    return [f"{where}: {line}" if where else line for line in dict.fromkeys(lines)]


def _detail_lines(detail: ErrorDetails, model: type[BaseModel]) -> list[str]:
    cause = detail.get("ctx", {}).get("error")
    if not isinstance(cause, FaultsError):
        return [_problem_line(detail, model)]
    inside = detail["loc"][:-1] if detail["loc"] and isinstance(detail["loc"][-1], str) else detail["loc"]
    place = _place(_user_path(inside, model))
    return [f"{place}: {line}" if place else line for line in cause.lines]


def _problem_line(detail: ErrorDetails, model: type[BaseModel]) -> str:
    path = _user_path(detail["loc"], model)
    place, kind, value = _place(path), detail["type"], detail["input"]
    hint = _description(path, model)
    if kind == "missing":
        return f"{place} is missing; add it: {hint}" if hint else f"{place} is missing; add it"
    if kind == "extra_forbidden":
        return f"unknown key {place}; {_suggest(path, model)}"
    if kind == "value_error":
        text = str(detail["ctx"]["error"])
        return f"{place}: {text}" if place else text
    if kind in ("model_type", "dict_type", "model_attributes_type"):
        return f"{place} = {shorten(value)}: must be a table of its own keys; {_suggest([*path, ''], model)}"
    rule = detail["msg"].removeprefix("Input should be ").replace("a valid ", "a ")
    for pydantics, ours in _WORDS.items():
        rule = rule.replace(pydantics, ours)
    return f"{place} = {shorten(value)}: must be {rule}" + (f"; it is {hint}" if hint else "")


_WORDS = {
    "greater than or equal to": "at least",
    "less than or equal to": "at most",
    f"{LARGEST:.0f}": f"{LARGEST:g}",
    "a string": "a text",
    "a integer": "a whole number",
    "a tuple": "a list",
}


def _user_path(location: tuple[int | str, ...], model: type[BaseModel]) -> list[int | str]:
    """What the user wrote: pydantic puts names of its own (of a union's branches) into a place too."""
    path: list[int | str] = []
    for part in location:
        known = isinstance(part, int) or any(part in m.model_fields for m in _owners([*path, part], model))
        if known or part is location[-1]:
            path.append(part)
    return path


def _place(path: list[int | str]) -> str:
    """``("span", 2, "length")`` reads ``span 3: length``: list positions count from 1, as on site."""
    words = ""
    for part in path:
        if isinstance(part, int):
            words += f" {part + 1}:"
        else:
            name = part if part.isprintable() and len(part) <= 60 else shorten(part)
            words += (" " if words.endswith(":") else "." if words else "") + name
    return words.strip().removesuffix(":")


def shorten(value: Any) -> str:
    """A value as an error shows it, at most 60 characters in one line."""
    try:
        text = repr(value)
    except (ValueError, RecursionError):  # Python refuses to write very long integers and very deep tables
        text = "a whole number of thousands of digits" if isinstance(value, int) else "a very deep table"
    return text if len(text) <= 60 else text[:57] + "..."


def _field_models(annotation: Any) -> list[type[BaseModel]]:
    """Parameter classes named anywhere inside an annotation."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [m for argument in getattr(annotation, "__args__", ()) for m in _field_models(argument)]


def _owners(path: list[int | str], model: type[BaseModel]) -> list[type[BaseModel]]:
    owners = [model]
    for part in path[:-1]:
        if isinstance(part, int):
            continue
        owners = [
            inner
            for owner in owners
            if part in owner.model_fields
            for inner in _field_models(owner.model_fields[part].annotation)
        ]
    return owners


def _description(path: list[int | str], model: type[BaseModel]) -> str:
    names = [part for part in path if isinstance(part, str)]
    for owner in _owners(path, model):
        field = owner.model_fields.get(names[-1]) if names else None
        if field and field.description:
            return " ".join(field.description.split())
    return ""


def _suggest(path: list[int | str], model: type[BaseModel]) -> str:
    known = sorted({name for owner in _owners(path, model) for name in owner.model_fields})
    near = difflib.get_close_matches(str(path[-1]), known, n=1)
    return f"did you mean '{near[0]}'?" if near else f"known keys: {', '.join(known)}"
