#!/bin/sh
# Builds build/RlvLanding.fmu, or the file that an argument names, and checks it with FMPy.
# With `--fmi 3` it is an FMU of FMI 3.0, build/RlvLanding3.fmu.
# Needs python3 (3.10 to 3.13), and makes .venv on first use. PYTHON=... names another Python that
# has the packages. `--pure` builds without the compiled core; `--help` says more.
set -eu
for option; do
    case $option in
        --pure | -h | --help) CORE=none ;;
    esac
done
cd "$(dirname "$0")"
if [ -z "${PYTHON:-}" ]; then
    PYTHON=.venv/bin/python
    needed='import Cython, fmpy, latex2mathml, pythonfmu'
    if ! [ -x "$PYTHON" ] || ! "$PYTHON" -c "$needed" 2>/dev/null; then
        make -s .venv/.packages
    fi
fi
[ "${CORE:-}" = none ] || "$PYTHON" setup.py -q build_ext --inplace
PYTHONPATH="fmu_src${PYTHONPATH:+:$PYTHONPATH}" exec "$PYTHON" -m fmu_build.build "$@"
