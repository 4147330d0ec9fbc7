"""Land on a calm and on a moving deck.

FMPy and Ecos run the same system of three FMUs. Their results are compared and drawn.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

import click
import numpy as np
import ssp
import system
from master import Parameters, simulate
from picture import save_picture
from tqdm import tqdm

LEGS = (1, 2, 3, 4)


@click.command(help=__doc__)
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("build/ship_deck"),
    show_default=True,
    help="Folder for the FMUs, the SSP files, the results as CSV, and the picture.",
)
@click.option(
    "--until",
    type=click.FloatRange(0.8, 60.0),
    default=3.0,
    show_default=True,
    help="Duration [s].",
)
@click.option(
    "--step",
    type=click.FloatRange(1e-5, 1e-2),
    default=1e-3,
    show_default=True,
    help="Communication step [s].",
)
@click.option(
    "--picture",
    type=click.Path(dir_okay=False, path_type=Path),
    help="The picture's file  [default: ship_deck.png in --out]",
)
def main(out: Path, until: float, step: float, picture: Path | None) -> None:
    """Build the FMUs, run both decks and draw them."""
    out.mkdir(parents=True, exist_ok=True)
    picture = picture or out / "ship_deck.png"
    fmus = system.build(out)
    results = {
        name: run(name, parameters, fmus, out, until, step)
        for name, parameters in system.DECKS.items()
    }
    save_picture(results, picture)
    click.echo(f"wrote {picture}, and FMUs, SSP files and results in {out}")


def run(
    name: str, parameters: Parameters, fmus: dict[str, Path], out: Path, until: float, step: float
) -> dict[str, np.ndarray]:
    """Land on one deck by FMPy and by Ecos; return FMPy's result.

    Both results and the SSP file go to `out`, and a summary is printed.
    """
    with tqdm(
        total=2.0 * until, desc=f"{name} deck", bar_format="{l_bar}{bar}| {n:.2f} of {total:.2f} s"
    ) as bar:
        result = simulate(
            fmus, system.CONNECTIONS, parameters, step, until, lambda time: bar.update(time - bar.n)
        )
        ssp.write(out / f"{name}.ssp", fmus, system.CONNECTIONS, parameters, until)
        columns = [column for column in result if column != "time"]
        again = ssp.run_in_ecos(
            out / f"{name}.ssp", columns, step, until, lambda time: bar.update(until + time - bar.n)
        )
    for table, importer in ((result, "fmpy"), (again, "ecos")):
        rows = np.array(list(table.values())).T
        np.savetxt(
            out / f"{name}-{importer}.csv",
            rows,
            fmt="%.12g",
            delimiter=",",
            header=",".join(table),
            comments="",
        )
    click.echo(summary(name, result, again))
    return result


def difference(one: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> tuple[float, str]:
    """Largest difference of two results, and the name of that quantity.

    The difference is in parts of the quantity's largest value.
    """
    parts = (
        (float(np.abs(one[name] - other[name]).max() / (np.abs(one[name]).max() or 1.0)), name)
        for name in one
    )
    return max(parts)


def summary(name: str, result: dict[str, np.ndarray], again: dict[str, np.ndarray]) -> str:
    """Two lines that summarise a landing."""
    touching = np.any([result[f"landing.leg[{leg}].contact.force_y"] > 0.0 for leg in LEGS], axis=0)
    if not touching.any():
        return (
            f"{name} deck: no footpad has touched it by {result['time'][-1]:g} s; "
            "take a longer --until"
        )
    first = int(np.argmax(touching))
    speed = result["deck.heave_rate"][first - 1] - result["landing.body.vy"][first - 1]
    force = -min(result[f"landing.leg[{leg}].main_strut.force"].min() for leg in LEGS)
    stroke = max(result[f"landing.leg[{leg}].main_strut.stroke"].max() for leg in LEGS)
    apart, where = difference(result, again)
    compared = (
        f"differ by {apart:.1e} of the largest value of {where}"
        if apart > 0.0
        else "give the same digits"
    )
    return (
        f"{name} deck: touches at {result['time'][first]:.3f} s "
        f"with {speed:.2f} m/s relative to the deck; "
        f"main struts up to {force:.0f} N and {1e3 * stroke:.1f} mm\n"
        f"  FMPy and Ecos {compared}"
    )


if __name__ == "__main__":
    try:
        main()
    except SystemExit as end:
        # Ecos' task library (TBB) races with the end of the process: a thread of it unloads
        # libraries that the main thread's finalisers still call. All files are closed here.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(end.code if isinstance(end.code, int) else 1)
