# The common tasks by name; `make help` lists them.
SHELL := /bin/bash
.DEFAULT_GOAL := help
.PHONY: help setup build install deb wheel demo docs test ros train benchmark format check-format tidy asan tsan clean

JOBS ?= $(shell nproc)
PRESET ?= release
BUILD = build/$(PRESET)
DXSLAM = build/release/dxslam
SOURCES = $(shell git ls-files '*.cpp' '*.h')
CLANG_FORMAT ?= clang-format-19

# Paths below are relative for the compiler cache, so the builds of program and wheel share its results.
export CCACHE_BASEDIR = $(CURDIR)

help:  ## this list
	@sed -n 's/^\([a-z][a-z -]*\):.*## /  make \1\t/p' $(MAKEFILE_LIST) | expand -t 22

setup:  ## install what is missing (Debian packages, Python environments)
	@scripts/setup $(SETUP_OPTIONS)

$(BUILD)/build.ninja: | setup
	cmake --preset $(PRESET)

build: setup $(BUILD)/build.ninja  ## the program, at build/release/dxslam
	cmake --build $(BUILD) -j $(JOBS) --target dxslam

PREFIX ?= /usr/local
install: setup $(BUILD)/build.ninja  ## program and C++ library to PREFIX (default: /usr/local)
	cmake --build $(BUILD) -j $(JOBS) --target dxslam dxslam_library
	cmake --install $(BUILD) --prefix '$(PREFIX)'

deb: setup $(BUILD)/build.ninja  ## a Debian package of the same, in the build folder (scripts/check_deb tests it)
	cmake --build $(BUILD) -j $(JOBS) --target dxslam dxslam_library
	cd $(BUILD) && cpack -G DEB

wheel: SETUP_OPTIONS = --with-eval
wheel: setup  ## the Python package as one wheel, in build/wheel/dist
	@scripts/build_wheel

demo: build  ## make a synthetic recording, run SLAM on it, evaluate and draw the result
	@rm -rf out/demo
	$(DXSLAM) synth out/demo/sequence --frames 300
	$(DXSLAM) run out/demo/sequence --out out/demo/result
	$(DXSLAM) eval ate out/demo/sequence/groundtruth.txt out/demo/result/trajectory.txt
	@printf '\nResults:  %s\nPicture:  %s\n' "$(CURDIR)/out/demo/result" \
	  "$(CURDIR)/out/demo/result/trajectory.svg"

test: SETUP_OPTIONS = --with-eval
test: setup $(BUILD)/build.ninja  ## set up, build everything and run all tests
	cmake --build $(BUILD) -j $(JOBS)
	ctest --preset $(PRESET) -j $(JOBS)

asan tsan:  ## all tests under AddressSanitizer and UBSan, or under ThreadSanitizer
	$(MAKE) test PRESET=$@

ros: SETUP_OPTIONS = --with-ros
ros: setup  ## set up, build and test the parts for ROS alone, in build/ros
	cmake -S ros -B build/ros -G Ninja
	cmake --build build/ros -j $(JOBS)
	ctest --test-dir build/ros --output-on-failure -j $(JOBS)

train:  ## train the feature network (hours; see training/)
	training/run.sh

benchmark: build  ## our system and ORB-SLAM3 on the real recordings, one table
	benchmarks/accuracy

format:  ## format all C++ sources
	$(CLANG_FORMAT) -i $(SOURCES)

check-format:  ## fail if a C++ source is not formatted
	@$(CLANG_FORMAT) --dry-run --Werror $(SOURCES)

docs: SETUP_OPTIONS = --dev
docs: setup  ## the pages and the reference of the library, in build/docs/html
	scripts/make_docs

tidy: SETUP_OPTIONS = --dev
tidy: PRESET = dev
tidy: setup  ## clang-tidy over all sources
	cmake --preset dev
	run-clang-tidy-19 -quiet -j $(JOBS) -p build/dev '^$(CURDIR)/src/'

clean:  ## remove what was built and made (environments stay)
	rm -rf build out
