"""The fraction of sampled initial states that synchronize, over a and the number of blocks.

A chain file has the results of `motion.chain_synchronization` for one number of blocks; the summary collects all.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
import xarray
from numpy.typing import ArrayLike

from burridge_knopoff.dataset.summary import STATE, axes, summary
from burridge_knopoff.dataset.variables import Variable, flag, global_attributes
from burridge_knopoff.model.fields import settings_from_config
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.parameters import CHAIN_PARAMETERS
from burridge_knopoff.model.sampling import CONFIDENCE, fraction_interval
from burridge_knopoff.motion.chain_synchronization import (
    Outcome,
    Sample,
    Watch,
    watch_chain,
)
from burridge_knopoff.study.formatting import friction_words
from burridge_knopoff.study.model import models_of

_POINT = ("law", "a")
_OWN_ATTRIBUTES = ("blocks", *global_attributes("", {}, module=__name__))
_STATE = (*_POINT, "state")
_SYMMETRIC = (*_POINT, "symmetric_state")
CHAIN_VARIABLES = {
    "outcome": Variable(_STATE, "i1", "outcome: whether the mirror blocks synchronize", flag("i1", Outcome)),
    "time": Variable(
        _STATE, "f8", "time tau at which the synchronization distance was reached, NaN if it was not reached"
    ),
    "distance": Variable(
        _STATE, "f8", "largest mirror distance in the last quarter of the time limit, or at that time"
    ),
    "mean_distance": Variable(
        _STATE, "f8", "mean mirror distance in the last quarter of the time limit, or at that time"
    ),
    "pairs": Variable(
        _STATE, "i2", "number of pairs of mirror blocks that stay synchronized in the last quarter of the time limit"
    ),
    "transverse_exponent": Variable(
        _STATE,
        "f8",
        "largest transverse Lyapunov exponent of the symmetric motion that was reached or is nearby, otherwise NaN",
    ),
    "symmetric_exponent": Variable(_SYMMETRIC, "f8", "largest transverse Lyapunov exponent of symmetric motion"),
    "symmetric_error": Variable(_SYMMETRIC, "f8", "standard error of this exponent from batches"),
    "lyapunov_exponent": Variable(_POINT, "f8", "largest Lyapunov exponent of the first state"),
    "lyapunov_error": Variable(_POINT, "f8", "error of this exponent, from batches and from the length of the window"),
}
VARIABLES = {
    **{
        name: Variable(("blocks", *item.dimensions), item.dtype, item.long_name, item.attributes)
        for name, item in CHAIN_VARIABLES.items()
    },
    **{
        name: Variable(("blocks", *_POINT), "f8", long_name)
        for name, long_name in {
            "synchronized_fraction": "fraction of the states that synchronize",
            "synchronized_low": "lower end of its confidence interval",
            "synchronized_high": "upper end of its confidence interval, undetermined states counted as synchronized",
            "undetermined_fraction": "fraction of the states that are undetermined",
            "partial_fraction": "fraction of the states in which some but not all pairs of mirror blocks synchronize",
            "mean_mirror_distance": "mean over the states of the mean mirror distance; synchronized states count as 0",
        }.items()
    },
}


def chain_of_length(config: Mapping[str, Any], blocks: int) -> xarray.Dataset:
    """Return the outcomes for one number of blocks; config : the keys of a study's config that decide them."""
    chains = config["chains"]
    models = models_of(config, chains["a"][0], blocks)
    sample = settings_from_config(Sample, {**config, **chains})
    return chain_dataset(models, chains["a"], sample, settings_from_config(Watch, {**config, **chains}))


def chain_dataset(models: Sequence[Model], grid: Sequence[float], sample: Sample, watch: Watch) -> xarray.Dataset:
    """Return the chain file of one number of blocks; see `watch_chain`."""
    values = watch_chain(models, grid, sample, watch)
    first = models[0]
    return summary(
        f"Mirror synchrony of sampled initial states, {first.blocks} blocks",
        CHAIN_VARIABLES,
        values,
        _coordinates([model.law.name for model in models], grid, sample.samples, sample.symmetric_samples),
        {
            "history": "snakemake chains",
            "blocks": first.blocks,
            **{name: getattr(first.chain, name) for name in (*CHAIN_PARAMETERS, "ends")},
            "friction": friction_words(model.law for model in models),
            "v": first.v,
            "contact": first.contact,
            **asdict(watch),
            **asdict(sample),
        },
        module=__name__,
    )


def merge(parts: Sequence[xarray.Dataset]) -> xarray.Dataset:
    """Combine chain files in the order of their numbers of blocks, and count outcomes."""
    chains = sorted(parts, key=lambda chain: chain.attrs["blocks"])
    first = chains[0]
    values = {name: np.stack([chain[name].values for chain in chains]) for name in CHAIN_VARIABLES}
    values.update(_fractions(values["outcome"], values["pairs"], values["mean_distance"]))
    coordinates = {
        "blocks": (
            "blocks",
            np.array([chain.attrs["blocks"] for chain in chains], dtype="i4"),
            {"long_name": "number N of blocks", "units": "1"},
        ),
        **_coordinates(first["law"].values, first["a"].values, first.sizes["state"], first.sizes["symmetric_state"]),
    }
    kept = {name: value for name, value in first.attrs.items() if name not in _OWN_ATTRIBUTES}
    return summary(
        "Mirror synchrony of longer chains",
        VARIABLES,
        values,
        coordinates,
        {"confidence": CONFIDENCE, **kept},
        module=__name__,
    )


def _coordinates(laws: ArrayLike, grid: ArrayLike, states: int, symmetric_states: int) -> dict[str, Any]:
    symmetric = {"long_name": "number of the sampled initial state that was made symmetric", "units": "1"}
    return {
        **axes(law=np.asarray(laws).tolist(), a=np.asarray(grid).tolist()),
        "state": ("state", np.arange(1, states + 1, dtype="i4"), STATE.all_attributes()),
        "symmetric_state": ("symmetric_state", np.arange(1, symmetric_states + 1, dtype="i4"), symmetric),
    }


def _fractions(outcome: np.ndarray, pairs: np.ndarray, mean_distance: np.ndarray) -> dict[str, np.ndarray]:
    """Return the counted variables, shape (blocks, laws, a)."""
    synchronized = outcome == Outcome.SYNCHRONIZED
    undetermined = outcome == Outcome.UNDETERMINED
    states = outcome.shape[-1]
    low, high = np.zeros(outcome.shape[:-1]), np.zeros(outcome.shape[:-1])
    for index in np.ndindex(low.shape):
        certain, possible = synchronized[index].sum(), (synchronized | undetermined)[index].sum()
        low[index] = fraction_interval(int(certain), states)[1]
        high[index] = fraction_interval(int(possible), states)[2]
    return {
        "synchronized_fraction": synchronized.mean(axis=-1),
        "synchronized_low": low,
        "synchronized_high": high,
        "undetermined_fraction": undetermined.mean(axis=-1),
        "partial_fraction": ((outcome == Outcome.NOT_SYNCHRONIZED) & (pairs > 0)).mean(axis=-1),
        "mean_mirror_distance": np.where(synchronized, 0.0, mean_distance).mean(axis=-1),
    }
