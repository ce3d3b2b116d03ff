# Seals: the expected content of each file of the study. Jobs write it with their files; the record of the study has it
# for readers such as `bk check`.
from functools import cache

from snakemake.io import apply_wildcards
from snakemake.iocontainers import Wildcards

from burridge_knopoff.check.leftovers import study_files
from burridge_knopoff.provenance.seal import BadFile, read_seal

# Params that decide nothing in a file: paths, and arguments of `snakemake`.
NOT_SEALED = {
    "seals",
    "script",
    "folder",
    "kept",
    "benchmarks",
    "optional",
    "arguments",
}
# Points are described by their commands, which are among the params of a file made from them.
OF_POINTS = ("points/", "solvers/", "stretches/")


def seals(wildcards, output):
    """Return {path: description} of the output of a job: a param of every rule except those of points."""
    return {f"{path}": seal_of(f"{path}") for path in output}


@cache
def seal_of(path):
    """Describe a file: its name, the params of its rule, and a digest of the description of each input."""
    made_by, wildcards = next(
        (each, found.groupdict())
        for each in workflow.rules
        for output in each.output
        if (found := output.match(path))
    )
    params = {
        name: value(Wildcards(fromdict=wildcards)) if callable(value) else value
        for name, value in made_by.params.items()
        if name not in NOT_SEALED
    }
    inputs = [apply_wildcards(f"{item}", wildcards) for item in made_by.input]
    return {
        "file": below(path),
        **params,
        "inputs": {
            below(item): identity(canonical(seal_of(item)))
            for item in inputs
            if not below(item).startswith(OF_POINTS)
        },
    }


def below(path):
    """Return the name of a file relative to the results of the study."""
    return os.path.relpath(path, RESULTS)


def recorded_seals():
    """Return {name in the results: expected description} of all files of the study except points."""
    return {name: seal_of(f"{RESULTS}/{name}") for name in study_files(STUDY)}


def remove_damaged():
    """Remove damaged texts and pictures, which hardly any job reads, and marks of stretches that lack points.

    The run remakes them.
    """
    dry = workflow.output_settings.dryrun
    then = "would be made again" if dry else "is made again"
    for name in study_files(STUDY):
        path = Path(RESULTS, name)
        if path.suffix != ".nc" and path.is_file():
            try:
                read_seal(path)
            except BadFile as error:
                print(f"{path}: {error.reason}: it {then}", file=sys.stderr)
                if not dry:
                    path.unlink()
    for path in incomplete(STUDY, Path(RESULTS)):
        print(
            f"{path}: a point of it is missing or was changed: it {then}",
            file=sys.stderr,
        )
        if not dry:
            path.unlink()


# Only in the main process, not in jobs.
if workflow.is_main_process:
    remove_damaged()
