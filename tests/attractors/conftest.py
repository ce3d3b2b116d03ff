"""Functions that give the answers they are told."""

import pytest


@pytest.fixture
def tell(monkeypatch):
    """Return how a function of a module is told its answers, in turn, which returns the list of what it is asked."""

    def told(module, name, answers):
        asked, left = [], iter(answers)

        def answer(*arguments, **named):
            asked.append((*arguments, *named.values()))
            return next(left)

        monkeypatch.setattr(module, name, answer)
        return asked

    return told
