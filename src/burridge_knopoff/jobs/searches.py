"""The stages that need attractors: the search itself, basins, bifurcations, edge states and phases."""

from __future__ import annotations

from math import prod

from burridge_knopoff.jobs.params import MOTION, law_jobs, model_keys, parts
from burridge_knopoff.jobs.rule import Rule, Shown, Wildcards
from burridge_knopoff.study.study import Study


def attractors(study: Study) -> list[Rule]:
    """Attractors of each law along the grid of a and between its values, and all laws together."""
    config = study.config["attractors"]
    return [
        Rule(
            "attractors_of_law",
            "Search for the attractors of one friction law at every a, and insert values of a where they change.",
            "attractors of the {law} law along a",
            ("attractors/{law}.nc", "refined/{law}.nc", "returns/{law}.nc"),
            "summaries.attractors_of_law:make",
            keys=lambda job: [*model_keys(job["law"]), "a", "initial", "start", "attractors", "refine", *MOTION],
            each=law_jobs(study),
            stage="attractors",
            cores=0,
            memory=300,
            minutes=240,
            # The longest jobs of a study start right after the points and the figures of the paper.
            priority=2,
            work=study.blocks * config["samples"] * (config["transient"] + config["window"]) * len(study.grid),
        ),
        Rule(
            "attractors",
            "Merge the attractors of all friction laws, with their branches, basin fractions and rotation numbers.",
            "attractors of all laws",
            ("summary/attractors.nc", "summary/attractors.txt", "summary/refined.nc", "summary/rotation.nc"),
            "summaries.all_laws:make",
            reads={"grid": "attractors/{law}.nc", "refined": "refined/{law}.nc"},
            keys=lambda job: [*model_keys(), "a", "attractors"],
            stage="attractors",
            shown={"summary/attractors.txt": Shown("attractors in words", "Attractors", "attractors_txt")},
            cores=0,
            memory=400,
            minutes=10,
        ),
    ]


def basins(study: Study) -> list[Rule]:
    """Basins of attraction: maps over a plane of initial states, computed in tiles and merged."""
    config = study.config["basins"]
    maps = [{"law": law, "a": a} for law, a in study.basin_maps]
    known = {"attractors": "summary/attractors.nc", "returns": "returns/{law}.nc"}

    def keys(job: Wildcards, *unused: str) -> list[str]:
        of_map = [*model_keys(job["law"]), f"a={job['a']}"] if job else [*model_keys(), "basins.a"]
        others = parts(study, "basins", "a", "threads", *unused)
        return [*of_map, *others, f"initial.{config['initial']}", "start", "attractors"]

    return [
        Rule(
            "basin_tile",
            "Map one tile of the basins of attraction over a plane of initial states.",
            "basins of the {law} law at a = {a}, tile {tile}",
            ("basins/{law}/a{a}/tile{tile}.nc",),
            "summaries.basins:make_tile",
            reads=known,
            keys=lambda job: keys(job, "pairs"),
            each=[{**one, "tile": str(tile)} for one in maps for tile in range(config["tiles"])],
            stage="basins",
            cores=config["threads"],
            minutes=240,
            work=config["pixels"] ** 2 / config["tiles"],
        ),
        Rule(
            "basin_pairs",
            "Measure how rough the basin boundaries are by pairs of nearby initial states.",
            "pairs of nearby states, {law} law, a = {a}",
            ("basins/{law}/a{a}/pairs.nc",),
            "summaries.basins:make_pairs",
            reads=known,
            keys=lambda job: keys(job, "pixels", "tiles"),
            each=maps,
            stage="basins",
            cores=config["threads"],
            minutes=240,
            work=config["pairs"],
        ),
        Rule(
            "basins",
            "Merge the tiles and pairs into basin maps.",
            "maps of basins of attraction",
            ("summary/basins.nc", "summary/basins.txt"),
            "summaries.basins:make",
            reads={
                "attractors": "summary/attractors.nc",
                "tiles": "basins/{law}/a{a}/tile{tile}.nc",
                "pairs": "basins/{law}/a{a}/pairs.nc",
            },
            keys=keys,
            stage="basins",
            exists=bool(maps),
            refusal=f"study {study.name}: no maps of basins: `basins.a` names no value of a",
            shown={"summary/basins.txt": Shown("basins in words", "Attractors", "basins_txt")},
            group="summaries",
            work=len(maps),
        ),
    ]


def bifurcations(study: Study) -> list[Rule]:
    """Bifurcations and crises of the branches of attractors of each law, and the edge states on their boundaries."""
    config = study.config.get("edges", {"a": []})
    return [
        Rule(
            "bifurcations_of_law",
            "Continue the periodic orbits of one friction law in a to the bifurcations at which their branches begin "
            "or end.",
            "bifurcations of the branches of attractors, {law} law",
            ("bifurcations/{law}.nc",),
            "summaries.bifurcations:make_of_law",
            reads={"attractors": "summary/attractors.nc", "refined": "summary/refined.nc"},
            keys=lambda job: [*model_keys(job["law"]), "a"],
            each=law_jobs(study),
            stage="bifurcations",
            cores=0,
            memory=350,
            minutes=60,
            work=len(study.grid),
        ),
        Rule(
            "edges_of_law",
            "Follow the boundaries between the basins of one friction law to edge states, and continue those in a.",
            "edge states between the attractors of the {law} law",
            ("edges/{law}.nc",),
            "summaries.edges:make_of_law",
            reads={
                "attractors": "summary/attractors.nc",
                "refined": "summary/refined.nc",
                "returns": "returns/{law}.nc",
                "bifurcations": "bifurcations/{law}.nc",
            },
            # Without bifurcations there are no crises.
            optional_reads=True,
            keys=lambda job: [*model_keys(job["law"]), "edges", "attractors"],
            each=law_jobs(study),
            stage="edges",
            exists=bool(config["a"]),
            refusal=f"study {study.name}: no edge states: add `edges: {{}}` to its config",
            cores=0,
            memory=350,
            minutes=240,
            work=len(config["a"]),
        ),
        Rule(
            "edges",
            "Merge the edge states of all friction laws.",
            "edge states of all laws",
            ("summary/edges.nc", "summary/edges.txt"),
            "summaries.edges:make",
            reads={"parts": "edges/{law}.nc"},
            stage="edges",
            shown={"summary/edges.txt": Shown("edge states in words", "Attractors", "edges_txt")},
            group="summaries",
        ),
        Rule(
            "bifurcations",
            "Merge the bifurcations of all friction laws.",
            "bifurcations of all laws",
            ("summary/bifurcations.nc", "summary/bifurcations.txt"),
            "summaries.bifurcations:make",
            reads={"parts": "bifurcations/{law}.nc", "edges": "summary/edges.nc"},
            optional_reads=True,
            stage="bifurcations",
            shown={"summary/bifurcations.txt": Shown("bifurcations in words", "Attractors", "bifurcations_txt")},
            group="summaries",
        ),
    ]


def phases(study: Study) -> list[Rule]:
    """Initial states defined by the phases of their end blocks, and the attractors that they reach under each law."""
    config = study.config["phases"]
    return [
        Rule(
            "phases_of_law",
            "Determine which initial phases of the end blocks lead to synchrony under one friction law.",
            "phases of the end blocks, {law} law",
            ("phases/{law}.nc",),
            "summaries.phases:make_of_law",
            reads={"attractors": "summary/attractors.nc", "returns": "returns/{law}.nc"},
            keys=lambda job: [*model_keys(job["law"]), "phases", "attractors"],
            each=law_jobs(study),
            stage="phases",
            exists=bool(config["a"]),
            refusal=f"study {study.name}: no phases of end blocks: `phases.a` names no value of a",
            cores=0,
            memory=300,
            minutes=60,
            work=config["samples"]
            * prod(len(config[name]) for name in ("a", "inner_share", "amplitude", "phase_difference")),
        ),
        Rule(
            "phases",
            "Merge the outcomes of initial phases of all friction laws.",
            "phases of the end blocks, all laws",
            ("summary/phases.nc",),
            "summaries.phases:make",
            reads={"parts": "phases/{law}.nc"},
            stage="phases",
            group="summaries",
        ),
    ]


#: All of these stages, each after those whose files it reads.
STAGES = (attractors, basins, bifurcations, phases)
