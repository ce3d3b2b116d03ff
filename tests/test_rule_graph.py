"""docs/results.md: its chart is Snakemake's graph of rules, and it has a question for every summary."""

import re
import runpy

import pytest

from burridge_knopoff.study.yaml_file import read_yaml
from tests.workflow.planned import planned


@pytest.mark.slow
def test_the_chart_is_that_of_the_rules(repository):
    rules = runpy.run_path(str(repository / "docs/rules.py"))
    graph = rules["rule_graph"]()
    page = (repository / "docs/results.md").read_text(encoding="utf-8")
    assert rules["chart"](graph) in page
    # Arrows that must be present: from points to figures, and from attractors to basins.
    assert {("simulate", "figures"), ("attractors", "basins"), ("claims", "report")} <= rules["arrows"](graph)


@pytest.mark.slow
def test_the_page_names_every_summary_of_the_default_study(repository):
    page = (repository / "docs/results.md").read_text(encoding="utf-8")
    summaries = {
        name for name in planned(read_yaml(repository / "config/paper.yaml")).files if name.startswith("summary/")
    }
    assert len(summaries) > 15
    assert summaries <= set(re.findall(r"`(summary/[\w.]+)`", page))
