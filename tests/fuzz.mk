# Fuzzing with libFuzzer, address and undefined behaviour sanitizers: make fuzz, or make fuzz FUZZ=mesh FUZZ_SECONDS=3600.
# Inputs found on the way stay in build/fuzz/corpus, crashes in build/fuzz/crashes; a mended crash's input goes to tests/fuzz/seeds.
FUZZ ?= pack scene mesh gltf obj ply stl 3mf assimp
FUZZ_SECONDS ?= 60
FUZZ_PARTS := $(filter-out tests/fuzz/targets/driver.c,$(wildcard tests/fuzz/targets/*.c))
FUZZERS := $(FUZZ:%=$(B)/fuzz_%)
# Bytes of an input, as FUZZ_TARGETS in tests/fuzz/targets/fuzz.h has them.
MOST_BYTES = $(shell sed -n 's/.*X($(1), \([0-9]*\)).*/\1/p' tests/fuzz/targets/fuzz.h)

# Every seed through the same functions, in make test.
$(B)/tests/fuzz/test_fuzz_corpus: $(call obj,$(FUZZ_PARTS))
$(FUZZ:%=$(B)/tests/fuzz/driver_%.o): $(B)/tests/fuzz/driver_%.o: tests/fuzz/targets/driver.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) -DFUZZ_TARGET=$* $(if $(filter pack,$*),-DFUZZ_SCRIPT) -c $< -o $@
$(FUZZERS): $(B)/fuzz_%: $(B)/tests/fuzz/driver_%.o $(call obj,$(FUZZ_PARTS)) $(BAKE_ARCHIVE) $(B)/libvitrine.a
	$(CC) $(OPT) -fsanitize=fuzzer $^ $(LIBS_COST) $(LIBS_BAKE) $(LIBS_RUNTIME) -o $@

.PHONY: fuzz build-fuzz run-fuzz $(FUZZ:%=run-fuzz-%)
fuzz: deps fuzz-deps
	@$(MAKE) $(SIDE_BY_SIDE) config=fuzz build-fuzz
	@$(MAKE) --no-print-directory config=fuzz run-fuzz
build-fuzz: $(FUZZERS)
run-fuzz: $(FUZZ:%=run-fuzz-%)
# 10 s or 2 GiB for one input is a fault too. The libraries that read meshes and scene files leak after errors: test_fuzz_corpus looks for
# leaks of ours.
$(FUZZ:%=run-fuzz-%): run-fuzz-%: $(B)/fuzz_%
	@mkdir -p $(B)/corpus/$* $(B)/crashes/$*
	ASAN_OPTIONS=detect_leaks=0:quarantine_size_mb=4 $< $(B)/corpus/$* tests/fuzz/seeds/$* -max_total_time=$(FUZZ_SECONDS) -max_len=$(call MOST_BYTES,$*) -timeout=10 -rss_limit_mb=2048 \
	  -artifact_prefix=$(B)/crashes/$*/ -print_final_stats=1
