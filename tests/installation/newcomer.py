"""A newcomer's commands one after the other, in this process; none may warn.

Called with the lines of a file: each is the arguments of `rlv-landing`.
"""

from __future__ import annotations

import contextlib
import shlex
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryFile

from rlv_landing.cli import main

temporary_text = partial(TemporaryFile, "w+", encoding="utf-8")

for line in Path(sys.argv[1]).read_text().splitlines():
    sys.argv = ["rlv-landing", *shlex.split(line)]
    code: object = 0
    # files, as the node asks for their numbers
    with temporary_text() as said, temporary_text() as warned:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(warned):
            try:
                main()
            except SystemExit as e:
                code = e.code
        said.seek(0)
        warned.seek(0)
        print(said.read(), end="")
        warning = warned.read()
    if code or warning:
        sys.exit(f"rlv-landing {line}: {code}\n{warning}")
