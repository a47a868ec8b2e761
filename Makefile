# make demo, make test: everything they need is put into .venv, from wheels; nothing else is touched.
SHELL := /bin/bash
ENV := .venv
BIN := $(ENV)/bin

.PHONY: demo test lint bench soak clean

demo: $(ENV)/ready
	@$(BIN)/hexarm demo

test: $(ENV)/ready
	@$(BIN)/ruff check . && $(BIN)/ruff format --check . && $(BIN)/mypy && $(BIN)/python -m pytest $(PYTEST)

lint: $(ENV)/ready
	@$(BIN)/ruff check . && $(BIN)/ruff format --check . && $(BIN)/mypy

bench: $(ENV)/ready
	@$(BIN)/python -m bench

soak: $(ENV)/ready
	@SOAK_SECONDS=600 $(BIN)/python -m pytest -s test/graph/test_soak.py

$(ENV)/ready: setup.py pyproject.toml environment.sh
	@./environment.sh $(ENV)

clean:
	rm -rf $(ENV) build *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis
