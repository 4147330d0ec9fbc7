#include "visit.h"

#include <stdlib.h>
#include <string.h>

enum answer visit_begin(struct visit *v, const struct listener *listener, long life)
{
    struct message reason = {""};
    *v = (struct visit){.listener = listener, .last = &v->first};
    enum entry entry = python_enter(life, &v->stay, &reason);
    if (entry == ENTERED)
        return DONE;
    listener->receive(listener->owner, STATUS_ERROR, NULL, reason.text);
    return entry == ENDED ? LOST : REFUSED;
}

void visit_end(struct visit *v)
{
    python_leave(&v->stay);
    while (v->first) {
        struct note *note = v->first;
        v->first = note->next;
        v->listener->receive(v->listener->owner, note->status, note->category, note->text);
        free(note->category);
        free(note->text);
        free(note);
    }
    /* the Python of the host shall get its Ctrl-C; its logger, which has run by now, need not */
    if (v->interrupted)
        py.PyErr_SetInterrupt();
}

static char *copy_of(const char *text)
{
    char *copy = malloc(strlen(text) + 1);
    return copy ? strcpy(copy, text) : NULL;
}

void add_note(struct visit *v, enum status status, const char *category, const char *text)
{
    struct note *note = calloc(1, sizeof *note);
    if (!note || !(note->text = copy_of(text))) {
        free(note);
        return;
    }
    make_utf8(note->text); /* a long one is cut */
    note->status = status;
    note->category = category ? copy_of(category) : NULL;
    *v->last = note;
    v->last = &note->next;
}

void release(PyObject *object)
{
    if (object)
        py.Py_DecRef(object);
}

const char *text_of(PyObject *object, PyObject **holder)
{
    *holder = object ? py.PyObject_Str(object) : NULL;
    const char *text = *holder ? py.PyUnicode_AsUTF8AndSize(*holder, NULL) : NULL;
    if (text)
        return text;
    py.PyErr_Clear();
    return "(no text)";
}

void note_exception(struct visit *v, const char *where)
{
    PyObject *type = NULL, *value = NULL, *trace = NULL, *name, *names_text, *values_text;
    py.PyErr_Fetch(&type, &value, &trace);
    py.PyErr_NormalizeException(&type, &value, &trace);
    if (type && py.PyErr_GivenExceptionMatches(type, *py.PyExc_KeyboardInterrupt))
        v->interrupted = true;
    name = type ? py.PyObject_GetAttrString(type, "__name__") : NULL;
    struct message message = {""};
    append_text(&message, "internal error in %s: %s", where, text_of(name, &names_text));
    const char *text = text_of(value, &values_text);
    if (*text)
        append_text(&message, ": %s", text);
    add_note(v, STATUS_ERROR, NULL, message.text);
    PyObject *made[] = {values_text, names_text, name, type, value, trace};
    for (size_t i = 0; i < sizeof made / sizeof *made; i++)
        release(made[i]);
}
