# Clone, then `make reproduce` or `make test`: each installs what is missing, configures, builds and runs.
PRESET ?= release
BUILD := build/$(PRESET)
SCALE ?= host
OUT ?= $(if $(filter host,$(SCALE)),results,build/results-$(SCALE))

# Presets of Clang need it installed.
ifneq (,$(filter clang tsan,$(PRESET)))
export DSS_EXTRA_PACKAGES += clang libomp-dev libclang-rt-dev
endif

.PHONY: all build test reproduce bench clean dependencies

all: build

dependencies:
	@./cmake/install_packages.sh

build: dependencies
	@cmake --preset $(PRESET) >$(PRESET).configure.log 2>&1 || { cat $(PRESET).configure.log; exit 1; }
	@rm -f $(PRESET).configure.log
	@cmake --build --preset $(PRESET) $(TARGETS)

test: build
	@ctest --preset $(PRESET)

# The program and its variants alone: no tests to build.
reproduce: TARGETS := --target dssbench
reproduce: build
	@$(BUILD)/dssbench verify --quiet
	@for study in table1_host table1 table2 table3_cpu cluster; do $(BUILD)/dssbench experiment experiments/$$study.json --scale $(SCALE) --out $(OUT) || exit 1; done
	@mkdir -p $(OUT)/fields
	@$(BUILD)/dssbench run plate_paper --set n=60 --steps 2000 --output $(OUT)/fields/plate_paper.vtu >/dev/null
	@/usr/bin/python3 plots/make_plots.py --results $(OUT)

bench: build
	@$(BUILD)/kernel_benchmark --benchmark_min_time=0.05 --benchmark_repetitions=3 --benchmark_report_aggregates_only=true \
	  --benchmark_enable_random_interleaving=true $(BENCH_FLAGS)

clean:
	@rm -rf build
