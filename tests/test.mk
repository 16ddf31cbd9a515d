# One program a test file; each ends with cmocka's summary line. `make test` runs them all.
TEST_PROGRAMS := $(patsubst %.c,$(B)/%,$(TESTS))
# Sources, or names from the command line: make bench BENCH="rays open".
BENCH_PROGRAMS := $(foreach b,$(BENCH),$(if $(filter %.c,$(b)),$(patsubst %.c,$(B)/%,$(b)),$(B)/tests/bench/bench_$(b)))
BAKE_PARTS := $(filter-out bake/main.c,$(BAKE))
SCENES_MADE := $(B)/scenes/atrium.obj

$(TEST_PROGRAMS): $(B)/tests/%: $(B)/tests/%.o $(COST_OBJECTS) $(call obj,$(BAKE_PARTS)) $(B)/libvitrine.a
	$(CC) $(OPT) $(WRAPPED:%=-Wl,--wrap=%) $^ -lcmocka $(LIBS_COST) $(LIBS_BAKE) $(LIBS_RUNTIME) -o $@
# Calls of our own objects that these tests want to see.
$(B)/tests/golden/test_no_allocation: private WRAPPED := malloc calloc realloc free aligned_alloc fopen fopen64 open open64 printf fprintf \
    vfprintf puts putchar fputs fwrite write
$(B)/tests/golden/test_effects: private WRAPPED := clCreateKernel clCreateBuffer clEnqueueNDRangeKernel
$(B)/tests/golden/test_reference_runs.o: CFLAGS_ALL += $(if $(LIBS_COST),-DVIT_MPI=1)
$(B)/tests/unit/test_work_kernel.o: CFLAGS_ALL += -DVIT_CC='"$(CC)"'
# How a program of the user's must be linked in this configuration.
$(B)/tests/golden/test_public_header.o: CFLAGS_ALL += -DVIT_COMPILE='"$(CC) $(OPT)"'
$(BENCH_PROGRAMS): $(B)/tests/%: $(B)/tests/%.o $(COST_OBJECTS) $(call obj,$(BAKE_PARTS)) $(B)/libvitrine.a
	$(CC) $(OPT) $^ $(LIBS_COST) $(LIBS_BAKE) $(LIBS_RUNTIME) -o $@
$(SCENES_MADE): $(B)/make-scenes $(wildcard bake/scenes/*.cfg)
	@mkdir -p $(B)/scenes
	$(B)/make-scenes bake/scenes $(B)/scenes

.PHONY: run-tests run-bench run-sanitized
test: deps
	@$(MAKE) --no-print-directory config=sanitize run-sanitized
	@$(MAKE) --no-print-directory run-tests
# Bad input under the address and undefined behaviour sanitizers.
SANITIZED := $(addprefix $(B)/tests/unit/,test_pack test_pack_forged test_pack_save test_scene)
run-sanitized: $(SANITIZED)
	@for t in $(SANITIZED); do echo "== $$t"; $$t || exit 1; done
run-tests: $(B)/vitrine-play $(B)/vitrine-bake $(B)/vitrine-cost $(SCENES_MADE) $(TEST_PROGRAMS)
	@for t in $(TEST_PROGRAMS); do echo "== $$t"; $$t || exit 1; done

bench: deps
	@$(MAKE) --no-print-directory run-bench
run-bench: $(B)/vitrine-play $(B)/vitrine-bake $(SCENES_MADE) $(BENCH_PROGRAMS)
	@for t in $(BENCH_PROGRAMS); do $$t || exit 1; done
