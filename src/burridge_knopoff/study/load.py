"""Builds a study from its config: fills in the defaults and checks the keys against each other."""

from __future__ import annotations

import json
from collections.abc import Mapping
from itertools import product
from pathlib import Path
from typing import Any

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.basins.settings import BasinSettings
from burridge_knopoff.catalogue.settings import CatalogueSettings
from burridge_knopoff.messages import refusal
from burridge_knopoff.model.distances import is_by_distance
from burridge_knopoff.model.fields import settings_from_config
from burridge_knopoff.model.springs import has_digest
from burridge_knopoff.motion.chain_settings import Sample
from burridge_knopoff.provenance.files import display_path
from burridge_knopoff.running.loading import check_loading
from burridge_knopoff.study import rules
from burridge_knopoff.study.config import CONFIG
from burridge_knopoff.study.grid import parameters_of, resolve_grid
from burridge_knopoff.study.study import Study
from burridge_knopoff.study.yaml_file import ConfigError


def load_study(config: Mapping[str, Any], file: str, written: Mapping[str, Any] | None = None) -> Study:
    """Return the study of a config, completed with defaults and checked against the ranges and the rules between keys.

    file : name of the config file, for messages
    written : content of the file if the command line changes it; errors without which this content is free are reported
        as errors of --config
    Raises ConfigError, one line: file, key, value, expected values.
    """
    folder = Path(file).parent
    try:
        return _study(config, folder)
    except ValueError as error:
        place = file if written in (None, config) or _config_error(written, folder) == str(error) else "--config"
        raise ConfigError(f"{place}: {error}") from error


def _config_error(config: Mapping[str, Any], folder: Path) -> str:
    try:
        _study(config, folder)
    except ValueError as error:
        return str(error)
    return ""


def _study(config: Mapping[str, Any], folder: Path) -> Study:
    chain_keys = config.get("chain")
    springs = chain_keys.get("springs") if isinstance(chain_keys, Mapping) else None
    # The config of a record names the file of springs with the digest of its content.
    is_new = isinstance(springs, str) and not has_digest(springs) and not is_by_distance(springs)
    # A name that cannot be printed is refused below.
    if isinstance(chain_keys, Mapping) and is_new and f"{springs}".isprintable():
        config = {**config, "chain": {**chain_keys, "springs": display_path(folder / f"{springs}")}}
    config = resolve_grid(config)
    # Use the types of YAML: lists instead of tuples.
    filled = json.loads(json.dumps(CONFIG.form(config, "")))
    # Ranges stay ranges; `parameters` has the values.
    filled.setdefault("a", [])
    study = Study(filled, parameters_of(filled))
    values = list(study.grid.values())
    if "transient" in config and filled["lyapunov_alignment"] > filled["transient"] and "lyapunov_alignment" in config:
        raise refusal("lyapunov_alignment", filled["lyapunov_alignment"], "at most transient, of which it is a part")
    rules.fill_states(filled, study.parameters.get("v", {"": filled["v"]}).values())
    rules.fill_blocks(filled)
    rules.fill_chains(filled)
    rules.fill_names(filled)
    rules.check_size(filled, study.parameters)
    rules.check_names(filled, study.parameters)
    other_values = study.other_values
    rules.check_models(filled, values, other_values)
    chains = [study.model(study.laws[0], values[0], **parameters).chain for parameters in other_values]
    chain = chains[0]
    if is_new:
        chain.check_springs()
    # Results may be read on a machine without the file of springs, which was checked when the study ran.
    has_springs = is_new or not has_digest(f"{chain.springs}")
    for law in study.laws if has_springs else ():
        for block_chain in chains:
            study.settings(law).check_chain(block_chain)
    # The default is three exponents; a single block has only two.
    filled["lyapunov_exponents"] = study.settings(study.laws[0]).exponent_count(chain)
    if "attractors" not in study.omitted_stages:
        with rules.error_prefix("attractors."):
            settings_from_config(SearchSettings, filled["attractors"]).box(study.model(study.laws[0], values[0]))
    with rules.error_prefix("basins."):
        of_basins = settings_from_config(BasinSettings, filled["basins"])
        if "basins" not in study.omitted_stages:
            of_basins.rows(study.model(study.laws[0], values[0]))
    with rules.error_prefix("chains."):
        settings_from_config(Sample, filled["chains"])
    rules.fill_values(filled, set(values), study.shown_a)
    rules.fill_catalogue(filled, values)
    rules.fill_edges(filled, values)
    with rules.error_prefix("catalogue."):
        loading = settings_from_config(CatalogueSettings, filled.get("catalogue", {})).loading
        for law, name in product(study.laws, study.catalogue_a):
            check_loading(loading, study.model(law, study.grid[name]), filled["solver"][law])
    for law in study.laws if has_springs and "solvers" not in study.omitted_stages else ():
        for solver in study.other_solvers(law):
            rules.check_comparison(study.settings(law, solver), chain, "step" in config.get("solvers", {}))
    rules.check_jobs(filled, study.blocks, study.omitted_stages)
    rules.leave_out(filled, study.omitted_stages)
    return study
