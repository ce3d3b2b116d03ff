"""Runs of a report: their commands and numbers are those of the study."""

import xarray as xr

from burridge_knopoff.report.runs import Commands, embedded_runs


def test_the_commands_of_every_run_are_those_of_the_workflow(poor):
    commands = Commands(poor.study, ("--configfile", "config/two words.yaml", "--config", "v=0.2"))
    opened = {name: xr.load_dataset(path) for name, path in poor.sources.summaries.items()}
    runs = embedded_runs(commands, *(opened[name] for name in ("mean_distance", "lyapunov", "agreement")))
    for i, law in enumerate(runs["laws"]):
        for k, name in enumerate(runs["names"]):
            before, after = runs["simulate"][i][0]
            typed = f"{before} --a {runs['texts'][k]} {after}{name}.nc"
            assert typed == f"{poor.study.command(law, 'pair', name)} --out {law}_pair_a{name}.nc"
    assert commands.snakemake("linearized", "pair", "0.1000") == (
        "snakemake -c1 --force results/poor/points/linearized/pair/a0.1000.nc"
        " --configfile 'config/two words.yaml' --config v=0.2"
    )
    assert commands.snakemake("linearized", "pair", "0.1000").endswith(runs["arguments"])
    assert runs["mean_distance"][0][0] == [opened["mean_distance"]["mean_distance"].values[0, 0, 0], None]
    assert runs["exponent_texts"][0][0][1] == ["–", "–", "–"]
