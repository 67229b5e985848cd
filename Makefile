# The commands of the README. They need Python >= 3.11, make and pip, nothing else.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable
.PHONY: train test check results soak browser pictures docs clients dist lint clean

train: $(VENV)/train
	$(BIN)/python -m agents.train

# All agents and baselines on all games: at most an hour on 2 cores. What it has finished it does not do again.
results: $(VENV)/train
	$(BIN)/python -m agents.study --agents bounce_env/trained

# For every edit: under two minutes, nothing is compiled.
check: lint
	NUMBA_DISABLE_JIT=1 $(BIN)/python -m pytest -q -n 2 --dist loadfile -m fast

test: lint
	$(BIN)/python -m pytest -n 2 --dist loadfile

# The same tests with full counts: hours, not minutes.
soak: $(VENV)/dev
	BOUNCE_SOAK=1 $(BIN)/python -m pytest -rP -n 2 --dist loadfile

# Trainers in environments of their own, as their pins collide: each trains, and must beat a baseline. 15 minutes.
clients: $(VENV)/dev $(VENV)/clients/done $(VENV)/rllib/done
	BOUNCE_CLIENTS=$(abspath $(VENV)) $(BIN)/python -m pytest -rP tests/clients

$(VENV)/clients/done: docs/clients/requirements.txt
$(VENV)/rllib/done: docs/clients/requirements-rllib.txt
$(VENV)/clients/done $(VENV)/rllib/done: pyproject.toml
	$(PYTHON) -m venv $(@D)
	@echo "Installing $(firstword $(filter docs/%,$^)) into $(@D): some minutes the first time ..."
	$(@D)/$(notdir $(BIN))/python -m pip install --quiet --disable-pip-version-check -r $(filter docs/%,$^) --editable .
	@touch $@

# The pages in a real browser, which make test does as well: Chromium or Chrome must be on the path.
browser: $(VENV)/dev
	BOUNCE_REQUIRE=browser $(BIN)/python -m pytest tests/browser

# The pictures of the lab in README and docs, of what the pages show now.
pictures: $(VENV)/dev
	$(BIN)/python -m tests.browser.pictures

# The site, into docs/_build/html: its examples run, its pictures are drawn, and a warning is an error.
docs: $(VENV)/docs
	rm -rf docs/_build docs/_made
	SDL_VIDEODRIVER=dummy $(BIN)/python -m sphinx -W --keep-going -b html docs docs/_build/html

# Wheel and sdist, tried out in a fresh environment of each Python that is there.
dist: $(VENV)/dist
	$(BIN)/python .ci/dist.py

lint: $(VENV)/dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	@if command -v npx > /dev/null; then npx --yes oxlint@1.94.0 --deny-warnings bounce_env/lab/pages bounce_env/replay; \
	else echo 'no npx: the pages are not linted'; fi

$(VENV)/train $(VENV)/docs $(VENV)/dev $(VENV)/dist: pyproject.toml constraints.txt
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@echo "Installing bounce_env[$(@F)] into $(VENV): some minutes the first time ..."
	$(INSTALL) ".[$(@F)]"
	@touch $@

clean:
	rm -rf docs/_build docs/_made docs/gallery $(VENV) dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
