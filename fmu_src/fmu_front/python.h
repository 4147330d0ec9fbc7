/*
 * The process' Python: found, started, entered and left.
 *
 * The functions of its limited API are looked up when the program runs, so that this library loads
 * in a program without Python, and works with every version. Their declarations here are those of
 * Python.h; a test compares them.
 */
#ifndef FRONT_PYTHON_H
#define FRONT_PYTHON_H

#include "text.h"

#include <fenv.h>
#include <stdint.h>

enum { OLDEST_PYTHON = 10, NEWEST_PYTHON = 14 }; /* minor versions of 3 */

#ifndef Py_PYTHON_H
typedef struct _object PyObject;
typedef struct _ts PyThreadState;
typedef struct _is PyInterpreterState;
typedef ptrdiff_t Py_ssize_t;
typedef enum { PyGILState_LOCKED, PyGILState_UNLOCKED } PyGILState_STATE;
#endif

#define PYTHON_FUNCTIONS(X) \
    X(int, Py_IsInitialized, (void)) \
    X(const char *, Py_GetVersion, (void)) \
    X(PyGILState_STATE, PyGILState_Ensure, (void)) \
    X(void, PyGILState_Release, (PyGILState_STATE)) \
    X(PyThreadState *, PyGILState_GetThisThreadState, (void)) \
    X(PyThreadState *, PyEval_SaveThread, (void)) \
    X(PyInterpreterState *, PyThreadState_GetInterpreter, (PyThreadState *)) \
    X(PyInterpreterState *, PyInterpreterState_Get, (void)) \
    X(PyObject *, PyInterpreterState_GetDict, (PyInterpreterState *)) \
    X(int64_t, PyInterpreterState_GetID, (PyInterpreterState *)) \
    X(void, Py_IncRef, (PyObject *)) \
    X(void, Py_DecRef, (PyObject *)) \
    X(PyObject *, Py_CompileString, (const char *, const char *, int)) \
    X(PyObject *, PyEval_EvalCode, (PyObject *, PyObject *, PyObject *)) \
    X(PyObject *, PyEval_GetBuiltins, (void)) \
    X(PyObject *, PyDict_New, (void)) \
    X(PyObject *, PyDict_GetItemString, (PyObject *, const char *)) \
    X(int, PyDict_SetItemString, (PyObject *, const char *, PyObject *)) \
    X(PyObject *, PyObject_GetAttrString, (PyObject *, const char *)) \
    X(PyObject *, PyObject_CallObject, (PyObject *, PyObject *)) \
    X(PyObject *, PyObject_Str, (PyObject *)) \
    X(int, PyObject_IsTrue, (PyObject *)) \
    X(PyObject *, Py_BuildValue, (const char *, ...)) \
    X(PyObject *, PyList_New, (Py_ssize_t)) \
    X(Py_ssize_t, PyList_Size, (PyObject *)) \
    X(PyObject *, PyList_GetItem, (PyObject *, Py_ssize_t)) \
    X(int, PyList_SetItem, (PyObject *, Py_ssize_t, PyObject *)) \
    X(int, PyList_SetSlice, (PyObject *, Py_ssize_t, Py_ssize_t, PyObject *)) \
    X(PyObject *, PyLong_FromLong, (long)) \
    X(PyObject *, PyLong_FromUnsignedLong, (unsigned long)) \
    X(long, PyLong_AsLong, (PyObject *)) \
    X(PyObject *, PyFloat_FromDouble, (double)) \
    X(double, PyFloat_AsDouble, (PyObject *)) \
    X(PyObject *, PyBool_FromLong, (long)) \
    X(PyObject *, PyUnicode_FromString, (const char *)) \
    X(PyObject *, PyUnicode_DecodeFSDefault, (const char *)) \
    X(const char *, PyUnicode_AsUTF8AndSize, (PyObject *, Py_ssize_t *)) \
    X(PyObject *, PyBytes_FromStringAndSize, (const char *, Py_ssize_t)) \
    X(int, PyBytes_AsStringAndSize, (PyObject *, char **, Py_ssize_t *)) \
    X(PyObject *, PyErr_Occurred, (void)) \
    X(void, PyErr_Fetch, (PyObject **, PyObject **, PyObject **)) \
    X(void, PyErr_NormalizeException, (PyObject **, PyObject **, PyObject **)) \
    X(int, PyErr_GivenExceptionMatches, (PyObject *, PyObject *)) \
    X(void, PyErr_Clear, (void)) \
    X(void, PyErr_SetInterrupt, (void))

struct python {
#define DECLARE(result, name, arguments) result(*name) arguments;
    PYTHON_FUNCTIONS(DECLARE)
#undef DECLARE
    PyObject **PyExc_KeyboardInterrupt;
};

/* The functions of this process' Python, after python_ready. */
extern struct python py;

/*
 * Start Python 3.10 or newer in this process unless it runs; `resources` is the FMU's folder of
 * that name.
 *
 * A Python that the process has is used. Else libpython is looked for, in this order:
 *   1. the file that RLV_LANDING_LIBPYTHON names;
 *   2. the file recorded when the FMU was built (resources/libpython.txt);
 *   3. the usual names, by the loader;
 *   4. an installed Python: the `python3` of PATH; on Windows, the registry.
 *
 * It is opened with global symbols, which Python's own libraries need. It is started without signal
 * handlers, environment and site-packages: the slave needs none of them, and a .pth file can
 * restart the process. It is never finalised, because Python cannot be started again in the same
 * process.
 *
 * Returns false with the reason if there is none.
 */
bool python_ready(const char *resources, struct message *reason);

/* Minor version of the Python 3 whose Py_GetVersion this is; 0 for another Python. */
int python_minor_version(void *get_version);
/* Look up the functions of `py` in the Python whose symbols are global, once. */
bool python_find_functions(struct message *reason);

/* Whether a thread has come into Python. */
enum entry {
    ENTERED,
    NOT_HERE, /* it is in a sub-interpreter: the slave lives in the main one */
    ENDED     /* the Python that the caller's objects belong to has ended */
};

/* A floating-point environment. Where the x87's part is the default one, which is so in nearly every
 * host, the SSE's register is kept alone: the x87's takes ten times as long to save and load. */
struct floats {
    fenv_t all;
    bool sse_only;
    unsigned sse;
    unsigned short x87_status;
};

/* What a thread that is in Python has to give back. */
struct stay {
    PyGILState_STATE lock;
    struct floats floats;
};

/*
 * Put the host's floating-point environment aside and take the default one: its traps would end
 * the process where a number that is not finite is refused, and its rounding would change digits.
 */
void floats_take(struct floats *host);
void floats_give_back(const struct floats *host);

/*
 * Take Python's lock for this thread, and the default floating-point environment; python_leave
 * gives both back.
 *
 * `life` is the python_life that the caller's objects belong to, or 0 if it has none. The reason is
 * given if the answer is not ENTERED.
 */
enum entry python_enter(long life, struct stay *stay, struct message *reason);
void python_leave(const struct stay *stay);

/* A number that identifies the running Python: another one after Py_Finalize and a new start. Call
 * it with Python's lock. */
long python_life(void);

#endif
