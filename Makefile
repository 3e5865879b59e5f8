# After a clone: `make reproduce`, `make reproduce-gpu` or `make test`. Each installs missing
# packages, configures, builds and runs.
PRESET ?= release
BUILD := build/$(PRESET)
SCALE ?= host
OUT ?= $(if $(filter host,$(SCALE)),results,build/results-$(SCALE))

# Ninja would start two more jobs than there are processors, and that takes longer: the compiler
# needs its caches.
export CMAKE_BUILD_PARALLEL_LEVEL ?= $(shell nproc)

# These presets need Clang.
ifneq (,$(filter clang tsan,$(PRESET)))
export DSS_EXTRA_PACKAGES += clang libomp-dev libclang-rt-dev
endif

.PHONY: all build test reproduce reproduce-gpu gpu-studies report site bench clean dependencies
.PHONY: verify-cpu verify-devices pages test-aarch64 fuzz mutants faults restarts flips valgrind
.PHONY: sanitize coverage wheel archive

# The program and its variants alone, without the tests.
all: TARGETS := --target dssbench
all: build

dependencies:
	@./cmake/install_packages.sh

build: dependencies
	@cmake --preset $(PRESET) $(CONFIGURE) >$(PRESET).configure.log 2>&1 || { cat $(PRESET).configure.log; exit 1; }
	@rm -f $(PRESET).configure.log
	@cmake --build --preset $(PRESET) $(TARGETS)

# The test of sizes needs ctags, random scenes need RapidCheck. The preset ci leaves out what needs
# a browser or MkDocs. The presets for users have the Python package.
PYTHON_PACKAGES := pybind11-dev python3-dev
test: export DSS_EXTRA_PACKAGES += universal-ctags librapidcheck-dev \
  $(if $(filter ci,$(PRESET)),,chromium chromium-driver python3-selenium mkdocs) \
  $(if $(filter ci release,$(PRESET)),$(PYTHON_PACKAGES))
test: CONFIGURE := $(if $(filter ci release,$(PRESET)),-DDSS_WITH_PYTHON=ON \
  -DPython_EXECUTABLE=/usr/bin/python3)
test: build
	@ctest --preset $(PRESET)

# Writes what is generated from the program and from results: the schema of names, the joined schema
# of studies, the page of columns, and the figures that pages quote. Tests fail if one of them is not
# current.
pages: TARGETS := --target dssbench schema_names
pages: build
	@$(BUILD)/tests/schemas/schema_names >$(BUILD)/names.json
	@mv $(BUILD)/names.json solver/json/names.schema.json
	@tests/schemas/study_schema.py
	@$(BUILD)/dssbench list columns --json | tests/docs/columns_page.py >$(BUILD)/columns.md
	@mv $(BUILD)/columns.md results/columns.md
	@/usr/bin/python3 plots/fill_pages.py

# A wheel of the Python package, which a new environment then installs and tries.
wheel: export DSS_EXTRA_PACKAGES += $(PYTHON_PACKAGES)
wheel: dependencies
	@mkdir -p build/wheel
	@/usr/bin/python3 -m pip wheel . --quiet --no-deps --wheel-dir build/wheel \
	  --config-settings=build-dir=build/wheel/tree
	@/usr/bin/python3 tests/python/wheel_test.py build/wheel/dssbench-*.whl

# The same bits on another processor: cross-built, and run under an emulator.
test-aarch64: TARGETS := --target dssbench
test-aarch64: build
	@./cmake/install_aarch64.sh
	@cmake --preset aarch64 --no-warn-unused-cli >/dev/null
	@cmake --build --preset aarch64 --target dssbench
	@/usr/bin/python3 tests/aarch64/aarch64_test.py $(BUILD) build/aarch64

# Fuzzes the readers of files and the command line, FUZZ_S seconds each (tests/fuzz/fuzz.py).
FUZZ_S ?= 60
fuzz: export DSS_EXTRA_PACKAGES += clang libomp-dev libclang-rt-dev
fuzz: dependencies
	@cmake --preset fuzz --no-warn-unused-cli >/dev/null
	@cmake --build --preset fuzz --target dss_fuzz_targets
	@tests/fuzz/fuzz.py build/fuzz --seconds $(FUZZ_S)

# Plants mistakes into a copy of the tree, MUTANTS in each area (tests/mutants/mutate.py).
MUTANTS ?= 60
mutants: dependencies
	@mkdir -p build/mutants
	@git ls-files -z | xargs -0 cp --parents -t build/mutants
	@cmake --preset debug -S build/mutants -DDSS_UNITY=OFF -DDSS_FEWER_KERNELS=ON -DDSS_WERROR=OFF \
	  "-DDSS_VARIANTS=reference;scalar;avx2" >/dev/null
	@tests/mutants/mutate.py --tree build/mutants --count $(MUTANTS) --json build/mutants.json

# Kills, stops and failing writes, KILLS and WRITES of them (tests/faults/campaign.py).
KILLS ?= 1000
WRITES ?= 10000
faults: TARGETS := --target dssbench failing_calls
faults: build
	@/usr/bin/python3 tests/faults/campaign.py $(BUILD)/dssbench \
	  $$(find $(BUILD)/tests/faults -name '*failing_calls.so') --kills $(KILLS) --writes $(WRITES)

# Random runs, RESTARTS of them, interrupted and continued elsewhere (tests/faults/restarts.py).
RESTARTS ?= 1000
restarts: TARGETS := --target dssbench
restarts: build
	@tests/faults/restarts.py $(BUILD)/dssbench --runs $(RESTARTS)

# Wrong bits in the state of runs, FLIPS of them, and what finds them (tests/faults/flips.py).
FLIPS ?= 1000
flips: TARGETS := --target dssbench
flips: build
	@tests/faults/flips.py $(BUILD)/dssbench --flips $(FLIPS)

# Two ranks under valgrind, with every halo strategy (tests/faults/valgrind_ranks.sh).
valgrind: export DSS_EXTRA_PACKAGES += valgrind
valgrind: TARGETS := --target dssbench
valgrind: build
	@tests/faults/valgrind_ranks.sh $(BUILD)/dssbench

# The whole suite with each sanitizer, and ranks under valgrind: some two hours.
sanitize:
	@$(MAKE) --no-print-directory test PRESET=asan
	@$(MAKE) --no-print-directory test PRESET=tsan
	@$(MAKE) --no-print-directory valgrind

# Which lines and branches the suite runs (tests/coverage/coverage.py). A test that fails in this
# build does not hide what the others ran.
coverage: export DSS_EXTRA_PACKAGES += gcovr
coverage:
	@$(MAKE) --no-print-directory build PRESET=coverage
	@find build/coverage -name '*.gcda' -delete
	@-$(MAKE) --no-print-directory test PRESET=coverage
	@tests/coverage/coverage.py build/coverage

# These come first, because work_precision reads what error_budget found. They time nothing and use
# one core each, so two run side by side.
UNTIMED_STUDIES := error_budget failures continuum verification
# Speed-ups are measured in three parts, with other studies in between: a busy neighbour
# of the machine stays for minutes, and so disturbs only some of their rounds.
ROUNDS := 4
IN_THREE_PARTS := table1 table2 table3 chain chain_block chain_bending
PAPER_STUDIES := paper_table1 paper_table2 paper_table3
STUDIES := kernels
LATER_STUDIES := geometry work_precision implicit exponential advise stability model_ladder \
  statics balance cluster mixed_nodes
# Some five minutes of measuring: the paper's tables alone, on at most two ranks.
ifeq (quick,$(SCALE))
UNTIMED_STUDIES :=
IN_THREE_PARTS := table1 table2 table3
STUDIES :=
LATER_STUDIES :=
else
begin-table% go-on-table%: ROUNDS := 8 # of 24 and 30
endif
ORDER := $(IN_THREE_PARTS:%=begin-%) $(STUDIES:%=study-%) $(IN_THREE_PARTS:%=go-on-%) \
  $(LATER_STUDIES:%=study-%) $(IN_THREE_PARTS:%=end-%) $(PAPER_STUDIES:%=study-%)
SIDE_BY_SIDE := --no-print-directory -j 2 --output-sync=target

reproduce: TARGETS := --target dssbench
reproduce: build
	@$(MAKE) $(SIDE_BY_SIDE) verify-cpu verify-devices
	@$(if $(UNTIMED_STUDIES),$(MAKE) $(SIDE_BY_SIDE) $(addprefix study-,$(UNTIMED_STUDIES)))
	@for part in $(ORDER); do $(MAKE) --no-print-directory $$part || exit 1; done
	@mkdir -p $(OUT)/fields
	@$(BUILD)/dssbench run plate_paper --set n=60 --steps 2000 \
	  --output $(OUT)/fields/plate_paper.vtu >/dev/null
	@$(BUILD)/dssbench run l_bracket --output $(OUT)/fields/l_bracket.vtu --frames 6 >/dev/null
	@$(BUILD)/dssbench run arm/arm --set duration=0.0035 --threads 2 \
	  --output $(OUT)/fields/arm.vtu >/dev/null
	@/usr/bin/python3 plots/make_plots.py --results $(OUT)
	@/usr/bin/python3 plots/make_report.py --results $(OUT)

verify-cpu:
	@$(BUILD)/dssbench verify --quiet --device none
verify-devices:
	@$(BUILD)/dssbench verify --quiet plate_paper --variant scalar,opencl,opencl-rhs

# $(1): further options
MEASURE = start=$$(date +%s); $(BUILD)/dssbench experiment $* --scale $(SCALE) --out $(OUT) $(1) && \
  echo "== $@: $$(($$(date +%s) - start)) s"
study-%:
	@$(call MEASURE)
begin-%:
	@$(call MEASURE,--rounds $(ROUNDS))
go-on-%:
	@$(call MEASURE,--rounds $(ROUNDS) --resume)
end-%:
	@$(call MEASURE,--resume)

# All that needs a GPU. Without one, present results stay as they are.
reproduce-gpu: TARGETS := --target dssbench
reproduce-gpu: build
	@$(BUILD)/dssbench list devices >$(BUILD)/devices.txt
	@if awk '$$2 == "gpu" && !/unusable/ { found = 1 } END { exit !found }' \
	  $(BUILD)/devices.txt; then \
	  $(MAKE) --no-print-directory gpu-studies; \
	else echo "reproduce-gpu: there is no GPU here, nothing was measured" \
	  "(dssbench list devices shows what there is)"; fi

gpu-studies:
	@$(BUILD)/dssbench list devices --measure
	@$(BUILD)/dssbench verify --quiet --variant opencl,opencl-rhs --device gpu
	@for study in table3 table3_gpu paper_table3; do \
	  $(MAKE) --no-print-directory study-$$study || exit 1; done
	@/usr/bin/python3 plots/make_plots.py --results $(OUT)
	@/usr/bin/python3 plots/make_report.py --results $(OUT)

# Makes the page from present results. Measures nothing.
report: dependencies
	@/usr/bin/python3 plots/make_report.py --results $(OUT)

# All pages as a static site that opens from disk, build/site/index.html.
site: export DSS_EXTRA_PACKAGES += mkdocs
site: dependencies
	@plots/make_site.py build/site

# The committed tree with metadata for an archive such as Zenodo.
archive: dependencies
	@mkdir -p build
	@/usr/bin/python3 plots/make_archive.py build/dssbench.zip

bench: TARGETS := --target dssbench
bench: build
	@$(BUILD)/dssbench bench $(BENCH_FLAGS)

clean:
	@rm -rf build
