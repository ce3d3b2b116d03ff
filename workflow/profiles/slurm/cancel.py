#!/usr/bin/env python3
"""Cancel jobs that submit.py has submitted.

cancel.py NUMBER:NAME ...
"""

import subprocess
import sys

if __name__ == "__main__":
    sys.exit(subprocess.run(["scancel", *(job.partition(":")[0] for job in sys.argv[1:])]).returncode)
