# The commands of everyday work. Everything runs on a fresh Debian that has Rust.
#
#   make demo    synthetic survey -> SEG-Y -> import -> layers -> three pictures in out/demo
#   make test    all tests
#   make check   formatting, lints and documentation, warnings denied
#   make bench   how long the stages take on this machine
#   make speed   how long pictures take, on the graphics driver and on the processor (small in CI: SPEED_SIDE, SPEED_SIZE)
#   make check-peers   opens the files that we write with libraries of other programs (Python: numpy, scipy, xtgeo, segyio, lasio)
#   make attack  names, links, damage, kills, full disks, false claims: the real program in minutes (docs/reliability.md)
#   make fuzz    a second of fuzzing for every parser; make fuzz-long ten minutes each
#   make scenario   an interpreter's session by mouse and keys in the real window (Xvfb, xdotool, ImageMagick)
#   make viewer  bundles the viewer of reviews (node, npm); the bundle is committed
#   make check-review   drives reviews in Chromium, compares them with drawn pictures, validates the model (node, npm, chromium)
#   make gallery the pictures of docs/gallery.md
#   make screenshots   every panel of the window, without a display (SIZES, APPEARANCES)
#   make accuracy   measures the accuracy again, for docs/accuracy.md
#   make extraction measures the quality of horizon candidates, for docs/extraction.md
#   make time       measures geologic time, for docs/time.md
#   make picks      counts the picks that horizons take, for docs/picks.md
#   make house      measures how the code is divided, for docs/house.md
#   make recipes    follows the recipes of ARCHITECTURE.md, "What do I touch to add", in a copy of the checkout
#   make wheel      a wheel of the Python package, in target/wheels
#   make test-python   pytest, mypy and the notebooks, in a virtual environment below target/ (PETROGLYPH_SKIP_PYTHON=1 skips it)
#   make rebuilds   which crates a change of each crate compiles again
#   make scale      measures tasks of Dask graphs, for docs/scale.md

OUT ?= out/demo
OUT_ACCURACY ?= docs/accuracy.md
OUT_EXTRACTION ?= docs/extraction.md
OUT_PICKS ?= docs/picks.md
OUT_TIME ?= docs/time.md
SPEED_SIDE ?= 128
SPEED_SIZE ?= 800x800
# The Vulkan loader complains where no desktop session has set this.
export XDG_RUNTIME_DIR ?= /tmp
# Cargo unites the features of what it is asked to build: over the whole workspace they are always the same, so that nothing
# is compiled twice for another command.
BUILD = cargo build --workspace --locked
EXAMPLES = target/debug/examples
PETROGLYPH = target/debug/petroglyph

SIZES ?= 1280x800 2560x1440
APPEARANCES ?= light dark
PYTHON ?= python3

.PHONY: demo gallery screenshots test check bench accuracy extraction picks time speed check-peers check-review viewer scenario attack fuzz fuzz-long setup build wheel test-python scale house recipes rebuilds

build: setup
	$(BUILD) --bin petroglyph

demo: build
	$(PETROGLYPH) demo --out $(OUT)

# The pictures of docs/gallery.md, from the demonstration's project.
gallery: demo
	PETROGLYPH=$(PETROGLYPH) docs/gallery.sh $(OUT) docs/gallery

# The demonstration's project is copied: its panels change it on the way.
screenshots: demo
	$(BUILD) --example screenshots
	for size in $(SIZES); do for appearance in $(APPEARANCES); do \
		rm -rf out/screenshots/demo && mkdir -p out/screenshots && cp -r $(OUT) out/screenshots/demo && \
		$(EXAMPLES)/screenshots out/screenshots/demo out/screenshots $$size $$appearance || exit 1; \
	done; done

# Tests note which projects they made; not in the user's own notes.
test: setup
	XDG_STATE_HOME=$(CURDIR)/target/state cargo test --workspace --locked

check: setup
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked --features fuzz/libfuzzer,fuzz/documents,fuzz/data -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked

accuracy: setup
	$(BUILD) --example accuracy
	$(EXAMPLES)/accuracy > $(OUT_ACCURACY).part && mv $(OUT_ACCURACY).part $(OUT_ACCURACY)

check-peers: build
	$(PYTHON) bench/check_formats.py $(PETROGLYPH)

viewer:
	crates/review/viewer/build.sh

check-review: demo
	cd crates/review/viewer/test && npm ci --no-audit --no-fund --loglevel=error
	node crates/review/viewer/test/drive.mjs $(PETROGLYPH) $(OUT)/demo.petro out/review

extraction: setup
	$(BUILD) --example extraction
	$(EXAMPLES)/extraction > $(OUT_EXTRACTION).part && mv $(OUT_EXTRACTION).part $(OUT_EXTRACTION)

time: setup
	$(BUILD) --example isochrons
	$(EXAMPLES)/isochrons > $(OUT_TIME).part && mv $(OUT_TIME).part $(OUT_TIME)

picks: setup
	$(BUILD) --example picks
	$(EXAMPLES)/picks > $(OUT_PICKS).part && mv $(OUT_PICKS).part $(OUT_PICKS)

speed: setup
	$(BUILD) --example illustration_speed --example time_param --example volume_speed
	$(EXAMPLES)/illustration_speed --side $(SPEED_SIDE) --size $(SPEED_SIZE) --repeats 3
	$(EXAMPLES)/time_param --definitions $(SPEED_SIDE)
	$(EXAMPLES)/volume_speed --side $(SPEED_SIDE) --size $(SPEED_SIZE)

# These also need Python, which `setup` then installs.
wheel test-python: export NEEDS_PYTHON = 1

wheel: setup
	[ -x target/python/maturin/bin/wheel ] || { $(PYTHON) -m venv target/python/maturin && target/python/maturin/bin/pip install --quiet 'maturin>=1.9,<2' 'wheel>=0.45'; }
	target/python/maturin/bin/maturin build --release --locked --out target/wheels
	target/python/maturin/bin/python crates/python/backend.py target/wheels/*.whl

test-python: setup
	crates/python/test.sh

rebuilds:
	@$(PYTHON) bench/rebuilds.py

# In the environment that `make test-python` has made.
scale:
	target/python/venv/bin/python bench/scale.py

house:
	$(PYTHON) bench/house.py

recipes: setup
	$(PYTHON) tests/recipes.py

scenario: build
	tests/scenario.sh $(PETROGLYPH) out/scenario

# What docs/reliability.md lists: modules and tests of tests/it, which run the real program, and tests of the crates.
ATTACKS_ON_CRATES = what_is_kept_comes_back grids_that_do_not_fit blocks_with_a_valid_hash a_damaged_step_is_told \
	a_kill_between_forgetting every_damaged_brick_is_counted what_does_not_open_is_offered a_change_waits_for_another \
	a_panic_is_told folders_are_made_and_flushed
ATTACKS = hostile:: foreign:: check:: steps:: bombs:: sources:: kill:: safety:: store:: bad_input:: memory:: extraction::the_same_extraction_twice extraction::damaged_candidates

attack: export XDG_STATE_HOME = $(CURDIR)/target/state
attack: export PETROGLYPH_EVERY_STEP = 1
attack: setup
	cargo test --locked --test it -- $(ATTACKS)
	cargo test --locked --workspace --lib -- $(ATTACKS_ON_CRATES)
	PETROGLYPH_MEMORY_SIDE=256 cargo test --locked --test it -- --nocapture memory::

# The same inputs each time, so that a change fails by its own fault alone.
fuzz: setup
	FUZZ_SEED=1 fuzz/run.sh 1

fuzz-long: setup
	fuzz/run.sh 600

bench: build
	$(PETROGLYPH) bench --quick

# What Rust alone does not bring: a C compiler for the compression library, a C++ one for the fuzzer, and a Vulkan driver (Mesa's software
# driver serves where there is no GPU); for the Python package also Python. Skipped at once when all is there.
setup:
	@missing=""; \
	{ command -v cc && command -v c++; } >/dev/null || missing="$$missing build-essential"; \
	PATH="$$PATH:/sbin:/usr/sbin" ldconfig -p 2>/dev/null | grep -q 'libvulkan\.so\.1' || missing="$$missing libvulkan1"; \
	ls /usr/share/vulkan/icd.d /etc/vulkan/icd.d 2>/dev/null | grep -q json || missing="$$missing mesa-vulkan-drivers"; \
	[ -z "$$NEEDS_PYTHON" ] || [ "$$PETROGLYPH_SKIP_PYTHON" = 1 ] || $(PYTHON) -c 'import ensurepip, venv' 2>/dev/null \
		|| missing="$$missing python3-venv"; \
	[ -z "$$missing" ] && exit 0; \
	sudo=""; \
	[ "$$(id -u)" = 0 ] || sudo="sudo"; \
	if command -v apt-get >/dev/null && { [ -z "$$sudo" ] || command -v sudo >/dev/null; }; then \
		echo "installing:$$missing"; \
		$$sudo apt-get update -q && $$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $$missing; \
	else \
		echo "These system packages are missing:$$missing"; \
		echo "On Debian or Ubuntu, as root: apt-get install$$missing"; \
		echo "Elsewhere: a C and C++ compiler, the Vulkan loader, and a Vulkan driver (Mesa's lavapipe serves without a GPU)."; \
		exit 1; \
	fi
