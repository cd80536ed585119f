# The front door: `make demo` shows a mesh in the browser, `make test` runs every test. Both may be
# repeated and do only what is missing. Developers use cmake and ctest with the presets of
# CMakePresets.json; this file adds nothing to them but the packages.

MESH ?=
PORT ?= 8080
RESULTS ?=
export MESH PORT
# Steps, of how many, and seconds so far.
export NINJA_STATUS := [%f/%t, %e s] 

BUILD := build/release
CHECKED := build/checked
# A translation unit with Boost.Beast takes up to 1.5 GB to compile: no more jobs than cores,
# nor than memory allows.
JOBS ?= $(shell awk -v cores="$$(nproc)" '/MemAvailable/ { \
  n = int($$2 / 1500000); n = n < cores ? n : cores; print n < 1 ? 1 : n}' /proc/meminfo)

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.ONESHELL:
.NOTPARALLEL:
.DELETE_ON_ERROR:
.PHONY: help setup packages build build-aarch64 build-checked demo demo-port demo-log test
.PHONY: test-units test-system check
.PHONY: soak format format-check lint house tidy sanitize fuzz fresh bench results sizes rate deb
.PHONY: test-deb same-bytes guard bench-server wheel release gallery clean
.DEFAULT_GOAL := help

help:
	@cat <<'END'
	make demo                  build qtet and show its sample mesh at http://127.0.0.1:8080/
	make demo MESH=file.vtu    the same with a mesh of yours (any kind that simplify/INPUT.md names)
	make test                  build everything and run every test
	make check ROOM=codec      build and run the quick unit tests of one room (proto, codec, simplify,
	                           server), or the tests of web-client; ALL=1 runs the slow ones, too
	make soak TIMES=20         run the tests with servers, or TESTS=REGEX, so many times
	make format                lay out C++ (clang-format-19) and TypeScript, JavaScript, CSS (prettier)
	make format-check          fail where that would change a file, or a line is over 100 columns
	make tidy                  clang-tidy over what changed since the merge base or in 20 commits
	make lint                  the linter of TypeScript, with types
	make house                 rules that need no build: arrows between rooms, plain words, packages
	make same-bytes            the logs of tests/same_bytes.txt from every build, processor and number
	                           of threads; WRITE=1 writes the table again
	make fuzz                  run each fuzzer for 20 seconds, built with sanitizers
	make sanitize              every test under ASan and UBSan, then under TSan, and how long that took
	make fresh SUITE=trixie    continuous integration in a new Debian (needs root and mmdebstrap);
	                           bookworm unless given; COMMAND="make demo" runs another command
	make deb                   Debian packages: build/release/packages/*.deb
	make release               wheel, Debian packages, npm package, gallery, sources, their bill of
	                           materials and checksums: build/release/dist
	make gallery               the samples and links to each feature, for any web server:
	                           build/release/gallery
	make wheel                 the Python package: build/release/wheels/*.whl; ARCH=aarch64 compiles
	                           it for that processor with g++-aarch64-linux-gnu, ARCH=pure makes the
	                           one for Pyodide, and for node on every system
	make test-deb              install, use and remove them in a Debian of their own (needs root)
	make build                 build only: build/release/bin/qtet and qtet-server
	make setup                 install what is missing of .ci/packages.txt (asks sudo if not root), and
	                           fetch the sources that the browser's simplifier is compiled from
	make bench                 build and run the benchmarks
	make guard BASE=COMMIT     fail where simplifying, decoding or serving became slower than COMMIT
	make bench-server          qtet-server beside nginx: the table of tests/bench/SERVER.md made anew
	make results               compare with VTK's decimation: tests/bench/RESULTS.md
	make sizes                 tests/bench/SIZES.md made anew: to the byte
	make rate                  tests/bench/RATE.md made anew: error against bytes
	make clean                 remove build/
	PORT=N                     another port for the demo than $(PORT)
	JOBS=N                     compile N files at a time (now $(JOBS))
	QTET_DATA=FOLDER           the .vtu files of results, and for sizes and rate the data sets, too
	QTET_JUDGE=PROGRAM         what judges the meshes of results
	RESULTS="--sets a,b"       options of tests/bench/results.py
	END

setup: packages
	@[[ "$(PART)" == build ]] || .ci/sources.sh

# The part of .ci/packages.txt that is wanted: `build`, or all of it.
PART :=

packages:
	@say() { printf 'setup: %s\n' "$$@"; }
	last='$$'
	[[ "$(PART)" != build ]] || last='/^# ==== tests/'
	mapfile -t wanted < <(sed -n "1,$$last p" .ci/packages.txt | sed 's/#.*//' |
	  grep -o '[^[:space:]]*')
	if ! command -v dpkg-query >/dev/null; then
	  say "this is no Debian; if the build fails, install what .ci/packages.txt names from your \
	system's packages"
	  exit 0
	fi
	installed=$$(dpkg-query -W -f '$${db:Status-Status} $${Package}\n' "$${wanted[@]}" 2>/dev/null |
	  sed -n 's/^installed //p') || true
	mapfile -t missing < <(comm -23 <(printf '%s\n' "$${wanted[@]}" | sort) <(sort <<<"$$installed"))
	nodeIsFine() {
	  command -v npm >/dev/null &&
	    node -e 'process.exit(parseInt(process.versions.node) >= 18 ? 0 : 1)' 2>/dev/null
	}
	nodeIsFine || missing+=(nodejs npm)
	if [[ $${#missing[@]} == 0 ]]; then
	  say "all $${#wanted[@]} packages that are wanted and node $$(node --version) are here"
	  exit 0
	fi
	say "installing $${#missing[@]} packages: $${missing[*]}"
	asRoot=(env)
	if [[ $$(id -u) != 0 ]]; then
	  command -v sudo >/dev/null || {
	    say "there is no sudo; run as root: apt-get install --no-install-recommends $${missing[*]}" >&2
	    exit 1
	  }
	  asRoot=(sudo)
	  [[ $${CI:-} == true ]] && asRoot=(sudo -n)
	  asRoot+=(env)
	fi
	asRoot+=(DEBIAN_FRONTEND=noninteractive)
	"$${asRoot[@]}" apt-get update ||
	  say "apt-get update failed; going on with the package lists that are here"
	"$${asRoot[@]}" apt-get install -y --no-install-recommends --no-remove "$${missing[@]}" || {
	  say "apt-get could not install them (its reason stands above). qtet is built on Debian 12;" \
	    "a package that apt would have to remove, such as another version's wasm32 library," \
	    "has to be removed by you first." >&2
	  exit 1
	}
	nodeIsFine || {
	  version=$$(node --version 2>/dev/null || echo "is missing")
	  say "node $$version - version 18 or later is needed, with npm" >&2
	  exit 1
	}

# Configures when there is no build yet, when the presets changed, or when the folder was moved;
# ninja sees to everything else. A build that was configured for the demo alone becomes a whole one.
PRESET := release
define configure
cache=build/$(1)/CMakeCache.txt
if ! grep -qsxF "CMAKE_HOME_DIRECTORY:INTERNAL=$$(pwd -P)" "$$cache" ||
  [[ ! -f build/$(1)/build.ninja || CMakePresets.json -nt build/$(1)/build.ninja ]] ||
  { [[ $(2) == release ]] && grep -qx 'QTET_TESTS:[A-Z]*=OFF' "$$cache"; }; then
  # Fresh, since CMake forgets a preset's variables where its compiler has changed.
  cmake --preset $(2) --fresh
fi
endef
build:
	@$(call configure,release,$(PRESET))
	cmake --build --preset release --parallel $(JOBS) $(TARGETS)

# The Python package's library for another processor.
build-aarch64:
	@command -v aarch64-linux-gnu-g++ >/dev/null || {
	  echo "aarch64: there is no aarch64-linux-gnu-g++; install g++-aarch64-linux-gnu" >&2
	  exit 1
	}
	.packaging/aarch64_root.sh
	$(call configure,aarch64,aarch64)
	cmake --build --preset aarch64 --parallel $(JOBS)

# The unit tests and the fuzzers, with assertions and sanitizers.
build-checked:
	@$(call configure,checked,checked)
	cmake --build --preset checked --parallel $(JOBS) $(CHECKED_TARGETS)

# Refuses a port in use at once, before anything is built.
demo-port:
	@refuse() { echo "demo: $$1" >&2; exit 1; }
	if [[ ! $$PORT =~ ^[0-9]{1,5}$$ ]] || ((10#$$PORT < 1 || 10#$$PORT > 65535)); then
	  refuse "PORT=$$PORT is no port; give a number from 1024 to 65535, for example: \
	make demo PORT=8081"
	fi
	if (exec 3<>"/dev/tcp/127.0.0.1/$$PORT") 2>/dev/null; then
	  refuse "port $$PORT is in use by another program; choose another: \
	make demo PORT=$$((10#$$PORT + 1))"
	fi
	if [[ -n $$MESH && ! -r $$MESH ]]; then
	  refuse "MESH=$$MESH cannot be read; give the path of a mesh file, in quotes if it holds spaces"
	fi

# The log's name, also the mesh's id in the URL: the file's name without its folder and ending, in
# letters that need no quoting.
define demo_name
name=fin
if [[ -n $$MESH ]]; then
  name=$$(basename -- "$$MESH")
  name=$${name%.*}
  name=$${name//[^A-Za-z0-9._-]/_}
  name=$${name#.}
fi
endef

# The demo waits for nothing that it does not show, the tests least of all.
demo: TARGETS := --target qtet qtet-server qtet_viewer
demo: PART := build
demo: PRESET := demo

# Makes build/demo/NAME.qtet, unless it is there already, from this very mesh and newer than mesh
# and tool. This viewer may not read an older tool's log, and this tool may write a better one. The
# tool writes its files whole or not at all, so an interrupted run leaves nothing half done.
demo-log: demo-port setup build
	@$(demo_name)
	log=build/demo/$$name.qtet
	origin=build/demo-input/$$name.origin
	input=$${MESH:-build/demo-input/fin.vtu}
	tool=$(BUILD)/bin/qtet
	mkdir -p build/demo build/demo-input
	[[ -n $$MESH || -f $$input ]] || "$$tool" sample fin -o "$$input"
	path=$$(realpath -- "$$input")
	if [[ -f $$log && ! $$input -nt $$log && ! $$tool -nt $$log &&
	  $$(cat "$$origin" 2>/dev/null) == "$$path" ]]; then
	  echo "demo: $$log is up to date"
	  exit 0
	fi
	echo "demo: simplifying $$input"
	rm -f "$$origin"
	"$$tool" simplify "$$input" -o "$$log"
	echo "$$path" >"$$origin"

# In a terminal's foreground the server becomes the foreground job instead of make, which would call
# a Ctrl-C an error. (Fields 3 and 6 behind the name in /proc/PID/stat: this process group, and the
# terminal's.) setpriv stops the server whenever this shell is gone, however it went.
demo: demo-log
	@$(demo_name)
	stat=$$(</proc/$$$$/stat)
	read -r _ _ group _ _ terminalGroup _ <<<"$${stat##*) }"
	terminal=$$([[ $$group == "$$terminalGroup" ]] && echo yes || echo no)
	[[ $$terminal == no ]] || set -m
	setpriv --pdeathsig TERM $(BUILD)/bin/qtet-server build/demo --port "$$PORT" --viewer \
	  $(BUILD)/share/qtet/viewer &
	server=$$!
	[[ $$terminal == yes ]] || trap 'kill -TERM $$server' INT TERM
	until (exec 3<>"/dev/tcp/127.0.0.1/$$PORT") 2>/dev/null; do
	  kill -0 $$server 2>/dev/null || {
	    wait $$server || status=$$?
	    echo "demo: the server stopped; see its message above" >&2
	    exit $${status:-1}
	  }
	  sleep 0.1
	done
	[[ -n $$MESH ]] || look='&field=Velocity&clip=y'  # the sample at its best: cut open along the flow
	echo "Open http://127.0.0.1:$$PORT/?mesh=$$name$${look:-}  (Ctrl-C stops)"
	status=0
	if [[ $$terminal == yes ]]; then
	  fg %1 >/dev/null || status=$$?
	else
	  # It ends early when a signal arrives; the second one gives the server's own status.
	  wait $$server || true
	  wait $$server || status=$$?
	fi
	exit $$status

# Every C++ file is compiled once for what users run, and once with sanitizers for its unit tests.
test: setup build build-checked test-units test-system
	@echo "test: all passed"

# The tests of a suite run in another order each time. SEED=N repeats an order.
SEED := $(or $(SEED),$(shell awk "BEGIN {srand(); print int(rand() * 99999) + 1}"))
test-units:
	@echo "test: unit tests are shuffled, SEED=$(SEED)"
	GTEST_SHUFFLE=1 GTEST_RANDOM_SEED=$(SEED) ctest --preset checked --parallel $(JOBS)
	echo "skipped:"
	sed -n 's/^\[  SKIPPED \] \([^ ]*\) (.*/  \1/p' $(CHECKED)/Testing/Temporary/LastTest.log

# A browser or a network namespace on a busy machine may stall for longer than a test allows. So
# tests with the label `chance`, and no others, get a second try, and the run lists them.
test-system:
	@ctest --preset release --parallel $(JOBS) -LE chance
	log=$(BUILD)/Testing/chance.txt
	ctest --preset release --parallel $(JOBS) -L chance --repeat until-pass:2 | tee "$$log"
	again=$$(grep -oE 'Test +#[0-9]+: [^ ]+ \.+\*+(Failed|Timeout|Exception)' "$$log" || true)
	[[ -z $$again ]] || printf 'test: passed only when tried again:\n%s\n' "$$again"

# After a change in one room. ROOM=codec: its unit tests alone are built and run.
ROOM ?=
# For a quick answer it leaves out what took longer than this here before, in seconds.
QUICK := 6
check: CHECKED_TARGETS := --target check_$(ROOM)
check:
	@case "$(ROOM)" in
	  proto | codec | simplify | server)
	    $(MAKE) --no-print-directory build-checked CHECKED_TARGETS="$(CHECKED_TARGETS)"
	    slow=$$(awk '/^---/ {exit} $$3 > $(QUICK) && $$1 ~ /^$(ROOM)[.]/ {print $$1}' \
	      $(CHECKED)/Testing/Temporary/CTestCostData.txt 2>/dev/null | paste -sd '|') || true
	    [[ -z "$(ALL)" ]] || slow=
	    ctest --preset checked --parallel $(JOBS) -L '^$(ROOM)$$' $${slow:+-E "^($$slow)$$"}
	    [[ -z $$slow ]] || echo "check: left to ALL=1 and test-units, over $(QUICK) s each:" \
	      "$${slow//|/ }" ;;
	  web-client)
	    $(MAKE) --no-print-directory build
	    ctest --preset release --parallel $(JOBS) -L '^web-client$$' ;;
	  *) echo "check: ROOM=$(ROOM) is no room; give proto, codec, simplify, server or web-client" >&2
	    exit 1 ;;
	esac

# Looks for tests that fail by chance: those with servers, again and again.
TIMES ?= 20
TESTS ?=
soak: build build-checked
	@tests="$(TESTS)"
	for ((i = 1; i <= $(TIMES); ++i)); do
	  echo "soak: $$i of $(TIMES)"
	  if [[ -n $$tests ]]; then
	    ctest --preset checked --parallel $(JOBS) -R "$$tests" --no-tests=ignore
	    ctest --preset release --parallel $(JOBS) -R "$$tests" --no-tests=ignore
	  else
	    ctest --preset checked --parallel $(JOBS) -L '^server$$'
	    ctest --preset release --parallel $(JOBS) -L '^server$$' -LE chance
	  fi
	done

# One clang-format and one prettier, whatever else is installed: their versions differ in what they
# do.
CPP_FILES = git ls-files -z '*.h' '*.cpp' '*.c'
format: setup web-packages
	@$(CPP_FILES) | xargs -0 clang-format-19 -i
	cd web-client && npm run --silent format

format-check: setup web-packages
	@$(CPP_FILES) | xargs -0 clang-format-19 --dry-run -Werror
	cd web-client && npm run --silent format:check
	cd .. && tests/lines.sh

lint: setup web-packages
	@cd web-client && npm run --silent typecheck && npm run --silent lint

# The rules of the house that need no build: arrows between rooms, plain words, packages.
house:
	@tests/arrows/check.sh .
	python3 tests/prose/check.py .
	python3 tests/packages/check.py . || [[ $$? == 77 ]]

.PHONY: web-packages
web-packages:
	@cd web-client
	installed=node_modules/.package-lock.json
	if [[ ! -f $$installed || package-lock.json -nt $$installed ]]; then
	  npm ci --no-audit --no-fund --loglevel=error
	  touch "$$installed"
	fi

TIDY_SINCE ?=
tidy: setup
	@$(call configure,tidy,tidy)
	# Nothing is built here that would look for new sources of tests.
	cmake --preset tidy >/dev/null
	.ci/tidy.py build/tidy $(JOBS) $(TIDY_SINCE)

# Doors to the same bytes; that of another processor where its compiler and qemu are here.
WRITE :=
same-bytes: TARGETS := --target same_bytes $(if $(WRITE),,qtet_viewer)
same-bytes: CHECKED_TARGETS := --target same_bytes
same-bytes: build $(if $(WRITE),,build-checked)
	@if [[ -n "$(WRITE)" ]]; then
	  exec tests/same_bytes/doors.sh --write $(BUILD)/bin/same_bytes
	fi
	if command -v aarch64-linux-gnu-g++ >/dev/null; then
	  grep -q '^QTET_AARCH64_CXX:.*=/' $(BUILD)/CMakeCache.txt || cmake --preset release
	  cmake --build --preset release --parallel $(JOBS) --target same_bytes_aarch64
	fi
	tests/same_bytes/doors.sh all $(BUILD) $(CHECKED)

# A fuzzer's finds stay in build/checked/fuzz/found.
fuzz: CHECKED_TARGETS := --target qtet_fuzzers
fuzz: setup build-checked
	@ctest --preset checked --parallel $(JOBS) -L fuzz

sanitize: setup build build-checked
	@$(call configure,tsan,tsan)
	failed=
	for preset in checked tsan; do
	  start=$$SECONDS
	  cmake --build --preset $$preset --parallel $(JOBS)
	  built=$$SECONDS
	  ctest --test-dir build/$$preset --output-on-failure --parallel $(JOBS) || failed+=" $$preset"
	  took+="$$preset: built in $$((built - start)) s, tested in $$((SECONDS - built)) s"$$'\n'
	done
	echo -n "$$took"
	[[ -z $$failed ]] || { echo "sanitize: failures under$$failed; see above" >&2; exit 1; }

# Proves that .ci/packages.txt names all that is needed.
SUITE ?= bookworm
COMMAND ?=
fresh:
	@.ci/fresh.sh $(SUITE) $(COMMAND)

ARCH :=
wheel: setup
	@python3 .packaging/python_backend.py $(BUILD)/wheels $(ARCH)

DEB_TARGETS := qtet qtet-server qtet_shared qtet_viewer qtet_manners qtet_packaging
release: TARGETS := --target $(DEB_TARGETS) qtet_package_library
release: setup build
	@python3 .packaging/release.py $(BUILD)/dist

gallery: TARGETS := --target qtet qtet_viewer
gallery: setup build
	@python3 .packaging/gallery.py $(BUILD)/gallery

deb: TARGETS := --target $(DEB_TARGETS)
deb: setup build
	@rm -rf $(BUILD)/packages
	cd $(BUILD) && cpack -G DEB
	ls -l packages/*.deb

test-deb: deb
	@status=0
	.packaging/test.sh $(BUILD)/packages build/deb-test || status=$$?
	[[ $$status == 77 ]] || exit $$status

bench: setup build
	@cmake --build --preset release --parallel $(JOBS) --target qtet_bench
	shopt -s nullglob
	for program in $(BUILD)/bench/*; do
	  [[ -x $$program && -f $$program ]] || continue
	  echo "== $$program"
	  "$$program"
	done

# Whether this tree is slower than another commit, which is built below build/guard.
BASE ?=
guard: TARGETS := --target qtet qtet-server web-client/qtet-codec.wasm
guard: setup web-packages build
	@[[ -n "$(BASE)" ]] || { echo "guard: give BASE=COMMIT, to compare with" >&2; exit 1; }
	tests/bench/guard.py --base "$(BASE)" --jobs $(JOBS)

# The table of tests/bench/SERVER.md. Counts on a quiet machine only.
bench-server: TARGETS := --target qtet-server server_log
bench-server: setup build
	@log=build/bench-server.qtet
	[[ -f $$log && ! $(BUILD)/bin/server_log -nt $$log ]] || $(BUILD)/bin/server_log "$$log"
	python3 tests/bench/server_bench.py --bin $(BUILD)/bin --log "$$log"

# Writes tests/bench/RESULTS.md. Finished results stay in build/results, so the run may be stopped
# and started again.
results: TARGETS := --target qtet vtk_decimate
results: setup build
	@python3 tests/bench/results.py --cache build/results $(RESULTS)

# tests/bench/SIZES.md, which a test compares with the tool.
sizes: TARGETS := --target qtet vtu_size
sizes: setup build
	@python3 tests/bench/sizes.py

# tests/bench/RATE.md and its pictures.
rate: TARGETS := --target qtet rate_distortion
rate: setup build
	@$(BUILD)/bin/rate_distortion --out tests/bench --curve "log=" --curve \
	  "optimal=--placement optimal" --curve "vertex=--placement vertex"

clean:
	@rm -rf build
	echo "removed build/"
