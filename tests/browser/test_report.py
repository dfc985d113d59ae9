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


def test_curves_zoom(browser):
    for button, low, high in (("band", 115, 185), ("all", 0, 240)):
        browser.find_element("css selector", f"[data-zoom=force-chart][data-to={button}]").click()
        wait(browser, f"const x = charts.force.scales.x; return x.min > {low} && x.max < {high}")


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


def wait(browser, script):
    from selenium.webdriver.support.ui import WebDriverWait

    WebDriverWait(browser, 20).until(lambda b: b.execute_script(script))
