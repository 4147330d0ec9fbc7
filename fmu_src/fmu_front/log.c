/* Messages to the host; what every call does when it enters and leaves. */
#include "instance.h"
#include "variables.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char *const STATUS_CATEGORIES[] = {"logAll", "logStatusWarning", "logStatusDiscard",
                                                "logStatusError"};

int category_index(const char *name)
{
    for (size_t i = 0; i < sizeof CATEGORIES / sizeof *CATEGORIES; i++)
        if (strcmp(CATEGORIES[i], name) == 0)
            return (int)i;
    return -1;
}

static bool is_logged(const struct host *host, const char *category)
{
    int all = category_index("logAll"), own = category_index(category);
    return host->logging && host->send &&
           (host->categories == 0 || (all >= 0 && host->categories >> all & 1) ||
            (own >= 0 && host->categories >> own & 1));
}

static void send_message(const struct instance *c, enum status status, const char *category,
                         const char *text)
{
    if (!category || !*category)
        category = STATUS_CATEGORIES[status];
    const bool taken = status >= STATUS_ERROR && c->host.takes_errors && c->host.send;
    if (taken || is_logged(&c->host, category))
        c->host.send(&c->host, c->name, status, category, text);
    else if (status >= STATUS_ERROR)
        fprintf(stderr, "%s (%s): %s\n", MODEL_NAME, c->name, text);
}

void log_message(const struct instance *c, enum status status, const char *format, ...)
{
    struct message message;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message.text, sizeof message.text, format, arguments);
    va_end(arguments);
    make_utf8(message.text); /* the host's own texts need not be, and long ones are cut */
    send_message(c, status, NULL, message.text);
}

void log_from_slave(void *instance, enum status status, const char *category, const char *text)
{
    struct instance *c = instance;
    if (status > c->worst_status)
        c->worst_status = status;
    send_message(c, status, category, text);
}

static const char *description_of(const struct instance *c)
{
    switch (c->phase) {
    case INSTANTIATED:
        return "before the initialization mode";
    case INITIALIZING:
        return "in initialization mode";
    case STEPPING:
        return c->host.event_mode ? "in step mode" : "after the initialization mode";
    case EVENT_MODE:
        return "in event mode";
    case UPDATING:
        return "in an intermediate update";
    case TERMINATED:
        return "after the termination";
    default:
        return "of an instance that an internal error has ended; reset or free it";
    }
}

bool enter_call(struct instance *c, const struct function *f)
{
    if (!c)
        return false;
    c->worst_status = STATUS_OK;
    c->outputs_valid = false;
    if (f->name[sizeof "fmi" - 1] != c->host.version) {
        log_message(c, STATUS_ERROR, "%s: the instance was made by FMI %c.0", f->name,
                    c->host.version);
        return false;
    }
    if (c->phase & f->phases)
        return true;
    log_message(c, STATUS_ERROR, "%s must not be called %s", f->name, description_of(c));
    return false;
}

bool enter_reading(struct instance *c, const struct function *f)
{
    bool valid = c && c->outputs_valid;
    if (!enter_call(c, f))
        return false;
    c->outputs_valid = valid;
    return true;
}

bool require(const struct instance *c, const struct function *f, const char *argument,
             const void *pointer)
{
    if (!pointer)
        log_message(c, STATUS_ERROR, "%s: %s is NULL", f->name, argument);
    return pointer != NULL;
}

enum status leave_call(struct instance *c, enum answer answer)
{
    if (answer == LOST) {
        c->phase = SLAVE_LOST;
        slave_free(c->slave);
        c->slave = NULL;
        return STATUS_ERROR;
    }
    return answer == REFUSED && c->worst_status < STATUS_DISCARD ? STATUS_DISCARD
                                                                  : c->worst_status;
}
