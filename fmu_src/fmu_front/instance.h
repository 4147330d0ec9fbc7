/*
 * An instance of the FMU, for every version of FMI.
 *
 * Each function checks its arguments and the instance's phase, calls the slave, and returns the
 * worst status that the slave has logged during the call. What it refuses changes nothing.
 */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "slave.h"
#include "text.h"

/*
 * Value references that no description has: the rate of input i is set as the real RATES + i.
 * The same number as in landing_fmu.py.
 */
enum { RATES = 2000000 };

/*
 * The phase of an instance: a state of FMI's state machine for co-simulation. STEPPING is Step
 * Mode. EVENT_MODE and UPDATING (Intermediate Update Mode) are FMI 3.0's. SLAVE_LOST: an internal
 * error has ended the slave; reset or free.
 */
enum phase {
    INSTANTIATED = 1,
    INITIALIZING = 2,
    STEPPING = 4,
    TERMINATED = 8,
    SLAVE_LOST = 16,
    EVENT_MODE = 32,
    UPDATING = 64
};
enum { BEFORE_STEPS = INSTANTIATED | INITIALIZING, ANY = BEFORE_STEPS | STEPPING | TERMINATED };

/* A function of the host's version of FMI: its name, and the phases in which it may be called. */
struct function {
    const char *name;
    unsigned phases;
};

/* The host: what it logs, and how. `send` is NULL if it takes no messages. */
struct host {
    void (*send)(const struct host *host, const char *name, enum status status,
                 const char *category, const char *text);
    const void *callbacks;
    char version; /* of FMI: '2' or '3'; `callbacks` are of its types */
    bool event_mode; /* it handles events */
    bool logging;
    bool takes_errors; /* whether they are of categories that it wants or not */
    unsigned categories; /* one bit for each of the description's; 0: all */
};

struct instance {
    struct host host;
    struct slave *slave; /* NULL in the phase SLAVE_LOST */
    char *name, *resources;
    bool visible;
    enum phase phase;
    enum status worst_status; /* the worst that the slave has logged during this call */
    enum status last_step;    /* status of the last step */
    double last_time;         /* end of the last successful step, else the start time [s] */
    bool outputs_valid;       /* outputs are the present ones */
    double *outputs;          /* numeric outputs, by value reference */
    double *numbers;          /* room for the numbers of a call */
    size_t room;              /* its length */
};

/*
 * Make an instance with its slave.
 *
 * `location` is what the host says of the resources. If it does not lead to them, they are looked
 * for from this library's place. Returns NULL, with the reason logged, if that fails.
 */
struct instance *instance_create(const struct host *host, const char *name, const char *location,
                                 bool visible);
void instance_free(struct instance *c);

enum status instance_setup(struct instance *c, const struct function *f, double start,
                           const double *stop, const double *tolerance);
enum status instance_enter_initialization(struct instance *c, const struct function *f);
enum status instance_exit_initialization(struct instance *c, const struct function *f);
enum status instance_step(struct instance *c, const struct function *f, double time, double step);
/*
 * Step from `time` to `stop`, in what is left of a step that ends at `end`, or to the first event
 * if `to_event`. `*event` is whether there is one; the time reached is c->last_time.
 */
enum status instance_step_part(struct instance *c, const struct function *f, double time,
                               double end, double stop, bool to_event, bool *event);
enum status instance_terminate(struct instance *c, const struct function *f);
enum status instance_reset(struct instance *c, const struct function *f);
/* Choose the categories that are logged; one that does not exist is a Warning. */
enum status instance_set_logging(struct instance *c, const struct function *f, bool logging,
                                 size_t n, const char *const categories[]);

/* Check that a variable may be set in this phase; log an error that calls it `name` if not. */
bool check_settable(const struct instance *c, const struct function *f, uint32_t vr,
                    const char *name);
/* A numeric output, which may be read as REAL, too. */
bool is_numeric_output(uint32_t vr);

/*
 * Read numbers of variables of the kind. Numeric outputs of the other kinds are read as REAL, too.
 */
enum status instance_read(struct instance *c, const struct function *f, enum kind kind,
                          const uint32_t vr[], size_t n, double value[]);
enum status instance_read_strings(struct instance *c, const struct function *f,
                                  const uint32_t vr[], size_t n, const char *value[]);
enum status instance_write(struct instance *c, const struct function *f, enum kind kind,
                           const uint32_t vr[], size_t n, const double value[]);
enum status instance_write_strings(struct instance *c, const struct function *f,
                                   const uint32_t vr[], size_t n, const char *const value[]);
/* Set derivatives of inputs with respect to time; `order` of each must be 1. */
enum status instance_write_rates(struct instance *c, const struct function *f,
                                 const uint32_t vr[], size_t n, const int32_t order[],
                                 const double value[]);
/* Room for `n` numbers, valid until the next call; NULL, with a logged error, if there is none. */
double *instance_room(struct instance *c, const struct function *f, size_t n);

/* States are handed to the host as pointers; a pointer that is none of them is an error. */
enum status instance_get_state(struct instance *c, const struct function *f, void **state);
enum status instance_set_state(struct instance *c, const struct function *f, void *state);
enum status instance_free_state(struct instance *c, const struct function *f, void **state);
enum status instance_state_size(struct instance *c, const struct function *f, void *state,
                                size_t *size);
enum status instance_serialize(struct instance *c, const struct function *f, void *state,
                               char bytes[], size_t size);
enum status instance_deserialize(struct instance *c, const struct function *f, const char bytes[],
                                 size_t size, void **state);
/* Free the states of this instance that the host has not freed. */
void free_states_of(struct instance *c);

/*
 * Log a message if the host wants its category. An error that the host does not take goes to
 * standard error.
 */
#if defined(__GNUC__)
__attribute__((format(gnu_printf, 3, 4)))
#endif
void log_message(const struct instance *c, enum status status, const char *format, ...);

/* Pass on a message of the slave; keep the worst status. `instance` is a struct instance. */
void log_from_slave(void *instance, enum status status, const char *category, const char *text);

/* Index of the log category `name`; -1 if there is none. */
int category_index(const char *name);

/*
 * Enter the call `f` of the host.
 *
 * Returns false if the instance is NULL, or, with a logged error, if it is one of another version of
 * FMI, or in a phase in which `f` may not be called. The cached outputs are invalid afterwards.
 */
bool enter_call(struct instance *c, const struct function *f);

/* The same for a call that reads: outputs that are valid stay so. */
bool enter_reading(struct instance *c, const struct function *f);

/* Leave the call after the slave's answer; returns the worst status. */
enum status leave_call(struct instance *c, enum answer answer);

/* Require an argument that must not be NULL. Returns false with a logged error if it is. */
bool require(const struct instance *c, const struct function *f, const char *argument,
             const void *pointer);

#endif
