/* fmi3DoStep with events: Event Mode, early return, Intermediate Update Mode. */
#include "fmi3.h"
#include "python.h"

#include <math.h>

/* The functions, and the phases in which each may be called. */
#define FUNCTIONS(X) \
    X(EnterEventMode, STEPPING) \
    X(UpdateDiscreteStates, EVENT_MODE) \
    X(EnterStepMode, EVENT_MODE) \
    X(DoStep, STEPPING)

#define FUNCTION(name, phases) static const struct function name = {"fmi3" #name, phases};
FUNCTIONS(FUNCTION)
#undef FUNCTION

/* Longest time between two calls of intermediateUpdate within a step [s]. */
static const double LONGEST_PART = 1e-3;

fmi3Status fmi3EnterEventMode(fmi3Instance instance)
{
    struct instance *c = instance;
    if (!enter_call(c, &EnterEventMode))
        return fmi3Error;
    if (!c->host.event_mode) {
        log_message(c, STATUS_ERROR, "fmi3EnterEventMode: the instance was made without event mode "
                                     "(eventModeUsed is fmi3False)");
        return fmi3Error;
    }
    c->phase = EVENT_MODE;
    return fmi3OK;
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *discreteStatesNeedUpdate,
                                    fmi3Boolean *terminateSimulation,
                                    fmi3Boolean *nominalsOfContinuousStatesChanged,
                                    fmi3Boolean *valuesOfContinuousStatesChanged,
                                    fmi3Boolean *nextEventTimeDefined, fmi3Float64 *nextEventTime)
{
    struct instance *c = instance;
    const struct function *f = &UpdateDiscreteStates;
    if (!enter_reading(c, f) ||
        !require(c, f, "discreteStatesNeedUpdate", discreteStatesNeedUpdate) ||
        !require(c, f, "terminateSimulation", terminateSimulation) ||
        !require(c, f, "nominalsOfContinuousStatesChanged", nominalsOfContinuousStatesChanged) ||
        !require(c, f, "valuesOfContinuousStatesChanged", valuesOfContinuousStatesChanged) ||
        !require(c, f, "nextEventTimeDefined", nextEventTimeDefined) ||
        !require(c, f, "nextEventTime", nextEventTime))
        return fmi3Error;
    /* the model's discrete states follow from its continuous ones: there is nothing to iterate */
    *discreteStatesNeedUpdate = *terminateSimulation = fmi3False;
    *nominalsOfContinuousStatesChanged = *valuesOfContinuousStatesChanged = fmi3False;
    *nextEventTimeDefined = fmi3False;
    *nextEventTime = 0.0;
    return fmi3OK;
}

fmi3Status fmi3EnterStepMode(fmi3Instance instance)
{
    struct instance *c = instance;
    if (!enter_call(c, &EnterStepMode))
        return fmi3Error;
    c->phase = STEPPING;
    return fmi3OK;
}

/* Call intermediateUpdate; returns where the step shall end, `end` at the latest [s]. */
static double update(struct instance *c, const struct fmi3_host *host, double end)
{
    fmi3Boolean early = fmi3False;
    fmi3Float64 early_time = c->last_time;
    c->phase = UPDATING;
    host->update(host->environment, c->last_time, fmi3True, fmi3True, fmi3True, host->early_return,
                 &early, &early_time);
    if (c->phase == UPDATING) /* else a function that the host called has ended the slave */
        c->phase = STEPPING;
    if (!early || !host->early_return)
        return end;
    return isless(early_time, end) ? early_time : end;
}

/*
 * Time of the next call of intermediateUpdate in a step from `time` to `end`: after the longest
 * part, or, where less than two of these are left, in the middle.
 */
static double next_stop(const struct fmi3_host *host, double time, double end)
{
    const double left = end - time;
    if (!host->update || left <= LONGEST_PART * (1.0 + 1e-9))
        return end;
    const double stop = time + (left < 2.0 * LONGEST_PART ? 0.5 * left : LONGEST_PART);
    return stop > time ? stop : end; /* at large times a part may round to nothing */
}

/* The status of a step whose first parts are done and whose part at `time` was refused. */
static enum status partly_done(const struct instance *c, enum status status, double time)
{
    /* Discard would say that nothing has changed */
    if (status == STATUS_DISCARD)
        log_message(c, STATUS_ERROR, "fmi3DoStep: for that reason the step has ended at %.9g s",
                    time);
    return STATUS_ERROR;
}

/* time + step, which may overflow: computed without the host's floating-point traps. */
static double end_of(double time, double step)
{
    /* volatile: the sum must not be moved out of the two calls */
    const volatile double start = time;
    volatile double end;
    struct floats floats;
    floats_take(&floats);
    end = start + step;
    floats_give_back(&floats);
    return end;
}

/* Step to `step_end`, or to where an event or the host ends the step; `*event`: there was one. */
static enum status step_in_parts(struct instance *c, double time, double step, double step_end,
                                 fmi3Boolean *event)
{
    const struct fmi3_host *host = c->host.callbacks;
    const bool to_event = c->host.event_mode || host->early_return;
    if ((!to_event && !host->update) || !(isgreater(step, 0.0) && isfinite(step_end)))
        return instance_step(c, &DoStep, time, step);
    const double start = time;
    enum status worst = STATUS_OK;
    for (double end = step_end; time < end;) {
        bool found;
        enum status status = instance_step_part(c, &DoStep, time, step_end,
                                                next_stop(host, time, end), to_event, &found);
        if (status >= STATUS_DISCARD)
            return time > start ? partly_done(c, status, time) : status;
        if (status > worst)
            worst = status;
        time = c->last_time;
        *event = *event || found;
        if (found && host->early_return)
            break;
        if (host->update && time < end)
            end = update(c, host, end);
        if (c->phase != STEPPING)
            return STATUS_ERROR;
    }
    return worst;
}

fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 currentCommunicationPoint,
                      fmi3Float64 communicationStepSize,
                      fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                      fmi3Boolean *eventHandlingNeeded, fmi3Boolean *terminateSimulation,
                      fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime)
{
    struct instance *c = instance;
    (void)noSetFMUStatePriorToCurrentPoint;
    if (!enter_call(c, &DoStep) ||
        !require(c, &DoStep, "eventHandlingNeeded", eventHandlingNeeded) ||
        !require(c, &DoStep, "terminateSimulation", terminateSimulation) ||
        !require(c, &DoStep, "earlyReturn", earlyReturn) ||
        !require(c, &DoStep, "lastSuccessfulTime", lastSuccessfulTime))
        return fmi3Error;
    fmi3Boolean event = fmi3False;
    const double end = end_of(currentCommunicationPoint, communicationStepSize);
    enum status status =
        step_in_parts(c, currentCommunicationPoint, communicationStepSize, end, &event);
    *eventHandlingNeeded = event && c->host.event_mode;
    *terminateSimulation = fmi3False;
    *lastSuccessfulTime = c->last_time;
    *earlyReturn = status < STATUS_DISCARD && isless(c->last_time, end);
    return (fmi3Status)status;
}
