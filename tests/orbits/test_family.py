"""Synchronized orbits over a: how they are continued where Newton's method needs a near orbit to begin with."""

import pytest

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.orbits import family
from burridge_knopoff.orbits.orbit import OrbitError


@pytest.fixture
def known():
    return family.Family(Model(Chain(3), law_of("linearized", 0.05)))


def test_steps_are_halved_until_the_orbit_is_found(known, monkeypatch):
    (here,) = known.known
    find, tried = family.find_orbit, []

    def near_only(model, reference, period):
        tried.append(model.a)
        if model.a - max(known.known) > 0.003:
            raise OrbitError("too far")
        return find(model, reference, period)

    monkeypatch.setattr(family, "find_orbit", near_only)
    found = known.at(here + 0.02)
    assert found.model.a == here + 0.02
    assert tried[:3] == pytest.approx([here + 0.02, here + 0.01, here + 0.005])
    # The step that succeeds is kept.
    assert len(tried) == pytest.approx(3 + 0.02 / 0.0025, abs=1)


def test_where_it_is_lost_the_error_is_told_after_the_least_step(known, monkeypatch):
    (here,) = known.known
    tried = []

    def lost(model, reference, period):
        tried.append(model.a)
        raise OrbitError("lost")

    monkeypatch.setattr(family, "find_orbit", lost)
    with pytest.raises(OrbitError, match="lost"):
        known.at(here + 0.02)
    assert tried[-1] - here == pytest.approx(family.LEAST_STEP, rel=1.0)
    assert len(tried) < 20


def test_steps_become_as_short_as_the_stick_is(known, monkeypatch):
    """It vanishes with a, and with it how far Newton's method comes."""
    known.known = {1e-4: known.at(1e-4)}
    find = family.find_orbit

    def near_only(model, reference, period):
        if min(abs(model.a - a) for a in known.known) > 3e-7:
            raise OrbitError("too far")
        return find(model, reference, period)

    monkeypatch.setattr(family, "find_orbit", near_only)
    assert known.at(0.99e-4).model.a == 0.99e-4
