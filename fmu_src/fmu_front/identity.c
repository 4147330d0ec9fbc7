/*
 * What makes this front that of one FMU: its names, its GUID and its variables.
 *
 * It stands in a file of its own, so that no compiler puts it into the code of the others: the
 * build writes another identity into a front that was compiled before (fmu_build/fronts/prebuilt.py).
 */
#include "variables.h"

const struct identity IDENTITY = {IDENTITY_VALUES};
