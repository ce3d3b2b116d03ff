"""Fuzzing of what reads the input of people: configs, point files, and the arguments of runs and of `bk`.

Each target takes bytes from a coverage-guided fuzzer and checks what tests/fuzzing requires: one line of refusal, or
what is right by a check of its own. The coverage is that of the Python code; compiled code guides nothing.
A crash is an exception or signal, a hang an input that takes longer than 20 s, a wrong acceptance a check that fails.
Inputs that do one of these are kept in the folder --keep, beside what the fuzzer says.
"""

from __future__ import annotations

import argparse
import faulthandler
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY))

TARGETS = ("config", "points", "runs")
COUNTS = ("executions", "accepted", "refused", "crashes", "hangs", "wrong")
HANG_SECONDS = 20
#: Executions after which the counts are written down: a fuzzer ends without a last word.
COUNTED = 100
#: Python packages whose coverage guides the fuzzer.
GUIDING = ["burridge_knopoff", "yaml"]


class Hang(BaseException):
    """An input took too long; no handler of errors may take it for one."""


def checks(target: str, folder: Path):
    """Return the function that checks one input, bytes → whether it was accepted, and inputs to begin with."""
    if target == "config":
        from tests.fuzzing import configs

        def config(data: bytes) -> bool:
            content = data[1:] if data[:1] < b"\x30" else configs.mutated(data[1:])
            return configs.check_config(content, folder)

        return config, [b"\0" + seed for seed in configs.SEEDS] + [b"\xff" + bytes(range(40))]
    if target == "points":
        from tests.fuzzing.points import Points

        return Points(folder).check, [bytes(range(k, 40 + k)) for k in range(20)]
    from tests.fuzzing import runs

    def run(data: bytes) -> bool:
        return runs.check_arguments(data[1:], folder) if data[:1] > b"\xc0" else runs.check_run(data)

    return run, [bytes((7 * i * k) % 256 for i in range(150)) for k in range(40)]


def fuzz(target: str, seconds: int, keep: Path, counts_file: Path) -> None:
    """Fuzz one target in this process, which the fuzzer ends."""
    import atheris

    with atheris.instrument_imports(include=GUIDING):
        folder = Path(tempfile.mkdtemp(dir=counts_file.parent))
        check, seeds = checks(target, folder)
    counts = dict.fromkeys(COUNTS, 0)
    corpus = folder.with_name("corpus")
    corpus.mkdir(exist_ok=True)
    for number, seed in enumerate(seeds):
        (corpus / f"seed{number}").write_bytes(seed)

    def give_up(*_) -> None:
        raise Hang

    signal.signal(signal.SIGALRM, give_up)

    current = counts_file.with_name("current")

    def one_input(data: bytes) -> None:
        counts["executions"] += 1
        current.write_bytes(data)
        signal.alarm(HANG_SECONDS)
        # Compiled code does not hear the alarm: then the process ends, and with it the hang.
        faulthandler.dump_traceback_later(2 * HANG_SECONDS, exit=True)
        try:
            counts["accepted" if check(data) else "refused"] += 1
        except Hang:
            _keep(keep, target, "hangs", data, counts)
        except AssertionError as error:
            _keep(keep, target, "wrong", data, counts, error)
        except Exception as error:
            _keep(keep, target, "crashes", data, counts, error)
        finally:
            signal.alarm(0)
            faulthandler.cancel_dump_traceback_later()
        if counts["executions"] % COUNTED == 0:
            counts_file.write_text(json.dumps(counts))

    options = [f"-max_total_time={seconds}", "-timeout=0", "-rss_limit_mb=2000", "-max_len=4096"]
    if target == "config":
        options.append(f"-dict={_dictionary(folder)}")
    atheris.Setup([sys.argv[0], *options, f"-artifact_prefix={keep}/{target}-", "-verbosity=0", str(corpus)], one_input)
    atheris.Fuzz()


def _keep(keep: Path, target: str, kind: str, data: bytes, counts: dict[str, int], error: object = "") -> None:
    counts[kind] += 1
    path = keep / f"{target}-{kind}-{counts[kind]}"
    if counts[kind] <= 20:
        path.write_bytes(data)
        print(f"{path}: {type(error).__name__} {error}"[:500], file=sys.stderr)


def _dictionary(folder: Path) -> Path:
    from tests.fuzzing.configs import PIECES

    def quoted(piece: str) -> str:
        return "".join(
            chr(byte) if 32 <= byte < 127 and byte not in b'"\\' else f"\\x{byte:02x}" for byte in piece.encode()
        )

    path = folder / "pieces.dict"
    path.write_text("".join(f'"{quoted(piece)}"\n' for piece in PIECES))
    return path


def measure(target: str, seconds: int, keep: Path) -> dict[str, int]:
    """Fuzz a target in a process of its own, again and again if it dies, and return the counts."""
    total = dict.fromkeys(COUNTS, 0)
    shared = Path("/dev/shm")
    end = time.monotonic() + seconds
    # What is left after a start of the fuzzer must be worth it.
    while (left := int(end - time.monotonic())) > 1:
        log = keep / f"{target}.log"
        with tempfile.TemporaryDirectory(dir=shared if shared.is_dir() else None) as folder, log.open("w") as file:
            counts_file, current = Path(folder, "counts.json"), Path(folder, "current")
            command = [sys.executable, __file__, "--one", target, "--seconds", str(left), "--keep", str(keep)]
            run = subprocess.run([*command, "--counts", str(counts_file)], stdout=file, stderr=subprocess.STDOUT)
            counts = json.loads(counts_file.read_text()) if counts_file.exists() else {}
            if run.returncode and not current.exists():
                raise SystemExit(f"{target}: the fuzzer did not start: {log.read_text().strip().splitlines()[-1]}")
            if run.returncode:
                counts["crashes"] = counts.get("crashes", 0) + 1
                shutil.copy(current, keep / f"{target}-ended-{total['crashes'] + counts['crashes']}")
        for key, count in counts.items():
            total[key] += count
    return total


def main() -> int:
    """Fuzz and print the table; the exit code tells whether there was anything to be mended."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--seconds", type=int, default=1200, help="time for each target (default: %(default)s)")
    parser.add_argument("--target", choices=TARGETS, action="append", help="one of them only")
    parser.add_argument(
        "--keep", type=Path, default=Path("fuzzed"), help="folder for bad inputs (default: %(default)s)"
    )
    parser.add_argument("--one", choices=TARGETS, help=argparse.SUPPRESS)
    parser.add_argument("--counts", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    options.keep.mkdir(parents=True, exist_ok=True)
    if options.one:
        fuzz(options.one, options.seconds, options.keep, options.counts)
        return 0
    from measure import print_table

    rows, bad = [], 0
    for target in options.target or TARGETS:
        counts = measure(target, options.seconds, options.keep)
        rows.append([target, options.seconds, *counts.values()])
        bad += counts["crashes"] + counts["hangs"] + counts["wrong"]
    print_table(["target", "seconds", *COUNTS[:-1], "wrong acceptances"], rows)
    return min(bad, 1)


if __name__ == "__main__":
    sys.exit(main())
