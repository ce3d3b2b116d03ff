"""Claims: their verdicts, as JSON, CSV and Markdown."""

import sys
from pathlib import Path

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.ledger import as_csv, as_json, as_markdown, ledger, read_claims
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.provenance.files import write_text

summaries = {Path(path).stem: open_summary(path) for path in snakemake.input.summaries}
# Not as input: moved results would be judged again. What it says is among the params.
root = Path(snakemake.scriptdir).resolve().parents[1]
claims = read_claims(root / "config/claims.yaml")
evidence = Evidence(summaries, snakemake.params.config)
content = ledger(snakemake.params.study, claims, evidence, snakemake.params.figures)
write_text(snakemake.output.content, as_json(content))
write_text(snakemake.output.table, as_csv(content))
write_text(snakemake.output.text, as_markdown(content, "../figures"))
