"""The synchronized orbits of both laws, found once, and the same motion from a 40-digit computation."""

from __future__ import annotations

import pytest

from burridge_knopoff.laws import law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Model
from burridge_knopoff.stability.family import Family
from burridge_knopoff.study.paper import PAPER_LAWS


@pytest.fixture(scope="package")
def families():
    """{law: Family} of the paper's laws at v = 0.1."""
    return {law: Family(Model(Chain(3), law_of(law, 0.0))) for law in PAPER_LAWS}


@pytest.fixture(params=PAPER_LAWS)
def law(request):
    """The name of each of the paper's laws in turn."""
    return request.param
