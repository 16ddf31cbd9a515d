# One program a test file.
TEST_PROGRAMS := $(patsubst %.c,$(B)/%,$(TESTS))
BAKE_PARTS := $(filter-out bake/main.c,$(BAKE))
$(TEST_PROGRAMS): $(B)/tests/%: $(B)/tests/%.o $(call obj,$(BAKE_PARTS)) $(B)/libvitrine.a
	$(CC) $(OPT) $^ -lcmocka $(LIBS_BAKE) $(LIBS_RUNTIME) -o $@
test: deps
	@$(MAKE) --no-print-directory run-tests
run-tests: $(B)/vitrine-play $(B)/vitrine-bake $(TEST_PROGRAMS)
	@for t in $(TEST_PROGRAMS); do echo "== $$t"; $$t || exit 1; done
.PHONY: run-tests
