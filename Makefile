# Mend: `make demo` shows the main job, `make test` runs every test; both set everything up first.
SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready

# Much is done by processes that begin anew: each would compile every module once more.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help setup demo demo-building types console screenshots serve test console-tests arm-kernels building-kernels fleet-kernels steady lint bench lock sbom clean

help:  ## Say what there is
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*## /\t/' | expand -t 10

setup: $(READY)  ## Make .venv with everything (the other targets do this first)

# An environment that was moved here, or whose Python has gone since, is made anew.
ifneq ($(shell [ "$$(cat $(READY) 2>/dev/null)" = "$(CURDIR)" ] && $(BIN)/python -c '' && echo good),good)
.PHONY: $(READY)
endif

$(READY): requirements.lock pyproject.toml scripts/setup
	scripts/setup

demo: $(READY)  ## A PR2 builds a table base, is robbed, asks for help, and finishes
	$(BIN)/mend run eket --world workcell --scenario eket_paper --speed max --seed 7 --report out/eket_paper.html

OFFICE := out/tall_office
demo-building: $(READY)  ## Two hours of four robots in an office: deliveries, faults, help, and a report
	@mkdir -p out/scenes
	$(BIN)/mend building generate --seed 1 --floors 4 --rooms 30 -o $(OFFICE).yaml
	$(BIN)/mend building scene $(OFFICE).yaml --robots 4 -o out/scenes/tall_office.yaml
	$(BIN)/mend building run out/scenes/tall_office.yaml examples/buildings/shift.yaml --seed 7 \
	    --option localizer=exact --option wrong_floors=0.3 \
	    --transfer F1/lift1 --transfer F2/lift1 --transfer F3/lift1 --transfer F4/lift1 \
	    --helper reception --helper caretaker --report out/tall_office.html

# Node comes from a wheel in .venv, so that no system Node is needed.
web/node_modules/.ready: web/package-lock.json $(READY)
	cd web && PATH="$(CURDIR)/$(BIN):$$PATH" npm ci --silent
	touch $@

# What goes over the wire, as types: a change of the protocol so breaks the console's build.
types: web/node_modules/.ready
	$(BIN)/mend schema console >web/node_modules/.wire.json
	cd web && PATH="$(CURDIR)/$(BIN):$$PATH" npm run --silent types <node_modules/.wire.json

console: types  ## Build the helper console into the service
	cd web && PATH="$(CURDIR)/$(BIN):$$PATH" npm run --silent build

serve: console  ## The service with the helper console on http://127.0.0.1:8080
	$(BIN)/mend serve

screenshots: console  ## The console's pictures in docs/images, from situations that are played
	$(BIN)/python scripts/screenshots.py
	$(BIN)/python scripts/view_sheets.py

test: console $(VENV)/.kernels  ## Every test, in random order; one in a browser that fails is run once more
	$(MAKE) --no-print-directory -j -O console-tests $(VENV)/.test-modules
	@command -v chromium-headless-shell chromium google-chrome >/dev/null || echo 'There is no Chromium on this machine: the tests in a browser are skipped.'
	$(BIN)/python scripts/run_tests.py

console-tests:
	cd web && PATH="$(CURDIR)/$(BIN):$$PATH" npm test --silent

# The tests and the kernels are compiled once here, not by many processes at a time.
$(VENV)/.test-modules: $(READY)
	@told=$$($(BIN)/pytest --collect-only -q) || { tail -20 <<<"$$told"; exit 1; }
	@touch $@

# And again where a kernel has changed.
KERNELS := $(shell grep -rl --include='*.py' 'maps.compiled import' maps localization robots fleet sim)
$(VENV)/.kernels: $(READY) maps/compiled.py $(KERNELS)
	$(MAKE) --no-print-directory -j -O arm-kernels building-kernels fleet-kernels
	@touch $@

# Vision, kinematics and drawing, and localization.
arm-kernels:
	$(BIN)/mend check tasks/library/eket.yaml --world workcell
	$(BIN)/mend run eket --world tabletop --speed max --seed 1 --answers yes >/dev/null
	for method in enml cgr mcl; do \
	    $(BIN)/mend localize examples/localization/drive.csv --method "$$method" \
	        --map examples/localization/floor.vectormap.txt >/dev/null; \
	done

# Laser, driving, and localization within.
building-kernels:
	$(BIN)/mend run examples/buildings/conditional_plan.yaml --world building --speed max --seed 1 \
	    --answers yes >/dev/null

fleet-kernels:
	$(BIN)/mend schedule examples/deliveries/corridor.yaml >/dev/null

REPEAT := 30
steady: console  ## The tests in a browser 30 times over (or REPEAT=n), to find one that fails now and then
	@failed=0; for ((round = 1; round <= $(REPEAT); round++)); do \
	    echo "== $$round of $(REPEAT)"; $(BIN)/pytest -q tests/e2e || failed=$$((failed + 1)); \
	done; echo "$$failed of $(REPEAT) rounds failed"; [ $$failed = 0 ]

lint: types  ## Formatting, lint, types (of web/ too) and the floors
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	cd web && PATH="$(CURDIR)/$(BIN):$$PATH" npm run --silent check

bench: $(READY)  ## Every benchmark, one after the other (takes long)
	@for each in $$(grep -l __main__ benchmarks/*.py); do echo "== $$each"; $(BIN)/python "$$each"; done

LOCK := uv pip compile --quiet --universal --no-emit-index-url --no-annotate --generate-hashes \
    --custom-compile-command 'make lock'

lock: $(READY)  ## Pin the newest versions that pyproject.toml allows
	$(BIN)/$(LOCK) --all-extras --upgrade pyproject.toml requirements-build.in -o requirements.lock
	@# What goes into an image, and what only builds one: the same versions.
	$(BIN)/$(LOCK) --extra workcell --extra speech -c requirements.lock pyproject.toml -o docker/service.lock
	$(BIN)/$(LOCK) -c requirements.lock docker/tools.in -o docker/tools.lock

sbom: $(READY)  ## Every package that Mend is made of and with, as CycloneDX, in out/mend.cdx.json
	$(BIN)/python scripts/sbom.py out/mend.cdx.json

clean:  ## Remove everything that was made
	rm -rf $(VENV) web/node_modules server/api/console/built out build dist .mypy_cache .ruff_cache .pytest_cache .hypothesis
