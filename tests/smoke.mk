# Short forms of all that `make test` does not run, to their ends and with all that they check, so that none of it rots: .ci/run. They time
# nothing. Each is the very target, with less to do.
SMOKE_BENCHES := $(patsubst tests/bench/bench_%.c,smoke-bench/%,$(wildcard tests/bench/bench_*.c))
# With and without OpenCL; a file of each folder; a reader, the frame and the player of a pack; and each fuzzer for a few seconds.
SMOKE_NUMERIC := grazing depth_slices
SMOKE_NO_OPENCL := config=debug HOST_ISAS=baseline HOST_LANES=8
SMOKE_LINTED := runtime/frame.c runtime/play/pacing.c bake/pack/pack_write.c bake/cost/pareto.c
SMOKE_COVERED := unit/test_pack golden/test_no_allocation
SMOKE_SECONDS := 5
SMOKES := $(addprefix smoke-,fuzz coverage bench matrix lint numeric no-opencl soak)
.PHONY: smoke build-benches build-smoke $(SMOKES) $(SMOKE_BENCHES)
# What they need is there first, so that none of them installs or builds what another does; then they run side by side.
smoke:
	@for d in deps fuzz-deps lint-deps coverage-deps; do $(MAKE) --no-print-directory $$d || exit 1; done
	@$(MAKE) $(SIDE_BY_SIDE) build-smoke
	@$(MAKE) $(SIDE_BY_SIDE) $(SMOKES)
	@echo "smoke: $(SMOKES:smoke-%=%) ran to their ends"

smoke-bench: deps
	@$(MAKE) $(SIDE_BY_SIDE) build-benches
	@VITRINE_BENCH=smoke $(MAKE) $(SIDE_BY_SIDE) $(SMOKE_BENCHES)
build-smoke: build-benches $(SMOKE_NUMERIC:%=$(B)/tests/numeric/test_%) $(B)/tests/golden/test_soak
build-benches: $(SMOKE_BENCHES:smoke-bench/%=$(B)/tests/bench/bench_%) $(B)/vitrine-play $(B)/vitrine-bake $(SCENES_MADE)
$(SMOKE_BENCHES): smoke-bench/%: $(B)/tests/bench/bench_%
	@tests/run.sh $@ $<
smoke-matrix:
	@VITRINE_MATRIX=smoke $(MAKE) --no-print-directory matrix
smoke-numeric:
	@$(MAKE) --no-print-directory numeric NUMERIC="$(SMOKE_NUMERIC)"
smoke-soak:
	@$(MAKE) --no-print-directory soak SOAK_FRAMES=64
# It must ask for no package of OpenCL's, and play what the other has baked.
smoke-no-opencl: $(B)/vitrine-bake $(SCENES_MADE)
	@! $(MAKE) --no-print-directory -n deps OPENCL=0 | grep -iE 'opencl|pocl'
	@$(MAKE) $(SIDE_BY_SIDE) OPENCL=0 $(SMOKE_NO_OPENCL) tools
	@$(B)/vitrine-bake $(B)/scenes/cornell.cfg -o $(B)/smoke.vit --quiet --no-check --size 64x48 --frames 2 --indirect photons --photons 2000
	@build/debug-no-opencl/vitrine-play $(B)/smoke.vit --verify
	@build/debug-no-opencl/vitrine-bake $(B)/scenes/cornell.cfg -o build/debug-no-opencl/smoke.vit --quiet --no-check --size 64x48 --frames 2 --indirect photons --photons 2000
	@cmp $(B)/smoke.vit build/debug-no-opencl/smoke.vit
smoke-lint:
	@$(MAKE) --no-print-directory lint LINTED="$(SMOKE_LINTED)"
smoke-coverage:
	@$(MAKE) --no-print-directory coverage COVERED="$(SMOKE_COVERED)" COVERED_VIEWS="final depth" COVERAGE_LEAST=1
smoke-fuzz:
	@$(MAKE) --no-print-directory fuzz FUZZ_SECONDS=$(SMOKE_SECONDS)
