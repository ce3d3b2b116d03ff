"""Claims: their verdicts, as JSON, CSV and Markdown."""

import sys
from pathlib import Path

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.claims.claim import claims_of
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.formats import as_csv, as_json, as_markdown
from burridge_knopoff.claims.ledger import ledger
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.provenance.files import write_text

summaries = {Path(path).stem: open_summary(path) for path in snakemake.input}
params = snakemake.params
evidence = Evidence(summaries, params.config)
content = ledger(params.study, claims_of(params.claims), evidence, params.figures)
write_text(snakemake.output.content, as_json(content))
write_text(snakemake.output.table, as_csv(content))
write_text(snakemake.output.text, as_markdown(content, "../figures"))
