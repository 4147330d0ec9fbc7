/* Communication steps and the status functions. */
#include "front.h"
#include "python.h"

fmi2Status fmi2DoStep(fmi2Component component, fmi2Real currentCommunicationPoint,
                      fmi2Real communicationStepSize, fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    struct instance *c = component;
    if (!enter_call(c, "fmi2DoStep", STEPPING))
        return fmi2Error;
    fmi2Status status =
        leave_call(c, pythonfmu.DoStep(c->slave, currentCommunicationPoint, communicationStepSize,
                                       noSetFMUStatePriorToCurrentPoint));
    if (status < fmi2Discard)
        c->last_time = currentCommunicationPoint + communicationStepSize;
    c->last_step = status;
    return status;
}

fmi2Status fmi2CancelStep(fmi2Component component)
{
    struct instance *c = component;
    if (enter_call(c, "fmi2CancelStep", ANY))
        log_message(c, fmi2Error,
                    "fmi2CancelStep: no step is pending; fmi2DoStep ends before it returns");
    return fmi2Error;
}

/* Enter a status function: Discard if it does not answer this `kind` of status. */
static fmi2Status enter_status(struct instance *c, const char *function, fmi2StatusKind kind,
                               bool answers, const void *value)
{
    if (!enter_call(c, function, ANY) || !require(c, function, "value", value))
        return fmi2Error;
    if (answers)
        return fmi2OK;
    log_message(c, fmi2Discard, "%s: this function does not answer status kind %d", function,
                (int)kind);
    return fmi2Discard;
}

fmi2Status fmi2GetStatus(fmi2Component component, const fmi2StatusKind s, fmi2Status *value)
{
    struct instance *c = component;
    fmi2Status status = enter_status(c, "fmi2GetStatus", s, s == fmi2DoStepStatus, value);
    if (status == fmi2OK)
        *value = c->last_step;
    return status;
}

fmi2Status fmi2GetRealStatus(fmi2Component component, const fmi2StatusKind s, fmi2Real *value)
{
    struct instance *c = component;
    fmi2Status status = enter_status(c, "fmi2GetRealStatus", s, s == fmi2LastSuccessfulTime, value);
    if (status == fmi2OK)
        *value = c->last_time;
    return status;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component component, const fmi2StatusKind s, fmi2Integer *value)
{
    /* FMI 2.0 has no status of type Integer */
    return enter_status(component, "fmi2GetIntegerStatus", s, false, value);
}

fmi2Status fmi2GetBooleanStatus(fmi2Component component, const fmi2StatusKind s, fmi2Boolean *value)
{
    fmi2Status status =
        enter_status(component, "fmi2GetBooleanStatus", s, s == fmi2Terminated, value);
    if (status == fmi2OK)
        *value = fmi2False; /* this FMU never asks the importer to end the simulation */
    return status;
}

fmi2Status fmi2GetStringStatus(fmi2Component component, const fmi2StatusKind s, fmi2String *value)
{
    fmi2Status status =
        enter_status(component, "fmi2GetStringStatus", s, s == fmi2PendingStatus, value);
    if (status == fmi2OK)
        *value = "";
    return status;
}
