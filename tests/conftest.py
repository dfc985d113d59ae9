"""What many tests need: the reference layout, a short line, and runs that are computed once."""

from pathlib import Path

import pytest

import catenary_fe as cf

LAYOUTS = Path(__file__).parents[1] / "models" / "layouts"


@pytest.fixture(scope="session")
def reference_layout() -> Path:
    return LAYOUTS / "en50318_2002.toml"


@pytest.fixture(scope="session")
def reference(reference_layout: Path) -> cf.Catenary:
    return cf.load_catenary(reference_layout)


@pytest.fixture(scope="session")
def reference_shape(reference: cf.Catenary) -> cf.Shape:
    return cf.find_form(reference)


@pytest.fixture(scope="session")
def pantograph() -> cf.Pantograph:
    return cf.library.pantograph("EN 50318:2002")


@pytest.fixture(scope="session")
def short(reference: cf.Catenary) -> cf.Catenary:
    """Four spans of the reference line, the third one evaluated."""
    return reference.replace(spans=reference.spans[:4], supports=reference.supports[:5], evaluated_spans=(3,))


@pytest.fixture(scope="session")
def short_shape(short: cf.Catenary) -> cf.Shape:
    return cf.find_form(short)


@pytest.fixture(scope="session")
def short_run(short_shape: cf.Shape, pantograph: cf.Pantograph) -> cf.Run:
    return cf.simulate(short_shape, [pantograph], speed=250 / 3.6, store_wire=0.02)


@pytest.fixture(scope="session")
def curved_shape(reference_layout: Path) -> cf.Shape:
    """Six spans with stitch wires, the third to the fifth in a curve to the left."""
    line = cf.load_catenary(reference_layout.with_name("re330.toml"))
    spans = tuple(
        span.replace(curve_radius=1500.0) if n in (3, 4, 5) else span
        for n, span in enumerate(line.spans[:6], start=1)
    )
    return cf.find_form(line.replace(spans=spans, supports=line.supports[:7], evaluated_spans=(4, 6)))


@pytest.fixture(scope="session")
def twin_wires_shape(reference_layout: Path) -> cf.Shape:
    """Three spans of a line with two contact wires and 45 droppers."""
    line = cf.load_catenary(reference_layout.with_name("dc_3kv_twin.toml"))
    return cf.find_form(line.replace(spans=line.spans[:3], supports=line.supports[:4], evaluated_spans=(2,)))


def refused_in_one_line(call, message):
    """Of the theory: what = value: rule; remedy."""
    with pytest.raises(ValueError, match=message) as caught:
        call()
    text = str(caught.value)
    assert "\n" not in text
    assert " = " in text and ": " in text and "; " in text
