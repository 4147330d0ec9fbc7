"""A newcomer's commands one after the other, in this process; none may warn.

Called with the lines of a file: each is the arguments of `rlv-landing`.
"""

from __future__ import annotations

import contextlib
import io
import shlex
import sys
from pathlib import Path

from rlv_landing.cli import main

for line in Path(sys.argv[1]).read_text().splitlines():
    sys.argv = ["rlv-landing", *shlex.split(line)]
    said, warned = io.StringIO(), io.StringIO()
    code: object = 0
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(warned):
        try:
            main()
        except SystemExit as e:
            code = e.code
    print(said.getvalue(), end="")
    if code or warned.getvalue():
        sys.exit(f"rlv-landing {line}: {code}\n{warned.getvalue()}")
