"""Where several blocks stop or start at one instant: a derivative that finite perturbations follow, or a refusal."""

import numpy as np
import pytest

from burridge_knopoff import (
    Chain,
    ChainState,
    InitialState,
    Model,
    OrbitError,
    event_exponents,
    event_multipliers,
    follow,
    law_of,
    multipliers,
    simulate,
    sweep,
    synchronized_orbit,
    transverse_exponent,
)
from burridge_knopoff.cli import main
from burridge_knopoff.kernel._core import Exponents
from burridge_knopoff.periodic_orbits.flow import rate
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from tests.scipy_flow import model_events

DROP = law_of("carlson_langer", a=0.6, sigma=0.1)
#: Blocks that all move alike, each joined to its neighbours by a dashpot.
UNIFORM = Model(DROP, blocks=4, coupling=1, pulling=1, damping=1)
ALIKE = InitialState("alike", (-0.9,) * 4, 0.1)


def rough(blocks, seed):
    return np.random.default_rng(seed).normal(size=2 * blocks)


def growth(orbit, end_of, size, seed, periods):
    """Return the growth of a finite perturbation of an orbit in its last period, without its part along the flow.

    end_of(state) : positions and velocities a period later
    """
    start, blocks = orbit.reference, orbit.model.blocks
    along = rate(orbit.model, start)
    along /= np.linalg.norm(along)
    moved = np.concatenate([np.ones(blocks), ~start.stuck])
    perturbation, length = rough(blocks, seed) * moved, 1.0
    after = end_of(start)
    for _ in range(periods):
        perturbation -= along * (along @ perturbation)
        length = np.linalg.norm(perturbation)
        shifted = start.vector() + size / length * perturbation
        perturbation = (end_of(ChainState(shifted[:blocks], shifted[blocks:], start.stuck)) - after) / size
    perturbation -= along * (along @ perturbation)
    return np.linalg.norm(perturbation)


def by_package(orbit):
    runner = Runner(orbit.model)
    return lambda start: runner.state_after(start, orbit.period).vector()


def by_scipy(orbit):
    return lambda start: model_events(orbit.model, start, orbit.period)[1]


def refused(reason="at one instant"):
    return pytest.raises(ValueError, match=reason)


def test_perturbations_of_four_equal_blocks_have_no_multiplier():
    """Each order of starts has its own linear map; the growth of perturbations is that of none of them alone."""
    orbit = synchronized_orbit(UNIFORM)
    rates = [growth(orbit, by_package(orbit), size, seed, 30) for size in (1e-6, 1e-8) for seed in range(3)]
    assert max(rates) - min(rates) < 1e-5
    assert growth(orbit, by_scipy(orbit), 1e-4, 0, 6) == pytest.approx(rates[0], abs=2e-3)
    assert abs(np.abs(np.linalg.eigvals(orbit.monodromy)) - rates[0]).min() > 0.01
    with refused():
        multipliers(orbit)
    with refused():
        follow(orbit, parameter="a")
    with refused():
        transverse_exponent(UNIFORM, UNIFORM.begin(ALIKE))


@pytest.mark.parametrize(
    "chain",
    [
        Chain(2, coupling=1, pulling=1, damping=1),
        Chain(2, coupling=1, pulling=1),
        Chain(3, coupling=1, pulling=1),
        Chain(3, damping=1),
        Chain(4, damping=1),
    ],
    ids=str,
)
def test_finite_perturbations_follow_the_multipliers(chain):
    orbit = synchronized_orbit(Model(DROP, chain=chain))
    leading = abs(multipliers(orbit).whole[0])
    for seed in range(2):
        assert growth(orbit, by_package(orbit), 1e-7, seed, 80) == pytest.approx(leading, rel=1e-4)


def test_without_a_drop_or_without_dashpots_the_order_does_not_matter():
    for model in (Model(DROP, blocks=4, coupling=1, pulling=1), Model("linearized", a=0.3, chain=UNIFORM.chain)):
        run = simulate(model, initial=ALIKE, transient=50, window=50)
        assert run.missing_derivative == ""
        assert np.isfinite(run.lyapunov_exponent[0])


def test_exponents_of_runs_alone_and_in_lanes():
    alone = simulate(UNIFORM, initial=ALIKE, transient=50, window=50, events="none")
    assert "blocks 1 and 2" in alone.missing_derivative
    assert (np.isnan(alone.lyapunov_exponent).all(), alone.lyapunov_infinite_count) == (True, -1)
    a = np.linspace(0.5, 0.6, 12)
    together = sweep(UNIFORM, ALIKE, a=a, transient=50, window=50)
    assert together.lyapunov_exponent.isnull().all()
    apart = InitialState("apart", (-0.9, -0.8, -0.91, -0.95), 0.1)
    assert sweep(UNIFORM, apart, a=a, transient=50, window=50).lyapunov_exponent.notnull().all()


@pytest.mark.parametrize("blocks", [23, 24])
@pytest.mark.parametrize("groups", [False, True])
@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
def test_exponents_in_groups(blocks, groups, loading):
    def run(spread):
        model = Model(DROP, blocks=blocks, coupling=1, pulling=1, damping=1)
        exponents = Exponents(blocks, 2, 0.0, np.array([0.0, 30.0]))
        runner = Runner(model, exponents=exponents, groups=groups, loading=loading)
        state = InitialState("rest", tuple(-0.9 + spread * np.sin(np.arange(1.0, blocks + 1.0))), 0.0)
        runner.begin(model.begin(state, "tested"))
        assert runner.run(30.0) == Status.COMPLETED
        return exponents

    alike, apart = run(0.0), run(0.1)
    assert (apart.unordered, apart.unordered_mirrors, apart.tied) == ((-1, -1),) * 3
    assert (alike.unordered if loading == "steady" else alike.tied)[0] >= 0


#: Without dashpots, quasi-static.
PAPER_CHAIN = Model("carlson_langer", a=1.0, sigma=0.2, v=1.0)
PAIR = Model("carlson_langer", a=1.0, sigma=0.2, blocks=2, coupling=1, pulling=1, v=1.0)


def rest(model, *position):
    return model.begin(InitialState("rest", position, 0.0), "tested")


def position_at(model, start, time):
    runner = Runner(model, loading="quasistatic")
    runner.begin(start)
    assert runner.run(time) == Status.COMPLETED
    return runner.state().position


@pytest.mark.parametrize("size", [1e-4, 1e-8, 1e-12])
def test_a_mirror_symmetric_start_under_quasistatic_loading_has_no_derivative(size):
    """The map jumps at τ = 2.7: the driver stops as soon as one of the end blocks starts."""
    symmetric, displaced = (rest(PAPER_CHAIN, -0.8 + d, -0.3, -0.8 - d) for d in (0.0, 0.5 * size))
    before, after = (
        np.abs(position_at(PAPER_CHAIN, displaced, time) - position_at(PAPER_CHAIN, symmetric, time)).max()
        for time in (2.5, 3.0)
    )
    assert before < 2.0 * size < 0.01 < 0.2 < after
    assert event_exponents(PAPER_CHAIN, symmetric, 2.5, begin=0.1).exponent[0] < 5.0
    assert event_exponents(PAPER_CHAIN, rest(PAPER_CHAIN, -0.8, -0.3, -0.81), 50.0).exponent[0] > 0.0
    with refused("blocks 1 and 3 start together"):
        event_exponents(PAPER_CHAIN, symmetric, 50.0)


def test_a_uniform_start_under_quasistatic_loading_has_no_derivative():
    """A displacement d grows as the square root of d: the second block waits until the first one has pulled it."""
    sizes = np.array([1e-6, 1e-8, 1e-10])
    alike = position_at(PAIR, rest(PAIR, -0.8, -0.8), 0.25)
    shifts = [np.abs(position_at(PAIR, rest(PAIR, -0.8 + d, -0.8), 0.25) - alike).max() for d in sizes]
    assert np.polyfit(np.log(sizes), np.log(shifts), 1)[0] == pytest.approx(0.5, abs=0.05)
    for call in (event_exponents, event_multipliers):
        with refused("blocks 1 and 2 start together"):
            call(PAIR, rest(PAIR, -0.8, -0.8), 50.0)


def test_commands_and_files_say_why_there_are_no_exponents(tmp_path, capsys):
    chain = ["--blocks", "4", "--coupling", "1", "--pulling", "1", "--damping", "1", "--initial", "alike"]
    law = ["--law", "carlson_langer", "--number", "sigma=0.1", "--a", "0.6"]
    state = ["--position=-0.9,-0.9,-0.9,-0.9", "--velocity", "0.1,0.1,0.1,0.1"]
    times = ["--transient", "50", "--window", "50"]
    path = str(tmp_path / "run.nc")
    for command in (["exponents", "--out", path], ["show", path], ["simulate", "--out", path]):
        options = [] if command[0] == "show" else [*law, *chain, *state, *times]
        assert main([*command, *options]) == 0
        assert "blocks 1 and 2, joined by a dashpot" in " ".join(capsys.readouterr().out.split())
    assert main(["orbit", *law, *chain[:8]]) != 0
    assert "blocks 1 and 2, joined by a dashpot" in capsys.readouterr().err


def test_an_orbit_error_is_raised_only_where_the_order_matters():
    with pytest.raises(OrbitError):
        multipliers(synchronized_orbit(Model(DROP, coupling=1, pulling=1, damping=1)))
