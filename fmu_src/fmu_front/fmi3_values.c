/*
 * Values of variables in FMI 3.0.
 *
 * A variable of FMI 3.0 is one of the slave's, or an array of `count` of them that are `stride`
 * apart: its value reference is that of the first. `time` comes after all of them.
 */
#include "fmi3.h"
#include "variables.h"

#include <stdlib.h>

#define TIME VARIABLE_COUNT

/* The functions, and the phases in which each may be called. */
#define FUNCTIONS(X) \
    X(GetFloat64, READABLE) \
    X(GetInt32, READABLE) \
    X(GetBoolean, READABLE) \
    X(GetString, READABLE) \
    X(SetFloat64, SETTABLE) \
    X(SetInt32, SETTABLE) \
    X(SetBoolean, SETTABLE) \
    X(SetString, SETTABLE)

#define FUNCTION(name, phases) static const struct function name = {"fmi3" #name, phases};
FUNCTIONS(FUNCTION)
#undef FUNCTION

static const char *type_name(char kind)
{
    return kind == REAL      ? "a Float64"
           : kind == INTEGER ? "an Int32"
           : kind == BOOLEAN ? "a Boolean"
                             : "a String";
}

static size_t count_of(fmi3ValueReference vr)
{
    return vr == TIME ? 1 : VARIABLES[vr].count;
}

static bool check_references(const struct instance *c, const struct function *f,
                             const fmi3ValueReference vr[], size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (vr[i] > TIME || count_of(vr[i]) == 0) {
            log_message(c, STATUS_ERROR, "%s: value reference %u is that of no variable", f->name,
                        (unsigned)vr[i]);
            return false;
        }
    return true;
}

bool fmi3_check_intermediate(const struct instance *c, const struct function *f,
                             const fmi3ValueReference vr[], size_t n)
{
    if (!check_references(c, f, vr, n))
        return false;
    for (size_t i = 0; i < n; i++) {
        const struct variable *v = vr[i] == TIME ? NULL : &VARIABLES[vr[i]];
        if (v && v->kind == REAL && (v->causality == 'i' || v->causality == 'o'))
            continue;
        log_message(c, STATUS_ERROR, "%s: %s is no input or continuous output", f->name,
                    v ? v->whole : "time");
        return false;
    }
    return true;
}

/* Check that the variables are of the kind. `kind` may be one that no variable has. */
static bool check_kinds(const struct instance *c, const struct function *f, char kind,
                        bool numbers_too, const fmi3ValueReference vr[], size_t n)
{
    if (!check_references(c, f, vr, n))
        return false;
    for (size_t i = 0; i < n; i++) {
        const char own = vr[i] == TIME ? REAL : VARIABLES[vr[i]].kind;
        if (own == kind || (numbers_too && kind == REAL && is_numeric_output(vr[i])))
            continue;
        log_message(c, STATUS_ERROR, "%s: %s (value reference %u) is %s", f->name,
                    vr[i] == TIME ? "time" : VARIABLES[vr[i]].whole, (unsigned)vr[i],
                    type_name(own));
        return false;
    }
    return true;
}

/* Check the number of values of variables that exist. */
static bool check_count(const struct instance *c, const struct function *f,
                        const fmi3ValueReference vr[], size_t n, size_t n_values)
{
    size_t needed = 0;
    for (size_t i = 0; i < n; i++)
        needed += count_of(vr[i]);
    if (needed == n_values)
        return true;
    log_message(c, STATUS_ERROR, "%s: nValues = %zu, but the variables have %zu values", f->name,
                n_values, needed);
    return false;
}

static bool check_read(struct instance *c, const struct function *f, enum kind kind,
                       const fmi3ValueReference vr[], size_t n, const void *values,
                       size_t n_values)
{
    return enter_reading(c, f) &&
           (n == 0 || (require(c, f, "valueReferences", vr) && require(c, f, "values", values))) &&
           check_kinds(c, f, (char)kind, true, vr, n) && check_count(c, f, vr, n, n_values);
}

static bool check_write(struct instance *c, const struct function *f, enum kind kind,
                        const fmi3ValueReference vr[], size_t n, const void *values,
                        size_t n_values)
{
    if (!enter_call(c, f) ||
        (n && (!require(c, f, "valueReferences", vr) || !require(c, f, "values", values))) ||
        !check_kinds(c, f, (char)kind, false, vr, n))
        return false;
    for (size_t i = 0; i < n; i++) {
        if (vr[i] != TIME && !check_settable(c, f, vr[i], VARIABLES[vr[i]].whole))
            return false;
        if (vr[i] == TIME) {
            log_message(c, STATUS_ERROR, "%s: time is no parameter or input", f->name);
            return false;
        }
    }
    return check_count(c, f, vr, n, n_values);
}

/* Write the value references of all elements but `time` to `elements`; return how many they are. */
static size_t list_elements(const fmi3ValueReference vr[], size_t n, uint32_t elements[])
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        for (uint32_t j = 0; vr[i] != TIME && j < VARIABLES[vr[i]].count; j++)
            elements[count++] = vr[i] + j * VARIABLES[vr[i]].stride;
    return count;
}

/* Make room for `time` among the `count` values that were read of the `n_values`. */
static void insert_time(double time, const fmi3ValueReference vr[], size_t n, double values[],
                        size_t count, size_t n_values)
{
    while (n-- && count < n_values)
        if (vr[n] == TIME)
            values[--n_values] = time;
        else
            for (size_t j = count_of(vr[n]); j--;)
                values[--n_values] = values[--count];
}

/* Read numbers after check_read. */
static enum status read_numbers(struct instance *c, const struct function *f, enum kind kind,
                                const fmi3ValueReference vr[], size_t n, double values[],
                                size_t n_values)
{
    uint32_t *elements = n_values ? malloc(n_values * sizeof *elements) : NULL;
    if (n_values && !elements) {
        log_message(c, STATUS_ERROR, "%s: no memory for %zu values", f->name, n_values);
        return STATUS_ERROR;
    }
    const size_t count = list_elements(vr, n, elements);
    enum status status = instance_read(c, f, kind, elements, count, values);
    if (status < STATUS_ERROR)
        insert_time(c->last_time, vr, n, values, count, n_values);
    free(elements);
    return status;
}

fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, fmi3Float64 values[], size_t nValues)
{
    if (!check_read(c, &GetFloat64, REAL, valueReferences, nValueReferences, values, nValues))
        return fmi3Error;
    return (fmi3Status)read_numbers(c, &GetFloat64, REAL, valueReferences, nValueReferences, values,
                                    nValues);
}

/* Read numbers into the instance's buffer (instance_room); NULL after an error, or if none. */
static const double *read_to_room(struct instance *c, const struct function *f, enum kind kind,
                                  const fmi3ValueReference vr[], size_t n, const void *values,
                                  size_t n_values, fmi3Status *status)
{
    *status = fmi3Error;
    if (!check_read(c, f, kind, vr, n, values, n_values))
        return NULL;
    double *numbers = instance_room(c, f, n_values);
    if (n_values && !numbers)
        return NULL;
    *status = (fmi3Status)read_numbers(c, f, kind, vr, n, numbers, n_values);
    return *status < fmi3Error ? numbers : NULL;
}

fmi3Status fmi3GetInt32(fmi3Instance c, const fmi3ValueReference valueReferences[],
                        size_t nValueReferences, fmi3Int32 values[], size_t nValues)
{
    fmi3Status status;
    const double *numbers = read_to_room(c, &GetInt32, INTEGER, valueReferences, nValueReferences,
                                         values, nValues, &status);
    for (size_t i = 0; numbers && i < nValues; i++)
        values[i] = (fmi3Int32)numbers[i];
    return status;
}

fmi3Status fmi3GetBoolean(fmi3Instance c, const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, fmi3Boolean values[], size_t nValues)
{
    fmi3Status status;
    const double *numbers = read_to_room(c, &GetBoolean, BOOLEAN, valueReferences,
                                         nValueReferences, values, nValues, &status);
    for (size_t i = 0; numbers && i < nValues; i++)
        values[i] = numbers[i] > 0.0;
    return status;
}

fmi3Status fmi3GetString(fmi3Instance c, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, fmi3String values[], size_t nValues)
{
    /* no array has strings */
    if (!check_read(c, &GetString, STRING, valueReferences, nValueReferences, values, nValues))
        return fmi3Error;
    return (fmi3Status)instance_read_strings(c, &GetString, valueReferences, nValueReferences,
                                             values);
}

/* No array can be set, so there is one value for each variable after check_write. */

fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference valueReferences[],
                          size_t nValueReferences, const fmi3Float64 values[], size_t nValues)
{
    if (!check_write(c, &SetFloat64, REAL, valueReferences, nValueReferences, values, nValues))
        return fmi3Error;
    return (fmi3Status)instance_write(c, &SetFloat64, REAL, valueReferences, nValueReferences,
                                      values);
}

/* Defines a setter for values whose type in C is not double. */
#define SET(Name, kind, type) \
    fmi3Status fmi3Set##Name(fmi3Instance c, const fmi3ValueReference valueReferences[], \
                             size_t nValueReferences, const type values[], size_t nValues) \
    { \
        if (!check_write(c, &Set##Name, kind, valueReferences, nValueReferences, values, nValues)) \
            return fmi3Error; \
        double *numbers = instance_room(c, &Set##Name, nValues); \
        if (nValues && !numbers) \
            return fmi3Error; \
        for (size_t i = 0; i < nValues; i++) \
            numbers[i] = values[i]; \
        return (fmi3Status)instance_write(c, &Set##Name, kind, valueReferences, nValueReferences, \
                                          numbers); \
    }
SET(Int32, INTEGER, fmi3Int32)
SET(Boolean, BOOLEAN, fmi3Boolean)
#undef SET

fmi3Status fmi3SetString(fmi3Instance c, const fmi3ValueReference valueReferences[],
                         size_t nValueReferences, const fmi3String values[], size_t nValues)
{
    if (!check_write(c, &SetString, STRING, valueReferences, nValueReferences, values, nValues))
        return fmi3Error;
    return (fmi3Status)instance_write_strings(c, &SetString, valueReferences, nValueReferences,
                                              values);
}

fmi3Status fmi3_refuse_type(struct instance *c, const char *name, const fmi3ValueReference vr[],
                            size_t n, size_t n_values)
{
    const struct function function = {name, READABLE};
    const bool nothing =
        enter_reading(c, &function) && (!n || require(c, &function, "valueReferences", vr)) &&
        check_kinds(c, &function, '-', false, vr, n) && check_count(c, &function, vr, n, n_values);
    return nothing ? fmi3OK : fmi3Error;
}
