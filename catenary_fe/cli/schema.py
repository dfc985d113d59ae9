"""JSON Schemas of the files that a user writes."""

from __future__ import annotations

import click

from catenary_fe.cli.terminal import print_json


@click.command(epilog="\b\nExample:\n  catenary-fe schema layout > layout.schema.json")
@click.argument("kind", type=click.Choice(["layout", "pantograph"]))
def schema(kind: str) -> None:
    """Print the JSON Schema with which an editor completes and checks layout or pantograph files."""
    from catenary_fe.layout import layout_schema, pantograph_schema

    print_json(layout_schema() if kind == "layout" else pantograph_schema())
