"""Shared fixtures and settings of the tests."""

import os
import signal

# Begun in the background of a shell, the tests would hand on to the programs they interrupt that Ctrl-C is ignored.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# As in a point job: the tests use both cores already.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from functools import cache
from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("study", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("study")


@pytest.fixture(scope="session")
def repository() -> Path:
    """Root of the checkout."""
    return Path(__file__).parent.parent


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory):
    """A tiny study that has run to its end; tests only read it."""
    from tests.workflow.conftest import Study

    study = Study(tmp_path_factory.mktemp("finished"))
    study.output = study.ok()
    return study


@pytest.fixture(scope="session")
def small_studies(tmp_path_factory: pytest.TempPathFactory):
    """Return small studies by their names in `tests.small_study`, each run once."""
    from tests.small_study import SMALL, STUDIES, run_study

    @cache
    def small_study(name: str):
        return run_study(tmp_path_factory.mktemp(name), {**SMALL, "study": name, **STUDIES[name]})

    return small_study
