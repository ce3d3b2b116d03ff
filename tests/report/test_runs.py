"""Runs of a report: their commands and numbers are those of the study."""

import xarray as xr

from burridge_knopoff.report import overview, runs
from burridge_knopoff.report.runs import Commands, embedded_runs
from burridge_knopoff.study.load import load_study
from tests.small_study import SMALL


def test_the_commands_of_every_run_are_those_of_the_workflow(poor):
    commands = Commands(poor.study, ("--configfile", "config/two words.yaml", "--config", "v=0.2"))
    opened = {name: xr.load_dataset(path) for name, path in poor.sources.summaries.items()}
    embedded = embedded_runs(commands, *(opened[name] for name in ("mean_distance", "lyapunov", "agreement")))
    for i, law in enumerate(embedded["laws"]):
        for k, name in enumerate(embedded["names"]):
            before, after = embedded["simulate"][i][0]
            typed = f"{before} --a {embedded['texts'][k]} {after}{name}.nc"
            assert typed == f"{poor.study.command(law, 'pair', name)} --out {law}_pair_a{name}.nc"
    assert commands.snakemake("linearized", "pair", "0.1000") == (
        "snakemake -c1 --force results/poor/points/linearized/pair/a0.1000.nc"
        " --configfile 'config/two words.yaml' --config v=0.2"
    )
    assert commands.snakemake("linearized", "pair", "0.1000").endswith(embedded["arguments"])
    assert embedded["mean_distance"][0][0] == [opened["mean_distance"]["mean_distance"].values[0, 0, 0], None]
    assert embedded["exponent_texts"][0][0][1] == ["–", "–", "–"]


def test_nothing_speaks_of_a_under_laws_without_it():
    law = {"formula": "mud + (1 - mud)*exp(-u)", "mud": 0.5}
    study = load_study(
        {**SMALL, "laws": {"belt": law}, "a": [0], "chains": {}, "phases": {}, "solvers": {}}, "belt.yaml"
    )
    (command,) = runs._split_command(Commands(study, ()), "belt", "minus")
    (name,) = study.grid
    assert f"{command}{name}.nc" == f"{study.command('belt', 'minus', name)} --out belt_minus_a{name}.nc"
    assert "--a " not in command
    assert overview.opening(study) == "3 blocks, v = 0.1, belt friction law"
    assert not any(" a = " in f" {value}" for _, value in overview.run_settings(study))
