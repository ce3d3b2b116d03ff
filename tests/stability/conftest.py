"""The synchronized orbits of both laws, found once, and the same motion from a 40-digit computation."""

from __future__ import annotations

import pytest

from burridge_knopoff.chain import Chain
from burridge_knopoff.friction import LAWS, Friction
from burridge_knopoff.stability.family import Family
from burridge_knopoff.stability.flow import Model


@pytest.fixture(scope="package")
def families():
    """{law: Family} at v = 0.1."""
    return {law: Family(Model(Chain(3), Friction(law, 0.0))) for law in LAWS}
