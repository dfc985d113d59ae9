"""Form finding of lines that an engineer might draw: none of them may fail."""

from pathlib import Path

import numpy as np
import pytest
from string_statics import dropper_lengths

import catenary_fe as cf

CASES = Path(__file__).parents[1] / "cases"


def drawn(rng: np.random.Generator) -> cf.Catenary:
    """A line drawn at random: plane or space, with and without EI, twin or stitched wires, curves."""
    spans = int(rng.integers(2, 7))
    lengths = np.clip(rng.uniform(27, 65) + rng.uniform(-4, 4, spans), 27, 65)
    spacing = rng.uniform(2, 10)
    in_space, stitched, twin = rng.random() < 0.5, rng.random() < 0.25, rng.random() < 0.25
    radius = float(rng.choice([-1, 1]) * rng.uniform(1200, 6000)) if in_space and rng.random() < 0.5 else None
    stagger = float(rng.uniform(0.1, 0.3)) if in_space else 0.0
    arm = (
        cf.SteadyArm(length=float(rng.uniform(0.8, 1.4)), mass_per_length=0.8, clamp_mass=0.3)
        if in_space and not radius and rng.random() < 0.5
        else cf.SteadyArm(stiffness=float(rng.uniform(0, 400)), mass=float(rng.uniform(0, 1)))
    )
    sag = float(rng.choice([0.0, 0.0005, 0.001]))
    return cf.Catenary(
        contact_wire=cf.Wire(
            mass_per_length=float(rng.uniform(0.9, 1.9)),
            tension=float(rng.uniform(9e3, 30e3)),
            axial_stiffness=float(rng.uniform(1e7, 2.5e7)),
            bending_stiffness=float(rng.choice([0.0, 109.0, 195.0])),
        ),
        messenger_wire=cf.Wire(
            mass_per_length=float(rng.uniform(0.6, 1.7)),
            tension=float(rng.uniform(14e3, 24e3)),
            axial_stiffness=float(rng.uniform(6e6, 1.9e7)),
            bending_stiffness=float(rng.choice([0.0, 0.0, 131.7])),
        ),
        contact_wire_spacing=0.05 if twin else None,
        stitch_wire=cf.StitchWire(
            mass_per_length=0.31, tension=3500.0, axial_stiffness=3.85e6, length=14.0, clamp_mass=0.3
        )
        if stitched
        else None,
        spans=tuple(
            cf.Span(
                length=float(length),
                droppers=tuple(
                    cf.Dropper(
                        position=float(x), stiffness=float(rng.choice([1e5, 2e5, 1e6])), mass_per_length=0.1
                    )
                    for x in np.arange(spacing / 2, length - 0.5, spacing)
                ),
                pre_sag=sag * float(length),
                curve_radius=radius,
            )
            for length in lengths
        ),
        supports=tuple(
            cf.Support(steady_arm=arm, stagger=stagger * (-1) ** i, messenger_stiffness=5e5)
            for i in range(spans + 1)
        ),
        system_height=float(rng.uniform(1.8, 2.4)),
    )


def scan(count: int, seed: int) -> tuple[int, list[str]]:
    """How many lines were found, and the errors of those that were refused."""
    rng, found, refused = np.random.default_rng(seed), 0, []
    for _ in range(count):
        line = drawn(rng)
        try:
            shape = cf.find_form(line)
        except cf.InputError as error:  # such as a dropper that would have to push
            refused.append(str(error))
            continue
        assert np.abs(shape.height_errors).max() < 1e-9
        assert (shape.dropper_forces > 0).all()
        found += 1
    return found, refused


def test_a_hundred_lines_drawn_at_random_are_found():
    found, refused = scan(100, 1)
    assert found >= 80, refused


@pytest.mark.slow
def test_two_thousand_lines_drawn_at_random_are_found():
    found, refused = scan(2000, 2)
    assert found >= 1600, refused[:20]


def test_lines_that_failed_at_random_are_found():
    droppers = tuple(cf.Dropper(position=x) for x in np.arange(1.125, 56 - 1e-6, 2.25).tolist())
    for span in (45.0, 55.9, 56.0, 65.0):
        line = cf.load_catenary(CASES / "messenger_56m.toml")
        kept = tuple(d for d in droppers if d.position < span)
        shape = cf.find_form(line.replace(spans=(cf.Span(length=span, droppers=kept),) * 2))
        assert np.abs(shape.height_errors).max() < 1e-9


def test_the_messenger_wire_of_56_m_sags_as_by_hand():
    shape = cf.find_form(cf.load_catenary(CASES / "messenger_56m.toml"))
    sag = 7.5 - shape.messenger_wire.height(28.0)
    assert sag == pytest.approx(32.2 * 56**2 / (8 * 13734), rel=0.02)  # by hand, the load spread out


def test_droppers_of_the_line_with_two_wires_are_as_by_hand():
    shape = cf.find_form(cf.load_catenary(CASES / "dc_3kv_54m.toml"))
    lengths = shape.dropper_lengths
    assert lengths[0] == pytest.approx(1.330, abs=1e-3)
    assert lengths.min() == pytest.approx(0.645, abs=1e-3)


def by_hand(span: float, spacing: float, tension: float, twin: bool) -> tuple[cf.Shape, np.ndarray]:
    """The form of a line whose wires have no EI, and what string statics say of its second span."""
    positions = np.arange(spacing / 2, span - 0.3, spacing)
    line = cf.Catenary.regular(
        spans=3,
        span_length=span,
        droppers=[cf.Dropper(position=x, stiffness=1e6, mass_per_length=0.1) for x in positions.tolist()],
        pre_sag=span / 2000,
        contact_wire=cf.Wire(mass_per_length=1.07, tension=15e3, axial_stiffness=1.4e7),
        messenger_wire=cf.Wire(mass_per_length=1.06, tension=tension, axial_stiffness=1.2e7),
        contact_wire_spacing=0.04 if twin else None,
        support=cf.Support(steady_arm=cf.SteadyArm(stiffness=200.0)),
        system_height=2.2,
        spatial=False,
    )
    return cf.find_form(line), dropper_lengths(line, span=2)


@pytest.mark.parametrize("span", [27.0, 38.5, 49.5, 56.0, 65.0])
@pytest.mark.parametrize(("spacing", "twin"), [(2.25, True), (4.5, True), (5.0, False), (9.0, False)])
def test_dropper_lengths_are_those_of_string_statics(span, spacing, twin):
    shape, hand = by_hand(span, spacing, 16e3, twin)
    mine = shape.dropper_lengths[shape.catenary.dropper_spans == 2]
    assert np.abs(mine - hand).max() < 0.15e-3  # the hand takes the weight by length along the track
    wrong = by_hand(span, spacing, 16e3 * 1.01, twin)[1]  # negative control: tension up by 1 %
    assert np.abs(mine - wrong).max() > 0.5e-3


def test_the_dropper_table_does_not_depend_on_the_mesh():
    line = cf.load_catenary(CASES / "dropper_table_49m5.toml")
    hand = dropper_lengths(line, span=2)
    for at_clamps in (0.5, 0.02):
        shape = cf.find_form(line, cf.MeshSettings(at_clamps=at_clamps))
        mine = shape.dropper_lengths[line.dropper_spans == 2]
        assert np.abs(mine - hand).max() < 0.2e-3  # EI of the contact wires, which the hand does not know
