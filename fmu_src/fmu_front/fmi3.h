/* What the files of FMI 3.0 share. */
#ifndef FMI3_H
#define FMI3_H

#include "fmi3Functions.h"
#include "instance.h"

/*
 * Sets of phases of FMI 3.0, in which variables may be set, may be read, and in which functions may
 * be called that are allowed in every mode but Intermediate Update Mode.
 */
enum {
    SETTABLE = BEFORE_STEPS | STEPPING | EVENT_MODE | UPDATING,
    READABLE = ANY | EVENT_MODE | UPDATING,
    ANY_MODE = ANY | EVENT_MODE
};

/* The host's callbacks, and whether it allows early return. */
struct fmi3_host {
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
    fmi3IntermediateUpdateCallback update;
    bool early_return;
};

/* Check that all these variables may be used in intermediate updates; log an error if not. */
bool fmi3_check_intermediate(const struct instance *c, const struct function *f,
                             const fmi3ValueReference vr[], size_t n);

/* Refuse to get or set values of a type that no variable has; a call for no variables is OK. */
fmi3Status fmi3_refuse_type(struct instance *c, const char *name, const fmi3ValueReference vr[],
                            size_t n, size_t n_values);

#endif
