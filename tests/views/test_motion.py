"""Films and the player take wires as they come: stitch wires with gaps, more than one contact wire."""

import base64
import json

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.views import plot_run_waves
from catenary_fe.views.film import film, scene
from catenary_fe.views.report.series import force_chart, motion, uplift_chart


@pytest.fixture(scope="module")
def spatial(short_run):
    """The short run with a stitch wire at the second and third support, and a second contact wire."""
    data = short_run.data.copy()
    x = np.concatenate([[51, 60, 69], [90], [111, 120, 129]]).astype(float)
    static = np.where(x == 90, np.nan, 6.2)
    lift = 0.01 * np.sin(np.arange(data.sizes["wire_time"]))[:, None]
    data["stitch_wire_height"] = (("wire_time", "stitch_wire_x"), static + lift)
    data = data.assign_coords(
        stitch_wire_x=x,
        static_stitch_wire_height=("stitch_wire_x", static),
        static_left_contact_wire_height=("x", data["static_contact_wire_height"].values),
    )
    data["left_contact_wire_height"] = data["contact_wire_height"] + 0.0
    return cf.Run(data)


def test_wires_in_their_order(spatial):
    names = [wire.name for wire in spatial.wires()]
    assert names == ["contact wire", "left contact wire", "messenger wire", "stitch wire"]
    assert [wire.touched for wire in spatial.wires()] == [True, True, False, False]


def test_droppers_hang_on_the_lowest_wire_above(spatial):
    seen = scene(spatial)
    names = [wire.name for wire in seen.wires]
    for x, (lower, upper) in zip(seen.dropper_x, seen.dropper_ends, strict=True):
        on_stitch = 51 <= x <= 69 or 111 <= x <= 129
        assert names[lower] == "contact wire"
        assert names[upper] == ("stitch wire" if on_stitch else "messenger wire")


@pytest.fixture(scope="module")
def falling(short_run):
    """The short run on a line whose contact wire falls by 1.2 m, everything with it."""
    data = short_run.data.copy()
    for name in ("contact_wire", "messenger_wire"):
        variable = f"{name}_height"
        drop = -0.005 * data[data[variable].dims[1]]
        data[variable] = data[variable] + drop
        data = data.assign_coords({f"static_{variable}": data[f"static_{variable}"] + drop})
    data["mass_height"] = data["mass_height"] - 0.005 * data["position"]
    return cf.Run(data)


@pytest.mark.parametrize("magnified", [1.0, 5.0])
def test_all_that_moves_stays_in_the_picture(falling, magnified):
    """The masses follow the wire that falls, their motion about it magnified as the wire's is."""
    seen = scene(falling)
    low, high = seen.extent(0.0, 240.0, magnified)
    (x,), (rest,) = seen.pantograph_x, seen.rest
    assert rest == pytest.approx(5.3 - 0.005 * x, abs=0.01)
    heights = seen.mass_heights(0, magnified)
    assert np.abs(heights[0] - rest).max() < 0.25 * magnified
    drawn = [seen.heights(i, frame, magnified) for i in (0, 1) for frame in range(seen.time.size)]
    assert low <= min(heights.min(), *(z.min() for z in drawn)) < 4.3
    assert high >= max(z.max() for z in drawn)
    here = seen.extent(0.0, 60.0, magnified)
    assert low < here[0] - 0.3


def test_each_kind_of_wire_has_its_colour(spatial):
    wires = {wire["name"]: wire["colour"] for wire in motion(spatial)["wires"]}
    assert wires["contact wire"] == wires["left contact wire"]
    assert len({wires[name] for name in ("contact wire", "messenger wire", "stitch wire")}) == 3


def test_the_player_gets_valid_json_and_the_same_shapes(spatial):
    data = json.loads(json.dumps(motion(spatial), allow_nan=False))
    stitch = data["wires"][3]
    assert stitch["static"][3] is None
    for wire, sent in zip(spatial.wires(), data["wires"], strict=True):
        rows = np.frombuffer(base64.b64decode(sent["uplift"]), dtype="<i2").reshape(-1, wire.x.size)
        assert rows * sent["unit"] == pytest.approx(np.nan_to_num(wire.uplift), abs=1e-5)


def test_frames_of_long_runs_are_left_out(spatial, monkeypatch):
    all_frames = motion(spatial)["time"]
    monkeypatch.setattr("catenary_fe.views.report.series._MOTION", 100_000)
    some = motion(spatial)["time"]
    points = sum(wire.x.size for wire in spatial.wires())
    assert 2 * len(some) * points <= 100_000 + 2 * points
    assert set(some) <= set(all_frames)


def test_curves_are_valid_json_over_one_axis(short_run):
    chart = json.loads(json.dumps(force_chart(short_run, "causal"), allow_nan=False))
    filtered = next(s["values"] for s in chart["series"] if not s["faint"])
    x = short_run.data["position"].values[0]
    expected = np.interp(chart["x"], x, short_run.filtered_contact_force()[0])
    assert filtered == pytest.approx(expected, abs=0.2)
    assert chart["band"] == [120, 180]
    uplift = json.loads(json.dumps(uplift_chart(short_run), allow_nan=False))
    largest = max(v for s in uplift["series"] if s["shown"] for v in s["values"])
    assert largest == pytest.approx(1e3 * short_run.largest_support_uplift(), abs=0.1)


def test_a_film_with_gaps_in_a_wire(spatial, tmp_path):
    path = film(spatial, tmp_path / "run.gif", spans=[2], slowed=1, frames_per_second=5)
    assert path.stat().st_size > 20_000


def test_waves_on_any_wire(spatial):
    for wire in ("messenger wire", "stitch wire"):
        ax = plot_run_waves(spatial, wire=wire, spans=[2])
        assert wire in ax.get_title(loc="left")
