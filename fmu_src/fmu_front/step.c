/* Steps, and questions about them. */
#include "front.h"
#include "python.h"

fmi2Status fmi2DoStep(fmi2Component component, fmi2Real currentCommunicationPoint, fmi2Real communicationStepSize,
                      fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    struct instance *c = component;
    if (!begin(c, "fmi2DoStep", STEPPING))
        return fmi2Error;
    fmi2Status status =
        end(c, stock.DoStep(c->slave, currentCommunicationPoint, communicationStepSize, noSetFMUStatePriorToCurrentPoint));
    if (status < fmi2Discard)
        c->last_time = currentCommunicationPoint + communicationStepSize;
    c->last_step = status;
    return status;
}

fmi2Status fmi2CancelStep(fmi2Component component)
{
    struct instance *c = component;
    if (begin(c, "fmi2CancelStep", ANY))
        say(c, fmi2Error, "fmi2CancelStep: no step is pending; fmi2DoStep ends before it returns");
    return fmi2Error;
}

/* Answer the question `asked` with `value` if it is the one, `can`, that this function answers. */
#define ANSWER(function, asked, can, place, answer)                                                                                        \
    struct instance *c = component;                                                                                                        \
    if (!begin(c, function, ANY) || !given(c, function, "value", place))                                                                   \
        return fmi2Error;                                                                                                                  \
    if ((asked) != (can)) {                                                                                                                \
        say(c, fmi2Discard, "%s: this function does not answer status kind %d", function, (int)(asked));                                   \
        return fmi2Discard;                                                                                                                \
    }                                                                                                                                      \
    *(place) = (answer);                                                                                                                   \
    return fmi2OK

fmi2Status fmi2GetStatus(fmi2Component component, const fmi2StatusKind s, fmi2Status *value)
{
    ANSWER("fmi2GetStatus", s, fmi2DoStepStatus, value, c->last_step);
}

fmi2Status fmi2GetRealStatus(fmi2Component component, const fmi2StatusKind s, fmi2Real *value)
{
    ANSWER("fmi2GetRealStatus", s, fmi2LastSuccessfulTime, value, c->last_time);
}

fmi2Status fmi2GetIntegerStatus(fmi2Component component, const fmi2StatusKind s, fmi2Integer *value)
{
    ANSWER("fmi2GetIntegerStatus", (int)s, -1, value, 0); /* no status is an integer */
}

fmi2Status fmi2GetBooleanStatus(fmi2Component component, const fmi2StatusKind s, fmi2Boolean *value)
{
    ANSWER("fmi2GetBooleanStatus", s, fmi2Terminated, value, fmi2False); /* the landing goes on as long as the host steps it */
}

fmi2Status fmi2GetStringStatus(fmi2Component component, const fmi2StatusKind s, fmi2String *value)
{
    ANSWER("fmi2GetStringStatus", s, fmi2PendingStatus, value, "");
}
