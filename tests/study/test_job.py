"""What a job takes of the machine."""

import os
import subprocess
import sys

import pytest


@pytest.mark.skipif(sys.platform != "linux", reason="counts threads in /proc")
def test_a_job_multiplies_matrices_in_one_thread_whatever_its_cores():
    code = (
        "import os, burridge_knopoff.job, numpy as np; np.ones((300, 300)) @ np.ones((300, 300)); "
        "print(len(os.listdir('/proc/self/task')))"
    )
    # Snakemake sets the variable to the threads of the rule.
    run = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "OPENBLAS_NUM_THREADS": "4"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stdout.split() == ["1"]
