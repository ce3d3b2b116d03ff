"""The runs of a study, the stages that need no attractors, and the list of all stages."""

from __future__ import annotations

from dataclasses import asdict

from burridge_knopoff.attractors.settings import GIVEN_STATE_KEYS
from burridge_knopoff.jobs import searches
from burridge_knopoff.jobs.params import (
    catalogue_keys,
    catalogue_run_config,
    condition_refusal,
    keys,
    length_refusal,
    model_config,
    motion_config,
    other_length_config,
)
from burridge_knopoff.jobs.rule import Rule, Shown
from burridge_knopoff.proof.scope import LARGEST_V, NONLINEAR_V
from burridge_knopoff.running.settings import SOLVERS
from burridge_knopoff.study.chunks import chunks
from burridge_knopoff.study.paths import CHUNK
from burridge_knopoff.study.study import Study, all_points, solver_points


def _time(study: Study) -> float:
    return study.config["transient"] + study.config["window"]


def runs(study: Study) -> list[Rule]:
    """Points, which the workflow makes: one job per point, or one per chunk if several parameters vary."""
    file, parts = study.point_file, chunks(study)
    return [
        Rule(
            "simulate",
            "Simulate one point of the study: one friction law, one initial state, one value of each parameter.",
            "simulate {law} law, initial state {initial}, "
            + ", ".join(f"{name} = {{{word}}}" for word, name in study.wildcards.items()),
            (f"points/{file}",),
            each=all_points(study),
            stage="points",
            over="any",
            log=f"simulate/{file.removesuffix('.nc')}",
            work=study.blocks * _time(study),
        ),
        Rule(
            "chunk",
            "Simulate the points of a chunk that are missing, damaged or out of date.",
            "simulate the points of chunk {chunk}",
            (CHUNK,),
            each=[{"chunk": chunk} for chunk in parts],
            stage="points",
            over="several",
            log="chunk/{chunk}",
            work=study.blocks * _time(study) * max(map(len, parts.values()), default=0),
        ),
        Rule(
            "simulate_solver",
            "Simulate one point again with another solver.",
            "simulate {law} law by {solver}, initial state {initial}, a = {a}",
            (f"solvers/{{solver}}/{file}",),
            each=solver_points(study),
            stage="solvers",
            log=f"simulate_solver/{{solver}}/{file.removesuffix('.nc')}",
            work=study.blocks * _time(study),
        ),
    ]


def solvers(study: Study) -> list[Rule]:
    """The comparison of the solvers: points at a few values of a, repeated with every other solver of each law."""
    of_laws = {solver: [law for law in study.laws if solver in study.other_solvers(law)] for solver in SOLVERS}
    return [
        Rule(
            "solvers",
            "Compare independent solvers of the equations of motion.",
            "independent solvers of the same equations",
            ("summary/solvers.nc",),
            "summaries.solvers:make",
            reads={"others": f"solvers/{{solver}}/{study.point_file}"},
            points=lambda job: {**study.points, "parameters": {"a": study.compared_values}},
            params=lambda job: {
                "others": {
                    solver: {law: asdict(study.settings(law, solver)) for law in laws}
                    for solver, laws in of_laws.items()
                },
                "step": study.config["solvers"]["step"],
            },
            stage="solvers",
            group="summaries",
        )
    ]


def proof(study: Study) -> list[Rule]:
    """The synchronized orbit of the paper's chain and its loss of stability, in ball arithmetic."""
    return [
        Rule(
            "proof",
            "Prove by ball arithmetic that the synchronized orbit exists and where it loses its stability.",
            "proof: the loss of synchrony in ball arithmetic",
            ("summary/proof.nc", "summary/proof.txt"),
            "summaries.proof:make",
            params=lambda job: {"model": model_config(study, study.proved_laws)},
            stage="proof",
            exists=bool(study.proved_laws),
            refusal=f"study {study.name}: nothing to prove: the proof covers the paper's chain of 3 blocks and its two "
            f"laws (linearized: any v, at most {LARGEST_V:g} under a symmetric contact; nonlinear: v = "
            f"{NONLINEAR_V:g})",
            shown={"summary/proof.txt": Shown("what is proved, and what is assumed", "Synchronization", "proof_txt")},
            group="summaries",
        )
    ]


def catalogue(study: Study) -> list[Rule]:
    """Catalogues of slip events: one run for each law and a, and the statistics of the events."""
    config = study.config.get("catalogue")
    if config is None:
        config = {"initial": next(iter(study.initial)), "a": []}
    state = {"name": config["initial"], **study.config["initial"][config["initial"]]}
    return [
        Rule(
            "catalogue_of_run",
            "Record the slip events of one run.",
            "slip events, {law} law, a = {a}",
            ("catalogues/{law}/a{a}.nc",),
            "summaries.catalogue_of_run:make",
            params=lambda job: {
                "model": model_config(study, [job["law"]]),
                "a": study.value(job["a"]),
                "state": state,
                "run": catalogue_run_config(study, job["law"]),
                "catalogue": catalogue_keys(study),
            },
            each=[{"law": law, "a": a} for law in study.laws for a in study.catalogue_a],
            stage="catalogue",
            refusal=f"study {study.name}: no catalogues of slip events: add `catalogue: {{}}` to its config",
            memory=1000,
            minutes=240,
            # Long runs start first.
            priority=1,
        ),
        Rule(
            "catalogue",
            "Count the slip events by magnitude, fit the slope, and measure extents, intervals and recurrence.",
            "statistics of slip events, all laws",
            ("summary/catalogue.nc",),
            "summaries.catalogue:make",
            reads={"runs": "catalogues/{law}/a{a}.nc"},
            params=lambda job: {
                "laws": list(study.laws),
                "grid": config["a"],
                "fit": {key: config[key] for key in ("low", "high") if key in config},
            },
            stage="catalogue",
            exists=bool(study.catalogue_a),
            memory=1000,
            group="summaries",
        ),
    ]


def two_blocks(study: Study) -> list[Rule]:
    """Two blocks under each law, about which the paper makes a claim."""
    config, search = study.config["chains"], study.config["attractors"]
    pair = config["two_blocks"]
    return [
        Rule(
            "two_blocks",
            "Compare the motion of two blocks under each friction law with that under the first.",
            "two blocks: each law against the first one",
            ("summary/two_blocks.nc",),
            "summaries.two_blocks:make",
            params=lambda job: {
                **keys(study, "agreement"),
                "model": other_length_config(study),
                "sample": {key: config[key] for key in ("seed", "position", "velocity")},
                "two_blocks": pair,
                "settings": keys(study, "start", "transient", "window"),
                "search": {key: search[key] for key in GIVEN_STATE_KEYS},
                # Two blocks may lack the block of the study's section; the sum always exists.
                "motion": {key: value for key, value in motion_config(study).items() if key != "section"},
            },
            stage="two_blocks",
            exists=study.has_several_laws and not study.single_length_key,
            refusal=length_refusal(study) or condition_refusal(study, "has_several_laws"),
            cores=0,
            memory=300,
            minutes=30,
            # A long job without inputs starts early, so that it does not run alone at the end.
            priority=1,
            work=pair["samples"] * len(pair["a"]) * len(study.laws) * _time(study),
        )
    ]


def chains(study: Study) -> list[Rule]:
    """Chains of other lengths: for the target `chains`, or in every run if the config has `chains.blocks`."""
    config = study.config["chains"]
    sample = ("samples", "symmetric_samples", "seed", "position", "velocity")
    return [
        Rule(
            "watch_chain",
            "Determine which sampled initial states of a chain end in mirror synchrony.",
            "mirror synchrony of sampled states, {blocks} blocks",
            ("chains/blocks{blocks}.nc",),
            "summaries.chains:make_of_length",
            params=lambda job: {
                "model": other_length_config(study, config["laws"]),
                "grid": config["a"],
                "watch": {key: config[key] for key in ("time_limit", "synchronization_distance")},
                "sample": {**keys(study, "start"), **{key: config[key] for key in sample}},
                "motion": keys(study, "synchronization_threshold"),
            },
            # Long chains take longest and start first.
            each=[{"blocks": str(number)} for number in sorted(study.chain_lengths, reverse=True)],
            stage="chains",
            exists=not study.single_length_key,
            refusal=length_refusal(study),
            requested="blocks" in config,
            minutes=30,
            priority=1,
            work=config["samples"] * len(config["a"]) * len(config["laws"]) * config["time_limit"],
        ),
        Rule(
            "chains_summary",
            "Merge the fractions of synchronizing initial states over chain length and a.",
            "fraction of synchronizing states over number of blocks and a",
            ("summary/chains.nc",),
            "summaries.chains:make",
            reads={"parts": "chains/blocks{blocks}.nc"},
            stage="chains",
            exists=not study.single_length_key,
            refusal=length_refusal(study),
            group="summaries",
        ),
    ]


#: All of these stages, each after those whose files it reads.
STAGES = (runs, *searches.STAGES, solvers, proof, catalogue, two_blocks, chains)
