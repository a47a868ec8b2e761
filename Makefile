# make demo, make test: what each needs is put into .venv, from wheels; nothing else is touched.
SHELL := /bin/bash
ENV := .venv
BIN := $(ENV)/bin
# One worker a core, and three for two cores where tests mostly wait for other processes. The tests of a file stay together,
# for its fixtures' sake, and those of a folder that share a graph (test/conftest.py). In a worker numpy has one thread.
# Tests are compiled once, and not by every worker of every run.
PYTEST := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -q --dist loadfile
CORES := $(shell n=$$(nproc); echo $$((n < 8 ? n : 8)))

ALL_SLOW := test/graph test/install test/firmware
LIBRARIES := manipulator/_kernel.abi3.so bridge/_board.abi3.so

.PHONY: demo check quick test lint bench soak docs clean

demo: $(ENV)/demo $(LIBRARIES)
	@echo 'Both machines on fake boards: about a minute.'
	@$(BIN)/hexarm demo

check: $(ENV)/ready $(LIBRARIES)
	@echo 'Lint, types, and the quick tests, which start no other program: 1 to 2 minutes on two quiet cores.'
	@$(MAKE) --no-print-directory -j 2 --output-sync=line lint quick

quick: $(ENV)/ready $(LIBRARIES)
	@$(PYTEST) -n $(CORES) -m 'not processes and not long' $(ALL_SLOW:%=--ignore=%)

test: check
	@echo 'Tests that start graphs, a browser, installations, or are long: 4 to 6 minutes on two quiet cores.'
	@$(PYTEST) -n $$((3 * $(CORES) / 2)) -m 'processes or long'

lint: $(ENV)/ready $(LIBRARIES)
	@$(BIN)/ruff check . && $(BIN)/ruff format --check . && $(BIN)/mypy

bench: $(ENV)/peers $(LIBRARIES)   # a quiet computer, please: some ten minutes
	@$(BIN)/python -m bench $(if $(WRITE),--write $(WRITE))

soak: $(ENV)/ready $(LIBRARIES)
	@SOAK_SECONDS=600 $(PYTEST) -n $(CORES) --dist load -s test/world/test_soak.py && $(BIN)/python -m bench.soak

# The libraries that the bench compares with; without them their rows say so.
$(ENV)/peers: $(ENV)/ready
	@echo 'Installing the libraries to compare with: about half a minute, once.'
	@$(BIN)/python -m pip install --disable-pip-version-check -e '.[bench]' >$(ENV)/peers.log 2>&1 \
	  && touch $@ || echo 'They could not be installed, see $(ENV)/peers.log: the table says which are missing.' >&2

# What pip has built is built again after a change of its sources.
$(LIBRARIES) &: $(wildcard kernel/*.[ch] firmware/core/*.[ch] firmware/host/*.[ch]) build_backend.py | $(ENV)/demo
	@echo 'Building the C libraries anew.'
	@$(BIN)/python -m pip install -q --disable-pip-version-check --no-deps -e . && touch $(LIBRARIES)

$(ENV)/demo: setup.py pyproject.toml environment.sh
	@./environment.sh $(ENV) demo

$(ENV)/ready: $(ENV)/demo
	@./environment.sh $(ENV) ready

docs: $(ENV)/ready   # the documents as a web site
	@NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build -q --strict && echo build/site/index.html

clean:
	rm -rf $(ENV) build *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis
