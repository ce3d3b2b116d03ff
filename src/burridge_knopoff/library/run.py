"""A trajectory for notebooks and xarray."""

from __future__ import annotations

from typing import TYPE_CHECKING

from burridge_knopoff.dataset.point import to_dataset
from burridge_knopoff.library.catalogue import Catalogue, record_events
from burridge_knopoff.motion.kind import Motion, MotionKind, motion_of_run
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.running.settings import DURATION, TIME
from burridge_knopoff.running.trajectory import Trajectory
from burridge_knopoff.values import instance_of

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure


def motion_of(run: Trajectory, settings: MotionSettings) -> Motion:
    """Return the kind of motion of a run; settings : thresholds at v = 0.1."""
    scaled = settings.scaled_to_velocity(run.model.v)
    return motion_of_run(vars(run), run.model.chain.is_mirror_symmetric, scaled)


class Run(Trajectory):
    """A `Trajectory` that can be plotted and turned into a Dataset; `simulate` returns one.

    >>> from burridge_knopoff import Model, simulate
    >>> model = Model("linearized", a=0.08)
    >>> run = simulate(model, "plus", transient=0, window=20)
    >>> run.to_dataset().velocity.dims
    ('trajectory_time', 'block')
    >>> simulate(model, "plus").motion().kind.words
    'periodic'
    >>> simulate(model.at(a=0.1), transient=100, window=20).catalogue(100)
    <Catalogue of 17 slip events of 3 blocks, linearized law, a = 0.1, τ = 120 to 220, completed>
    """

    @property
    def kind(self) -> MotionKind:
        """Kind of motion in the window, with the thresholds of the default study."""
        return self.motion().kind

    @property
    def period(self) -> float:
        """Time after which the motion repeats, infinite or NaN if it does not; see `Motion`."""
        return self.motion().period

    def motion(self, settings: MotionSettings = MOTION) -> Motion:
        """Return the kind of motion in the window and its period, as the run alone shows them; see `Motion`.

        settings : thresholds, at v = 0.1; they are scaled to the v of the run

        A study compares the run with the attractors at its a as well, which are followed for longer.
        """
        return motion_of(self, instance_of(settings, MotionSettings, "settings"))

    def plot(self) -> Figure:
        """Return a figure of J(τ) and of the velocities U_i'(τ) in the last part of the run."""
        # Imported here so that matplotlib is loaded only for a picture.
        from burridge_knopoff.figures.single_run import plot_run

        return plot_run(self)

    def to_dataset(self) -> xarray.Dataset:
        """Return the run as an xarray Dataset, with the content of its point file."""
        return to_dataset(self)

    def catalogue(
        self, window: float = 7000.0, *, transient: float = 0.0, profiles: bool = False, loading: str = "steady"
    ) -> Catalogue:
        """Return the catalogue of slip events of a run that continues from the end of this one with the same solver.

        window : length of the catalogue; transient : time before it; both on the loading clock
        profiles, loading : see `record_events`

        Raises ValueError as `record_events` does.
        """
        window, transient = TIME.form(window, "window"), DURATION.form(transient, "transient")
        begin = self.end_time + transient
        return record_events(
            self.model,
            self.final,
            begin + window,
            begin=begin,
            profiles=profiles,
            loading=loading,
            solver=self.settings.solver,
            step=self.settings.step,
        )
