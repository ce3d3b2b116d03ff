"""Summary: what is proved of the synchronized orbit under a law."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries import proof
from burridge_knopoff.summaries.results import write_results

model = snakemake.params.model
(law,) = model["laws"]
dataset = proof.summarize(model_of(model, law, proof.GIVEN[0] / proof.GIVEN[1], proof.CHAIN_BLOCKS))
write_results(dataset, proof, snakemake.output)
