/*
 * The front of the FMU: the FMI 2.0 functions that importers call.
 *
 * Each checks what it is given, forwards to pythonfmu's binary, which lies beside this library and runs the slave (landing_fmu.py), and
 * returns the worst status that the slave has logged meanwhile. pythonfmu's binary alone needs a process that has Python, dies of some
 * paths, and reports every exception of the slave as Fatal, after which no further call is safe.
 */
#ifndef FRONT_H
#define FRONT_H

#include "fmi2FunctionTypes.h"
#include "fmi2Functions.h"
#include "text.h"

/* Value references of our own, in no description: input i's rate is set as the real RATES + i. As in landing_fmu.py. */
enum { RATES = 2000000 };

enum phase { INSTANTIATED = 1, INITIALIZING = 2, STEPPING = 4, TERMINATED = 8, LOST = 16 };
enum { ANY = INSTANTIATED | INITIALIZING | STEPPING | TERMINATED };

/* pythonfmu's functions. */
#define STOCK_FUNCTIONS(X)                                                                                                                 \
    X(Instantiate)                                                                                                                         \
    X(FreeInstance)                                                                                                                        \
    X(SetupExperiment)                                                                                                                     \
    X(EnterInitializationMode)                                                                                                             \
    X(ExitInitializationMode)                                                                                                              \
    X(Terminate)                                                                                                                           \
    X(Reset)                                                                                                                               \
    X(GetReal)                                                                                                                             \
    X(GetInteger)                                                                                                                          \
    X(GetBoolean)                                                                                                                          \
    X(GetString)                                                                                                                           \
    X(SetReal)                                                                                                                             \
    X(SetInteger)                                                                                                                          \
    X(SetBoolean)                                                                                                                          \
    X(SetString)                                                                                                                           \
    X(GetFMUstate)                                                                                                                         \
    X(SetFMUstate)                                                                                                                         \
    X(FreeFMUstate)                                                                                                                        \
    X(SerializedFMUstateSize)                                                                                                              \
    X(SerializeFMUstate)                                                                                                                   \
    X(DeSerializeFMUstate)                                                                                                                 \
    X(DoStep)

struct stock {
#define DECLARE(name) fmi2##name##TYPE *name;
    STOCK_FUNCTIONS(DECLARE)
#undef DECLARE
};

extern struct stock stock;

/* Load pythonfmu's binary, once. false with the reason. */
bool load_stock(struct message *reason);

struct instance {
    fmi2Component slave; /* pythonfmu's; NULL where it is lost */
    fmi2CallbackFunctions host, own;
    char *name, *location;
    char link[PATH_SIZE]; /* to the resources, where their own path is not plain; else empty */
    enum phase phase;
    bool logging, interrupted;
    unsigned categories; /* one bit for each of the description's log categories */
    fmi2Status worst;    /* that the slave has logged during the present call */
    fmi2Status last_step;
    double last_time; /* end of the last step done, else the start time */
    bool fresh;       /* whether `values` are the present outputs */
    fmi2Real values[]; /* of the outputs that are numbers, by value reference */
};

/* Log for the host, as far as it wants to know; errors that it does not want to know of go to standard error. */
#if defined(__GNUC__)
__attribute__((format(gnu_printf, 3, 4)))
#endif
void say(const struct instance *c, fmi2Status status, const char *format, ...);
/* pythonfmu's logger: notes the status and passes the message on. */
void relay(fmi2ComponentEnvironment c, fmi2String name, fmi2Status status, fmi2String category, fmi2String message, ...);
/* Which log category has this name; -1 if none. */
int category_index(const char *name);

/* Begin the call `function` on the instance: false, said why, if it is none, or not in one of the `phases`. Outputs are not fresh then. */
bool begin(struct instance *c, const char *function, unsigned phases);
/* End it: the worse of pythonfmu's status and of what the slave has logged. Fatal, after which pythonfmu must not be called, loses the slave. */
fmi2Status end(struct instance *c, fmi2Status status);
/* As `begin`, for an argument that must not be NULL. */
bool given(const struct instance *c, const char *function, const char *argument, const void *pointer);

/* Free the states that were taken of this instance and not freed. */
void free_states_of(struct instance *c);

#endif
