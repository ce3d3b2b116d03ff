# Basins of attraction: tiles of maps over a plane of initial states, and the maps put together.


BASIN_MAPS = [
    (law, a) for law, values in STUDY.config["basins"]["a"].items() for a in values
]
TILE = f"{RESULTS}/basins/{{law}}/a{{a}}/tile{{tile}}.nc"
GRID_NAMES = {value: name for name, value in STUDY.grid.items()}
PLANE_STATE = STUDY.config["basins"]["initial"]


# What both kinds of jobs of a map depend on.
BASIN_PARAMS = {
    "state": {"name": PLANE_STATE, **STUDY.config["initial"][PLANE_STATE]},
    "start": STUDY.config["start"],
    "attractors": STUDY.config["attractors"],
    "motion": motion_config(),
}


rule basin_tile:
    input:
        rules.attractors.output.dataset,
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
        mem_mb=400,
        runtime=240,
    params:
        **BASIN_PARAMS,
        a=lambda wildcards: STUDY.value(wildcards.a),
        model=lambda wildcards: model_config([wildcards.law]),
        basins=basin_config("pairs"),
        sources=script_sources("basin_tile"),
    message:
        "basins of the {wildcards.law} law at a = {wildcards.a}, tile {wildcards.tile}"
    script:
        "../scripts/basin_tile.py"


rule basin_pairs:
    input:
        rules.attractors.output.dataset,
    output:
        f"{RESULTS}/basins/{{law}}/a{{a}}/pairs.nc",
    log:
        f"{RESULTS}/logs/basins/{{law}}/a{{a}}/pairs.log",
    benchmark:
        f"{RESULTS}/benchmarks/basins/{{law}}/a{{a}}/pairs.tsv"
    threads: STUDY.config["basins"]["threads"]
    resources:
        mem_mb=400,
        runtime=240,
    params:
        **BASIN_PARAMS,
        a=lambda wildcards: STUDY.value(wildcards.a),
        model=lambda wildcards: model_config([wildcards.law]),
        basins=basin_config("pixels", "tiles"),
        sources=script_sources("basin_pairs"),
    message:
        "pairs of near states, {wildcards.law} law, a = {wildcards.a}"
    script:
        "../scripts/basin_pairs.py"


rule basins:
    input:
        tiles=[
            TILE.format(law=law, a=GRID_NAMES[a], tile=tile)
            for law, a in BASIN_MAPS
            for tile in range(STUDY.config["basins"]["tiles"])
        ],
        pairs=[
            f"{RESULTS}/basins/{law}/a{GRID_NAMES[a]}/pairs.nc"
            for law, a in BASIN_MAPS
        ],
    output:
        dataset=f"{SUMMARY}/basins.nc",
        digest=report(
            f"{SUMMARY}/basins.txt",
            caption="../report/basins_text.rst",
            category="Attractors",
            labels={"result": "basins in words", "paper": "none"},
        ),
    log:
        f"{RESULTS}/logs/basins.log",
    benchmark:
        f"{RESULTS}/benchmarks/basins.tsv"
    resources:
        mem_mb=400,
        runtime=10,
    params:
        maps=BASIN_MAPS,
        model=model_config(),
        basins=basin_config(),
        state=BASIN_PARAMS["state"],
        start=STUDY.config["start"],
        time_limit=STUDY.config["attractors"]["time_limit"],
        sources=script_sources("basins"),
    message:
        "maps of basins of attraction"
    script:
        "../scripts/basins.py"
