/* A visit to Python: calls made under its lock (GIL), whose messages are sent after its release. */
#ifndef VISIT_H
#define VISIT_H

#include "python.h"
#include "slave.h"

/* A message that waits until Python's lock is released: the listener may wait for other threads. */
struct note {
    struct note *next;
    enum status status;
    char *category, *text;
};

struct visit {
    const struct listener *listener;
    struct stay stay;
    struct note *first, **last;
    bool interrupted;
};

/* Begin a visit to the Python whose python_life is `life` (0: any); DONE if it has begun. */
enum answer visit_begin(struct visit *v, const struct listener *listener, long life);
/* End it: give the notes to the listener, and pass on Ctrl-C to the Python of the host. */
void visit_end(struct visit *v);

/* Keep a message for the listener; `category` may be NULL. */
void add_note(struct visit *v, enum status status, const char *category, const char *text);
/* Note the exception that `where` has raised, and clear it. */
void note_exception(struct visit *v, const char *where);

/* Py_DecRef of an object that may be NULL. */
void release(PyObject *object);
/* The text of `object`, which may be NULL; `*holder` keeps it and is to be released. */
const char *text_of(PyObject *object, PyObject **holder);

#endif
