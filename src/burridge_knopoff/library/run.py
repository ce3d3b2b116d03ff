"""A trajectory for notebooks and xarray."""

from __future__ import annotations

from typing import TYPE_CHECKING

from burridge_knopoff.dataset.point import to_dataset
from burridge_knopoff.library.plot import plot_run
from burridge_knopoff.running.trajectory import Trajectory

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure


class Run(Trajectory):
    """A `Trajectory` that can be plotted and turned into a Dataset; `simulate` returns one.

    >>> from burridge_knopoff import simulate
    >>> run = simulate("linearized", 0.08, "plus", transient=0, window=20)
    >>> run.to_dataset().velocity.dims
    ('trajectory_time', 'block')
    """

    def plot(self) -> Figure:
        """Return a figure of J(τ) and of the velocities U_i'(τ) in the last part of the run."""
        return plot_run(self)

    def to_dataset(self) -> xarray.Dataset:
        """Return the run as an xarray Dataset, the same as its point file."""
        return to_dataset(self)
