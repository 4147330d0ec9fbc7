/* The functions of FMI 3.0: instances, modes, states. */
#include "fmi3.h"
#include "state_functions.h"
#include "variables.h"

#include <stdlib.h>
#include <string.h>

/* The functions, and the phases in which each may be called. */
#define FUNCTIONS(X) \
    X(SetDebugLogging, READABLE) \
    X(EnterInitializationMode, INSTANTIATED) \
    X(ExitInitializationMode, INITIALIZING) \
    X(Terminate, INITIALIZING | STEPPING | EVENT_MODE) \
    X(Reset, ANY_MODE | SLAVE_LOST) \
    X(GetFMUState, ANY_MODE) \
    X(SetFMUState, ANY_MODE) \
    X(FreeFMUState, ANY_MODE | SLAVE_LOST) \
    X(SerializedFMUStateSize, ANY_MODE) \
    X(SerializeFMUState, ANY_MODE) \
    X(DeserializeFMUState, ANY_MODE)

#define FUNCTION(name, phases) static const struct function name = {"fmi3" #name, phases};
FUNCTIONS(FUNCTION)
#undef FUNCTION

const char *fmi3GetVersion(void)
{
    return fmi3Version;
}

static void send_message(const struct host *host, const char *name, enum status status,
                         const char *category, const char *text)
{
    const struct fmi3_host *callbacks = host->callbacks;
    (void)name; /* the host distinguishes instances by their environment */
    /* the host takes what is between two # for a value reference, and a path may hold one */
    char escaped[2 * sizeof(struct message)];
    double_character(text, '#', escaped, sizeof escaped);
    callbacks->log(callbacks->environment, (fmi3Status)status, category, escaped);
}

static bool check_arguments(const struct instance *c, const char *name, const char *token,
                            const fmi3ValueReference required[], size_t n)
{
    static const struct function instantiate = {"fmi3InstantiateCoSimulation", 0};
    if (!require(c, &instantiate, "instanceName", name) ||
        !require(c, &instantiate, "instantiationToken", token) ||
        (n && !require(c, &instantiate, "requiredIntermediateVariables", required)))
        return false;
    if (!decode_utf8(name, NULL, 0))
        log_message(c, STATUS_ERROR, "%s: instanceName is not UTF-8", instantiate.name);
    else if (strcmp(token, GUID) != 0)
        log_message(c, STATUS_ERROR,
                    "%s: instantiationToken = %.100s, but this FMU's is %s; description and binary are "
                    "of different builds",
                    instantiate.name, token, GUID);
    else
        return fmi3_check_intermediate(c, &instantiate, required, n);
    return false;
}

/* An instance that is not made yet, to log with. */
static struct instance wanted(struct fmi3_host *callbacks, const char *name, bool logging)
{
    return (struct instance){.host = {.send = callbacks->log ? send_message : NULL,
                                      .callbacks = callbacks,
                                      .version = '3',
                                      .takes_errors = true,
                                      .logging = logging},
                             .name = (char *)(name ? name : "")};
}

fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn, fmi3Boolean eventModeUsed,
    fmi3Boolean earlyReturnAllowed, const fmi3ValueReference requiredIntermediateVariables[],
    size_t nRequiredIntermediateVariables, fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage, fmi3IntermediateUpdateCallback intermediateUpdate)
{
    struct fmi3_host *callbacks = malloc(sizeof *callbacks);
    if (!callbacks)
        return NULL;
    *callbacks = (struct fmi3_host){instanceEnvironment, logMessage, intermediateUpdate,
                                    earlyReturnAllowed};
    struct instance unmade = wanted(callbacks, instanceName, loggingOn), *c = NULL;
    unmade.host.event_mode = eventModeUsed;
    if (check_arguments(&unmade, instanceName, instantiationToken, requiredIntermediateVariables,
                        nRequiredIntermediateVariables))
        c = instance_create(&unmade.host, instanceName, resourcePath, visible);
    if (!c)
        free(callbacks);
    return c;
}

/* Refuse to make an instance of a kind that this FMU is not for. */
static fmi3Instance refuse_kind(const char *name, bool logging, const char *function,
                                fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    struct fmi3_host callbacks = {environment, log, NULL, false};
    struct instance unmade = wanted(&callbacks, name, logging);
    log_message(&unmade, STATUS_ERROR, "%s: this FMU is for co-simulation only", function);
    return NULL;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String instanceName, fmi3String instantiationToken,
                                          fmi3String resourcePath, fmi3Boolean visible,
                                          fmi3Boolean loggingOn,
                                          fmi3InstanceEnvironment instanceEnvironment,
                                          fmi3LogMessageCallback logMessage)
{
    (void)instantiationToken, (void)resourcePath, (void)visible;
    return refuse_kind(instanceName, loggingOn, "fmi3InstantiateModelExchange",
                       instanceEnvironment, logMessage);
}

fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn, fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage, fmi3ClockUpdateCallback clockUpdate,
    fmi3LockPreemptionCallback lockPreemption, fmi3UnlockPreemptionCallback unlockPreemption)
{
    (void)instantiationToken, (void)resourcePath, (void)visible, (void)clockUpdate;
    (void)lockPreemption, (void)unlockPreemption;
    return refuse_kind(instanceName, loggingOn, "fmi3InstantiateScheduledExecution",
                       instanceEnvironment, logMessage);
}

void fmi3FreeInstance(fmi3Instance instance)
{
    struct instance *c = instance;
    static const struct function function = {"fmi3FreeInstance", ~(unsigned)UPDATING};
    if (!enter_call(c, &function))
        return;
    void *callbacks = (void *)c->host.callbacks;
    instance_free(c);
    free(callbacks);
}

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean loggingOn, size_t nCategories,
                               const fmi3String categories[])
{
    return (fmi3Status)instance_set_logging(c, &SetDebugLogging, loggingOn, nCategories,
                                            categories);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean toleranceDefined,
                                       fmi3Float64 tolerance, fmi3Float64 startTime,
                                       fmi3Boolean stopTimeDefined, fmi3Float64 stopTime)
{
    enum status setup = instance_setup(c, &EnterInitializationMode, startTime,
                                       stopTimeDefined ? &stopTime : NULL,
                                       toleranceDefined ? &tolerance : NULL);
    if (setup >= STATUS_ERROR)
        return (fmi3Status)setup;
    enum status status = instance_enter_initialization(c, &EnterInitializationMode);
    return (fmi3Status)(setup > status ? setup : status);
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    return (fmi3Status)instance_exit_initialization(c, &ExitInitializationMode);
}

fmi3Status fmi3Terminate(fmi3Instance c)
{
    return (fmi3Status)instance_terminate(c, &Terminate);
}

fmi3Status fmi3Reset(fmi3Instance c)
{
    return (fmi3Status)instance_reset(c, &Reset);
}

STATE_FUNCTIONS(fmi3, Instance, FMUState, Deserialize)
