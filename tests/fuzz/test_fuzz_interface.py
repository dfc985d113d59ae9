"""Nonsense for every argument of the public interface: each is refused in one clear line, none is taken.

No call here is allowed to compute anything: a value that is taken is a fault, as is another error.
"""

from types import SimpleNamespace

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe import views
from catenary_fe.views.film import film

NAN, ARRAY, THING = float("nan"), np.ones((2, 2)), object()
NUMBER = ("x", b"x", NAN, float("inf"), True, [], {}, THING, 1 + 2j, ARRAY)
POSITIVE = (*NUMBER, -1.0, 0.0)
WHOLE = ("x", 1.5, NAN, True, [], -1, 0, THING, ARRAY)
NUMBERS = ("x", ["x"], [NAN], [None], {}, THING, [[1.0], [1.0, 2.0]], [True])
PLACES = (*NUMBERS, 1e4, -1.0, [20.0, 1e4])
SPANS = ("x", 3, [0], [99], [-1], [1.5], [True], ["1"], [None], [], THING)
OBJECT = ("x", 3, None, [], {}, THING, True, ARRAY)
PATH = (3, 1.5, None, [], {}, THING, b"x", True)
CHOICE = ("x", "", 3, None, [], THING, ARRAY)
FUNCTION = ("x", 3, [], THING)

WIRE = cf.Wire(mass_per_length=1.0, tension=1e4, axial_stiffness=1e7)
ARM, DROPPER, NODES = cf.SteadyArm(stiffness=100.0), cf.Dropper(position=5.0), np.linspace(0, 50, 26)
EQUAL = {
    "spans": 3, "span_length": 50.0, "droppers": [DROPPER], "contact_wire": WIRE, "messenger_wire": WIRE,
    "support": cf.Support(steady_arm=ARM),
}  # fmt: skip
PLACES_MEASURED = np.arange(100.0, 200.0, 0.2)
TEST = cf.LineTest([cf.MeasuredPass(position=PLACES_MEASURED, force=100 + np.sin(PLACES_MEASURED))])
ELASTIC, RULE = cf.ElasticPantograph(force=100.0), "EN 50367 AC"


@pytest.fixture(scope="module")
def given(short, short_shape, short_run, pantograph):
    """What calls need besides the argument that is nonsense."""
    modes = cf.solve_modes(short_shape, count=3)
    ran = cf.modal_run(short_shape, modes, ELASTIC, speed=50.0, step=0.02)
    return SimpleNamespace(
        line=short, shape=short_shape, run=short_run, head=pantograph, modes=modes, ran=ran,
        wire=cf.WireProblem(wire=WIRE, x=NODES),
        session=cf.stepping(short_shape, [pantograph], speed=50.0),
    )  # fmt: skip


def equal(name):
    return lambda g, bad: cf.Catenary.regular(**(EQUAL | {name: bad}))


def simulated(name):
    return lambda g, bad: cf.simulate(g.shape, [g.head], **({"speed": 50.0} | {name: bad}))


def stepped(name):
    return lambda g, bad: cf.stepping(g.shape, [g.head], **({"speed": 50.0} | {name: bad}))


def step(name):
    return lambda g, bad: g.session.step(**{name: bad})


def modal(name):
    return lambda g, bad: cf.modal_run(g.shape, g.modes, ELASTIC, **({"speed": 50.0} | {name: bad}))


def problem(name):
    return lambda g, bad: cf.WireProblem(**({"wire": WIRE, "x": NODES} | {name: bad}))


def sliding(name):
    values = {"pantograph": cf.library.pantograph("DSA250"), "uplift": 100.0, "speed": 50.0}
    return lambda g, bad: cf.SlidingPantograph(**(values | {name: bad}))


def graded(name):
    values = {"fixed": [0.0, 10.0], "element": 1.0, "kinks": [5.0], "finest": 0.1}
    return lambda g, bad: cf.graded_nodes(**(values | {name: bad}))


def scattered(name):
    study = cf.Study(layout="no.toml", pantographs=["DSA250"], speed_kmh=[200])
    return lambda g, bad: cf.run_scatter(study, **({"samples": 2, "folder": "x"} | {name: bad}))


def line_test(name):
    return lambda g, bad: cf.compare_with_line_test(g.run, TEST, **{name: bad})


CALLS = {
    "load_catenary": (lambda g, b: cf.load_catenary(b), PATH),
    "load_pantograph": (lambda g, b: cf.load_pantograph(b), PATH),
    "pantograph_response": (lambda g, b: cf.pantograph_response(b), OBJECT),
    "pantograph_response: frequencies": (
        lambda g, b: cf.pantograph_response(g.head, b), (*NUMBERS, [], [0.0], [-1.0], 3.0, ARRAY)
    ),
    "pantograph_response: speed": (lambda g, b: cf.pantograph_response(g.head, speed=b), (*NUMBER, -1.0)),
    "receptance_table": (lambda g, b: cf.receptance_table(b, "head.csv"), OBJECT),
    "receptance_table: path": (lambda g, b: cf.receptance_table(g.head, b), PATH),
    "ReceptancePantograph": (
        lambda g, b: cf.ReceptancePantograph(receptance=b, uplift_force=90.0),
        (*NUMBERS, "head.csv", [], [[1.0, 1e-3, -90.0]], [[1.0, 1e-3, -90.0]] * 20),
    ),
    "load_conditions": (lambda g, b: cf.load_conditions(b), PATH),
    "load_study": (lambda g, b: cf.load_study(b), PATH),
    "run_scatter": (lambda g, b: cf.run_scatter(b, samples=2, folder="x"), OBJECT),
    "run_scatter: samples": (scattered("samples"), (*WHOLE, 1)),
    "run_scatter: folder": (scattered("folder"), PATH),
    "run_scatter: sensitivity": (scattered("sensitivity"), ("x", 1, None, [], ARRAY)),
    "run_scatter: sampling": (scattered("sampling"), ("x", "", 3, [], THING, ARRAY)),
    "run_scatter: progress": (scattered("progress"), FUNCTION),
    "optimise": (lambda g, b: cf.optimise(b), OBJECT),
    "DesignProblem": (lambda g, b: cf.DesignProblem(b, folder="x"), OBJECT),
    "settle": (lambda g, b: cf.settle(b, cf.Conditions()), OBJECT),
    "settle: conditions": (lambda g, b: cf.settle(g.shape, b), (*OBJECT[:3], *OBJECT[4:], [3], [None])),
    "case_rows": (lambda g, b: cf.case_rows(b), OBJECT),
    "load_run": (lambda g, b: cf.load_run(b), (*PATH, "missing.nc", "")),
    "join_sections": (lambda g, b: cf.join_sections(b, []), OBJECT),
    "join_sections: overlaps": (lambda g, b: cf.join_sections([g.line, g.line], b), OBJECT),
    "save_catenary": (lambda g, b: cf.save_catenary(b, "line.toml"), OBJECT),
    "save_catenary: path": (lambda g, b: cf.save_catenary(g.line, b), PATH),
    "catenary_from_tables": (lambda g, b: cf.catenary_from_tables(b, base=g.line), PATH),
    "catenary_from_tables: base": (lambda g, b: cf.catenary_from_tables("no.csv", base=b), OBJECT[1:]),
    "build_line": (lambda g, b: cf.build_line(b, [50.0] * 4), OBJECT),
    "build_line: span_lengths": (lambda g, b: cf.build_line("Re 330", b), NUMBERS),
    "layout_warnings": (lambda g, b: cf.layout_warnings(b), OBJECT),
    "find_form": (lambda g, b: cf.find_form(b), OBJECT),
    "find_form: mesh": (lambda g, b: cf.find_form(g.line, b), OBJECT[:2]),
    "find_heights": (lambda g, b: cf.find_heights(b), OBJECT),
    "find_heights: lengths": (lambda g, b: cf.find_heights(g.line, b), (*NUMBERS, [1.0], -1.0)),
    "against_design": (lambda g, b: cf.against_design(b), OBJECT),
    "against_design: design": (lambda g, b: cf.against_design(g.shape, b), OBJECT[:2]),
    "read_measured": (lambda g, b: cf.read_measured(b), PATH),
    "fit_measured": (lambda g, b: cf.fit_measured(b, cf.MeasuredWire([0.0], [5.3])), OBJECT),
    "fit_measured: measured": (lambda g, b: cf.fit_measured(g.line, b), OBJECT),
    "MeasuredWire: x": (lambda g, b: cf.MeasuredWire(b, [5.3, 5.3]), (*NUMBERS, [1.0], [2.0, 1.0])),
    "MeasuredWire: height": (lambda g, b: cf.MeasuredWire([0.0, 1.0], b), (*NUMBERS, [1.0], [53.0, 5.3])),
    "read_line_test": (lambda g, b: cf.read_line_test(b), (*PATH, "missing.csv", "run.nc", [], [3])),
    "read_line_test: columns": (lambda g, b: cf.read_line_test("no.csv", columns=b), (*OBJECT[:2], {3: "x"})),
    "read_line_test: support": (lambda g, b: cf.read_line_test("no.csv", support=b), WHOLE),
    "compare_with_line_test": (lambda g, b: cf.compare_with_line_test(b, TEST), OBJECT),
    "compare_with_line_test: test": (lambda g, b: cf.compare_with_line_test(g.run, b), OBJECT),
    "compare_with_line_test: shift": (line_test("shift"), (*NUMBER, 1e4)),
    "compare_with_line_test: speed": (line_test("speed"), (*POSITIVE, 300.0)),
    "compare_with_line_test: pantograph": (line_test("pantograph"), ("x", 1.5, None, -1, 1, True)),
    "compare_with_line_test: filter": (line_test("filter"), CHOICE),
    "compare_with_line_test: is_filtered": (line_test("is_filtered"), ("x", 1, None, [], ARRAY)),
    "LineTest": (lambda g, b: cf.LineTest(b), (*OBJECT, [3])),
    "MeasuredPass: position": (lambda g, b: cf.MeasuredPass(position=b, force=[1.0, 2.0]), NUMBERS),
    "MeasuredPass: force": (lambda g, b: cf.MeasuredPass(position=[1.0, 2.0], force=b), NUMBERS),
    "MeasuredPass: uplift": (lambda g, b: cf.MeasuredPass(uplift=b), (*OBJECT[:4], {0: [1.0]}, {1: ["x"]})),
    "with_dropper_lengths": (lambda g, b: g.line.with_dropper_lengths(b), (*NUMBERS, [1.0], None)),
    "has_stitch_wire": (lambda g, b: g.line.has_stitch_wire(b), (*WHOLE[:-3], 99)),
    "simulate: shape": (lambda g, b: cf.simulate(b, [g.head], speed=50.0), OBJECT),
    "simulate: pantographs": (lambda g, b: cf.simulate(g.shape, b, speed=50.0), (*OBJECT, [3], [None])),
    "simulate: speed": (simulated("speed"), (*POSITIVE, 200.0)),
    "simulate: positions": (simulated("positions"), (*NUMBERS, 1e4, [[15.0]], [])),
    "simulate: time": (simulated("time"), OBJECT[:2]),
    "simulate: store_wire": (simulated("store_wire"), (*POSITIVE, 1e30)),
    "simulate: progress": (simulated("progress"), FUNCTION),
    "simulate: method": (simulated("method"), CHOICE),
    "simulate: energy": (simulated("energy"), ("x", 1, None, [], ARRAY)),
    "simulate: checkpoint": (simulated("checkpoint"), (3, [], THING, b"x")),
    "simulate: model": (simulated("model"), OBJECT[:2]),
    "stepping": (lambda g, b: cf.stepping(b, [g.head], speed=50.0), OBJECT),
    "stepping: pantographs": (lambda g, b: cf.stepping(g.shape, b, speed=50.0), (*OBJECT, [3], [None])),
    "stepping: speed": (stepped("speed"), (*POSITIVE, 200.0)),
    "stepping: positions": (stepped("positions"), (*NUMBERS, 1e4, [[15.0]], [])),
    "stepping: time": (stepped("time"), OBJECT[:2]),
    "stepping: duration": (stepped("duration"), (*POSITIVE, 1e-3)),
    "stepping: conditions": (stepped("conditions"), ("x", 3, [3], [None])),
    "Session.step": (step("steps"), (*WHOLE, 10**6)),
    "Session.step: uplift_force": (step("uplift_force"), (*NUMBER, 1e4, [1.0, 2.0], [])),
    "Session.step: base_height": (step("base_height"), (*NUMBER, 10.0, [0.1, 0.2], [])),
    "Session.step: speed": (step("speed"), (*NUMBER, -1.0, 200.0)),
    "exudyn_model": (lambda g, b: cf.exudyn_model(b), OBJECT),
    "exudyn_model: pantographs": (lambda g, b: cf.exudyn_model(g.shape, b), (3, "x", [3], [None])),
    "solve_statics": (lambda g, b: cf.solve_statics(b), OBJECT),
    "solve_statics: forces": (
        lambda g, b: cf.solve_statics(g.shape, b), ("x", 3, [3.0], [(1.0,)], [("x", 1.0)], [(1e4, 1.0)])
    ),
    "solve_statics: force": (lambda g, b: cf.solve_statics(g.shape, [(60.0, b)]), NUMBER[:4]),
    "elasticity": (lambda g, b: cf.elasticity(b), OBJECT),
    "elasticity: force": (lambda g, b: cf.elasticity(g.shape, force=b), (*POSITIVE, 1e30)),
    "elasticity: spans": (lambda g, b: cf.elasticity(g.shape, spans=b), SPANS),
    "elasticity: positions": (lambda g, b: cf.elasticity(g.shape, positions=b), (*PLACES, [], ARRAY)),
    "elasticity: points": (lambda g, b: cf.elasticity(g.shape, points_per_span=b), (*WHOLE, 1)),
    "elasticity: both": (lambda g, b: cf.elasticity(g.shape, positions=[60.0], **b), ({"spans": [2]},)),
    "solve_modes": (lambda g, b: cf.solve_modes(b), OBJECT),
    "solve_modes: count": (lambda g, b: cf.solve_modes(g.shape, count=b), WHOLE),
    "solve_modes: below": (lambda g, b: cf.solve_modes(g.shape, below=b), (*POSITIVE, 1e30)),
    "modal_run: shape": (lambda g, b: cf.modal_run(b, g.modes, ELASTIC, speed=50.0), OBJECT),
    "modal_run: modes": (lambda g, b: cf.modal_run(g.shape, b, ELASTIC, speed=50.0), OBJECT),
    "modal_run: pantograph": (lambda g, b: cf.modal_run(g.shape, g.modes, b, speed=50.0), OBJECT),
    "modal_run: speed": (modal("speed"), (*POSITIVE, 1e30)),
    "modal_run: start": (modal("start"), (*NUMBER, -1.0, 1e4)),
    "modal_run: distance": (modal("distance"), (*POSITIVE, 1e4)),
    "modal_run: step": (modal("step"), (*POSITIVE, 1e30, 1e-9)),
    "ModalRun.uplift": (lambda g, b: g.ran.uplift(b), PLACES),
    "ModalRun.uplift: every": (lambda g, b: g.ran.uplift(50.0, b), WHOLE),
    "ModalRun.error_against": (
        lambda g, b: g.ran.error_against(b), (*NUMBERS, 3.0, [1.0], 0 * np.asarray(range(9)))
    ),
    "ModalRun.error_against: of": (lambda g, b: g.ran.error_against(g.ran.contact_force, b), CHOICE),
    "Modes.below": (lambda g, b: g.modes.below(b), POSITIVE),
    "Modes.kind": (lambda g, b: g.modes.kind(b), ("x", 1.5, None, -1, 3, True, ARRAY)),
    "Modes.plot": (lambda g, b: g.modes.plot(b), ("x", 1.5, None, -1, 3, True)),
    "Modes.compliance": (lambda g, b: g.modes.compliance(b), PLACES),
    "Shape.contact_wire_height": (lambda g, b: g.shape.contact_wire_height(b), PLACES),
    "HangingWire.lateral": (lambda g, b: g.shape.messenger_wire.lateral(b), PLACES),
    "criteria_rows": (lambda g, b: cf.criteria_rows(b, "AC"), OBJECT),
    "criteria_rows: system": (lambda g, b: cf.criteria_rows(g.run, b), CHOICE),
    "criteria_rows: filter": (lambda g, b: cf.criteria_rows(g.run, "AC", filter=b), (*CHOICE, "zerophase")),
    "statistics: spans": (lambda g, b: g.run.contact_force_statistics(b), SPANS),
    "statistics: filter": (lambda g, b: g.run.contact_force_statistics(filter=b), (*CHOICE, "zerophase")),
    "filtered_contact_force": (lambda g, b: g.run.filtered_contact_force(b), CHOICE),
    "largest_support_uplift": (lambda g, b: g.run.largest_support_uplift(b), SPANS),
    "Run.window": (lambda g, b: g.run.window(b), ("x", 1.5, None, -1, 1, True)),
    "Run.summary": (lambda g, b: g.run.summary(b), CHOICE),
    "Run.save": (lambda g, b: g.run.save(b), (*PATH, "", "missing/run.nc")),
    "target_mean_force: rule": (lambda g, b: cf.target_mean_force(b, 50.0), CHOICE),
    "target_mean_force: speed": (lambda g, b: cf.target_mean_force(RULE, b), (*NUMBER, -1.0)),
    "contact_force": (lambda g, b: ELASTIC.contact_force(b), NUMBER),
    "AerodynamicForce.at": (lambda g, b: cf.AerodynamicForce(linear=1.0).at(b), (*NUMBER, -1.0)),
    "library.wire": (lambda g, b: cf.library.wire(b, tension=1e4), OBJECT),
    "library.wire: tension": (lambda g, b: cf.library.wire("AC-120", tension=b), (*POSITIVE, None)),
    "library.pantograph": (lambda g, b: cf.library.pantograph(b), OBJECT),
    "library.line": (lambda g, b: cf.library.line(b), OBJECT),
    "library.names": (lambda g, b: cf.library.names(b), CHOICE),
    "Line.catenary: spans": (lambda g, b: re250(spans=b), WHOLE),
    "Line.catenary: spacing": (lambda g, b: re250(dropper_spacing=b), POSITIVE),
    "Line.catenary: arm": (lambda g, b: re250(steady_arm=b), OBJECT),
    "Catenary.regular: spans": (equal("spans"), (*WHOLE, 10**9)),
    "Catenary.regular: length": (equal("span_length"), POSITIVE),
    "Catenary.regular: droppers": (equal("droppers"), (3, "x", None, [3], THING)),
    "Catenary.regular: wire": (equal("contact_wire"), OBJECT),
    "Catenary.regular: support": (equal("support"), OBJECT),
    "Catenary.regular: pre_sag": (equal("pre_sag"), NUMBER),
    "Catenary.regular: stagger": (equal("stagger"), (*NUMBER, 200.0)),
    "Catenary.regular: radius": (equal("curve_radius"), (*NUMBER, 5.0)),
    "values without names": (lambda g, b: cf.Wire(b), (1.0, "x", None)),
    "MeshSettings": (lambda g, b: cf.MeshSettings(contact_wire_element=b), (*POSITIVE, None)),
    "MeshSettings: growth": (lambda g, b: cf.MeshSettings(growth=b), (*POSITIVE, 0.9)),
    "TimeSettings": (lambda g, b: cf.TimeSettings(step=b), (*POSITIVE, None, 1.0)),
    "TimeSettings: tolerance": (lambda g, b: cf.TimeSettings(tolerance=b), (*POSITIVE, None, 1.0)),
    "TimeSettings: radius": (lambda g, b: cf.TimeSettings(spectral_radius=b), (*NUMBER, -0.1, 1.1)),
    "even_nodes: fixed": (lambda g, b: cf.even_nodes(b, 1.0), (*NUMBERS, [], [1.0], 3.0, None)),
    "even_nodes: element": (lambda g, b: cf.even_nodes([0.0, 10.0], b), (*POSITIVE, 1e-9)),
    "graded_nodes: fixed": (graded("fixed"), (*NUMBERS, None)),
    "graded_nodes: element": (graded("element"), POSITIVE),
    "graded_nodes: kinks": (graded("kinks"), (*NUMBERS, None)),
    "graded_nodes: finest": (graded("finest"), (*POSITIVE, 2.0, 1e-12)),
    "graded_nodes: growth": (graded("growth"), (*POSITIVE, 1.0)),
    "WireProblem: wire": (problem("wire"), OBJECT),
    "WireProblem: x": (problem("x"), (*NUMBERS, [1.0], [2.0, 1.0], None)),
    "WireProblem: supports": (problem("supports"), (*NUMBERS, [1e4], 1e4)),
    "WireProblem: foundation": (problem("foundation_stiffness"), (*NUMBER, -1.0)),
    "WireProblem: masses": (
        problem("masses"), ("x", 3, [3], {"x": 1.0}, {10.0: "x"}, {10.0: -1.0}, {1e4: 1.0})
    ),
    "WireProblem: deflection": (problem("initial_deflection"), FUNCTION),
    "WireProblem: loads": (problem("loads"), ("x", 3, None, [3], [None], ["x"])),
    "WireProblem.node": (lambda g, b: g.wire.node(b), (*NUMBER, 1e4)),
    "SlidingPantograph": (sliding("pantograph"), OBJECT),
    "SlidingPantograph: uplift": (sliding("uplift"), NUMBER),
    "SlidingPantograph: speed": (sliding("speed"), (*NUMBER, -1.0)),
    "SlidingPantograph: start": (sliding("start"), NUMBER),
    "run_wire": (lambda g, b: cf.run_wire(b, duration=0.01), OBJECT),
    "run_wire: duration": (lambda g, b: cf.run_wire(g.wire, duration=b), (*POSITIVE, 0.00123, 1e30)),
    "run_wire: interval": (lambda g, b: cf.run_wire(g.wire, duration=0.01, interval=b), POSITIVE),
    "run_wire: time": (lambda g, b: cf.run_wire(g.wire, duration=0.01, time=b), OBJECT[:2]),
    "a deflection of nonsense": (
        lambda g, b: cf.run_wire(cf.WireProblem(wire=WIRE, x=NODES, initial_deflection=b), duration=0.01),
        (lambda x: "x", lambda x: NAN * x, lambda x: x[:3], lambda x: None),
    ),
    "plot_layout: spans": (lambda g, b: views.plot_layout(g.line, spans=b), SPANS),
    "plot_layout: shape": (lambda g, b: views.plot_layout(g.line, b), OBJECT[:2]),
    "plot_static_shape": (lambda g, b: views.plot_static_shape(g.shape, spans=b), SPANS),
    "plot_heights: spans": (lambda g, b: views.plot_heights(g.shape, spans=b), SPANS),
    "plot_heights: speed": (lambda g, b: views.plot_heights(g.shape, speed=b), POSITIVE),
    "plot_plan: spans": (lambda g, b: views.plot_plan(g.shape, spans=b), SPANS),
    "plot_plan: width": (lambda g, b: views.plot_plan(g.shape, head_width=b), POSITIVE),
    "plot_contact_force": (lambda g, b: views.plot_contact_force(b), OBJECT),
    "plot_run_waves: spans": (lambda g, b: views.plot_run_waves(g.run, spans=b), SPANS),
    "plot_run_waves: quantity": (lambda g, b: views.plot_run_waves(g.run, quantity=b), CHOICE),
    "plot_run_waves: wire": (lambda g, b: views.plot_run_waves(g.run, wire=b), CHOICE),
    "plot_pantograph": (lambda g, b: views.plot_pantograph(b), OBJECT),
    "plot_line_test": (lambda g, b: views.plot_line_test(b), OBJECT),
    "plot_force_spectrum": (lambda g, b: views.plot_force_spectrum(g.run, up_to=b), POSITIVE),
    "film: spans": (lambda g, b: film(g.run, "x.gif", spans=b), SPANS),
    "film: slowed": (lambda g, b: film(g.run, "x.gif", slowed=b), POSITIVE),
    "film: rate": (lambda g, b: film(g.run, "x.gif", frames_per_second=b), (*WHOLE, 51)),
}  # fmt: skip


def re250(**changes):
    return cf.library.line("Re 250").catenary(**({"steady_arm": ARM} | changes))


@pytest.mark.parametrize("call", CALLS)
def test_nonsense_is_refused_in_one_line(given, call, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ask, nonsense = CALLS[call]
    for bad in nonsense:
        try:
            taken = ask(given, bad)
        except cf.InputError as error:
            for line in error.problems:
                assert 10 < len(line) < 400, line
                assert "\n" not in line
            continue
        raise AssertionError(f"{bad!r} was taken: {taken!r:.200}")
    assert not list(tmp_path.iterdir())


def test_every_public_function_is_tried():
    functions = {name for name in cf.__all__ if callable(getattr(cf, name)) and name.islower()}
    assert functions <= {call.split(":")[0] for call in CALLS}
