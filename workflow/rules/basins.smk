# Basins of attraction: tiles of maps over a plane of initial states, and their merge.
TILE = f"{RESULTS}/basins/{{law}}/a{{a}}/tile{{tile}}.nc"
PLANE_STATE = STUDY.config["basins"]["initial"]

# Settings that both kinds of jobs of a map depend on.
BASIN_PARAMS = {
    "state": {"name": PLANE_STATE, **STUDY.config["initial"][PLANE_STATE]},
    **keys(STUDY, "start", "attractors"),
}


rule basin_tile:
    """Map one tile of the basins of attraction over a plane of initial states."""
    input:
        f"{SUMMARY}/attractors.nc",
        RETURNS,
    output:
        TILE,
    log:
        f"{RESULTS}/logs/basins/{{law}}/a{{a}}/tile{{tile}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/basins/{{law}}/a{{a}}/tile{{tile}}.tsv"
    wildcard_constraints:
        tile="|".join(map(str, range(STUDY.config["basins"]["tiles"]))),
    threads: STUDY.config["basins"]["threads"]
    resources:
        cpus_per_task=lambda wildcards, threads: threads,
        runtime=240,
    params:
        **BASIN_PARAMS,
        a=lambda wildcards: STUDY.value(wildcards.a),
        model=lambda wildcards: model_config(STUDY, [wildcards.law]),
        basins=basin_keys(STUDY, "pairs"),
        sources=sources("basin_part"),
        seals=seals,
    message:
        "basins of the {wildcards.law} law at a = {wildcards.a}, tile {wildcards.tile}"
    script:
        "../scripts/basin_part.py"


use rule basin_tile as basin_pairs with:
    """Measure how rough the basin boundaries are, from pairs of nearby initial states."""
    output:
        f"{RESULTS}/basins/{{law}}/a{{a}}/pairs.nc",
    log:
        f"{RESULTS}/logs/basins/{{law}}/a{{a}}/pairs.log",
    benchmark:
        f"{RESULTS}/benchmarks/basins/{{law}}/a{{a}}/pairs.tsv"
    params:
        basins=basin_keys(STUDY, "pixels", "tiles"),
    message:
        "pairs of near states, {wildcards.law} law, a = {wildcards.a}"


rule basins:
    """Merge the tiles and pairs into basin maps."""
    input:
        attractors=f"{SUMMARY}/attractors.nc",
        tiles=[
            TILE.format(law=law, a=a, tile=tile)
            for law, a in STUDY.basin_maps
            for tile in range(STUDY.config["basins"]["tiles"])
        ],
        pairs=[f"{RESULTS}/basins/{law}/a{a}/pairs.nc" for law, a in STUDY.basin_maps],
    output:
        f"{SUMMARY}/basins.nc",
        report(
            f"{SUMMARY}/basins.txt",
            caption="../report/basins_text.rst",
            category="Attractors",
            labels={"result": "basins in words", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/basins.log",
    benchmark:
        f"{RESULTS}/benchmarks/basins.tsv"
    group:
        group("summaries")
    params:
        **keys(STUDY, "start", "attractors"),
        maps=[(law, STUDY.value(a)) for law, a in STUDY.basin_maps],
        model=model_config(STUDY),
        basins=basin_keys(STUDY),
        state=BASIN_PARAMS["state"],
        sources=sources("basins"),
        seals=seals,
    message:
        "maps of basins of attraction"
    script:
        "../scripts/basins.py"
