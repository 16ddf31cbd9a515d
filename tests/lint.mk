# clang-tidy (.clang-tidy says which checks and why not others) and cppcheck over our sources; any finding is an error. A file at a time
# has its stamp in build/lint, so that a second run looks at what has changed. stb is not ours. Layout: tests/format.sh; the kernels' divisions:
# tests/float_divisions.sh.
LINTED := $(filter-out bake/import/stb_image.c bake/radiosity/stb_dxt.c,$(RUNTIME) $(PLAY) $(BAKE) $(SCENES))
LINT_FLAGS := $(filter -D% -I%,$(BASE)) -Ibake -Iruntime -I$(B) -DVIT_EMBREE=$(EMBREE) -isystem /usr/include/libxml2
LINT_STAMPS := $(LINTED:%.c=build/lint/%.ok)
# Not found by cppcheck: that a setting's list takes over a block through memcpy(), that a status guards a structure, that an error's
# text is written before it is read, that a file's bytes mean that it is open. It takes pow() in a list of initialisers for a call without
# a use, and %d of a bit for a fault; Debian 13's says of each long function that it did not try all branches.
CPPCHECK := -D__BYTE_ORDER__=1234 -D__ORDER_BIG_ENDIAN__=4321 --enable=warning,performance,portability --std=c11 --quiet --error-exitcode=1 --suppress=memleak:bake/scene/scene.c \
            --suppress=uninitStructMember:bake/pack/bounds.c --suppress=ignoredReturnValue:bake/report/report_axes.c \
            --suppress=ctuuninitvar --suppress=invalidPrintfArgType_sint:runtime/device_opencl.c \
            --suppress=duplicateAssignExpression --suppress=nullPointerOutOfResources:bake/import/import_texture.c \
            --suppress=nullPointerOutOfMemory:bake/zones/zones.c --suppress=normalCheckLevelMaxBranches

.PHONY: lint run-lint run-cppcheck run-float-divisions run-format
lint: deps lint-deps
	@$(MAKE) $(SIDE_BY_SIDE) run-lint
run-lint: run-format run-cppcheck run-float-divisions $(LINT_STAMPS)
	@echo "lint: $(words $(LINTED)) files are clean"
run-format:
	@tests/format.sh --check
run-cppcheck:
	@cppcheck $(CPPCHECK) $(LINT_FLAGS) $(LINTED)
run-float-divisions:
	@sh tests/float_divisions.sh $(addprefix kernels/,$(KERNELS))
build/lint/runtime/host/programs.ok: $(B)/host_programs.h
build/lint/%.ok: %.c .clang-tidy
	@mkdir -p $(@D)
	@clang-tidy --quiet $< -- -std=c11 $(LINT_FLAGS) 2>/dev/null
	@touch $@
$(LINT_STAMPS): $(wildcard include/*.h kernels/*.clh runtime/*.h runtime/play/*.h bake/*.h bake/*/*.h bake/*/*/*.h)
