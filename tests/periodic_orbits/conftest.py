"""The synchronized orbits of both laws, computed once."""

import pytest

from burridge_knopoff import Model
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.study.paper import PAPER_LAWS


@pytest.fixture(scope="package")
def families():
    """{law: synchronized orbits over a} of the paper's laws at v = 0.1."""
    return {law: synchronized_orbits(Model(law, a=0.0)) for law in PAPER_LAWS}
