"""`rlv-landing parameters`: the tables of parameters, inputs and outputs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ..errors import LandingError
from .options import HELP_NAMES, chosen_parameters, json_option, parameter_options
from .printing import print_json

if TYPE_CHECKING:
    from ..parameters import Parameters


@click.command(context_settings=HELP_NAMES)
@parameter_options
@click.option("--origin", is_flag=True, help="Where each value comes from: file, preset, --set.")
@click.option("--toml", is_flag=True, help="As a TOML file that --parameters takes back.")
@json_option()
@click.option("--inputs", "what", flag_value="inputs", help="List the landing's inputs instead.")
@click.option("--outputs", "what", flag_value="outputs", help="List the landing's outputs instead.")
def parameters(*, origin: bool, toml: bool, as_json: bool, what: str | None, **choice: Any) -> None:
    """Print every parameter with its value, unit, bounds, source and meaning.

    The source is paper, derived, closure or identified. Inputs and outputs are those of the
    landing that the options choose: in space there are more, for each leg.

    \b
    rlv-landing parameters --preset yue2022-table2 --mode 1-2-1
    rlv-landing parameters --toml > mine.toml
    rlv-landing parameters --parameters mine.toml --origin
    rlv-landing parameters --mode space --inputs
    """
    from ..choices import split_pair
    from ..presets import origins, to_toml
    from ..tables.landing import origin_table, parameter_records, parameter_table
    from ..text.files import pipes_kept

    if what is not None and (origin or toml):
        raise LandingError(
            f"--{what} lists names, which have no {'origin' if origin else 'TOML file'}; "
            f"leave --{'origin' if origin else 'toml'} out"
        )
    with pipes_kept():
        chosen = chosen_parameters(**choice)
        if what is not None:
            _print_quantities(what, chosen, as_json=as_json)
            return
        found = origins(choice["file"], choice["preset"], chosen.drop.mode) if origin else {}
    if origin:
        found.update({split_pair(pair, "parameter")[0]: "--set" for pair in choice["pairs"]})
        found["drop.mode"] = "--mode" if choice["mode"] else found["drop.mode"]
        if as_json:
            print_json([r | {"origin": found[r["name"]]} for r in parameter_records(chosen)])
        else:
            click.echo(origin_table(chosen, found), nl=False)
    elif toml:
        click.echo(to_toml(chosen), nl=False)
    elif as_json:
        print_json(parameter_records(chosen))
    else:
        click.echo(parameter_table(chosen), nl=False)


def _print_quantities(what: str, chosen: Parameters, *, as_json: bool) -> None:
    from ..tables.landing import quantity_table

    interface = chosen.interface
    quantities = interface.inputs if what == "inputs" else interface.outputs
    if as_json:
        print_json([{"name": q.name, "unit": q.unit, "meaning": q.meaning} for q in quantities])
    else:
        click.echo(quantity_table(what, quantities), nl=False)
