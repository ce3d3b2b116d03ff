"""Catalogues of slip events for notebooks and xarray."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.catalogue import events
from burridge_knopoff.catalogue.batches import batch_index, batch_sums, rate_error, ratio_error
from burridge_knopoff.catalogue.distribution import fit_range
from burridge_knopoff.catalogue.events import SlipEvents
from burridge_knopoff.catalogue.slope import Slope, fit_slope
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.messages import refusal
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.running.status import Status, early_end
from burridge_knopoff.values import is_sequence, real_array

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike


@dataclass(frozen=True, eq=False, repr=False)
class Catalogue(SlipEvents):
    """`SlipEvents` of a model that can be plotted and turned into a Dataset; `record_events` returns them.

    begin_time, end_time : ends of the catalogue on the loading clock; loading, solver : of the run

    >>> from burridge_knopoff import InitialState, Model, record_events
    >>> model = Model("carlson_langer", a=3.0, blocks=20, coupling=9, pulling=1, v=0.01)
    >>> rough = {"random": "uniform", "low": -1.0, "high": -0.9, "seed": 1}
    >>> events = record_events(model, model.begin(InitialState("rough", rough, 0.0), "tested"), 500.0, begin=100.0)
    >>> events.slope().count > 10
    True
    >>> rate, error = events.rate(events.blocks > 1)
    >>> bool(0.0 < error < rate)
    True
    >>> events.to_dataset().magnitude.dims
    ('event',)
    """

    model: Model
    begin_time: float
    end_time: float
    loading: str
    solver: str

    def __repr__(self) -> str:
        return (
            f"<Catalogue of {len(self.time)} slip events of {self.model.blocks} blocks, {self.model.words}, "
            f"τ = {self.begin_time:g} to {self.end_time:g}, "
            f"{early_end(self.status, self.final.time) or self.status.name.lower()}>"
        )

    def rate(self, chosen: ArrayLike | None = None) -> tuple[float, float]:
        """Return the number of events per unit of τ and its standard error, by batch means (`catalogue.batches`).

        chosen : mask of the events that count, shape (events,); by default all count

        Both are NaN if the run did not complete. Raises ValueError for a mask of another shape.
        """
        mask = np.ones(len(self.time), dtype=bool) if chosen is None else self._column(chosen, "chosen").astype(bool)
        length = self.end_time - self.begin_time if self.status == Status.COMPLETED else math.nan
        error = rate_error(batch_sums(self._batch[mask])[0], length)
        return float(mask.sum() / length), float(error)

    def mean(self, values: ArrayLike, weights: ArrayLike | None = None) -> tuple[float, float]:
        """Return the mean of a value over the events and its standard error, by batch means (`catalogue.batches`).

        values : of the events, shape (events,); the mean of a mask is the share of the events that it chooses
        weights : of the events, such as their moments, or a mask of those that count; by default all are 1

        The error is NaN if nearly all weight lies in a few batches. Raises ValueError for arrays of another shape.
        """
        value = self._column(values, "values")
        weight = np.ones(len(value)) if weights is None else self._column(weights, "weights")
        counts = weight != 0.0
        batch, weight, total = self._batch[counts], weight[counts], (weight * value)[counts]
        if not len(batch):
            return math.nan, math.nan
        error = ratio_error(batch_sums(batch, total), batch_sums(batch, weight))
        return float(total.sum() / weight.sum()), float(error[0])

    @property
    def _batch(self) -> np.ndarray:
        return batch_index(self.time, self.begin_time, self.end_time)

    def _column(self, values: ArrayLike, name: str) -> np.ndarray:
        is_mask = is_sequence(values) and np.asanyarray(values).dtype == bool
        column = real_array(np.asanyarray(values, dtype=int) if is_mask else values, name)
        if column.shape != self.time.shape:
            raise refusal(name, column.shape, f"shape {self.time.shape}, a value for each event")
        return column

    def slope(self, low: float | None = None, high: float | None = None) -> Slope:
        """Return the slope of the magnitudes from `low` to `high`; see `fit_slope`.

        By default from one bin above the most frequent magnitude of events with more than one block to the least
        frequent magnitude below the one that releases most moment. Raises ValueError, one line, if the run did not
        complete.
        """
        if ended := early_end(self.status, self.final.time):
            raise ValueError(f"slope: expected a complete catalogue: {ended}")
        ends = fit_range(self.magnitude, self.moment, self.blocks, low, high)
        return fit_slope(self.magnitude, *ends, time=self.time)

    def plot(self) -> Figure:
        """Return a figure of the slips in space and time, their recurrence, rates, extents and intervals."""
        # Imported here so that matplotlib is loaded only for a picture.
        from burridge_knopoff.figures.slip_events import draw_run
        from burridge_knopoff.summaries.catalogue import summarize

        return draw_run(
            summarize([self.to_dataset()], [self.model.law.name], [recorded_a(self.model.law)]).isel(law=0, a=0)
        )

    def to_dataset(self) -> xarray.Dataset:
        """Return the catalogue as an xarray Dataset, in the form of the catalogue files of a study."""
        from burridge_knopoff.catalogue.slip_events import catalogue_dataset

        about = {"start": "continued", "loading": self.loading, "solver": self.solver, "history": "record_events"}
        return catalogue_dataset(self, self.model, self.begin_time, self.end_time, about)


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
) -> Catalogue:
    """Return the catalogue of the slip events of a run that begin after a given time and end before its end.

    model : the model; state : its initial state, from `Model.begin` or the `final` of another run
    end : τ at the end of the run
    begin : events that begin earlier are left out, but count in the intervals; by default none is left out
    profiles : keep the slip of every block of each event, and when it starts
    loading : steady: the driver always moves | quasistatic: the driver stops while any block slips; when all stick or
        creep it advances to the next slip. An overdamped slip does not end: it creeps, and its event goes on
    solver, step : see `Settings`

    τ is the loading clock, the displacement of the driver divided by v. Blocks that slip at the start of the run belong
    to no event until they have stopped. Raises ValueError, one line, for anything that the model or the solver does not
    allow.

    >>> from burridge_knopoff import InitialState, Model, record_events
    >>> model = Model("linearized", a=0.1, blocks=1, pulling=1, v=0.01)
    >>> start = model.begin(InitialState("own", (-0.9,), (0.0,)), "tested")
    >>> events = record_events(model, start, 100.0)
    >>> len(events.time), events.blocks[0].item()
    (14, 1)
    """
    record = events.record_events(
        model, state, end, begin=begin, profiles=profiles, loading=loading, solver=solver, step=step
    )
    begin = state.time if begin is None else max(begin, state.time)
    return Catalogue(**vars(record), model=model, begin_time=begin, end_time=end, loading=loading, solver=solver)
