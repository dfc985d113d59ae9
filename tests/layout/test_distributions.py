"""Distributions: moments in closed form, what they refuse; members of places and their nominal values."""

import numpy as np
import pytest
from scipy.stats import norm

import catenary_fe as cf
from catenary_fe.layout.members import members_of_line, members_of_pantograph
from catenary_fe.layout.variation import Variable
from catenary_fe.studies.sampling import unit_cube

SAMPLES = 2**13


def drawn(nominal=10.0, **kind):
    cube = unit_cube("sobol", SAMPLES, 1, 3)
    return np.array(cf.Distribution(**kind).draw(cube, [nominal], "x"))[:, 0]


def truncated(t):
    """Standard deviation of a normal distribution without what lies beyond t deviations."""
    return np.sqrt(1 - 2 * t * norm.pdf(t) / (2 * norm.cdf(t) - 1))


@pytest.mark.parametrize(
    ("kind", "mean", "deviation"),
    [
        ({"normal": 0.5}, 10.0, 0.5 * truncated(3.0)),
        ({"normal": 0.5, "truncate": 1.0}, 10.0, 0.5 * truncated(1.0)),
        ({"relative_normal": 0.1, "truncate": 8.0}, 10.0, 1.0),
        ({"uniform": [2.0, 5.0]}, 3.5, 3.0 / np.sqrt(12)),
        ({"relative_uniform": 0.1}, 10.0, 2.0 / np.sqrt(12)),
        ({"integers": [3, 6]}, 4.5, np.sqrt(15 / 12)),
        ({"values": [1.0, 4.0]}, 2.5, 1.5),
    ],
)
def test_moments_are_those_of_the_closed_form(kind, mean, deviation):
    values = drawn(**kind)
    assert values.mean() == pytest.approx(mean, rel=1e-3)
    assert values.std() == pytest.approx(deviation, rel=3e-3)
    assert values.std() != pytest.approx(1.02 * deviation, rel=3e-3)


def test_normal_values_end_where_they_are_truncated():
    assert 2.4 < np.abs(drawn(normal=1.0, truncate=2.5) - 10.0).max() <= 2.5
    assert drawn(nominal=-10.0, relative_normal=0.1).std() > 0.9  # of a negative value, too


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ({}, "gives no distribution; give one of normal"),
        ({"normal": 1.0, "uniform": [0.0, 1.0]}, "gives normal and uniform; give one of"),
        ({"uniform": [1.0, 0.0]}, "must not be above"),
        ({"uniform": [0.0, 1.0], "truncate": 2.0}, "truncate has no effect beside uniform"),
        ({"values": []}, "values is empty"),
        ({"normal": -1.0}, "at least 0"),
        ({"integers": [1.5, 2]}, "whole number"),
    ],
)
def test_what_is_no_distribution(kind, said):
    with pytest.raises(cf.InputError, match=said):
        cf.Distribution(**kind)


@pytest.mark.parametrize(("nominal", "said"), [(0.0, "a share is nothing"), (None, "no value of its own")])
def test_a_share_of_nothing_is_refused(nominal, said):
    with pytest.raises(cf.InputError, match=said):
        drawn(nominal, relative_normal=0.1)


def test_members_and_their_nominal_values(reference_layout):
    variable = Variable(reference_layout.with_name("re330.toml"))
    droppers = members_of_line(variable, "span.*.droppers.*")
    assert droppers.places[:2] == ("span.1.droppers.1", "span.1.droppers.2")
    assert droppers.nominal[:2] == (5.0, 14.17)
    assert droppers.changes(range(7))["span.1.droppers.7"] == 6
    # what the file leaves out: the library's, and defaults
    mass = cf.library.wire_record("AC-120 CuMg")["mass_per_length"]
    assert members_of_line(variable, "contact_wire.mass_per_length").nominal == (mass,)
    assert members_of_line(variable, "cant_base").nominal == (1.5,)
    assert members_of_line(variable, "conditions.wind.speed").nominal == (None,)
    assert members_of_pantograph("DSA380", "stages.*.mass").nominal == tuple(
        stage.mass for stage in cf.library.pantograph("DSA380").stages
    )
    with pytest.raises(cf.InputError, match="did you mean 'tension'"):
        members_of_line(variable, "contact_wire.tensoin")
    with pytest.raises(cf.InputError, match="did you mean 'wind'"):
        members_of_line(variable, "conditions.wnd.speed")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "contact_wire.tension = { normal = 1.0 }",
            r'contact_wire: write the whole place in quotes, .*"contact',
        ),
        ('"contact_wire.tension" = 3.0', "contact_wire.tension = 3.0: must be a table"),
        (
            '"contact_wire.tension" = { norml = 1.0 }',
            "contact_wire.tension: unknown key norml; did you mean 'no",
        ),
    ],
)
def test_faults_of_a_study_name_the_place(tmp_path, text, said):
    path = tmp_path / "study.toml"
    path.write_text(f'layout = "x"\npantographs = ["y"]\nspeed_kmh = [200]\n[scatter]\n{text}\n')
    with pytest.raises(cf.InputError, match=said):
        cf.load_study(path)


def test_files_are_found_from_where_the_study_is(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(
        'layout = "a/x.toml"\npantographs = ["DSA380", "p.toml"]\nspeed_kmh = [200]\nconditions = "c.toml"\n'
    )
    study = cf.load_study(path)
    assert study.layout == str(tmp_path / "a" / "x.toml")
    assert study.pantographs == ("DSA380", str(tmp_path / "p.toml"))
    assert study.conditions == str(tmp_path / "c.toml")
