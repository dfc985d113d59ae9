"""Key numbers of every figure of the paper, each with the reason for its tolerance.

The default run draws what takes seconds; ``-m slow`` draws all others.
"""

import json
from importlib import import_module
from pathlib import Path

import pytest

SCRIPTS = Path(__file__).parents[2] / "models" / "paper"

# why a number may differ from the one written down
EXACT = 1e-6  # a closed form, or an input
MESH = 0.01  # halving mesh and step moves it by less
SENSITIVE = (
    0.05  # an extreme or a deviation of a run: halving mesh and step moves it by up to 2 %, libraries by more
)

QUICK = {
    "fig01_segment_of_traction": {
        "wave speed of the contact wire (m/s)": (122.628, 1e-5),  # √(20 kN / 1.33 kg/m)
        "dropper force (N)": (103.88, MESH),  # 8 m of contact wire and half a dropper
        "sag of the messenger wire (m)": (0.4221, MESH),
    },
    "fig02_shift_splits_into_two_waves": {
        "height of each wave (mm)": (5.0, 0.005),  # half of the shift; the crest lies between nodes
        "speed of the crest over c": (1.0, 0.005),  # as far as the distance of nodes tells
    },
    "fig03_moving_force_space_time": {
        "V/c": (0.72487, 1e-5),
        "deflection under the force at 0.5 s, closed form (m)": (0.30657, 1e-5),
        "deflection under the force at 0.5 s, ANCF (m)": (0.30657, 0.005),  # the bound of the validation
    },
    "fig06_cell": {"span (m)": (48, EXACT), "droppers": (6, EXACT), "longest dropper (m)": (1.2687, MESH)},
    "fig07_bending_stiffness": {
        "largest deflection at 0.5 s (mm)": (278.5, MESH),
        "largest deflection of the string (mm)": (306.0, 0.002),  # at the node nearest to the force
        "waves above 1 mm ahead of the string's front (m)": (59.7, SENSITIVE),
    },
    "text_dispersion": {
        "phase velocity over c at k = 1 rad/m, S = 195 N m²": (1.00486, 1e-5),  # √(1 + S/T)
        "phase velocity over c at k = 1 rad/m, S = 200 kN m²": (3.31662, 1e-5),
    },
    "text_periodic_force": {
        "frequency ahead of the force (Hz)": (36.346, 1e-4),  # Doppler
        "frequency behind it (Hz)": (5.7976, 1e-4),
    },
}

SLOW = {
    "fig04_five_speeds": {
        "largest deflection at V = 0 c (m)": (0.30657, 1e-5),
        "largest deflection at V = 1.5 c (m)": (0.2453, 0.005),  # F t/(ρc) /(1 + V/c), between nodes
        "largest deflection at V = 2 c (m)": (0.2044, 0.005),
    },
    "fig05_rigid_supports": {
        "largest deflection, closed form (mm)": (28.4, MESH),
        "largest deflection under 200 N, ANCF (mm)": (28.4, SENSITIVE),
    },
    "fig08_supports_and_bending": {
        "largest deflection, regular, V = 0.725 c (mm)": (2.52, SENSITIVE),
        "largest deflection, regular, V = c (mm)": (2.84, SENSITIVE),
        "largest deflection, mistuned, V = 0.725 c (mm)": (3.58, SENSITIVE),
        "largest deflection behind the start, regular, V = c (mm)": (1.107, SENSITIVE),
        "largest deflection more than 6 m ahead of the force, regular, V = c (mm)": (1.041, SENSITIVE),
    },
    "fig09_low_frequency_mode": {
        "lowest symmetric mode (Hz)": (1.0475, 0.002),  # the mesh leaves 0.02 %
        "its half-waves along the line": (1, EXACT),
        "modes of bays in first shape below 20 Hz": (117, 0.03),  # a few lie between the kinds
        "modes of bays in second shape below 20 Hz": (59, 0.03),
    },
    "fig10_bays_in_first_and_second_shape": {
        "drawn mode in shape 1 (Hz)": (7.67, 0.02),  # a bay of 8 m alone
        "drawn mode in shape 2 (Hz)": (15.37, 0.02),
        "first mode with bays in shape 1 (Hz)": (6.889, 0.005),
    },
    "fig11_compliance": {
        "smallest compliance (mm/N)": (0.1561, MESH),
        "largest compliance (mm/N)": (0.4051, MESH),
        "non-uniformity (%)": (44.38, MESH),
    },
    "fig12_elastic_pantograph": {
        "force at 0.5 s, string, linear law (N)": (43.19, 0.005),  # 200 N exp(-k t/2√(Tρ))
        "force at 0.5 s, S = 200 kN m², linear law (N)": (44.64, MESH),
        "force at 0.5 s, string, law of points (N)": (15.28, MESH),
    },
    "fig13_two_wire_system": {
        "mean force, S = 195 N m² (N)": (139.64, MESH),
        "standard deviation, S = 195 N m² (N)": (9.84, SENSITIVE),
        "largest uplift under the pantograph, S = 195 N m² (mm)": (83.7, MESH),
    },
    "fig14_two_pantographs": {
        "mean force, trailing (N)": (139.4, MESH),
        "standard deviation, leading (N)": (10.39, SENSITIVE),
        "standard deviation, trailing (N)": (10.74, SENSITIVE),
    },
    "fig15_contact_force_wire_and_head": {
        "mean force (N)": (117.2, MESH),
        "standard deviation (N)": (32.1, SENSITIVE),
        "range of the wire's height (mm)": (27.5, SENSITIVE),
        "contact loss (%)": (0, EXACT),
    },
    "text_critical_speed_with_bending": {
        "deflection under the force, S = 200 kN m² (mm)": (195.4, MESH),
        "steepest slope, S = 200 kN m²": (0.02073, MESH),
        "steepest slope, S = 2 kN m²": (0.1002, SENSITIVE),
    },
    "text_deflection_against_speed": {
        "free, any V up to c (mm/N)": (1.53285, 1e-4),  # F t/(2ρc)
        "supported, largest of all speeds (mm/N)": (0.1486, MESH),
        "two-wire at V = 0.7 c (mm/N)": (0.583, SENSITIVE),
        "two-wire, V/c of the largest": (1.0, 0.06),  # the grid of speeds
    },
    "text_distance_of_two_pantographs": {
        "trailing, largest (N)": (26.5, SENSITIVE),
        "trailing, distance of the largest (m)": (79, 0.08),  # the grid of distances
        "trailing, smallest (N)": (8.87, SENSITIVE),
    },
    "text_mistuned_supports": {
        "regular: largest deflection (mm)": (2.55, SENSITIVE),
        "moved by up to 1 m: largest deflection (mm)": (5.89, SENSITIVE),
    },
    "text_modal_truncation": {
        "elastic pantograph: error of the wire's height, 20 Hz (%)": (14.9, SENSITIVE),
    },
}

# differences between two ways to the same number, in %: the validation's bounds, or the reason beside them
LIMITS = {
    "fig02_shift_splits_into_two_waves": {"largest difference to the closed form (%)": 0.5},
    "fig03_moving_force_space_time": {"difference at 0.5 s (%)": 0.5},
    "fig04_five_speeds": {
        "difference at V = 0 c (%)": 0.5,
        "difference at V = 0.5 c (%)": 0.5,
        "difference at V = 1 c (%)": 3.0,  # the front is a jump
        "difference at V = 1.5 c (%)": 0.5,
        "difference at V = 2 c (%)": 0.5,
    },
    "fig05_rigid_supports": {"largest difference, linear (%)": 1.0},
    "fig07_bending_stiffness": {"difference between ANCF and lines at 0.5 s (%)": 0.2},
    "fig08_supports_and_bending": {
        "difference, regular, V = 0.725 c (%)": 1.0,
        "difference, regular, V = c (%)": 1.0,
        "difference, mistuned, V = 0.725 c (%)": 1.0,
    },
    "fig11_compliance": {
        "downward against upward, largest difference (%)": 0.01,  # 1 N is little: statics is linear there
        # above 100 Hz an infinite wire stands for the modes, which has neither droppers nor supports
        "modes against statics, largest difference (%)": 1.0,
    },
    "fig12_elastic_pantograph": {
        "difference to the closed form, string (%)": 0.5,
        "difference to the lines, string, linear law (%)": 0.5,
        "difference to the lines, S = 200 kN m², linear law (%)": 0.2,
        "difference to the lines, string, law of points (%)": 0.5,
    },
    "fig13_two_wire_system": {"influence of the bending stiffness on the force (N, rms)": 1.0},
    "fig15_contact_force_wire_and_head": {
        "force balance of the masses, 0 to 20 Hz (N, rms)": 0.5,  # differences over steps of 1 ms up to 20 Hz
    },
    "text_critical_speed_with_bending": {"ANCF against method of lines, S = 200 kN m² (%)": 0.2},
    "text_deflection_against_speed": {
        "modes against ANCF up to 0.75 c, largest difference (%)": 2.0,  # modes above 100 Hz
        # at c short waves pile up at the force, and droppers near it give way to 50 N
        "modes against ANCF at c and above, largest difference (%)": 5.0,
    },
    "text_dispersion": {
        "measured against the relation, S = 0 N m², largest difference (%)": 0.2,
        "measured against the relation, S = 195 N m², largest difference (%)": 0.2,
        # (ωΔt)²/12 at the shortest wave, 1800 rad/s
        "measured against the relation, S = 200 kN m², largest difference (%)": 0.3,
    },
    "text_modal_truncation": {
        # what is left of modes above 200 Hz and of the full run's integration in time
        "constant force: error of the wire's height, 200 Hz (%)": 1.0,
        "elastic pantograph: error of the wire's height, 200 Hz (%)": 1.0,
        "two-mass pantograph: error of the wire's height, 200 Hz (%)": 1.5,
    },
    "text_periodic_force": {"difference at 0.5 s (%)": 0.5, "difference under the force (%)": 0.5},
}

NAMES = [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in SLOW)]


def test_every_script_is_pinned():
    scripts = {p.stem for p in SCRIPTS.glob("*.py")} - {"paper_common"}
    assert scripts == set(QUICK) | set(SLOW)
    assert {int(name[3:5]) for name in scripts if name.startswith("fig")} == set(range(1, 16))


@pytest.mark.parametrize("name", NAMES)
def test_figure(name, tmp_path):
    numbers = import_module(name).main(tmp_path)
    for key, (value, share) in (QUICK | SLOW)[name].items():
        assert numbers[key] == pytest.approx(value, rel=share), key
    for key, limit in LIMITS.get(name, {}).items():
        assert 0 <= numbers[key] <= limit, key
    assert (tmp_path / f"{name}.png").stat().st_size > 10_000
    facts = json.loads((tmp_path / f"{name}.json").read_text())
    assert facts["numbers"] == numbers
    assert len(facts["caption"]) > 80
