/* Messages to the importer; what every call does when it enters and leaves. */
#include "front.h"
#include "python.h"
#include "variables.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char *const STATUS_CATEGORIES[] = {"logAll", "logStatusWarning", "logStatusDiscard",
                                                "logStatusError", "logStatusFatal"};

int category_index(const char *name)
{
    for (size_t i = 0; i < sizeof CATEGORIES / sizeof *CATEGORIES; i++)
        if (strcmp(CATEGORIES[i], name) == 0)
            return (int)i;
    return -1;
}

static bool is_logged(const struct instance *c, const char *category)
{
    int all = category_index("logAll"), own = category_index(category);
    return c->logging && c->host_callbacks.logger &&
           (c->categories == 0 || (all >= 0 && c->categories >> all & 1) ||
            (own >= 0 && c->categories >> own & 1));
}

static void send_message(const struct instance *c, fmi2Status status, const char *category,
                         const char *text)
{
    if (!category || !*category)
        category = STATUS_CATEGORIES[status <= fmi2Fatal ? status : fmi2Error];
    if (!is_logged(c, category)) {
        if (status >= fmi2Error)
            fprintf(stderr, "RlvLanding (%s): %s\n", c->name, text);
        return;
    }
    /* the importer takes the message as a format, and a path or a value in it may hold a % */
    char escaped[2 * sizeof(struct message)], *to = escaped;
    for (; *text && to < escaped + sizeof escaped - 2; text++) {
        if (*text == '%')
            *to++ = '%';
        *to++ = *text;
    }
    *to = '\0';
    c->host_callbacks.logger(c->host_callbacks.componentEnvironment, c->name, status, category,
                             escaped);
}

void log_message(const struct instance *c, fmi2Status status, const char *format, ...)
{
    struct message message;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message.text, sizeof message.text, format, arguments);
    va_end(arguments);
    send_message(c, status, NULL, message.text);
}

void log_from_slave(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                    fmi2String category, fmi2String message, ...)
{
    (void)name;
    struct instance *c = environment;
    if (status >= fmi2Fatal) {
        /* An exception that the slave did not catch: an error of this instance, not of the process.
         * The slave catches all but interrupts, which Python 3.10 and 3.11 report without a value.
         */
        c->interrupted |= strstr(message, "KeyboardInterrupt") || strstr(message, "unknown error");
        status = fmi2Error;
        category = NULL;
    }
    if (status > c->worst_status)
        c->worst_status = status;
    send_message(c, status, category, message);
}

bool enter_call(struct instance *c, const char *function, unsigned phases)
{
    if (!c)
        return false;
    c->worst_status = fmi2OK;
    c->outputs_valid = false;
    if (c->phase & phases)
        return true;
    const char *now = c->phase == INSTANTIATED   ? "before fmi2EnterInitializationMode"
                      : c->phase == INITIALIZING ? "in initialization mode"
                      : c->phase == STEPPING     ? "after fmi2ExitInitializationMode"
                      : c->phase == TERMINATED
                          ? "after fmi2Terminate"
                          : "of an instance that an internal error has ended; reset or free it";
    log_message(c, fmi2Error, "%s must not be called %s", function, now);
    return false;
}

bool require(const struct instance *c, const char *function, const char *argument,
             const void *pointer)
{
    if (!pointer)
        log_message(c, fmi2Error, "%s: %s is NULL", function, argument);
    return pointer != NULL;
}

fmi2Status leave_call(struct instance *c, fmi2Status status)
{
    if (status >= fmi2Fatal) {
        c->phase = SLAVE_LOST;
        c->slave = NULL;
        status = fmi2Error;
    }
    if (c->interrupted) {
        c->interrupted = false;
        interrupt_python();
    }
    return status > c->worst_status ? status : c->worst_status;
}
