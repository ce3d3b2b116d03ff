"""The catalogue of slip events of a run."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from burridge_knopoff.kernel._core import Catalogue
from burridge_knopoff.messages import refusal
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.ranges import Number, OneOf, TrueOrFalse
from burridge_knopoff.running.runner import Runner, new_observer
from burridge_knopoff.running.settings import TIME, check_step
from burridge_knopoff.running.solvers import SOLVERS
from burridge_knopoff.running.status import Status
from burridge_knopoff.values import MOST_NUMBERS, instance_of

#: Largest number of events, and of slips in profiles, that a run stores.
MOST_EVENTS = MOST_NUMBERS / 10
TIMES = Number(-1e15, 1e15)

#: Columns with an entry for each block of each event.
PROFILES = ("slip_block", "slip", "slip_onset")

#: Limit on a fixed step times the highest frequency: a tenth of the shortest period. It is higher than the limit of
#: other runs, so that the effect of the step on a catalogue can be studied.
LONGEST_STEP = 0.2 * math.pi


@dataclass(frozen=True, eq=False)
class SlipEvents:
    """Slip events in the order of their start times; arrays of shape (events,).

    A slip of a block lasts from its start to its stop. Slips of neighbouring blocks that overlap in time are connected,
    and an event is a connected set of slips. Blocks are numbered from 1; all quantities are in the units of `Model`.

    time : τ of the first start; slip_time : the same on the slip clock, which differs under quasi-static loading
    duration : slip time from the first start to the last stop, without creep
    epicentre : block that starts first
    first_block, last_block : ends of the event along the chain. In a ring, `first_block` exceeds `last_block` if the
        event spans the seam
    blocks : number of blocks that slip; moment : sum of their slips; largest_slip : largest slip of a block
    peak_velocity : highest slip speed of a block
    stress_drop : decrease of the spring force by the slips, mean over the blocks
    energy_released : work of the springs on the blocks, which friction and dashpots dissipate
    energy_damped : energy dissipated by the dashpots at slipping blocks, ∫ Σ c_ij (U_j' − U_i')² + Σ c_i (v − U_i')² dτ
    interval : τ since the start of the previous event in which the epicentre slipped; NaN if there is none
    slip_block, slip, slip_onset : with profiles, the blocks of all events, the slip of each, and the slip time from the
        first start of the event to the first start of the block; slip_end : end of each event in these arrays
    status : how the run ended
    final : the state at the end, from which another run continues, with the events that have not ended

    >>> from burridge_knopoff import InitialState, Model, record_events
    >>> model = Model("nonlinear", a=0.5, blocks=2, pulling=1, v=0.01)
    >>> start = model.begin(InitialState("own", (-0.9, -0.8), (0.0, 0.0)), "tested")
    >>> events = record_events(model, start, 40.0)
    >>> events.epicentre.tolist(), events.blocks.tolist()
    ([1, 1, 1, 1, 2], [1, 1, 1, 1, 2])
    >>> events.magnitude.round(2).tolist()
    [-3.64, -3.64, -3.64, -3.64, -1.86]
    """

    time: np.ndarray = field(repr=False)
    slip_time: np.ndarray = field(repr=False)
    duration: np.ndarray = field(repr=False)
    epicentre: np.ndarray = field(repr=False)
    first_block: np.ndarray = field(repr=False)
    last_block: np.ndarray = field(repr=False)
    blocks: np.ndarray = field(repr=False)
    moment: np.ndarray = field(repr=False)
    largest_slip: np.ndarray = field(repr=False)
    peak_velocity: np.ndarray = field(repr=False)
    stress_drop: np.ndarray = field(repr=False)
    energy_released: np.ndarray = field(repr=False)
    energy_damped: np.ndarray = field(repr=False)
    interval: np.ndarray = field(repr=False)
    slip_end: np.ndarray = field(repr=False)
    slip_block: np.ndarray = field(repr=False)
    slip: np.ndarray = field(repr=False)
    slip_onset: np.ndarray = field(repr=False)
    status: Status
    final: ChainState = field(repr=False)

    @property
    def magnitude(self) -> np.ndarray:
        """ln |moment|; the moment may be negative, since blocks may slip backward under symmetric contact."""
        with np.errstate(divide="ignore"):
            return np.log(np.abs(self.moment))


def record_events(
    model: Model,
    state: ChainState,
    end: float,
    *,
    begin: float | None = None,
    profiles: bool = False,
    loading: str = "steady",
    solver: str = "series",
    step: float = 1e-3,
) -> SlipEvents:
    """Return the slip events of a run that start after `begin` and end before the end of the run.

    state, end : state at the start of the run, and τ of its end
    begin : earlier events are omitted, by default none; they still count for the intervals
    profiles : whether the slip of every block, and when it starts, is stored
    loading : steady: the driver moves at velocity v | quasistatic: the driver stops while any block slips; when all
        stick or creep it advances to the next slip. In the second case τ is the displacement of the driver divided by
        v, and the slip clock runs while blocks slip. An overdamped slip does not end: it creeps, at the kinetic
        friction of zero speed, and its event goes on
    solver : series, map (where the motion has a closed form), or, for comparison, a solver with a fixed step and events
        at step ends: rk4, or euler (explicit)
    step : step of rk4 and euler

    Blocks that slip at the start of the run belong to no event until they have stopped.

    Raises ValueError, one line, for an end that is not after `state` and `begin`; for an unknown solver; for a step
    that is not above 0, is longer than a tenth of the shortest period of the chain, or needs too many steps; for map if
    the model has no closed form; for more than MOST_EVENTS events; and for quasi-static loading if friction does not
    drop at the start of a slip.
    """
    instance_of(model, Model, "model")
    instance_of(state, ChainState, "state")
    begin = TIMES.least if begin is None else TIMES.form(begin, "begin")
    end = TIMES.form(end, "end")
    if end <= state.time:
        raise refusal("end", end, f"a time after the start ({state.time:g})")
    if end <= begin:
        raise refusal("end", end, f"a time after begin ({begin:g})")
    profiles = TrueOrFalse().form(profiles, "profiles")
    solver = OneOf(tuple(SOLVERS)).form(solver, "solver")
    step = TIME.form(step, "step")
    stepping = SOLVERS[solver].has_fixed_step
    if stepping:
        check_step(step, LONGEST_STEP, end - state.time, model.chain)
    observer = new_observer(model, [end, end], section_only=True) if stepping else None
    catalogue = Catalogue(model.blocks, begin, profiles, MOST_EVENTS)
    runner = Runner(model, solver, step=step, observer=observer, catalogue=catalogue, loading=loading)
    runner.begin(state)
    status = runner.run(None if stepping else end)
    table = catalogue.take()
    order = np.lexsort((table["slip_time"], table["time"]))
    ends, *profile = (table.pop(name) for name in ("slip_end", *PROFILES))
    for name in table:
        table[name] = table[name][order]
    if profiles:
        counts = table["blocks"]
        first = (ends - np.diff(ends, prepend=0))[order]
        ends = np.cumsum(counts)
        index = np.repeat(first - ends + counts, counts) + np.arange(counts.sum())
        profile = [column[index] for column in profile]
    columns = dict(zip(PROFILES, profile, strict=True))
    return SlipEvents(**table, slip_end=ends, **columns, status=status, final=runner.final(status))
