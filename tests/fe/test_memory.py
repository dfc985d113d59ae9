"""Systems are freed: a long series of solves does not fill the memory."""

import sys

import pytest

import catenary_fe as cf


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads the process's size from /proc")
def test_form_finding_again_and_again_keeps_its_size(short):
    def resident_mb() -> float:
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * 4096 / 2**20

    for _ in range(3):
        cf.find_form(short)
    before = resident_mb()
    for _ in range(6):
        cf.find_form(short)
    # without freeing, each adds 25 MB
    assert resident_mb() - before < 40
