/*
 * The FMU's front: the FMI 2.0 functions that importers call.
 *
 * Each function checks its arguments and the instance's phase. It then calls pythonfmu's binary,
 * which lies beside this library and runs the slave (landing_fmu.py). It returns the worst status
 * that the slave has logged during the call.
 *
 * pythonfmu's binary alone needs a process that has Python, crashes on some paths, and reports
 * every exception of the slave as Fatal, after which no further call is allowed.
 */
#ifndef FRONT_H
#define FRONT_H

#include "fmi2FunctionTypes.h"
#include "fmi2Functions.h"
#include "text.h"

/*
 * Value references that no description has: the rate of input i is set as the real RATES + i.
 * The same number as in landing_fmu.py.
 */
enum { RATES = 2000000 };

/* The phase of an instance. SLAVE_LOST: an internal error has ended the slave; reset or free. */
enum phase { INSTANTIATED = 1, INITIALIZING = 2, STEPPING = 4, TERMINATED = 8, SLAVE_LOST = 16 };
enum { ANY = INSTANTIATED | INITIALIZING | STEPPING | TERMINATED };

#define PYTHONFMU_FUNCTIONS(X) \
    X(Instantiate) \
    X(FreeInstance) \
    X(SetupExperiment) \
    X(EnterInitializationMode) \
    X(ExitInitializationMode) \
    X(Terminate) \
    X(Reset) \
    X(GetReal) \
    X(GetInteger) \
    X(GetBoolean) \
    X(GetString) \
    X(SetReal) \
    X(SetInteger) \
    X(SetBoolean) \
    X(SetString) \
    X(GetFMUstate) \
    X(SetFMUstate) \
    X(FreeFMUstate) \
    X(SerializedFMUstateSize) \
    X(SerializeFMUstate) \
    X(DeSerializeFMUstate) \
    X(DoStep)

/* The functions of pythonfmu's binary. */
struct pythonfmu {
#define DECLARE(name) fmi2##name##TYPE *name;
    PYTHONFMU_FUNCTIONS(DECLARE)
#undef DECLARE
};

extern struct pythonfmu pythonfmu;

/* Load pythonfmu's binary, once. Returns false with the reason. */
bool load_pythonfmu(struct message *reason);

struct instance {
    fmi2Component slave; /* pythonfmu's instance; NULL in the phase SLAVE_LOST */
    fmi2CallbackFunctions host_callbacks, own_callbacks; /* the importer's; those for pythonfmu */
    char *name, *location;         /* instance name; URI of the resources for pythonfmu */
    char resource_link[PATH_SIZE]; /* link to the resources if their path is not plain, else "" */
    enum phase phase;
    bool logging, interrupted;
    unsigned categories;      /* one bit for each of the description's log categories */
    fmi2Status worst_status;  /* the worst that the slave has logged during this call */
    fmi2Status last_step;     /* status of the last fmi2DoStep */
    double last_time;         /* end of the last successful step, else the start time [s] */
    bool outputs_valid;       /* output_values are the present outputs */
    fmi2Real output_values[]; /* numeric outputs, by value reference */
};

/*
 * Log a message if the importer wants its category. An error that the importer does not want goes
 * to standard error.
 */
#if defined(__GNUC__)
__attribute__((format(gnu_printf, 3, 4)))
#endif
void log_message(const struct instance *c, fmi2Status status, const char *format, ...);

/* pythonfmu's logger: keeps the worst status and passes the message to the importer. */
void log_from_slave(fmi2ComponentEnvironment c, fmi2String name, fmi2Status status,
                    fmi2String category, fmi2String message, ...);

/* Index of the log category `name`; -1 if there is none. */
int category_index(const char *name);

/*
 * Enter the call `function` of the importer.
 *
 * Returns false if the instance is NULL, or, with a logged error, if it is in none of `phases`.
 * The cached outputs are invalid afterwards.
 */
bool enter_call(struct instance *c, const char *function, unsigned phases);

/*
 * Leave the call; `status` is pythonfmu's.
 *
 * Returns the worse of `status` and what the slave has logged. After Fatal pythonfmu must not be
 * called again: the slave is lost, and the importer gets an error.
 */
fmi2Status leave_call(struct instance *c, fmi2Status status);

/* Require an argument that must not be NULL. Returns false with a logged error if it is. */
bool require(const struct instance *c, const char *function, const char *argument,
             const void *pointer);

/* Free the states of this instance that the importer has not freed. */
void free_states_of(struct instance *c);

#endif
