"""CITATION.cff describes the present version."""

import yaml

import burridge_knopoff


def test_the_citation_is_of_this_version(repository):
    citation = yaml.safe_load((repository / "CITATION.cff").read_text())
    assert citation["version"] == burridge_knopoff.__version__
    assert str(citation["license"]) in (repository / "LICENSE").read_text()
    title = citation["references"][0]["title"]
    assert title in " ".join((repository / "README.md").read_text().split())
