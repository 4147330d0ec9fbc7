/* A host in C: loads an FMU's binary, which brings its Python with it. Not linked with Python. */
#ifndef HOST_H
#define HOST_H

#include "fmi2FunctionTypes.h"

#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FUNCTIONS(X) \
    X(GetTypesPlatform) \
    X(GetVersion) \
    X(SetDebugLogging) \
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
    X(GetDirectionalDerivative) \
    X(SetRealInputDerivatives) \
    X(GetRealOutputDerivatives) \
    X(DoStep) \
    X(CancelStep) \
    X(GetStatus) \
    X(GetRealStatus) \
    X(GetIntegerStatus) \
    X(GetBooleanStatus) \
    X(GetStringStatus)

static struct {
#define DECLARE(name) fmi2##name##TYPE *name;
    FUNCTIONS(DECLARE)
#undef DECLARE
} fmi2;

static void print_log(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                      fmi2String category, fmi2String message, ...)
{
    (void)environment;
    printf("log %d %s %s: ", status, category, name);
    va_list arguments;
    va_start(arguments, message);
    vprintf(message, arguments);
    va_end(arguments);
    printf("\n");
}

static const fmi2CallbackFunctions CALLBACKS = {print_log, calloc, free, NULL, NULL};

static void *load(const char *binary)
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
    if (!(*(void **)&fmi2.name = dlsym(library, "fmi2" #name))) { \
        fprintf(stderr, "no fmi2" #name "\n"); \
        exit(2); \
    }
    FUNCTIONS(FIND)
#undef FIND
    return library;
}

static inline void must(fmi2Status status, const char *what)
{
    if (status != fmi2OK) {
        fprintf(stderr, "%s: status %d\n", what, status);
        exit(3);
    }
}

static inline fmi2Component instantiate(const char *name, const char *resources, const char *guid)
{
    return fmi2.Instantiate(name, fmi2CoSimulation, guid, resources, &CALLBACKS, fmi2False,
                            fmi2True);
}

static inline void initialise(fmi2Component c)
{
    must(fmi2.SetupExperiment(c, fmi2False, 0.0, 0.0, fmi2False, 0.0), "setup");
    must(fmi2.EnterInitializationMode(c), "enter");
    must(fmi2.ExitInitializationMode(c), "exit");
}

#endif
