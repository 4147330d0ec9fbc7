/* Instances: instantiate, set up, initialise, terminate, reset, free; debug logging. */
#include "front.h"
#include "python.h"
#include "variables.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return fmi2Version;
}

static void release_instance(struct instance *c)
{
    if (c->resource_link[0])
        unlink_folder(c->resource_link);
    free(c->location);
    free(c->name);
    free(c);
}

/* Find the resources and set `location`, under a path that pythonfmu's binary can take. */
static bool set_location(struct instance *c, const char *uri, char folder[PATH_SIZE])
{
    if (!resource_folder_of_uri(uri, folder)) {
        log_message(
            c, fmi2Error,
            "fmuResourceLocation does not name the FMU's resources (no slavemodule.txt there): %s",
            uri);
        return false;
    }
    const char *path = folder;
    if (!is_plain(folder))
        shorten_path(folder);
    if (!is_plain(folder)) {
        if (!link_folder(folder, c->resource_link)) {
            c->resource_link[0] = '\0';
            log_message(c, fmi2Error, "cannot make a link to %s in the temporary folder: %s",
                        folder, strerror(errno));
            return false;
        }
        path = c->resource_link;
    }
    c->location = malloc(strlen(path) + 9);
    if (c->location)
        sprintf(c->location, "file://%s%s", path[0] == '/' ? "" : "/",
                path); /* C:/... on Windows */
    return c->location != NULL;
}

static bool create_slave(struct instance *c)
{
    c->worst_status = fmi2OK;
    c->slave = pythonfmu.Instantiate(c->name, fmi2CoSimulation, GUID, c->location,
                                     &c->own_callbacks, fmi2False, fmi2True);
    c->phase = c->slave ? INSTANTIATED : SLAVE_LOST;
    c->last_time = 0.0;
    c->last_step = fmi2OK;
    return c->slave != NULL;
}

static bool check_arguments(const struct instance *c, const char *name, fmi2Type type,
                            const char *guid, const char *uri)
{
    static const char function[] = "fmi2Instantiate";
    if (!require(c, function, "instanceName", name) || !require(c, function, "fmuGUID", guid) ||
        !require(c, function, "fmuResourceLocation", uri))
        return false;
    if (!decode_utf8(name, NULL, 0))
        log_message(c, fmi2Error, "%s: instanceName is not UTF-8", function);
    else if (type != fmi2CoSimulation)
        log_message(c, fmi2Error, "%s: this FMU is for co-simulation only", function);
    else if (strcmp(guid, GUID) != 0)
        log_message(c, fmi2Error,
                    "%s: fmuGUID = %s, but this FMU's is %s; description and binary are of "
                    "different builds",
                    function, guid, GUID);
    else
        return true;
    return false;
}

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                              fmi2Boolean loggingOn)
{
    (void)visible;
    struct instance *c = calloc(1, sizeof *c + VARIABLE_COUNT * sizeof *c->output_values);
    if (!c)
        return NULL;
    if (functions)
        c->host_callbacks = *functions;
    c->own_callbacks = (fmi2CallbackFunctions){.logger = log_from_slave,
                                               .allocateMemory = calloc,
                                               .freeMemory = free,
                                               .componentEnvironment = c};
    c->logging = loggingOn;
    const char *name = instanceName ? instanceName : "";
    c->name = malloc(strlen(name) + 1);
    char folder[PATH_SIZE];
    if (c->name && strcpy(c->name, name) &&
        check_arguments(c, instanceName, fmuType, fmuGUID, fmuResourceLocation) &&
        set_location(c, fmuResourceLocation, folder)) {
        struct message reason = {""};
        lock_process();
        bool ready = python_ready(folder, &reason) && load_pythonfmu(&reason);
        unlock_process();
        if (!ready)
            log_message(c, fmi2Error, "%s", reason.text);
        else if (create_slave(c))
            return c;
    }
    release_instance(c);
    return NULL;
}

void fmi2FreeInstance(fmi2Component component)
{
    struct instance *c = component;
    if (!c)
        return;
    free_states_of(c);
    if (c->slave)
        pythonfmu.FreeInstance(c->slave);
    release_instance(c);
}

fmi2Status fmi2SetDebugLogging(fmi2Component component, fmi2Boolean loggingOn, size_t nCategories,
                               const fmi2String categories[])
{
    struct instance *c = component;
    if (!enter_call(c, "fmi2SetDebugLogging", ANY) ||
        (nCategories && !require(c, "fmi2SetDebugLogging", "categories", categories)))
        return fmi2Error;
    unsigned chosen = 0;
    for (size_t i = 0; i < nCategories; i++) {
        int index = categories[i] ? category_index(categories[i]) : -1;
        if (index < 0) {
            log_message(c, fmi2Error, "fmi2SetDebugLogging: %s is no log category of this FMU",
                        categories[i] ? categories[i] : "NULL");
            return fmi2Error;
        }
        chosen |= 1u << index;
    }
    c->logging = loggingOn;
    c->categories = chosen;
    return fmi2OK;
}

fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean toleranceDefined,
                               fmi2Real tolerance, fmi2Real startTime, fmi2Boolean stopTimeDefined,
                               fmi2Real stopTime)
{
    struct instance *c = component;
    if (!enter_call(c, "fmi2SetupExperiment", INSTANTIATED))
        return fmi2Error;
    if (!isfinite(startTime)) {
        log_message(c, fmi2Error, "fmi2SetupExperiment: startTime = %g s must be finite",
                    startTime);
        return fmi2Error;
    }
    c->last_time = startTime;
    return leave_call(c, pythonfmu.SetupExperiment(c->slave, toleranceDefined, tolerance, startTime,
                                                   stopTimeDefined, stopTime));
}

fmi2Status fmi2EnterInitializationMode(fmi2Component component)
{
    struct instance *c = component;
    if (!enter_call(c, "fmi2EnterInitializationMode", INSTANTIATED))
        return fmi2Error;
    fmi2Status status = leave_call(c, pythonfmu.EnterInitializationMode(c->slave));
    if (status < fmi2Error)
        c->phase = INITIALIZING;
    return status;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component component)
{
    struct instance *c = component;
    if (!enter_call(c, "fmi2ExitInitializationMode", INITIALIZING))
        return fmi2Error;
    fmi2Status status = leave_call(c, pythonfmu.ExitInitializationMode(c->slave));
    if (status < fmi2Error) /* else the importer may set other values and try again */
        c->phase = STEPPING;
    return status;
}

fmi2Status fmi2Terminate(fmi2Component component)
{
    struct instance *c = component;
    if (!enter_call(c, "fmi2Terminate", INITIALIZING | STEPPING))
        return fmi2Error;
    fmi2Status status = leave_call(c, pythonfmu.Terminate(c->slave));
    if (c->phase != SLAVE_LOST)
        c->phase = TERMINATED;
    return status;
}

fmi2Status fmi2Reset(fmi2Component component)
{
    struct instance *c = component;
    if (!enter_call(c, "fmi2Reset", ANY | SLAVE_LOST))
        return fmi2Error;
    if (c->phase == SLAVE_LOST)
        return create_slave(c) ? fmi2OK : fmi2Error;
    fmi2Status status = leave_call(c, pythonfmu.Reset(c->slave));
    if (status < fmi2Error) {
        c->phase = INSTANTIATED;
        c->last_time = 0.0;
        c->last_step = fmi2OK;
    }
    return status;
}
