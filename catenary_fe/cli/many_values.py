"""Options that take several values: ``--pantograph-at 110 10`` for the option given twice."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click


class ManyValues(click.Command):
    """A command some of whose options go on until the next option.

    many : names of those options
    numbers : they take numbers only, so that an argument after them is still seen as one
    """

    def __init__(self, *args: Any, many: Sequence[str] = (), numbers: bool = False, **others: Any) -> None:
        super().__init__(*args, **others)
        self._many, self._numbers = many, numbers

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        spread: list[str] = []
        option: str | None = None
        taken = 0
        for argument in args:
            is_option = argument.startswith("-") and not _is_number(argument)
            if is_option:
                option, taken = (argument if argument in self._many else None), 0
            elif option and self._numbers and not _is_number(argument):
                option = None
            elif option:
                taken += 1
                if taken > 1:
                    spread.append(option)
            spread.append(argument)
        return super().parse_args(ctx, spread)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
