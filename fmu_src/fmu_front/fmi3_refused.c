/*
 * The functions of FMI 3.0 for what this FMU does not have: each is an error.
 *
 * Some hosts look up all functions before they know what an FMU is for.
 */
#include "fmi3.h"

/* none of the arguments is used */
#pragma GCC diagnostic ignored "-Wunused-parameter"

static fmi3Status refuse(struct instance *c, const char *function, const char *reason)
{
    const struct function called = {function, READABLE};
    if (enter_reading(c, &called))
        log_message(c, STATUS_ERROR, "%s: %s", function, reason);
    return fmi3Error;
}

static const char NO_DISCRETE[] = "this FMU has no discrete states to evaluate";
static const char NO_CLOCKS[] = "this FMU has no clocks";
static const char CO_SIMULATION[] = "this FMU is for co-simulation only";
static const char NO_STRUCTURE[] = "this FMU has no structural parameters";
static const char NO_DERIVATIVES[] = "this FMU has no derivatives";
static const char NO_DEPENDENCIES[] =
    "this FMU has no dependencies of elements; modelDescription.xml has those of variables";

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c)
{
    return refuse(c, "fmi3EnterContinuousTimeMode", CO_SIMULATION);
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi3Boolean *enterEventMode,
                                       fmi3Boolean *terminateSimulation)
{
    return refuse(c, "fmi3CompletedIntegratorStep", CO_SIMULATION);
}

fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time)
{
    return refuse(c, "fmi3SetTime", CO_SIMULATION);
}

fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 continuousStates[],
                                   size_t nContinuousStates)
{
    return refuse(c, "fmi3SetContinuousStates", CO_SIMULATION);
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 derivatives[],
                                             size_t nContinuousStates)
{
    return refuse(c, "fmi3GetContinuousStateDerivatives", CO_SIMULATION);
}

fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 eventIndicators[],
                                  size_t nEventIndicators)
{
    return refuse(c, "fmi3GetEventIndicators", CO_SIMULATION);
}

fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 continuousStates[],
                                   size_t nContinuousStates)
{
    return refuse(c, "fmi3GetContinuousStates", CO_SIMULATION);
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 nominals[],
                                             size_t nContinuousStates)
{
    return refuse(c, "fmi3GetNominalsOfContinuousStates", CO_SIMULATION);
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *nEventIndicators)
{
    return refuse(c, "fmi3GetNumberOfEventIndicators", CO_SIMULATION);
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *nContinuousStates)
{
    return refuse(c, "fmi3GetNumberOfContinuousStates", CO_SIMULATION);
}

fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference clockReference,
                                      fmi3Float64 activationTime)
{
    return refuse(c, "fmi3ActivateModelPartition", CO_SIMULATION);
}

fmi3Status fmi3EnterConfigurationMode(fmi3Instance c)
{
    return refuse(c, "fmi3EnterConfigurationMode", NO_STRUCTURE);
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance c)
{
    return refuse(c, "fmi3ExitConfigurationMode", NO_STRUCTURE);
}

fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, const fmi3ValueReference valueReferences[],
                                  size_t nValueReferences, fmi3Float64 intervals[],
                                  fmi3IntervalQualifier qualifiers[])
{
    return refuse(c, "fmi3GetIntervalDecimal", NO_CLOCKS);
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance c, const fmi3ValueReference valueReferences[],
                                   size_t nValueReferences, fmi3UInt64 counters[],
                                   fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[])
{
    return refuse(c, "fmi3GetIntervalFraction", NO_CLOCKS);
}

fmi3Status fmi3GetShiftDecimal(fmi3Instance c, const fmi3ValueReference valueReferences[],
                               size_t nValueReferences, fmi3Float64 shifts[])
{
    return refuse(c, "fmi3GetShiftDecimal", NO_CLOCKS);
}

fmi3Status fmi3GetShiftFraction(fmi3Instance c, const fmi3ValueReference valueReferences[],
                                size_t nValueReferences, fmi3UInt64 counters[],
                                fmi3UInt64 resolutions[])
{
    return refuse(c, "fmi3GetShiftFraction", NO_CLOCKS);
}

fmi3Status fmi3SetIntervalDecimal(fmi3Instance c, const fmi3ValueReference valueReferences[],
                                  size_t nValueReferences, const fmi3Float64 intervals[])
{
    return refuse(c, "fmi3SetIntervalDecimal", NO_CLOCKS);
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance c, const fmi3ValueReference valueReferences[],
                                   size_t nValueReferences, const fmi3UInt64 counters[],
                                   const fmi3UInt64 resolutions[])
{
    return refuse(c, "fmi3SetIntervalFraction", NO_CLOCKS);
}

fmi3Status fmi3SetShiftDecimal(fmi3Instance c, const fmi3ValueReference valueReferences[],
                               size_t nValueReferences, const fmi3Float64 shifts[])
{
    return refuse(c, "fmi3SetShiftDecimal", NO_CLOCKS);
}

fmi3Status fmi3SetShiftFraction(fmi3Instance c, const fmi3ValueReference valueReferences[],
                                size_t nValueReferences, const fmi3UInt64 counters[],
                                const fmi3UInt64 resolutions[])
{
    return refuse(c, "fmi3SetShiftFraction", NO_CLOCKS);
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c)
{
    return refuse(c, "fmi3EvaluateDiscreteStates", NO_DISCRETE);
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknowns[],
                                        size_t nUnknowns, const fmi3ValueReference knowns[],
                                        size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
                                        fmi3Float64 sensitivity[], size_t nSensitivity)
{
    return refuse(c, "fmi3GetDirectionalDerivative", NO_DERIVATIVES);
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, const fmi3ValueReference unknowns[],
                                    size_t nUnknowns, const fmi3ValueReference knowns[],
                                    size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
                                    fmi3Float64 sensitivity[], size_t nSensitivity)
{
    return refuse(c, "fmi3GetAdjointDerivative", NO_DERIVATIVES);
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference valueReferences[],
                                    size_t nValueReferences, const fmi3Int32 orders[],
                                    fmi3Float64 values[], size_t nValues)
{
    return refuse(c, "fmi3GetOutputDerivatives", NO_DERIVATIVES);
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference valueReference,
                                               size_t *nDependencies)
{
    return refuse(c, "fmi3GetNumberOfVariableDependencies", NO_DEPENDENCIES);
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference dependent,
                                       size_t elementIndicesOfDependent[],
                                       fmi3ValueReference independents[],
                                       size_t elementIndicesOfIndependents[],
                                       fmi3DependencyKind dependencyKinds[], size_t nDependencies)
{
    return refuse(c, "fmi3GetVariableDependencies", NO_DEPENDENCIES);
}

/* Getters and setters of types that no variable has. */

#define TYPES_OF_NO_VARIABLE(X) \
    X(Float32) \
    X(Int8) \
    X(UInt8) \
    X(Int16) \
    X(UInt16) \
    X(UInt32) \
    X(Int64) \
    X(UInt64)

#define REFUSE_TYPE(type) \
    fmi3Status fmi3Get##type(fmi3Instance c, const fmi3ValueReference vr[], size_t n, \
                             fmi3##type values[], size_t n_values) \
    { \
        return fmi3_refuse_type(c, "fmi3Get" #type, vr, n, n_values); \
    } \
    fmi3Status fmi3Set##type(fmi3Instance c, const fmi3ValueReference vr[], size_t n, \
                             const fmi3##type values[], size_t n_values) \
    { \
        return fmi3_refuse_type(c, "fmi3Set" #type, vr, n, n_values); \
    }
TYPES_OF_NO_VARIABLE(REFUSE_TYPE)

fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, size_t valueSizes[], fmi3Binary values[],
                         size_t nValues)
{
    return fmi3_refuse_type(c, "fmi3GetBinary", valueReferences, nValueReferences, nValues);
}

fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, const size_t valueSizes[],
                         const fmi3Binary values[], size_t nValues)
{
    return fmi3_refuse_type(c, "fmi3SetBinary", valueReferences, nValueReferences, nValues);
}

fmi3Status fmi3GetClock(fmi3Instance c, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, fmi3Clock values[])
{
    return fmi3_refuse_type(c, "fmi3GetClock", valueReferences, nValueReferences, 0);
}

fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, const fmi3Clock values[])
{
    return fmi3_refuse_type(c, "fmi3SetClock", valueReferences, nValueReferences, 0);
}
