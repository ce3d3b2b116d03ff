"""The profiles name what the rules have: Snakemake ignores other names without a word."""

import re

import pytest
import yaml

from tests.workflow.conftest import REPOSITORY

RULES = "\n".join(path.read_text() for path in sorted((REPOSITORY / "workflow" / "rules").glob("*.smk")))
NAMES = set(re.findall(r"^(?:use rule \w+ as|rule) (\w+)\b", RULES, re.MULTILINE))
GROUPS = set(re.findall(r'^ +group:\s+"(\w+)"$', RULES, re.MULTILINE))
PROFILES = {
    path.parent.name: yaml.safe_load(path.read_text()) for path in REPOSITORY.glob("workflow/profiles/*/*.yaml")
}


def test_groups():
    """A group without a number of points would be a submission for each point."""
    profile = PROFILES["slurm"]
    assert GROUPS == profile["group-components"].keys() == {"points", "solver_points"}
    # Summaries and figures are in none: Snakemake looks at all points for each job of a group that reads them.
    assert RULES.count("group:") == len(GROUPS)


@pytest.mark.parametrize("profile", PROFILES)
def test_names_of_rules(profile):
    for key in ("groups", "set-resources", "set-threads"):
        assert PROFILES[profile].get(key, {}).keys() <= NAMES, key


def test_the_cluster_repeats_the_settings_of_this_machine():
    """Snakemake reads one profile only."""
    local, cluster = PROFILES["default"], PROFILES["slurm"]
    assert {key: cluster.get(key) for key in local} == local
