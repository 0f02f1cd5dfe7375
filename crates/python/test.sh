#!/usr/bin/env bash
# Tests the Python package: the extension that `cargo test --workspace` has built goes into a wheel, the wheel into a virtual
# environment under target/, and there run pytest, mypy --strict and the notebooks.
#
#   crates/python/test.sh [PYTEST_ARGUMENTS]
#
# `make test-python` installs Python where it is missing and may. PETROGLYPH_SKIP_PYTHON=1, which CI never sets, skips it.
set -euo pipefail
cd "$(dirname "$0")/../.."

if [ "${PETROGLYPH_SKIP_PYTHON:-}" = 1 ]; then
    echo "PETROGLYPH_SKIP_PYTHON is set: the Python package is not tested." >&2
    exit 0
fi
python="${PYTHON:-python3}"
environment=target/python/venv

if ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then
    echo "error: Python with its module venv is missing" >&2
    echo "hint: as root on Debian: apt-get install python3-venv; PETROGLYPH_SKIP_PYTHON=1 goes on without it" >&2
    exit 1
fi

# Built by `make test` already; where it was not, all of it is built as the tests need it.
cargo test --workspace --locked --no-run --quiet
[ -x "$environment/bin/python" ] || "$python" -m venv "$environment"
"$environment/bin/python" -m pip install --quiet --disable-pip-version-check -r crates/python/requirements-test.txt
rm -rf target/python/wheel
wheel=$("$environment/bin/python" crates/python/assemble_wheel.py target/debug/deps/libpetroglyph_native.so target/python/wheel)
"$environment/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --force-reinstall "$wheel"

# From elsewhere, so that the installed package is tested and not its sources.
root="$PWD"
cd target/python
export XDG_STATE_HOME="$PWD/state" PETROGLYPH_PROGRAM="$root/target/debug/petroglyph"
venv/bin/python -m mypy --config-file "$root/pyproject.toml" -p petroglyph
venv/bin/python -m pytest -c "$root/pyproject.toml" --rootdir "$root" -p no:cacheprovider -q "$root/crates/python/tests" "$@"
