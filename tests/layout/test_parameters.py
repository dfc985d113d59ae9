"""Parameter objects refuse what breaks a rule, in words that an engineer can act on."""

import math
import re

import pytest

import catenary_fe as cf

WIRE = {"mass_per_length": 1.35, "tension": 20e3, "axial_stiffness": 1.7e7}


def problems(make, *args, **kwargs):
    with pytest.raises(cf.InputError) as caught:
        make(*args, **kwargs)
    return caught.value.problems


def test_wave_speed_and_impedance():
    wire = cf.Wire(**WIRE)
    assert wire.wave_speed == pytest.approx(math.sqrt(20e3 / 1.35))
    assert wire.impedance == pytest.approx(math.sqrt(20e3 * 1.35))
    beam = wire.replace(bending_stiffness=195.0).beam
    assert (beam.tension, beam.mass_per_length, beam.bending_stiffness) == (20e3, 1.35, 195.0)


@pytest.mark.parametrize(
    ("make", "name", "said"),
    [
        (
            lambda: cf.Wire(**WIRE),
            "tension",
            r"Wire\.tension cannot .* copy with \.replace\(tension=\.\.\.\)",
        ),
        (lambda: cf.Wire(**WIRE), "tensoin", "Wire has no 'tensoin', .* did you mean 'tension'"),
        (lambda: cf.Wire(**WIRE), "wave_speed", "Wire.wave_speed follows from the fields"),
        (
            cf.TimeSettings,
            "step",
            r"TimeSettings\.step cannot .* dataclasses\.replace\(\.\.\., step=\.\.\.\)",
        ),
        (cf.MeshSettings, "colour", "MeshSettings has no 'colour', .* it has contact_wire_element, "),
    ],
)
def test_nothing_is_changed_in_place(make, name, said):
    thing = make()
    (line,) = problems(setattr, thing, name, 1.0)
    assert re.search(said, line)
    assert problems(delattr, thing, name) == (line,)
    assert thing == make()


def test_results_are_not_changed_in_place_either(short_shape, short_run):
    statistics = short_run.contact_force_statistics()[0]
    for thing, name in ((short_shape, "wires"), (short_run, "data"), (statistics, "std")):
        (line,) = problems(setattr, thing, name, None)
        assert line.startswith(f"{type(thing).__name__}.{name} cannot be changed in place")


def test_arrays_of_a_catenary_are_not_changed_in_place(reference):
    for name in ("support_positions", "dropper_positions", "design_heights", "staggers", "lateral_pulls"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(reference, name)[0] = 1.0


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"tension": -1.0}, "tension = -1.0: must be greater than 0; it is [N] along the wire"),
        ({"tension": "20 kN"}, "tension = '20 kN': must be a number"),
        ({"tension": math.nan}, "tension = nan: must be a finite number"),
        ({"tension": math.inf}, "tension = inf: must be a finite number"),
        ({"tension": True}, "tension = True: must be a number"),
        ({"tensoin": 1.0}, "unknown key tensoin; did you mean 'tension'?"),
        ({"bending_stiffness": -0.1}, "bending_stiffness = -0.1: must be at least 0"),
    ],
)
def test_a_bad_value_is_one_clear_line(change, said):
    (line,) = problems(cf.Wire, **(WIRE | change))
    assert line.startswith(said)
    assert "\n" not in line


def test_a_missing_value_is_named_with_its_unit():
    (line,) = problems(cf.Wire, mass_per_length=1.0, axial_stiffness=1e7)
    assert line.startswith("tension is missing; add it: [N]")


def test_several_faults_are_reported_together():
    assert len(problems(cf.Wire, mass_per_length=-1.0, tension="x", axial_stiffness=0.0, colour=1)) == 4


def test_droppers_outside_the_span_or_out_of_order():
    outside = [cf.Dropper(position=5.0), cf.Dropper(position=56.2)]
    (line,) = problems(cf.Span, length=55.0, droppers=outside)
    assert line.startswith("dropper 2 at 56.2 m lies outside the 55 m span")
    swapped = [cf.Dropper(position=7.0), cf.Dropper(position=5.0)]
    (line,) = problems(cf.Span, length=55.0, droppers=swapped)
    assert line.startswith("dropper 2 at 5 m does not come after the one before it at 7 m")


def test_droppers_too_close_to_mesh():
    (line,) = problems(cf.Span, length=55.0, droppers=[cf.Dropper(position=x) for x in (5.0, 5.000001)])
    assert line.startswith("dropper 2 at 5 m is less than 0.01 m from the next clamp or support")
    (line,) = problems(cf.Span, length=55.0, droppers=[cf.Dropper(position=54.999)])
    assert "from the next clamp or support" in line


def test_pre_sag_is_a_parabola_between_the_outermost_droppers():
    # heights of the EN 50318:2018 AC simple layout (secondary source): 0, -24, -41, -52, -55 mm
    droppers = tuple(cf.Dropper(position=x) for x in (4.5, 10.25, 16, 21.75, 27.5, 33.25, 39, 44.75, 50.5))
    offsets = cf.Span(length=55.0, droppers=droppers, pre_sag=0.055).height_offsets()
    assert offsets[:5] == pytest.approx([0, -0.024, -0.041, -0.052, -0.055], abs=6e-4)
    assert offsets == pytest.approx(offsets[::-1])


def test_a_dropper_longer_than_the_system_height_is_refused(reference):
    span = reference.spans[0]
    long = span.replace(droppers=(*span.droppers[:-1], span.droppers[-1].replace(length=1.5)))
    (line,) = problems(reference.replace, spans=(*reference.spans[:-1], long))
    assert line.startswith(
        "span 10: dropper 9 with a length of 1.5 m is longer than the system height allows"
    )


def test_counts_of_spans_and_supports_must_fit(reference):
    (line,) = problems(reference.replace, supports=reference.supports[:-1])
    assert "10 supports for 10 spans" in line
    (line,) = problems(reference.replace, evaluated_spans=(11,))
    assert "span 11" in line
    assert problems(reference.replace, evaluated_spans=())[0].startswith("evaluated_spans is empty")


def test_zero_spans_are_refused(reference):
    (line,) = problems(
        cf.Catenary.regular,
        spans=0,
        span_length=60.0,
        droppers=[],
        contact_wire=reference.contact_wire,
        messenger_wire=reference.messenger_wire,
        support=reference.supports[0],
    )
    assert line == "spans = 0: must be a whole number from 1 to 10000"


def test_regular_spans_equal_the_reference_layout(reference):
    regular = cf.Catenary.regular(
        spans=10,
        span_length=60.0,
        droppers=reference.spans[0].droppers,
        contact_wire=reference.contact_wire,
        messenger_wire=reference.messenger_wire,
        support=reference.supports[0],
        name=reference.name,
        source=reference.source,
        damping=reference.damping,
        evaluated_spans=(5, 6),
    )
    assert regular == reference
    assert (regular.length, regular.dropper_spans.size) == (reference.length, reference.dropper_spans.size)
    assert regular == reference  # with arrays kept from the line above
    assert hash(regular) == hash(reference)
    assert regular != reference.replace(system_height=1.3)


@pytest.mark.parametrize(
    ("record", "said"),
    [
        ({"stages": [], "uplift_force": 1.0}, "stages: is empty"),
        ({"stages": [{"mass": 0.0, "stiffness": 1.0}], "uplift_force": 1.0}, "stages 1: mass = 0.0: must be"),
        ({"stages": [{"stiffness": 1.0}], "uplift_force": 1.0}, "stages 1: mass is missing"),
        ({"stages": [{"mass": 1.0, "stiffness": 1.0}]}, "uplift_force and mean_force: give exactly one"),
        (
            {"stages": [{"mass": 1.0, "stiffness": 1.0}], "mean_force": "EN 5"},
            "mean_force: 'EN 5' is neither",
        ),
    ],
)
def test_pantographs_that_cannot_work(record, said):
    assert problems(cf.Pantograph, **record)[0].startswith(said)


def test_mean_force_formulas():
    # EN 50367 (secondary source): 0.00097 v² + 70 N above 200 km/h
    assert cf.target_mean_force("EN 50367 AC", 300 / 3.6) == pytest.approx(157.3)
    assert cf.target_mean_force("EN 50367 AC", 200 / 3.6) == pytest.approx(0.00047 * 200**2 + 90)
    assert cf.target_mean_force("EN 50367 DC 3 kV", 50.0) == pytest.approx(0.00097 * 180**2 + 110)
    # of DC 1.5 kV only the formula above 200 km/h is known
    assert cf.target_mean_force("EN 50367 DC 1.5 kV", 50.0) == pytest.approx(0.00228 * 180**2 + 90)


def test_aerodynamic_force_adds_to_the_uplift(pantograph):
    windy = pantograph.replace(aerodynamic_force=cf.AerodynamicForce(quadratic=0.005, linear=0.1))
    assert windy.static_uplift(80.0) == pytest.approx(120 + 0.005 * 6400 + 8)
