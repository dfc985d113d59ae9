"""The report in a real browser: it loads alone, its player plays, its pictures are there, it prints."""

import base64
import json
import re

import pytest

import catenary_fe as cf
from catenary_fe.views.report import report_page

INJECTION = 'line </script><script>window.injected = 1</script><img src="http://example.org/x.png">'


@pytest.fixture(scope="module")
def page(short_run, short_shape, tmp_path_factory):
    data = short_run.with_elasticity(cf.elasticity(short_shape, points_per_span=4)).data
    data.attrs = data.attrs | {"title": INJECTION}
    path = tmp_path_factory.mktemp("report") / "report.html"
    path.write_text(report_page(cf.Run(data), short_shape), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def browser(chromium, page):
    browser = chromium(1200, 900)
    browser.get(page.as_uri())
    return browser


def test_loads_without_errors_or_network(browser, page):
    assert browser.get_log("browser") == []
    messages = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
    asked = {
        m["params"]["request"]["url"]
        for m in messages
        if m["method"] == "Network.requestWillBeSent" and m["params"]["documentURL"] == page.as_uri()
    }
    assert {url for url in asked if not url.startswith("data:")} == {page.as_uri()}


def test_what_a_user_wrote_is_text(browser):
    assert browser.execute_script("return window.injected") is None
    assert INJECTION in browser.find_element("tag name", "h1").text


def test_pictures_are_there(browser):
    sizes = browser.execute_script("return [...document.images].map((i) => [i.naturalWidth, i.alt])")
    assert len(sizes) == 9
    assert all(width > 500 and alt for width, alt in sizes)
    inked = browser.execute_script(INKED, "#force-chart canvas, #uplift-chart canvas, #stage")
    assert len(inked) == 3
    assert all(count > 5_000 for count in inked)


INKED = """return [...document.querySelectorAll(arguments[0])].map((c) => {
    const d = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
    let n = 0;
    for (let i = 3; i < d.length; i += 4) n += d[i] > 0;
    return n; })"""


def test_the_player_plays(browser, short_run):
    wait(browser, "return true")
    before = browser.execute_script("return player.time")
    picture = browser.execute_script("return player.canvas.toDataURL()")
    browser.find_element("id", "play").click()
    wait(browser, f"return player.time > {before} + 0.05")
    browser.find_element("id", "play").click()
    assert browser.find_element("id", "play").text == "Play"
    assert browser.execute_script("return player.canvas.toDataURL()") != picture
    time, frame = browser.execute_script("return [player.m.time[player.frame()], player.frame()]")
    said = browser.find_element("id", "now").text
    at = round(time / short_run.step)
    force = short_run.filtered_contact_force()[0, at]
    slack = int((short_run.data["dropper_force"].values[:, at] <= 0).sum())
    numbers = [float(n) for n in re.findall(r"\d+\.?\d*", said)]
    x = short_run.data["position"].values[0, at]
    assert numbers == pytest.approx([time, force, x, slack], abs=0.6), said  # whole newtons and metres
    uplift = browser.execute_script(
        "const w = player.m.wires[0], n = w.x.length, f = arguments[0];"
        "return Array.from(w.rows.subarray(f * n, (f + 1) * n), (v) => v * w.unit)",
        frame,
    )
    contact = short_run.wires()[0]
    assert uplift == pytest.approx(contact.uplift[round(time / 0.02)], abs=1e-5)


def test_the_player_says_its_scales(browser):
    said = browser.find_element("id", "scale").text
    assert "times larger than lengths, the motion about the static shape another 5 times." in said
    browser.execute_script(
        "const s = document.getElementById('magnified'); s.value = '1'; s.dispatchEvent(new Event('input'))"
    )
    assert browser.find_element("id", "scale").text.endswith("times larger than lengths.")


def test_the_player_stops_at_the_end(browser):
    browser.execute_script("document.getElementById('slowed').value = '1'; player.seek(player.end - 0.05)")
    browser.find_element("id", "play").click()
    wait(browser, "return !player.playing")
    assert browser.execute_script("return player.time === player.end")


def choose(browser, spans):
    browser.execute_script(
        "const s = document.getElementById('spans'); s.value = arguments[0];"
        "s.dispatchEvent(new Event('input'))",
        str(spans),
    )


def test_the_reader_chooses_spans(browser):
    """Of four spans, of which the third is evaluated: curves, tables and player follow."""
    for spans, low, high, tables in (("all", 0, 240, 36), (2, 55, 125, 9), ("evaluated", 115, 185, 9)):
        choose(browser, spans)
        for chart in ("force", "heights"):
            wait(
                browser, f"const x = charts.{chart}.scales.x; return x.min > {low - 1} && x.max < {high + 1}"
            )
        shown = "return [...document.querySelectorAll('#line .of-spans')].map((t) => [...t.querySelectorAll("
        shown += "'tbody tr')].filter((r) => r.getClientRects().length).length)"
        of_spans, schedule, supports = browser.execute_script(shown)
        assert schedule == tables
        assert (of_spans, supports) == ((4, 5) if spans == "all" else (1, 2))
    choose(browser, 2)
    assert browser.execute_script("return player.m.pantographs[0].x[player.frame()]") == pytest.approx(
        60, abs=2
    )
    browser.find_element("id", "after").click()
    assert browser.find_element("id", "chosen").text == "120 to 180 m"
    shown = browser.execute_script("return charts.uplift.series.slice(1).map((s) => s.show)")
    assert shown == [False, True, True]  # supports 2 to 4
    choose(browser, 1)  # which the pantograph starts in: it has no figures
    empty = browser.find_element("css selector", "#force .of-spans .none")
    assert empty.text == "Nothing in these spans."
    choose(browser, "evaluated")


def test_a_click_on_the_force_moves_the_player(browser):
    from selenium.webdriver import ActionChains

    over = browser.find_element("css selector", "#force-chart .u-over")
    browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", over)
    left, width = browser.execute_script(
        "const u = charts.force; return [u.valToPos(150, 'x'), u.over.clientWidth]"
    )
    ActionChains(browser).move_to_element_with_offset(over, round(left - width / 2), 0).click().perform()
    x = browser.execute_script("return player.m.pantographs[0].x[player.frame()]")
    assert x == pytest.approx(150, abs=1.5)


def test_on_a_phone(chromium, page):
    browser = chromium(375, 800)
    browser.get(page.as_uri())
    assert browser.get_log("browser") == []
    assert browser.execute_script("return document.documentElement.scrollWidth") <= 375
    inked = browser.execute_script(INKED, "#force-chart canvas, #stage")
    assert all(count > 3_000 for count in inked)
    sizes = browser.execute_script(
        "return [...document.querySelectorAll('p, td, button, figcaption')]"
        ".map((e) => parseFloat(getComputedStyle(e).fontSize))"
    )
    assert min(sizes) >= 13


def test_prints(browser, tmp_path):
    printed = browser.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})
    pdf = base64.b64decode(printed["data"])
    assert pdf.startswith(b"%PDF")
    assert 50_000 < len(pdf) < 5_000_000
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    shown = browser.execute_script(
        "return ['#stage', '#force-chart', '.on-paper', '.table']"
        ".map((s) => document.querySelector(s).getClientRects().length > 0)"
    )
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
    assert shown == [False, False, True, True]


@pytest.fixture(scope="module")
def whole_line(reference, pantograph, chromium, tmp_path_factory):
    """Two pantographs on a ramp down by 0.2 m, and over an overlap to a second section."""
    heights = [5.5, 5.45, 5.4, 5.35, 5.3, 5.3, 5.3, 5.3]
    ramp = reference.replace(
        spans=reference.spans[:7],
        supports=tuple(
            support.replace(contact_wire_height=height)
            for support, height in zip(reference.supports[:8], heights, strict=True)
        ),
        evaluated_spans=None,
    )
    level = reference.replace(spans=ramp.spans, supports=reference.supports[:8], evaluated_spans=None)
    line = cf.join_sections([ramp, level], [cf.Overlap(spans=3)], evaluated_spans=(4, 5, 6, 7))
    shape = cf.find_form(line)
    run = cf.simulate(shape, [pantograph] * 2, speed=60.0, positions=[70.0, 10.0], method="linearised",
                      store_wire=0.05)  # fmt: skip
    path = tmp_path_factory.mktemp("line") / "report.html"
    path.write_text(report_page(run, shape), encoding="utf-8")
    browser = chromium(1200, 900)
    browser.get(path.as_uri())
    assert browser.get_log("browser") == []
    return browser, run


def test_both_pantographs_are_in_the_headline(whole_line):
    browser, run = whole_line
    card = browser.find_elements("css selector", ".keys > div")[1]
    assert card.find_element("tag name", "dt").text == "standard deviation"
    said = [value.text.splitlines()[-1] for value in card.find_elements("tag name", "dd")]
    assert said == [f"{s.std:.1f} N" for s in run.contact_force_statistics()]
    assert len(card.find_elements("css selector", ".governs")) == 1


def test_each_verdict_has_a_bar(whole_line):
    browser, run = whole_line
    rows = cf.criteria_rows(run, "AC")
    bars = browser.execute_script(
        "return [...document.querySelectorAll('.criteria .bar')].map((b) => [b.firstChild.className,"
        " b.firstChild.offsetWidth / b.querySelector('i').offsetLeft])"
    )
    judged = [row for row in rows if row.limit is not None]
    assert [kind for kind, _ in bars] == [row.verdict for row in judged]
    assert [share for _, share in bars] == pytest.approx([min(row.used, 2) for row in judged], abs=0.03)


def test_the_player_follows_a_ramp(whole_line):
    """The picture sinks with the wire, to one scale; heads are under the wire that is there."""
    browser, _ = whole_line
    browser.execute_script("document.getElementById('magnified').value = '1'; player.range()")
    found = []
    for span in (2, 4, 9):
        choose(browser, span)
        at = "player.m.pantographs.map((p) => p.x[player.frame()])"
        found.append(browser.execute_script(f"return [player.low, player.high, player.heads, {at}]"))
    (low, high, _, _), (lower, _, _, _), _ = found
    assert low - lower > 0.05
    assert [high - low] * 3 == pytest.approx([each[1] - each[0] for each in found])
    for low, high, heads, places in found:
        for head, x in zip(heads, places, strict=True):
            assert low < head["height"] < high
            rest = max(5.3, 5.5 - 0.05 * x / 60)
            assert rest - 0.05 < head["height"] < rest + 0.12, x
    assert found[2][2][0]["wire"] == 1  # of the second section
    browser.execute_script("player.goTo([405])")  # where the first section's wire still is, but runs off
    assert browser.execute_script("return player.heads[0].wire") == 1


def test_numbers_of_supports_stay_clear(whole_line):
    """However many supports are in the picture: the next ones that are named are so far apart."""
    browser, _ = whole_line
    for count, gap, step in ((11, 60, 1), (60, 20, 2), (300, 3, 10)):
        places = [gap * i for i in range(count)]
        named = browser.execute_script("return charting.thinned(arguments[0], 26)", places)
        assert named == list(range(step, count + 1, step))


def wait(browser, script):
    from selenium.webdriver.support.ui import WebDriverWait

    WebDriverWait(browser, 20).until(lambda b: b.execute_script(script))
