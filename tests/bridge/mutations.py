"""Reads and recovers mutated copies of a log, in a process of its own with little memory:
mutations.py FILE COUNT SEED FOLDER.

Any exception but an error for the user ends it, as does a case that takes a minute. What is
recovered must be in the log.
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
    """`data` with one to four bits flipped, bytes put in, taken out, repeated, or made a huge
    length; or cut.
    """
    spoilt = bytearray(data)
    for _ in range(generator.choice((1, 1, 1, 2, 4))):
        at = generator.randrange(len(spoilt))
        length = generator.choice((1, 2, 9, 100, 3000))
        kind = generator.randrange(6)
        if kind == 0:
            spoilt[at] ^= 1 << generator.randrange(8)
        elif kind == 1:
            spoilt[at:at] = generator.randbytes(length)
        elif kind == 2 and len(spoilt) > length:
            del spoilt[at : at + length]
        elif kind == 3:
            spoilt[at:at] = spoilt[at : at + length]
        elif kind == 4:
            spoilt[at : at + 8] = generator.choice((2**63, 2**40, 2**31, 0)).to_bytes(8, "little")
        elif len(spoilt) > 1000:
            del spoilt[at:]
    return bytes(spoilt)


def attempt(action: Callable[[Path], str], path: Path) -> bool:
    """Whether it was done, or refused in one line."""
    try:
        return bool(action(path))
    except LandingError as e:
        if "\n" in str(e):
            raise RuntimeError(f"an error of more than one line: {e}") from e
        return False


def main(file: Path, count: int, seed: int, folder: Path) -> dict[str, int]:
    """How many cases there were, and what became of them."""
    original = file.read_bytes()
    wanted = set(messages_of(file))
    told = {"cases": 0, "read": 0, "recovered": 0}
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
        told["cases"] += 1
        told["read"] += attempt(lambda path: log_info(open_log(path)).text(), source)
        told["recovered"] += attempt(lambda path: recover(path).text(), source)
        if target.exists():
            invented = set(messages_of(target / "mutated-recovered_0.mcap")) - wanted
            assert not invented, f"case {case}: {len(invented)} messages are not in the log"
    faulthandler.cancel_dump_traceback_later()
    return told


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    print(
        json.dumps(main(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]), Path(sys.argv[4])))
    )
