"""The fraction of sampled initial states that synchronize, over a and the number of blocks.

A chain file has the results of `motion.chain_synchronization` for one number of blocks; the summary collects all.

Blocks i and j = N + 1 − i are mirror blocks at the distance sqrt((U_i' − U_j')² + (U_i − U_j)²); the mirror distance is
the largest of these. Symmetric motion is nearby if it is below 0.01. `lyapunov_exponent` is taken in the second half of
the time limit.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import xarray

from burridge_knopoff.dataset.summary import axes, summary
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
from burridge_knopoff.summaries.sentences import values_where

_POINT = ("law", "a")
_OWN_ATTRIBUTES = ("blocks", *global_attributes("", {}, module=__name__))
_STATE = (*_POINT, "state")
_SYMMETRIC = (*_POINT, "symmetric_state")
BLOCKS = Variable(("blocks",), "i4", "number N of blocks", coordinate=True)
SYMMETRIC_STATE = Variable(
    _SYMMETRIC[2:], "i4", "number of the symmetric state: of the sampled state that was made symmetric", coordinate=True
)
CHAIN_VARIABLES = {
    "outcome": Variable(_STATE, "i1", "outcome: whether the mirror blocks synchronize", flag("i1", Outcome)),
    "time": Variable(
        _STATE,
        "f8",
        "synchronization time: first of the checks, 20 apart, at which the synchronization distance was reached, NaN "
        "if it was not reached",
    ),
    "distance": Variable(
        _STATE, "f8", "largest mirror distance: at the checks in the last quarter of the time limit, or at that time"
    ),
    "mean_distance": Variable(
        _STATE, "f8", "mean mirror distance: at the checks in the last quarter of the time limit, or at that time"
    ),
    "pairs": Variable(
        _STATE,
        "i2",
        "number of synchronized pairs: pairs of mirror blocks that are synchronized at all checks in the last quarter "
        "of the time limit",
    ),
    "transverse_exponent": Variable(
        _STATE,
        "f8",
        "largest transverse exponent: Lyapunov exponent of the symmetric motion that was reached or is "
        "nearby, otherwise NaN",
    ),
    "symmetric_exponent": Variable(
        _SYMMETRIC, "f8", "largest transverse exponent: Lyapunov exponent of symmetric motion"
    ),
    "symmetric_error": Variable(_SYMMETRIC, "f8", "standard error of this exponent: from batches"),
    "lyapunov_exponent": Variable(_POINT, "f8", "largest Lyapunov exponent: of the first state"),
    "lyapunov_error": Variable(_POINT, "f8", "error of this exponent: from batches and from the length of the window"),
}
VARIABLES = {
    **{
        name: Variable(("blocks", *item.dimensions), item.dtype, item.description, item.attributes)
        for name, item in CHAIN_VARIABLES.items()
    },
    **{
        name: Variable(("blocks", *_POINT), "f8", description)
        for name, description in {
            "synchronized_fraction": "synchronized fraction: fraction of the states that synchronize",
            "synchronized_low": "lower end of its confidence interval",
            "synchronized_high": "upper end of its confidence interval: undetermined states counted as synchronized",
            "undetermined_fraction": "undetermined fraction: fraction of the states that are undetermined",
            "partial_fraction": "partial fraction: states in which some but not all pairs of mirror blocks synchronize",
            "mean_mirror_distance": "mean mirror distance: over the states; synchronized states count as 0",
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
        axes(
            {"symmetric_state": SYMMETRIC_STATE},
            law=[model.law.name for model in models],
            a=grid,
            state=range(1, sample.samples + 1),
            symmetric_state=range(1, sample.symmetric_samples + 1),
        ),
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
    values = xarray.concat([chain[list(CHAIN_VARIABLES)] for chain in chains], "blocks", join="exact")
    lengths = axes({"blocks": BLOCKS}, blocks=[chain.attrs["blocks"] for chain in chains])
    kept = {name: value for name, value in first.attrs.items() if name not in _OWN_ATTRIBUTES}
    return summary(
        "Mirror synchrony of longer chains",
        VARIABLES,
        values.assign(_fractions(values)),
        {**lengths, **first.coords},
        {"confidence": CONFIDENCE, **kept},
        module=__name__,
    )


def _fractions(chains: xarray.Dataset) -> dict[str, xarray.DataArray]:
    """Return the counted variables over (blocks, law, a)."""
    outcome, states = chains["outcome"], chains.sizes["state"]
    synchronized, undetermined = outcome == Outcome.SYNCHRONIZED, outcome == Outcome.UNDETERMINED
    partial = (outcome == Outcome.NOT_SYNCHRONIZED) & (chains["pairs"] > 0)

    def end_of_interval(holds: xarray.DataArray, end: int) -> xarray.DataArray:
        counts = holds.sum("state")
        return xarray.apply_ufunc(lambda count: fraction_interval(int(count), states)[end], counts, vectorize=True)

    return {
        "synchronized_fraction": synchronized.mean("state"),
        "synchronized_low": end_of_interval(synchronized, 1),
        "synchronized_high": end_of_interval(synchronized | undetermined, 2),
        "undetermined_fraction": undetermined.mean("state"),
        "partial_fraction": partial.mean("state"),
        "mean_mirror_distance": chains["mean_distance"].where(~synchronized, 0.0).mean("state", skipna=False),
    }


def digest(data: xarray.Dataset) -> str:
    """Return where all sampled states of a chain synchronize, and where none is known to, for each number of blocks."""
    lines, a = [], data["a"].values
    for law in data["law"].values:
        for blocks in data["blocks"].values:
            share = data["synchronized_fraction"].sel(law=law, blocks=blocks).values
            words = f"all sampled states synchronize {values_where(share == 1.0, a)}; none is known to synchronize "
            lines.append(f"{law}, {blocks} blocks: {words}{values_where(share == 0.0, a)}")
    return "\n".join(lines)
