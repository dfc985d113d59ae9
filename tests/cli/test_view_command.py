"""Exudyn's viewer: a clear line without a screen, a picture of the model with one."""

import os
import shutil
import subprocess
import sys

import numpy as np
import pytest


@pytest.fixture(scope="module")
def screen():
    """The name of a virtual screen."""
    if not shutil.which("Xvfb"):
        if os.environ.get("CATENARY_FE_BROWSER") == "required":
            pytest.fail("Xvfb is not installed, and CATENARY_FE_BROWSER=required")
        pytest.skip("needs Xvfb (Debian: xvfb libgl1-mesa-dri)")
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24"],
        pass_fds=[write], stderr=subprocess.DEVNULL,
    )  # fmt: skip
    os.close(write)
    with os.fdopen(read) as pipe:
        number = pipe.readline().strip()
    yield f":{number}"
    server.terminate()
    server.wait()


def view(layout, *arguments, display):
    """In a process of its own: a window that fails takes the whole process with it."""
    environment = {k: v for k, v in os.environ.items() if k != "DISPLAY"}
    if display:
        environment["DISPLAY"] = display
    command = [sys.executable, "-m", "catenary_fe", "view", str(layout), *arguments]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120)


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have a screen")
@pytest.mark.parametrize(
    ("display", "said"), [(None, "DISPLAY is not set"), (":9999", "the X server :9999 does not answer")]
)
def test_no_screen(reference_layout, display, said):
    done = view(reference_layout, display=display)
    assert (done.returncode, done.stdout) == (3, "")
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("name", ["en50318_2002", "en50318_2018_ac_simple"])  # in the plane, in space
def test_a_picture_of_the_model(reference_layout, name, screen, tmp_path):
    from PIL import Image

    layout = reference_layout.with_name(f"{name}.toml")
    done = view(layout, "--spans", "2", "-o", str(tmp_path / "model.png"), display=screen)
    assert done.returncode == 0, done.stderr
    with Image.open(tmp_path / "model.png") as picture:
        pixels = np.asarray(picture.convert("RGB")).astype(int)
    red, green, blue = pixels[..., 0], pixels[..., 1], pixels[..., 2]
    contact = (red > 180) & (blue < 170) & (green < 180)
    messenger = (red < 150) & (green > 60) & (green < 200) & (blue > 100) & (blue > red + 40)
    assert contact.any(axis=0).mean() > 0.9  # across the whole picture
    assert messenger.any(axis=0).mean() > 0.9
    assert np.flatnonzero(contact.any(axis=1)).min() > np.flatnonzero(messenger.any(axis=1)).min()  # below it
