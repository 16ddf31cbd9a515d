# Lines of runtime/ and kernels/ (as C) that tests run, of which 90 % is asked; those that none runs are named in build/coverage.txt.
# These are the tests that run most of them, and packs and views that test_same_bits plays in many more ways.
COVERED_UNITS := pack pack_forged pack_save pack_derive byte_order faults player work_kernel
COVERED_GOLDEN := host effects tools no_allocation budget work_counts soak
COVERED := $(filter $(COVERED_UNITS:%=$(B)/tests/unit/test_%) $(COVERED_GOLDEN:%=$(B)/tests/golden/test_%) $(B)/tests/fuzz/test_fuzz_corpus \
             $(foreach t,framebuffers camera photons light_power clusters attributes,$(B)/tests/numeric/test_$t),$(TEST_PROGRAMS))
NAMED := $(COVERED_UNITS) $(COVERED_GOLDEN) framebuffers camera photons light_power clusters attributes fuzz_corpus
ifneq ($(words $(NAMED)),$(words $(COVERED)))
$(error tests/coverage.mk names a test that is none: $(NAMED))
endif
VIEWS := $(shell sed -n '/define VIT_VIEWS/,/[^\\]$$/s/ *X.\([a-z]*\),.*/\1/p' include/vitrine.h)
.PHONY: coverage build-coverage run-coverage play-coverage
coverage: deps coverage-deps
	@rm -f build/coverage.txt; [ ! -d build/coverage ] || find build/coverage -name '*.gcda' -delete
	@$(MAKE) $(SIDE_BY_SIDE) config=coverage build-coverage
	@$(MAKE) $(SIDE_BY_SIDE) config=coverage run-coverage
	@$(MAKE) --no-print-directory config=coverage play-coverage
	@gcovr --root . --object-directory build/coverage --filter runtime/ --filter kernels/ --txt build/coverage.txt --fail-under-line 90 || { cat build/coverage.txt; exit 1; }
	@cat build/coverage.txt
build-coverage: $(COVERED) $(B)/vitrine-play $(B)/vitrine-bake $(B)/vitrine-cost $(SCENES_MADE)
run-coverage: $(COVERED:%=run/%)
play-coverage:
	@[ -n "$(VIEWS)" ] || { echo 'tests/coverage.mk finds no views in vitrine.h'; exit 1; }
	@set -e; for p in list buckets raw small small-sparse nearest trilinear flattened normal-keys zones zones-buckets zones-sparse areas-buckets sparse-16 room; do for l in 1 8; do \
	  $(B)/vitrine-play $(B)/test-packs/$$p.vit --verify --quiet --device host --lanes $$l; done; done; \
	for v in $(VIEWS); do for f in xrgb8888 rgb565 rgba32f; do for l in 1 8; do \
	  $(B)/vitrine-play $(B)/test-packs/room.vit --quiet --device host --frames 0 --view $$v --format $$f --lanes $$l; done; done; done
