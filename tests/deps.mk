# What a machine needs, and what single targets need beside it; nothing happens where it is all there. Debian 12 and 13, Ubuntu 24.04.
DEPS := make gcc g++ libc6-dev $(if $(filter 0,$(OPENCL)),,ocl-icd-opencl-dev opencl-c-headers pocl-opencl-icd) libassimp-dev libembree-dev libstb-dev \
        libconfig-dev libpng-dev libjansson-dev libdraco-dev libmeshoptimizer-dev libwebp-dev libzip-dev libxml2-dev libxxhash-dev libcmocka-dev gnuplot-nox
FUZZ_DEPS := clang libclang-rt-dev
LINT_DEPS := clang clang-format clang-tidy cppcheck
COVERAGE_DEPS := gcovr
deps: packages := $(DEPS)
fuzz-deps: packages := $(FUZZ_DEPS)
lint-deps: packages := $(LINT_DEPS)
coverage-deps: packages := $(COVERAGE_DEPS)
deps fuzz-deps lint-deps coverage-deps:
	@missing=; for p in $(packages); do dpkg-query -W -f '$${db:Status-Status}' $$p 2>/dev/null | grep -qx installed || missing="$$missing $$p"; done; \
	[ -z "$$missing" ] || { echo "make $@: installing$$missing"; S=; [ "$$(id -u)" = 0 ] || S=sudo; \
	$$S env DEBIAN_FRONTEND=noninteractive sh -c "apt-get update -qq && apt-get install -y --no-install-recommends$$missing"; }
