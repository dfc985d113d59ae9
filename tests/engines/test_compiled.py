"""Where machine code is kept, and that no fault of that place is one of the program."""

import time
from pathlib import Path

import pytest

from catenary_fe.engines.compiled import compilation, kept, numba, run_clock
from catenary_fe.results.files import own_temporary_folder


def twice():
    """A function of its own each time, compiled on first use."""

    def double(x: float) -> float:
        return 2 * x

    return kept(double)


@pytest.fixture
def no_other_place(monkeypatch, tmp_path):
    """Neither the source's folder nor the user's own can be written; temporary files are here."""
    from numba.core import caching

    for locator in (caching.InTreeCacheLocator, caching.UserWideCacheLocator):
        monkeypatch.setattr(locator, "from_function", classmethod(lambda *_: None))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    return tmp_path


def test_it_is_kept_among_temporary_files(no_other_place):
    assert twice()(2.0) == 4.0
    assert list(no_other_place.rglob("*.nbc"))
    again = twice()
    assert again(2.0) == 4.0
    assert again.stats.cache_hits


def test_a_folder_that_others_may_write_is_not_taken(no_other_place):
    Path(own_temporary_folder()).chmod(0o777)
    assert own_temporary_folder() is None
    assert twice()(2.0) == 4.0
    assert not list(no_other_place.rglob("*.nbc"))


def test_damaged_files_only_cost_time(no_other_place):
    assert twice()(2.0) == 4.0
    for file in [*no_other_place.rglob("*.nbi"), *no_other_place.rglob("*.nbc")]:
        file.write_bytes(b"\x80")
    assert twice()(2.0) == 4.0


def test_a_run_is_not_charged_with_what_it_compiles():
    """Inner functions are compiled within outer ones, and count once; who asked is told once."""
    told = []
    compilation.told = lambda: told.append(1)

    @numba.njit
    def inner(x):
        return x + 1.0

    @numba.njit
    def outer(x):
        return inner(x) * 2.0

    before, begin, wall = compilation.seconds, run_clock(), time.perf_counter()
    assert outer(1.0) == 4.0
    wall, charged = time.perf_counter() - wall, run_clock() - begin
    spent = compilation.seconds - before
    assert 0 < spent <= wall and charged == pytest.approx(wall - spent, abs=1e-3)
    assert outer(2.0) == 6.0 and compilation.seconds - before == spent
    assert told == [1]
