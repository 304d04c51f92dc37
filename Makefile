# What people run. CMake does the work; see CMakePresets.json.
.DEFAULT_GOAL := help

JOBS := $(shell nproc)
PREFIX := /usr/local
SOURCES = $(shell find data docs filters geom plugin tests -name '*.h' -o -name '*.cxx' -o -name '*.cpp')

include tests/support/open_mpi
export $(shell sed -n 's/=.*//p' tests/support/open_mpi)

.PHONY: help
help: ## Show this list
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 22

.PHONY: packages
packages: ## Install all Debian packages that are missing (other targets install what they need)
	@.ci/install-packages

.PHONY: build
build: ## Build the plugin: build/release
	@.ci/install-packages plugin
	@cmake --preset plugin
	@cmake --build --preset plugin --parallel $(JOBS)

.PHONY: build-all
build-all: ## Build the plugin, the tests and the benchmarks, in the same folder
	@.ci/install-packages plugin tests
	@cmake --preset release
	@cmake --build --preset release --parallel $(JOBS)

.PHONY: demo
demo: ## Run the NACA 0012 case on two ranks: tables and pictures in build/demo
	@.ci/install-packages plugin
	@cmake --preset plugin
	@cmake --build --preset plugin --target CADRefine --parallel $(JOBS)
	@/usr/bin/python3 plugin/demo.py --output build/demo

.PHONY: gallery
gallery: build ## Run the cases of docs/gallery.md: meshes, reports and pictures in build/gallery
	@.ci/install-packages tests
	@/usr/bin/python3 docs/gallery/gallery.py

.PHONY: test
test: lint build-all ## Run the tests, but for the slow ones
	@ctest --preset release --parallel $(JOBS)

.PHONY: test-slow
test-slow: build-all ## Run the slow tests
	@ctest --preset release-slow --parallel $(JOBS) $(CTEST_ARGUMENTS)

.PHONY: test-all
test-all: lint build-all ## Run all tests
	@ctest --preset release-all --parallel $(JOBS)

.PHONY: install
install: ## Install what `make build` made (PREFIX=/usr/local, DESTDIR=)
	@DESTDIR="$(abspath $(DESTDIR))" cmake --install build/release --prefix "$(PREFIX)"
	@cp build/release/install_manifest.txt build/installed.txt

.PHONY: uninstall
uninstall: ## Remove what `make install` installed last (the same DESTDIR)
	@DESTDIR="$(abspath $(DESTDIR))" plugin/package/uninstall build/installed.txt

.PHONY: package
package: build ## Make Debian packages: build/*.deb
	@.ci/install-packages dpkg-dev file
	@plugin/package/debian build/release build

.PHONY: benchmarks
benchmarks: build-all ## Measure against other programs: tables of rates and ratios
	@build/release/tests/benchmarks/closest_point_benchmark
	@for ranks in 1 2 4 8; do mpirun --bind-to none -np $$ranks build/release/tests/benchmarks/nose_benchmark \
	  data/aeroplane.igs data/aeroplane_coarse.vtu 0.05 0.2 -0.25 0.25 -0.2 0.2 || exit; done
	@/usr/bin/python3 tests/benchmarks/reading.py
	@/usr/bin/python3 tests/benchmarks/projection.py
	@/usr/bin/python3 tests/benchmarks/adaptivity.py
	@/usr/bin/python3 tests/benchmarks/experiments.py
	@/usr/bin/python3 tests/benchmarks/refinement.py

.PHONY: load
load: build ## Run very large cases, many ranks, many cycles: a table of time and memory (15 GiB, half an hour)
	@/usr/bin/python3 -B tests/benchmarks/load.py

.PHONY: sanitizers
sanitizers: ## Run the tests of geom/ and filters/ with address and undefined behaviour sanitizers; coverage
	@.ci/install-packages plugin tests gcovr
	@cmake --preset sanitizers $(CMAKE_ARGUMENTS)
	@cmake --build --preset sanitizers --parallel $(JOBS)
	@.ci/sanitizers --parallel $(JOBS) $(CTEST_ARGUMENTS)

.PHONY: threads
threads: ## Run the tests of what runs on threads with the thread sanitizer
	@.ci/install-packages plugin tests
	@cmake --preset threads
	@cmake --build --preset threads --parallel $(JOBS)
	@ctest --preset threads --parallel $(JOBS)

FUZZ_SECONDS := 600
.PHONY: fuzz
fuzz: ## Fuzz the parsers for FUZZ_SECONDS each; what they find is left in build/fuzz/findings
	@.ci/install-packages plugin clang libclang-rt-dev
	@cmake --preset fuzz
	@cmake --build --preset fuzz --parallel $(JOBS)
	@tests/fuzz/run $(FUZZ_SECONDS)

CAD_SAMPLES = data/naca0012_blunt.igs data/three_arcs.igs data/three_arcs_nurbs.igs data/aeroplane.igs \
  data/cylinder.brep /usr/share/doc/libdeal.ii-doc/examples/step-54/input/DTMB-5415_bulbous_bow.iges \
  $(addprefix /usr/share/opencascade/data/,iges/bearing.iges iges/hammer.iges step/screw.step step/linkrods.step \
  occ/bottle.brep occ/face1.brep occ/fuse.brep occ/mal_vis.brep occ/Room.brep occ/solid.brep occ/wing.brep)
.PHONY: bad-cad
bad-cad: build-all ## Read damaged CAD files by the hundred: a table of what became of them
	@build/release/tests/geom/badcad_table corpus
	@build/release/tests/geom/badcad_table 100 1000 $(CAD_SAMPLES)

.PHONY: format
format: ## Format the sources
	@.ci/install-packages clang-format
	@clang-format -i $(SOURCES)

.PHONY: lint
lint: ## Look at the format of the sources (clang-format 14: others differ) and of the documentation
	@.ci/install-packages clang-format python3
	@if clang-format --version | grep -q 'version 14\.'; then clang-format --dry-run --Werror $(SOURCES); \
	  else echo "lint: the sources are left out, $$(clang-format --version) is not 14"; fi
	@/usr/bin/python3 -B tests/docs/lint.py

.PHONY: tidy
tidy: build-all ## Run clang-tidy on the sources
	@.ci/tidy all

.PHONY: pictures
pictures: build ## Make the pictures of the documentation anew (docs/images)
	@.ci/install-packages tests tools
	@xvfb-run --auto-servernum --server-args="-screen 0 1280x1024x24 -noreset" pvpython docs/pictures.py
	@xvfb-run --auto-servernum --server-args="-screen 0 1280x1024x24 -noreset" pvpython docs/triangle_pictures.py
	@/usr/bin/python3 -B docs/gallery/gallery.py --publish
	@/usr/bin/python3 -B docs/window_pictures.py
	@dot -Tsvg docs/images/architecture.dot -o docs/images/architecture.svg

.PHONY: doxygen
doxygen: ## Make the reference of the C++ code: build/doxygen/html/index.html
	@.ci/install-packages doxygen
	@mkdir -p build/doxygen
	@CADREFINE_DOXYGEN=build/doxygen doxygen docs/Doxyfile

.PHONY: clean
clean: ## Remove everything that was built
	@rm -rf build
