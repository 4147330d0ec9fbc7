#!/bin/sh
# Builds build/RlvLanding.fmu (or the file named as first argument): compiled core + slave, validated by FMPy and landed once.
# Needs nothing but python3 (3.10 to 3.13) and gcc; makes .venv on first use. PYTHON=... names another Python with the packages.
set -eu
cd "$(dirname "$0")"
if [ -z "${PYTHON:-}" ]; then
    PYTHON=.venv/bin/python
    if ! [ -x "$PYTHON" ] || ! "$PYTHON" -c 'import Cython, fmpy, latex2mathml, pythonfmu' 2>/dev/null; then
        make -s .venv/.packages
    fi
fi
"$PYTHON" setup.py -q build_ext --inplace
PYTHONPATH="fmu_src${PYTHONPATH:+:$PYTHONPATH}" exec "$PYTHON" -m fmu_build.build "$@"
