/* Looks up the functions of Python; enters and leaves it. */
#include "python.h"

#include <stdio.h>

struct python py;

int python_minor_version(void *get_version)
{
    const char *(*version)(void);
    *(void **)&version = get_version;
    int minor = 0;
    return sscanf(version(), "3.%d", &minor) == 1 ? minor : 0;
}

/* Functions that distinguish interpreters; none of them is in the limited API. */
static struct {
    int minor;
    PyInterpreterState *(*first)(void), *(*next)(PyInterpreterState *);
    PyThreadState *(*current_thread)(void);
} interpreters;

static void find_interpreter_functions(void)
{
    interpreters.minor = python_minor_version(*(void **)&py.Py_GetVersion);
    *(void **)&interpreters.first = process_symbol("PyInterpreterState_Head");
    *(void **)&interpreters.next = process_symbol("PyInterpreterState_Next");
    void *current = process_symbol("PyThreadState_GetUnchecked");
    if (!current)
        current = process_symbol("_PyThreadState_UncheckedGet");
    *(void **)&interpreters.current_thread = current;
}

bool python_find_functions(struct message *reason)
{
    static const char *const names[] = {
#define NAME(result, name, arguments) #name,
        PYTHON_FUNCTIONS(NAME)
#undef NAME
    };
    void **const places[] = {
#define PLACE(result, name, arguments) (void **)&py.name,
        PYTHON_FUNCTIONS(PLACE)
#undef PLACE
    };
    if (py.PyExc_KeyboardInterrupt)
        return true;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!(*places[i] = process_symbol(names[i]))) {
            append_text(reason, ": not a complete Python library, it has no %s", names[i]);
            return false;
        }
    find_interpreter_functions();
    /* keep it loaded, whatever the host does with its own reference */
    char path[PATH_SIZE];
    if (library_path(*places[0], path))
        library_open(path, false);
    py.PyExc_KeyboardInterrupt = process_symbol("PyExc_KeyboardInterrupt");
    return py.PyExc_KeyboardInterrupt != NULL;
}

static bool is_main(PyInterpreterState *interpreter)
{
    return py.PyInterpreterState_GetID(interpreter) == 0;
}

/*
 * True if this thread may take Python's lock for the main interpreter.
 *
 * PyGILState_Ensure waits for ever, or ends the process, in a thread that runs in a
 * sub-interpreter. Before Python 3.12 such a thread cannot be distinguished.
 */
static bool is_in_main_interpreter(struct message *reason)
{
    if (!interpreters.first || !interpreters.next || !interpreters.next(interpreters.first()))
        return true;
    if (!interpreters.current_thread || interpreters.minor < 12) {
        append_text(reason, "this process has several Python interpreters, with which the FMU "
                            "works from Python 3.12 on");
        return false;
    }
    PyThreadState *own = py.PyGILState_GetThisThreadState(), *current = interpreters.current_thread();
    if ((!own || is_main(py.PyThreadState_GetInterpreter(own))) && (!current || current == own))
        return true;
    append_text(reason, "this thread is in a sub-interpreter of Python; call the FMU from the main "
                        "interpreter");
    return false;
}

#ifdef __x86_64__
enum { SSE_DEFAULT = 0x1f80, X87_DEFAULT = 0x37f, X87_EXCEPTIONS = 0xff };

static unsigned short x87_status(void)
{
    unsigned short status;
    __asm__ volatile("fnstsw %0" : "=am"(status));
    return status & X87_EXCEPTIONS;
}

static bool take_sse(struct floats *host)
{
    unsigned short control;
    __asm__ volatile("fnstcw %0" : "=m"(control));
    if (control != X87_DEFAULT)
        return false;
    host->x87_status = x87_status();
    host->sse = __builtin_ia32_stmxcsr();
    __builtin_ia32_ldmxcsr(SSE_DEFAULT);
    return true;
}

static void give_sse_back(const struct floats *host)
{
    if (x87_status() != host->x87_status) { /* long doubles have been computed with in between */
        unsigned words[7]; /* control, status, tag and four of the last instruction */
        __asm__ volatile("fnstenv %0" : "=m"(words));
        words[0] = (words[0] & ~0xffffu) | X87_DEFAULT;
        words[1] = (words[1] & ~(unsigned)X87_EXCEPTIONS) | host->x87_status;
        __asm__ volatile("fldenv %0" : : "m"(words));
    }
    __builtin_ia32_ldmxcsr(host->sse);
}
#else
static bool take_sse(struct floats *host)
{
    (void)host;
    return false;
}

static void give_sse_back(const struct floats *host)
{
    (void)host;
}
#endif

void floats_take(struct floats *host)
{
    host->sse_only = take_sse(host);
    if (host->sse_only)
        return;
    fegetenv(&host->all);
    fesetenv(FE_DFL_ENV);
}

void floats_give_back(const struct floats *host)
{
    if (host->sse_only)
        give_sse_back(host);
    else
        fesetenv(&host->all);
}

enum entry python_enter(long life, struct stay *stay, struct message *reason)
{
    if (!py.Py_IsInitialized()) {
        append_text(reason, "the Python of this process has ended, and the FMU's slave with it");
        return ENDED;
    }
    if (!is_in_main_interpreter(reason))
        return NOT_HERE;
    floats_take(&stay->floats);
    stay->lock = py.PyGILState_Ensure();
    if (life == 0 || life == python_life())
        return ENTERED;
    python_leave(stay);
    append_text(reason, "the Python of this process was ended and started again, and the FMU's "
                        "slave has ended with it");
    return ENDED;
}

void python_leave(const struct stay *stay)
{
    py.PyGILState_Release(stay->lock);
    floats_give_back(&stay->floats);
}

long python_life(void)
{
    static long last;
    static char key[40]; /* each copy of this library counts for itself */
    if (!key[0])
        snprintf(key, sizeof key, "rlv_landing life %p", (void *)&last);
    PyObject *kept = py.PyInterpreterState_GetDict(py.PyInterpreterState_Get());
    PyObject *known = kept ? py.PyDict_GetItemString(kept, key) : NULL;
    if (known) {
        long life = py.PyLong_AsLong(known);
        if (life > last)
            last = life;
        return life;
    }
    PyObject *number = py.PyLong_FromLong(++last);
    if (kept && number)
        py.PyDict_SetItemString(kept, key, number);
    if (number)
        py.Py_DecRef(number);
    return last;
}
