# `make`: set up and run the default study.  `make setup`: only set up.
# `make test`: set up and run the quick checks.  `make test-all`: every check.
# `make kernel`: compile the kernel again.  `make test-oldest`: the workflow with the oldest Snakemake that is allowed.
# `make benchmark`: most tables of docs/performance.md (over an hour).  `make docs`: the figures and claims of docs/.
# `make site`: the documentation, with all docstrings, as a site in build/site.
# `make faults`, `make fuzz`, `make size`: a study killed 20 times and more; 250,000 broken inputs; 10,000 points.
# `make sanitize`: random runs under the sanitizers of addresses and undefined behaviour (a few minutes).
# `make mutants`: 300 random changes of the sources, do the tests notice? (up to two hours)

PYTHON ?= python3
BIN := .venv/bin
KERNEL := $(foreach suffix,cpp h py,$(wildcard src/burridge_knopoff/kernel/*.$(suffix))) \
	$(addprefix src/burridge_knopoff/provenance/,compilation.py kernel_build.py processor.py sources.py)
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet
# pip compiles one file after the other, and the packages' own tests as well. Where Python may write no bytecode, the
# project's own would be compiled anew in every job.
INSTALL := $(PIP) install --no-compile --require-hashes --requirement
# Without a compiler pip would print dozens of lines.
define INSTALL_KERNEL
@$(BIN)/python setup.py --quiet check_compiler
$(PIP) install --no-build-isolation --no-deps --editable .
endef
COMPILE := $(BIN)/python -m compileall -qq -j 0 -x /tests/ .venv/lib src

.PHONY: study announce setup kernel test test-all types style test-oldest durations benchmark faults fuzz sanitize mutants size docs site lock clean

study: announce setup
	$(BIN)/snakemake -c2

# Snakemake itself begins with the time that its jobs will take.
announce:
	@test -e .venv/kernel || echo "make: sets up .venv and compiles the kernel (a minute, once)," \
		"then runs the default study on two cores (under ten minutes if they are quick; results/paper/report.html)"

setup: .venv/kernel

ifneq ($(words $(CURDIR)),1)
$(error $(CURDIR): Snakemake cannot run scripts from a path with a space: move the checkout)
endif

.venv/study: requirements/pip.lock requirements/study.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed: make PYTHON=...")'
	$(PYTHON) -m venv .venv
	$(INSTALL) requirements/pip.lock
	$(INSTALL) requirements/study.lock
	$(COMPILE)
	@touch $@

.venv/kernel: .venv/study setup.py pyproject.toml $(KERNEL)
	$(INSTALL_KERNEL)
	@touch $@

# Whatever the times of files say: what is compiled is known by what it was compiled from.
kernel: .venv/study
	$(INSTALL_KERNEL)
	@touch .venv/kernel

.venv/test: requirements/test.lock .venv/study
	$(INSTALL) $<
	$(COMPILE)
	@touch $@

# What is installed and read on one core goes on beside the compiler.
test: QUICK := -m "not slow"
test test-all:
	@$(MAKE) --no-print-directory --jobs=2 types style
	$(BIN)/python -m pytest $(QUICK)

# The kernel has its types in stubs.
types: .venv/test
	$(BIN)/mypy

style: .venv/kernel .venv/test
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/clang-format --dry-run --Werror src/burridge_knopoff/kernel/*.h src/burridge_knopoff/kernel/*.cpp \
		tests/kernel/*.cpp
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/snakemake --lint

# The lock files hold the newest; between the two is what pyproject.toml states.
.venv-oldest/ready: requirements/test.lock requirements/oldest.txt setup.py pyproject.toml $(KERNEL)
	$(PYTHON) -m venv .venv-oldest
	.venv-oldest/bin/python -m pip --disable-pip-version-check --quiet install --require-hashes --requirement $<
	.venv-oldest/bin/python -m pip --disable-pip-version-check --quiet install --require-hashes --no-deps \
		--requirement requirements/oldest.txt
	.venv-oldest/bin/python -m pip --disable-pip-version-check --quiet install --no-build-isolation --no-deps --editable .
	@touch $@

test-oldest: .venv-oldest/ready
	.venv-oldest/bin/python -m pytest tests/logger $(addprefix tests/workflow/test_,runs.py progress.py bad_input.py \
		failed_points.py)

# The peers live apart from the study's environment.
.venv-benchmark/ready: requirements/benchmark.lock setup.py pyproject.toml $(KERNEL)
	$(PYTHON) -m venv .venv-benchmark
	.venv-benchmark/bin/python -m pip --disable-pip-version-check --quiet install --require-hashes --requirement $<
	.venv-benchmark/bin/python -m pip --disable-pip-version-check --quiet install --no-build-isolation --no-deps --editable .
	@touch $@

# After a run of these studies on a quiet machine: the durations from which the time left is told, and how good it is.
durations: .venv/kernel
	$(BIN)/python benchmarks/durations.py config/paper.yaml config/smoke.yaml
	$(BIN)/python benchmarks/replay.py config/paper.yaml config/smoke.yaml

benchmark: .venv/kernel .venv-benchmark/ready
	.venv-benchmark/bin/python benchmarks/floor.py
	.venv-benchmark/bin/python benchmarks/peers.py
	.venv-benchmark/bin/python benchmarks/lockstep.py
	.venv-benchmark/bin/python benchmarks/chains.py
	.venv-benchmark/bin/python benchmarks/lyapunov.py
	.venv-benchmark/bin/python benchmarks/maps.py
	.venv-benchmark/bin/python benchmarks/point_job.py
	.venv-benchmark/bin/python benchmarks/study.py
	rm -rf .snakemake/kept/paper
	$(BIN)/snakemake -c2 --forceall
	$(BIN)/python benchmarks/stages.py results/paper
	$(BIN)/python benchmarks/tori.py results/paper
	$(BIN)/python benchmarks/lifetimes.py results/paper
	$(BIN)/python benchmarks/other_settings.py results/paper

faults: .venv/kernel .venv/test
	$(BIN)/python benchmarks/faults.py

size: .venv/kernel
	$(BIN)/python benchmarks/size.py

# A hundred times what `make test` tries: a quarter of an hour on two cores.
fuzz: .venv/kernel .venv/test
	BK_FUZZ=100 $(BIN)/python -m pytest tests/fuzzing

# A copy of the package, whose kernel is compiled with the sanitizers of g++, and with less optimisation, which is
# quicker. They have to be loaded before Python, which itself leaks.
SANITIZE := -fsanitize=address,undefined -fno-sanitize-recover=all -D_GLIBCXX_ASSERTIONS
build/sanitized/ready: .venv/study setup.py $(KERNEL)
	rm -rf $(@D)
	mkdir -p $(@D)
	cp -R setup.py pyproject.toml README.md LICENSE src $(@D)
	find $(@D) -name '*.so' -delete
	sed -i.full 's/"-O3"/"-O1"/' $(@D)/src/burridge_knopoff/provenance/compilation.py
	cd $(@D) && BURRIDGE_KNOPOFF_LANES=2 CFLAGS="$(SANITIZE)" CXXFLAGS="$(SANITIZE)" LDFLAGS="$(SANITIZE)" \
		$(CURDIR)/$(BIN)/python setup.py --quiet build_ext --inplace
	@touch $@

sanitize: build/sanitized/ready
	PYTHONPATH=build/sanitized/src ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1 \
		LD_PRELOAD="$$(g++ -print-file-name=libasan.so) $$(g++ -print-file-name=libubsan.so)" \
		$(BIN)/python benchmarks/random_runs.py

# Cosmic Ray lives apart as well; the tests run in the study's environment.
.venv-mutants/ready: requirements/mutants.lock
	$(PYTHON) -m venv .venv-mutants
	.venv-mutants/bin/python -m pip --disable-pip-version-check --quiet install --require-hashes --requirement $<
	@touch $@

mutants: .venv/kernel .venv/test .venv-mutants/ready
	.venv-mutants/bin/python benchmarks/mutants.py

.venv/site: requirements/site.lock .venv/study
	$(INSTALL) $<
	$(COMPILE)
	@touch $@

# Its pages open offline, also without a server.
site: .venv/kernel .venv/site
	$(BIN)/sphinx-build --fail-on-warning --fresh-env --quiet -c docs -d build/doctrees . build/site
	@echo build/site/index.html

# The ledger in docs/claims.md and the README, from the default study; the figures of docs/, from the same study at a
# greater depth and with longer chains, whose verdicts are compared; the tables of keys; the tutorial as a notebook.
docs: setup .venv/site
	$(BIN)/snakemake -c2
	$(BIN)/snakemake -c2 chains --configfile config/paper_fine.yaml
	$(BIN)/snakemake -c2 --configfile config/paper_fine.yaml
	$(BIN)/python docs/refresh.py results/paper results/paper_fine
	$(BIN)/python docs/keys.py
	$(BIN)/python docs/notebook.py

# Needs uv. The lock files hold names, versions and hashes only.
lock:
	cd requirements && for name in pip study; do uv pip compile --universal --python-version 3.11 --generate-hashes \
		--no-emit-index-url --no-emit-find-links --no-annotate --no-header $$name.in -o $$name.lock; done
	cd requirements && for name in site test benchmark mutants; do uv pip compile --universal --python-version 3.11 \
		--generate-hashes --no-emit-index-url --no-emit-find-links --no-annotate --no-header -c study.lock \
		$$name.in -o $$name.lock; done

clean:
	rm -rf .venv .venv-benchmark .venv-oldest .venv-mutants build .snakemake src/*.egg-info src/burridge_knopoff/kernel/*.so \
		src/burridge_knopoff/kernel/v[234]
