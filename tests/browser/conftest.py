"""A headless Chromium that may not reach any network."""

import os
import shutil

import pytest


@pytest.fixture(scope="session")
def chromium(tmp_path_factory):
    """Starts a browser of a given window size; all of them end with the tests."""
    browser, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if not (browser and driver):
        if os.environ.get("CATENARY_FE_BROWSER") == "required":
            pytest.fail("chromium and chromedriver are not installed, and CATENARY_FE_BROWSER=required")
        pytest.skip("needs chromium and chromedriver (Debian: chromium chromium-driver)")
    webdriver = pytest.importorskip("selenium.webdriver")
    started = []

    def start(width, height):
        options = webdriver.ChromeOptions()
        options.binary_location = browser
        for flag in (
            "headless", "no-sandbox", "disable-gpu", "disable-quic", "no-first-run",
            "disable-background-networking", "disable-component-update", "disable-sync",
            "host-resolver-rules=MAP * ~NOTFOUND", f"window-size={width},{height}",
            f"user-data-dir={tmp_path_factory.mktemp('browser')}",
        ):  # fmt: skip
            options.add_argument(f"--{flag}")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        service = webdriver.ChromeService(executable_path=driver)
        started.append(webdriver.Chrome(options=options, service=service))
        # the window of a headless Chromium has a least width; the page's size can be set below it
        started[-1].execute_cdp_cmd(
            "Emulation.setDeviceMetricsOverride",
            {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600},
        )
        return started[-1]

    yield start
    for each in started:
        each.quit()
