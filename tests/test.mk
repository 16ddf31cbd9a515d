# One program a test file, of cmocka's tests. `make test` runs them all and ends with one total.
TEST_PROGRAMS := $(patsubst %.c,$(B)/%,$(TESTS))
# Sources, or names from the command line: make bench BENCH="rays open".
BENCH_PROGRAMS := $(foreach b,$(BENCH),$(if $(filter %.c,$(b)),$(patsubst %.c,$(B)/%,$(b)),$(B)/tests/bench/bench_$(b)))
SCENES_MADE := $(B)/scenes/atrium.obj

# Kernel functions as C on plain arrays (tests/host_lab.h), for the catalogue of hard cases.
HOST_LAB := $(B)/tests/host_lab.o $(HOST_ISAS:%=$(B)/tests/host_lab_%.o)
$(B)/host_labs.h: Makefile tests/test.mk
	@mkdir -p $(@D)
	@for i in $(HOST_ISAS); do echo "LAB($$i)"; done > $@
$(B)/tests/host_lab.o: CFLAGS_ALL += -I$(B)
$(B)/tests/host_lab.o: $(B)/host_labs.h
$(HOST_ISAS:%=$(B)/tests/host_lab_%.o): $(B)/tests/host_lab_%.o: tests/host_lab_kernels.c $(B)/kernel_list.h
	@mkdir -p $(@D)
	$(CC) $(if $(filter release,$(config)),-O2) $(HOST_CFLAGS) -Wno-unused-function -Wno-unused-variable $(HOST_FLAGS_$*) -DVIT_LANES=8 -DHOST_ISA='"$*"' -DHOST_LAB=host_lab_$* -c $< -o $@

NUMERIC_PROGRAMS := $(filter $(B)/tests/numeric/%,$(TEST_PROGRAMS))
$(NUMERIC_PROGRAMS) $(addprefix $(B)/tests/unit/test_,transfer_kernel receivers_kernel relight_kernel cache_kernel): $(HOST_LAB)
# Plain methods of other systems, which nothing of the product uses.
OCTREE := $(call obj,$(wildcard tests/baselines/octree*.c))
$(B)/tests/bench/bench_cache $(B)/tests/bench/bench_cache_moving: $(HOST_LAB)
$(B)/tests/golden/test_octree $(B)/tests/bench/bench_octree: $(OCTREE)
$(TEST_PROGRAMS): $(B)/tests/%: $(B)/tests/%.o $(BAKE_ARCHIVE) $(B)/libvitrine.a
	$(CC) $(OPT) $(WRAPPED:%=-Wl,--wrap=%) $(filter %.o,$^) $(filter %.a,$^) -lcmocka $(LIBS_COST) $(LIBS_BAKE) $(LIBS_RUNTIME) -o $@
# Calls of our own objects that these tests want to see.
$(B)/tests/golden/test_no_allocation: private WRAPPED := malloc calloc realloc free aligned_alloc fopen fopen64 open open64 printf fprintf \
    vfprintf puts putchar fputs fwrite write __printf_chk __fprintf_chk
# Put before libc's by LD_PRELOAD: signals at counted moments.
$(addprefix $(B)/tests/golden/test_,killed bake_tool): $(B)/tests/signal_at.so
$(B)/tests/signal_at.so: tests/preload/signal_at.c
	@mkdir -p $(@D)
	$(CC) $(BASE) $(WARN) -O2 -fPIC -shared $< -o $@
$(B)/tests/golden/test_effects: private WRAPPED := clCreateKernel clCreateBuffer clEnqueueNDRangeKernel
# The child that reads mesh files may be made to do anything.
$(B)/tests/unit/test_import_child: private WRAPPED := import_file
$(B)/tests/golden/test_reference_runs.o: CFLAGS_ALL += $(if $(LIBS_COST),-DVIT_MPI=1)
$(B)/tests/unit/test_work_kernel.o: CFLAGS_ALL += -DVIT_CC='"$(CC)"'
# How a program of the user's must be linked in this configuration.
$(B)/tests/golden/test_public_header.o: CFLAGS_ALL += -DVIT_COMPILE='"$(CC) $(OPT)"' -DVIT_LIBS='"$(LIBS_RUNTIME)"'
$(B)/tests/golden/test_public_header: $(B)/vitrine.pc
# The player's own judgement.
$(B)/tests/unit/test_budget_verdict: $(addprefix $(B)/runtime/play/,budget.o failure.o machine_load.o pacing.o report.o times.o)
# It casts rays with the tests' laboratory.
$(B)/tests/bench/bench_octree $(B)/tests/bench/bench_transfer: private LIBS_COST += -lcmocka
$(BENCH_PROGRAMS): $(B)/tests/%: $(B)/tests/%.o $(BAKE_ARCHIVE) $(B)/libvitrine.a
	$(CC) $(OPT) $(filter %.o,$^) $(filter %.a,$^) $(LIBS_COST) $(LIBS_BAKE) $(LIBS_RUNTIME) -o $@
$(SCENES_MADE): $(B)/make-scenes $(wildcard bake/scenes/*.cfg)
	@mkdir -p $(B)/scenes
	$(B)/make-scenes bake/scenes $(B)/scenes

# Tests run side by side, each with its output in one piece; those that take longest first, so that none is left to run alone. What test_same_bits
# has PoCL compile is there for those that come late.
JOBS ?= $(shell nproc)
# Called by a make that already has jobs to give, it takes of those.
SIDE_BY_SIDE = --no-print-directory $(if $(findstring jobserver,$(MAKEFLAGS)),,-j$(JOBS)) --output-sync=target
LONGEST := $(patsubst %,$(B)/tests/golden/test_%,same_bits pipeline furnace) $(B)/tests/unit/test_zones $(patsubst %,$(B)/tests/golden/test_%,baked_light odd_files dark_scenes cost bake_twice convergence indirect_auto auto effects bounds)
RUNS := $(addprefix run/,$(filter $(TEST_PROGRAMS),$(LONGEST)) $(filter-out $(LONGEST),$(TEST_PROGRAMS)))
.PHONY: matrix numeric run-tests run-bench build-tests build-sanitized build-sanitized-too
# What became of each test is written down here; a run of `make test` that is stopped, or cannot build, comes to no total.
RESULTS := build/results
test: deps
	@[ "$(OPENCL)" != 0 ] || { echo "make test: many tests are about OpenCL and its compiler; OPENCL=0 is for tools and demo" >&2; exit 2; }
	@rm -rf $(RESULTS); mkdir -p $(RESULTS)
	@$(MAKE) $(SIDE_BY_SIDE) build-tests build-sanitized-too
	@VITRINE_RESULTS=$(RESULTS) $(MAKE) $(SIDE_BY_SIDE) run-tests
	@tests/total.sh $(RESULTS) $(RUNS:run/%=%) $(SANITIZED_PLAYS)
# Bad input under the address and undefined behaviour sanitizers.
SANITIZED := $(addprefix tests/,$(addprefix unit/test_,pack pack_forged pack_forged_basis pack_save scene scene_mistakes transfer) fuzz/test_fuzz_corpus)
RUNS += $(filter-out $(RUNS),$(SANITIZED:%=run/build/sanitize/%))
build-sanitized: $(SANITIZED:%=$(B)/%) $(B)/vitrine-play
build-sanitized-too:
	@$(MAKE) --no-print-directory config=sanitize build-sanitized
build-tests: $(TEST_PROGRAMS) $(B)/vitrine-play $(B)/vitrine-bake $(B)/vitrine-cost $(SCENES_MADE)
# The kernels as C, too: packs that hold each effect between them, baked by the release's baker.
SANITIZED_list := cornell --zones 0 --sample-bits 16
SANITIZED_zones := cornell --zones 2 --indirect-samples 4 --kernel flattened
SANITIZED_raw := cornell --estimate buckets --smoothing raw --normal-keys 1 --zones 0
SANITIZED_sparse := cornell --estimate buckets --indirect-samples 16 --tile 8 --bounce-sequence 1
SANITIZED_basis := cornell --indirect basis --receiver-rays 64 --receiver-spacing 24 --sample-bits 16
SANITIZED_atrium := atrium --zones 0 --texture-filter trilinear
SANITIZED_PLAYS := $(addprefix sanitized-play/,list zones raw sparse basis atrium)
$(SANITIZED_PLAYS): sanitized-play/%: $(B)/vitrine-bake $(SCENES_MADE)
	@mkdir -p build/sanitize/packs
	@tests/run.sh $@ sh -ec '$(B)/vitrine-bake $(B)/scenes/$(firstword $(SANITIZED_$*)).cfg -o build/sanitize/packs/$*.vit --quiet --no-check --device host \
	  --size 96x64 --frames 1 --indirect photons --photons 2000 $(wordlist 2,99,$(SANITIZED_$*)); \
	  for l in 1 8; do build/sanitize/vitrine-play --quiet build/sanitize/packs/$*.vit --verify --device host --threads 3 --lanes $$l; done'
run-tests: $(B)/vitrine-play $(B)/vitrine-bake $(B)/vitrine-cost $(SCENES_MADE) $(RUNS) $(SANITIZED_PLAYS)
.PHONY: $(RUNS) $(SANITIZED_PLAYS)
$(RUNS): run/%: %
	@tests/run.sh $* $*

# The same test for hours' worth of frames.
SOAK_FRAMES ?= 20000
soak: deps
	@$(MAKE) $(SIDE_BY_SIDE) $(B)/tests/golden/test_soak $(B)/vitrine-play $(B)/vitrine-bake $(SCENES_MADE)
	for d in host 0; do VITRINE_SOAK_DEVICE=$$d VITRINE_SOAK_FRAMES=$(SOAK_FRAMES) $(B)/tests/golden/test_soak || exit 1; done
# Every way of playing that this machine offers gives the same hashes.
matrix: deps
	@$(MAKE) $(SIDE_BY_SIDE) $(B)/vitrine-play $(B)/vitrine-bake $(SCENES_MADE)
	@tests/matrix.sh $(B) build/matrix

# The catalogue of hard cases: every numeric test whole, or those of NUMERIC="slivers scale", one table of rows, a plot a sweep.
NUMERIC := $(NUMERIC_PROGRAMS:$(B)/tests/numeric/test_%=%)
NUMERIC_ASKED = $(NUMERIC:%=$(B)/tests/numeric/test_%)
numeric: deps
	@$(MAKE) $(SIDE_BY_SIDE) $(NUMERIC_ASKED) $(B)/vitrine-play $(B)/vitrine-bake $(SCENES_MADE)
	@rm -rf $(B)/numeric build/numeric
	@VITRINE_NUMERIC=whole $(MAKE) $(SIDE_BY_SIDE) $(addprefix run/,$(NUMERIC_ASKED)) > $(B)/numeric.log 2>&1 || { cat $(B)/numeric.log; exit 1; }
	@tests/numeric/catalogue.sh $(B)/numeric build/numeric

bench: deps
	@$(MAKE) --no-print-directory run-bench
run-bench: $(B)/vitrine-play $(B)/vitrine-bake $(SCENES_MADE) $(BENCH_PROGRAMS)
	@for t in $(BENCH_PROGRAMS); do $$t || exit 1; done
