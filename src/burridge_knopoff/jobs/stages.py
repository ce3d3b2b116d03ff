"""The runs of a study, the stages that need no attractors, and the list of all stages."""

from __future__ import annotations

from burridge_knopoff.attractors.settings import GIVEN_STATE_KEYS
from burridge_knopoff.jobs import searches
from burridge_knopoff.jobs.params import (
    MOTION,
    condition_refusal,
    length_refusal,
    model_keys,
    other_length_keys,
    parts,
    point_keys,
    run_keys,
)
from burridge_knopoff.jobs.rule import Rule, Shown
from burridge_knopoff.proof.scope import LARGEST_V, NONLINEAR_V
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
            keys=lambda job: point_keys(study),
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
    return [
        Rule(
            "solvers",
            "Compare independent solvers of the equations of motion.",
            "independent solvers of the same equations",
            ("summary/solvers.nc",),
            "summaries.solvers:make",
            reads={"other_points": f"solvers/{{solver}}/{study.point_file}"},
            points=lambda job: {**study.points, "parameters": {"a": study.compared_values}},
            keys=lambda job: [*run_keys(study), "initial", "solvers.a", "solvers.step"],
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
            keys=lambda job: model_keys(*study.proved_laws),
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
    initial = config["initial"]
    return [
        Rule(
            "catalogue_of_run",
            "Record the slip events of one run.",
            "slip events, {law} law, a = {a}",
            ("catalogues/{law}/a{a}.nc",),
            "summaries.catalogue_of_run:make",
            keys=lambda job: [
                *model_keys(job["law"]),
                f"a={job['a']}",
                *("start", f"solver.{job['law']}"),
                *(["step"] if study.config["solver"][job["law"]] == "rk4" else []),
                f"initial.{initial}",
                # The ends of the range of the fit affect only the statistics.
                *parts(study, "catalogue", "a", "low", "high"),
            ],
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
            keys=lambda job: [
                "laws",
                *(f"catalogue.{name}" for name in ("a", "low", "high") if name in config),
            ],
            stage="catalogue",
            exists=bool(study.catalogue_a),
            memory=1000,
            group="summaries",
        ),
    ]


def two_blocks(study: Study) -> list[Rule]:
    """Two blocks under each law, about which the paper makes a claim."""
    pair = study.config["chains"]["two_blocks"]
    return [
        Rule(
            "two_blocks",
            "Compare the motion of two blocks under each friction law with that under the first.",
            "two blocks: each law against the first one",
            ("summary/two_blocks.nc",),
            "summaries.two_blocks:make",
            keys=lambda job: [
                *other_length_keys(study),
                *(f"chains.{name}" for name in ("seed", "position", "velocity", "two_blocks")),
                *("start", "transient", "window", "agreement"),
                *(f"attractors.{name}" for name in GIVEN_STATE_KEYS),
                # Two blocks may lack the block of the study's section; the sum always exists.
                *(key for key in MOTION if key != "section"),
            ],
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
    return [
        Rule(
            "watch_chain",
            "Determine which sampled initial states of a chain end in mirror synchrony.",
            "mirror synchrony of sampled states, {blocks} blocks",
            ("chains/blocks{blocks}.nc",),
            "summaries.chains:make_of_length",
            keys=lambda job: [
                *other_length_keys(study, *config["laws"]),
                *parts(study, "chains", "blocks", "two_blocks"),
                *("start", "synchronization_threshold"),
            ],
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
