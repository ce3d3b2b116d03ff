# Seals: what each file of the study should be. Jobs write it with their files, and the record of the study has it for
# every reader, as `bk check`.
from functools import cache

from snakemake.io import apply_wildcards
from snakemake.iocontainers import Wildcards

from burridge_knopoff.check.leftovers import study_files
from burridge_knopoff.provenance.seal import BadFile, canonical, read_seal

# Params that decide nothing in a file, but say where things lie and how they are named to `snakemake`.
NOT_SEALED = {
    "seals",
    "script",
    "folder",
    "kept",
    "benchmarks",
    "optional",
    "arguments",
}
# What points are is decided by their commands; a file that is made from them has these among its params.
OF_POINTS = ("points/", "solvers/")


def seals(wildcards, output):
    """Return {path: what the file is} of the output of a job: a param of every rule but those of points."""
    return {f"{path}": seal_of(f"{path}") for path in output}


@cache
def seal_of(path):
    """Return what a file is: its name, the params of its rule, and a digest of what each of its inputs is."""
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
    """Return the name of a file below the results of the study."""
    return os.path.relpath(path, RESULTS)


def recorded_seals():
    """Return {name below the results: what the file should be} of all files of the study but points."""
    return {name: seal_of(f"{RESULTS}/{name}") for name in study_files(STUDY)}


def remove_damaged():
    """Remove texts and pictures that are damaged, so that the run makes them again: most of them no job reads."""
    for name in study_files(STUDY):
        path = Path(RESULTS, name)
        if path.suffix != ".nc" and path.is_file():
            try:
                read_seal(path)
            except BadFile as error:
                dry = workflow.output_settings.dryrun
                then = "would be made again" if dry else "is made again"
                print(f"{path}: {error.reason}: it {then}", file=sys.stderr)
                if not dry:
                    path.unlink()


# Not in the processes of jobs.
if workflow.is_main_process:
    remove_damaged()
