/* Instances: made, set up, initialised, reset, ended, freed. */
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

static void discard(struct instance *c)
{
    if (c->link[0])
        unlink_folder(c->link);
    free(c->location);
    free(c->name);
    free(c);
}

/* Find the resources and hand them to pythonfmu under a path that it can take. */
static bool locate(struct instance *c, const char *uri, char folder[PATH_SIZE])
{
    if (!folder_of_uri(uri, folder)) {
        say(c, fmi2Error, "fmuResourceLocation does not name the FMU's resources (no slavemodule.txt there): %s", uri);
        return false;
    }
    const char *path = folder;
    if (!is_plain(folder))
        shorten(folder);
    if (!is_plain(folder)) {
        if (!link_folder(folder, c->link)) {
            c->link[0] = '\0';
            say(c, fmi2Error, "cannot make a link to %s in the temporary folder: %s", folder, strerror(errno));
            return false;
        }
        path = c->link;
    }
    c->location = malloc(strlen(path) + 9);
    if (c->location)
        sprintf(c->location, "file://%s%s", path[0] == '/' ? "" : "/", path); /* C:/... on Windows */
    return c->location != NULL;
}

static bool make_slave(struct instance *c)
{
    c->worst = fmi2OK;
    c->slave = stock.Instantiate(c->name, fmi2CoSimulation, GUID, c->location, &c->own, fmi2False, fmi2True);
    c->phase = c->slave ? INSTANTIATED : LOST;
    c->last_time = 0.0;
    c->last_step = fmi2OK;
    return c->slave != NULL;
}

static bool check_arguments(const struct instance *c, const char *name, fmi2Type type, const char *guid, const char *uri)
{
    static const char function[] = "fmi2Instantiate";
    if (!given(c, function, "instanceName", name) || !given(c, function, "fmuGUID", guid) || !given(c, function, "fmuResourceLocation", uri))
        return false;
    if (!decode_utf8(name, NULL, 0))
        say(c, fmi2Error, "%s: instanceName is not UTF-8", function);
    else if (type != fmi2CoSimulation)
        say(c, fmi2Error, "%s: this FMU is for co-simulation only", function);
    else if (strcmp(guid, GUID) != 0)
        say(c, fmi2Error, "%s: fmuGUID = %s, but this FMU's is %s; description and binary are of different builds", function, guid, GUID);
    else
        return true;
    return false;
}

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID, fmi2String fmuResourceLocation,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean loggingOn)
{
    (void)visible;
    struct instance *c = calloc(1, sizeof *c + VARIABLE_COUNT * sizeof *c->values);
    if (!c)
        return NULL;
    if (functions)
        c->host = *functions;
    c->own = (fmi2CallbackFunctions){.logger = relay, .allocateMemory = calloc, .freeMemory = free, .componentEnvironment = c};
    c->logging = loggingOn;
    const char *name = instanceName ? instanceName : "";
    c->name = malloc(strlen(name) + 1);
    char folder[PATH_SIZE];
    if (c->name && strcpy(c->name, name) && check_arguments(c, instanceName, fmuType, fmuGUID, fmuResourceLocation) &&
        locate(c, fmuResourceLocation, folder)) {
        struct message reason = {""};
        lock();
        bool ready = python_ready(folder, &reason) && load_stock(&reason);
        unlock();
        if (!ready)
            say(c, fmi2Error, "%s", reason.text);
        else if (make_slave(c))
            return c;
    }
    discard(c);
    return NULL;
}

void fmi2FreeInstance(fmi2Component component)
{
    struct instance *c = component;
    if (!c)
        return;
    free_states_of(c);
    if (c->slave)
        stock.FreeInstance(c->slave);
    discard(c);
}

fmi2Status fmi2SetDebugLogging(fmi2Component component, fmi2Boolean loggingOn, size_t nCategories, const fmi2String categories[])
{
    struct instance *c = component;
    if (!begin(c, "fmi2SetDebugLogging", ANY) || (nCategories && !given(c, "fmi2SetDebugLogging", "categories", categories)))
        return fmi2Error;
    unsigned chosen = 0;
    for (size_t i = 0; i < nCategories; i++) {
        int index = categories[i] ? category_index(categories[i]) : -1;
        if (index < 0) {
            say(c, fmi2Error, "fmi2SetDebugLogging: %s is no log category of this FMU", categories[i] ? categories[i] : "NULL");
            return fmi2Error;
        }
        chosen |= 1u << index;
    }
    c->logging = loggingOn;
    c->categories = chosen;
    return fmi2OK;
}

fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean toleranceDefined, fmi2Real tolerance, fmi2Real startTime,
                               fmi2Boolean stopTimeDefined, fmi2Real stopTime)
{
    struct instance *c = component;
    if (!begin(c, "fmi2SetupExperiment", INSTANTIATED))
        return fmi2Error;
    if (!isfinite(startTime)) {
        say(c, fmi2Error, "fmi2SetupExperiment: startTime = %g s must be finite", startTime);
        return fmi2Error;
    }
    c->last_time = startTime;
    return end(c, stock.SetupExperiment(c->slave, toleranceDefined, tolerance, startTime, stopTimeDefined, stopTime));
}

fmi2Status fmi2EnterInitializationMode(fmi2Component component)
{
    struct instance *c = component;
    if (!begin(c, "fmi2EnterInitializationMode", INSTANTIATED))
        return fmi2Error;
    fmi2Status status = end(c, stock.EnterInitializationMode(c->slave));
    if (status < fmi2Error)
        c->phase = INITIALIZING;
    return status;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component component)
{
    struct instance *c = component;
    if (!begin(c, "fmi2ExitInitializationMode", INITIALIZING))
        return fmi2Error;
    fmi2Status status = end(c, stock.ExitInitializationMode(c->slave));
    if (status < fmi2Error) /* else the host may set other values and try again */
        c->phase = STEPPING;
    return status;
}

fmi2Status fmi2Terminate(fmi2Component component)
{
    struct instance *c = component;
    if (!begin(c, "fmi2Terminate", INITIALIZING | STEPPING))
        return fmi2Error;
    fmi2Status status = end(c, stock.Terminate(c->slave));
    if (c->phase != LOST)
        c->phase = TERMINATED;
    return status;
}

fmi2Status fmi2Reset(fmi2Component component)
{
    struct instance *c = component;
    if (!begin(c, "fmi2Reset", ANY | LOST))
        return fmi2Error;
    if (c->phase == LOST)
        return make_slave(c) ? fmi2OK : fmi2Error;
    fmi2Status status = end(c, stock.Reset(c->slave));
    if (status < fmi2Error) {
        c->phase = INSTANTIATED;
        c->last_time = 0.0;
        c->last_step = fmi2OK;
    }
    return status;
}
