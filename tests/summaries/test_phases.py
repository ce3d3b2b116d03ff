"""What phases lead to: counted from labels that are known, and real ones of a few states."""

import numpy as np
import pytest

from burridge_knopoff import Chain, Instant, Model, law_of
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.stability.basins import KnownAttractors
from burridge_knopoff.stability.phases import common_phases, oscillating_states
from burridge_knopoff.stability.sampling import fraction_interval
from burridge_knopoff.stability.settings import MOTION, SEARCH, PhaseSettings
from burridge_knopoff.summaries import phases

PHASES = PhaseSettings(amplitude=(0.05, 0.5), phase_difference=(30.0, 90.0, 180.0), samples=5, seed=3)
MODELS = [Model(Chain(3), law_of(law, 0.05)) for law in ("linearized", "nonlinear")]


@pytest.fixture
def ruled(monkeypatch):
    """Three attractors; a state reaches the first where x_1 > 0.4 v, none where x_1 < −0.4, else the last."""

    class Known:
        motion = type("Motion", (), {"instant": staticmethod(lambda: None)})

    def label_states(model, attractors, position, velocity, *, time_limit):
        assert time_limit == SEARCH.label_limit
        x = (position - model.sliding_offset)[:, 0]
        return np.select([x > 0.04, x < -0.4], [0, -1], 2), np.zeros(len(x))

    def known(found, model, *_):
        return KnownAttractors(model, [Known] * 3, np.array([0, 7, 7]), np.array([0, 1, -1]))

    monkeypatch.setattr(phases, "label_states", label_states)
    monkeypatch.setattr(phases, "known_attractors", known)
    correlations = iter([1.0, -0.5, -0.7] * 100)
    monkeypatch.setattr(phases, "velocity_correlation", lambda model, start: next(correlations))


def test_states_are_counted_by_what_they_reach(ruled):
    parts = [phases.one_law(None, model, [0.05, 0.08], PHASES, SEARCH, MOTION) for model in MODELS]
    found = phases.merge(parts)
    assert found["branch"].dims == ("law", "a", "amplitude", "phase_difference", "state")
    assert found["branch"].shape == (2, 2, 2, 3, 5)
    assert found["law"].values.tolist() == ["linearized", "nonlinear"]
    assert found["phase_difference"].values.tolist() == [30.0, 90.0, 180.0]
    assert found["phase_difference"].attrs["units"] == "degree"
    for a in (0.05, 0.08):
        common = common_phases(a, (2, 3, 5), 3)
        assert (found["common_phase"].sel(a=a).values == common).all()
        x = found["amplitude"].values[:, None, None] * np.cos(np.radians(common))
        for law in found["law"].values:
            one = found.sel(law=law, a=a)
            assert (one["branch"].values == np.select([x > 0.04, x < -0.4], [0, -1], 7)).all()
            assert (one["side"].values == np.select([x > 0.04, x < -0.4], [0, 0], -1)).all()
            correlation = np.select([x > 0.04, x < -0.4], [1.0, np.nan], -0.7)
            np.testing.assert_array_equal(one["velocity_correlation"].values, correlation)
            for index in np.ndindex(2, 3):
                hits, unknown = int((x[index] > 0.04).sum()), int((x[index] < -0.4).sum())
                told = [one[f"synchronized_{name}"].values[index] for name in ("fraction", "low", "high")]
                assert told == [*fraction_interval(hits, 5)[:2], fraction_interval(hits + unknown, 5)[2]]
                assert one["undetermined_count"].values[index] == unknown
    assert found["undetermined_count"].sum() > 0
    # With A = 0.05 no velocity becomes negative; with A = 0.5 those of most states do.
    assert found["standing_count"].sel(amplitude=0.05).sum() == 0
    assert 15 < found["standing_count"].sel(amplitude=0.5).sum() <= 30
    assert found.attrs["slipping_amplitude"] == pytest.approx(0.1 / np.sqrt(2.0))


def test_a_study_finds_what_its_phases_lead_to(small_studies):
    """The attractors are found with short runs; synchrony is, and its velocities are the same."""
    found = small_studies("paper").found["phases"]
    assert found["a"].values.tolist() == [0.05]
    synchronized = found["branch"] == 0
    assert synchronized.sel(amplitude=0.05, phase_difference=30.0).all()
    assert not synchronized.sel(amplitude=0.05, phase_difference=180.0).any()
    assert found["velocity_correlation"].where(synchronized).min() == pytest.approx(1.0)
    # Its two sampled states have not found the attractor of opposite phases.
    lost = found.sel(amplitude=0.05, phase_difference=180.0)
    assert (lost["undetermined_count"] == 2).all()
    assert lost["velocity_correlation"].isnull().all()
    assert "phases" not in small_studies("ring").found


@pytest.mark.parametrize(("difference", "least", "most"), [(20.0, 1.0 - 1e-9, 1.0), (180.0, -1.0, -0.99)])
def test_velocities_go_together_or_against_each_other(difference, least, most):
    """What close and opposite phases have come to after 3000 time units."""
    model = MODELS[0]
    position, velocity, _ = oscillating_states(model, *(np.array([x]) for x in (0.03, difference, 100.0)))
    start = Instant(position[0] - model.sliding_offset, velocity[0], np.zeros(3, dtype=bool))
    end = Runner(model).after(start, 3000.0)
    assert least <= phases.velocity_correlation(model, end) <= most
