"""Summary: proofs of the synchronized orbit under each law."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.study.model import models_of
from burridge_knopoff.summaries import proof
from burridge_knopoff.summaries.results import write_results

models = models_of(snakemake.params.model, proof.GIVEN[0] / proof.GIVEN[1], proof.CHAIN_BLOCKS)
write_results(proof.summarize(models), proof, snakemake.params.seals)
