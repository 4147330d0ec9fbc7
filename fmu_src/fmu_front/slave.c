/* The slave: calls of its Python methods, with values of C. */
#include "slave.h"
#include "variables.h"
#include "visit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define METHODS(X) \
    X(GET_LOG_QUEUE, _get_log_queue) \
    X(SETUP, setup_experiment) \
    X(ENTER_INITIALIZATION, enter_initialization_mode) \
    X(EXIT_INITIALIZATION, exit_initialization_mode) \
    X(STEP, do_step) \
    X(TERMINATE, terminate) \
    X(GET_REAL, get_real) \
    X(GET_INTEGER, get_integer) \
    X(GET_BOOLEAN, get_boolean) \
    X(GET_STRING, get_string) \
    X(SET_REAL, set_real) \
    X(SET_INTEGER, set_integer) \
    X(SET_BOOLEAN, set_boolean) \
    X(SET_STRING, set_string) \
    X(GET_STATE, _get_fmu_state) \
    X(SET_STATE, _set_fmu_state) \
    X(STATE_TO_BYTES, _fmu_state_to_bytes) \
    X(STATE_FROM_BYTES, _fmu_state_from_bytes) \
    X(GET_OUTPUTS, get_outputs) /* this and the next may be missing */ \
    X(STEP_PART, do_part)

#define NUMBER(name, method) name,
enum method { METHODS(NUMBER) METHOD_COUNT };
#undef NUMBER

static const char *const METHOD_NAMES[] = {
#define NAME(name, method) #method,
    METHODS(NAME)
#undef NAME
};

struct slave {
    struct listener listener;
    long life; /* python_life of the Python that its objects belong to */
    PyObject *methods[METHOD_COUNT];
    PyObject *strings; /* the list of strings that was read last */
};

struct slave_state {
    long life;
    PyObject *object, *bytes; /* bytes is NULL until they are asked for */
};

static void note_log_message(struct visit *v, PyObject *message)
{
    PyObject *status = py.PyObject_GetAttrString(message, "status"),
             *category = py.PyObject_GetAttrString(message, "category"),
             *text = py.PyObject_GetAttrString(message, "msg"), *category_text, *text_text;
    long number = status ? py.PyLong_AsLong(status) : STATUS_ERROR;
    if (py.PyErr_Occurred())
        py.PyErr_Clear();
    /* FMI's Fatal is an error of this instance, not of the process */
    enum status known =
        number >= STATUS_OK && number <= STATUS_ERROR ? (enum status)number : STATUS_ERROR;
    const char *name = text_of(category, &category_text);
    add_note(v, known, number == (long)known ? name : NULL, text_of(text, &text_text));
    PyObject *made[] = {category_text, text_text, status, category, text};
    for (size_t i = 0; i < sizeof made / sizeof *made; i++)
        release(made[i]);
}

/* Move the messages that the slave has logged to the visit's list. */
static void take_messages(struct visit *v, struct slave *s)
{
    PyObject *queue = py.PyObject_CallObject(s->methods[GET_LOG_QUEUE], NULL);
    Py_ssize_t count = queue ? py.PyList_Size(queue) : -1;
    for (Py_ssize_t i = 0; i < count; i++)
        note_log_message(v, py.PyList_GetItem(queue, i));
    if (count > 0)
        py.PyList_SetSlice(queue, 0, count, NULL);
    if (py.PyErr_Occurred())
        note_exception(v, METHOD_NAMES[GET_LOG_QUEUE]);
    release(queue);
}

/* The result of a method; `arguments` is NULL, with an exception set, if they could not be made. */
static PyObject *call(struct slave *s, enum method method, PyObject *arguments)
{
    PyObject *result =
        arguments ? py.PyObject_CallObject(s->methods[method], arguments) : arguments;
    release(arguments);
    return result;
}

/* After a call: keep its exception, if there is one, and the slave's messages; end the visit. */
static enum answer end_call(struct visit *v, struct slave *s, enum method method)
{
    enum answer answer = DONE;
    if (py.PyErr_Occurred()) {
        note_exception(v, METHOD_NAMES[method]);
        answer = LOST;
    }
    take_messages(v, s);
    visit_end(v);
    return answer;
}

/* Call a method that has no arguments and no result. */
static enum answer do_call(struct slave *s, enum method method)
{
    struct visit v;
    enum answer entry = visit_begin(&v, &s->listener, s->life);
    if (entry != DONE)
        return entry;
    release(py.PyObject_CallObject(s->methods[method], NULL));
    return end_call(&v, s, method);
}

enum { KEY_SIZE = 64 };

/* Write the key under which this FMU keeps `what` in a Python. */
static const char *own_key(const char *what, char key[KEY_SIZE])
{
    snprintf(key, KEY_SIZE, "rlv_landing %s %s", what, GUID);
    return key;
}

/* The function of create_slave.py (a borrowed reference), compiled once in each interpreter. */
static PyObject *creator(void)
{
    char key[KEY_SIZE];
    PyObject *kept = py.PyInterpreterState_GetDict(py.PyInterpreterState_Get());
    PyObject *known = kept ? py.PyDict_GetItemString(kept, own_key("create", key)) : NULL;
    if (known || !kept)
        return known;
    enum { FILE_INPUT = 257 }; /* Py_file_input */
    PyObject *code = py.Py_CompileString(CREATE_SLAVE, "create_slave.py", FILE_INPUT);
    PyObject *globals = py.PyDict_New(), *result = NULL;
    if (code && globals &&
        py.PyDict_SetItemString(globals, "__builtins__", py.PyEval_GetBuiltins()) == 0)
        result = py.PyEval_EvalCode(code, globals, globals);
    if (result) {
        known = py.PyDict_GetItemString(globals, "create");
        if (known && py.PyDict_SetItemString(kept, key, known) != 0)
            known = NULL;
    }
    release(result);
    release(globals);
    release(code);
    return known;
}

static bool find_methods(struct slave *s, PyObject *object)
{
    for (int i = 0; i < METHOD_COUNT; i++) {
        s->methods[i] = py.PyObject_GetAttrString(object, METHOD_NAMES[i]);
        if (!s->methods[i] && i < GET_OUTPUTS)
            return false;
    }
    py.PyErr_Clear();
    return true;
}

static void release_methods(struct slave *s)
{
    for (int i = 0; i < METHOD_COUNT; i++)
        release(s->methods[i]);
}

/*
 * True if the compiled core of this FMU was loaded by a Python that was finalised since. It cannot
 * be loaded again: its module is gone, and the library, which stays loaded, would return it.
 */
static bool compiled_core_is_lost(const char *resources)
{
    char key[KEY_SIZE];
    PyObject *kept = py.PyInterpreterState_GetDict(py.PyInterpreterState_Get());
    if (!kept || py.PyDict_GetItemString(kept, own_key("core", key)))
        return false;
    bool loaded = library_is_loaded_below(resources);
    PyObject *mark = py.PyBool_FromLong(1);
    if (!loaded && mark)
        py.PyDict_SetItemString(kept, key, mark);
    release(mark);
    return loaded;
}

struct slave *slave_create(const char *resources, const char *name, bool visible,
                           const struct listener *listener)
{
    struct slave *s = calloc(1, sizeof *s);
    struct visit v;
    if (!s || visit_begin(&v, listener, 0) != DONE) {
        free(s);
        return NULL;
    }
    s->listener = *listener;
    s->life = python_life();
    PyObject *create = creator(), *object = NULL;
    if (create) {
        PyObject *arguments = py.Py_BuildValue(
            "(NssNN)", py.PyUnicode_DecodeFSDefault(resources), SLAVE_MODULE, name,
            py.PyBool_FromLong(visible), py.PyBool_FromLong(compiled_core_is_lost(resources)));
        object = arguments ? py.PyObject_CallObject(create, arguments) : NULL;
        release(arguments);
    }
    bool found = object && find_methods(s, object);
    if (found)
        take_messages(&v, s);
    else {
        note_exception(&v, "the creation of the slave");
        release_methods(s);
    }
    release(object); /* its methods hold it */
    visit_end(&v);
    if (found)
        return s;
    free(s);
    return NULL;
}

void slave_free(struct slave *s)
{
    struct stay stay;
    struct message reason = {""};
    /* the objects of a Python that was finalised are gone with it */
    if (python_enter(s->life, &stay, &reason) == ENTERED) {
        release(s->strings);
        release_methods(s);
        python_leave(&stay);
    }
    free(s);
}

/* A float, or None for NULL. */
static PyObject *optional_float(const double *value)
{
    return value ? py.PyFloat_FromDouble(*value) : py.Py_BuildValue("");
}

enum answer slave_setup(struct slave *s, double start, const double *stop, const double *tolerance)
{
    struct visit v;
    enum answer entry = visit_begin(&v, &s->listener, s->life);
    if (entry != DONE)
        return entry;
    release(call(
        s, SETUP,
        py.Py_BuildValue("(dNN)", start, optional_float(stop), optional_float(tolerance))));
    return end_call(&v, s, SETUP);
}

enum answer slave_enter_initialization(struct slave *s)
{
    return do_call(s, ENTER_INITIALIZATION);
}

enum answer slave_exit_initialization(struct slave *s)
{
    return do_call(s, EXIT_INITIALIZATION);
}

enum answer slave_terminate(struct slave *s)
{
    return do_call(s, TERMINATE);
}

static PyObject *references(const uint32_t vr[], size_t n)
{
    PyObject *list = py.PyList_New((Py_ssize_t)n);
    for (size_t i = 0; list && i < n; i++)
        py.PyList_SetItem(list, (Py_ssize_t)i, py.PyLong_FromUnsignedLong(vr[i]));
    return list;
}

/* Write the `n` numbers of a list that the slave has returned; an exception if it has others. */
static void copy_numbers(PyObject *list, size_t n, double value[])
{
    for (size_t i = 0; list && i < n; i++) {
        PyObject *item = py.PyList_GetItem(list, (Py_ssize_t)i);
        value[i] = item ? py.PyFloat_AsDouble(item) : -1.0;
        if (value[i] == -1.0 && py.PyErr_Occurred())
            return;
    }
}

enum answer slave_step(struct slave *s, double time, double step)
{
    struct visit v;
    enum answer entry = visit_begin(&v, &s->listener, s->life);
    if (entry != DONE)
        return entry;
    PyObject *result = call(s, STEP, py.Py_BuildValue("(dd)", time, step));
    bool refused = result && py.PyObject_IsTrue(result) == 0;
    release(result);
    enum answer answer = end_call(&v, s, STEP);
    return answer == DONE && refused ? REFUSED : answer;
}

enum answer slave_step_part(struct slave *s, double time, double step, struct part *part)
{
    double found[] = {INFINITY, 0.0}; /* the time reached, and whether there is an event */
    struct visit v;
    if (!s->methods[STEP_PART]) {
        part->reached = INFINITY;
        part->event = false;
        return slave_step(s, time, step);
    }
    enum answer entry = visit_begin(&v, &s->listener, s->life);
    if (entry != DONE)
        return entry;
    PyObject *arguments =
        py.Py_BuildValue("(dddd)", time, step, part->stop, part->to_event ? 1.0 : 0.0);
    PyObject *list = call(s, STEP_PART, arguments);
    bool refused = list && py.PyObject_IsTrue(list) == 0;
    if (!refused)
        copy_numbers(list, sizeof found / sizeof *found, found);
    release(list);
    part->reached = found[0];
    part->event = found[1] > 0.0;
    enum answer answer = end_call(&v, s, STEP_PART);
    return answer == DONE && refused ? REFUSED : answer;
}

enum answer slave_read(struct slave *s, enum kind kind, const uint32_t vr[], size_t n,
                       double value[])
{
    enum method method = kind == REAL ? GET_REAL : kind == INTEGER ? GET_INTEGER : GET_BOOLEAN;
    struct visit v;
    enum answer entry = visit_begin(&v, &s->listener, s->life);
    if (entry != DONE)
        return entry;
    PyObject *list = call(s, method, py.Py_BuildValue("(N)", references(vr, n)));
    copy_numbers(list, n, value);
    release(list);
    return end_call(&v, s, method);
}

bool slave_has_outputs(const struct slave *s)
{
    return s->methods[GET_OUTPUTS] != NULL;
}

enum answer slave_read_outputs(struct slave *s, size_t n, double value[])
{
    struct visit v;
    enum answer entry = visit_begin(&v, &s->listener, s->life);
    if (entry != DONE)
        return entry;
    PyObject *list = py.PyObject_CallObject(s->methods[GET_OUTPUTS], NULL);
    copy_numbers(list, n, value);
    release(list);
    return end_call(&v, s, GET_OUTPUTS);
}

enum answer slave_read_strings(struct slave *s, const uint32_t vr[], size_t n, const char *value[])
{
    struct visit v;
    enum answer entry = visit_begin(&v, &s->listener, s->life);
    if (entry != DONE)
        return entry;
    PyObject *list = call(s, GET_STRING, py.Py_BuildValue("(N)", references(vr, n)));
    for (size_t i = 0; list && i < n; i++) {
        PyObject *item = py.PyList_GetItem(list, (Py_ssize_t)i);
        if (!item || !(value[i] = py.PyUnicode_AsUTF8AndSize(item, NULL)))
            break;
    }
    if (list) {
        release(s->strings);
        s->strings = list;
    }
    return end_call(&v, s, GET_STRING);
}

static PyObject *number(enum kind kind, double value)
{
    return kind == REAL      ? py.PyFloat_FromDouble(value)
           : kind == INTEGER ? py.PyLong_FromLong((long)value)
                             : py.PyBool_FromLong(value != 0.0);
}

enum answer slave_write(struct slave *s, enum kind kind, const uint32_t vr[], size_t n,
                        const double value[])
{
    enum method method = kind == REAL ? SET_REAL : kind == INTEGER ? SET_INTEGER : SET_BOOLEAN;
    struct visit v;
    enum answer entry = visit_begin(&v, &s->listener, s->life);
    if (entry != DONE)
        return entry;
    PyObject *values = py.PyList_New((Py_ssize_t)n);
    for (size_t i = 0; values && i < n; i++)
        py.PyList_SetItem(values, (Py_ssize_t)i, number(kind, value[i]));
    release(call(s, method, py.Py_BuildValue("(NN)", references(vr, n), values)));
    return end_call(&v, s, method);
}

enum answer slave_write_strings(struct slave *s, const uint32_t vr[], size_t n,
                                const char *const value[])
{
    struct visit v;
    enum answer entry = visit_begin(&v, &s->listener, s->life);
    if (entry != DONE)
        return entry;
    PyObject *values = py.PyList_New((Py_ssize_t)n);
    for (size_t i = 0; values && i < n; i++)
        py.PyList_SetItem(values, (Py_ssize_t)i, py.PyUnicode_FromString(value[i]));
    release(call(s, SET_STRING, py.Py_BuildValue("(NN)", references(vr, n), values)));
    return end_call(&v, s, SET_STRING);
}

/* A state that holds `object`, whose reference it takes; NULL if there is none. */
static struct slave_state *new_state(const struct slave *s, PyObject *object)
{
    struct slave_state *state = object ? malloc(sizeof *state) : NULL;
    if (state)
        *state = (struct slave_state){.life = s->life, .object = object};
    else
        release(object);
    return state;
}

enum answer slave_get_state(struct slave *s, struct slave_state **state)
{
    struct visit v;
    *state = NULL;
    enum answer entry = visit_begin(&v, &s->listener, s->life);
    if (entry != DONE)
        return entry;
    *state = new_state(s, py.PyObject_CallObject(s->methods[GET_STATE], NULL));
    return end_call(&v, s, GET_STATE);
}

/* False, with the reason given to the listener, if the state's Python was finalised. */
static bool has_its_python(const struct slave *s, const struct slave_state *state)
{
    if (state->life == s->life)
        return true;
    s->listener.receive(s->listener.owner, STATUS_ERROR, NULL,
                     "the state is gone with the Python that held it, which has ended");
    return false;
}

enum answer slave_set_state(struct slave *s, const struct slave_state *state)
{
    struct visit v;
    if (!has_its_python(s, state))
        return REFUSED;
    enum answer entry = visit_begin(&v, &s->listener, s->life);
    if (entry != DONE)
        return entry;
    release(call(s, SET_STATE, py.Py_BuildValue("(O)", state->object)));
    return end_call(&v, s, SET_STATE);
}

enum answer slave_state_bytes(struct slave *s, struct slave_state *state, const char **bytes,
                              size_t *size)
{
    struct visit v;
    char *start = NULL;
    Py_ssize_t length = 0;
    if (!has_its_python(s, state))
        return REFUSED;
    enum answer entry = visit_begin(&v, &s->listener, s->life);
    if (entry != DONE)
        return entry;
    if (!state->bytes)
        state->bytes = call(s, STATE_TO_BYTES, py.Py_BuildValue("(O)", state->object));
    if (state->bytes)
        py.PyBytes_AsStringAndSize(state->bytes, &start, &length);
    *bytes = start;
    *size = (size_t)length;
    return end_call(&v, s, STATE_TO_BYTES);
}

enum answer slave_state_from_bytes(struct slave *s, const char *bytes, size_t size,
                                   struct slave_state **state)
{
    struct visit v;
    *state = NULL;
    enum answer entry = visit_begin(&v, &s->listener, s->life);
    if (entry != DONE)
        return entry;
    PyObject *copy = py.PyBytes_FromStringAndSize(bytes, (Py_ssize_t)size);
    *state = new_state(s, call(s, STATE_FROM_BYTES, py.Py_BuildValue("(N)", copy)));
    return end_call(&v, s, STATE_FROM_BYTES);
}

void slave_free_state(struct slave_state *state)
{
    struct stay stay;
    struct message reason = {""};
    if (python_enter(state->life, &stay, &reason) == ENTERED) {
        release(state->object);
        release(state->bytes);
        python_leave(&stay);
    }
    free(state);
}
