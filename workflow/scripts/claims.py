"""Claims: their verdicts, as JSON, CSV and Markdown."""

import sys
from pathlib import Path

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.claims.claim import claims_of
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.formats import as_csv, as_json, as_markdown
from burridge_knopoff.claims.ledger import ledger
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.provenance.seal import write_sealed_text

summaries = {Path(path).stem: open_summary(path) for path in snakemake.input}
params = snakemake.params
evidence = Evidence(summaries, params.config)
content = ledger(params.study, claims_of(params.claims), evidence, params.figures)
texts = as_json(content), as_csv(content), as_markdown(content, "../figures")
for text, (path, about) in zip(texts, params.seals.items(), strict=True):
    write_sealed_text(path, text, about)
