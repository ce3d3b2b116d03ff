# Basins of attraction: maps over a plane of initial states, computed in tiles and merged.
# Keys of a map, besides its law and its a.
PLANE = [
    *parts(STUDY, "basins", "a", "cores", "pixels", "tiles", "pairs"),
    *(f"initial.{STUDY.config['basins']['initial']}", "start", "attractors"),
]


rule basin_tile:
    """Map one tile of the basins of attraction over a plane of initial states."""
    input:
        attractors=rules.attractors.output.attractors,
        returns=rules.attractors_of_law.output.returns,
    output:
        f"{RESULTS}/basins/{{law}}/a{{a}}/tile{{tile}}.nc",
    log:
        f"{RESULTS}/logs/basins/{{law}}/a{{a}}/tile{{tile}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/basins/{{law}}/a{{a}}/tile{{tile}}.tsv"
    wildcard_constraints:
        tile=r"\d+",
    threads: STUDY.config["basins"]["cores"]
    resources:
        runtime=240,
        cpus_per_task=all_threads,
    params:
        config=uses("basin_tile", MODEL_OF_LAW, "a={a}", PLANE, "basins.pixels", "basins.tiles"),
        sources=sources("basin_tile"),
    message:
        "basins of the {wildcards.law} law at a = {wildcards.a}, tile {wildcards.tile}"
    script:
        "../scripts/basin_tile.py"


rule basin_pairs:
    """Measure how rough the basin boundaries are by pairs of nearby initial states."""
    input:
        attractors=rules.attractors.output.attractors,
        returns=rules.attractors_of_law.output.returns,
    output:
        f"{RESULTS}/basins/{{law}}/a{{a}}/pairs.nc",
    log:
        f"{RESULTS}/logs/basins/{{law}}/a{{a}}/pairs.log",
    benchmark:
        f"{RESULTS}/benchmarks/basins/{{law}}/a{{a}}/pairs.tsv"
    threads: STUDY.config["basins"]["cores"]
    resources:
        runtime=240,
        cpus_per_task=all_threads,
    params:
        config=uses("basin_pairs", MODEL_OF_LAW, "a={a}", PLANE, "basins.pairs"),
        sources=sources("basin_pairs"),
    message:
        "pairs of nearby states, {wildcards.law} law, a = {wildcards.a}"
    script:
        "../scripts/basin_pairs.py"


rule basins:
    """Merge the tiles and pairs into basin maps."""
    input:
        attractors=rules.attractors.output.attractors,
        tiles=made("basin_tile"),
        pairs=made("basin_pairs"),
    output:
        f"{RESULTS}/summary/basins.nc",
        shown("basins.txt", "basins in words", "Attractors"),
    log:
        f"{RESULTS}/logs/basins.log",
    benchmark:
        f"{RESULTS}/benchmarks/basins.tsv"
    params:
        config=uses("basins", MODELS, PLANE, "basins.a", "basins.pixels", "basins.tiles", "basins.pairs"),
        sources=sources("basins"),
    message:
        "maps of basins of attraction"
    script:
        "../scripts/basins.py"
