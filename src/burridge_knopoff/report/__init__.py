"""The report of a study: one HTML file, readable offline, from summaries, figures and verdicts on the paper."""
