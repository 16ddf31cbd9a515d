# Vitrine. `make demo` and `make test` do everything on a fresh machine; `make help` lists the rest.
#   config=release|debug|sanitize|fuzz|coverage   (default release; each builds into build/$(config))
#   OPENCL=0                        without OpenCL: the built-in device `host` alone
config ?= release
OPENCL ?= 1
B := build/$(config)$(if $(filter 0,$(OPENCL)),-no-opencl)
CC ?= cc
CXX ?= c++
prefix ?= /usr/local

WARN := -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wstrict-prototypes -Werror
# Same bits on every host too: no contraction, no reassociation, and no vectors that the compiler joins of scalars by itself, of which GCC 12.2
# makes other bits in bake/geometry/glass_inset.c (kernels as C: HOST_FLAGS).
BASE := -std=c11 -D_POSIX_C_SOURCE=200809L -D_FILE_OFFSET_BITS=64 -DCL_TARGET_OPENCL_VERSION=120 -DVIT_OPENCL=$(OPENCL) -pthread -ffp-contract=off -fno-tree-slp-vectorize -MMD -MP -Iinclude
ifeq ($(config),release)
OPT := -O2 -g1
else ifeq ($(config),debug)
OPT := -O0 -g
else ifeq ($(config),sanitize)
OPT := -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer
else ifeq ($(config),fuzz)
CC := clang
CXX := clang++
OPT := -O1 -g1 -fsanitize=address,undefined,fuzzer-no-link -fno-sanitize-recover=undefined -fno-omit-frame-pointer
else ifeq ($(config),coverage)
OPT := -O1 -g1 --coverage
else
$(error config must be release, debug, sanitize, fuzz or coverage, got '$(config)')
endif
MACHINE := $(shell $(CC) -dumpmachine)
# There GCC, asked for C11, makes doubles of floats, because the C library's float_t is one; asked for speed, it does not.
BASE += $(if $(filter s390x-%,$(MACHINE)),-fexcess-precision=fast)
CFLAGS_ALL := $(BASE) $(WARN) $(OPT) $(CFLAGS)

# The kernels in the order in which they are joined into one program.
KERNELS := ../include/vitrine_frame.h records.clh cache_cell.clh counters.clh transfer_code.clh strict.clh lanes.clh work.clh random.clh scene.clh texture.clh ray.clh bundle.clh surface.clh specular.clh cells.clh receivers.cl visibility.cl bundle_visibility.cl \
           chains.cl samples.cl direct.cl bundle_direct.cl radiosity.cl skylight.cl cache.clh cache.cl photons.cl clusters.cl hierarchy.cl splat.cl estimate.cl indirect.cl sparse.cl film.cl gloss.cl resolve.cl transfer_product.clh transfer_product.cl

RUNTIME := $(filter-out $(if $(filter 0,$(OPENCL)),runtime/device_opencl.c),$(wildcard runtime/*.c)) runtime/host/pool.c runtime/host/programs.c
PLAY := $(wildcard runtime/play/*.c runtime/play/sinks/*.c)
BAKE := $(filter-out bake/scenes/%,$(wildcard bake/*.c bake/*/*.c bake/*/*/*.c))
SCENES := $(wildcard bake/scenes/*.c)
TESTS := $(wildcard tests/unit/*.c tests/golden/*.c tests/numeric/*.c tests/fuzz/*.c)
BENCH := $(wildcard tests/bench/*.c)

# libdraco speaks C++ alone.
BAKE_CXX := $(wildcard bake/*/*/*.cc)

obj = $(patsubst %.c,$(B)/%.o,$(1))
# All of vitrine-bake and vitrine-cost but their mains.
BAKE_PARTS := $(filter-out bake/main.c bake/cost/main.c,$(BAKE))
BAKE_OBJECTS := $(call obj,$(BAKE_PARTS)) $(BAKE_CXX:%.cc=$(B)/%.o) $(B)/report_files.o
# As an archive: a program is linked with those that it calls alone, which takes a fifth of the time.
BAKE_ARCHIVE := $(B)/libbake.a
# Libraries. Embree 3 or 4, whichever is installed.
EMBREE := $(shell for v in 4 3; do [ -e /usr/include/embree$$v/rtcore.h ] && { echo $$v; break; }; done)
LIBS_RUNTIME := $(if $(filter 0,$(OPENCL)),,-lOpenCL) -lpthread -lm
LIBS_PLAY := -lpng $(LIBS_RUNTIME)
# Open MPI, if it is installed, spreads references over machines (bake/reference/spread.h).
LIBS_COST := $(shell mpicc --showme:link 2>/dev/null)
LIBS_BAKE := -lembree$(EMBREE) -lassimp -ljansson -ldraco -lmeshoptimizer -lwebp -lzip -lxml2 -lconfig -lpng -lstdc++ -lpthread -lm

# The device `host`: runtime/host/kernels.c once for each instruction set, best first, and each number of lanes.
HOST_LANES := 1 8 16
HOST_ISAS := $(if $(filter x86_64-%,$(MACHINE)),avx512 avx2) baseline
# Vectors that the compiler joins of scalars by itself make it 2.8 times as quick, but GCC 14.2's are wrong with AVX-512 (the pass chains with
# glass, test_same_bits), and of GCC only 12's have been seen right: others do without there.
HOST_GCC := $(if $(shell $(CC) --version 2>/dev/null | grep 'Free Software Foundation'),$(shell $(CC) -dumpversion | cut -d. -f1))
HOST_FLAGS_baseline := -ftree-slp-vectorize
HOST_FLAGS_avx2 := -mavx2 -mfma -ftree-slp-vectorize
HOST_FLAGS_avx512 := $(if $(filter-out 12,$(HOST_GCC)),,-ftree-slp-vectorize) -mavx512f -mavx512dq -mavx512bw -mavx512vl -mfma -mprefer-vector-width=512
ifneq ($(filter sanitize fuzz coverage,$(config)),)
HOST_LANES := 1 $(if $(filter fuzz,$(config)),,8)
HOST_ISAS := baseline
endif
HOST_PROGRAMS := $(foreach i,$(HOST_ISAS),$(foreach l,$(HOST_LANES),$(i)_$(l)))
# What people play with is optimised; the other widths are there to be compared, and compile for half a minute each if they are. GCC by itself stops
# inlining after the first few kernels; calls then cost a third of the time, since no vector register survives them.
HOST_FAST := %_1 avx512_8 avx512_16 avx2_8 $(if $(filter x86_64-%,$(MACHINE)),,%)
HOST_OPT := -O3 $(if $(HOST_GCC),--param inline-unit-growth=400 --param large-function-growth=1000 --param large-stack-frame-growth=10000)
# Kernels are written for OpenCL C: their types and warnings are other ones. No option here changes a bit of a result: errno and traps
# are not looked at, and records are read as other types.
HOST_CFLAGS := $(BASE) -Wall -Wextra -Werror -Wno-unknown-pragmas -Wno-sign-compare -Wno-unused-parameter -Wno-psabi -fno-math-errno \
               -fno-trapping-math -fno-strict-aliasing $(if $(filter release,$(config)),-g1,$(OPT)) $(if $(filter sanitize,$(config)),-fsanitize=float-cast-overflow -fno-sanitize-recover=float-cast-overflow) -I. -I$(B) $(CFLAGS)
HOST_OBJECTS := $(HOST_PROGRAMS:%=$(B)/host_%.o)

.DELETE_ON_ERROR:
.PHONY: all tools help deps fuzz-deps lint-deps demo run-demo cost run-cost test soak bench clean install format readme
all: deps
	@$(MAKE) $(SIDE_BY_SIDE) tools
tools: $(B)/vitrine-play $(B)/vitrine-bake $(B)/vitrine-cost

include tests/deps.mk

$(B)/kernel_sources.c: $(addprefix kernels/,$(KERNELS)) Makefile
	@mkdir -p $(@D)
	@set -e; { echo '/* Made from kernels/ by the Makefile. */'; echo '#include "kernel_sources.h"'; \
	   echo 'const char *const vit_kernel_sources[] = {'; \
	   for f in $(KERNELS); do printf '"#line 1 \\"%s\\"\\n"\n' $$f; sed -e 's/\\/\\\\/g' -e 's/"/\\"/g' -e 's/^/"/' -e 's/$$/\\n"/' kernels/$$f; echo ','; done; \
	   echo '};'; echo 'const unsigned vit_kernel_source_count = sizeof vit_kernel_sources / sizeof vit_kernel_sources[0];'; } > $@

$(B)/kernel_list.h: Makefile
	@mkdir -p $(@D)
	@for f in $(filter-out %.h records.clh cache_cell.clh counters.clh transfer_code.clh,$(KERNELS)); do echo "#include \"kernels/$$f\""; done > $@
$(B)/host_programs.h: Makefile
	@mkdir -p $(@D)
	@for p in $(HOST_PROGRAMS); do echo "PROGRAM($${p%_*}, $${p##*_})"; done > $@
$(HOST_OBJECTS): $(B)/host_%.o: runtime/host/kernels.c $(B)/kernel_list.h
	$(CC) $(if $(filter release,$(config)),$(if $(filter $(HOST_FAST),$*),$(HOST_OPT),-O1)) $(HOST_CFLAGS) $(HOST_FLAGS_$(firstword $(subst _, ,$*))) -DVIT_LANES=$(lastword $(subst _, ,$*)) \
	   -DHOST_ISA='"$(firstword $(subst _, ,$*))"' -DHOST_PROGRAM=vit_host_$* -c $< -o $@
$(B)/runtime/host/programs.o: CFLAGS_ALL += -I$(B)
$(B)/runtime/host/programs.o: $(B)/host_programs.h

# The report's style sheet and script as C strings.
$(B)/report_files.c: bake/report/report.css bake/report/report.js Makefile
	@mkdir -p $(@D)
	@set -e; { echo '/* Made from bake/report/ by the Makefile. */'; \
	   for f in css js; do echo "extern const char report_$$f[];"; echo "const char report_$$f[] ="; \
	     sed -e 's/\\/\\\\/g' -e 's/"/\\"/g' -e 's/^/"/' -e 's/$$/\\n"/' bake/report/report.$$f; echo ';'; done; } > $@

$(B)/report_files.o: CFLAGS_ALL += -Wno-overlength-strings
$(B)/report_files.o: $(B)/report_files.c
	$(CC) $(CFLAGS_ALL) -c $< -o $@
$(B)/kernel_sources.o: CFLAGS_ALL += -Iruntime -Wno-overlength-strings
$(B)/bake/%.o: CFLAGS_ALL += -Ibake -DVIT_EMBREE=$(EMBREE)
$(B)/bake/import/3mf/threemf_xml.o: CFLAGS_ALL += -isystem /usr/include/libxml2
ifneq ($(LIBS_COST),)
$(B)/bake/reference/spread.o: CFLAGS_ALL += -DVIT_MPI=1 $(patsubst -I%,-isystem %,$(shell mpicc --showme:compile))
endif
$(B)/tests/%.o: CFLAGS_ALL += -Ibake -Iruntime -Itests -DVIT_EMBREE=$(EMBREE) -DVIT_BUILD_DIR='"$(B)"'
$(B)/kernel_sources.o: $(B)/kernel_sources.c
	$(CC) $(CFLAGS_ALL) -c $< -o $@
$(B)/%.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) -c $< -o $@
$(B)/%.o: %.cc
	@mkdir -p $(@D)
	$(CXX) -std=c++17 -Wall -Wextra -Werror -ffp-contract=off -MMD -MP -Ibake $(OPT) -fno-sanitize=vptr $(CXXFLAGS) -c $< -o $@

$(BAKE_ARCHIVE): $(BAKE_OBJECTS)
$(B)/libvitrine.a: $(call obj,$(RUNTIME)) $(HOST_OBJECTS) $(if $(filter 0,$(OPENCL)),,$(B)/kernel_sources.o)
$(BAKE_ARCHIVE) $(B)/libvitrine.a:
	@rm -f $@
	$(AR) rcs $@ $^
$(B)/vitrine-play: $(call obj,$(PLAY)) $(B)/libvitrine.a
	$(CC) $(OPT) $^ $(LIBS_PLAY) -o $@
$(B)/vitrine-bake: $(call obj,bake/main.c) $(BAKE_ARCHIVE) $(B)/libvitrine.a
	$(CC) $(OPT) $^ $(LIBS_COST) $(LIBS_BAKE) $(LIBS_RUNTIME) -o $@
$(B)/vitrine-cost: $(call obj,bake/cost/main.c) $(BAKE_ARCHIVE) $(B)/libvitrine.a
	$(CC) $(OPT) $^ $(LIBS_COST) $(LIBS_BAKE) $(LIBS_RUNTIME) -o $@
$(B)/make-scenes: $(call obj,$(SCENES))
	$(CC) $(OPT) $^ -lpng -lm -o $@

include tests/test.mk
include tests/fuzz.mk
include tests/lint.mk
include tests/coverage.mk
include tests/smoke.mk

# Bakes our scenes, plays them, verifies every hash, writes pictures.
demo: deps
	@$(MAKE) $(SIDE_BY_SIDE) $(B)/vitrine-play $(B)/vitrine-bake $(SCENES_MADE)
	@$(MAKE) --no-print-directory run-demo
run-demo: $(B)/vitrine-play $(B)/vitrine-bake $(SCENES_MADE)
	@mkdir -p build/demo
	@set -e; for s in cornell atrium; do \
	  echo "== $$s"; \
	  $(B)/vitrine-bake $(B)/scenes/$$s.cfg -o build/demo/$$s.vit; \
	  $(B)/vitrine-play build/demo/$$s.vit --verify --report --out png:build/demo/$$s; \
	done
	@echo "pictures: build/demo/cornell/*.png build/demo/atrium/*.png   packs: build/demo/*.vit"

# What accuracy costs, for our scenes: reports in build/cost.
cost: deps
	@$(MAKE) --no-print-directory run-cost
run-cost: $(B)/vitrine-cost $(SCENES_MADE)
	@mkdir -p build/cost
	@set -e; for s in cornell atrium; do \
	  echo "== $$s"; \
	  $(B)/vitrine-cost $(B)/scenes/$$s.cfg -o build/cost/$$s; \
	done
	@echo "reports: build/cost/cornell/index.html build/cost/atrium/index.html"

# How a user's program is compiled and linked.
$(B)/vitrine.pc: Makefile
	@mkdir -p $(@D)
	@printf '%s\n' 'prefix=$(prefix)' 'libdir=$${prefix}/lib' 'includedir=$${prefix}/include' '' 'Name: vitrine' \
	   'Description: plays baked 3D scenes with the same bits on every device' \
	   'Version: $(shell sed -n 's/.*VIT_VERSION "\(.*\)"/\1/p' include/vitrine.h)' 'Cflags: -I$${includedir}' 'Libs: -L$${libdir} -lvitrine $(LIBS_RUNTIME)' > $@

# The library, its headers and the tools under $(prefix).
install: all
	@rm -f $(B)/vitrine.pc
	@$(MAKE) --no-print-directory $(B)/vitrine.pc
	install -d $(DESTDIR)$(prefix)/bin $(DESTDIR)$(prefix)/lib/pkgconfig $(DESTDIR)$(prefix)/include
	install -m 644 $(B)/vitrine.pc $(DESTDIR)$(prefix)/lib/pkgconfig
	install -m 755 $(B)/vitrine-play $(B)/vitrine-bake $(B)/vitrine-cost $(DESTDIR)$(prefix)/bin
	install -m 644 $(B)/libvitrine.a $(DESTDIR)$(prefix)/lib
	install -m 644 include/vitrine.h include/vitrine_frame.h $(DESTDIR)$(prefix)/include

help:
	@echo "make demo     install what is missing, build, bake our scenes, play and verify them, pictures in build/demo"
	@echo "make cost     what accuracy costs in time, for our scenes; reports in build/cost"
	@echo "make test     all tests"
	@echo "make fuzz     bad packs, scenes and meshes under sanitizers (clang): FUZZ_SECONDS=$(FUZZ_SECONDS) each of FUZZ=\"$(FUZZ)\""
	@echo "make soak     plays a small pack for SOAK_FRAMES=$(SOAK_FRAMES) frames: same bits, same memory"
	@echo "make matrix   same bits: OpenCL devices, threads, lanes, instruction sets, other machines under qemu; one line a row"
	@echo "make numeric  hard cases: the worst error of each against its bound, one table; CSV and plots in build/numeric"
	@echo "make lint     clang-tidy and cppcheck over our sources"
	@echo "make coverage lines of runtime/ and kernels/ that tests run: build/coverage.txt"
	@echo "make bench    speed: rays against Embree, milliseconds a pass; CSV in build/bench"
	@echo "make smoke    short forms of bench, matrix, numeric, soak, lint, coverage, fuzz and of the build without OpenCL, for continuous integration"
	@echo "make install  prefix=$(prefix)"
	@echo "make deps | all | clean | format | readme     config=release|debug|sanitize|fuzz|coverage"

clean:
	rm -rf build
format:
	tests/format.sh
# Tables in READMEs that are made from the code.
readme: $(B)/vitrine-bake
	$(B)/vitrine-bake --settings > $(B)/settings_table
	sed -i -e '/^<!-- settings/,/^<!-- end of settings/{//!d}' -e '/^<!-- settings/r $(B)/settings_table' bake/README.md

-include $(shell find $(B) -name '*.d' -type f 2>/dev/null)
