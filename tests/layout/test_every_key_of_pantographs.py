"""Every key of every kind of pantograph acts, is refused, or is shown: each one's value is changed once."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

import catenary_fe as cf
from catenary_fe.layout import pantograph_schema
from catenary_fe.views.report.tables import _pantograph_table
from tests.layout.test_every_key_acts import keys, put

EXAMPLES = Path(__file__).parents[2] / "docs/reference/examples"
PANTOGRAPH: dict[str, Any] = {
    "name": "another", "source": "elsewhere", "stages.mass": 8.0, "stages.stiffness": 5e3,
    "stages.damping": 20.0, "stages.damping_up": 5.0, "stages.damping_down": 140.0, "stages.friction": 3.0,
    "stages.travel": [0.03, 0.04], "stages.stop_stiffness": 2e5,
    "uplift_force": 130.0, "mean_force": "EN 50367 DC 3 kV",
    "aerodynamic_force.quadratic": 0.02, "aerodynamic_force.linear": 0.2, "contact_stiffness": 6e4,
    "contact_damping": 5.0, "base": "rail", "head.width": 1.0, "head.spring_distance": 0.6,
    "head.roll_inertia": 2.0,
    "head.strips": 1, "head.strip_distance": 0.4,
    "head.pitch_inertia": 0.7, "head.pitch_spring_distance": 0.3,
    "head.bending_frequencies": [50.0], "head.bending_damping": 0.03,
    "aerodynamic_force.trailing": [0.01, 0.0], "knuckle": "leading",
    "stages.aerodynamic_force.quadratic": 0.01, "stages.aerodynamic_force.linear": 0.1,
    "stages.aerodynamic_force.trailing": [0.01, 0.0],
}  # fmt: skip
ELASTIC: dict[str, Any] = {
    "base": "rail",
    "force": 250.0,
    "stiffness": 900.0,
    "law": [[0.0, 150.0], [0.1, 90.0]],
}
RECEPTANCE: dict[str, Any] = {"receptance": "", "order": 1, "static_stiffness": 0.0, "head_width": 1.9}
LINKAGE: dict[str, Any] = {
    "lower_arm.length": 1.55, "lower_arm.mass": 25.0, "lower_arm.centre": 0.7, "lower_arm.inertia": 6.0,
    "upper_arm.length": 2.1, "upper_arm.mass": 15.0, "upper_arm.centre": 0.8, "upper_arm.inertia": 5.0,
    "upper_arm.lever": 0.21, "upper_arm.lever_angle": 3.4,
    "coupling_rod.length": 1.66, "coupling_rod.mass": 6.0, "coupling_rod.centre": 0.8,
    "coupling_rod.inertia": 1.0, "coupling_rod.pivot": [-0.2, -0.3], "apex_mass": 7.0,
    "head_stages.mass": 8.0, "head_stages.stiffness": 5e3, "head_stages.damping": 20.0,
    "pivot_height": 3.8, "head_height": 0.1, "working_height": 5.2, "reach": [0.5, 2.5],
    "stop_stiffness": 2e5, "drive.torque": 1400.0, "drive.bellows_stiffness": 200.0, "drive.lag": 0.3,
    "damper.up": 500.0, "damper.down": 500.0, "joint_friction": 1.0,
    "head_stages.damping_up": 5.0, "head_stages.damping_down": 5.0, "head_stages.friction": 2.0,
    "head_stages.travel": [0.03, 0.04], "head_stages.stop_stiffness": 1e5,
    "head_stages.aerodynamic_force.quadratic": 0.01, "head_stages.aerodynamic_force.linear": 0.1,
    "head_stages.aerodynamic_force.trailing": [0.01, 0.0],
}  # fmt: skip


def test_a_value_is_known_for_every_key_of_pantographs():
    found = set(keys(pantograph_schema(), pantograph_schema()))
    assert sorted(found) == sorted(PANTOGRAPH | ELASTIC | RECEPTANCE | LINKAGE)


STRIPS = {"spring_distance": 0.7, "strips": 2, "strip_distance": 0.5}
STAGES = [{"mass": 7.0, "stiffness": 4e3, "damping": 10.0}, {"mass": 14.0, "stiffness": 50.0}]
PUSHED = {"name": "pushed", "uplift_force": 120.0, "stages": STAGES, "head": STRIPS}
BESIDE: dict[str, dict[str, Any]] = {
    "damping_up": {"damping": 0.0, "damping_up": 20.0, "damping_down": 30.0},
    "damping_down": {"damping": 0.0, "damping_up": 20.0, "damping_down": 30.0},
    "stop_stiffness": {"travel": [0.02, 0.02]},
}
AIR = {"quadratic": 0.005, "trailing": [0.004, 0.1]}
TOGETHER: dict[str, dict[str, Any]] = {  # the base for keys that act with others
    "head.pitch_inertia": {"head": STRIPS | {"pitch_inertia": 0.5, "pitch_spring_distance": 0.2}},
    "head.bending_frequencies": {"head": {"bending_frequencies": [60.0]}},
    "knuckle": {"aerodynamic_force": AIR, "knuckle": "trailing"},
    "aerodynamic_force.trailing": {"aerodynamic_force": AIR, "knuckle": "trailing"},
    "stages.aerodynamic_force.trailing": {"aerodynamic_force": AIR, "knuckle": "trailing"},
}
TOGETHER["head.pitch_spring_distance"] = TOGETHER["head.pitch_inertia"]
TOGETHER["head.bending_damping"] = TOGETHER["head.bending_frequencies"]
SET = {"name": "set", "mean_force": "EN 50367 AC", "stages": STAGES}


def known_of(pantograph: cf.Pantograph) -> list[Any]:
    """What is computed from a pantograph before it runs."""
    found = [pantograph.assemble(spatial=True, speed=70.0)]
    return [*found, pantograph.static_uplift(70.0), pantograph.target_mean_force(70.0)]


@pytest.mark.parametrize("place", PANTOGRAPH)
def test_a_key_of_a_pantograph_acts(place):
    base: dict[str, Any] = SET if place == "mean_force" else PUSHED
    key = place.removeprefix("stages.")
    base = base | TOGETHER.get(place, {})
    if key in BESIDE:  # they act with another one
        base = base | {"stages": [STAGES[0] | BESIDE[key], STAGES[1]]}
    before, changed = cf.Pantograph(**base), put(base, place, PANTOGRAPH[place])
    if place == "head.strips":
        with pytest.raises(cf.InputError, match="strips = 2 and strip_distance belong together"):
            cf.Pantograph(**changed)
        return
    after = cf.Pantograph(**changed)
    if place in ("name", "source"):
        assert str(_pantograph_table(after.name, after)) != str(_pantograph_table(before.name, before))
    else:
        assert known_of(after) != known_of(before)


@pytest.mark.parametrize("key", ELASTIC)
def test_a_key_of_an_elastic_pantograph_acts(key):
    base: dict[str, Any] = {"force": 200.0, "stiffness": 500.0}
    changed = {key: ELASTIC[key]} if key == "law" else base | {key: ELASTIC[key]}
    before, after = (cf.ElasticPantograph.model_validate(record) for record in (base, changed))
    assert before.assemble(spatial=False) != after.assemble(spatial=False)
    if key == "law":  # beside a force, it is refused
        with pytest.raises(cf.InputError, match="give exactly one"):
            cf.ElasticPantograph(**base, law=ELASTIC["law"])


@pytest.mark.parametrize(
    "key", ["receptance", "order", "static_stiffness", "head_width", "base", "uplift_force"]
)
def test_a_key_of_a_pantograph_by_its_receptance_acts(key):
    frequencies = [0.2 * 1.2**n for n in range(30)]
    response = cf.pantograph_response(cf.Pantograph(**(PUSHED | {"head": None})), frequencies).as_dict()
    rows = [list(row) for row in zip(*response["receptance"].values(), strict=True)]
    base: dict[str, Any] = {"receptance": rows, "uplift_force": 100.0}
    values = RECEPTANCE | {"receptance": [[f, 0.9 * z, phase] for f, z, phase in rows]} | PANTOGRAPH
    before, after = (cf.ReceptancePantograph(**record) for record in (base, base | {key: values[key]}))
    assert (*known_of(before), before.panhead) != (*known_of(after), after.panhead)


@pytest.mark.parametrize("place", LINKAGE)
def test_a_key_of_a_mechanism_acts(place):
    base = tomllib.loads((EXAMPLES / "pantograph_linkage.toml").read_text(encoding="utf-8"))
    if "aerodynamic_force" in place:  # refused beside a mean force
        del base["mean_force"]
        base |= {"uplift_force": 80.0, "aerodynamic_force": AIR, "knuckle": "trailing"}
    before = cf.LinkagePantograph.model_validate(base)
    changed = put(base, place, LINKAGE[place])
    beside = {"drive.torque": "give exactly one", "head_stages.damping_up": "give both or neither",
              "head_stages.damping_down": "give both or neither",
              "head_stages.stop_stiffness": "give both or neither"}  # fmt: skip
    if place in beside:
        with pytest.raises(cf.InputError, match=beside[place]):
            cf.LinkagePantograph(**changed)
        if place != "drive.torque":
            return
        changed.pop("mean_force")
    after = cf.LinkagePantograph.model_validate(changed)
    assert known_of(after) != known_of(before)
