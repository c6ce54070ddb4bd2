# make run  : sets everything up and serves the panel with a simulated tracker at http://127.0.0.1:8000
# make test : sets up what tests need and runs them, browser tests included; what judges time is in make soak
# make check: formatting, lint, types, layers, texts, documents, generated and vendored files, migrations
# make fuzz : 10,000 cases against the API and hostile values for every form, in a network of its own; minutes
# make looks: opens the pages that changed in Chromium, in all sizes, languages and themes, and stamps those that are
#   good in tests/looks/looked_at.json, which make test compares; ALL=1 opens every page
# make soak : what make test leaves out: PART=timing judges how punctual things are, on a computer without other work;
#   PART=built builds, releases and installs the product; PART=long are the long proofs: millions of random ticks,
#   1,000 kills, 300 power cuts, a day of 20 trackers
# make mutants: changes guards, access, limits, drives and control in a copy, one place at a time, and counts
#   what their tests notice; ONLY=access does one area
# make gate : make check and make test as CI runs them, in a clone of the last commit; writes build/green
# make fresh: the two commands of the README on pristine Debian machines in folders, as a user and as root (needs root);
#   DEBIAN="12 13", WHO="user root", ONLY="run test", PYTHON=python3.14 do a part
# make dist : builds the sdist and the wheel into dist/, with the manual where zensical is installed
# make release VERSION=x.y.z: raises the version, builds sdist, wheel, bill of materials, image and checksums into
#   dist/x.y.z, commits and tags; with DRY=1 nothing is committed
# make docs : builds the site of the documents into manual/, and fails at a broken link or anchor
# make firmware: builds the firmware of controllers/avr for Arduino Mega and Uno
# make bench: measures and writes docs/develop/benchmarks.md

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# Installs a lock, in seconds: every file has the checksum that stands there (deploy/locked.py).
LOCKED := deploy/locked.py
# The tests share the cores, more of them at a time than there are cores, since most of a test is waiting.
# ORDER=random runs them in an order by chance, ORDER=7 in that which the seed 7 makes.
WORKERS ?= 3
ORDER ?=
SEED := $(if $(filter random,$(ORDER)),$(shell od -An -N3 -tu4 /dev/urandom | tr -d ' '),$(ORDER))
IN_ORDER := $(SEED:%=--random-order=%)
# Tests start hundreds of processes: what is compiled is kept, even where the environment says otherwise.
test looks soak soak-timing soak-built soak-long browser: export PYTHONDONTWRITEBYTECODE :=
# tests/soak is what judges time, builds and installs, or takes hours: no part of make test, as tests/looks.
PARTS := long timing built

.DEFAULT_GOAL := help
.PHONY: help setup firmware docs reference dist fast client run test gate looks fresh check translations fuzz soak soak-timing soak-built soak-long mutants release bench format lock browser system-packages clean

help: ## Show what each command does
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | awk -F ':.*## ' '{printf "make %-10s %s\n", $$1, $$2}'

$(VENV)/.runtime: requirements.txt requirements-uv.txt pyproject.toml
	@echo "Setting up $(VENV) with what Heliopanel needs to run ..."
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@$(BIN)/python $(LOCKED) requirements.txt .
	@touch $@

$(VENV)/.test: requirements-test.txt $(VENV)/.runtime
	@echo "Adding what tests and checks need ..."
	@$(BIN)/python $(LOCKED) requirements-test.txt
	@touch $@

$(VENV)/.dev: requirements-dev.txt $(VENV)/.test
	@echo "Adding what builds releases and documents ..."
	@$(BIN)/python $(LOCKED) requirements-dev.txt
	@touch $@

$(VENV)/.client: requirements-client.txt $(VENV)/.runtime
	@echo "Setting up $(VENV)/client, an integrator's own environment ..."
	@test -x $(VENV)/client/bin/python || $(PYTHON) -m venv $(VENV)/client
	@$(VENV)/client/bin/python $(LOCKED) requirements-client.txt
	@touch $@

client: $(VENV)/.client ## Add the generator of clients that a test of the API's document needs

setup: $(VENV)/.runtime ## Make .venv with the command heliopanel
	@echo "Ready: $(BIN)/heliopanel --help"

dist: $(VENV)/.runtime ## Build the sdist, and the wheel from it, into dist/ (with the manual where zensical is there)
	@test ! -x $(BIN)/zensical || $(BIN)/python -m tools.manual
	@$(BIN)/python -c "from setuptools.build_meta import build_sdist; build_sdist('dist')" >/dev/null
	@$(BIN)/python -m pip wheel --quiet --disable-pip-version-check --no-index --no-build-isolation --no-deps -w dist \
		dist/heliopanel-$$($(BIN)/heliopanel version).tar.gz
	@ls dist

release: $(VENV)/.dev ## Release VERSION=x.y.z: raise it, build all into dist/, commit, tag; DRY=1 only builds
	@test -n "$(VERSION)" || { echo "Say which: make release VERSION=1.2.0" >&2; exit 2; }
	@$(BIN)/python -m release $(VERSION) $(if $(DRY),--dry-run)

docs: $(VENV)/.dev ## Build the site of the documents into manual/; a broken link or anchor fails
	@$(BIN)/python -m tools.manual

reference: $(VENV)/.test ## Renew the pages of Reference that are made of the code
	@$(BIN)/python -m tools.manual.made

fast: $(VENV)/.runtime ## Add the compiled loops (numba) that make studies and comparisons quick
	@$(BIN)/python $(LOCKED) requirements-fast.txt
	@echo "Ready: studies and comparisons use compiled loops."

run: setup ## Serve the panel with a simulated tracker at http://127.0.0.1:8000
	@$(BIN)/heliopanel serve

system-packages:
	@sh tools/system-packages.sh

test: ## Set up what tests need and run them, browser tests included
	@$(MAKE) --no-print-directory --jobs=2 system-packages $(VENV)/.test
	@$(BIN)/python -m tools.gate -n $(WORKERS) --dist loadfile --no-loadscope-reorder $(IN_ORDER) \
		--ignore=tests/soak --ignore=tests/looks

looks: $(VENV)/.test system-packages ## Look at the pages that changed, in all sizes, languages, and themes; ALL=1 at every page
	@$(BIN)/python -m tests.looks $(if $(ALL),--all)

gate: ## Run .ci/run in a clone of the last commit; build/green says which commit passed, and how long it took
	@$(PYTHON) -m tools.clean_gate

fresh: ## Run the README's two commands on pristine Debian machines; DEBIAN=13 WHO=user ONLY=run does a part
	@python3 -m tools.fresh $(DEBIAN:%=--debian %) $(WHO:%=--who %) $(ONLY:%=--only %) \
		$(if $(filter file,$(origin PYTHON)),,--python $(PYTHON))

soak: $(VENV)/.dev $(VENV)/.client system-packages ## Run what make test leaves out; PART=timing, built or long (hours) does a part
	@$(if $(filter-out $(PARTS),$(PART)),echo "PART is one of: $(PARTS)." >&2; exit 2)
	@set -e; for part in $(or $(PART),$(PARTS)); do $(MAKE) --no-print-directory soak-$$part; done

soak-timing:
	@$(BIN)/python -m pytest $(IN_ORDER) tests/soak/timing

soak-built:
	@$(BIN)/python -m pytest $(IN_ORDER) tests/soak/built

soak-long:
	@HELIOPANEL_SOAK=1 HELIOPANEL_TEST_PATIENCE_S=600 $(BIN)/python -m pytest -s tests --ignore=tests/soak --ignore=tests/looks
	@HELIOPANEL_SOAK=1 $(BIN)/python -m pytest -s tests/soak/timing/test_clock_jump.py tests/soak/timing/test_field_events.py tests/soak/timing/test_storm.py
	@HELIOPANEL_SOAK=1 HELIOPANEL_TEST_KILLS=$${HELIOPANEL_TEST_KILLS:-1000} $(BIN)/python -m pytest -s tests/soak/long
	@HELIOPANEL_TEST_KILLS=20 $(BIN)/python -m pytest -s tests/soak/timing/test_kill.py tests/soak/timing/test_process.py
	@HELIOPANEL_TEST_KILLS=30 HELIOPANEL_TEST_TRACKERS=100 $(BIN)/python -m pytest -s tests/soak/timing/test_storm_kill.py

mutants: $(VENV)/.dev ## Change what guards and limits place by place, in a copy, and count what tests notice
	@$(BIN)/python -m tools.mutants $(ONLY)

browser: $(VENV)/.test system-packages ## Run the browser tests alone; screenshots go to build/screens
	@HELIOPANEL_SCREENS=1 $(BIN)/python -m pytest tests/browser

# Two at a time; what each says comes together. The texts take longest but for the types, and begin with them.
CHECKS := types texts security lint generated imports secrets clocks vendored migrations
.PHONY: $(CHECKS:%=check-%)

check: $(VENV)/.test ## Formatting, lint, types, layers, texts, documents, generated and vendored files, migrations
	@$(MAKE) --no-print-directory --keep-going --output-sync=target --jobs=2 $(CHECKS:%=check-%)

check-types:
	@$(BIN)/mypy
check-texts:
	@$(BIN)/python -m checks texts sources documents
check-security:
	@$(BIN)/bandit -q -r app -c pyproject.toml -ll
check-lint:
	@$(BIN)/ruff format --check .
	@$(BIN)/ruff check .
check-generated:
	@$(BIN)/python -m checks generated api
check-imports:
	@$(BIN)/lint-imports
check-secrets:
	@$(BIN)/python -m checks secrets
check-clocks:
	@$(BIN)/python -m checks clocks
check-vendored:
	@$(BIN)/python static/vendor/vendor.py check
check-migrations:
	@$(BIN)/python -m app.store.migrations check
	@$(BIN)/python -m app.access.migrations

firmware: ## Build the firmware of controllers/avr for Arduino Mega and Uno (avr-gcc)
	@$(MAKE) -s -C controllers/avr BOARD=mega
	@$(MAKE) -s -C controllers/avr BOARD=uno
	@ls controllers/avr/build/*.hex

translations: $(VENV)/.test ## Bring catalogues, and fonts cut for them, up to date with the texts of the sources
	@$(BIN)/python -m app.web.translation.catalogues update
	@$(BIN)/python static/vendor/vendor.py letters

fuzz: $(VENV)/.test ## Send 10,000 bad requests to the API, and hostile values into every form
	@$(BIN)/python -m tools.fuzz

bench: $(VENV)/.dev system-packages ## Measure, as ratios against peers in the same run, and write docs/develop/benchmarks.md
	@$(BIN)/python -m bench

format: $(VENV)/.test ## Format the code
	@$(BIN)/ruff format .
	@$(BIN)/ruff check --fix .

# For every Python from 3.11 on: Debian 12 has 3.11.2, where some releases want 3.11.5, and 3.13 needs libraries
# that 3.11 does not.
COMPILE = $(BIN)/uv pip compile --universal --python-version 3.11 --upgrade --generate-hashes --no-emit-index-url \
	--no-annotate --no-header -q
lock: $(VENV)/.runtime ## Renew the locked dependencies
	$(COMPILE) --extra build --extra all pyproject.toml -o requirements.txt
	$(COMPILE) --extra build --extra all --extra dev -c requirements.txt pyproject.toml -o requirements-dev.txt
	$(COMPILE) --extra build --extra all --extra mdns --extra test -c requirements-dev.txt pyproject.toml -o requirements-test.txt
	$(COMPILE) --extra build --extra all --extra fast -c requirements-dev.txt pyproject.toml -o requirements-fast.txt
	$(COMPILE) --group client -o requirements-client.txt
	$(COMPILE) --group uv -o requirements-uv.txt

clean: ## Remove what was built (not the data)
	rm -rf $(VENV) build dist .pytest_cache .mypy_cache .ruff_cache .import_linter_cache
