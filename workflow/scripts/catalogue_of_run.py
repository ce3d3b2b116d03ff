"""Catalogue file: the slip events of one run."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.catalogue.settings import CatalogueSettings
from burridge_knopoff.catalogue.slip_events import catalogue_of_run
from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.study.model import model_of

params = snakemake.params
model = model_of(params.model, snakemake.wildcards.law, params.a, params.blocks)
settings = CatalogueSettings(**params.catalogue)
dataset = catalogue_of_run(model, InitialState(**params.state), settings, **params.run)
write_summary(dataset, *next(iter(params.seals.items())))
