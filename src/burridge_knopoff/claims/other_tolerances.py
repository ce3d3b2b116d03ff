"""The evidence of a study with other tolerances of agreement and of the kinds of motion.

Kinds of runs and comparisons of laws are computed again from runs.nc. The kinds of attractors come from longer windows
and are unchanged. `motion.period_tolerance` and `section` are not tried: with others, the repetition of a motion would
have to be looked for in the runs again. Nor are tolerances within the search for attractors, which would have to be
repeated.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.study.model import motion_of
from burridge_knopoff.summaries import agreement as law_agreement
from burridge_knopoff.summaries import lyapunov, mean_distance
from burridge_knopoff.summaries.judgement import compare_states

FACTORS = (0.5, 2.0)
AGREEMENT = ("relative_tolerance", "standard_errors")
MOTION = ("zero_exponent", "chaotic_exponent", "standard_errors", "longest_period")
THRESHOLD = "synchronization_threshold"


def other_tolerances(evidence: Evidence) -> Iterator[tuple[str, Evidence]]:
    """Yield («tolerance were 2 (it is 1)», the evidence with it), at half and at twice each tolerance."""
    summaries = evidence.summaries
    attributes = summaries["agreement"].attrs if "agreement" in summaries else {}
    agreement = {name: attributes[name] for name in AGREEMENT if name in attributes}
    threshold = {THRESHOLD: attributes[THRESHOLD]} if agreement else {}
    motion = motion_of({**evidence.config, **threshold})
    for factor in FACTORS:
        for name, value in agreement.items():
            changed = {**agreement, name: factor * value}
            choice = _format_choice(f"agreement.{name}", value, factor)
            yield choice, _with_agreement(evidence, motion.synchronization_threshold, changed)
        if "runs" not in summaries:
            continue
        for name in (*MOTION, *[THRESHOLD] * bool(agreement)):
            value = getattr(motion, name)
            choice = _format_choice(name if name == THRESHOLD else f"motion.{name}", value, factor)
            section = {} if name == THRESHOLD else {name: factor * value}
            config = {**evidence.config, "motion": {**evidence.config["motion"], **section}}
            other = replace(evidence, config=config)
            yield choice, _with_motion(other, replace(motion, **{name: factor * value}), agreement)


def _format_choice(name: str, value: float, factor: float) -> str:
    return f"{name} were {factor * value:g} (it is {value:g})"


def _with_motion(evidence: Evidence, settings: MotionSettings, agreement: Mapping[str, Any]) -> Evidence:
    """Return evidence in which kinds and synchrony of the runs follow other criteria of motion."""
    runs, threshold = evidence.summaries["runs"], settings.synchronization_threshold
    changed = {"lyapunov": lyapunov.summarize(runs, settings)}
    if "mean_distance" in evidence.summaries:
        changed["mean_distance"] = mean_distance.summarize(runs, threshold)
    if not agreement:
        return replace(evidence, summaries={**evidence.summaries, **changed})
    return _with_agreement(replace(evidence, summaries={**evidence.summaries, **changed}), threshold, agreement)


def _with_agreement(evidence: Evidence, threshold: float, agreement: Mapping[str, Any]) -> Evidence:
    """Return evidence in which the laws are compared with other tolerances, for three blocks and for two."""
    summaries, changed = evidence.summaries, {}
    if "agreement" in summaries:
        changed["agreement"] = law_agreement.summarize(
            summaries["runs"],
            summaries["lyapunov"],
            summaries["agreement"][list(law_agreement.EVENT_VARIABLES)],
            summaries.get("attractors"),
            synchronization_threshold=threshold,
            agreement=agreement,
        )
    if "two_blocks" in summaries:
        pairs = summaries["two_blocks"]
        attributes = {f"agreement_{name}": value for name, value in agreement.items()}
        compared = pairs.assign(compare_states(pairs, threshold, agreement))
        changed["two_blocks"] = compared.assign_attrs(synchronization_threshold=threshold, **attributes)
    return replace(evidence, summaries={**summaries, **changed})
