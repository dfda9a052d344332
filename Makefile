# deaspice: build, test and install. Settings first; override them on the command line: make CC=clang PREFIX=/opt/deaspice
CC      ?= cc
CFLAGS  ?= -O2 -g
PREFIX  ?= /usr/local
BUILD   ?= build
DESTDIR ?=

VERSION  := 0.1.0
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wconversion
PKG_CONFIG ?= pkg-config
PACKAGES := libfyaml udunits lapacke ngspice
ALL_CFLAGS  = -std=c11 -D_POSIX_C_SOURCE=200809L -D_DEFAULT_SOURCE $(WARNINGS) -ffp-contract=off -fvisibility=hidden -fPIC -Iinclude -Isrc \
              -DDEA_VERSION='"$(VERSION)"' -MMD -MP $(shell $(PKG_CONFIG) --cflags-only-I libfyaml ngspice lapacke 2>/dev/null) $(CFLAGS)
SUNDIALS_CORE := $(if $(wildcard $(shell $(CC) -print-file-name=libsundials_core.so)),-lsundials_core,-lsundials_generic)
LIBS = -lngspice -lfyaml -ludunits2 -llapacke -lsundials_ida -lsundials_kinsol -lsundials_nvecserial -lsundials_sunmatrixdense \
       -lsundials_sunlinsoldense $(SUNDIALS_CORE) -ldl -lm

LIBRARY_SOURCES := $(filter-out src/program/%,$(sort $(wildcard src/*/*.c src/*/*/*.c)))
PROGRAM_SOURCES := $(sort $(wildcard src/program/*.c))
LIBRARY_OBJECTS := $(LIBRARY_SOURCES:%.c=$(BUILD)/%.o)
PROGRAM_OBJECTS := $(PROGRAM_SOURCES:%.c=$(BUILD)/%.o)
UNIT_SOURCES    := $(sort $(wildcard tests/unit/test_*.c))
UNIT_PROGRAMS   := $(UNIT_SOURCES:tests/unit/%.c=$(BUILD)/tests/%)

.DELETE_ON_ERROR:
.PHONY: all unit

all: $(BUILD)/deaspice $(BUILD)/libdeaspice.so

$(BUILD)/%.o: %.c Makefile
	@mkdir -p $(@D)
	$(CC) $(ALL_CFLAGS) -c $< -o $@

$(BUILD)/libdeaspice.a: $(LIBRARY_OBJECTS)
	@rm -f $@
	ar rcs $@ $^

$(BUILD)/libdeaspice.so: $(LIBRARY_OBJECTS)
	$(CC) -shared -Wl,-soname,libdeaspice.so.0 $(CFLAGS) $(LDFLAGS) $^ -o $@ $(LIBS)

$(BUILD)/deaspice: $(PROGRAM_OBJECTS) $(BUILD)/libdeaspice.a
	$(CC) $(CFLAGS) $(LDFLAGS) $^ -o $@ $(LIBS)

$(BUILD)/tests/%: tests/unit/%.c $(BUILD)/libdeaspice.a Makefile
	@mkdir -p $(@D)
	$(CC) $(ALL_CFLAGS) -Itests/unit $< $(BUILD)/libdeaspice.a -o $@ $(LDFLAGS) -lcmocka $(LIBS)

unit: $(UNIT_PROGRAMS)

-include $(LIBRARY_OBJECTS:.o=.d) $(PROGRAM_OBJECTS:.o=.d) $(wildcard $(BUILD)/tests/*.d)
