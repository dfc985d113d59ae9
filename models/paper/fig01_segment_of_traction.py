"""Fig. 1: segment of a simplified two-wire traction.

Question: what is the structure whose waves are studied?
Model: three spans of ``models/layouts/paper_cell.toml``, the layout object that figs. 9 to 15 compute with,
drawn as it hangs after form finding. Tension and mass of the contact wire are the paper's, all other
dimensions ours.
"""

from __future__ import annotations

from pathlib import Path

from paper_common import Numbers, paper_shape, publish, run_script

import catenary_fe as cf
from catenary_fe.views import plot_layout


def main(folder: Path) -> Numbers:
    shape = paper_shape()
    line = shape.catenary
    figure = plot_layout(line, shape, spans=[3, 4, 5]).figure
    sag = line.messenger_support_heights[0] - shape.messenger_wire_z.min()
    caption = (
        f"Three of the {len(line.spans)} spans of the two-wire system, as it hangs: contact wire under 20 kN,"
        f" messenger wire under {line.messenger_wire.tension / 1e3:g} kN, droppers, rigid supports of the"
        " messenger wire. The print gives no dimensions; these are ours."
    )
    return publish(folder, __file__, figure, caption, _numbers(shape, sag))


def _numbers(shape: cf.Shape, sag: float) -> Numbers:
    return {
        "sag of the messenger wire (m)": sag,
        "sag of the contact wire in a bay (mm)": 1e3 * (5.3 - shape.contact_wire_z.min()),
        "dropper force (N)": float(shape.dropper_forces.mean()),
        "wave speed of the contact wire (m/s)": shape.catenary.contact_wire.wave_speed,
        "wave speed of the messenger wire (m/s)": shape.catenary.messenger_wire.wave_speed,
    }


if __name__ == "__main__":
    run_script(main)
