"""Any chain, state and settings as a run, and any words as a command line of `bk`: refused, or a run with a status."""

from __future__ import annotations

import contextlib
import io
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from burridge_knopoff.cli import main
from burridge_knopoff.dataset.point import STATUS_FLAG
from burridge_knopoff.laws import law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.running.trajectory import Trajectory
from tests.fuzzing.source import Source

#: The longest run, and steps of rk4: what is asked for beyond is refused or done, not waited for.
LONGEST = 100.0
MOST_STEPS = 20_000

BELOW_TWO = math.nextafter(2.0, 0.0)
LAWS: tuple[dict[str, Any], ...] = (
    *2 * ({"law": "linearized"}, {"law": "nonlinear"}),
    {"law": "exponential"},
    {"law": "stribeck", "sigma": 0.1},
    {"law": "carlson_langer", "sigma": 0.05},
    {"formula": "1 - c*tanh(a*u/c)", "c": 0.2},
    {"formula": "0.9/(1 + a*u)**1.5"},
    {"formula": "1/sqrt(1 + a*u)"},
)
ODD_NUMBERS = (math.nan, math.inf, -math.inf, -1.0, -0.0, 0.0, 5e-324, 1e-300, 1e-9, 1e9, 1e10, 1e300, 2.0, 10**400)
ODD_VALUES = (*ODD_NUMBERS, True, None, "", "0.1", [], (), 1 + 0j)


def _position(source: Source) -> float:
    return source.choice(
        [
            lambda: source.uniform(-1.5, 1.5),
            lambda: source.choice([0.0, -0.0, 1.0, -1.0, 0.5, -0.989, -0.993, -0.991, 1e6, -1e6, 5e-324, 1e-12]),
            lambda: source.choice([1.0, -1.0]) * source.power(-12.0, 6.0),
            lambda: math.nextafter(source.choice([-1.0, 1.0, 0.5]), source.choice([-2.0, 2.0])),
        ]
    )()


def _velocity(source: Source, symmetric: bool) -> float:
    value = source.choice([lambda: source.uniform(0.0, 0.2), lambda: 0.0, lambda: source.power(-12.0, 6.0)])()
    return -value if symmetric and source.chance(3) else value


def draw_run(data: bytes) -> tuple[Callable[[], Trajectory], dict[str, Any]]:
    """Return a run that may or may not be allowed, and what it is made of."""
    source = Source(data)
    blocks = source.choice([2, 3, 3, 3, 4, 5, 8])
    law = source.choice(LAWS)
    a = source.choice([0.0, 5e-324, 0.08, 1.0, BELOW_TWO, source.uniform(0.0, 0.4), source.uniform(0.0, 2.0)])
    contact = source.choice(["one_sided", "one_sided", "symmetric"])
    transient = source.choice([0.0, source.power(-9.0, 1.7), source.uniform(0.0, 50.0)])
    window = source.choice([1e-3, source.power(-3.0, 1.7), source.uniform(1e-3, 50.0)])
    settings: dict[str, Any] = {
        "start": source.choice(["moving", "tested"]),
        "solver": source.choice(["series", "map", "series", "rk4"]),
        "step": max(source.power(-4.0, 1.0), (transient + window) / MOST_STEPS),
        "transient": transient,
        "window": window,
        "batches": source.choice([2, 7, 100, 10_000]),
        "sampling": source.choice([5.0, 1e9, max(source.power(-6.0, 2.0), (transient + window) / 1e5)]),
        "trajectory": source.choice([0.0, 30.0, 1e9, source.power(-3.0, 2.0)]),
        "trajectory_sampling": source.choice([0.05, 1e9, source.power(-2.0, 2.0)]),
        "events": source.choice(["none", "window", "all"]),
        "event_window": source.choice([0.0, 1e9, source.power(-3.0, 2.0)]),
        "lyapunov_exponents": source.choice([0, 1, 3, 2 * blocks, 2 * blocks + 1]),
        "lyapunov_alignment": source.choice([0.0, 1e9, source.power(-3.0, 2.0)]),
    }
    position = [_position(source) for _ in range(blocks)]
    if source.chance(4):
        position[-1] = position[0]
    velocity = [_velocity(source, contact == "symmetric") for _ in range(blocks)]
    case: dict[str, Any] = {"law": law, "a": a, "blocks": blocks, "position": position, "velocity": velocity}
    case["v"] = source.choice([0.1, 1e-6, 1e3, source.power(-6.0, 3.0)])
    case["contact"] = contact
    case["chain"] = _chain(source, blocks)
    case["settings"] = settings
    if source.chance(4):
        odd = source.choice(ODD_VALUES)
        key = source.choice(["a", "v", "contact", "blocks", "position", "velocity", "chain", *settings])
        if key in ("position", "velocity"):
            case[key][0] = source.choice(ODD_NUMBERS)
        elif key == "chain":
            case["chain"][source.choice(["coupling", "pulling", "threshold", "ends"])] = odd
        elif key in settings:
            settings[key] = odd
            _stay_short(settings)
        else:
            case[key] = odd
    stuck = None
    if source.chance(8):
        stuck = np.array([source.chance(2) for _ in range(blocks)])

    def begin() -> Trajectory:
        state = InitialState("fuzzed", case["position"], case["velocity"])
        law = law_of("fuzzed", case["a"], case["law"])
        model = Model(Chain(case["blocks"], **case["chain"]), law, case["v"], case["contact"])
        at = None
        if stuck is not None:
            begun = model.begin(state)
            at = Instant(begun.position, np.where(stuck, 0.0, begun.velocity), stuck)
        return run(model, state, Settings(**settings), at)

    return begin, case


def _chain(source: Source, blocks: int) -> dict[str, Any]:
    """Return the springs of a chain: the paper's, other ones for all, or one each; sometimes one too many."""
    if source.chance(2):
        return {}
    ends = source.choice(["open", "ring"])

    def strengths(count: int) -> Any:
        count += source.chance(50)
        return source.choice(
            [lambda: source.power(-1.0, 1.0), lambda: [source.power(-1.0, 1.0) for _ in range(count)], lambda: 1.0]
        )()

    pulling = "neighbours" if source.chance(3) else strengths(blocks)
    springs = blocks - (ends == "open")
    return {"coupling": strengths(springs), "pulling": pulling, "threshold": strengths(blocks), "ends": ends}


def _stay_short(settings: dict[str, Any]) -> None:
    """Leave out odd settings that are allowed and take hours."""
    for key in ("transient", "window"):
        if settings[key] == 1e9:
            settings[key] = 2e9
    if settings["step"] in (1e-9, 5e-324, 1e-300):
        settings["step"] = 0.0


def check_run(data: bytes) -> bool:
    """Run what the bytes say; return True if it ran, False if it was refused with one line."""
    begin, case = draw_run(data)
    try:
        with np.errstate(all="ignore"):
            trajectory = begin()
    except ValueError as error:
        message = str(error)
        assert "\n" not in message, message
        assert ": " in message, message
        assert len(message) < 600, message
        return False
    check_trajectory(trajectory, case)
    return True


def check_trajectory(trajectory: Trajectory, case: dict[str, Any]) -> None:
    """Require a status, and arrays of the right lengths with finite values in order; NaN where nothing is known."""
    model, settings, n = trajectory.model, trajectory.settings, trajectory.model.blocks
    assert model.a >= 0.0
    assert (model.a, model.v, model.contact) == (case["a"], case["v"], case["contact"])
    for key, value in case["settings"].items():
        assert not isinstance(value, float) or math.isfinite(value), key
        assert getattr(settings, key) == value, key
    assert trajectory.status in STATUS_FLAG["flag_meanings"].split()
    # The last piece of a run ends at the last sample, within rounding.
    rounding = 4.0 * math.ulp(settings.duration)
    assert 0.0 <= trajectory.end_time <= settings.duration + rounding, trajectory.end_time
    completed = trajectory.status == "completed"
    assert completed == (trajectory.end_time >= settings.duration - rounding), (trajectory.status, trajectory.end_time)
    batch = trajectory.batch_mean_distance
    assert batch.shape == (settings.batches,)
    if completed:
        assert np.isfinite(batch).all()
        assert (batch >= 0.0).all()
        assert math.isfinite(trajectory.mean_distance)
        assert math.isfinite(trajectory.mean_distance_error)
        assert np.isfinite(trajectory.distance).all()
        assert np.isfinite(trajectory.position).all()
        assert np.isfinite(trajectory.velocity).all()
    else:
        assert math.isnan(trajectory.mean_distance)
        assert np.isnan(batch).all()
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
    exponents = trajectory.lyapunov_exponent
    assert exponents.shape == (settings.lyapunov_exponents,)
    assert not np.isposinf(exponents).any()
    if not completed:
        assert np.isnan(exponents).all()


OPTIONS = """--law --formula --number --law-name --coupling --pulling --threshold --ends
--a --v --contact --initial --blocks --position --velocity --start --solver --step --transient
--window --batches --lyapunov-exponents --lyapunov-alignment --sampling --events --event-window --trajectory
--trajectory-sampling"""
VALUES = """linearized nonlinear carlson_langer stribeck 1-a*u 1-b*u exp(-a*u) sigma=0.1 b=1 u= =1 ring open neighbours
minus plus pair one_sided symmetric moving tested map series rk4 none window all 0
-0 1 2 3 0.08 -0.1 2.0 nan inf -inf 1e400 1e-400 1_0 0x10 ٣ é 1,2 0.1,0.1 1,2,3 -1,2 ,, 1, two 1e9 1e-9 . ..
simulate $(ls) a;b 1e5 --law=nonlinear --a=0.1 --a=-1 --window=1 --window=nan --initial=x --initial=../x --help
--version -h -- - --out"""
SHORT = "simulate --law linearized --a 0.08 --transient 1 --window 2 --batches 2"


def draw_arguments(data: bytes, out: Path) -> list[str]:
    """Return arguments of `bk`: those of a short run with a few words put in, cut out or replaced."""
    source = Source(data)
    options, values = OPTIONS.split(), VALUES.split()
    arguments = [*SHORT.split(), "--out", str(out)]
    for _ in range(source.integer(0, 4)):
        place = source.integer(0, len(arguments) - 1)
        kind = source.integer(0, 3)
        if arguments[place] == str(out) or "--out" in arguments[place - 1 : place + 1]:
            continue
        if kind == 0:
            del arguments[place]
        elif kind == 1:
            arguments[place] = source.choice([*options, *values])
        elif kind == 2:
            arguments[-2:-2] = [source.choice(options), source.choice(values)]
        else:
            arguments.insert(place, source.choice([*options, *values]))
    return arguments


def check_arguments(data: bytes, folder: Path) -> bool:
    """Give `bk` these arguments; return True if it ran, False if it refused with one line and wrote nothing."""
    before = sorted(folder.iterdir())
    out = folder / "fuzzed.nc"
    arguments = draw_arguments(data, out)
    if any(word in ("1e9", "1e5") for word in arguments):
        # Long runs are allowed, and not waited for.
        arguments = [word if word not in ("1e9", "1e5") else "1e300" for word in arguments]
    output, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        try:
            code = main(arguments)
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else 1
    if code == 0 and (out.exists() or output.getvalue()):
        assert errors.getvalue().count("\n") <= 1
        out.unlink(missing_ok=True)
        return True
    assert code == 2, (code, arguments)
    assert output.getvalue() == ""
    assert errors.getvalue().count("\n") == 1, errors.getvalue()
    assert sorted(folder.iterdir()) == before, arguments
    return False
