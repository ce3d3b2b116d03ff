"""The synchronized orbits of both laws, computed once."""

import pytest

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.study.paper import PAPER_LAWS


@pytest.fixture(scope="package")
def families():
    """{law: synchronized orbits over a} of the paper's laws at v = 0.1."""
    return {law: synchronized_orbits(Model(Chain(3), law_of(law, 0.0))) for law in PAPER_LAWS}
