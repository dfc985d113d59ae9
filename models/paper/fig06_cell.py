"""Fig. 6: geometry of one cell of the two-wire system.

Question: what are the dimensions of the cell that is repeated in fig. 1?
Model: one span of ``models/layouts/paper_cell.toml`` with its dimensions, drawn from the layout object that
figs. 9 to 15 compute with. The print gives no dimensions; these are ours.
"""

from __future__ import annotations

from pathlib import Path

from paper_common import Numbers, paper_shape, publish, run_script

from catenary_fe.views import plot_layout


def main(folder: Path) -> Numbers:
    shape = paper_shape()
    line = shape.catenary
    span = line.spans[3]
    figure = plot_layout(line, shape, spans=[4]).figure
    caption = (
        f"One cell: a span of {span.length:g} m with {len(span.droppers)} droppers 8 m apart, across the"
        f" supports too, so that all bays of the contact wire are equal; system height {line.system_height:g}"
        " m. Contact wire 20 kN, 1.33 kg/m (paper); all other dimensions are ours."
    )
    numbers = {
        "span (m)": span.length,
        "droppers": len(span.droppers),
        "bay of the contact wire (m)": span.droppers[1].position - span.droppers[0].position,
        "system height (m)": line.system_height,
        "shortest dropper (m)": float(shape.dropper_lengths.min()),
        "longest dropper (m)": float(shape.dropper_lengths.max()),
    }
    return publish(folder, __file__, figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
