# `make help` lists the targets, from the comments after them.

PYTHON ?= python3
# One core installs and checks while the other one compiles.
MAKEFLAGS += --jobs=2
BIN := .venv/bin
KERNEL := $(foreach suffix,cpp h py,$(wildcard src/burridge_knopoff/kernel/*.$(suffix))) \
	$(addprefix src/burridge_knopoff/provenance/,compilation.py kernel_build.py processor.py sources.py)
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet
# pip compiles one file after the other, the packages' own tests included. Without this step, jobs that may not write
# bytecode would compile the package again.
INSTALL := $(PIP) install --no-compile --require-hashes --requirement
# Without a compiler pip would print dozens of lines.
define INSTALL_KERNEL
@$(BIN)/python setup.py --quiet check_compiler
$(PIP) install --no-build-isolation --no-deps --editable .
endef
COMPILE := $(BIN)/python -m compileall -qq -j 0 -x /tests/ .venv/lib src

.PHONY: study help announce setup kernel test test-all types style test-oldest durations benchmark fuzz sanitize mutants size docs site lock clean

study: announce .venv/kernel  ## set up and run the default study (the target of a plain `make`)
	$(BIN)/snakemake -c2

# Snakemake itself begins with an estimate of the time.
announce:
	@test -e .venv/kernel || echo "make: sets up .venv and compiles the kernel (a minute, once)," \
		"then runs the default study on two cores (results/paper/report.html)"

help:  ## list the targets
	@sed -n 's/^\([a-z][a-z-]*\)\( [a-z-]*\)*:.*## /\1 /p' $(MAKEFILE_LIST) \
		| while read -r target text; do printf 'make %-12s %s\n' "$$target" "$$text"; done

setup: .venv/kernel  ## set up .venv and compile the kernel
	@echo "Next: source .venv/bin/activate, then snakemake -n (what a run would do) or snakemake -c2 (the default study)."

ifneq ($(words $(CURDIR)),1)
$(error $(CURDIR): Snakemake cannot run scripts from a path with a space: move the checkout)
endif

# The programs of an environment contain the path at which it was made, and so does the installed package. In a checkout
# that was moved or copied they are missing, or run the sources of the other one.
ENVIRONMENTS := .venv .venv-oldest .venv-benchmark .venv-mutants
made_at = $(filter %/$(1),$(file <$(1)/pyvenv.cfg))
MOVED := $(strip $(foreach folder,$(patsubst %/pyvenv.cfg,%,$(wildcard $(ENVIRONMENTS:=/pyvenv.cfg))), \
	$(if $(filter-out $(CURDIR)/$(folder),$(call made_at,$(folder))),$(folder))))
ifneq ($(MOVED),)
.venv/build .venv-oldest/ready .venv-benchmark/ready .venv-mutants/ready: moved
.PHONY: moved
moved:
	@echo "make: this checkout was moved or copied, and what was made at its old place is set up again: $(MOVED)"
	@rm -rf $(MOVED)
endif

.venv/build: requirements/build.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed: make PYTHON=...")'
	$(PYTHON) -m venv .venv
	$(INSTALL) $<
	@touch $@

.venv/study: requirements/study.lock .venv/build
	$(INSTALL) $<
	$(COMPILE)
	@touch $@

# Compiled while the rest is installed.
.venv/compiled: .venv/build setup.py pyproject.toml $(KERNEL)
	$(INSTALL_KERNEL)
	@touch $@

.venv/kernel: .venv/study .venv/compiled
	@touch $@

# Always run: the build itself compares the sources with those of the last one.
kernel: .venv/build  ## compile the kernel again
	$(INSTALL_KERNEL)
	@touch .venv/compiled

.venv/test: requirements/test.lock .venv/study
	$(INSTALL) $<
	$(COMPILE)
	@touch $@

test: QUICK := -m "not slow"
test: types style  ## set up and run the quick checks
test-all: types style  ## set up and run every check
test test-all:
	$(BIN)/python -m pytest $(QUICK)

# The types of the kernel are in its stub file.
types: .venv/test  ## check types
	$(BIN)/mypy

style: .venv/kernel .venv/test  ## check style
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/clang-format --dry-run --Werror src/burridge_knopoff/kernel/*.h src/burridge_knopoff/kernel/*.cpp \
		tests/kernel/*.cpp
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/snakemake --lint
	$(BIN)/check-jsonschema --builtin-schema vendor.github-workflows .github/workflows/test.yml
	$(BIN)/check-jsonschema --builtin-schema vendor.citation-file-format CITATION.cff

# The lock files hold the newest versions, oldest.txt the oldest that pyproject.toml allows.
.venv-oldest/ready: requirements/test.lock requirements/oldest.txt setup.py pyproject.toml $(KERNEL)
	$(PYTHON) -m venv .venv-oldest
	.venv-oldest/bin/python -m pip --disable-pip-version-check --quiet install --require-hashes --requirement $<
	.venv-oldest/bin/python -m pip --disable-pip-version-check --quiet install --require-hashes --no-deps \
		--requirement requirements/oldest.txt
	.venv-oldest/bin/python -m pip --disable-pip-version-check --quiet install --no-build-isolation --no-deps --editable .
	@touch $@

test-oldest: .venv-oldest/ready  ## test the workflow with the oldest Snakemake that is allowed
	.venv-oldest/bin/python -m pytest tests/logger $(addprefix tests/workflow/test_,runs.py progress.py bad_input.py \
		failed_points.py)

# The programs to compare with have an environment of their own.
.venv-benchmark/ready: requirements/benchmark.lock setup.py pyproject.toml $(KERNEL)
	$(PYTHON) -m venv .venv-benchmark
	.venv-benchmark/bin/python -m pip --disable-pip-version-check --quiet install --require-hashes --requirement $<
	.venv-benchmark/bin/python -m pip --disable-pip-version-check --quiet install --no-build-isolation --no-deps --editable .
	@touch $@

# Needs a run of both studies on a quiet machine.
durations: .venv/kernel  ## measure the durations from which the time left is estimated, and the error of the estimate
	$(BIN)/python benchmarks/durations.py config/paper.yaml config/smoke.yaml
	$(BIN)/python benchmarks/replay.py config/paper.yaml config/smoke.yaml

benchmark: .venv/kernel .venv-benchmark/ready  ## print most tables of docs/performance.md (over an hour)
	.venv-benchmark/bin/python benchmarks/floor.py
	.venv-benchmark/bin/python benchmarks/peers.py
	.venv-benchmark/bin/python benchmarks/lockstep.py
	.venv-benchmark/bin/python benchmarks/chains.py
	.venv-benchmark/bin/python benchmarks/dense.py
	.venv-benchmark/bin/python benchmarks/lyapunov.py
	.venv-benchmark/bin/python benchmarks/maps.py
	$(BIN)/snakemake -c2
	$(BIN)/python benchmarks/tori.py results/paper
	$(BIN)/python benchmarks/lifetimes.py results/paper
	$(BIN)/python benchmarks/other_settings.py results/paper

size: .venv/kernel  ## run a study of 10,000 points
	$(BIN)/python benchmarks/size.py

fuzz: .venv/kernel .venv/test  ## try 250,000 broken inputs, 100 times as many as the tests (15 minutes)
	BK_FUZZ=100 $(BIN)/python -m pytest tests/fuzzing

# A copy of the package whose kernel is compiled with the sanitizers of g++, and with less optimization, to compile
# faster. The sanitizers have to be loaded before Python; Python's own leaks are ignored.
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

sanitize: build/sanitized/ready  ## random runs under the sanitizers of addresses and undefined behaviour
	PYTHONPATH=build/sanitized/src ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1 \
		LD_PRELOAD="$$(g++ -print-file-name=libasan.so) $$(g++ -print-file-name=libubsan.so)" \
		$(BIN)/python benchmarks/random_runs.py

# Cosmic Ray has an environment of its own; the tests run in that of the study.
.venv-mutants/ready: requirements/mutants.lock
	$(PYTHON) -m venv .venv-mutants
	.venv-mutants/bin/python -m pip --disable-pip-version-check --quiet install --require-hashes --requirement $<
	@touch $@

mutants: .venv/kernel .venv/test .venv-mutants/ready  ## do the tests notice 300 random changes? (up to two hours)
	.venv-mutants/bin/python benchmarks/mutants.py

.venv/site: requirements/site.lock .venv/study
	$(INSTALL) $<
	$(COMPILE)
	@touch $@

site: .venv/kernel .venv/site  ## build the documentation, with all docstrings: build/site/index.html, opens offline
	$(BIN)/sphinx-build --fail-on-warning --fresh-env --quiet -c docs -d build/doctrees . build/site
	$(BIN)/python docs/notebook.py build/site/docs/tutorial.ipynb
	@echo build/site/index.html

docs: .venv/kernel .venv/site  ## update all that the pages print from the default study, and the keys
	$(BIN)/snakemake -c2 chains
	$(BIN)/snakemake -c2
	$(BIN)/python docs/refresh.py results/paper
	$(BIN)/python docs/dictionary.py
	$(BIN)/python docs/keys.py
	$(BIN)/python docs/rules.py

# Needs uv. The lock files hold names, versions and hashes only.
lock:  ## lock the versions of all requirements
	cd requirements && uv pip compile --universal --python-version 3.11 --generate-hashes --no-emit-index-url \
		--no-emit-find-links --no-annotate --no-header study.in -o study.lock
	cd requirements && for name in build site test benchmark mutants; do uv pip compile --universal --python-version 3.11 \
		--generate-hashes --no-emit-index-url --no-emit-find-links --no-annotate --no-header -c study.lock \
		$$name.in -o $$name.lock; done

clean:  ## delete what `make` has made, except results/
	rm -rf $(ENVIRONMENTS) build .snakemake src/*.egg-info src/burridge_knopoff/kernel/*.so \
		src/burridge_knopoff/kernel/v[234]
