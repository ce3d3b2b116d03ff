"""Random chains, states, settings and command lines of `bk` are refused or give a run with a status."""

import contextlib
import io
import math
import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff.cli import main
from burridge_knopoff.dataset.point import STATUS_FLAG
from burridge_knopoff.laws import law_of
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from tests.fuzzing import check_refusal, examples

pytestmark = pytest.mark.slow

#: Limit on the steps of rk4, so that no test has to wait for a longer run.
MOST_STEPS = 20_000
ODD_NUMBERS = (math.nan, math.inf, -math.inf, -1.0, -0.0, 0.0, 5e-324, 1e-300, 1e-9, 2e9, 1e10, 1e300, 2.0, 10**400)
ODD_VALUES = (*ODD_NUMBERS, True, None, "", "0.1", [], (), 1 + 0j)
LAWS = (
    *({"law": law} for law in ("linearized", "linearized", "nonlinear", "nonlinear", "exponential")),
    {"law": "stribeck", "sigma": 0.1},
    {"law": "carlson_langer", "sigma": 0.05},
    {"formula": "1 - c*tanh(a*u/c)", "c": 0.2},
    {"formula": "0.9/(1 + a*u)**1.5"},
    {"formula": "1/sqrt(1 + a*u)"},
)


class Chance(random.Random):
    """Random choices of the inputs of a run."""

    def one_in(self, count):
        return self.randrange(count) == 0

    def power(self, low, high):
        return 10.0 ** self.uniform(low, high)

    def position(self):
        whole = [0.0, -0.0, 1.0, -1.0, 0.5, -0.989, -0.993, -0.991, 1e6, -1e6, 5e-324, 1e-12]
        neighbour = math.nextafter(self.choice([-1.0, 1.0, 0.5]), self.choice([-2.0, 2.0]))
        power = self.choice([1.0, -1.0]) * self.power(-12.0, 6.0)
        return self.choice([self.uniform(-1.5, 1.5), self.choice(whole), power, neighbour])

    def velocity(self, contact):
        value = self.choice([self.uniform(0.0, 0.2), 0.0, self.power(-12.0, 6.0)])
        return -value if contact == "symmetric" and self.one_in(3) else value

    def settings(self, blocks):
        transient = self.choice([0.0, self.power(-9.0, 1.7), self.uniform(0.0, 50.0)])
        window = self.choice([1e-3, self.power(-3.0, 1.7), self.uniform(1e-3, 50.0)])
        shortest = (transient + window) / MOST_STEPS
        return {
            "start": self.choice(["moving", "tested"]),
            "solver": self.choice(["series", "map", "series", "rk4"]),
            "step": max(self.power(-4.0, 1.0), shortest),
            "transient": transient,
            "window": window,
            "batches": self.choice([2, 7, 100, 10_000]),
            "sampling": self.choice([5.0, 1e9, max(self.power(-6.0, 2.0), shortest / 5.0)]),
            "trajectory": self.choice([0.0, 30.0, 1e9, self.power(-3.0, 2.0)]),
            "trajectory_sampling": self.choice([0.05, 1e9, self.power(-2.0, 2.0)]),
            "events": self.choice(["none", "window", "all"]),
            "event_window": self.choice([0.0, 1e9, self.power(-3.0, 2.0)]),
            "lyapunov_exponents": self.choice([0, 1, 3, 2 * blocks, 2 * blocks + 1]),
            "lyapunov_alignment": self.choice([0.0, 1e9, self.power(-3.0, 2.0)]),
        }

    def springs(self, blocks):
        """Return the paper's springs, another strength for all, or one strength each; sometimes one too many."""
        if self.one_in(2):
            return {}
        ends, extra = self.choice(["open", "ring"]), self.one_in(50)

        def strengths(count):
            powers = [self.power(-1.0, 1.0) for _ in range(count + extra)]
            return self.choice([self.power(-1.0, 1.0), powers, 1.0])

        pulling = "neighbours" if self.one_in(3) else strengths(blocks)
        coupling = strengths(blocks - (ends == "open"))
        return {"coupling": coupling, "pulling": pulling, "threshold": strengths(blocks), "ends": ends}

    def case(self):
        """Return the inputs of a run; in one of four cases something is odd."""
        blocks = self.choice([2, 3, 3, 3, 4, 5, 8])
        below_two = math.nextafter(2.0, 0.0)
        contact = self.choice(["one_sided", "one_sided", "symmetric"])
        case = {
            "law": self.choice(LAWS),
            "a": self.choice([0.0, 5e-324, 0.08, 1.0, below_two, self.uniform(0.0, 0.4), self.uniform(0.0, 2.0)]),
            "blocks": blocks,
            "position": [self.position() for _ in range(blocks)],
            "velocity": [self.velocity(contact) for _ in range(blocks)],
            "v": self.choice([0.1, 1e-6, 1e3, self.power(-6.0, 3.0)]),
            "contact": contact,
            "chain": self.springs(blocks),
            "settings": self.settings(blocks),
            "stuck": [self.one_in(2) for _ in range(blocks)] if self.one_in(8) else None,
        }
        if self.one_in(4):
            case["position"][-1] = case["position"][0]
        if self.one_in(4):
            self.make_odd(case, case["settings"], self.choice(ODD_VALUES))
        return case

    def make_odd(self, case, settings, odd):
        key = self.choice(["a", "v", "contact", "blocks", "position", "velocity", "chain", *settings])
        if key in ("position", "velocity"):
            case[key][0] = self.choice(ODD_NUMBERS)
        elif key == "chain":
            case[key][self.choice(["coupling", "pulling", "threshold", "ends"])] = odd
        elif key in settings:
            # The allowed steps would take hours.
            settings[key] = 0.0 if key == "step" and odd in (1e-9, 5e-324, 1e-300) else odd
        else:
            case[key] = odd


@examples(1000)
@given(st.integers(0, 2**64 - 1))
def test_a_run_is_refused_or_ends_with_a_status(seed):
    case = Chance(seed).case()
    try:
        with np.errstate(all="ignore"):
            state = InitialState("fuzzed", case["position"], case["velocity"])
            law = law_of({"fuzzed": case["law"]}, a=case["a"])
            model = Model(law, blocks=case["blocks"], **case["chain"], v=case["v"], contact=case["contact"])
            if case["stuck"]:
                begun, stuck = model.begin(state), np.array(case["stuck"])
                state = ChainState(begun.position, np.where(stuck, 0.0, begun.velocity), stuck)
            trajectory = run(model, state, Settings(**case["settings"]))
    except ValueError as error:
        check_refusal(error)
    else:
        check_trajectory(trajectory, case)


def check_trajectory(trajectory, case):
    """Require a status, and arrays of the right lengths with finite values in order, or NaN for unknown values."""
    model, settings, n = trajectory.model, trajectory.settings, trajectory.model.blocks
    assert model.parameter("a") >= 0.0
    assert (model.parameter("a"), model.v, model.contact) == (case["a"], case["v"], case["contact"])
    for key, value in case["settings"].items():
        assert not isinstance(value, float) or math.isfinite(value), key
        assert getattr(settings, key) == value, key
    assert trajectory.status in STATUS_FLAG["flag_meanings"].split()
    # The last piece of a run ends at the last sample, within rounding.
    rounding = 4.0 * math.ulp(settings.duration)
    assert 0.0 <= trajectory.end_time <= settings.duration + rounding, trajectory.end_time
    completed = trajectory.status == "completed"
    assert completed == (trajectory.end_time >= settings.duration - rounding), (trajectory.status, trajectory.end_time)
    batch, exponents = trajectory.batch_mean_distance, trajectory.lyapunov_exponent
    assert batch.shape == (settings.batches,)
    assert exponents.shape == (settings.lyapunov_exponents,)
    assert not np.isposinf(exponents).any()
    if completed:
        assert (batch >= 0.0).all()
        for name in ("batch_mean_distance", "mean_distance", "mean_distance_error", "distance", "position", "velocity"):
            assert np.isfinite(getattr(trajectory, name)).all(), name
    else:
        assert math.isnan(trajectory.mean_distance)
        assert np.isnan(batch).all()
        assert np.isnan(exponents).all()
    for times in (trajectory.earlier_event_time, trajectory.event_time, trajectory.crossing_time):
        assert (np.diff(times) >= 0.0).all()
        assert ((times >= 0.0) & (times <= trajectory.end_time)).all()
    assert len(trajectory.time) == len(trajectory.distance)
    assert len(trajectory.trajectory_time) == len(trajectory.position) == len(trajectory.velocity)
    events = len(trajectory.earlier_event_time) + len(trajectory.event_time)
    assert events == (trajectory.event_count if settings.events != "none" else 0)
    assert trajectory.event_position.shape == trajectory.event_velocity.shape == (len(trajectory.event_time), n)
    assert np.isfinite(trajectory.event_position).all()
    for blocks in (trajectory.event_block, trajectory.earlier_event_block):
        assert ((blocks >= 1) & (blocks <= n)).all()
    if model.contact == "one_sided" and settings.solver != "rk4":
        assert (trajectory.velocity[np.isfinite(trajectory.velocity)] >= 0.0).all()


WORDS = """
--law --formula --number --law-name --coupling --pulling --threshold --ends --a --v --contact --initial --blocks
--position --velocity --start --solver --step --transient --window --batches --lyapunov-exponents --lyapunov-alignment
--sampling --events --event-window --trajectory --trajectory-sampling
linearized nonlinear carlson_langer stribeck 1-a*u 1-b*u exp(-a*u) sigma=0.1 b=1 u= =1 ring open neighbours minus plus
pair one_sided symmetric moving tested map series rk4 none window all 0 -0 1 2 3 0.08 -0.1 2.0 nan inf -inf 1e400
1e-400 1_0 0x10 é 1,2 0.1,0.1 1,2,3 -1,2 ,, 1, two 1e300 1e-9 . .. simulate $(ls) a;b --law=nonlinear --a=0.1 --a=-1
--window=1 --window=nan --initial=x --initial=../x --help --version -h -- -
"""
SHORT = "simulate --law linearized --a 0.08 --transient 1 --window 2 --batches 2"
words = st.sampled_from(WORDS.split())


@st.composite
def command_lines(draw):
    """The arguments of a short run with a few words inserted, removed or replaced; --out with its file comes last."""
    arguments = SHORT.split()
    for _ in range(draw(st.integers(0, 4))):
        place = draw(st.integers(0, len(arguments)))
        arguments[place : place + draw(st.integers(0, 1))] = draw(st.lists(words, max_size=2))
    return arguments


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzzed")


@examples(400)
@given(command_lines())
def test_a_command_line_is_refused_or_runs(folder, arguments):
    """If it is refused, it writes one line to standard error and no file."""
    out, output, errors = folder / "fuzzed.nc", io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        try:
            code = main([*arguments, "--out", str(out)])
        except SystemExit as end:
            code = end.code
    if code == 0:
        assert out.exists() or output.getvalue()
        assert errors.getvalue().count("\n") <= 1
        out.unlink(missing_ok=True)
    else:
        assert code == 2
        assert output.getvalue() == ""
        assert errors.getvalue().count("\n") == 1, errors.getvalue()
    assert list(folder.iterdir()) == []
