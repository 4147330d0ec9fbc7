/* The functions of FMI 2.0. */
#include "fmi2Functions.h"
#include "instance.h"
#include "state_functions.h"
#include "variables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The functions, and the phases in which each may be called. */
#define FUNCTIONS(X) \
    X(SetDebugLogging, ANY) \
    X(SetupExperiment, INSTANTIATED) \
    X(EnterInitializationMode, INSTANTIATED) \
    X(ExitInitializationMode, INITIALIZING) \
    X(Terminate, INITIALIZING | STEPPING) \
    X(Reset, ANY | SLAVE_LOST) \
    X(GetReal, ANY) \
    X(GetInteger, ANY) \
    X(GetBoolean, ANY) \
    X(GetString, ANY) \
    X(SetReal, BEFORE_STEPS | STEPPING) \
    X(SetInteger, BEFORE_STEPS | STEPPING) \
    X(SetBoolean, BEFORE_STEPS | STEPPING) \
    X(SetString, BEFORE_STEPS | STEPPING) \
    X(GetFMUstate, ANY) \
    X(SetFMUstate, ANY) \
    X(FreeFMUstate, ANY | SLAVE_LOST) \
    X(SerializedFMUstateSize, ANY) \
    X(SerializeFMUstate, ANY) \
    X(DeSerializeFMUstate, ANY) \
    X(GetDirectionalDerivative, ANY) \
    X(SetRealInputDerivatives, BEFORE_STEPS | STEPPING) \
    X(GetRealOutputDerivatives, ANY) \
    X(DoStep, STEPPING) \
    X(CancelStep, ANY) \
    X(GetStatus, ANY) \
    X(GetRealStatus, ANY) \
    X(GetIntegerStatus, ANY) \
    X(GetBooleanStatus, ANY) \
    X(GetStringStatus, ANY)

#define FUNCTION(name, phases) static const struct function name = {"fmi2" #name, phases};
FUNCTIONS(FUNCTION)
#undef FUNCTION

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return fmi2Version;
}

static void send_message(const struct host *host, const char *name, enum status status,
                         const char *category, const char *text)
{
    const fmi2CallbackFunctions *callbacks = host->callbacks;
    /* the host takes the message as a format, and a path or a value in it may hold a % */
    char escaped[2 * sizeof(struct message)];
    double_character(text, '%', escaped, sizeof escaped);
    callbacks->logger(callbacks->componentEnvironment, name, (fmi2Status)status, category, escaped);
}

/* The host's callbacks, kept apart from its own memory, which it may free. */
static struct host host_of(const fmi2CallbackFunctions *callbacks, bool logging)
{
    struct host host = {.version = '2', .logging = logging};
    fmi2CallbackFunctions *copy = callbacks && callbacks->logger ? malloc(sizeof *copy) : NULL;
    if (copy) {
        /* not by assignment: the members are const in headers before FMI 2.0.1 */
        memcpy(copy, callbacks, sizeof *copy);
        host.callbacks = copy;
        host.send = send_message;
    }
    return host;
}

static bool check_arguments(const struct instance *c, const char *name, fmi2Type type,
                            const char *guid)
{
    static const struct function instantiate = {"fmi2Instantiate", 0};
    if (!require(c, &instantiate, "instanceName", name) ||
        !require(c, &instantiate, "fmuGUID", guid))
        return false;
    if (!decode_utf8(name, NULL, 0))
        log_message(c, STATUS_ERROR, "fmi2Instantiate: instanceName is not UTF-8");
    else if (type != fmi2CoSimulation)
        log_message(c, STATUS_ERROR, "fmi2Instantiate: this FMU is for co-simulation only");
    else if (strcmp(guid, GUID) != 0)
        log_message(c, STATUS_ERROR,
                    "fmi2Instantiate: fmuGUID = %.100s, but this FMU's is %s; description and binary "
                    "are of different builds",
                    guid, GUID);
    else
        return true;
    return false;
}

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                              fmi2Boolean loggingOn)
{
    const struct host host = host_of(functions, loggingOn);
    /* an instance that is not made yet, to log with */
    const struct instance wanted = {.host = host,
                                    .name = (char *)(instanceName ? instanceName : "")};
    struct instance *c = NULL;
    if (check_arguments(&wanted, instanceName, fmuType, fmuGUID))
        c = instance_create(&host, instanceName, fmuResourceLocation, visible);
    if (!c)
        free((void *)host.callbacks);
    return c;
}

void fmi2FreeInstance(fmi2Component c)
{
    if (!c)
        return;
    void *callbacks = (void *)((struct instance *)c)->host.callbacks;
    instance_free(c);
    free(callbacks);
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories,
                               const fmi2String categories[])
{
    return (fmi2Status)instance_set_logging(c, &SetDebugLogging, loggingOn, nCategories,
                                            categories);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                               fmi2Real startTime, fmi2Boolean stopTimeDefined, fmi2Real stopTime)
{
    return (fmi2Status)instance_setup(c, &SetupExperiment, startTime,
                                      stopTimeDefined ? &stopTime : NULL,
                                      toleranceDefined ? &tolerance : NULL);
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    return (fmi2Status)instance_enter_initialization(c, &EnterInitializationMode);
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    return (fmi2Status)instance_exit_initialization(c, &ExitInitializationMode);
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    return (fmi2Status)instance_terminate(c, &Terminate);
}

fmi2Status fmi2Reset(fmi2Component c)
{
    return (fmi2Status)instance_reset(c, &Reset);
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[])
{
    return (fmi2Status)instance_read(c, &GetReal, REAL, vr, nvr, value);
}

/* Read numbers into the instance's buffer (instance_room); NULL after an error. */
static const double *read_to_room(struct instance *c, const struct function *f, enum kind kind,
                                  const fmi2ValueReference vr[], size_t n, const void *value,
                                  fmi2Status *status)
{
    double *numbers = c && value ? instance_room(c, f, n) : NULL;
    *status = fmi2Error;
    if (c && value && n && !numbers)
        return NULL;
    *status = (fmi2Status)instance_read(c, f, kind, vr, n, numbers);
    return *status < fmi2Error ? numbers : NULL;
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          fmi2Integer value[])
{
    fmi2Status status;
    const double *numbers = read_to_room(c, &GetInteger, INTEGER, vr, nvr, value, &status);
    for (size_t i = 0; numbers && i < nvr; i++)
        value[i] = isnan(numbers[i]) ? 0 : (fmi2Integer)numbers[i];
    return status;
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          fmi2Boolean value[])
{
    fmi2Status status;
    const double *numbers = read_to_room(c, &GetBoolean, BOOLEAN, vr, nvr, value, &status);
    for (size_t i = 0; numbers && i < nvr; i++)
        value[i] = numbers[i] > 0.0 ? fmi2True : fmi2False;
    return status;
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                         fmi2String value[])
{
    return (fmi2Status)instance_read_strings(c, &GetString, vr, nvr, value);
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                       const fmi2Real value[])
{
    return (fmi2Status)instance_write(c, &SetReal, REAL, vr, nvr, value);
}

/* fmi2Integer and fmi2Boolean are both int. */
static fmi2Status write_integers(struct instance *c, const struct function *f, enum kind kind,
                                 const fmi2ValueReference vr[], size_t n, const int value[])
{
    double *numbers = c && value ? instance_room(c, f, n) : NULL;
    if (c && value && n && !numbers)
        return fmi2Error;
    for (size_t i = 0; numbers && i < n; i++)
        numbers[i] = value[i];
    return (fmi2Status)instance_write(c, f, kind, vr, n, numbers);
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          const fmi2Integer value[])
{
    return write_integers(c, &SetInteger, INTEGER, vr, nvr, value);
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          const fmi2Boolean value[])
{
    return write_integers(c, &SetBoolean, BOOLEAN, vr, nvr, value);
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                         const fmi2String value[])
{
    return (fmi2Status)instance_write_strings(c, &SetString, vr, nvr, value);
}

STATE_FUNCTIONS(fmi2, Component, FMUstate, DeSerialize)

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                       const fmi2Integer order[], const fmi2Real value[])
{
    return (fmi2Status)instance_write_rates(c, &SetRealInputDerivatives, vr, nvr, order, value);
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint,
                      fmi2Real communicationStepSize, fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    return (fmi2Status)instance_step(c, &DoStep, currentCommunicationPoint, communicationStepSize);
}

/* Refuse a function that this FMU does not have. */
static fmi2Status refuse(struct instance *c, const struct function *f, const char *reason)
{
    if (enter_call(c, f))
        log_message(c, STATUS_ERROR, "%s: %s", f->name, reason);
    return fmi2Error;
}

fmi2Status fmi2CancelStep(fmi2Component c)
{
    return refuse(c, &CancelStep, "no step is pending; fmi2DoStep ends before it returns");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                        const fmi2Integer order[], fmi2Real value[])
{
    (void)vr, (void)nvr, (void)order, (void)value;
    return refuse(c, &GetRealOutputDerivatives, "this FMU has no derivatives of outputs");
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference vUnknown_ref[],
                                        size_t nUnknown, const fmi2ValueReference vKnown_ref[],
                                        size_t nKnown, const fmi2Real dvKnown[],
                                        fmi2Real dvUnknown[])
{
    (void)vUnknown_ref, (void)nUnknown, (void)vKnown_ref, (void)nKnown, (void)dvKnown;
    (void)dvUnknown;
    return refuse(c, &GetDirectionalDerivative, "this FMU has no directional derivatives");
}

/* Begin a fmi2Get...Status function: Discard if it does not return this `kind` of status. */
static fmi2Status enter_status(struct instance *c, const struct function *f, fmi2StatusKind kind,
                               bool answers, const void *value)
{
    if (!enter_call(c, f) || !require(c, f, "value", value))
        return fmi2Error;
    if (answers)
        return fmi2OK;
    log_message(c, STATUS_DISCARD, "%s: this function does not answer status kind %d", f->name,
                (int)kind);
    return fmi2Discard;
}

fmi2Status fmi2GetStatus(fmi2Component component, const fmi2StatusKind s, fmi2Status *value)
{
    struct instance *c = component;
    fmi2Status status = enter_status(c, &GetStatus, s, s == fmi2DoStepStatus, value);
    if (status == fmi2OK)
        *value = (fmi2Status)c->last_step;
    return status;
}

fmi2Status fmi2GetRealStatus(fmi2Component component, const fmi2StatusKind s, fmi2Real *value)
{
    struct instance *c = component;
    fmi2Status status = enter_status(c, &GetRealStatus, s, s == fmi2LastSuccessfulTime, value);
    if (status == fmi2OK)
        *value = c->last_time;
    return status;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind s, fmi2Integer *value)
{
    /* FMI 2.0 has no status of type Integer */
    return enter_status(c, &GetIntegerStatus, s, false, value);
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s, fmi2Boolean *value)
{
    fmi2Status status = enter_status(c, &GetBooleanStatus, s, s == fmi2Terminated, value);
    if (status == fmi2OK)
        *value = fmi2False; /* this FMU never asks the host to end the simulation */
    return status;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind s, fmi2String *value)
{
    fmi2Status status = enter_status(c, &GetStringStatus, s, s == fmi2PendingStatus, value);
    if (status == fmi2OK)
        *value = "";
    return status;
}
