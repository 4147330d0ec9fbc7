/* A host in C of FMI 3.0: loads an FMU's binary, which brings its Python. Not linked with Python. */
#ifndef HOST3_H
#define HOST3_H

#include "fmi3FunctionTypes.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FUNCTIONS(X) \
    X(GetVersion) \
    X(SetDebugLogging) \
    X(InstantiateCoSimulation) \
    X(FreeInstance) \
    X(EnterInitializationMode) \
    X(ExitInitializationMode) \
    X(EnterEventMode) \
    X(UpdateDiscreteStates) \
    X(EnterStepMode) \
    X(Terminate) \
    X(Reset) \
    X(GetFloat64) \
    X(GetInt32) \
    X(GetBoolean) \
    X(GetString) \
    X(SetFloat64) \
    X(SetString) \
    X(GetFMUState) \
    X(SetFMUState) \
    X(FreeFMUState) \
    X(SerializedFMUStateSize) \
    X(SerializeFMUState) \
    X(DeserializeFMUState) \
    X(GetOutputDerivatives) \
    X(DoStep)

static struct {
#define DECLARE(name) fmi3##name##TYPE *name;
    FUNCTIONS(DECLARE)
#undef DECLARE
} fmi3;

static inline void load(const char *binary)
{
    if (dlsym(RTLD_DEFAULT, "Py_IsInitialized")) {
        fprintf(stderr, "this host has Python in it, which is not what it is for\n");
        exit(2);
    }
    void *library = dlopen(binary, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        exit(2);
    }
#define FIND(name) \
    if (!(*(void **)&fmi3.name = dlsym(library, "fmi3" #name))) { \
        fprintf(stderr, "no fmi3" #name "\n"); \
        exit(2); \
    }
    FUNCTIONS(FIND)
#undef FIND
}

static inline void must(fmi3Status status, const char *what)
{
    if (status != fmi3OK) {
        fprintf(stderr, "%s: status %d\n", what, status);
        exit(3);
    }
}

/* Make an instance that has no callbacks at all. */
static inline fmi3Instance instantiate(const char *resources, const char *token, bool events)
{
    fmi3Instance c = fmi3.InstantiateCoSimulation("host", token, resources, false, true, events,
                                                  events, NULL, 0, NULL, NULL, NULL);
    if (!c) {
        fprintf(stderr, "no instance\n");
        exit(1);
    }
    return c;
}

static inline void initialise(fmi3Instance c)
{
    must(fmi3.EnterInitializationMode(c, false, 0.0, 0.0, false, 0.0), "enter");
    must(fmi3.ExitInitializationMode(c), "exit");
}

/* Update the discrete states, and enter the step mode. */
static inline void leave_event_mode(fmi3Instance c)
{
    bool again = true, ends, nominals, values, defined;
    double next;
    while (again)
        must(fmi3.UpdateDiscreteStates(c, &again, &ends, &nominals, &values, &defined, &next),
             "update");
    must(fmi3.EnterStepMode(c), "step mode");
}

/* Step from `time` to `goal`, or to an event before; returns the time reached, counts the event. */
static inline double step(fmi3Instance c, double time, double goal, int *events)
{
    bool event, ends, early;
    double last;
    must(fmi3.DoStep(c, time, goal - time, true, &event, &ends, &early, &last), "step");
    if (!event)
        return last;
    ++*events;
    must(fmi3.EnterEventMode(c), "event mode");
    leave_event_mode(c);
    return last;
}

#endif
