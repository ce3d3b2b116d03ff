"""The synchronized orbits of both laws, found once, and functions that give the answers they are told."""

import pytest

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.stability.family import Family
from burridge_knopoff.study.paper import PAPER_LAWS


@pytest.fixture(scope="package")
def families():
    """{law: Family} of the paper's laws at v = 0.1."""
    return {law: Family(Model(Chain(3), law_of(law, 0.0))) for law in PAPER_LAWS}


@pytest.fixture
def tell(monkeypatch):
    """Return how a function of a module is told its answers, in turn, which returns the list of what it is asked."""

    def told(module, name, answers):
        asked, left = [], iter(answers)

        def answer(*arguments):
            asked.append(arguments)
            return next(left)

        monkeypatch.setattr(module, name, answer)
        return asked

    return told
