/* Finds the FMU's folder `resources`. */
#ifndef RESOURCES_H
#define RESOURCES_H

#include "platform.h"

/*
 * Write the folder that a URI or a path names.
 *
 * Takes file:///..., file:/..., file://..., in any case, every percent-escape, names that are not
 * escaped, and the folder above the resources. Returns false if the script of this build is not
 * there.
 */
bool resources_of_uri(const char *uri, char folder[PATH_SIZE]);

/* Write the resources of the FMU that holds this library. Returns false if they are not there. */
bool resources_of_library(char folder[PATH_SIZE]);

#endif
