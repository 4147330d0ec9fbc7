"""`rlv-landing audit`: what a landing conserves, where it ends, how exact it is."""

from __future__ import annotations

import json

import click

from ..errors import LandingError
from .options import choose, parameter_options

FAILED = 1


@click.command()
@click.argument("name", metavar="[PRESET]", required=False)
@parameter_options
@click.option("--json", "as_json", is_flag=True, help="Print as JSON.")
def audit(
    name: str | None,
    preset: str | None,
    file: str | None,
    mode: str | None,
    pairs: tuple[str, ...],
    as_json: bool,
) -> int:
    """Audit a preset (default yue2022-figures) or a parameter file: energy term by term, liquid
    mass, momentum, rest, convergence.

    Energy, mass and rest are audited on a slope of 5 deg and under a steady side load of a tenth of
    the weight as well. Momentum is audited in free flight and in contact, against the integral of
    contact forces and weight. Every value is held against a bound that is printed with its reason. Both drop tests
    unless --mode names one. Exit code 1 when a bound is missed.

    \b
    rlv-landing audit yue2022-figures
    rlv-landing audit --parameters mine.toml --mode 2-2 --json
    """
    from ..tables.study_tables import audit_tables, missed_lines
    from ..validation.audit import audit as run

    if name is not None and preset is not None:
        raise LandingError(f"the preset is named twice, {name} and --preset {preset}; name it once")
    parameters, modes, label = choose(name or preset, file, mode, pairs)
    audits = run(parameters, modes)
    missed = missed_lines(audits)
    if as_json:
        record = {
            "parameters": label,
            "passed": not missed,
            "missed": missed,
            "audits": [a.record() for a in audits],
        }
        click.echo(json.dumps(record, indent=1, allow_nan=False))
    else:
        click.echo(audit_tables(audits), nl=False)
    for line in missed:
        click.echo(f"missed: {line}", err=True)
    return FAILED if missed else 0
