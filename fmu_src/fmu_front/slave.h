/*
 * The slave: an object in Python, of the class that the FMU's script defines.
 *
 * Only slave.c and visit.c, with python.c and libpython.c, call Python. The class is one of
 * pythonfmu's `Fmi2Slave`; its methods are called as pythonfmu's own binary calls them. Two more
 * are called if they are there: `get_outputs()` gives all numeric outputs, in the order of the
 * description; `do_part(time, step, stop, to_event)` ends a step early, at `stop` or at an event,
 * and gives the time reached and whether there is an event.
 */
#ifndef SLAVE_H
#define SLAVE_H

#include "text.h"

#include <stdint.h>

/* The numbers are FMI's. */
enum status { STATUS_OK, STATUS_WARNING, STATUS_DISCARD, STATUS_ERROR };

/* The result of a call to the slave. */
enum answer {
    DONE,
    REFUSED, /* nothing has changed; of a step: the slave returned False */
    LOST     /* an exception or the end of Python: the slave must not be called again */
};

/* Type of a variable, a letter of the description's type. */
enum kind { REAL = 'R', INTEGER = 'I', BOOLEAN = 'B', STRING = 'S' };

/* Receives the slave's messages. `category` is NULL where the status says it. */
struct listener {
    void (*receive)(void *owner, enum status status, const char *category, const char *text);
    void *owner;
};

struct slave;
struct slave_state;

/*
 * Make the slave from the script in the folder `resources`; Python must be ready.
 *
 * Returns NULL, with the reason given to the listener, if that fails.
 */
struct slave *slave_create(const char *resources, const char *name, bool visible,
                           const struct listener *listener);
void slave_free(struct slave *s);

enum answer slave_setup(struct slave *s, double start, const double *stop, const double *tolerance);
enum answer slave_enter_initialization(struct slave *s);
enum answer slave_exit_initialization(struct slave *s);
enum answer slave_step(struct slave *s, double time, double step);
/* A part of a communication step: where it shall end, and where it has ended. */
struct part {
    double stop; /* end of the part; infinite: that of the step */
    bool to_event; /* end it at the first event before `stop` */
    double reached; /* `stop`, or the time of an event before */
    bool event;
};
/* Do a part of a step; a slave without `do_part` does the whole step. */
enum answer slave_step_part(struct slave *s, double time, double step, struct part *part);
enum answer slave_terminate(struct slave *s);

/* Read `n` variables of the kind, which is not STRING. */
enum answer slave_read(struct slave *s, enum kind kind, const uint32_t vr[], size_t n,
                       double value[]);
/* True if the slave gives all numeric outputs at once. */
bool slave_has_outputs(const struct slave *s);
/* Read all `n` numeric outputs at once. */
enum answer slave_read_outputs(struct slave *s, size_t n, double value[]);
/* Read strings. They are valid until the next call of this function, or until the slave is freed.
 */
enum answer slave_read_strings(struct slave *s, const uint32_t vr[], size_t n, const char *value[]);
enum answer slave_write(struct slave *s, enum kind kind, const uint32_t vr[], size_t n,
                        const double value[]);
enum answer slave_write_strings(struct slave *s, const uint32_t vr[], size_t n,
                                const char *const value[]);

/* Get the slave's state; the caller frees it. `*state` is NULL if that fails. */
enum answer slave_get_state(struct slave *s, struct slave_state **state);
enum answer slave_set_state(struct slave *s, const struct slave_state *state);
/* Write the state as bytes, which live as long as the state. */
enum answer slave_state_bytes(struct slave *s, struct slave_state *state, const char **bytes,
                              size_t *size);
enum answer slave_state_from_bytes(struct slave *s, const char *bytes, size_t size,
                                   struct slave_state **state);
/* Free a state, whether its slave still exists or not. */
void slave_free_state(struct slave_state *state);

#endif
