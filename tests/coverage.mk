# Lines of runtime/ and kernels/ (as C) that tests run, of which 90 % is asked; those that none runs are named in build/coverage.txt.
COVERED_UNITS := pack pack_forged pack_save pack_derive byte_order faults player work_kernel
COVERED := $(filter $(COVERED_UNITS:%=$(B)/tests/unit/test_%) $(B)/tests/golden/test_host $(B)/tests/golden/test_effects \
             $(B)/tests/golden/test_tools $(B)/tests/golden/test_no_allocation $(B)/tests/fuzz/test_fuzz_corpus \
             $(foreach t,framebuffers camera photons light_power clusters attributes,$(B)/tests/numeric/test_$t),$(TEST_PROGRAMS))
.PHONY: coverage build-coverage run-coverage
coverage: deps coverage-deps
	@rm -rf build/coverage.txt && find build/coverage -name '*.gcda' -delete 2>/dev/null || true
	@$(MAKE) $(SIDE_BY_SIDE) config=coverage build-coverage
	@$(MAKE) $(SIDE_BY_SIDE) config=coverage run-coverage
	@gcovr --root . --object-directory build/coverage --filter runtime/ --filter kernels/ --txt build/coverage.txt --fail-under-line 90 || { cat build/coverage.txt; exit 1; }
	@cat build/coverage.txt
build-coverage: $(COVERED) $(B)/vitrine-play $(B)/vitrine-bake $(B)/vitrine-cost $(SCENES_MADE)
run-coverage: $(COVERED:%=run/%)
