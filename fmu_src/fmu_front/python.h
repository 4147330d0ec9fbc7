/* A running Python in this process, for pythonfmu's binary to use. */
#ifndef PYTHON_H
#define PYTHON_H

#include "text.h"

/*
 * Make sure that this process has a running Python 3.10 or newer; `resources` is the FMU's folder of that name.
 *
 * The host's own Python, if it has one, is used. Else libpython is looked for: in the file that RLV_LANDING_LIBPYTHON names; in the one
 * recorded when the FMU was built (resources/libpython.txt); under the usual names; where Python is installed (that of the `python3`
 * of PATH; Windows: of the registry). It is opened for all,
 * started without signal handlers, environment and site-packages (the slave needs none, and a .pth there can restart the process), and
 * never finalised: Python cannot be started again in the same process.
 *
 * Returns false with the reason in `reason` if there is none.
 */
bool python_ready(const char *resources, struct message *reason);

/* Hand an interrupt (Ctrl-C) that the slave caught on to the host's Python. */
void python_interrupt(void);

#endif
