/* Instances: create, set up, initialise, step, terminate, reset, free. */
#include "instance.h"
#include "python.h"
#include "resources.h"
#include "variables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool create_slave(struct instance *c)
{
    const struct listener listener = {log_from_slave, c};
    c->worst_status = STATUS_OK;
    c->slave = slave_create(c->resources, c->name, c->visible, &listener);
    c->phase = c->slave ? INSTANTIATED : SLAVE_LOST;
    c->last_time = 0.0;
    c->last_step = STATUS_OK;
    return c->slave != NULL;
}

static char *copy_of(const char *text)
{
    char *copy = malloc(strlen(text) + 1);
    return copy ? strcpy(copy, text) : NULL;
}

static bool find_resources(struct instance *c, const char *location)
{
    char folder[PATH_SIZE];
    if (!resources_of_uri(location, folder)) {
        const char *given = location ? location : "NULL";
        if (!resources_of_library(folder)) {
            log_message(c, STATUS_ERROR,
                        "the location of the FMU's resources, %.3000s, does not lead to them (no "
                        "%s.py there), and they are not beside the folder of its binary",
                        given, SLAVE_MODULE);
            return false;
        }
        log_message(c, STATUS_WARNING,
                    "the location of the FMU's resources, %.1900s, does not lead to them; %.1900s is "
                    "taken",
                    given, folder);
    }
    c->resources = copy_of(folder);
    return c->resources != NULL;
}

static bool start_python(struct instance *c)
{
    static const char in_this_library;
    struct message reason = {""};
    if (is_in_own_namespace(&in_this_library)) {
        log_message(c, STATUS_ERROR,
                    "this library was loaded to a namespace of its own (dlmopen), in which Python "
                    "does not work; load it with dlopen");
        return false;
    }
    lock_process();
    bool ready = python_ready(c->resources, &reason);
    unlock_process();
    if (!ready)
        log_message(c, STATUS_ERROR, "%s", reason.text);
    return ready;
}

struct instance *instance_create(const struct host *host, const char *name, const char *location,
                                 bool visible)
{
    struct instance *c = calloc(1, sizeof *c);
    if (!c)
        return NULL;
    c->host = *host;
    c->visible = visible;
    c->name = copy_of(name);
    c->outputs = calloc(VARIABLE_COUNT, sizeof *c->outputs);
    if (c->name && c->outputs && find_resources(c, location) && start_python(c) && create_slave(c))
        return c;
    instance_free(c);
    return NULL;
}

void instance_free(struct instance *c)
{
    free_states_of(c);
    if (c->slave)
        slave_free(c->slave);
    free(c->numbers);
    free(c->outputs);
    free(c->resources);
    free(c->name);
    free(c);
}

enum status instance_set_logging(struct instance *c, const struct function *f, bool logging,
                                 size_t n, const char *const categories[])
{
    if (!enter_call(c, f) || (n && !require(c, f, "categories", categories)))
        return STATUS_ERROR;
    unsigned chosen = 0;
    for (size_t i = 0; i < n; i++) {
        int index = categories[i] ? category_index(categories[i]) : -1;
        if (index >= 0) {
            chosen |= 1u << index;
            continue;
        }
        c->worst_status = STATUS_WARNING;
        log_message(c, STATUS_WARNING, "%s: %.100s is no log category of this FMU", f->name,
                    categories[i] ? categories[i] : "NULL");
    }
    /* if none of them exists, none is logged */
    const unsigned none = ~0u << sizeof CATEGORIES / sizeof *CATEGORIES;
    c->host.logging = logging;
    c->host.categories = n && !chosen ? none : chosen;
    return c->worst_status;
}

enum status instance_setup(struct instance *c, const struct function *f, double start,
                           const double *stop, const double *tolerance)
{
    if (!enter_call(c, f))
        return STATUS_ERROR;
    if (!isfinite(start)) {
        log_message(c, STATUS_ERROR, "%s: startTime = %g s must be finite", f->name, start);
        return STATUS_ERROR;
    }
    enum status status = leave_call(c, slave_setup(c->slave, start, stop, tolerance));
    if (status < STATUS_ERROR)
        c->last_time = start;
    return status;
}

enum status instance_enter_initialization(struct instance *c, const struct function *f)
{
    if (!enter_call(c, f))
        return STATUS_ERROR;
    enum status status = leave_call(c, slave_enter_initialization(c->slave));
    if (status < STATUS_ERROR)
        c->phase = INITIALIZING;
    return status;
}

enum status instance_exit_initialization(struct instance *c, const struct function *f)
{
    if (!enter_call(c, f))
        return STATUS_ERROR;
    enum status status = leave_call(c, slave_exit_initialization(c->slave));
    if (status < STATUS_ERROR) /* else the host may set other values and try again */
        c->phase = c->host.event_mode ? EVENT_MODE : STEPPING;
    return status;
}

enum status instance_step(struct instance *c, const struct function *f, double time, double step)
{
    if (!enter_call(c, f))
        return STATUS_ERROR;
    enum status status = leave_call(c, slave_step(c->slave, time, step));
    if (status < STATUS_DISCARD)
        c->last_time = time + step;
    c->last_step = status;
    return status;
}

enum status instance_step_part(struct instance *c, const struct function *f, double time,
                               double end, double stop, bool to_event, bool *event)
{
    struct part part = {.stop = stop < end ? stop : INFINITY, .to_event = to_event};
    *event = false;
    if (!enter_call(c, f))
        return STATUS_ERROR;
    enum status status = leave_call(c, slave_step_part(c->slave, time, end - time, &part));
    if (status < STATUS_DISCARD) {
        c->last_time = part.reached < end ? part.reached : end;
        *event = part.event;
    }
    c->last_step = status;
    return status;
}

enum status instance_terminate(struct instance *c, const struct function *f)
{
    if (!enter_call(c, f))
        return STATUS_ERROR;
    enum status status = leave_call(c, slave_terminate(c->slave));
    if (c->phase != SLAVE_LOST)
        c->phase = TERMINATED;
    return status;
}

enum status instance_reset(struct instance *c, const struct function *f)
{
    if (!enter_call(c, f))
        return STATUS_ERROR;
    if (c->slave)
        slave_free(c->slave);
    c->slave = NULL;
    c->phase = SLAVE_LOST;
    return start_python(c) && create_slave(c) ? STATUS_OK : STATUS_ERROR;
}
