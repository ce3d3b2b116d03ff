"""What a user may not expect of a study, told before it runs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from burridge_knopoff.model.initial import PAPER_V, PaperState, has_paper_numbers
from burridge_knopoff.model.parameters import remarks_on_states
from burridge_knopoff.provenance.record import read_study_record
from burridge_knopoff.running.cost import cost_note, is_dense, is_stiff
from burridge_knopoff.study.stages import missing_library
from burridge_knopoff.study.study import Study

#: Most rules that a line names.
MOST_RULES = 3


def remarks(study: Study, config: Mapping[str, Any]) -> list[str]:
    """Return lines on missing parts, on numbers that do not follow the model, and on runs that take very long.

    config : the config as written
    """
    return [*_cost_remarks(study), *_part_remarks(study, config), *_state_remarks(study)]


def _cost_remarks(study: Study) -> list[str]:
    """Return the cost of a run of the stiffest chain, or of a dense network, if that is over a minute."""
    law, initial = study.laws[0], study.initial[0]
    chains = study.other_values[: 1 if study.has_one_chain else None]
    models = [study.model(law, study.shown_a, **others) for others in chains]
    stiffest, settings = max(models, key=lambda model: model.chain.highest_rate), study.settings(law)
    if not (is_stiff(stiffest.chain) or is_dense(stiffest.chain)):
        return []
    note = cost_note(stiffest, stiffest.begin(study.state(initial), settings.start), settings)
    return [f"each simulation: {note}"] if note else []


def _part_remarks(study: Study, config: Mapping[str, Any]) -> Iterator[str]:
    if study.blocks == 1:
        yield "one block: J = 0; no phases or synchronized orbit, which need two end blocks"
    if config.get("basins") and "basins" not in study.omitted_stages and not study.basin_maps:
        yield "basins: no map, since no default value of basins.a is on the grid; set basins.a"
    if "claims" not in study.omitted_stages and not study.has_paper_chain:
        yield "claims: none, since they are about the paper's chain of 3 blocks"
    if study.proved_laws and not study.omission("proof") and (library := missing_library("proof")):
        yield f"proof: none, since {library}"


def _state_remarks(study: Study) -> Iterator[str]:
    states = [study.state(name) for name in study.initial]
    yield from remarks_on_states(states, (name for name, values in study.parameters.items() if len(values) > 1))
    velocities: Iterable[float] = study.parameters.get("v", {"": study.config["v"]}).values()
    for state in states:
        if remark := study.model(study.laws[0], study.shown_a, **study.other_values[0]).dropped_velocities(
            state, study.config["start"]
        ):
            yield remark
    fixed = [state.name for state in states if has_paper_numbers(state) and not isinstance(state, PaperState)]
    if fixed and {*velocities} != {PAPER_V}:
        yield (
            f"initial: {', '.join(fixed)}: the numbers of the paper, which are for v = {PAPER_V:g}; with "
            f"{', '.join(f'{name}: {{}}' for name in fixed)} they follow v"
        )


def override_remarks(study: Study, results: str, config_file: str, overrides: Mapping[str, Any]) -> list[str]:
    """Return a line if the values of --config change the results of a study in place.

    results : folder of the study; config_file : its config; overrides : the values of --config
    """
    if not overrides or "study" in overrides:
        return []
    try:
        if read_study_record(results)["config"] == study.config:
            return []
    except ValueError:
        # Without results there is no record; those of this run would be replaced by the next run without --config.
        pass
    return [
        f"--config {', '.join(overrides)}: {results} will hold the results of the changed config in place of those of "
        f"{config_file}; to keep both, add study=NAME to --config"
    ]


def change_remarks(changes: Mapping[str, Sequence[str]]) -> list[str]:
    """Return a line for each change of the config, or of the sources, since the files of some rules were made.

    changes : {change: rules}, see `check.changes`
    """
    return [
        f"changed: {change} ({', '.join(rules[:MOST_RULES])}{f' and {len(rules) - MOST_RULES} more' * truncated})"
        for change, rules in changes.items()
        for truncated in [len(rules) > MOST_RULES]
    ]
