# conelab: `make demo` and `make test` install what is missing on Debian and Ubuntu, build and run.

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
export PATH := $(PATH):$(HOME)/.cargo/bin

# Size of the demo's pictures, and more arguments of `conelab render`, for example: make demo SIZE=1920x1080 ARGS="--set voxel_dim=256"
SIZE ?= 1280x720
ARGS ?=
# Run only the tests whose names hold this, for example: make test TESTS=voxel
TESTS ?=

VERSION := $(shell sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
CONELAB := cargo run --quiet --release --locked --
OUT := captures/demo

.PHONY: help demo view shot test check fmt dist setup clean

help: ## Say what there is
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/make \1	\2/p' $(MAKEFILE_LIST) | expand -t 14

demo: ## Render the built-in atrium, lit by voxel cones, on any Vulkan device
	@scripts/setup.sh build run
	@cargo build --release --locked
	@$(CONELAB) devices
	@$(CONELAB) render configs/default.ron --scene atrium --size $(SIZE) $(ARGS) \
		--json $(OUT)/stats.json -o $(OUT)/atrium.png
	@$(CONELAB) render configs/default.ron --scene atrium --size $(SIZE) $(ARGS) \
		--set view=voxels --set voxel_view=color -o $(OUT)/voxels.png
	@printf '\nLook at:\n  %s\n  %s\n  %s\n' \
		'$(OUT)/atrium.png   the atrium by direct light and voxel cones' \
		'$(OUT)/voxels.png   the voxels that stand for the scene, coloured by albedo' \
		'$(OUT)/stats.json   times of every pass, memory of every resource, all settings'

view: ## Open the workbench
	@scripts/setup.sh build run window
	@cargo build --release --locked
	@$(CONELAB) view $(ARGS)

shot: ## Take the README's picture of the workbench
	@scripts/setup.sh build run
	@$(CONELAB) screenshot configs/default.ron --scene atrium --window 1600x900 \
		--click "raster | tessellated" --click Time --click "keep rendering" --measure 400 $(ARGS) -o docs/workbench.jpg

test: ## Run all tests
	@scripts/setup.sh build run test
	@cargo test --locked --quiet --doc $(TESTS)
	@cargo test --locked --no-fail-fast --lib --bins --tests $(TESTS)

check: ## Check formatting, lints, graphs, shaders and experiments
	@scripts/setup.sh build
	@cargo fmt --check
	@cargo clippy --locked --all-targets -- -D warnings
	@cargo run --quiet --locked -- check

fmt: ## Format the source
	@cargo fmt

dist: ## Pack the program for other Linux machines
	@scripts/setup.sh build
	@scripts/dist.sh $(VERSION)

setup: ## Install what building, running and testing need
	@scripts/setup.sh build run test

clean: ## Remove what was built
	@cargo clean
	@rm -rf dist .shaderc
