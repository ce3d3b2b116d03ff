"""The setting of a study in words, and the origin of its numbers."""

from __future__ import annotations

import platform
import re
from collections.abc import Mapping
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np
import xarray
import yaml

from burridge_knopoff.figures.sketch import WHOLE
from burridge_knopoff.model.chain import NEIGHBOURS, Chain
from burridge_knopoff.model.initial import PAPER_V, PaperState
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.provenance.record import git_commit
from burridge_knopoff.provenance.sources import provenance
from burridge_knopoff.running.solvers import SOLVERS
from burridge_knopoff.study.formatting import format_count, text
from burridge_knopoff.study.study import Study, all_points

#: Distributions whose versions are reported.
LIBRARIES = (
    *("numpy", "scipy", "netCDF4", "xarray", "matplotlib", "nanobind", "snakemake"),
    *("pyyaml", "jinja2", "plotly", "pillow"),
)

#: The conventions of a study in words, by the values of the keys `contact` and `start`.
CONTACTS = {
    "one_sided": "one-sided (a stuck block never slips backward)",
    "symmetric": "symmetric (a stuck block slips backward if the force on it is large enough)",
}
STARTS = {
    "moving": "moving (every block slips at τ = 0)",
    "tested": "tested (a block sticks at τ = 0 if static friction can hold it)",
}


def conventions(contact: str, start: str) -> str:
    """Describe the convention of contact and start."""
    return f"contact {CONTACTS[contact]}, start {STARTS[start]}"


def convention(setting: Mapping[str, Any]) -> str:
    """Describe the setting of the verdicts: v, contact and start; empty for a study without verdicts."""
    return f"v = {text(setting['v'])}; {conventions(setting['contact'], setting['start'])}" if setting else ""


def convention_words(name: str) -> str:
    """Return a convention by its name in a verdict, `contact, start`, in words; the name of a reading as it is."""
    contact, _, start = name.partition(", ")
    return f"{contact} contact, {start} start" if contact in CONTACTS and start in STARTS else name


def explanations(words: str, study: Study) -> list[str]:
    """Explain terms of verdicts and of runs in sentences, those that stand in these words."""
    longest = MotionSettings(**study.config["motion"]).scaled_to_velocity(study.config["v"]).longest_period
    terms = {
        r"one_sided|symmetric, (moving|tested)": f"Contact: {'; '.join(CONTACTS.values())}.",
        r", (moving|tested)\b|\b(other|moving|tested) start\b": f"Start: {'; '.join(STARTS.values())}.",
        "quasiperiodic": f"Quasiperiodic: no repetition was found within {text(longest)} time units.",
    }
    return [sentence for pattern, sentence in terms.items() if re.search(pattern, words)]


def sketch_caption(study: Study) -> str:
    """Return what the picture of the chain of this study shows."""
    chain = study.chain
    sentences = ["The chain of the study."]
    if chain.blocks == 1:
        sentences.append("A spring connects the block to a driver that moves with velocity v.")
    elif chain.is_network:
        sentences.append("Springs connect blocks to a driver that moves with velocity v.")
        sentences.append("The springs between the blocks are not drawn.")
    else:
        sentences.append(
            "Springs couple neighbouring blocks, and others connect blocks to a driver that moves with velocity v."
        )
    sentences.append("The number next to a spring is its stiffness in units of the spring constant k.")
    sentences.append("U_i is the position of block i.")
    if np.ptp(chain.thresholds) > 0.0:
        sentences.append("F is the static friction of a block in units of F(0).")
    if np.ptp(chain.weakenings) > 0.0:
        sentences.append("The weakening w of a block is the factor of the slip speed in its friction.")
    if chain.blocks > WHOLE:
        sentences.append("Only the first two blocks and the last are drawn.")
    if np.any(chain.damping) or np.any(chain.pulling_damping):
        sentences.append("Dashpots are not drawn.")
    if study.has_paper_chain:
        sentences.append("Compare the paper's Fig. 1.")
    return " ".join(sentences)


def opening(study: Study) -> str:
    """Return a study's blocks, parameters and laws in a line."""
    laws = study.laws
    words = f"{', '.join(laws[:-1])} and {laws[-1]} friction laws" if len(laws) > 1 else f"{laws[0]} friction law"
    varied = ", ".join(f"{name} = {values}" for name, values in _parameters(study).items())
    return f"{format_count(study.blocks, 'block')}, {varied}, {words}"


def _parameters(study: Study) -> dict[str, str]:
    """Return v, a and every other parameter that a study varies, with its values in words."""
    config = study.config
    lists = config["grid"] or ({"a": config["a"]} if study.has_a else {})
    return {"v": text(config["v"]), **{name: _format_grid(items) for name, items in lists.items()}}


def run_settings(study: Study) -> list[tuple[str, str]]:
    """Return names and values of the settings of the runs."""
    config = study.config
    solvers = ", ".join(f"{config['solver'][law]} ({law} law)" for law in study.laws)
    if any(SOLVERS[name].has_fixed_step for name in config["solver"].values()):
        solvers += f", step {text(config['step'])}"
    transient, window = config["transient"], config["window"]
    first = {name: next(iter(values.values())) for name, values in study.parameters.items()}
    models = {law: study.model(law, **first) for law in study.laws}
    at_first = " at the first point" if study.is_plane else ""
    chain = next(iter(models.values())).chain
    omitted = () if study.is_plane else study.omitted_stages
    threshold = text(config["synchronization_threshold"])
    synchronized = [("Synchronized", f"if ⟨J⟩ < {threshold}")] if study.has_end_blocks else []
    without = [("Left out by the config", ", ".join(omitted))] if omitted else []
    return [
        ("Blocks", f"N = {chain.blocks}"),
        (f"Chain{at_first}", chain_text(chain)),
        (f"Friction law{'s' * (len(models) > 1)}{at_first}", laws_text(models)),
        *_parameter_rows(study),
        ("Conventions", conventions(config["contact"], config["start"])),
        ("Solvers", solvers),
        (
            "Windows",
            f"transient of {text(transient)}, then averages over τ = {text(transient)} to {text(transient + window)} "
            f"in {config['batches']} batches",
        ),
        *synchronized,
        ("Runs", str(len(all_points(study)))),
        *without,
    ]


def _parameter_rows(study: Study) -> list[tuple[str, str]]:
    """Return a row for each parameter that varies, and one for v."""
    words = _parameters(study)
    rows = {
        name: f"{name} = {words[name]}: {format_count(len(values), 'value')}"
        for name, values in study.parameters.items()
        if name in words
    }
    rows.setdefault("v", f"v = {words['v']}")
    kinds = {"a": "Friction parameter", "v": "Driver velocity"}
    return [(kinds.get(name, "Parameter"), row) for name, row in rows.items()]


def chain_text(chain: Chain) -> str:
    """Describe the springs and the static friction of a chain."""
    parts = []
    if chain.springs:
        parts.append(f"springs of {chain.springs}")
    elif chain.blocks > 1:
        parts.append(f"coupling {_format_of_springs(chain, chain.coupling)}")
    parts.append(
        "pulling springs, one per neighbour of the block"
        if chain.pulling == NEIGHBOURS
        else f"pulling {_format_numbers(chain.pulling)}"
    )
    parts.append(f"static friction {_format_numbers(chain.threshold)}")
    if chain.mass != 1.0:
        parts.append(f"mass {_format_numbers(chain.mass)}")
    if chain.weakening != 1.0:
        parts.append(f"weakening {_format_numbers(chain.weakening)}")
    if np.any(chain.damping):
        parts.append(f"dashpots to neighbours {_format_of_springs(chain, chain.damping)}")
    if np.any(chain.pulling_damping):
        parts.append(f"dashpots to the driver {_format_numbers(chain.pulling_damping)}")
    shape = "a ring" if chain.ends == "ring" else "open ends" if chain.blocks > 1 else "one block"
    if chain.is_network:
        shape = f"a grid of {chain.grid[0]} × {chain.grid[1]} blocks" if chain.grid else "a network"
    return f"{shape}; {'; '.join(parts)}"


def _format_of_springs(chain: Chain, value: Any) -> str:
    if chain.grid and isinstance(value, tuple):
        return "{} along rows and {} along columns".format(*map(text, value))
    return _format_numbers(value)


def _format_numbers(value: Any) -> str:
    return ", ".join(text(item) for item in value) if isinstance(value, list | tuple) else text(value)


def laws_text(models: Mapping[str, Model]) -> str:
    """Return names and formulas of friction laws."""
    return "; ".join(f"{name}, {model.law.words}" for name, model in models.items())


def _format_grid(items: list[Any]) -> str:
    parts = [
        f"{text(item['from'])} to {text(item['to'])} in steps of {text(item['step'])}"
        if isinstance(item, dict)
        else text(item)
        for item in items
    ]
    return ", ".join(parts)


def initial_states(study: Study) -> list[dict[str, str]]:
    """Return name, U(0) and U'(0) of each initial state; of one that follows v the numbers for the paper's v."""
    return [
        {
            "name": f"{name} (for v = {text(PAPER_V)}, follows v)" if isinstance(state, PaperState) else name,
            **{key: _format_numbers(getattr(state, key)) for key in ("position", "velocity")},
        }
        for name, state in ((name, study.state(name)) for name in study.initial)
    ]


def config_text(study: Study) -> str:
    """Return the config with all defaults as YAML."""
    return yaml.safe_dump(dict(study.config), sort_keys=False, allow_unicode=True, default_flow_style=None, width=88)


def origins(summaries: Mapping[str, xarray.Dataset]) -> list[dict[str, str]]:
    """Return the software that wrote each summary, as stored in its file."""
    return [
        {"name": f"{name}.nc", **{key: str(dataset.attrs.get(key, "–")) for key in provenance(__name__)}}
        for name, dataset in summaries.items()
    ]


def software() -> list[tuple[str, str]]:
    """Return the provenance of this report and the versions of the libraries."""
    record = provenance("burridge_knopoff.dataset.point")
    rows = [
        ("Software", record["software"]),
        ("Source fingerprint of the runs", record["source_fingerprint"]),
        ("Git commit", git_commit()),
        ("Python", platform.python_version()),
    ]
    for name in LIBRARIES:
        try:
            rows.append((name, version(name)))
        except PackageNotFoundError:
            continue
    return rows
