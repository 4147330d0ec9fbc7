"""`rlv-landing audit`: conservation, rest state and convergence of a landing."""

from __future__ import annotations

from typing import Any

import click

from ..errors import LandingError
from .options import choose, json_option, parameter_options
from .printing import print_checked


@click.command()
@click.argument("name", metavar="[PRESET]", required=False)
@parameter_options
@json_option()
def audit(name: str | None, *, as_json: bool, **choice: Any) -> int:
    """Audit energy, liquid mass, momentum, rest and convergence of a landing.

    It takes a preset (default yue2022-figures) or a parameter file. Energy, mass and rest are also
    audited on a slope of 5 deg and under a steady side load of a tenth of the weight. Momentum is
    audited in free flight and in contact, against the integral of contact forces and weight. Every
    value has a bound, which is printed with its reason. Both drop tests are audited unless --mode
    names one, or the parameters are of a landing in space. The exit code is 1 when a bound is
    missed.

    \b
    rlv-landing audit yue2022-figures
    rlv-landing audit --parameters mine.toml --mode 2-2 --json
    """
    from ..audit.audit import audit as run
    from ..tables.study_tables import audit_tables, missed_lines

    if name is not None:
        if choice["preset"] is not None:
            raise LandingError(
                f"the preset is named twice, {name} and --preset {choice['preset']}; name it once"
            )
        choice["preset"] = name
    parameters, modes, label = choose(**choice)
    audits = run(parameters, modes)
    missed = missed_lines(audits)
    record = {
        "parameters": label,
        "passed": not missed,
        "audits": [a.record() for a in audits],
    }
    return print_checked(record, lambda: audit_tables(audits), missed, as_json=as_json)
