"""Fixtures of several tests of summaries."""

import numpy as np
import pytest

from burridge_knopoff.motion.settings import MOTION
from burridge_knopoff.summaries import attractors
from tests.summaries.continued import SETTINGS, STATES, continuation


@pytest.fixture
def one_law(monkeypatch):
    """The summary of a law whose initial states reach the second attractor under a symmetric contact, or none.

    With a tested start the first state reaches no attractor.
    """

    def label(model, candidates, starts, time_limit):
        assert time_limit == 1230.0
        reached = [1 if len(candidates) else -1] * len(starts)
        # The states under one convention of the start, then under the other.
        for k in (0, len(starts) // 2):
            if starts[k].stuck.any():
                reached[k] = -1
        return np.array(reached, int), np.zeros(len(starts))

    monkeypatch.setattr(attractors, "label", label)
    return lambda law: attractors.one_law(continuation(law), STATES, SETTINGS, MOTION, "tested")
