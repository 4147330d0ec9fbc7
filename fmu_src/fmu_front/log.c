/* Messages to the host, and the frame of every call. */
#include "front.h"
#include "python.h"
#include "variables.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char *const STATUS_CATEGORIES[] = {"logAll", "logStatusWarning", "logStatusDiscard", "logStatusError", "logStatusFatal"};

int category_index(const char *name)
{
    for (size_t i = 0; i < sizeof CATEGORIES / sizeof *CATEGORIES; i++)
        if (strcmp(CATEGORIES[i], name) == 0)
            return (int)i;
    return -1;
}

static bool wanted(const struct instance *c, const char *category)
{
    int all = category_index("logAll"), own = category_index(category);
    return c->logging && c->host.logger &&
           (c->categories == 0 || (all >= 0 && c->categories >> all & 1) || (own >= 0 && c->categories >> own & 1));
}

static void deliver(const struct instance *c, fmi2Status status, const char *category, const char *text)
{
    if (!category || !*category)
        category = STATUS_CATEGORIES[status <= fmi2Fatal ? status : fmi2Error];
    if (!wanted(c, category)) {
        if (status >= fmi2Error)
            fprintf(stderr, "RlvLanding (%s): %s\n", c->name, text);
        return;
    }
    /* the host takes the message for a format: a path or a value of the user's may hold a % */
    char escaped[2 * sizeof(struct message)], *to = escaped;
    for (; *text && to < escaped + sizeof escaped - 2; text++) {
        if (*text == '%')
            *to++ = '%';
        *to++ = *text;
    }
    *to = '\0';
    c->host.logger(c->host.componentEnvironment, c->name, status, category, escaped);
}

void say(const struct instance *c, fmi2Status status, const char *format, ...)
{
    struct message message;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message.text, sizeof message.text, format, arguments);
    va_end(arguments);
    deliver(c, status, NULL, message.text);
}

void relay(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category, fmi2String message, ...)
{
    (void)name;
    struct instance *c = environment;
    if (status >= fmi2Fatal) { /* an exception that the slave did not catch: this instance is lost, the host is not */
        /* the slave catches all but interrupts, which Python 3.10 and 3.11 leave without a value */
        c->interrupted |= strstr(message, "KeyboardInterrupt") || strstr(message, "unknown error");
        status = fmi2Error;
        category = NULL;
    }
    if (status > c->worst)
        c->worst = status;
    deliver(c, status, category, message);
}

bool begin(struct instance *c, const char *function, unsigned phases)
{
    if (!c)
        return false;
    c->worst = fmi2OK;
    c->fresh = false;
    if (c->phase & phases)
        return true;
    const char *now = c->phase == INSTANTIATED   ? "before fmi2EnterInitializationMode"
                      : c->phase == INITIALIZING ? "in initialization mode"
                      : c->phase == STEPPING     ? "after fmi2ExitInitializationMode"
                      : c->phase == TERMINATED   ? "after fmi2Terminate"
                                                 : "of an instance that an internal error has ended; reset or free it";
    say(c, fmi2Error, "%s must not be called %s", function, now);
    return false;
}

bool given(const struct instance *c, const char *function, const char *argument, const void *pointer)
{
    if (!pointer)
        say(c, fmi2Error, "%s: %s is NULL", function, argument);
    return pointer != NULL;
}

fmi2Status end(struct instance *c, fmi2Status status)
{
    if (status >= fmi2Fatal) {
        c->phase = LOST;
        c->slave = NULL;
        status = fmi2Error;
    }
    if (c->interrupted) {
        c->interrupted = false;
        python_interrupt();
    }
    return status > c->worst ? status : c->worst;
}
