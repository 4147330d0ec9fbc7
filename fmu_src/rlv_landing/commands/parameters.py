"""`rlv-landing parameters`: the tables of parameters, inputs and outputs."""

from __future__ import annotations

import json

import click

from .options import parameter_options


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@parameter_options
@click.option("--toml", is_flag=True, help="As a TOML file that --parameters takes back.")
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
@click.option("--inputs", "what", flag_value="inputs", help="List the inputs instead.")
@click.option("--outputs", "what", flag_value="outputs", help="List the outputs instead.")
def parameters(
    preset: str | None,
    file: str | None,
    mode: str | None,
    pairs: tuple[str, ...],
    toml: bool,
    as_json: bool,
    what: str | None,
) -> None:
    """Print the table of parameters: value, unit, bounds, where it comes from (paper, derived,
    closure, identified), meaning.

    \b
    rlv-landing parameters --preset yue2022-table2 --mode 1-2-1
    rlv-landing parameters --toml > mine.toml
    """
    from ..choices import choose_parameters, parse_pairs
    from ..parameters import PARAMETER_QUANTITIES
    from ..presets import to_toml
    from ..quantities import INPUT_QUANTITIES, OUTPUT_QUANTITIES
    from ..tables.landing import parameter_records, parameter_table, quantity_table

    if what is not None:
        quantities = INPUT_QUANTITIES if what == "inputs" else OUTPUT_QUANTITIES
        if as_json:
            click.echo(
                json.dumps(
                    [{"name": q.name, "unit": q.unit, "meaning": q.meaning} for q in quantities],
                    indent=1,
                )
            )
        else:
            click.echo(quantity_table(what, quantities), nl=False)
        return
    chosen = choose_parameters(
        preset, file, mode, parse_pairs(pairs, PARAMETER_QUANTITIES, "parameter")
    )
    if toml:
        click.echo(to_toml(chosen), nl=False)
    elif as_json:
        click.echo(json.dumps(parameter_records(chosen), indent=1))
    else:
        click.echo(parameter_table(chosen), nl=False)
