"""docs/results.md: its table is that of the rules, whose graph fits a screen, and each summary has a question."""

import re
import runpy
from graphlib import TopologicalSorter

import pytest

from burridge_knopoff.study.yaml_file import read_yaml
from tests.workflow.planned import planned


@pytest.mark.slow
def test_the_table_is_that_of_the_rules(repository):
    rules = runpy.run_path(str(repository / "docs/rules.py"))
    graph = rules["rule_graph"]()
    page = (repository / "docs/results.md").read_text(encoding="utf-8")
    assert rules["table"](graph) in page
    # Arrows that must be present: from points to figures, and from attractors to basins.
    assert {("points", "figures"), ("attractors", "basins"), ("claims", "report")} <= rules["arrows"](graph)


@pytest.mark.slow
def test_the_graph_of_all_rules_from_left_to_right_fits_a_screen(repository):
    """As Graphviz draws it, in points of 1/72 inch: its ranks, half an inch apart, with the longest name in each."""
    graph = runpy.run_path(str(repository / "docs/rules.py"))["rule_graph"]()
    names = dict(re.findall(r"(id\d+)\[(\w+)\]", graph))
    needs = {rule: set() for rule in names}
    for source, target in re.findall(r"(id\d+) --> (id\d+)", graph):
        needs[target].add(source)
    rank, widest = {}, {}
    for rule in TopologicalSorter(needs).static_order():
        rank[rule] = max((rank[need] + 1 for need in needs[rule]), default=0)
        widest[rank[rule]] = max(widest.get(rank[rule], 0), len(names[rule]))
    assert len(names) > 40
    # A letter of 10 points is 6 points wide. A screen of 1,440 pixels, 96 to the inch, is 1,080 points wide.
    assert sum(6 * letters + 16 for letters in widest.values()) + 36 * (len(widest) - 1) < 1080


@pytest.mark.slow
def test_the_page_names_every_summary_of_the_default_study(repository):
    page = (repository / "docs/results.md").read_text(encoding="utf-8")
    summaries = {
        name for name in planned(read_yaml(repository / "config/paper.yaml")).files if name.startswith("summary/")
    }
    assert len(summaries) > 15
    assert summaries <= set(re.findall(r"`(summary/[\w.]+)`", page))
