"""Runs along a, one on each core."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Unpack

import numpy as np

from burridge_knopoff.dataset.point import to_dataset
from burridge_knopoff.library.by_name import RunSettings, settings_of, shows
from burridge_knopoff.library.coercion import GivenLaw, Initial, given_model, given_state
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.ranges import Whole
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.values import shown

if TYPE_CHECKING:
    import xarray

#: Dimensions of the same size in every run.
_EVERYWHERE = {"batch", "exponent"}


@shows(Settings)
def sweep(
    law: Model | GivenLaw,
    a: Sequence[float] | np.ndarray,
    initial: Initial = "minus",
    settings: Settings | None = None,
    *,
    chain: Chain | None = None,
    v: float | None = None,
    contact: str | None = None,
    cores: int | None = None,
    **by_name: Unpack[RunSettings],
) -> xarray.Dataset:
    """Run a simulation at each of several a, and return the numbers of a run, a batch or an exponent, over a.

    law : a `Model`, at any a, with its own chain, v and contact; or a law in any form that `simulate` takes
    a : friction parameters, shape (n,); `a` of the Dataset, in the same order
    initial, settings, chain, v, contact, by_name : see `simulate`
    cores : number of simultaneous runs, by default the number of cores; results do not depend on it

    The variables are those of a point file (docs/data.md) with `a` as the first dimension, among them `mean_distance`,
    `mean_distance_error`, `lyapunov_exponent` and `status`, which is 0 for a completed run. Raises ValueError, one
    line, for a wrong argument; an error at one a names it.

    >>> from burridge_knopoff import sweep
    >>> runs = sweep("nonlinear", [0.02, 0.05, 0.3], transient=1000, window=500, batches=2)
    >>> runs.mean_distance.dims, runs.lyapunov_exponent.shape
    (('a',), (3, 3))
    >>> (runs.mean_distance < 1e-6).values.tolist()
    [True, True, False]
    """
    state = given_state(initial)
    chosen = settings_of(Settings, settings, by_name)
    values = np.asanyarray(a, dtype=object).ravel().tolist()
    if not values:
        raise ValueError("a: got no value, expected at least one")
    if cores is not None:
        cores = Whole(1, 1024).form(cores, "cores")
    if isinstance(law, Model):
        models = [given_model(law, None, 0, chain, v, contact).at(value) for value in values]
    else:
        models = [given_model(law, value, state.blocks, chain, v, contact) for value in values]
    value, count = Counter(model.a for model in models).most_common(1)[0]
    if count > 1:
        raise ValueError(f"a: got {shown(value)} twice, expected each value once")
    for model in models:
        chosen.check_chain(model.chain)
        model.begin(state, chosen.start)

    def one(model: Model) -> xarray.Dataset:
        try:
            return _numbers(to_dataset(run(model, state, chosen)))
        except (ValueError, MemoryError) as error:
            raise type(error)(f"a = {model.a!r}: {error}") from error

    # The kernel releases Python's global lock while it runs: threads use all cores.
    with ThreadPoolExecutor(cores or _cores()) as pool:
        try:
            found = list(pool.map(one, models))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    import xarray

    return xarray.concat(
        found, "a", data_vars=[*found[0]], coords="minimal", compat="override", combine_attrs="drop_conflicts"
    )


def _numbers(point: xarray.Dataset) -> xarray.Dataset:
    """Return a run without the dimensions that vary between runs, and without the description of its initial state."""
    kept = [name for name, item in point.data_vars.items() if set(item.dims) <= _EVERYWHERE]
    return point[kept].drop_vars("block", errors="ignore")


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
