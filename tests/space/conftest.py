"""Short lines in space."""

import pytest

import catenary_fe as cf


@pytest.fixture(scope="session")
def staggered(reference_layout) -> cf.Catenary:
    """Four spans of the AC simple model, its messenger wire over the track's centre."""
    line = cf.load_catenary(reference_layout.parent / "en50318_2018_ac_simple.toml")
    return line.replace(spans=line.spans[:4], supports=line.supports[:5], evaluated_spans=(3,))


@pytest.fixture(scope="session")
def staggered_shape(staggered) -> cf.Shape:
    return cf.find_form(staggered)


@pytest.fixture(scope="session")
def following(staggered) -> cf.Catenary:
    """The same line with the messenger wire above the contact wire: droppers do not lean."""
    supports = tuple(s.replace(messenger_stagger=s.stagger) for s in staggered.supports)
    return staggered.replace(supports=supports)


@pytest.fixture(scope="session")
def flat(short) -> cf.Catenary:
    """A line that lies in the vertical plane, its arms springs without mass."""
    arm = cf.SteadyArm(stiffness=300.0)
    return short.replace(supports=(cf.Support(messenger_stiffness=5e5, steady_arm=arm),) * 5)
