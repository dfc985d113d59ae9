"""Commands that make layouts: from tables of masts and droppers, and by the rules of line types."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import click

from catenary_fe.cli import options
from catenary_fe.cli.terminal import print_json, print_table, print_warnings, say
from catenary_fe.layout import Catenary, InputError, build_line, layout_warnings, library, load_catenary
from catenary_fe.layout.files import MOST_SPANS

_SPANS = re.compile(r"(?:(\d+)\s*[x×*]\s*)?(\d+(?:\.\d*)?)")

FROM_TABLE_EPILOG = """\b
Examples:
  catenary-fe layout from-table masts.csv droppers.csv --base models/layouts/re250.toml -o line.toml
  catenary-fe layout from-table masts.csv --line "Re 250" -o line.toml"""


@click.group()
def layout() -> None:
    """Make layout files, from tables or by the rules of line types."""


def _line_names(context: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    names = [n for n in library.names("lines") if n.casefold().startswith(incomplete.strip("'\"").casefold())]
    return [shlex.quote(name) for name in names]


_file = options.output("Layout file to write.", "FILE", required=True)


@layout.command("from-table", epilog=FROM_TABLE_EPILOG)
@click.argument("masts", type=click.Path())
@click.argument("droppers", type=click.Path(), required=False)
@click.option("--base", type=click.Path(), metavar="LAYOUT", help="Layout for what the tables do not hold.")
@click.option(
    "--line", "kind", metavar="NAME", shell_complete=_line_names, help="Line of the library for that."
)
@click.option("--name", help="Of the line; unset: the name of the masts' file.")
@options.spans
@_file
@options.as_json
@options.quiet
def from_table(
    masts: str,
    droppers: str | None,
    base: str | None,
    kind: str | None,
    name: str | None,
    spans: list[int] | None,
    output: str,
    as_json: bool,
    quiet: bool,
) -> None:
    """Make a layout of a table of MASTS and one of DROPPERS (CSV).

    A column's heading has its unit: chainage_m, stagger_mm. Masts need chainage and stagger, droppers span
    and position or chainage; droppers with a length are hung with it. form -o writes tables of this kind.
    Wires, damping, arms and clamps are those of the base. Without a table of droppers, the line's rule places
    them, or the base's span of the same length.
    """
    from catenary_fe.layout.from_tables import read_line

    if (base is None) == (kind is None):
        raise click.UsageError(
            "give --base LAYOUT or --line NAME: one of them, for what the tables do not hold"
        )
    made = read_line(masts, droppers, base=load_catenary(base) if base else kind, name=name)
    files = [masts, *([droppers] if droppers else [])]
    origin = ["--base", base] if base else ["--line", str(kind)]
    not_read = {path: list(headings) for path, headings in made.not_read.items()}
    line = made.catenary.replace(evaluated_spans=tuple(spans)) if spans else made.catenary
    words = ["from-table", *files, *origin, *(["--name", name] if name else [])]
    words += ["--spans", ",".join(map(str, spans))] if spans else []
    _write(line, output, words, as_json, quiet, {"not_read": not_read})
    for path, headings in made.not_read.items():
        if not quiet:
            say("note", f"{path}: results, which are not read: {', '.join(headings)}", "cyan")


@layout.command(
    "build", epilog='\b\nExample:\n  catenary-fe layout build "Re 250" --spans 65,10x60,50 -o line.toml'
)
@click.argument("line", shell_complete=_line_names)
@click.option("--spans", "spans", required=True, help="Lengths in m, in order, e.g. 65,10x60,50.")
@click.option("--stagger", type=float, metavar="M", help="To alternating sides; unset: the line's.")
@click.option("--curve-radius", type=float, metavar="M", help="Of the track, positive to the left.")
@click.option("--name", help="Of the line; unset: that of its type.")
@_file
@options.as_json
@options.quiet
def build(
    line: str,
    spans: str,
    stagger: float | None,
    curve_radius: float | None,
    name: str | None,
    output: str,
    as_json: bool,
    quiet: bool,
) -> None:
    """Make a layout of a LINE of the library, droppers and stitch wires placed by its rule.

    The source of the layout says what is from where, and what is assumed.
    """
    named: dict[str, Any] = {"name": name} if name else {}
    made = build_line(line, _lengths(spans), staggers=stagger, curve_radii=curve_radius, **named)
    given = (("stagger", stagger), ("curve-radius", curve_radius), ("name", name))
    words = [word for n, v in given if v is not None for word in (f"--{n}", str(v))]
    _write(made, output, ["build", line, "--spans", spans, *words], as_json, quiet, {})


@layout.command("dxf", epilog="\b\nExample:\n  catenary-fe layout dxf models/layouts/re250.toml -o line.dxf")
@click.argument("layout", type=click.Path())
@click.option(
    "--exaggeration", type=click.FloatRange(0.1, 100), default=1.0, show_default=True, help="Of heights."
)
@options.planar
@options.output("DXF file to write.", "FILE", required=True)
@options.quiet
def dxf(layout: str, exaggeration: float, planar: bool, output: str, quiet: bool) -> None:
    """Draw the long section of a LAYOUT at rest as DXF, in metres, with wires and droppers on layers."""
    from catenary_fe.cli.terminal import warned, working
    from catenary_fe.statics import find_form
    from catenary_fe.views import write_dxf
    from catenary_fe.views.dxf import check_dxf

    check_dxf()
    catenary = options.read_layout(layout, planar)
    with warned(layout_warnings(catenary)), working("form finding", not quiet):
        shape = find_form(catenary)
    path = write_dxf(shape, output, exaggeration=exaggeration)
    if not quiet:
        click.echo(f"long section in {path}")


def _lengths(text: str) -> list[float]:
    """``65,2x60`` is 65, 60, 60. Raises InputError."""
    lengths: list[float] = []
    for part in text.split(","):
        found = _SPANS.fullmatch(part.strip())
        if not found or len(lengths) + int(found[1] or 1) > MOST_SPANS:
            raise InputError(f"--spans {text}: {part.strip()!r} is no length in m, nor so many: 60 or 10x60")
        lengths += [float(found[2])] * int(found[1] or 1)
    return lengths


def _write(
    catenary: Catenary, output: str, words: list[str], as_json: bool, quiet: bool, more: dict[str, Any]
) -> None:
    """Write the file, and say what is in it.

    more : to be said in JSON
    """
    from catenary_fe.cli.design import layout_facts
    from catenary_fe.results import save_catenary

    warnings = layout_warnings(catenary)
    comment = "catenary-fe layout " + shlex.join(words)
    path = save_catenary(catenary, Path(output), comment=comment)
    facts = layout_facts(catenary)
    if as_json:
        print_json({"file": str(path)} | facts | more | {"warnings": warnings})
        return
    if not quiet:
        print_table(catenary.name, ("quantity", "value"), _rows(facts, path))
    print_warnings(warnings)


def _rows(facts: dict[str, Any], path: Path) -> list[tuple[str, str]]:
    names = ("length_m", "spans", "span_lengths_m", "droppers", "dropper_lengths_given", "stitch_wires",
             "largest_stagger_m", "largest_lateral_pull_N")  # fmt: skip
    rows = [("written to", str(path))]
    for name in names:
        value = facts[name]
        rows.append((name.replace("_", " "), f"{value:.6g}" if isinstance(value, float) else str(value)))
    return rows
