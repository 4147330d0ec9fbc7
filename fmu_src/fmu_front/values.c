/* Values of variables, and rates of inputs. */
#include "front.h"
#include "variables.h"

#include <math.h>
#include <stdlib.h>

static const char *type_name(char type)
{
    return type == 'R' ? "a Real" : type == 'I' ? "an Integer" : type == 'B' ? "a Boolean" : "a String";
}

/* Whether all `n` value references are variables of the type, said why not. */
static bool known(const struct instance *c, const char *function, char type, const fmi2ValueReference vr[], size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (vr[i] >= VARIABLE_COUNT) {
            say(c, fmi2Error, "%s: value reference %u is not one of 0 to %d", function, vr[i], VARIABLE_COUNT - 1);
            return false;
        }
        if (VARIABLES[vr[i]].type != type) {
            say(c, fmi2Error, "%s: %s (value reference %u) is %s", function, VARIABLES[vr[i]].name, vr[i], type_name(VARIABLES[vr[i]].type));
            return false;
        }
    }
    return true;
}

/* Whether they may be set now, said why not. */
static bool settable(const struct instance *c, const char *function, const fmi2ValueReference vr[], size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const struct variable *v = &VARIABLES[vr[i]];
        if (v->causality == 'i' || (v->causality == 'p' && (c->phase & (INSTANTIATED | INITIALIZING))))
            continue;
        say(c, fmi2Error, "%s: %s %s", function, v->name,
            v->causality == 'p' ? "is a fixed parameter: set it before fmi2ExitInitializationMode, or reset" : "is no parameter or input");
        return false;
    }
    return true;
}

static bool is_numeric_output(fmi2ValueReference vr)
{
    return VARIABLES[vr].causality == 'o' && VARIABLES[vr].type != 'S';
}

/*
 * Read all outputs that are numbers, whatever their type. Most of what reading one costs is the way into Python and back: a host that
 * reads them one by one, or type by type, goes it once.
 */
static fmi2Status read_outputs(struct instance *c)
{
    fmi2ValueReference vr[VARIABLE_COUNT];
    fmi2Real value[VARIABLE_COUNT];
    size_t n = 0;
    for (fmi2ValueReference i = 0; i < VARIABLE_COUNT; i++)
        if (is_numeric_output(i)) {
            value[n] = NAN;
            vr[n++] = i;
        }
    fmi2Status status = end(c, stock.GetReal(c->slave, vr, n, value));
    for (size_t i = 0; i < n; i++)
        c->values[vr[i]] = value[i];
    c->fresh = status == fmi2OK;
    return status;
}

#define GETTER(Type, letter, from_real)                                                                                                    \
    fmi2Status fmi2Get##Type(fmi2Component component, const fmi2ValueReference vr[], size_t nvr, fmi2##Type value[])                       \
    {                                                                                                                                      \
        static const char function[] = "fmi2Get" #Type;                                                                                    \
        struct instance *c = component;                                                                                                    \
        bool fresh = c && c->fresh, outputs = true;                                                                                        \
        if (!begin(c, function, ANY))                                                                                                      \
            return fmi2Error;                                                                                                              \
        c->fresh = fresh; /* to get changes nothing */                                                                                     \
        if (nvr == 0)                                                                                                                      \
            return fmi2OK;                                                                                                                 \
        if (!given(c, function, "vr", vr) || !given(c, function, "value", value) || !known(c, function, letter, vr, nvr))                  \
            return fmi2Error;                                                                                                              \
        for (size_t i = 0; i < nvr && outputs; i++)                                                                                        \
            outputs = is_numeric_output(vr[i]);                                                                                            \
        if (!outputs)                                                                                                                      \
            return end(c, stock.Get##Type(c->slave, vr, nvr, value));                                                                      \
        fmi2Status status = fresh ? fmi2OK : read_outputs(c);                                                                              \
        for (size_t i = 0; i < nvr; i++)                                                                                                   \
            value[i] = from_real(c->values[vr[i]]);                                                                                        \
        return status;                                                                                                                     \
    }

#define same(number) (number)
#define integer(number) (isnan(number) ? 0 : (fmi2Integer)(number))
#define truth(number) ((number) > 0.0 ? fmi2True : fmi2False)
#define no_text(number) ((void)(number), NULL) /* no output is a text */

GETTER(Real, 'R', same)
GETTER(Integer, 'I', integer)
GETTER(Boolean, 'B', truth)
GETTER(String, 'S', no_text)

static bool may_set(struct instance *c, const char *function, char type, const fmi2ValueReference vr[], size_t n, const void *value)
{
    return given(c, function, "vr", vr) && given(c, function, "value", value) && known(c, function, type, vr, n) &&
           settable(c, function, vr, n);
}

#define SETTER(Type, letter)                                                                                                               \
    fmi2Status fmi2Set##Type(fmi2Component component, const fmi2ValueReference vr[], size_t nvr, const fmi2##Type value[])                 \
    {                                                                                                                                      \
        static const char function[] = "fmi2Set" #Type;                                                                                    \
        struct instance *c = component;                                                                                                    \
        if (!begin(c, function, INSTANTIATED | INITIALIZING | STEPPING))                                                                   \
            return fmi2Error;                                                                                                              \
        if (nvr == 0)                                                                                                                      \
            return fmi2OK;                                                                                                                 \
        if (!may_set(c, function, letter, vr, nvr, value) || !valid_##Type(c, vr, nvr, value))                                             \
            return fmi2Error;                                                                                                              \
        return end(c, stock.Set##Type(c->slave, vr, nvr, value));                                                                          \
    }

/* Numbers are checked by the slave against their bounds, when they are used. Texts must be texts before they reach Python. */
#define valid_Real(c, vr, n, value) true
#define valid_Integer(c, vr, n, value) true
#define valid_Boolean(c, vr, n, value) true

static bool valid_String(const struct instance *c, const fmi2ValueReference vr[], size_t n, const fmi2String value[])
{
    for (size_t i = 0; i < n; i++)
        if (!value[i] || !decode_utf8(value[i], NULL, 0)) {
            say(c, fmi2Error, "fmi2SetString: the value of %s is %s", VARIABLES[vr[i]].name, value[i] ? "not UTF-8" : "NULL");
            return false;
        }
    return true;
}

SETTER(Real, 'R')
SETTER(Integer, 'I')
SETTER(Boolean, 'B')
SETTER(String, 'S')

fmi2Status fmi2SetRealInputDerivatives(fmi2Component component, const fmi2ValueReference vr[], size_t nvr, const fmi2Integer order[],
                                       const fmi2Real value[])
{
    static const char function[] = "fmi2SetRealInputDerivatives";
    struct instance *c = component;
    if (!begin(c, function, INSTANTIATED | INITIALIZING | STEPPING))
        return fmi2Error;
    if (nvr == 0)
        return fmi2OK;
    if (!given(c, function, "vr", vr) || !given(c, function, "order", order) || !given(c, function, "value", value) ||
        !known(c, function, 'R', vr, nvr))
        return fmi2Error;
    for (size_t i = 0; i < nvr; i++) {
        const struct variable *v = &VARIABLES[vr[i]];
        if (v->causality != 'i' || order[i] != 1) {
            if (v->causality != 'i')
                say(c, fmi2Error, "%s: %s is no input", function, v->name);
            else
                say(c, fmi2Error, "%s: order = %d of %s; only the first derivative is taken", function, order[i], v->name);
            return fmi2Error;
        }
    }
    fmi2ValueReference *rates = malloc(nvr * sizeof *rates);
    if (!rates)
        return fmi2Error;
    for (size_t i = 0; i < nvr; i++)
        rates[i] = RATES + vr[i];
    fmi2Status status = end(c, stock.SetReal(c->slave, rates, nvr, value));
    free(rates);
    return status;
}

static fmi2Status unsupported(struct instance *c, const char *function, const char *what)
{
    if (begin(c, function, ANY))
        say(c, fmi2Error, "%s: this FMU has no %s", function, what);
    return fmi2Error;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Integer order[],
                                        fmi2Real value[])
{
    (void)vr, (void)nvr, (void)order, (void)value;
    return unsupported(c, "fmi2GetRealOutputDerivatives", "derivatives of outputs");
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference vUnknown_ref[], size_t nUnknown,
                                        const fmi2ValueReference vKnown_ref[], size_t nKnown, const fmi2Real dvKnown[],
                                        fmi2Real dvUnknown[])
{
    (void)vUnknown_ref, (void)nUnknown, (void)vKnown_ref, (void)nKnown, (void)dvKnown, (void)dvUnknown;
    return unsupported(c, "fmi2GetDirectionalDerivative", "directional derivatives");
}
