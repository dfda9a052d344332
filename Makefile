# deaspice: build, test and install. Settings first; override them on the command line: make CC=clang PREFIX=/opt/deaspice
CC      ?= cc
CFLAGS  ?= -O2 -g
PREFIX  ?= /usr/local
BUILD   ?= build
DESTDIR ?=

VERSION  := 0.1.0
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wconversion
PKG_CONFIG ?= pkg-config
ALL_CFLAGS  = -std=c11 -D_POSIX_C_SOURCE=200809L -D_DEFAULT_SOURCE $(WARNINGS) -ffp-contract=off -fvisibility=hidden -fPIC -Iinclude -Isrc \
              -DDEA_VERSION='"$(VERSION)"' -MMD -MP $(HEADERS) \
              $(LOADED) $(CPPFLAGS) $(CFLAGS)

# $(call once,NAME,COMMAND): the output of a shell command that runs when it is first needed, and not again.
once = $(eval $(1) := $$(shell $(2)))$($(1))
HEADERS = $(call once,HEADERS,$(PKG_CONFIG) --cflags-only-I libfyaml ngspice lapacke $(MPI) 2>/dev/null)
# Version of SUNDIALS, and whether its headers need those of the MPI that it was built with, by those that are compiled against.
SUNDIALS_VERSION = $(call once,SUNDIALS_VERSION,printf '\043include <sundials/sundials_config.h>\nSUNDIALS_VERSION_MAJOR SUNDIALS_MPI_ENABLED\n' | \
                   $(CC) $(CPPFLAGS) $(CFLAGS) -E -P - 2>/dev/null | tail -n 1)
SUNDIALS_OLD = $(filter 4 5 6,$(firstword $(SUNDIALS_VERSION)))
SUNDIALS_CORE = $(if $(SUNDIALS_OLD),-lsundials_generic,-lsundials_core)
SUNDIALS_LIBS = -lsundials_ida -lsundials_arkode -lsundials_kinsol -lsundials_nvecserial -lsundials_sunmatrixdense -lsundials_sunlinsoldense \
                $(SUNDIALS_CORE)
MPI = $(if $(SUNDIALS_OLD)$(filter 0,$(lastword $(SUNDIALS_VERSION))),,$(call once,MPI,for name in ompi-c ompi mpich mpi-c mpi; do \
      $(PKG_CONFIG) --exists $$$$name 2>/dev/null && echo $$$$name && break; done))
# SUNDIALS and LAPACKE are loaded when an engine needs them, by the names that the linker would have noted: of their ABI, not
# of their development files. Where only static ones are there, they are linked in.
SONAMES = $(call once,SONAMES,probe=$$$$(mktemp) && printf 'int main(void) { return 0; }' | \
          $(CC) $(CFLAGS) -x c - -o $$$$probe $(LDFLAGS) -Wl$$(comma)--no-as-needed -llapacke $(SUNDIALS_LIBS) 2>/dev/null && \
          readelf -d $$$$probe | sed -n 's/.*(NEEDED).*\[\(lib\(lapacke\|sundials\)[^]]*\)\].*/\1/p'; rm -f $$$$probe)
comma := ,
empty :=
SUNDIALS_NAMES = $(filter libsundials%,$(SONAMES))
LAPACKE_NAME   = $(filter liblapacke%,$(SONAMES))
LOADED = $(if $(LAPACKE_NAME),-DDEA_LAPACKE='"$(LAPACKE_NAME)"') \
         $(if $(SUNDIALS_NAMES),-DDEA_SUNDIALS='$(subst $(empty) ,$(comma),$(SUNDIALS_NAMES:%="%"))')
LIBS = -lngspice -lfyaml -ludunits2 $(if $(LAPACKE_NAME),,-llapacke) \
       $(if $(SUNDIALS_NAMES),,$(SUNDIALS_LIBS) $(if $(MPI),$(shell $(PKG_CONFIG) --libs $(MPI)))) -ldl -lm

LIBRARY_SOURCES := $(filter-out src/program/%,$(sort $(wildcard src/*/*.c src/*/*/*.c)))
PROGRAM_SOURCES := $(sort $(wildcard src/program/*.c))
LIBRARY_OBJECTS := $(LIBRARY_SOURCES:%.c=$(BUILD)/%.o)
PROGRAM_OBJECTS := $(PROGRAM_SOURCES:%.c=$(BUILD)/%.o)
UNIT_SOURCES    := $(sort $(wildcard tests/unit/test_*.c))
UNIT_PROGRAMS   := $(UNIT_SOURCES:tests/unit/%.c=$(BUILD)/tests/%)
STABILITY_SOURCES := $(filter-out %/main.c,$(sort $(wildcard tests/stability/*.c))) tests/bench/measure.c tests/bench/reference.c
STABILITY_PARTS := $(STABILITY_SOURCES:%.c=$(BUILD)/%.o)

CLANG    := $(shell command -v clang 2>/dev/null)
JOBS     ?= $(shell nproc 2>/dev/null || echo 1)
# What make check runs, the longest first.
STAGES   := compilers-agree fuzz examples-agree test asan layers
# Alignment is left out: to ask at each load takes a quarter of the time, and casts go to fields of their own type alone.
SANITIZE := -O1 -g1 -fsanitize=address,undefined -fno-sanitize=alignment -fno-sanitize-recover=undefined -fno-omit-frame-pointer

.DELETE_ON_ERROR:
.PHONY: all unit demo check $(STAGES) $(STAGES:%=%-stage) clang clang-stage checked bench work-precision stability promises hard netlists install uninstall clean packages packages-check

all: $(BUILD)/deaspice $(BUILD)/libdeaspice.so

packages:
	@sh .ci/packages build
packages-check:
	@sh .ci/packages check

# The main job on real input: the coverage sweep of the paper's Figure 10, as a table and as a picture.
demo: packages
	@echo "building the program"
	@$(MAKE) --no-print-directory -j$(JOBS) $(BUILD)/deaspice >/dev/null
	@mkdir -p demo
	@$(BUILD)/deaspice run examples/figure10.yaml -o demo/figure10.csv --plot demo/figure10.svg 2>demo/log || { cat demo/log; exit 1; }
	@$(BUILD)/deaspice check examples/figure10.yaml >demo/check || { cat demo/check; exit 3; }
	@grep -e ': largest strain' -e ' points in ' demo/log
	@awk '$$NF == "agrees" {n++; for (i = 4; i < NF - 1; i++) if ($$i + 0 > worst) worst = $$i + 0} \
	END {printf "engines direct, ngspice and ida agree in %d comparisons, the largest relative difference is %.1e\n", n, worst; exit n == 0}' demo/check
	@echo "the table is demo/figure10.csv, the picture demo/figure10.svg; next: $(BUILD)/deaspice run examples/protocol.yaml --plot demo/protocol.svg"

# Everything that must hold: unit tests, engines against each other, examples, bad input, sanitizers, fuzzing, a second compiler.
# All stages share the jobs of one make, so that no core waits for the last test of a stage.
check: packages-check
	@rm -f $(BUILD)/tally; mkdir -p $(BUILD)
	@TALLY=$(abspath $(BUILD))/tally $(MAKE) --no-print-directory -k -j$(JOBS) $(STAGES:%=%-stage); \
	status=$$?; \
	awk -v status=$$status '{p += $$1; f += $$2} END {if (status && !f) f = 1; printf "%d passed, %d failed\n", p, f}' $(BUILD)/tally; \
	exit $$status

# One stage by itself.
$(STAGES) clang: %:
	@$(MAKE) --no-print-directory -k -j$(JOBS) $*-stage

# $(call counted,COMMAND): one test of the tally.
counted = $(1) && echo "1 0" >>$${TALLY:-/dev/null} || { echo "0 1" >>$${TALLY:-/dev/null}; exit 1; }

STAGE := test
UNIT_RUNS := $(UNIT_PROGRAMS:%=%-run)
.PHONY: $(UNIT_RUNS)
test-stage: $(UNIT_RUNS)
$(UNIT_RUNS): %-run: % all
	@DEASPICE=$(abspath $(BUILD))/deaspice tests/run $(STAGE) $<

examples-agree-stage: all
	@$(call counted,$(BUILD)/deaspice check --quiet examples/*.yaml)

# The warnings of a second compiler, its program, and its library for the fuzzers. Tests are compiled and not linked: nothing runs them.
CHECKED := $(patsubst %.c,$(BUILD)/%.checked,$(sort $(UNIT_SOURCES) $(wildcard tests/promises/*.c tests/stability/*.c tests/bench/*.c tests/hard/*.c)))
clang-stage:
	+@$(MAKE) --no-print-directory BUILD=$(BUILD)/clang CC=clang CFLAGS="-O1 -Werror" all checked
checked: $(CHECKED)
$(BUILD)/%.checked: %.c Makefile
	@mkdir -p $(@D)
	@echo "CHECK $<"
	@$(CC) $(ALL_CFLAGS) -Itests/bench -MF $(@:.checked=.d) -MT $@ -fsyntax-only $<
	@touch $@

# The examples by both compilers.
compilers-agree-stage: all $(BUILD)/stability clang-stage
	@$(call counted,{ $(BUILD)/stability --compilers examples gcc=$(BUILD)/deaspice clang=$(BUILD)/clang/deaspice >$(BUILD)/compilers \
	|| { cat $(BUILD)/compilers; false; }; })

# The truths that tests compute for themselves, half of the time of some, run without sanitizers: they share no code with the library.
ASAN := detect_leaks=1:quarantine_size_mb=64:malloc_context_size=8:max_malloc_fill_size=256
asan-stage:
	+@ASAN_OPTIONS=$(ASAN) UBSAN_OPTIONS=print_stacktrace=1 LSAN_OPTIONS=suppressions=$(abspath tests/leaks.supp):print_suppressions=0 \
	$(MAKE) --no-print-directory BUILD=$(BUILD)/asan CFLAGS="$(SANITIZE)" TRUTH_FLAGS="-O2 -fno-sanitize=all" STAGE=asan test-stage

# libFuzzer on the readers of scenes and of tables, side by side; FUZZ_SECONDS=n for longer. What reads a scene is instrumented; what
# else the tables of kinds bring in comes from clang's library.
FUZZ_SECONDS ?= 30
FUZZERS := scene table
FUZZ = clang $(filter-out -MMD -MP,$(ALL_CFLAGS)) -O1 -g1 -fsanitize=fuzzer,address,undefined
FUZZ_RUNS := $(FUZZERS:%=fuzz-%)
.PHONY: $(FUZZ_RUNS)
fuzz-stage: $(FUZZ_RUNS)
$(FUZZ_RUNS): fuzz-%: $(BUILD)/fuzz/%_fuzz
	@mkdir -p $(BUILD)/fuzz/$*
	@$(call counted,{ UDUNITS2_XML_PATH=/nonexistent $< -max_total_time=$(FUZZ_SECONDS) -timeout=10 -rss_limit_mb=2048 -verbosity=0 \
	-print_final_stats=1 -artifact_prefix=$(BUILD)/fuzz/ $(BUILD)/fuzz/$* $(FUZZ_SEEDS_$*) >$(BUILD)/fuzz/$*.log 2>&1 \
	&& grep -h executed $(BUILD)/fuzz/$*.log || { tail -n 40 $(BUILD)/fuzz/$*.log; false; }; })

FUZZ_SEEDS_scene := tests/bad examples
FUZZ_FOLDERS := scene support material drive study film load
$(BUILD)/fuzz/scene_fuzz: tests/fuzz/scene_fuzz.c $(sort $(wildcard $(FUZZ_FOLDERS:%=src/%/*.c))) | clang-stage
	@mkdir -p $(@D)
	@echo "CC $@"
	@$(FUZZ) -DDEA_AXIS_VALUES_MAX=100000 $^ $(BUILD)/clang/libdeaspice.a -o $@ $(LIBS)

FUZZ_SEEDS_table := tests/fuzz/tables examples/data
$(BUILD)/fuzz/table_fuzz: tests/fuzz/table_fuzz.c $(sort $(wildcard src/support/*.c))
	@mkdir -p $(@D)
	@echo "CC $@"
	@$(FUZZ) $^ -o $@ $(LIBS)

# Speed and error side by side, against the goals and against other programs where they are installed, then the diagrams of README and tests/README.
# Takes about ten minutes.
bench:
	@$(MAKE) --no-print-directory -j$(JOBS) all $(BUILD)/bench
	@$(BUILD)/bench $(BUILD)/deaspice tests/peers examples
	@$(MAKE) --no-print-directory work-precision

work-precision:
	@$(MAKE) --no-print-directory -j$(JOBS) all
	@$(BUILD)/deaspice bench examples/figure10.yaml --model lumped,coverage,lame,field --budget 90 --plot examples/work-precision-static.svg
	@$(BUILD)/deaspice bench examples/work-precision.yaml --model lumped,coverage --budget 90 --plot examples/work-precision-transient.svg

$(BUILD)/bench: $(wildcard tests/bench/*.[ch]) $(BUILD)/libdeaspice.a
	@echo "CC $@"
	@$(CC) $(filter-out -MMD -MP,$(ALL_CFLAGS)) -Itests/bench $(filter %.c,$^) $(BUILD)/libdeaspice.a -o $@ $(LDFLAGS) -lcmocka $(LIBS)

# Orders, conditioning, freedom of units, other compilers and flags, as Markdown. Takes 3 minutes after the builds.
stability:
	@{ $(MAKE) --no-print-directory -j$(JOBS) all $(BUILD)/stability; \
	$(MAKE) --no-print-directory -j$(JOBS) BUILD=$(BUILD)/o0 CFLAGS=-O0 $(BUILD)/o0/deaspice; \
	$(MAKE) --no-print-directory -j$(JOBS) BUILD=$(BUILD)/o3 CFLAGS=-O3 $(BUILD)/o3/deaspice; \
	$(MAKE) --no-print-directory -j$(JOBS) BUILD=$(BUILD)/fma CFLAGS="-O2 -march=native -ffp-contract=fast" $(BUILD)/fma/deaspice; \
	$(if $(CLANG),$(MAKE) --no-print-directory -j$(JOBS) BUILD=$(BUILD)/clang CC=clang CFLAGS="-O1 -Werror" $(BUILD)/clang/deaspice;) } >&2
	@$(BUILD)/stability examples "$(CC) $(CFLAGS)=$(BUILD)/deaspice" "-O0=$(BUILD)/o0/deaspice" "-O3=$(BUILD)/o3/deaspice" \
	"-O2 -march=native -ffp-contract=fast=$(BUILD)/fma/deaspice" $(if $(CLANG),"clang -O1=$(BUILD)/clang/deaspice")

$(BUILD)/stability: $(STABILITY_PARTS) $(BUILD)/tests/stability/main.o $(BUILD)/libdeaspice.a
	@echo "LD $@"
	@$(CC) $(CFLAGS) $(LDFLAGS) $^ -o $@ $(LIBS)

# Random scenes by all engines and accuracies against truths found another way: broken promises of accuracy; then membranes that move,
# with all that may lie beside a film, at 1e-3; then transients with an electrical port and branches at which steps of ngspice once
# collapsed. About an hour of one core; SCENES=n, FILMS=n, STALLS=n, SEED=s for others. The seed is the date unless given, printed
# with the command that repeats the run.
SCENES ?= 500
FILMS ?= 200
STALLS ?= 200
promises:
	@$(MAKE) --no-print-directory -j$(JOBS) all $(BUILD)/promises
	@status=0; \
	$(BUILD)/promises --scenes $(SCENES) $(if $(SEED),--seed $(SEED)) || status=$$?; \
	$(BUILD)/promises --films --accuracy 1e-3 --scenes $(FILMS) $(if $(SEED),--seed $(SEED)) || status=$$?; \
	$(BUILD)/promises --stalls --scenes $(STALLS) $(if $(SEED),--seed $(SEED)) || status=$$?; \
	exit $$status

TRUTHS := $(patsubst %,$(BUILD)/tests/promises/%.o,law film still legendre membrane source radau moving response radial radial_motion radial_response)
PROMISES := $(patsubst %.c,$(BUILD)/%.o,$(sort $(wildcard tests/promises/*.c)))
$(BUILD)/promises: $(PROMISES) $(BUILD)/libdeaspice.a
	@echo "LD $@"
	@$(CC) $(CFLAGS) $(LDFLAGS) $^ -o $@ -lcmocka $(LIBS)

# The hard cases by all engines as a Markdown table, the full size of each; make check runs them thinned.
hard:
	@$(MAKE) --no-print-directory -j$(JOBS) all $(BUILD)/hard
	@$(BUILD)/hard tests/hard

$(BUILD)/hard: $(wildcard tests/hard/*.[ch]) $(TRUTHS) $(BUILD)/libdeaspice.a
	@echo "CC $@"
	@$(CC) $(filter-out -MMD -MP,$(ALL_CFLAGS)) $(filter %.c %.o,$^) $(BUILD)/libdeaspice.a -o $@ $(LDFLAGS) $(LIBS)

# No circle of includes, no arrow upwards.
layers-stage:
	@tests/run layers tests/layers

# The ready-made parts for circuit simulators; a unit test finds what is checked in and differs.
netlists: $(BUILD)/make_netlists
	@$(BUILD)/make_netlists netlists

$(BUILD)/make_netlists: tests/make_netlists.c $(BUILD)/libdeaspice.a
	@echo "CC $@"
	@$(CC) $(filter-out -MMD -MP,$(ALL_CFLAGS)) $^ -o $@ $(LDFLAGS) $(LIBS)

SHARE = $(DESTDIR)$(PREFIX)/share
COMPLETIONS = $(SHARE)/bash-completion/completions/deaspice $(SHARE)/zsh/site-functions/_deaspice \
              $(SHARE)/fish/vendor_completions.d/deaspice.fish
install: all
	install -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/lib/pkgconfig $(DESTDIR)$(PREFIX)/include/deaspice $(SHARE)/man/man1 \
	  $(SHARE)/deaspice $(dir $(COMPLETIONS))
	install -m 755 $(BUILD)/deaspice $(DESTDIR)$(PREFIX)/bin/
	install -m 644 $(BUILD)/libdeaspice.a $(DESTDIR)$(PREFIX)/lib/
	install -m 755 $(BUILD)/libdeaspice.so $(DESTDIR)$(PREFIX)/lib/libdeaspice.so.0
	ln -sf libdeaspice.so.0 $(DESTDIR)$(PREFIX)/lib/libdeaspice.so
	install -m 644 include/deaspice/*.h $(DESTDIR)$(PREFIX)/include/deaspice/
	install -m 644 src/program/deaspice.1 $(SHARE)/man/man1/
	$(BUILD)/deaspice completion bash >$(word 1,$(COMPLETIONS))
	$(BUILD)/deaspice completion zsh >$(word 2,$(COMPLETIONS))
	$(BUILD)/deaspice completion fish >$(word 3,$(COMPLETIONS))
	rm -rf $(SHARE)/deaspice/netlists $(SHARE)/deaspice/examples
	cp -R netlists examples $(SHARE)/deaspice/
	chmod -R a+rX $(SHARE)/deaspice
	printf 'prefix=%s\nlibdir=$${prefix}/lib\nincludedir=$${prefix}/include\n\nName: deaspice\nDescription: networks of dielectric elastomer actuators\nVersion: %s\nLibs: -L$${libdir} -ldeaspice\nLibs.private: %s\nCflags: -I$${includedir}\n' \
	  '$(PREFIX)' '$(VERSION)' '$(LIBS)' >$(DESTDIR)$(PREFIX)/lib/pkgconfig/deaspice.pc
	@printf '%s\n' "program      $(DESTDIR)$(PREFIX)/bin/deaspice" "library      $(DESTDIR)$(PREFIX)/lib/libdeaspice.{so,a}" \
	  "headers      $(DESTDIR)$(PREFIX)/include/deaspice" "man page     $(SHARE)/man/man1/deaspice.1" \
	  "examples     $(SHARE)/deaspice/examples" "netlists     $(SHARE)/deaspice/netlists" $(COMPLETIONS:%="completion   %")

uninstall:
	rm -f $(DESTDIR)$(PREFIX)/bin/deaspice $(DESTDIR)$(PREFIX)/lib/libdeaspice.a $(DESTDIR)$(PREFIX)/lib/libdeaspice.so* \
	  $(DESTDIR)$(PREFIX)/lib/pkgconfig/deaspice.pc $(SHARE)/man/man1/deaspice.1 $(COMPLETIONS)
	rm -rf $(DESTDIR)$(PREFIX)/include/deaspice $(SHARE)/deaspice

clean:
	rm -rf $(BUILD) demo

$(BUILD)/%.o: %.c Makefile
	@mkdir -p $(@D)
	@echo "CC $@"
	@$(CC) $(ALL_CFLAGS) $(OWN) -c $< -o $@

$(BUILD)/libdeaspice.a: $(LIBRARY_OBJECTS)
	@rm -f $@
	@echo "AR $@"
	@ar rcs $@ $^

$(BUILD)/libdeaspice.so: $(LIBRARY_OBJECTS)
	@echo "LD $@"
	@$(CC) -shared -Wl,-soname,libdeaspice.so.0 $(CFLAGS) $(LDFLAGS) $^ -o $@ $(LIBS)

$(BUILD)/deaspice: $(PROGRAM_OBJECTS) $(BUILD)/libdeaspice.a
	@echo "LD $@"
	@$(CC) $(CFLAGS) $(LDFLAGS) $^ -o $@ $(LIBS)

# Unit tests do little work of their own and compile faster with less optimisation; without any, the truths of some run too long.
UNIT_OBJECTS := $(UNIT_SOURCES:%.c=$(BUILD)/%.o)
$(UNIT_OBJECTS): OWN = -O1
$(TRUTHS): OWN = $(TRUTH_FLAGS)
$(UNIT_PROGRAMS): $(BUILD)/tests/%: $(BUILD)/tests/unit/%.o $(BUILD)/libdeaspice.a
	@echo "LD $@"
	@$(CC) $(CFLAGS) $(LDFLAGS) $(WRAPPED) $(filter %.o,$^) $(BUILD)/libdeaspice.a -o $@ -lcmocka $(LIBS)

# The whole program with calls that can be made to fail.
FAULTS := $(shell awk -F '[^A-Za-z0-9_]+' '$$1 == "FAULT_CALL" {print $$2} $$2 ~ /^__wrap_/ {print substr($$2, 8)}' tests/unit/faults.h)
$(BUILD)/tests/program.o: src/program/main.c Makefile
	@mkdir -p $(@D)
	@echo "CC $@"
	@$(CC) $(ALL_CFLAGS) -Dmain=deaspice_main -c $< -o $@
$(BUILD)/tests/test_faults: $(filter-out %/main.o,$(PROGRAM_OBJECTS)) $(BUILD)/tests/program.o
$(BUILD)/tests/test_faults: private WRAPPED = $(FAULTS:%=-Wl,--wrap=%)
$(BUILD)/tests/test_stability: $(STABILITY_PARTS)
$(BUILD)/tests/test_promises $(BUILD)/tests/test_columns: $(filter-out %/main.o,$(PROMISES))
$(BUILD)/tests/test_hard_static $(BUILD)/tests/test_hard_moving: $(TRUTHS)
$(BUILD)/tests/test_stalls: $(BUILD)/tests/promises/stalls.o

unit: $(UNIT_PROGRAMS)

-include $(LIBRARY_OBJECTS:.o=.d) $(PROGRAM_OBJECTS:.o=.d) $(STABILITY_PARTS:.o=.d) $(wildcard $(BUILD)/tests/*.d $(BUILD)/tests/*/*.d)
