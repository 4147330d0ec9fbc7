"""Reads and recovers mutated copies of a log: mutations.py FILE COUNT SEED FOLDER.

Runs as a process with little memory. Any exception but an error for the user ends it, as does a
case that takes a minute. All that is recovered must be in the log.
"""

from __future__ import annotations

import faulthandler
import json
import random
import resource
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

from log_tools import messages_of

from rlv_landing.errors import LandingError
from rlv_ros_bridge.logs.bag_reader import open_log
from rlv_ros_bridge.logs.info import log_info
from rlv_ros_bridge.logs.recover import recover

MEMORY = 2 * 1024**3


def mutated(data: bytes, generator: random.Random) -> bytes:
    """`data` after random mutations: bits flipped, bytes inserted, removed or repeated, a cut."""
    mutant = bytearray(data)
    for _ in range(generator.choice((1, 1, 1, 2, 4))):
        at = generator.randrange(len(mutant))
        length = generator.choice((1, 2, 9, 100, 3000))
        kind = generator.randrange(6)
        if kind == 0:
            mutant[at] ^= 1 << generator.randrange(8)
        elif kind == 1:
            mutant[at:at] = generator.randbytes(length)
        elif kind == 2 and len(mutant) > length:
            del mutant[at : at + length]
        elif kind == 3:
            mutant[at:at] = mutant[at : at + length]
        elif kind == 4:
            mutant[at : at + 8] = generator.choice((2**63, 2**40, 2**31, 0)).to_bytes(8, "little")
        elif len(mutant) > 1000:
            del mutant[at:]
    return bytes(mutant)


def attempt(action: Callable[[Path], str], path: Path) -> bool:
    """Whether the action was done; false if it was refused in one line."""
    try:
        return bool(action(path))
    except LandingError as e:
        if "\n" in str(e):
            raise RuntimeError(f"an error of more than one line: {e}") from e
        return False


def main(file: Path, count: int, seed: int, folder: Path) -> dict[str, int]:
    """The number of cases, and of those that were read and recovered."""
    original = file.read_bytes()
    wanted = set(messages_of(file))
    counts = {"cases": 0, "read": 0, "recovered": 0}
    for case in range(count):
        faulthandler.dump_traceback_later(60.0, exit=True)
        generator = random.Random(f"{seed}-{case}")
        source, target = folder / "mutated", folder / "mutated-recovered"
        for path in (source, target):
            shutil.rmtree(path, ignore_errors=True)
        source.mkdir()
        (source / f"run_0{generator.choice(('.mcap', '.mcap.part'))}").write_bytes(
            mutated(original, generator)
        )
        counts["cases"] += 1
        counts["read"] += attempt(lambda path: log_info(open_log(path)).text(), source)
        counts["recovered"] += attempt(lambda path: recover(path).text(), source)
        if target.exists():
            foreign = set(messages_of(target / "mutated-recovered_0.mcap")) - wanted
            assert not foreign, f"case {case}: {len(foreign)} messages are not in the log"
    faulthandler.cancel_dump_traceback_later()
    return counts


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    print(
        json.dumps(main(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]), Path(sys.argv[4])))
    )
