"""The system of three FMUs: connections, and the parameters of a calm and a moving deck."""

from __future__ import annotations

import shutil
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory

from pythonfmu.builder import FmuBuilder

HERE = Path(__file__).resolve().parent
# of a checkout
ROOT = HERE.parent.parent
LANDING = ROOT / "build" / "RlvLanding.fmu"
SLAVES = {"deck": "ship_deck.py", "engine": "engine_tail_off.py"}

# output of a component -> input of another; the rates too, because the ground moves at them within
# a step
CONNECTIONS = {
    **{
        ("deck", name): ("landing", f"ground.{name}")
        for name in ("heave", "heave_rate", "tilt", "tilt_rate")
    },
    **{
        ("engine", name): ("landing", f"external.{name}")
        for name in ("force_x", "force_y", "moment")
    },
}

# a landing burn: at time 0 the vehicle is 0.2 m above the deck, and its engine carries most of its
# weight
DROP = {
    "drop.contact_time": 0.2,
    "drop.vertical_velocity": -2.0,
    "drop.horizontal_velocity": 0.1,
    "drop.tilt": -0.04,
    "drop.pitch_rate": 0.0,
}
MOVING: dict[str, dict[str, float]] = {"landing": DROP, "deck": {}, "engine": {}}
CALM = {**MOVING, "deck": {"heave_amplitude": 0.0, "tilt_amplitude": 0.0}}
DECKS = {"calm": CALM, "moving": MOVING}


def build(folder: Path, landing: Path = LANDING) -> dict[str, Path]:
    """The file of every component; deck and engine are built into `folder`.

    So is the landing's where `landing` is missing, as outside of a checkout.
    """
    if not landing.is_file():
        landing = folder / "RlvLanding.fmu"
        build_landing(landing)
    fmus = {"landing": landing}
    for component, slave in SLAVES.items():
        fmus[component] = Path(
            FmuBuilder.build_FMU(
                HERE / "fmus" / slave, dest=folder, project_files=[HERE / "fmus" / "described.py"]
            )
        )
        add_front(fmus[component])
    return fmus


def build_landing(file: Path) -> None:
    """Build the landing's FMU as `rlv-landing fmu build` does."""
    from fmu_build.build import build as build_fmu
    from fmu_build.wanted import Wanted

    build_fmu(file, Wanted())


def add_front(fmu: Path) -> None:
    """Give an FMU of pythonfmu the C front of RlvLanding.fmu.

    Without it the FMU runs only in hosts that are Python processes.
    """
    from fmu_build.binary import record_libpython, replace_binaries

    with TemporaryDirectory() as folder:
        files = Path(folder) / "files"
        with zipfile.ZipFile(fmu) as archive:
            archive.extractall(files)
        record_libpython(files)
        replace_binaries(files)
        shutil.move(shutil.make_archive(str(Path(folder) / "fmu"), "zip", files), fmu)
