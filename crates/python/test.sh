#!/usr/bin/env bash
# Tests the Python package: its sources and the extension that `cargo test --workspace` has built go into a virtual environment
# under target/, and there run pytest, mypy --strict and the notebooks.
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
installed=$("$environment/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
rm -rf "$installed/petroglyph"
cp -r crates/python/python/petroglyph "$installed"
cp target/debug/deps/libpetroglyph_native.so "$installed/petroglyph/_native.abi3.so"
"$environment/bin/python" crates/python/stub.py "$installed"

# From elsewhere, so that the installed package is tested and not its sources.
root="$PWD"
cd target/python
export XDG_STATE_HOME="$PWD/state" PETROGLYPH_PROGRAM="$root/target/debug/petroglyph"
venv/bin/python -m mypy --config-file "$root/pyproject.toml" -p petroglyph
venv/bin/python -m pytest -c "$root/pyproject.toml" --rootdir "$root" -p no:cacheprovider -q "$root/crates/python/tests" "$@"
