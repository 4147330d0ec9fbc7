/* python_host BINARY RESOURCES GUID LIBPYTHON SCENARIO: a host in C that has its own Python, and ends
 * it, starts it again, or has a sub-interpreter, while instances live. Prints a word for each call. */
#define _GNU_SOURCE
#include "host.h"

#include <link.h>

static struct {
    void (*Py_InitializeEx)(int);
    int (*Py_FinalizeEx)(void);
    void *(*PyEval_SaveThread)(void);
    void (*PyEval_RestoreThread)(void *);
    void *(*PyThreadState_Swap)(void *);
    void *(*Py_NewInterpreter)(void);
    void (*Py_EndInterpreter)(void *);
    int (*PyRun_SimpleString)(const char *);
} python;

static void *symbol(void *library, const char *name)
{
    void *found = dlsym(library, name);
    if (!found) {
        fprintf(stderr, "no %s\n", name);
        exit(2);
    }
    return found;
}

static void load_python(const char *path)
{
    void *library = dlopen(path, RTLD_NOW | RTLD_GLOBAL);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        exit(2);
    }
    *(void **)&python.Py_InitializeEx = symbol(library, "Py_InitializeEx");
    *(void **)&python.Py_FinalizeEx = symbol(library, "Py_FinalizeEx");
    *(void **)&python.PyEval_SaveThread = symbol(library, "PyEval_SaveThread");
    *(void **)&python.PyEval_RestoreThread = symbol(library, "PyEval_RestoreThread");
    *(void **)&python.PyThreadState_Swap = symbol(library, "PyThreadState_Swap");
    *(void **)&python.Py_NewInterpreter = symbol(library, "Py_NewInterpreter");
    *(void **)&python.Py_EndInterpreter = symbol(library, "Py_EndInterpreter");
    *(void **)&python.PyRun_SimpleString = symbol(library, "PyRun_SimpleString");
}

static const char *word(fmi2Status status)
{
    return status == fmi2OK ? "ok" : status == fmi2Error ? "error" : "other";
}

static int steps;

static void step(fmi2Component c, const char *when)
{
    fmi2Status status = fmi2.DoStep(c, steps * 1e-3, 1e-3, fmi2True);
    steps += status == fmi2OK;
    printf("step %s: %s\n", when, word(status));
}

/* A new instance's lowest number of a landing of 20 steps, or "none". */
static fmi2Component landed(const char *resources, const char *guid, const char *when)
{
    fmi2Component c = instantiate("landed", resources, guid);
    printf("instance %s: %s\n", when, c ? "ok" : "error");
    if (!c)
        return NULL;
    initialise(c);
    for (int k = 0; k < 20; k++)
        must(fmi2.DoStep(c, k * 1e-3, 1e-3, fmi2True), "step");
    steps = 20;
    return c;
}

int main(int argc, char **argv)
{
    if (argc != 6)
        return 2;
    setvbuf(stdout, NULL, _IONBF, 0);
    const char *resources = argv[2], *guid = argv[3], *scenario = argv[5];
    if (strcmp(scenario, "dlmopen") == 0) {
        void *library = dlmopen(LM_ID_NEWLM, argv[1], RTLD_NOW | RTLD_LOCAL);
        fmi2InstantiateTYPE *make = NULL;
        if (library)
            *(void **)&make = dlsym(library, "fmi2Instantiate");
        if (!make)
            return 2;
        printf("instance: %s\n", make("apart", fmi2CoSimulation, guid, resources, &CALLBACKS,
                                      fmi2False, fmi2True)
                                     ? "ok"
                                     : "error");
        return 0;
    }
    load(argv[1]);
    load_python(argv[4]);
    python.Py_InitializeEx(0);
    /* the lock of Python is held by this thread, unless it says so */
    fmi2Component c = landed(resources, guid, "with the lock");
    if (!c)
        return 1;
    step(c, "with the lock");
    void *main_thread = python.PyEval_SaveThread();
    step(c, "without the lock");
    python.PyEval_RestoreThread(main_thread);
    if (strcmp(scenario, "sub-interpreter") == 0) {
        void *sub = python.Py_NewInterpreter();
        step(c, "in a sub-interpreter");
        fmi2Component other = instantiate("other", resources, guid);
        printf("instance in a sub-interpreter: %s\n", other ? "ok" : "error");
        python.PyThreadState_Swap(main_thread);
        step(c, "beside a sub-interpreter");
        python.PyThreadState_Swap(sub);
        python.Py_EndInterpreter(sub);
        python.PyThreadState_Swap(main_thread);
        step(c, "after a sub-interpreter");
    }
    python.Py_FinalizeEx();
    step(c, "after the end");
    if (strcmp(scenario, "again") == 0) {
        python.Py_InitializeEx(0);
        step(c, "in the second life");
        fmi2Component second = landed(resources, guid, "in the second life");
        if (second) {
            step(second, "of the second");
            fmi2.FreeInstance(second);
        }
        python.Py_FinalizeEx();
    }
    printf("terminate: %s\n", word(fmi2.Terminate(c)));
    fmi2.FreeInstance(c);
    printf("end\n");
    return 0;
}
