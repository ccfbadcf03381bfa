# conelab: `make demo` and `make test` install what is missing on Debian and Ubuntu, build and run.

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
export PATH := $(PATH):$(HOME)/.cargo/bin

# Size of the demo's pictures (1280x720; 640x360 without a GPU), and more arguments of `conelab render`, for example: make demo SIZE=1920x1080 ARGS="--set voxel_dim=256"
SIZE ?=
ARGS ?=
# Run only the tests whose names hold this, for example: make test TESTS=voxel
TESTS ?=
# Slow suites that run at once: many use one core, because compilers of shaders do.
JOBS ?= 2
# BUDGET: seconds within which slow suites may begin. TURN: the number of the first one. Suites of windows always run.
BUDGET ?= 86400
TURN ?= 0
# Takes 25 minutes of a core, and so is left out wherever there is a budget.
LONG := $(if $(filter-out 86400,$(BUDGET)),families)
# Slow suites that drive a window: they wait for pictures, and so run alone.
ALONE := window chart runs
# Suites that take a minute and more, the longest first; what takes a second at most; and all others (files of tests/).
SLOW := incremental readme families reference converge emitters options furnace sweep stability energy area_lights turns volume tutorial scales normal_maps settings $(ALONE)
QUICK := effects floors graph_errors hostile metrics pages results structure
SUITES := $(filter-out $(SLOW),$(basename $(notdir $(wildcard tests/*.rs))))
RUN := cargo test --release --locked --no-fail-fast

VERSION := $(shell sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
CONELAB := cargo run --quiet --release --locked --
OUT := captures/demo

.PHONY: help demo view shot quick test slow python check record site figures fmt dist setup clean

help: ## Say what there is
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/make \1	\2/p' $(MAKEFILE_LIST) | expand -t 14

demo: ## Render the built-in atrium, lit through voxels, on any Vulkan device
	@scripts/setup.sh build run
	@cargo build --release --locked
	@$(CONELAB) devices
	@devices=$$($(CONELAB) devices); size='$(SIZE)'; \
	[[ -n $$size ]] || { [[ $${devices%%$$'\n'*} == *'(cpu,'* ]] && size=640x360 || size=1280x720; }; \
	$(CONELAB) render configs/rays.ron --scene atrium --size $$size $(ARGS) \
		--json $(OUT)/stats.json -o $(OUT)/atrium.png; \
	$(CONELAB) render configs/rays.ron --scene atrium --size $$size $(ARGS) \
		--set view=voxels --set voxel_view=color -o $(OUT)/voxels.png
	@printf '\nLook at:\n  %s\n  %s\n  %s\n' \
		'$(OUT)/atrium.png   the atrium by direct light and light that bounced' \
		'$(OUT)/voxels.png   the voxels that stand for the scene, coloured by albedo' \
		'$(OUT)/stats.json   times of every pass, memory of every resource, all settings'

view: ## Open the workbench
	@scripts/setup.sh build run window
	@cargo build --release --locked
	@$(CONELAB) view $(ARGS)

shot: ## Take the picture of the workbench in docs/workbench.md
	@scripts/setup.sh build run
	@$(CONELAB) screenshot configs/cones.ron --scene atrium --size 800x600 --window 1600x900 \
		--click Compare --click "cones | rays" --click timers --click Chart --click "Render reference" \
		--patience 600 $(ARGS) -o docs/workbench.jpg

quick: ## Run the tests that take a minute together
	@scripts/setup.sh build run test
	@$(RUN) --lib $(QUICK:%=--test %) $(TESTS)

test: ## Run the tests, but for the slow suites
	@scripts/setup.sh build run test
	@cargo test --release --locked --quiet --doc $(TESTS)
	@$(RUN) --lib --bins $(SUITES:%=--test %) $(TESTS)

slow: ## Run the slow suites, JOBS (2) side by side, but families where there is a BUDGET
	@scripts/setup.sh build run test
	@$(RUN) --no-run $(SLOW:%=--test %)
	@$(if $(LONG),echo "no time for the suite $(LONG)")
	@until=$$(($$(date +%s) + $(BUDGET))); export until; \
	printf '%s\n' $(filter-out $(ALONE) $(LONG),$(SLOW)) | \
		awk -v turn=$(TURN) '{ suite[NR] = $$0 } END { for (i = 0; i < NR; i++) print suite[(i + turn) % NR + 1] }' | \
		xargs -P $(JOBS) -I{} bash -c '[[ $$(date +%s) -lt $$until ]] || { echo "no time left for the suite {}"; exit 0; }; \
		said=$$($(RUN) --test {} $(TESTS) 2>&1) && code=0 || code=$$?; printf "%s\n" "$$said"; exit $$code'
	@$(RUN) $(ALONE:%=--test %) $(TESTS)

python: ## Install the Python module in target/venv, and run its tests and notebooks
	@scripts/setup.sh build run test python
	@cargo build --release --locked
	@python3 -m venv target/venv
	@target/venv/bin/pip install --quiet './python[test]'
	@target/venv/bin/pytest python/tests $(TESTS:%=-k %)

check: ## Check formatting, lints, documentation, graphs, shaders and experiments
	@scripts/setup.sh build
	@cargo fmt --all --check
	@cargo clippy --release --locked --workspace --all-targets -- -D warnings
	@RUSTDOCFLAGS="-D warnings" cargo doc --release --locked --no-deps
	@$(CONELAB) check

record: ## Measure again what docs/results.md has tables of, and write them (half an hour of a GPU)
	@scripts/setup.sh build run
	@cargo build --release --locked
	@scripts/record.sh
	@CONELAB_BLESS=1 cargo test --release --locked --test results

site: ## Build the documentation as a site with search
	@scripts/setup.sh build
	@scripts/site.sh

figures: python ## Render the pictures of the documents again that show no times
	@target/venv/bin/python scripts/figures.py
	@CONELAB_BLESS=1 cargo test --release --locked --test results

fmt: ## Format the source
	@cargo fmt --all

dist: ## Pack the program for other Linux machines
	@scripts/setup.sh build
	@scripts/dist.sh $(VERSION)

setup: ## Install what building, running and testing need
	@scripts/setup.sh build run test python

clean: ## Remove what was built
	@cargo clean
	@rm -rf dist .shaderc
