/* The Python that pythonfmu's binary uses in this process. */
#ifndef PYTHON_H
#define PYTHON_H

#include "text.h"

/*
 * Start Python 3.10 or newer in this process unless it runs; `resources` is the FMU's folder of
 * that name.
 *
 * A Python that the process has is used. Else libpython is looked for, in this order:
 *   1. the file that RLV_LANDING_LIBPYTHON names;
 *   2. the file recorded when the FMU was built (resources/libpython.txt);
 *   3. the usual names, by the loader;
 *   4. an installed Python: the `python3` of PATH; on Windows, the registry.
 *
 * It is opened with global symbols and started without signal handlers, environment and
 * site-packages: the slave needs none of them, and a .pth file can restart the process. It is never
 * finalised, because Python cannot be started again in the same process.
 *
 * Returns false with the reason if there is none.
 */
bool python_ready(const char *resources, struct message *reason);

/* Raise in the importer's Python an interrupt (Ctrl-C) that arrived while the slave ran. */
void interrupt_python(void);

#endif
