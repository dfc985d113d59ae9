"""What form finding refuses, from both sides of each limit."""

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.statics.rules import check_arms, check_pulls, check_room, check_stretch


@pytest.fixture
def linked(reference):
    """Three spans with links, the second of the two inner supports without one."""
    link = cf.SteadyArm(length=1.0, mass_per_length=0.7)
    support = reference.supports[1].replace(steady_arm=link, stagger=0.2)
    bare = support.replace(steady_arm=None, stagger=0.0)
    return reference.replace(
        spans=reference.spans[:4], supports=(support, bare, support, support, support), evaluated_spans=None
    )


def forces(left, up, support=2):
    """[N], shape (1, 5, 2), sound ones but for one support."""
    found = np.full((1, 5, 2), 200.0)
    found[0, support] = left, up
    return found


def test_droppers_may_pull_a_little_but_not_push(reference):
    pulls = np.full(len(reference.droppers), 0.5)
    check_pulls(reference, pulls)
    check_pulls(reference, 0 * pulls)
    pulls[[1, 9]] = -0.1
    with pytest.raises(cf.InputError) as caught:
        check_pulls(reference, pulls)
    assert len(caught.value.problems) == 2
    assert caught.value.problems[1].startswith("span 2: dropper 1 at 5 m would have to push with 0.1 N")


def test_droppers_need_some_room(reference):
    heights = np.full(len(reference.droppers), 1e-3)
    check_room(reference, heights)
    heights[3] = 0.0
    with pytest.raises(cf.InputError, match=r"span 1: dropper 4 at .* lies 0\.000 m below its"):
        check_room(reference, heights)


def test_droppers_may_stretch_but_not_from_nothing(reference):
    distances = np.full(len(reference.droppers), 1.0)
    tensions = 0.999e5 * distances  # their stiffness is 100 kN/m
    check_stretch(reference, distances, tensions)
    tensions[10] = 1.001e5
    with pytest.raises(cf.InputError) as caught:
        check_stretch(reference, distances, tensions)
    assert caught.value.problems == (
        "span 2: dropper 2 at 10.5 m: stiffness = 100000 N/m is too small: its tension of 100100 N would"
        " stretch it by 1 m, and it spans 1 m; raise it, look at its unit",
    )


def test_a_dropper_far_too_soft_is_named_by_its_stiffness(reference):
    soft = [d.replace(stiffness=1e-3) if d.position == 30.0 else d for d in reference.spans[1].droppers]
    spans = (reference.spans[0], reference.spans[1].replace(droppers=soft), *reference.spans[2:4])
    line = reference.replace(spans=spans, supports=reference.supports[:5], evaluated_spans=None)
    with pytest.raises(
        cf.InputError, match=r"^span 2: dropper 5 at 30 m: stiffness = 0\.001 N/m is too"
    ) as e:
        cf.find_form(line)
    assert len(e.value.problems) == 1


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_links_need_a_pull(linked, side):
    check_arms(linked, forces(1.0 * side, 0.5))
    with pytest.raises(cf.InputError, match=r"support 3: no lateral force on the steady arm \(0\.99 N\)"):
        check_arms(linked, forces(0.99 * side, 0.5))


def test_links_stand_up_by_60_degrees_at_most(linked):
    check_arms(linked, forces(100.0, 100 * np.tan(np.radians(59.9))))
    with pytest.raises(cf.InputError, match="support 3: the steady arm would stand up by 60°"):
        check_arms(linked, forces(100.0, 100 * np.tan(np.radians(60.1))))
    with pytest.raises(cf.InputError, match="support 4: the steady arm would stand up by 80°"):
        check_arms(linked, forces(100.0, 100 * np.tan(np.radians(80)), support=3))


def test_arms_do_not_hold_the_wire_down(linked, reference):
    check_arms(linked, forces(100.0, -5.0))
    with pytest.raises(
        cf.InputError, match="support 3: the steady arm would have to hold the contact wire down"
    ):
        check_arms(linked, forces(100.0, -5.1))
    low = reference.supports[4].replace(contact_wire_height=reference.contact_wire_height - 0.5)
    supports = (*reference.supports[:4], low, *reference.supports[5:])
    with pytest.raises(
        cf.InputError, match="support 5: the steady arm would have to hold the contact wire down"
    ):
        cf.find_form(reference.replace(supports=supports))


def test_links_pull_to_their_own_side(linked):
    left = linked.supports[2].replace(steady_arm=linked.supports[2].steady_arm.replace(side="left"))
    line = linked.replace(supports=(*linked.supports[:2], left, *linked.supports[3:]))
    check_arms(line, forces(2.0, 1.0))
    with pytest.raises(cf.InputError, match="support 3: the arm on the left would have to push with 2 N"):
        check_arms(line, forces(-2.0, 1.0))
