# Lines of runtime/ and kernels/ (as C) that tests run, of which 90 % is asked; those that none runs are named in build/coverage.txt.
# These are the tests that run most of them; then every pack that they baked is played, and every view in every format, which
# test_same_bits does in many more ways.
COVERED := $(addprefix unit/test_,pack pack_forged pack_save pack_derive byte_order faults player work_kernel) \
           $(addprefix golden/test_,host effects bake_tool play_tool no_allocation budget work_counts soak) fuzz/test_fuzz_corpus \
           $(addprefix numeric/test_,framebuffers camera photons light_power clusters attributes)
# Names of a list in vitrine_frame.h, as the player's options have them.
COVERED_VIEWS = $(call NAMES_OF,VIT_VIEWS)
COVERAGE_LEAST := 90 # percent
NAMES_OF = $(shell sed -n '/define $(1)/,/[^\\]$$/s/ *X.\([A-Za-z0-9]*\),.*/\1/p' include/vitrine_frame.h | tr A-Z a-z)
# A kernel stands in the sources twice, for packets and for bundles of them, at two lines: gcovr 6 and later is told to keep the two apart, for
# earlier ones gcov tells nothing of functions (gcov_lines.sh).
GCOVR = $(if $(shell gcovr --help 2>/dev/null | grep merge-mode-functions),--merge-mode-functions=separate,--gcov-executable '$(CURDIR)/tests/gcov_lines.sh')
.PHONY: coverage coverage-deps build-coverage run-coverage play-coverage
coverage: deps coverage-deps
	@rm -f build/coverage.txt; [ ! -d build/coverage ] || find build/coverage -name '*.gcda' -delete
	@$(MAKE) $(SIDE_BY_SIDE) config=coverage build-coverage
	@$(MAKE) $(SIDE_BY_SIDE) config=coverage run-coverage
	@$(MAKE) --no-print-directory config=coverage play-coverage
	@gcovr $(GCOVR) --root . --object-directory build/coverage --filter runtime/ --filter kernels/ --txt build/coverage.txt --fail-under-line $(COVERAGE_LEAST) || { cat build/coverage.txt; exit 1; }
	@cat build/coverage.txt
build-coverage: $(COVERED:%=$(B)/tests/%) $(B)/vitrine-play $(B)/vitrine-bake $(B)/vitrine-cost $(SCENES_MADE)
run-coverage: $(COVERED:%=run/$(B)/tests/%)
play-coverage:
	@set -e; for l in 1 8; do \
	  for p in $(B)/test-packs/*.vit; do $(B)/vitrine-play $$p --verify --quiet --device host --lanes $$l; done; \
	  for v in $(COVERED_VIEWS); do for f in $(call NAMES_OF,VIT_FORMATS); do \
	    $(B)/vitrine-play $(B)/test-packs/room.vit --quiet --device host --frames 0 --view $$v --format $$f --lanes $$l; done; done; done
