"""The report of a study: one HTML file that opens offline, from summaries, figures and the verdicts on the paper."""
