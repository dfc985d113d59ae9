"""Commands that need no run: what a layout is, how it hangs, how it gives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click
import numpy as np

from catenary_fe.cli.folder import output_folder
from catenary_fe.cli.schedules import print_schedules, write_schedules
from catenary_fe.cli.terminal import (
    drawn_spans_option,
    json_option,
    layout_argument,
    output_option,
    planar_option,
    print_json,
    print_table,
    print_warnings,
    progress_bar,
    quiet_option,
    read_layout,
    say_lengths,
    spans_option,
    warned,
    working,
)
from catenary_fe.layout import Catenary, load_catenary
from catenary_fe.layout.catenary_rules import check_lengths
from catenary_fe.layout.current_collection import WAVE_SPEED_SHARE
from catenary_fe.layout.preflight import layout_warnings

if TYPE_CHECKING:
    from catenary_fe.results import Elasticity


@click.command(epilog="\b\nExample:\n  catenary-fe info models/layouts/en50318_2002.toml -o info")
@layout_argument
@drawn_spans_option
@output_option
@json_option
@quiet_option
def info(layout: str, spans: list[int] | None, output: str | None, as_json: bool, quiet: bool) -> None:
    """Check a LAYOUT file: wave speeds, masses, a drawing. Nothing is solved."""
    catenary = load_catenary(layout)
    check_lengths(catenary)
    _check_drawn(catenary, spans, output)
    facts = layout_facts(catenary)
    warnings = layout_warnings(catenary)
    with output_folder(output) as folder:
        if folder:
            from catenary_fe.views import plot_layout

            folder.json("info.json", facts | {"warnings": warnings})
            folder.picture("layout.png", plot_layout(catenary, spans=spans))
    if as_json:
        print_json(facts | {"warnings": warnings})
    else:
        if not quiet:
            print_table(catenary.name, ("quantity", "value"), _fact_rows(facts))
        print_warnings(warnings)


def _check_drawn(catenary: Catenary, spans: list[int] | None, output: str | None) -> None:
    """Before the work: whether there are these spans to draw, and somewhere to draw them."""
    if spans is None:
        return
    if output is None:
        raise click.UsageError("--spans chooses the spans that are drawn: give -o DIR, too")
    from catenary_fe.views.stretch import stretch

    stretch(catenary, spans)


def layout_facts(catenary: Catenary) -> dict[str, Any]:
    """Key figures of a layout in display units."""
    wires = {}
    for name, wire in (
        ("contact_wire", catenary.contact_wire),
        ("messenger_wire", catenary.messenger_wire),
        ("stitch_wire", catenary.stitch_wire),
    ):
        if wire is None:
            continue
        wires[name] = {
            "tension_kN": wire.tension / 1e3,
            "mass_per_length_kg_per_m": wire.mass_per_length,
            "wave_speed_kmh": 3.6 * wire.wave_speed,
            "impedance_Ns_per_m": wire.impedance,
        }
    lengths = [span.length for span in catenary.spans]
    clamps = sum(d.messenger_clamp_mass + d.contact_wire_clamp_mass for d in catenary.droppers)
    contact_wires = len(catenary.contact_wire_offsets)
    line = contact_wires * catenary.contact_wire.mass_per_length + catenary.messenger_wire.mass_per_length
    if catenary.stitch_wire:
        stitch = catenary.stitch_wire
        clamps += 2 * len(catenary.stitched_supports) * stitch.clamp_mass
        line += len(catenary.stitched_supports) * stitch.mass_per_length * stitch.length / catenary.length
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
        "system_height_m": catenary.system_height,
        "contact_wire_height_m": catenary.contact_wire_height,
        **wires,
        "largest_speed_by_wave_speed_kmh": 3.6 * WAVE_SPEED_SHARE * catenary.contact_wire.wave_speed,
        "mass_of_wires_kg": line * catenary.length,
        "mass_of_clamps_kg": clamps,
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
@layout_argument
@click.option(
    "--design-lengths",
    is_flag=True,
    help="Find the lengths of the design, whatever lengths the layout gives.",
)
@drawn_spans_option
@planar_option
@output_option
@json_option
@quiet_option
def form(
    layout: str,
    design_lengths: bool,
    spans: list[int] | None,
    planar: bool,
    output: str | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Find the dropper lengths that give the contact wire of a LAYOUT its design height.

    Where the droppers have lengths of their own, the line is hung with these, and the table says how far the
    contact wire then lies from its design height.
    """
    from catenary_fe.statics import find_form

    catenary = read_layout(layout, planar)
    if design_lengths:
        catenary = catenary.without_dropper_lengths()
    _check_drawn(catenary, spans, output)
    with warned(layout_warnings(catenary)), output_folder(output) as folder:
        with working("form finding", not quiet):
            shape = find_form(catenary)
        result: dict[str, Any] = {
            "dropper_lengths_given": catenary.gives_dropper_lengths,
            "droppers": [row.as_dict() for row in shape.dropper_schedule()],
            "supports": [row.as_dict() for row in shape.support_schedule()],
            "steady_arm_forces_N": shape.steady_arm_forces.tolist(),
            "steady_arm_lateral_forces_N": shape.steady_arm_lateral_forces.tolist(),
            "messenger_support_forces_N": shape.support_forces.tolist(),
            "warnings": layout_warnings(catenary),
        }
        if folder:
            from catenary_fe.views import plot_layout, plot_plan, plot_static_shape

            folder.json("form.json", result)
            write_schedules(folder, shape)
            folder.picture("layout.png", plot_layout(catenary, shape, spans=spans))
            folder.picture("static_shape.png", plot_static_shape(shape, spans=spans))
            if catenary.is_spatial:
                folder.picture("plan.png", plot_plan(shape, spans=spans))
    if as_json:
        print_json(result)
    elif not quiet:
        print_schedules(shape)
    say_lengths(shape, quiet)
    if not as_json:
        print_warnings(result["warnings"])


@click.command(epilog="\b\nExample:\n  catenary-fe static models/layouts/en50318_2002.toml --force 100")
@layout_argument
@click.option("--force", "force", type=float, default=100.0, show_default=True, help="Upward force in N.")
@spans_option
@planar_option
@output_option
@json_option
@quiet_option
def static(
    layout: str,
    force: float,
    spans: list[int] | None,
    planar: bool,
    output: str | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Elasticity of a LAYOUT: how far a static force lifts the contact wire, point by point."""
    from catenary_fe.statics import find_form
    from catenary_fe.statics.elasticity import elasticity

    catenary = read_layout(layout, planar)
    with warned(layout_warnings(catenary)), output_folder(output) as folder:
        with working("form finding", not quiet):
            shape = find_form(catenary)
        with progress_bar("elasticity", not quiet) as progress:
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
    if as_json:
        print_json(result)
    elif not quiet:
        table = [(row["position_m"], f"{row['mm_per_N']:.4f}") for row in rows]
        print_table(
            f"{catenary.name}: elasticity under {force:g} N,"
            f" non-uniformity {100 * curve.non_uniformity:.1f} %",
            ("position m", "elasticity mm/N"),
            table,
        )
    say_lengths(shape, quiet)
    if not as_json:
        print_warnings(result["warnings"])


def elasticity_table(curve: Elasticity, catenary: Catenary) -> list[dict[str, Any]]:
    """Rows of the elasticity, each with the span that it is in; a support belongs to the span before it."""
    inside = np.searchsorted(catenary.support_positions, curve.position - 1e-6)
    spans = np.clip(inside, 1, len(catenary.spans)).tolist()
    columns = curve.position.tolist(), (1e3 * curve.uplift).tolist(), (1e3 * curve.values).tolist()
    return [
        {"span": span, "position_m": x, "uplift_mm": uplift, "elasticity_mm_per_N": value}
        for span, x, uplift, value in zip(spans, *columns, strict=True)
    ]
