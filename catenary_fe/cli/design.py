"""Commands that need no run: what a layout is, how it hangs, its elasticity, its modes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from catenary_fe.cli import options
from catenary_fe.cli.folder import Folder, output_folder
from catenary_fe.cli.installed import design_beside, installed_rows, measured_line, print_installed
from catenary_fe.cli.terminal import Answer, print_table, progress_bar, static_shape, working
from catenary_fe.layout import Catenary, ends_in_words, load_catenary
from catenary_fe.layout.current_collection import WAVE_SPEED_SHARE
from catenary_fe.layout.installed import changes_in_words, worn_mass
from catenary_fe.layout.rules import check_lengths, layout_warnings
from catenary_fe.layout.terminations import slowest_contact_wire
from catenary_fe.results.export import cell, check_xlsx, common_name, save_catenary
from catenary_fe.results.quantities import decimals_of

if TYPE_CHECKING:
    from catenary_fe.results import Elasticity
    from catenary_fe.statics import Shape

DRAWN = 6  # shapes of modes in an output folder
_DROPPERS = (
    "section", "span", "dropper", "chainage_m", "hangs_on", "contact_wire", "cut_length_mm",
    "installed_length_m", "force_N", "contact_wire_height_error_mm",
)  # fmt: skip
_SUPPORTS = (
    "section", "support", "chainage_m", "stagger_m", "contact_wire_height_m", "system_height_m",
    "arm_vertical_N", "arm_lateral_N", "messenger_vertical_N", "messenger_lateral_N",
)  # fmt: skip
_SHORT = {
    "chainage_m": "at m",
    "contact_wire_height_error_mm": "height error mm",
    "cut_length_mm": "cut mm",
    "installed_length_m": "installed m",
    "contact_wire_height_m": "wire height m",
    "messenger_vertical_N": "messenger up N",
    "messenger_lateral_N": "messenger left N",
    "arm_vertical_N": "arm up N",
    "arm_lateral_N": "arm left N",
}


@click.command(epilog="\b\nExample:\n  catenary-fe info models/layouts/en50318_2002.toml -o info")
@options.layout
@options.drawn_spans
@options.answer()
def info(layout: str, spans: list[int] | None, answer: Answer) -> None:
    """Check a LAYOUT file: wave speeds, masses, a drawing. Nothing is solved."""
    catenary = load_catenary(layout)
    check_lengths(catenary)
    _check_drawn(catenary, spans, answer.folder)
    facts = layout_facts(catenary)
    result = facts | {"warnings": layout_warnings(catenary)}
    with output_folder(answer.folder) as folder:
        if folder:
            from catenary_fe.views import plot_layout

            folder.json("info.json", result)
            folder.picture("layout.png", plot_layout(catenary, spans=spans))
    answer.show(result, lambda: print_table(catenary.name, ("quantity", "value"), _fact_rows(facts)))


def _check_drawn(catenary: Catenary, spans: list[int] | None, output: str | None) -> None:
    """Check before the work starts that the spans to draw exist, and that there is an output folder."""
    if spans is None:
        return
    if output is None:
        raise click.UsageError("--spans chooses the spans that are drawn: give -o DIR, too")
    from catenary_fe.views.stretch import stretch

    stretch(catenary, spans)


def layout_facts(catenary: Catenary) -> dict[str, Any]:
    """Key figures of a layout in display units."""
    wires = {
        name: {
            "tension_kN": wire.tension / 1e3,
            "mass_per_length_kg_per_m": wire.mass_per_length,
            "wave_speed_kmh": 3.6 * wire.wave_speed,
            "impedance_Ns_per_m": wire.impedance,
        }
        for name in ("contact_wire", "messenger_wire", "stitch_wire")
        if (wire := getattr(catenary, name))
    }
    lengths = [span.length for span in catenary.spans]
    clamps = sum(d.messenger_clamp_mass + d.contact_wire_clamp_mass for d in catenary.droppers)
    contact_wires = len(catenary.contact_wire_offsets)
    line = contact_wires * catenary.contact_wire.mass_per_length
    line += catenary.messenger_wire.mass_per_length if catenary.messenger_wire else 0.0
    if catenary.stitch_wire:
        stitch = catenary.stitch_wire
        clamps += 2 * len(catenary.stitched_supports) * stitch.clamp_mass
        line += stitch.mass_per_length * float(catenary.stitch_wire_lengths.sum()) / catenary.length
    return {
        "name": catenary.name,
        "source": catenary.source,
        "length_m": catenary.length,
        "spans": len(lengths),
        "span_lengths_m": [min(lengths), max(lengths)],
        "droppers": len(catenary.droppers),
        "dropper_lengths_given": catenary.gives_dropper_lengths,
        "model": "in space" if catenary.is_spatial else "in the vertical plane",
        "contact_wires": len(catenary.contact_wire_offsets),
        "stitch_wires": len(catenary.stitched_supports),
        "largest_stagger_m": float(np.abs(catenary.staggers).max()),
        "largest_lateral_pull_N": float(np.abs(catenary.lateral_pulls).max()),
        "wires_along_the_track": ends_in_words(catenary),
        "system_height_m": catenary.system_height if catenary.messenger_wire else None,
        "contact_wire_height_m": catenary.contact_wire_height,
        **wires,
        "largest_speed_by_wave_speed_kmh": 3.6 * WAVE_SPEED_SHARE * slowest_contact_wire(catenary).wave_speed,
        "changed_since_droppers_were_cut": changes_in_words(catenary) or "nothing",
        "mass_of_wires_kg": line * catenary.length - worn_mass(catenary),
        "mass_of_clamps_kg": clamps,
        "mass_of_equipment_kg": sum(item.mass for item in catenary.equipment),
        "evaluated_spans": list(catenary.spans_to_evaluate),
    }


def _fact_rows(facts: dict[str, Any], prefix: str = "") -> list[tuple[str, str]]:
    rows = []
    for key, value in facts.items():
        if isinstance(value, dict):
            rows += _fact_rows(value, f"{key.replace('_', ' ')}: ")
        elif key != "name":
            text = f"{value:.6g}" if isinstance(value, float) else str(value)
            rows.append((prefix + key.replace("_", " "), text))
    return rows


@click.command(epilog="\b\nExample:\n  catenary-fe form models/layouts/en50318_2002.toml -o form")
@options.layout
@options.flag("--design-lengths", "Find the lengths of the design, whatever lengths the layout gives.")
@click.option(
    "--measured",
    type=click.Path(),
    metavar="FILE",
    help="Measured heights (CSV: x_m, height_m, perhaps stagger_m): find the lengths that explain them.",
)
@options.flag("--xlsx", "Write the tables as a workbook, too (with -o).")
@options.drawn_spans
@options.planar
@options.answer()
def form(
    layout: str,
    design_lengths: bool,
    measured: str | None,
    xlsx: bool,
    spans: list[int] | None,
    planar: bool,
    answer: Answer,
) -> None:
    """Find the dropper lengths that give the contact wire of a LAYOUT its design height.

    Where the droppers have lengths of their own, the line is hung with these, and the table says how far the
    contact wire then lies from its design height. A line that hangs otherwise than its design, with lengths
    of its own, droppers missing or a worn wire, is shown beside the design. With measured heights, the
    folder's layout.toml is the line that has them.
    """
    if xlsx:
        if answer.folder is None:
            raise click.UsageError("--xlsx writes a workbook: give -o DIR, too")
        check_xlsx()
    catenary = options.read_layout(layout, planar)
    if design_lengths:
        catenary = catenary.without_dropper_lengths()
    _check_drawn(catenary, spans, answer.folder)
    line = measured_line(catenary, measured) if measured else catenary
    with static_shape(line, answer) as (shape, folder):
        design = design_beside(shape, catenary, answer.quiet)
        compared = installed_rows(shape, design)
        result: dict[str, Any] = {
            "dropper_lengths_given": line.gives_dropper_lengths,
            "droppers": [row.as_dict() for row in shape.dropper_schedule()],
            "supports": [row.as_dict() for row in shape.support_schedule()],
            "steady_arm_forces_N": shape.steady_arm_forces.tolist(),
            "steady_arm_lateral_forces_N": shape.steady_arm_lateral_forces.tolist(),
            "messenger_support_forces_N": shape.support_forces.tolist(),
            "against_design": compared,
            "warnings": layout_warnings(catenary),
        }
        if folder:
            from catenary_fe.views import plot_heights, plot_layout, plot_plan, plot_static_shape

            folder.json("form.json", result)
            write_schedules(folder, shape, xlsx)
            if compared:
                folder.table("against_design.csv", compared)
            if measured:
                save_catenary(line, folder.path / "layout.toml", comment=f"From heights measured: {measured}")
            folder.picture("layout.png", plot_layout(line, shape, spans=spans))
            folder.picture("static_shape.png", plot_static_shape(shape, spans=spans, design=design))
            if line.is_spatial:
                folder.picture("plan.png", plot_plan(shape, spans=spans))
            if shape.catenary.changes_height:
                folder.picture("heights.png", plot_heights(shape, spans=spans))

    def tables() -> None:
        print_schedules(shape)
        if compared:
            print_installed(line.name, compared)

    answer.show(result, tables, shape)


@click.command(epilog="\b\nExample:\n  catenary-fe static models/layouts/en50318_2002.toml --force 100")
@options.layout
@click.option("--force", "force", type=float, default=100.0, show_default=True, help="Upward force in N.")
@options.spans
@options.planar
@options.answer()
def static(layout: str, force: float, spans: list[int] | None, planar: bool, answer: Answer) -> None:
    """Elasticity of a LAYOUT: how far a static force lifts the contact wire, point by point."""
    from catenary_fe.statics.elasticity import elasticity

    catenary = options.read_layout(layout, planar)
    with static_shape(catenary, answer) as (shape, folder):
        with progress_bar("elasticity", not answer.quiet) as progress:
            curve = elasticity(shape, force=force, spans=spans, progress=progress)
        rows = [
            {"position_m": float(x), "mm_per_N": 1e3 * float(e)}
            for x, e in zip(curve.position, curve.values, strict=True)
        ]
        result: dict[str, Any] = {
            "elasticity": rows,
            "non_uniformity": curve.non_uniformity,
            "force_N": curve.force,
            "dropper_lengths_given": catenary.gives_dropper_lengths,
            "warnings": layout_warnings(catenary),
        }
        if folder:
            from catenary_fe.views import plot_elasticity, plot_static_shape

            folder.json("static.json", result)
            folder.table("elasticity.csv", elasticity_table(curve, catenary))
            folder.picture("elasticity.png", plot_elasticity(curve))
            folder.picture("static_shape.png", plot_static_shape(shape))
    title = f"{catenary.name}: elasticity under {force:g} N"
    title += f", non-uniformity {100 * curve.non_uniformity:.1f} %"
    table = [(row["position_m"], f"{row['mm_per_N']:.4f}") for row in rows]
    answer.show(result, lambda: print_table(title, ("position m", "elasticity mm/N"), table), shape)


def elasticity_table(curve: Elasticity, catenary: Catenary) -> list[dict[str, Any]]:
    """Rows of the elasticity, each with the span that it is in; a support belongs to the span before it."""
    inside = np.searchsorted(catenary.support_positions, curve.position - 1e-6)
    spans = np.clip(inside, 1, len(catenary.spans)).tolist()
    columns = curve.position.tolist(), (1e3 * curve.uplift).tolist(), (1e3 * curve.values).tolist()
    return [
        {"span": span, "position_m": x, "uplift_mm": uplift, "elasticity_mm_per_N": value}
        for span, x, uplift, value in zip(spans, *columns, strict=True)
    ]


@click.command(epilog="\b\nExample:\n  catenary-fe modes models/layouts/paper_cell.toml --below 20 -o modes")
@options.layout
@click.option("--count", type=click.IntRange(1), help="How many modes; unset, and with no --below: 40.")
@click.option("--below", type=float, metavar="HZ", help="All modes up to this frequency.")
@options.planar
@options.answer()
def modes(layout: str, count: int | None, below: float | None, planar: bool, answer: Answer) -> None:
    """Eigenfrequencies and shapes of a LAYOUT about its static state, droppers taut."""
    from catenary_fe.engines.modal.modes import mode_warnings, solve_modes
    from catenary_fe.fe import MeshSettings

    catenary = options.read_layout(layout, planar)
    # the usual mesh leaves 0.1 % in the lowest frequencies, half of it 0.02 %
    with static_shape(catenary, answer, MeshSettings().halved()) as (shape, folder):
        with working("modes", not answer.quiet):
            found = solve_modes(shape, count=count, below=below)
        rows = found.table()
        result: dict[str, Any] = {
            "modes": rows,
            "dropper_lengths_given": catenary.gives_dropper_lengths,
            "warnings": [*layout_warnings(catenary), *mode_warnings(shape, found)],
        }
        if folder:
            from catenary_fe.views import plot_mode, plot_spectrum

            folder.json("modes.json", result)
            folder.table("modes.csv", rows)
            folder.picture("spectrum.png", plot_spectrum(found))
            for i in range(min(DRAWN, len(found))):
                folder.picture(f"mode_{i + 1:02d}.png", plot_mode(found, i))
    table = [
        (row["mode"], f"{row['frequency_Hz']:.4f}", f"{100 * row['damping_ratio']:.3f}", str(kind))
        for row, kind in zip(rows, found.kinds(), strict=True)
    ]
    columns, title = ("mode", "frequency Hz", "damping %", "kind"), "modes about the static state"
    answer.show(result, lambda: print_table(f"{catenary.name}: {title}", columns, table), shape)


def write_schedules(folder: Folder, shape: Shape, xlsx: bool = False) -> None:
    """Write the tables of droppers and supports as CSV, all columns on every line; perhaps as XLSX, too."""
    from catenary_fe.results.export import write_xlsx
    from catenary_fe.statics import DropperRow

    droppers = [row.as_record() for row in shape.dropper_schedule()]
    supports = [row.as_record() for row in shape.support_schedule()]
    folder.table("dropper_schedule.csv", droppers, columns=DropperRow.columns())
    folder.table("support_schedule.csv", supports)
    if xlsx:
        sheets = {"droppers": (DropperRow.columns(), droppers), "supports": (list(supports[0]), supports)}
        write_xlsx(folder.path / "schedules.xlsx", sheets)


def print_schedules(shape: Shape) -> None:
    """Print the main columns of both tables."""
    name, several = shape.catenary.name, len(shape.contact_wires) > 1
    supports = [key for key in _SUPPORTS if not (several and key == "contact_wire_height_m")]  # no room
    _print(f"{name}: dropper schedule", [row.as_dict() for row in shape.dropper_schedule()], _DROPPERS)
    _print(f"{name}: supports", [row.as_dict() for row in shape.support_schedule()], supports)


def _print(title: str, rows: Sequence[Mapping[str, Any]], wanted: Sequence[str]) -> None:
    """The wanted columns, those of each contact wire among them, as far as the line has them."""
    columns = [
        key
        for key in (rows[0] if rows else ())
        if common_name(key) in wanted and any(row[key] is not None for row in rows)
    ]
    columns.sort(key=lambda key: wanted.index(common_name(key)))
    table = [
        ["" if row[key] is None else cell(row[key], decimals_of(key)) for key in columns] for row in rows
    ]
    print_table(title, [_heading(key) for key in columns], table)


def _heading(key: str) -> str:
    common = common_name(key)
    number = key[len(common) :] and ("right " if "_1_" in key else "left ")
    return number + _SHORT.get(common, common.replace("_", " "))
