"""Shared fixtures and settings of the tests."""

import os
import signal

# In tests run in the background of a shell, the interrupted programs would inherit that Ctrl-C is ignored.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# One thread, as in a point job, since the tests already use both cores.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import fcntl
import pickle
import shutil
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis.strategies import SearchStrategy

settings.register_profile("study", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("study")


#: Fixtures for which the real Snakefile runs a study with attractors, or to its end.
WHOLE_STUDIES = {"finished", "limited", "small_studies", "poor", "plane"}


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark the tests that need such a study as slow; others run the Snakefile for some files or plan its jobs."""
    if not WHOLE_STUDIES.isdisjoint(item.fixturenames):
        item.add_marker(pytest.mark.slow)


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Let one of two workers begin with Slurm, the other with the other long tests, and both end with short ones.

    Each has one half; the one that finishes first takes tests from the end of the other's half, so that none is left
    alone with a long test.
    """
    slurm, slow, workflow, short = groups = [], [], [], []
    for item in items:
        is_of = (
            item.path.name == "test_slurm.py",
            item.get_closest_marker("slow") is not None,
            item.path.parent.name == "workflow",
            True,
        )
        groups[is_of.index(True)].append(item)
    half = max(0, len(items) // 2 - len(slurm))
    items[:] = [*slurm, *short[:half], *slow, *workflow, *short[half:]]


def quick_first(cases: Iterable[Any], count: int) -> list[Any]:
    """Return cases of a test as parameters, all except the first few marked as slow."""
    values = [case if isinstance(case, tuple) else (case,) for case in cases]
    return [pytest.param(*case, marks=pytest.mark.slow if n >= count else ()) for n, case in enumerate(values)]


def crossed(cases: Sequence[tuple[Any, ...]], values: Iterable[Any]) -> list[Any]:
    """Return each case with each value as parameters; slow except for as many as have every case and every value."""
    return [
        pytest.param(*case, value, marks=() if n == k % len(cases) else pytest.mark.slow)
        for k, value in enumerate(values)
        for n, case in enumerate(cases)
    ]


def random_examples(quick: int, whole: int, *strategies: SearchStrategy[Any]) -> Callable[[Callable], Callable]:
    """Decorate a test of random examples: a few for the quick tests, more for the slow ones."""

    def decorate(check: Callable) -> Callable:
        @pytest.mark.parametrize("examples", quick_first([quick, whole], 1))
        def test(examples: int) -> None:
            settings(max_examples=examples)(given(*strategies)(check))()

        test.__doc__ = check.__doc__
        return test

    return decorate


@pytest.fixture(scope="session")
def repository() -> Path:
    """Root of the checkout."""
    return Path(__file__).parent.parent


@pytest.fixture(params=["linearized", "nonlinear"])
def law(request: pytest.FixtureRequest) -> str:
    """The name of each of the paper's laws in turn."""
    return request.param


def made_once(tmp_path_factory: pytest.TempPathFactory, name: str, make: Callable[[Path], object]) -> Path:
    """Return a folder that `make` fills once for all workers: the first one fills it while the others wait."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / f"shared_{name}"
    with folder.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        done = folder.with_suffix(".done")
        if not done.exists():
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
            make(folder)
            done.touch()
    return folder


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory):
    """A tiny study that has run to its end; tests only read it."""
    from tests.workflow.conftest import TINY, run_once

    return run_once(tmp_path_factory, "finished", TINY)


@pytest.fixture(scope="session")
def small_studies(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest):
    """Return small studies by their names in `tests.small_study`, with all summaries, each made once.

    "paper" is the finished study.
    """
    from tests.small_study import SMALL, STUDIES, open_small_study, run_study

    def make(name: str, folder: Path) -> None:
        small = run_study(folder / "results" / name, {**SMALL, "study": name, **STUDIES[name]}, ("summary",))
        assert small.summaries
        (folder / "study.pickle").write_bytes(pickle.dumps(small))

    @cache
    def small_study(name: str):
        if name == "paper":
            return open_small_study(request.getfixturevalue("finished").folder / "results/tiny")
        folder = made_once(tmp_path_factory, name, lambda folder: make(name, folder))
        return pickle.loads((folder / "study.pickle").read_bytes())

    return small_study


@pytest.fixture(scope="session")
def installed(repository: Path, tmp_path_factory: pytest.TempPathFactory):
    """The package installed from its source distribution, in an environment with only the declared requirements."""
    from tests.installation import Installation, install

    return Installation(made_once(tmp_path_factory, "installed", lambda folder: install(repository, folder)))


@pytest.fixture
def script_answers(monkeypatch):
    """Return a function that replaces a function of a module by scripted answers, and returns the list of its calls."""

    def script(module, name, answers):
        asked, left = [], iter(answers)

        def answer(*arguments, **named):
            asked.append((*arguments, *named.values()))
            return next(left)

        monkeypatch.setattr(module, name, answer)
        return asked

    return script


@pytest.fixture
def maps(monkeypatch):
    """Let searches follow maps of the line, see `tests.maps`."""
    from burridge_knopoff.attractors import candidates, convergence, labels, search, slow_set
    from burridge_knopoff.motion import classification
    from burridge_knopoff.periodic_orbits.flow import OrbitError
    from tests.maps import Clouds, Ensemble, observe, visit

    monkeypatch.setattr(candidates, "sliding_motion", lambda _: SimpleNamespace(exponent=[1.0]))
    for module in (convergence, search, slow_set):
        monkeypatch.setattr(module, "visit", visit)
    monkeypatch.setattr(labels, "new_ensemble", Ensemble)
    monkeypatch.setattr(labels, "Clouds", Clouds)
    monkeypatch.setattr(classification, "observe", observe)
    monkeypatch.setattr(classification, "locked_orbit", lambda *_: None)

    def no_flow(*_):
        raise OrbitError("a map has no orbits of a flow")

    monkeypatch.setattr(candidates, "limit_cycle", no_flow)
