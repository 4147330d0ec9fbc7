/* Values of variables, and rates of inputs. */
#include "instance.h"
#include "variables.h"

#include <math.h>
#include <stdlib.h>

static const char *kind_name(char kind)
{
    return kind == REAL      ? "a Real"
           : kind == INTEGER ? "an Integer"
           : kind == BOOLEAN ? "a Boolean"
                             : "a String";
}

bool is_numeric_output(uint32_t vr)
{
    return VARIABLES[vr].causality == 'o' && VARIABLES[vr].kind != STRING;
}

/*
 * Check that all `n` value references are variables of the kind; log the first that is not.
 *
 * `numbers_too`: numeric outputs of every kind may be read as REAL. FMI has a function for each
 * kind, but some hosts read all outputs as Reals.
 */
static bool check_references(const struct instance *c, const struct function *f, enum kind kind,
                             bool numbers_too, const uint32_t vr[], size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (vr[i] >= VARIABLE_COUNT) {
            log_message(c, STATUS_ERROR, "%s: value reference %u is not one of 0 to %u", f->name,
                        (unsigned)vr[i], (unsigned)(VARIABLE_COUNT - 1));
            return false;
        }
        const struct variable *v = &VARIABLES[vr[i]];
        if ((enum kind)v->kind != kind &&
            !(numbers_too && kind == REAL && is_numeric_output(vr[i]))) {
            log_message(c, STATUS_ERROR, "%s: %s (value reference %u) is %s", f->name, v->name,
                        (unsigned)vr[i], kind_name(v->kind));
            return false;
        }
    }
    return true;
}

static bool enter_read(struct instance *c, const struct function *f, enum kind kind,
                       const uint32_t vr[], size_t n, const void *value)
{
    return enter_reading(c, f) &&
           (n == 0 || (require(c, f, "vr", vr) && require(c, f, "value", value) &&
                       check_references(c, f, kind, true, vr, n)));
}

/* Read all numeric outputs of the kind, or, if that is 0, of every kind, to the cache. */
static enum answer read_outputs(struct instance *c, int kind)
{
    uint32_t vr[MOST_VARIABLES];
    double value[MOST_VARIABLES];
    size_t n = 0;
    for (uint32_t i = 0; i < VARIABLE_COUNT; i++)
        if (is_numeric_output(i) && (kind == 0 || VARIABLES[i].kind == kind)) {
            value[n] = NAN;
            vr[n++] = i;
        }
    enum answer answer = n == 0    ? DONE
                         : kind == 0 ? slave_read_outputs(c->slave, n, value)
                                     : slave_read(c->slave, (enum kind)kind, vr, n, value);
    for (size_t i = 0; i < n; i++)
        c->outputs[vr[i]] = value[i];
    return answer;
}

/*
 * Read all numeric outputs unless they are valid.
 *
 * Most of what a read costs is the call into Python: a host that reads variable by variable, or
 * kind by kind, pays for it once.
 */
static enum status update_outputs(struct instance *c)
{
    if (c->outputs_valid)
        return STATUS_OK;
    enum answer answer = DONE;
    if (slave_has_outputs(c->slave))
        answer = read_outputs(c, 0);
    else
        for (const char *kind = "RIB"; *kind && answer == DONE; kind++)
            answer = read_outputs(c, *kind);
    enum status status = leave_call(c, answer);
    c->outputs_valid = status == STATUS_OK;
    return status;
}

/* Read from the slave those `count` of the `n` variables that are no numeric outputs. */
static enum status read_others(struct instance *c, const struct function *f, enum kind kind,
                               const uint32_t vr[], size_t n, size_t count, double value[])
{
    if (count == n)
        return leave_call(c, slave_read(c->slave, kind, vr, n, value));
    uint32_t *references = malloc(count * sizeof *references);
    double *found = malloc(count * sizeof *found);
    enum status status = STATUS_ERROR;
    if (references && found) {
        size_t k = 0;
        for (size_t i = 0; i < n; i++)
            if (!is_numeric_output(vr[i])) {
                found[k] = NAN;
                references[k++] = vr[i];
            }
        status = leave_call(c, slave_read(c->slave, kind, references, count, found));
        for (size_t i = n; i--;)
            if (!is_numeric_output(vr[i]))
                value[i] = found[--k];
    } else {
        log_message(c, STATUS_ERROR, "%s: no memory for %zu values", f->name, count);
    }
    free(found);
    free(references);
    return status;
}

enum status instance_read(struct instance *c, const struct function *f, enum kind kind,
                          const uint32_t vr[], size_t n, double value[])
{
    if (!enter_read(c, f, kind, vr, n, value))
        return STATUS_ERROR;
    size_t others = 0;
    enum status status = STATUS_OK;
    for (size_t i = 0; i < n; i++)
        others += !is_numeric_output(vr[i]);
    if (others < n) {
        status = update_outputs(c);
        for (size_t i = 0; i < n; i++)
            if (is_numeric_output(vr[i]))
                value[i] = c->outputs[vr[i]];
    }
    if (others && c->slave) {
        enum status other = read_others(c, f, kind, vr, n, others, value);
        return other > status ? other : status;
    }
    return status;
}

enum status instance_read_strings(struct instance *c, const struct function *f,
                                  const uint32_t vr[], size_t n, const char *value[])
{
    if (!enter_read(c, f, STRING, vr, n, value))
        return STATUS_ERROR;
    return n ? leave_call(c, slave_read_strings(c->slave, vr, n, value)) : STATUS_OK;
}

bool check_settable(const struct instance *c, const struct function *f, uint32_t vr,
                    const char *name)
{
    const char causality = VARIABLES[vr].causality;
    if (causality == 'i' || (causality == 'p' && c->phase & BEFORE_STEPS))
        return true;
    log_message(c, STATUS_ERROR, "%s: %s %s", f->name, name,
                causality == 'p' ? "is a fixed parameter: set it before the end of the "
                                   "initialization mode, or reset"
                                 : "is no parameter or input");
    return false;
}

/* Check that all variables may be set in this phase; log the first that may not. */
static bool check_all_settable(const struct instance *c, const struct function *f,
                               const uint32_t vr[], size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!check_settable(c, f, vr[i], VARIABLES[vr[i]].name))
            return false;
    return true;
}

/*
 * Check a call that sets variables of the kind. Bounds of numbers are not checked here: the slave
 * does so when it uses them. Texts must be UTF-8 before they reach Python.
 */
static bool enter_write(struct instance *c, const struct function *f, enum kind kind,
                        const uint32_t vr[], size_t n, const void *value)
{
    return enter_call(c, f) &&
           (n == 0 || (require(c, f, "vr", vr) && require(c, f, "value", value) &&
                       check_references(c, f, kind, false, vr, n) &&
                       check_all_settable(c, f, vr, n)));
}

enum status instance_write(struct instance *c, const struct function *f, enum kind kind,
                           const uint32_t vr[], size_t n, const double value[])
{
    if (!enter_write(c, f, kind, vr, n, value))
        return STATUS_ERROR;
    return n ? leave_call(c, slave_write(c->slave, kind, vr, n, value)) : STATUS_OK;
}

static bool check_texts(const struct instance *c, const struct function *f, const uint32_t vr[],
                        size_t n, const char *const value[])
{
    for (size_t i = 0; i < n; i++)
        if (!value[i] || !decode_utf8(value[i], NULL, 0)) {
            log_message(c, STATUS_ERROR, "%s: the value of %s is %s", f->name,
                        VARIABLES[vr[i]].name, value[i] ? "not UTF-8" : "NULL");
            return false;
        }
    return true;
}

enum status instance_write_strings(struct instance *c, const struct function *f,
                                   const uint32_t vr[], size_t n, const char *const value[])
{
    if (!enter_write(c, f, STRING, vr, n, value) || !check_texts(c, f, vr, n, value))
        return STATUS_ERROR;
    return n ? leave_call(c, slave_write_strings(c->slave, vr, n, value)) : STATUS_OK;
}

static bool check_rates(const struct instance *c, const struct function *f, const uint32_t vr[],
                        size_t n, const int32_t order[])
{
    for (size_t i = 0; i < n; i++) {
        const struct variable *v = &VARIABLES[vr[i]];
        if (v->causality != 'i') {
            log_message(c, STATUS_ERROR, "%s: %s is no input", f->name, v->name);
            return false;
        }
        if (order[i] != 1) {
            log_message(c, STATUS_ERROR, "%s: order = %d of %s; only the first derivative is taken",
                        f->name, (int)order[i], v->name);
            return false;
        }
    }
    return true;
}

enum status instance_write_rates(struct instance *c, const struct function *f,
                                 const uint32_t vr[], size_t n, const int32_t order[],
                                 const double value[])
{
    if (!enter_call(c, f))
        return STATUS_ERROR;
    if (n == 0)
        return STATUS_OK;
    if (!require(c, f, "vr", vr) || !require(c, f, "order", order) ||
        !require(c, f, "value", value) || !check_references(c, f, REAL, false, vr, n) ||
        !check_rates(c, f, vr, n, order))
        return STATUS_ERROR;
    uint32_t *rates = malloc(n * sizeof *rates);
    if (!rates)
        return STATUS_ERROR;
    for (size_t i = 0; i < n; i++)
        rates[i] = RATES + vr[i];
    enum answer answer = slave_write(c->slave, REAL, rates, n, value);
    free(rates);
    return leave_call(c, answer);
}

double *instance_room(struct instance *c, const struct function *f, size_t n)
{
    if (n > c->room) {
        double *more = n <= SIZE_MAX / sizeof *more ? realloc(c->numbers, n * sizeof *more) : NULL;
        if (!more) {
            log_message(c, STATUS_ERROR, "%s: no memory for %zu values", f->name, n);
            return NULL;
        }
        c->numbers = more;
        c->room = n;
    }
    return c->numbers;
}
