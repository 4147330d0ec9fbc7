/* Values of variables, and rates of inputs. */
#include "front.h"
#include "variables.h"

#include <math.h>
#include <stdlib.h>

static const char *type_name(char type)
{
    return type == 'R'   ? "a Real"
           : type == 'I' ? "an Integer"
           : type == 'B' ? "a Boolean"
                         : "a String";
}

/* Check that all `n` value references are variables of the type; log the first that is not. */
static bool check_references(const struct instance *c, const char *function, char type,
                             const fmi2ValueReference vr[], size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (vr[i] >= VARIABLE_COUNT) {
            log_message(c, fmi2Error, "%s: value reference %u is not one of 0 to %d", function,
                        vr[i], VARIABLE_COUNT - 1);
            return false;
        }
        const struct variable *v = &VARIABLES[vr[i]];
        if (v->type != type) {
            log_message(c, fmi2Error, "%s: %s (value reference %u) is %s", function, v->name, vr[i],
                        type_name(v->type));
            return false;
        }
    }
    return true;
}

static bool is_numeric_output(fmi2ValueReference vr)
{
    return VARIABLES[vr].causality == 'o' && VARIABLES[vr].type != 'S';
}

static bool are_numeric_outputs(const fmi2ValueReference vr[], size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!is_numeric_output(vr[i]))
            return false;
    return true;
}

/* Enter a getter. Reading changes nothing, so outputs that are valid stay so. */
static bool enter_get(struct instance *c, const char *function, char type,
                      const fmi2ValueReference vr[], size_t n, const void *value)
{
    bool valid = c && c->outputs_valid;
    if (!enter_call(c, function, ANY))
        return false;
    c->outputs_valid = valid;
    return n == 0 || (require(c, function, "vr", vr) && require(c, function, "value", value) &&
                      check_references(c, function, type, vr, n));
}

/*
 * Read all numeric outputs in one call of the slave, unless they are valid.
 *
 * Most of what a read costs is the call into Python: an importer that reads variable by variable,
 * or type by type, pays for it once.
 */
static fmi2Status update_outputs(struct instance *c)
{
    if (c->outputs_valid)
        return fmi2OK;
    fmi2ValueReference vr[VARIABLE_COUNT];
    fmi2Real value[VARIABLE_COUNT];
    size_t n = 0;
    for (fmi2ValueReference i = 0; i < VARIABLE_COUNT; i++)
        if (is_numeric_output(i)) {
            value[n] = NAN;
            vr[n++] = i;
        }
    fmi2Status status = leave_call(c, pythonfmu.GetReal(c->slave, vr, n, value));
    for (size_t i = 0; i < n; i++)
        c->output_values[vr[i]] = value[i];
    c->outputs_valid = status == fmi2OK;
    return status;
}

static fmi2Real as_real(fmi2Real number)
{
    return number;
}

static fmi2Integer as_integer(fmi2Real number)
{
    return isnan(number) ? 0 : (fmi2Integer)number;
}

static fmi2Boolean as_boolean(fmi2Real number)
{
    return number > 0.0 ? fmi2True : fmi2False;
}

#define DEFINE_GETTER(Type, letter, converted) \
    fmi2Status fmi2Get##Type(fmi2Component component, const fmi2ValueReference vr[], size_t nvr, \
                             fmi2##Type value[]) \
    { \
        struct instance *c = component; \
        if (!enter_get(c, "fmi2Get" #Type, letter, vr, nvr, value)) \
            return fmi2Error; \
        if (nvr == 0) \
            return fmi2OK; \
        if (!are_numeric_outputs(vr, nvr)) \
            return leave_call(c, pythonfmu.Get##Type(c->slave, vr, nvr, value)); \
        fmi2Status status = update_outputs(c); \
        for (size_t i = 0; i < nvr; i++) \
            value[i] = converted(c->output_values[vr[i]]); \
        return status; \
    }

DEFINE_GETTER(Real, 'R', as_real)
DEFINE_GETTER(Integer, 'I', as_integer)
DEFINE_GETTER(Boolean, 'B', as_boolean)

fmi2Status fmi2GetString(fmi2Component component, const fmi2ValueReference vr[], size_t nvr,
                         fmi2String value[])
{
    struct instance *c = component;
    if (!enter_get(c, "fmi2GetString", 'S', vr, nvr, value))
        return fmi2Error;
    return nvr ? leave_call(c, pythonfmu.GetString(c->slave, vr, nvr, value)) : fmi2OK;
}

/* Check that all variables may be set in this phase; log the first that may not. */
static bool check_settable(const struct instance *c, const char *function,
                           const fmi2ValueReference vr[], size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const struct variable *v = &VARIABLES[vr[i]];
        bool initial = c->phase & (INSTANTIATED | INITIALIZING);
        if (v->causality == 'i' || (v->causality == 'p' && initial))
            continue;
        log_message(c, fmi2Error, "%s: %s %s", function, v->name,
                    v->causality == 'p' ? "is a fixed parameter: set it before "
                                          "fmi2ExitInitializationMode, or reset"
                                        : "is no parameter or input");
        return false;
    }
    return true;
}

/*
 * Enter a setter of the type. The slave checks numbers against their bounds when it uses them;
 * texts must be UTF-8 before they reach Python.
 */
static bool enter_set(struct instance *c, const char *function, char type,
                      const fmi2ValueReference vr[], size_t n, const void *value)
{
    if (!enter_call(c, function, INSTANTIATED | INITIALIZING | STEPPING))
        return false;
    return n == 0 ||
           (require(c, function, "vr", vr) && require(c, function, "value", value) &&
            check_references(c, function, type, vr, n) && check_settable(c, function, vr, n));
}

static bool check_texts(const struct instance *c, const fmi2ValueReference vr[], size_t n,
                        const fmi2String value[])
{
    for (size_t i = 0; i < n; i++)
        if (!value[i] || !decode_utf8(value[i], NULL, 0)) {
            log_message(c, fmi2Error, "fmi2SetString: the value of %s is %s", VARIABLES[vr[i]].name,
                        value[i] ? "not UTF-8" : "NULL");
            return false;
        }
    return true;
}

#define DEFINE_SETTER(Type, letter) \
    fmi2Status fmi2Set##Type(fmi2Component component, const fmi2ValueReference vr[], size_t nvr, \
                             const fmi2##Type value[]) \
    { \
        struct instance *c = component; \
        if (!enter_set(c, "fmi2Set" #Type, letter, vr, nvr, value)) \
            return fmi2Error; \
        return nvr ? leave_call(c, pythonfmu.Set##Type(c->slave, vr, nvr, value)) : fmi2OK; \
    }

DEFINE_SETTER(Real, 'R')
DEFINE_SETTER(Integer, 'I')
DEFINE_SETTER(Boolean, 'B')

fmi2Status fmi2SetString(fmi2Component component, const fmi2ValueReference vr[], size_t nvr,
                         const fmi2String value[])
{
    struct instance *c = component;
    if (!enter_set(c, "fmi2SetString", 'S', vr, nvr, value) || !check_texts(c, vr, nvr, value))
        return fmi2Error;
    return nvr ? leave_call(c, pythonfmu.SetString(c->slave, vr, nvr, value)) : fmi2OK;
}

static bool check_rates(const struct instance *c, const char *function,
                        const fmi2ValueReference vr[], size_t n, const fmi2Integer order[])
{
    for (size_t i = 0; i < n; i++) {
        const struct variable *v = &VARIABLES[vr[i]];
        if (v->causality != 'i') {
            log_message(c, fmi2Error, "%s: %s is no input", function, v->name);
            return false;
        }
        if (order[i] != 1) {
            log_message(c, fmi2Error, "%s: order = %d of %s; only the first derivative is taken",
                        function, order[i], v->name);
            return false;
        }
    }
    return true;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component component, const fmi2ValueReference vr[],
                                       size_t nvr, const fmi2Integer order[],
                                       const fmi2Real value[])
{
    static const char function[] = "fmi2SetRealInputDerivatives";
    struct instance *c = component;
    if (!enter_call(c, function, INSTANTIATED | INITIALIZING | STEPPING))
        return fmi2Error;
    if (nvr == 0)
        return fmi2OK;
    if (!require(c, function, "vr", vr) || !require(c, function, "order", order) ||
        !require(c, function, "value", value) || !check_references(c, function, 'R', vr, nvr) ||
        !check_rates(c, function, vr, nvr, order))
        return fmi2Error;
    fmi2ValueReference *rates = malloc(nvr * sizeof *rates);
    if (!rates)
        return fmi2Error;
    for (size_t i = 0; i < nvr; i++)
        rates[i] = RATES + vr[i];
    fmi2Status status = leave_call(c, pythonfmu.SetReal(c->slave, rates, nvr, value));
    free(rates);
    return status;
}

static fmi2Status refuse(struct instance *c, const char *function, const char *feature)
{
    if (enter_call(c, function, ANY))
        log_message(c, fmi2Error, "%s: this FMU has no %s", function, feature);
    return fmi2Error;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                        const fmi2Integer order[], fmi2Real value[])
{
    (void)vr, (void)nvr, (void)order, (void)value;
    return refuse(c, "fmi2GetRealOutputDerivatives", "derivatives of outputs");
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference vUnknown_ref[],
                                        size_t nUnknown, const fmi2ValueReference vKnown_ref[],
                                        size_t nKnown, const fmi2Real dvKnown[],
                                        fmi2Real dvUnknown[])
{
    (void)vUnknown_ref, (void)nUnknown, (void)vKnown_ref, (void)nKnown, (void)dvKnown;
    (void)dvUnknown;
    return refuse(c, "fmi2GetDirectionalDerivative", "directional derivatives");
}
