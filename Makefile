# Everything starts here. On a bare Linux machine with Python 3.11, make and git, `make test`
# and `make demo` set up what they need: one environment per Blender, each a virtual
# environment that holds Blender as a Python module and the numpy that this Blender bundles.

SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

VERSION := $(shell sed -n 's/^version = "\(.*\)"/\1/p' blender_manifest.toml)
ZIP := dist/mocap_assist-$(VERSION)-linux_x64.zip
WHEEL := dist/mocap_assist-$(VERSION)-py3-none-any.whl
PYTHON_4.5 := .venv-4.5/bin/python
PYTHON_5.2 := .venv-5.2/bin/python
TYPED := build/types/mocap_assist_extension
NO_PYTHON = no Python $(1) that can make environments was found: not on the PATH, nor in uv's or pyenv's folders
NO_5.2 := SKIPPED on Blender 5.2: $(call NO_PYTHON,3.13).

# Solves are small, and two suites run side by side: one thread each.
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1
# The suites start hundreds of Pythons. Without bytecode each compiles all that it imports:
# 2.9 s of CPU time in place of 1.2 s for a solve of Clean.
unexport PYTHONDONTWRITEBYTECODE
# A test that hangs, or a Blender that hangs at its end, must not hold up the rest forever; a
# suite takes ten minutes on a quiet machine and an hour next to ten other jobs.
AT_MOST := timeout --kill-after=10 3600
SUBMAKE := $(MAKE) --no-print-directory --jobs=2

.PHONY: help
help:  ## this list
	@awk -F ':.*## ' '/^[a-z][a-z0-9.-]*:.*## / { printf "  %-21s%s\n", $$1, $$2 }' Makefile

# --- Tests ---

.PHONY: test lint test-source-4.5 test-source-5.2 test-blender test-blender-4.5 test-blender-5.2
.PHONY: test-wheel
# The longest first, so that both cores are busy to the end.
test: environments  ## every check and test below, on Blender 4.5 and 5.2, two at a time
	@$(SUBMAKE) --output-sync=target --keep-going \
	    test-source-5.2 test-source-4.5 test-blender-5.2 test-blender-4.5 lint test-wheel
	@if [ -e .venv-5.2/ready ]; then echo "All is well, on Blender 4.5 and 5.2."; \
	else echo "$(NO_5.2)"; echo "All is well, on Blender 4.5."; fi

lint: .venv-4.5/ready $(TYPED)  ## ruff, mypy on all that ships, and the calls of benchmarks
	$(PYTHON_4.5) -m ruff check .
	$(PYTHON_4.5) -m ruff format --check .
	$(PYTHON_4.5) -m mypy
	$(PYTHON_4.5) -m mypy --config-file tests/types.ini tests/benchmarks tests/training

# The extension as one package, which is what its parts import each other from.
$(TYPED):
	@mkdir -p $(@D)
	@ln -sfn ../.. $@

test-source-4.5: .venv-4.5/ready  ## the checkout: Python 3.11 and the numpy of Blender 4.5
	$(AT_MOST) $(PYTHON_4.5) -m pytest

test-source-5.2: optional-5.2  ## the solvers: Python 3.13 and the numpy of Blender 5.2
	@[ ! -e .venv-5.2/ready ] || { set -x; $(AT_MOST) $(PYTHON_5.2) -m pytest tests/solvers; }

test-blender: test-blender-4.5 test-blender-5.2  ## the installed zip, in both Blenders

test-blender-4.5: .venv-4.5/ready zip  ## the installed zip, in Blender 4.5
	MOCAP_ASSIST_ZIP=$(ZIP) $(AT_MOST) $(PYTHON_4.5) -m pytest tests/blender

test-blender-5.2: optional-5.2 zip  ## the installed zip, in Blender 5.2
	@[ ! -e .venv-5.2/ready ] || { set -x; \
	    MOCAP_ASSIST_ZIP=$(ZIP) $(AT_MOST) $(PYTHON_5.2) -m pytest tests/blender; }

test-wheel: .venv-4.5/ready optional-5.2 wheel  ## the installed wheel, on Python 3.11 to 3.13
	MOCAP_ASSIST_WHEEL=$(WHEEL) $(AT_MOST) $(PYTHON_4.5) -m pytest tests/wheel
	@[ ! -e .venv-5.2/ready ] || { set -x; \
	    MOCAP_ASSIST_WHEEL=$(WHEEL) $(AT_MOST) $(PYTHON_5.2) -m pytest tests/wheel; }

.PHONY: test-wheel-oldest
test-wheel-oldest: .venv-4.5/ready wheel  ## the wheel with the lowest versions of its libraries
	MOCAP_ASSIST_OLDEST=yes MOCAP_ASSIST_WHEEL=$(WHEEL) $(AT_MOST) $(PYTHON_4.5) -m pytest \
	    tests/wheel/test_clean_environments.py -k lowest

.PHONY: test-gui
test-gui: extension-plain  ## press buttons in a Blender with a window; DRIVERS="clean vary"
	$(PYTHON_4.5) tests/gui/run_drivers.py --zip dist/mocap_assist-$(VERSION)-plain.zip $(DRIVERS)

# The fuzzer comes as a wheel for Linux; it finds files, and no verdict depends on time.
SECONDS ?= 60
.PHONY: fuzz
fuzz: .venv-fuzz/ready  ## search for files that break a reader; SECONDS=60 TARGETS="c3d bvh"
	.venv-fuzz/bin/python tests/fuzz/fuzz_files.py --seconds $(SECONDS) $(TARGETS)

.PHONY: kills
kills: .venv-4.5/ready zip  ## kill commands at random moments; ARGUMENTS="--kills 60 --each 12"
	PYTHONPATH=.:tests/fixtures $(PYTHON_4.5) .ci/kill_commands.py --zip $(ZIP) $(ARGUMENTS)

# --- What there is to see ---

.PHONY: demo docs catalogs pictures pictures-origins sensitivity
demo: .venv-4.5/ready zip  ## clean a sample, or CLIP=path.bvh, in Blender 4.5: build/demo
	@mkdir -p build/demo
	MOCAP_ASSIST_ZIP=$(ZIP) $(AT_MOST) $(PYTHON_4.5) .ci/demo.py build/demo $(if $(CLIP),"$(CLIP)")

docs: .venv-4.5/ready  ## tables of settings and buttons, and job types of Flamenco, in docs
	PYTHONPATH=. $(PYTHON_4.5) .ci/documents/write_docs.py
	PYTHONPATH=. $(PYTHON_4.5) .ci/documents/write_flamenco.py

catalogs: .venv-4.5/ready zip  ## texts of other languages; ARGUMENTS=--untranslated prints what lacks one
	$(PYTHON_4.5) .ci/languages/catalogs.py --zip $(ZIP) $(ARGUMENTS)

pictures: .venv-4.5/ready  ## the pictures of docs/formats and of Reconstruct, from ../shared/data
	PYTHONPATH=. $(PYTHON_4.5) .ci/documents/draw_formats.py ../shared/data
	PYTHONPATH=. $(PYTHON_4.5) .ci/documents/draw_reconstruction.py ../shared/data

pictures-origins: .venv-4.5/ready  ## takes of many makers, imported, cleaned, on Rigify: build/origins
	PYTHONPATH=. $(PYTHON_4.5) .ci/documents/draw_origins.py ../shared/data build/origins $(TAKES)

# Each writes what is shipped from recordings of ../shared/data; ARGUMENTS="--out FILE" writes
# elsewhere, and tests/training/README.md says from which recordings, and how long it takes.
.PHONY: forest postures residuals motion-prior motion-mixture body-relation failures contacts
forest: .venv-4.5/ready  ## train the shipped forest that classifies body parts in depth images
	$(PYTHON_4.5) -m tests.training.train_forest $(ARGUMENTS)

postures: .venv-4.5/ready  ## thin out the shipped library of postures
	$(PYTHON_4.5) -m tests.training.train_postures $(ARGUMENTS)

residuals: .venv-4.5/ready  ## learn the shipped errors of a Kinect, and their confidence
	$(PYTHON_4.5) -m tests.training.train_residuals $(ARGUMENTS)

motion-prior: .venv-4.5/ready  ## learn the shipped motion prior of the depth tracker
	$(PYTHON_4.5) -m tests.training.train_motion_prior $(ARGUMENTS)

motion-mixture: .venv-4.5/ready  ## learn how joints move; ARGUMENTS=--pairs: with their parents
	$(PYTHON_4.5) -m tests.training.train_motion_mixture $(ARGUMENTS)

body-relation: .venv-4.5/ready  ## learn how joints move together, for limbs that are missing
	$(PYTHON_4.5) -m tests.training.train_body_relation $(ARGUMENTS)

failures: .venv-4.5/ready  ## learn when a tracked pose is wrong, and print the weights
	$(PYTHON_4.5) -m tests.training.learn_failures

contacts: .venv-4.5/ready  ## learn how a foot in contact moves, and print the weights
	$(PYTHON_4.5) -m tests.training.learn_contacts

BENCHMARKS := denoise first-press contacts markers bvh press live scene import import-corpus roles up-axis video \
  reliability reconstruct postures retrieval retarget variation depth physics gestures retarget-rig farm
.PHONY: benchmarks $(BENCHMARKS:%=bench-%)
benchmarks: .venv-4.5/ready  ## run every benchmark, one after another (hours); prints how each ended
	@mkdir -p build/benchmarks; failed=0; for name in $(BENCHMARKS); do \
	  start=$$(date +%s); result=ok; \
	  $(MAKE) --silent bench-$$name > build/benchmarks/$$name.txt 2>&1 || { result=failed; failed=1; }; \
	  echo "$$name: $$result, $$(( $$(date +%s) - start )) s, build/benchmarks/$$name.txt"; \
	done; exit $$failed

# Each prints tables; with ARGUMENTS=--docs it rewrites its own part of a page in docs/benchmarks, and
# ARGUMENTS=--help lists the other options.
bench-denoise: .venv-4.5/ready  ## measure denoising and gap filling against peers
	$(PYTHON_4.5) -m tests.benchmarks.denoise.bench_denoise $(ARGUMENTS)

bench-first-press: .venv-4.5/ready  ## measure Clean without examples against filters
	nice $(PYTHON_4.5) -m tests.benchmarks.first_press.bench_first_press $(ARGUMENTS)

bench-contacts: .venv-4.5/ready  ## measure planted and retargeted feet and hands, and each goal left out
	$(PYTHON_4.5) -m tests.benchmarks.contacts.bench_contacts $(ARGUMENTS)

bench-markers: .venv-4.5/ready  ## measure labels, rigid clusters and skeletons of optical markers
	$(PYTHON_4.5) -m tests.benchmarks.markers.bench_markers $(ARGUMENTS)

bench-bvh: .venv-4.5/ready  ## measure reading of BVH against Blender's importer
	$(PYTHON_4.5) -m tests.benchmarks.importing.bench_bvh_import $(ARGUMENTS)

bench-live: .venv-4.5/ready  ## measure how long a live frame takes, from joints to a rig
	$(PYTHON_4.5) -m tests.benchmarks.live.bench_live $(ARGUMENTS)

bench-press: .venv-4.5/ready  ## measure presses with and without a solver that waits
	$(PYTHON_4.5) -m tests.benchmarks.press.bench_press $(ARGUMENTS)

bench-stalls: .venv-4.5/ready  ## measure how long the window stands still on a long take
	$(PYTHON_4.5) -m tests.benchmarks.press.bench_stalls $(ARGUMENTS)

bench-scene: .venv-4.5/ready  ## measure reading and writing of actions of 120 bones
	$(PYTHON_4.5) -m tests.benchmarks.importing.bench_scene_io $(ARGUMENTS)

bench-import: .venv-4.5/ready  ## measure the import time of recordings of five minutes
	$(PYTHON_4.5) -m tests.benchmarks.importing.bench_import $(ARGUMENTS)

bench-import-corpus: .venv-4.5/ready  ## read every recording of other makers, and compare with its truth
	$(PYTHON_4.5) -m tests.benchmarks.importing.bench_import_corpus $(ARGUMENTS)

bench-roles: .venv-4.5/ready  ## measure how often the role of a bone is right, by its reason
	$(PYTHON_4.5) -m tests.benchmarks.importing.bench_role_confidence

bench-up-axis: .venv-4.5/ready  ## measure how often the up axis of points is right
	$(PYTHON_4.5) -m tests.benchmarks.importing.bench_up_axis $(ARGUMENTS)

bench-video: .venv-4.5/ready  ## measure Clean, Plant Feet and Physics on takes of video models
	$(PYTHON_4.5) -m tests.benchmarks.video.bench_video $(ARGUMENTS)

bench-reliability: .venv-4.5/ready  ## measure the detection of joint errors of a Kinect
	$(PYTHON_4.5) -m tests.benchmarks.reconstruction.bench_reliability $(ARGUMENTS)

bench-reconstruct: .venv-4.5/ready  ## measure reconstruction of Kinect joints against peers
	$(PYTHON_4.5) -m tests.benchmarks.reconstruction.bench_reconstruct $(ARGUMENTS)

bench-postures: .venv-4.5/ready  ## measure the completion of poses from the pose library
	$(PYTHON_4.5) -m tests.benchmarks.reconstruction.bench_postures $(ARGUMENTS)

bench-retrieval: .venv-4.5/ready  ## measure retrieval of similar clips against peers
	$(PYTHON_4.5) -m tests.benchmarks.retrieval.bench_retrieval $(ARGUMENTS)

bench-retarget: .venv-4.5/ready  ## measure retargeting and unbaking against Blender's Decimate
	$(PYTHON_4.5) -m tests.benchmarks.retarget.bench_retarget $(ARGUMENTS)

bench-variation: .venv-4.5/ready  ## measure variants of a few clips against peers
	$(PYTHON_4.5) -m tests.benchmarks.variation.bench_variation $(ARGUMENTS)

bench-depth: .venv-4.5/ready  ## measure the depth tracker against known joints and peers
	$(PYTHON_4.5) -m tests.benchmarks.depth.bench_depth $(ARGUMENTS)

bench-physics: .venv-4.5/ready  ## measure Physics, before and after, and at partial strength
	$(PYTHON_4.5) -m tests.benchmarks.physics.bench_physics $(ARGUMENTS)

bench-gestures: .venv-4.5/ready  ## measure detected, missed and false gestures
	$(PYTHON_4.5) -m tests.benchmarks.retrieval.bench_gestures $(ARGUMENTS)

bench-retarget-rig: .venv-4.5/ready  ## measure Retarget in Blender against baking controls
	$(PYTHON_4.5) -m tests.benchmarks.retarget.bench_retarget_rig $(ARGUMENTS)

bench-farm: .venv-4.5/ready  ## measure batches on a Dask cluster against processes of this machine
	$(PYTHON_4.5) -m tests.benchmarks.farm.bench_farm $(ARGUMENTS)

sensitivity: .venv-4.5/ready  ## halve and double each tuned constant; ARGUMENTS="--family feet"
	nice $(PYTHON_4.5) -m tests.benchmarks.sensitivity.run_sensitivity $(ARGUMENTS)

# --- The extension ---

.PHONY: extension extension-per-python extension-plain zip repository
extension: .venv-4.5/ready  ## the zips of all platforms, with their wheels: dist
	$(PYTHON_4.5) .ci/packages/build_extension.py

extension-per-python: .venv-4.5/ready  ## zips of half the size, for each platform and Python
	$(PYTHON_4.5) .ci/packages/build_extension.py --per-python

extension-plain: .venv-4.5/ready  ## a zip without wheels, for a Blender of another Python
	$(PYTHON_4.5) .ci/packages/build_extension.py --plain

zip: .venv-4.5/ready  ## the zip for Linux, which the tests install
	@$(PYTHON_4.5) .ci/packages/build_extension.py --platform linux-x64

repository: .venv-4.5/ready  ## what a studio serves to its Blenders from a share: dist/repository
	$(PYTHON_4.5) .ci/packages/build_repository.py $(ARGUMENTS)

# --- The Python package ---

.PHONY: wheel
wheel: .venv-wheel/ready  ## the solvers as a package for pip: dist
	@.venv-wheel/bin/python -m hatchling build --target wheel --directory dist

# --- A release ---

.PHONY: version release
version: .venv-4.5/ready  ## write the next version where it stands: make version NUMBER=0.3.0
	$(PYTHON_4.5) .ci/packages/release.py version "$(NUMBER)"

release: .venv-4.5/ready  ## check this commit, and gather all files of its release; TESTED=yes
	$(PYTHON_4.5) .ci/packages/release.py check $(if $(TESTED),--tested)
	@$(MAKE) --no-print-directory extension extension-per-python wheel
	$(PYTHON_4.5) .ci/packages/release.py collect

# --- Environments ---

.PHONY: environments libraries optional-5.2 clean
environments: libraries  ## .venv-4.5, .venv-wheel and, where there is a Python 3.13, .venv-5.2
	@$(SUBMAKE) .venv-4.5/ready .venv-wheel/ready optional-5.2

optional-5.2:
	@if .ci/find_python 3.13 >/dev/null; then $(MAKE) --no-print-directory .venv-5.2/ready; \
	elif [ ! -e .venv-5.2/ready ]; then echo "$(NO_5.2)"; fi

libraries:
	@python=$$(.ci/find_python 3.11) || { echo "Stopped: $(call NO_PYTHON,3.11)."; \
	    echo "On Debian and Ubuntu: sudo apt-get install python3.11-venv"; exit 1; }; \
	"$$python" .ci/check_libraries.py $(INSTALL_LIBRARIES)

.venv-4.5/ready: PYTHON := 3.11
.venv-5.2/ready: PYTHON := 3.13
.venv-fuzz/ready .venv-wheel/ready: PYTHON := 3.11
.venv-%/ready: .ci/requirements-%.txt .ci/requirements.txt | libraries
	@if [ -L $(@D) ]; then echo "$(@D) is a link, and left as it is."; else \
	    echo "Setting up $(@D), once: a minute and up to 1.5 GB."; \
	    "$$(.ci/find_python $(PYTHON))" -m venv --clear $(@D); \
	    $(@D)/bin/python -m pip install -qq --no-deps --no-compile --disable-pip-version-check -r $<; fi
	@touch $@

clean:  ## remove what make made, the environments too
	rm -rf .venv-4.5 .venv-5.2 .venv-fuzz .venv-wheel .venv-wheel-* build dist wheels
