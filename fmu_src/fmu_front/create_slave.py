"""Makes the slave in Python. The front (slave.c) contains this text and calls `create`."""

import os
import sys
from importlib import import_module


def create(folder, module, name, visible, pure):
    """A slave of the class that the script `module` in `folder` defines.

    It is the class derived from pythonfmu's `Fmi2Slave` through the most classes, as pythonfmu's
    builder chooses it. `folder` is on Python's path during the import only. `pure` imports without
    the compiled core.
    """
    sys.path.insert(0, folder)
    wanted = os.environ.get("RLV_LANDING_PURE")
    if pure:
        os.environ["RLV_LANDING_PURE"] = "1"
    try:
        found = vars(import_module(module)).values()
    finally:
        if folder in sys.path:
            sys.path.remove(folder)
        sys.path_importer_cache.pop(folder, None)
        if pure and wanted is None:
            del os.environ["RLV_LANDING_PURE"]
    slaves = [
        c
        for c in found
        if isinstance(c, type)
        and "Fmi2Slave" in [base.__name__ for base in c.__mro__[1:]]
        and not getattr(c, "__abstractmethods__", None)
    ]
    if not slaves:
        raise TypeError(f"{module}.py has no class derived from Fmi2Slave")
    chosen = max(slaves, key=lambda c: len(c.__mro__))
    return chosen(instance_name=name, resources=folder, visible=visible)
