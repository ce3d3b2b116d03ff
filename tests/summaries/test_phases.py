"""Outcomes of initial phases: counts from known labels, and real labels of a few states."""

from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np
import pytest

from burridge_knopoff import ChainState, Model
from burridge_knopoff.attractors.settings import SEARCH
from burridge_knopoff.attractors.stored_returns import KnownAttractors
from burridge_knopoff.basins.initial_phases import common_phases, inner_phases, oscillating_states
from burridge_knopoff.basins.settings import PhaseSettings
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.sampling import fraction_interval
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.summaries import phases
from burridge_knopoff.summaries.attractor_observables import AttractorObservables, follow_attractor

PHASES = PhaseSettings(
    amplitude=(0.05, 0.5), phase_difference=(30.0, 90.0, 180.0), inner_share=(0.0, 0.5), samples=5, seed=3
)
MODELS = [Model(law, a=0.05) for law in ("linearized", "nonlinear")]


@pytest.fixture
def ruled(monkeypatch):
    """Three attractors; a state reaches the first if x_1 + x_2 > 0.4 v, none if it is < −0.4 v, otherwise the last."""

    def label_states(model, attractors, position, velocity, *, time_limit, cores):
        assert (time_limit, cores) == (SEARCH.label_limit, 1)
        x = (position - model.sliding_offset)[:, :2].sum(axis=1)
        return np.select([x > 0.04, x < -0.4], [0, -1], 2), np.zeros(len(x))

    monkeypatch.setattr(phases, "label_states", label_states)
    correlations = iter([1.0, -0.5, -0.7] * 100)
    followed = partial(AttractorObservables, np.empty(0), velocity=np.empty((0, 3)), starts=())
    monkeypatch.setattr(
        phases, "follow_attractor", lambda model, start: followed(velocity_correlation=next(correlations))
    )


def candidates(model):
    """Return three attractors; only the rule determines which one a state reaches."""
    attractor = type("One", (), {"motion": type("Motion", (), {"state": staticmethod(lambda: None)})})
    return KnownAttractors(model, [attractor] * 3, np.array([0, 7, 7]), np.array([0, 1, -1]))


def test_states_are_counted_by_what_they_reach(ruled):
    parts = [
        phases.one_law([candidates(model.at(a=a)) for a in (0.05, 0.08)], PHASES, SEARCH.label_limit)
        for model in MODELS
    ]
    dataset = phases.merge(parts)
    assert dataset["branch"].dims == ("law", "a", "inner_share", "amplitude", "phase_difference", "state")
    assert dataset["branch"].shape == (2, 2, 2, 2, 3, 5)
    assert dataset["law"].values.tolist() == ["linearized", "nonlinear"]
    assert dataset["phase_difference"].values.tolist() == [30.0, 90.0, 180.0]
    assert dataset["phase_difference"].attrs["units"] == "degree"
    assert dataset["inner_share"].values.tolist() == [0.0, 0.5]
    assert dataset["inner_block"].values.tolist() == [2]
    for a, share in product((0.05, 0.08), (0.0, 0.5)):
        common, inner = common_phases(a, (2, 3, 5), 3), inner_phases(a, (2, 3, 5, 1), 3)
        assert (dataset["common_phase"].sel(a=a).values == common).all()
        assert (dataset["inner_phase"].sel(a=a).values == inner).all()
        swing = np.cos(np.radians(common)) + share * np.cos(np.radians(inner[..., 0]))
        x = dataset["amplitude"].values[:, None, None] * swing
        for law in dataset["law"].values:
            part = dataset.sel(law=law, a=a, inner_share=share)
            assert (part["branch"].values == np.select([x > 0.04, x < -0.4], [0, -1], 7)).all()
            assert (part["side"].values == np.select([x > 0.04, x < -0.4], [0, 0], -1)).all()
            correlation = np.select([x > 0.04, x < -0.4], [1.0, np.nan], -0.7)
            np.testing.assert_array_equal(part["velocity_correlation"].values, correlation)
            for index in np.ndindex(2, 3):
                hits, unknown = int((x[index] > 0.04).sum()), int((x[index] < -0.4).sum())
                shares = [part[f"synchronized_{name}"].values[index] for name in ("fraction", "low", "high")]
                assert shares == [*fraction_interval(hits, 5)[:2], fraction_interval(hits + unknown, 5)[2]]
                assert part["undetermined_count"].values[index] == unknown
    assert dataset["undetermined_count"].sum() > 0
    # With A = 0.05 no velocity becomes negative; with A = 0.5 those of most states do.
    assert dataset["standing_count"].sel(amplitude=0.05).sum() == 0
    for share in dataset["inner_share"].values:
        assert 15 < dataset["standing_count"].sel(amplitude=0.5, inner_share=share).sum() <= 30
    assert dataset["slipping_amplitude"].values == pytest.approx([0.1 / np.sqrt(2.0)] * 2)


def test_states_do_not_depend_on_the_other_shares(ruled):
    """The states with uniformly sliding inner blocks do not change when other shares are added."""
    alone = phases.one_law([candidates(MODELS[0])], replace(PHASES, inner_share=(0.5,)), SEARCH.label_limit)
    both = phases.one_law([candidates(MODELS[0])], PHASES, SEARCH.label_limit)
    assert both.sel(inner_share=[0.5]).drop_attrs().equals(alone.drop_attrs())


def test_a_study_determines_the_outcome_of_its_phases(small_studies):
    """The attractors are found with short runs; in synchrony the velocities are identical."""
    dataset = small_studies("paper").summaries["phases"]
    assert dataset["a"].values.tolist() == [0.05, 0.08]
    dataset = dataset.sel(inner_share=0.0, a=0.05)
    synchronized = dataset["branch"] == 0
    assert synchronized.sel(amplitude=0.03, phase_difference=20.0).all()
    assert not synchronized.sel(amplitude=0.03, phase_difference=180.0).any()
    assert dataset["velocity_correlation"].where(synchronized).min() == pytest.approx(1.0)
    opposite = dataset.sel(amplitude=0.03, phase_difference=180.0)
    assert (opposite["velocity_correlation"].sel(law="nonlinear") < -0.99).all()
    # Under the linearized law the sampled states have not reached the attractor with opposite phases.
    assert opposite["undetermined_count"].values.tolist() == [3, 0]
    assert opposite["velocity_correlation"].sel(law="linearized").isnull().all()
    assert "phases" not in small_studies("ring").summaries


@pytest.mark.parametrize(("difference", "least", "most"), [(20.0, 1.0 - 1e-9, 1.0), (180.0, -1.0, -0.99)])
def test_velocities_are_correlated_or_anticorrelated(difference, least, most):
    """The states reached from close and from opposite phases after 3000 time units."""
    model = MODELS[0]
    position, velocity, _ = oscillating_states(model, *(np.array([x]) for x in (0.03, difference, 100.0)))
    start = ChainState(position[0] - model.sliding_offset, velocity[0], np.zeros(3, dtype=bool))
    end = Runner(model).state_after(start, 3000.0)
    assert least <= follow_attractor(model, end).velocity_correlation <= most


@pytest.mark.parametrize(("share", "least", "most"), [(0.0, 1.0, 1.0), (0.7, 0.6, 0.99)])
def test_inner_blocks_that_oscillate_break_the_rule_of_close_phases(share, least, most):
    """Of phases 30° apart all states synchronize while the inner block slides uniformly, and not all if it does not.

    The motion is integrated until it has synchronized or never will; attractors and labels are not used.
    """
    count = 40
    common, inner = common_phases(0.05, (count,), 7), inner_phases(0.05, (count, 1), 7)
    position, velocity, standing = oscillating_states(
        MODELS[0], np.full(count, 0.03), np.full(count, 30.0), common, share, inner
    )
    assert not standing.any()
    runner, together = Runner(MODELS[0]), 0
    for x, speed in zip(position - MODELS[0].sliding_offset, velocity, strict=True):
        end = runner.state_after(ChainState(x, speed, np.zeros(3, dtype=bool)), 3000.0)
        together += abs(end.position[0] - end.position[2]) < 1e-3
    assert least <= together / count <= most


def test_the_correlation_is_that_of_the_velocities_from_the_state_on():
    """Compare with NumPy for a state that has not settled, with twenty samples per unit of time."""
    model = MODELS[0]
    start = model.begin(PAPER_STATES["plus"])
    runner, velocity = Runner(model), [start.velocity]
    runner.begin(start)
    for look in range(1, 20_001):
        runner.run(0.05 * look)
        velocity.append(runner.state().velocity)
    one, _, other = np.transpose(velocity)
    assert follow_attractor(model, start).velocity_correlation == pytest.approx(np.corrcoef(one, other)[0, 1], abs=1e-9)
