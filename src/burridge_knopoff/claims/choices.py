"""The evidence of a study with other tolerances of agreement and of the kinds of motion.

A run is given another kind if its exponents, section points and ⟨J⟩ are classified differently with the new tolerance.
The kinds of attractors come from longer windows and are unchanged. `motion.period_tolerance` and `motion.section` are
not tried: with others, the repetition of a motion would have to be looked for in the runs again. Nor are tolerances
within the search for attractors, which would have to be repeated.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.motion.kind import MotionKind, motion_from_period
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.summaries.judgement import compare

if TYPE_CHECKING:
    import xarray

FACTORS = (0.5, 2.0)
AGREEMENT = ("relative_tolerance", "standard_errors")
MOTION = ("zero_exponent", "chaotic_exponent", "standard_errors", "longest_period")
THRESHOLD = "synchronization_threshold"


def other_tolerances(evidence: Evidence) -> Iterator[tuple[str, Evidence]]:
    """Yield («tolerance is another value (here its own)», the evidence with it), at half and at twice the tolerance."""
    summaries, motion = evidence.summaries, dict(evidence.config["motion"])
    agreement = summaries["agreement"].attrs if "agreement" in summaries else {}
    for factor in FACTORS:
        for name in AGREEMENT if agreement else ():
            changed = {**agreement, name: factor * agreement[name]}
            yield _format_choice(f"agreement.{name}", agreement[name], factor), _compare_laws(evidence, changed)
        if "lyapunov" not in summaries:
            continue
        for name in MOTION:
            value = motion.get(name, getattr(MotionSettings(), name))
            other = replace(evidence, config={**evidence.config, "motion": {**motion, name: factor * value}})
            yield _format_choice(f"motion.{name}", value, factor), _reclassify_runs(other, evidence, agreement)
        if THRESHOLD in agreement:
            changed = {**agreement, THRESHOLD: factor * agreement[THRESHOLD]}
            yield _format_choice(THRESHOLD, agreement[THRESHOLD], factor), _reclassify_runs(evidence, evidence, changed)


def _format_choice(name: str, value: float, factor: float) -> str:
    return f"{name} is {factor * value:g} (here {value:g})"


def _reclassify_runs(other: Evidence, evidence: Evidence, agreement: Mapping[str, Any]) -> Evidence:
    """Return evidence in which kinds and synchrony of the runs follow tolerances other than those of `evidence`."""
    lyapunov = evidence.summaries["lyapunov"]
    own = evidence.summaries.get("agreement")
    threshold = {} if own is None else own.attrs
    before, after = (
        _classify_runs(lyapunov, one.config, about) for one, about in ((evidence, threshold), (other, agreement))
    )
    kind = lyapunov["run_kind"]
    changed = {"lyapunov": lyapunov.assign(run_kind=kind.copy(data=np.where(after != before, after, kind.values)))}
    if own is not None:
        runs = own["kind"]
        same = runs.values == kind.sel(law=runs["law"], initial=runs["initial"], a=runs["a"]).values
        moved = changed["lyapunov"]["run_kind"].sel(law=runs["law"], initial=runs["initial"], a=runs["a"]).values
        changed["agreement"] = own.assign(kind=runs.copy(data=np.where(same, moved, runs.values)))
    if THRESHOLD in agreement and "mean_distance" in evidence.summaries:
        means = evidence.summaries["mean_distance"]
        below = (means["mean_distance"] < agreement[THRESHOLD]).astype(means["synchronized"].dtype)
        is_new = agreement[THRESHOLD] != threshold.get(THRESHOLD)
        changed["mean_distance"] = means.assign(synchronized=below) if is_new else means
    result = replace(other, summaries={**evidence.summaries, **changed})
    return _compare_laws(result, agreement) if agreement else result


def _classify_runs(lyapunov: xarray.Dataset, config: Mapping[str, Any], about: Mapping[str, Any]) -> np.ndarray:
    """Return the kind of motion of each run for the tolerances of a config and a threshold of synchrony."""
    threshold = {THRESHOLD: about[THRESHOLD]} if THRESHOLD in about else {}
    settings = MotionSettings(**{**config["motion"], **threshold}).scaled_to_velocity(config["v"])
    names = "section_period", "period", "mean_distance", "lyapunov_exponent", "lyapunov_error"
    points, period, mean, exponent, error = (lyapunov[name].values for name in names)
    kinds = np.full(mean.shape, int(MotionKind.UNDETERMINED))
    for at in np.argwhere(np.isfinite(mean)):
        run = tuple(at)
        kinds[run] = motion_from_period(points[run], period[run], mean[run], exponent[run], error[run], settings).kind
    return kinds


def _compare_laws(evidence: Evidence, agreement: Mapping[str, Any]) -> Evidence:
    """Return evidence in which the laws are compared with other tolerances, for three blocks and for two."""
    changed = {}
    for name in ("agreement", "two_blocks"):
        if name not in evidence.summaries:
            continue
        dataset = evidence.summaries[name].copy(deep=True)
        for one in [dataset.sel(chain=chain) for chain in dataset["chain"]] if "chain" in dataset.dims else [dataset]:
            known = {
                key: one[key].values for key in ("difference", "difference_error", "same_kind", "agrees", "parting_a")
            }
            for i in range(one.sizes["other_law"]):
                pair = {key: one[key].values[[0, i + 1]] for key in ("mean_distance", "mean_distance_error", "kind")}
                both = {**pair, **{key: value[i] for key, value in known.items()}}
                compare(both, one["a"].values, agreement[THRESHOLD], agreement)
        prefix = "agreement_" if name == "two_blocks" else ""
        about = {f"{prefix}{key}": agreement[key] for key in AGREEMENT}
        changed[name] = dataset.assign_attrs({**about, THRESHOLD: agreement[THRESHOLD]})
    return replace(evidence, summaries={**evidence.summaries, **changed})
