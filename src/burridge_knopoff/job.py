"""A job of a study, as a script of the workflow sees it: checked inputs, the config that it uses, and outputs."""

from __future__ import annotations

import logging
import os
import sys
from pathlib import Path
from typing import Any

# Snakemake sets this to the threads of the rule, but those are processes here. With several threads the last digits of
# a product would depend on the number of cores, and processes would wait for each other.
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import xarray

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.provenance.files import remove_links, reserve_room, write_text
from burridge_knopoff.provenance.keys import nested
from burridge_knopoff.provenance.origin import OWN_ATTRIBUTES, Origin, check_origin, other_params, with_origin
from burridge_knopoff.provenance.record import NAME, read_study_record, study_folder
from burridge_knopoff.study.study import Study


class Job:
    """A job of a study: what it reads, and what it writes with its origin.

    snakemake : what Snakemake gives a script, with `config`, the keys of the config that the job uses, and `sources`
        among its params; messages, and errors, go to its log. A script that is run by hand has no log, and the `folder`
        into which it writes.

    config : the part of the study's config that these keys describe
    law : its wildcard of that name
    cores : number of its cores
    results : folder of the study; folder : the folder into which it writes, the same unless it is run by hand
    cache : folder in which long jobs of the study cache their results, for other values of a or after a kill

    Raises BadFile if an input is corrupt or not the expected one, ValueError if the results have no record of the study
    or belong to another config.
    """

    def __init__(self, snakemake: Any) -> None:
        for log in snakemake.log:
            remove_links(log)
            sys.stdout = sys.stderr = open(log, "w", buffering=1, encoding="utf-8")
            reserve_room(sys.stderr)
        logging.basicConfig(format="%(message)s")
        logging.getLogger("burridge_knopoff").setLevel(logging.INFO)
        folder = study_folder(snakemake.output[0])
        if folder is None:
            raise ValueError(
                f"{snakemake.output[0]}: no {NAME} in a folder above it: a workflow that imports a study calls its "
                "onstart (config/README.md)"
            )
        self.results = Path(os.path.relpath(folder))
        self.config = nested(snakemake.params.config)
        self.wildcards, self.params = snakemake.wildcards, snakemake.params
        self.cores: int = snakemake.resources.get("cpus_per_task", snakemake.threads)
        is_by_hand = hasattr(snakemake, "folder")
        self.folder = snakemake.folder if is_by_hand else self.results
        self.cache = self.folder / "cache" if is_by_hand else Path(".snakemake/study_cache", self.results.name)
        self._inputs, self._outputs, self._rule = snakemake.input, snakemake.output, snakemake.rule
        self._check_inputs()

    @property
    def law(self) -> str:
        """Name of the job's law."""
        return self.wildcards.law

    @property
    def study(self) -> Study:
        """The part of the study that the keys of its config describe."""
        return Study.of_keys(self.config)

    def paths(self, name: str) -> list[Path]:
        """Return the input files of a name."""
        files = self._inputs.get(name, [])
        return [Path(files)] if isinstance(files, str) else [*map(Path, files)]

    def summaries(self, name: str) -> list[xarray.Dataset]:
        """Return the input files of a name, loaded into memory, without their origin."""
        datasets = [open_summary(path) for path in self.paths(name)]
        for dataset in datasets:
            dataset.attrs = {key: value for key, value in dataset.attrs.items() if key not in OWN_ATTRIBUTES}
        return datasets

    def summary(self, name: str) -> xarray.Dataset:
        """Return the only input file of a name, loaded into memory, without its origin."""
        (dataset,) = self.summaries(name)
        return dataset

    def _check_inputs(self) -> None:
        record = read_study_record(self.results)
        if words := other_params(self.params.config, record):
            raise ValueError(
                f"{self.results / NAME}: another run has changed the config ({words}); run snakemake again"
            )
        self._params: dict[str, Any] = {}
        self._checksums: dict[str, str] = {}
        # Points are checked when they are read.
        names = [name for name, _ in self._inputs.items() if not name.endswith("points")]
        for path in (path for name in names for path in self.paths(name)):
            origin, checksum = check_origin(path, self.results, record)
            self._params |= origin.params if origin else {}
            self._checksums[path.relative_to(self.results).as_posix()] = checksum

    def write(self, *contents: Any) -> None:
        """Write the outputs: Datasets, texts, or one Figure to all of them."""
        pictures = {}
        names = [Path(path).relative_to(self.results).as_posix() for path in self._outputs]
        if len(contents) == 1:
            contents *= len(names)
        for name, content in zip(names, contents, strict=True):
            path = self.folder / name
            params = {**self._params, **self.params.config}
            origin = Origin(name, self._rule, params, self._checksums, self.params.sources)
            if isinstance(content, xarray.Dataset):
                write_summary(content.assign_attrs(origin.attributes()), path)
            elif isinstance(content, str):
                write_text(path, with_origin(content, name, origin))
            else:
                pictures[path] = vars(origin)
        if pictures:
            # Only figures need matplotlib.
            from burridge_knopoff.figures.style import write_figure

            write_figure(contents[0], *pictures, origins=pictures)
