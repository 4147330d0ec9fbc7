/* An FMI 2.0 co-simulation FMU with the landing's variables and no model, to measure the importer.
 *
 * A step advances the time, a getter returns it, a setter ignores the values. VARIABLES comes from
 * the compiler's command line.
 */
#include "fmi2FunctionTypes.h"

#include <stdlib.h>

struct instance {
    fmi2Real time;
};

const char *fmi2GetVersion(void)
{
    return "2.0";
}

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String location,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                              fmi2Boolean loggingOn)
{
    (void)name, (void)type, (void)guid, (void)location, (void)functions, (void)visible,
        (void)loggingOn;
    return calloc(1, sizeof(struct instance));
}

void fmi2FreeInstance(fmi2Component c)
{
    free(c);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                               fmi2Real startTime, fmi2Boolean stopTimeDefined, fmi2Real stopTime)
{
    (void)toleranceDefined, (void)tolerance, (void)stopTimeDefined, (void)stopTime;
    ((struct instance *)c)->time = startTime;
    return fmi2OK;
}

#define NOTHING(name) \
    fmi2Status name(fmi2Component c) \
    { \
        (void)c; \
        return fmi2OK; \
    }

NOTHING(fmi2EnterInitializationMode)
NOTHING(fmi2ExitInitializationMode)
NOTHING(fmi2Terminate)
NOTHING(fmi2Reset)

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real point, fmi2Real step,
                      fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    ((struct instance *)c)->time = point + step;
    return fmi2OK;
}

#define VALUES(Type, from_time) \
    fmi2Status fmi2Get##Type(fmi2Component c, const fmi2ValueReference vr[], size_t n, \
                             fmi2##Type value[]) \
    { \
        fmi2Real time = ((struct instance *)c)->time; \
        (void)time; \
        for (size_t i = 0; i < n; i++) { \
            if (vr[i] >= VARIABLES) \
                return fmi2Error; \
            value[i] = from_time; \
        } \
        return fmi2OK; \
    } \
    fmi2Status fmi2Set##Type(fmi2Component c, const fmi2ValueReference vr[], size_t n, \
                             const fmi2##Type value[]) \
    { \
        (void)c, (void)vr, (void)n, (void)value; \
        return fmi2OK; \
    }

VALUES(Real, time)
VALUES(Integer, (fmi2Integer)time)
VALUES(Boolean, time > 0.0)
VALUES(String, "")

/* FMPy looks every function up, and calls none of these. */
#define UNSUPPORTED(name) \
    fmi2Status name(void) \
    { \
        return fmi2Error; \
    }

UNSUPPORTED(fmi2SetDebugLogging)
UNSUPPORTED(fmi2GetFMUstate)
UNSUPPORTED(fmi2SetFMUstate)
UNSUPPORTED(fmi2FreeFMUstate)
UNSUPPORTED(fmi2SerializedFMUstateSize)
UNSUPPORTED(fmi2SerializeFMUstate)
UNSUPPORTED(fmi2DeSerializeFMUstate)
UNSUPPORTED(fmi2GetDirectionalDerivative)
UNSUPPORTED(fmi2SetRealInputDerivatives)
UNSUPPORTED(fmi2GetRealOutputDerivatives)
UNSUPPORTED(fmi2CancelStep)
UNSUPPORTED(fmi2GetStatus)
UNSUPPORTED(fmi2GetRealStatus)
UNSUPPORTED(fmi2GetIntegerStatus)
UNSUPPORTED(fmi2GetBooleanStatus)
UNSUPPORTED(fmi2GetStringStatus)
