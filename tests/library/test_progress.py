"""The bar of a long call: in a terminal, in a pipe, and without the libraries that draw it."""

import sys
from concurrent.futures import ThreadPoolExecutor
from types import ModuleType
from typing import ClassVar

import pytest

from burridge_knopoff import Model, sweep
from burridge_knopoff.library import progress
from burridge_knopoff.library.progress import progress_bar


@pytest.fixture
def without(monkeypatch):
    """Return a function that hides a library."""
    return lambda *names: [monkeypatch.setitem(sys.modules, name, None) for name in names]


class Bar:
    """What this package uses of tqdm."""

    bars: ClassVar[list["Bar"]] = []

    def __init__(self, total, **_):
        self.total, self.done = total, 0.0
        self.bars.append(self)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def update(self, amount):
        self.done += amount


@pytest.fixture
def tqdm(monkeypatch):
    module = ModuleType("tqdm.auto")
    module.tqdm = Bar
    monkeypatch.setitem(sys.modules, "tqdm", ModuleType("tqdm"))
    monkeypatch.setitem(sys.modules, "tqdm.auto", module)
    monkeypatch.setattr(Bar, "bars", [])
    return Bar


@pytest.mark.parametrize("value", [False, True])
def test_nothing_is_written_to_a_pipe(value, capsys):
    with progress_bar(value, 2, "sweep") as advance:
        advance()
        advance(0.5)
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("value", [True, "always"])
def test_the_share_is_drawn_in_a_terminal_or_where_it_is_forced(value, capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: value is True)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(progress, "DRAWN", 0.0)
    with progress_bar(value, 4, "sweep") as advance:
        advance()
        advance(2.0)
    out, err = capsys.readouterr()
    assert not out
    assert 0 < err.index("sweep") < err.index("25%") < err.index("75%")
    assert "100%" not in err


def test_tqdm_draws_where_rich_is_not_installed(tqdm, without):
    without("rich", "rich.console", "rich.progress")
    with progress_bar("always", 1.0, "continue_attractors") as advance, ThreadPoolExecutor(4) as threads:
        list(threads.map(advance, [0.125] * 8))
    (bar,) = tqdm.bars
    assert (bar.total, bar.done) == (1.0, 1.0)


def test_a_warning_says_that_no_bar_can_be_shown(without):
    without("rich", "rich.console", "rich.progress", "tqdm", "tqdm.auto")
    text = r"^progress: no bar is shown, expected rich or tqdm"
    with pytest.warns(UserWarning, match=text), progress_bar("always", 1, "sweep") as advance:
        advance()
    with progress_bar(False, 1, "sweep") as advance:
        advance()


def test_a_sweep_counts_its_runs(tqdm, without):
    without("rich", "rich.console", "rich.progress")
    sweep(Model("linearized"), a=[0.05, 0.08, 0.1], transient=0, window=1, batches=2, cores=2, progress="always")
    (bar,) = tqdm.bars
    assert bar.total == bar.done == 3


@pytest.mark.parametrize("value", [None, 2, "yes"])
def test_another_value_is_refused(value):
    with pytest.raises(ValueError, match="^progress: got "), progress_bar(value, 1, "sweep"):
        pass


def test_an_error_ends_the_bar(monkeypatch, capsys):
    monkeypatch.setenv("TERM", "xterm")
    with pytest.raises(ZeroDivisionError), progress_bar("always", 1, "sweep"):
        1 / 0  # noqa: B018
    shows_cursor = "\x1b[?25h"
    assert shows_cursor in capsys.readouterr().err
