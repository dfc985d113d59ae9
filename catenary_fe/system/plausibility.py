"""What looks wrong in a layout, though no rule forbids it."""

from __future__ import annotations

from catenary_fe.system.catenary import Catenary


def layout_warnings(catenary: Catenary) -> list[str]:
    """What looks wrong in a layout, though no rule forbids it."""
    found = []
    for name, wire in (("contact_wire", catenary.contact_wire), ("messenger_wire", catenary.messenger_wire)):
        if wire.tension < 1000:
            found.append(
                f"{name}.tension = {wire.tension:g} N is below 1000 N: looks like kN, the field takes N"
            )
        strain = wire.tension / wire.axial_stiffness
        if strain > 0.01:
            found.append(
                f"{name}: the tension stretches the wire by {100 * strain:.2g} %, more than 1 %: EA ="
                f" {wire.axial_stiffness:g} N looks too small"
            )
    for i, support in enumerate(catenary.supports[1:-1], start=2):
        if support.steady_arm is None:
            found.append(f"support {i} has no steady arm: the contact wire is free to sag there")
            break
    return found
