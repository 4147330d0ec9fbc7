"""The picture: deck motion, strokes, forces and pitch over time, on a calm and on a moving deck."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from rlv_landing.figures.style import COLOURS

OF_DECKS = {"calm": COLOURS[2], "moving": COLOURS[0]}
STYLES = {1: "-", 3: "--"}


def save_picture(results: dict[str, dict[str, np.ndarray]], path: Path) -> None:
    """Write the picture of `results` (name of the deck -> columns) to `path`.

    Solid: legs 1 and 2, dashed: legs 3 and 4.
    """
    figure = Figure(figsize=(10.0, 11.0), layout="constrained")
    axes = figure.subplots(5, 1, sharex=True)
    for name, result in results.items():
        time, colour = result["time"], OF_DECKS[name]
        axes[0].plot(time, result["deck.heave"] * 1e3, color=colour, label=f"{name} deck")
        axes[1].plot(time, result["landing.body.y"] - result["deck.heave"], color=colour)
        for leg, style in STYLES.items():
            axes[2].plot(
                time,
                result[f"landing.leg[{leg}].main_strut.stroke"] * 1e3,
                color=colour,
                linestyle=style,
            )
            axes[3].plot(
                time,
                result[f"landing.leg[{leg}].main_strut.force"] / 1e3,
                color=colour,
                linestyle=style,
            )
        axes[4].plot(time, np.degrees(result["landing.body.pitch"]), color=colour)
        axes[4].plot(time, np.degrees(result["deck.tilt"]), color=colour, linestyle=":")
    axes[3].plot(
        time, result["engine.force_y"] / 1e3, color=COLOURS[1], linewidth=1.0, label="thrust"
    )
    labels = (
        "heave of\nthe deck [mm]",
        "CG above\nthe deck [m]",
        "main strut stroke\n[mm]",
        "main strut force\nand thrust [kN]",
        "pitch; dotted:\ntilt of the deck [deg]",
    )
    for ax, label in zip(axes, labels):
        ax.set_ylabel(label)
        ax.grid(visible=True, linewidth=0.3)
        ax.margins(x=0.0)
    axes[0].set_title("Engine tail-off and touchdown on a calm and on a moving deck", loc="left")
    axes[0].legend(loc="lower left", frameon=False)
    axes[3].legend(loc="lower right", frameon=False)
    axes[-1].set_xlabel(
        "time [s]   (solid: legs 1 and 2, dashed: legs 3 and 4; forces negative in compression)"
    )
    figure.savefig(path, dpi=110)
