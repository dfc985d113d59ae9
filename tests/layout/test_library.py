"""The library: everything in it loads, has a source, and is found by its name."""

import pytest

import catenary_fe as cf


@pytest.mark.parametrize("name", cf.library.names("wires"))
def test_wires(name):
    wire = cf.library.wire(name, tension=20e3)
    assert wire.source
    assert 80 < wire.wave_speed < 300
    assert wire.tension / wire.axial_stiffness < 0.01


@pytest.mark.parametrize("name", cf.library.names("pantographs"))
def test_pantographs(name):
    pantograph = cf.library.pantograph(name)
    assert pantograph.source
    assert pantograph.name == name
    assert 10 < sum(stage.mass for stage in pantograph.stages) < 41  # the GPU has 40.1


def test_the_names_that_the_field_uses():
    wanted = {"EN 50318:2002", "EN 50318:2018 AC", "DSA380", "DSA250", "SSS400+"}
    assert wanted <= set(cf.library.names("pantographs"))


def test_published_values_carry_over():
    # EN 50318:2018 AC, secondary source
    stages = cf.library.pantograph("EN 50318:2018 AC").stages
    assert [(s.mass, s.stiffness, s.damping) for s in stages] == [
        (7.5, 7000, 45),
        (9, 15500, 0.1),
        (6, 160, 100),
    ]


def test_unknown_names_list_the_near_ones():
    with pytest.raises(cf.InputError, match="'DSA380', 'DSA250'"):
        cf.library.pantograph("DSA 381")


def test_names_are_found_whatever_the_case():
    assert cf.library.pantograph("dsa380").name == "DSA380"


@pytest.mark.parametrize("name", cf.library.names("lines"))
def test_lines(name):
    line = cf.library.line(name)
    arm = cf.SteadyArm(stiffness=200.0, mass=0.5)
    shape = cf.find_form(line.catenary(spans=3, steady_arm=arm))
    assert abs(shape.height_errors).max() < 1e-4
    assert len(shape.stitch_wires) == (2 if line.stitch_wire else 0)
    assert shape.catenary.is_spatial == (line.stagger is not None)
