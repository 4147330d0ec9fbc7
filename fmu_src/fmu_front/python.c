#include "python.h"
#include "variables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OLDEST = 10, NEWEST = 13 };

/* Minor version of the Python 3 whose Py_GetVersion this is; 0 for another Python. */
static int minor_version(void *get_version)
{
    const char *(*version)(void);
    *(void **)&version = get_version;
    int minor = 0;
    return sscanf(version(), "3.%d", &minor) == 1 ? minor : 0;
}

/* Write the folder above `library` that holds the standard library of Python 3.`minor`. */
static bool find_home(const char *library, int minor, char home[PATH_SIZE])
{
    snprintf(home, PATH_SIZE, "%s", library);
    for (char *end = strrchr(home, '/'); end && end != home; end = strrchr(home, '/')) {
        *end = '\0';
        for (const char *const *where = STANDARD_LIBRARIES; *where; where++) {
            char file[PATH_SIZE + 40];
            snprintf(file, sizeof file, *where, home, minor);
            if (file_exists(file))
                return true;
        }
    }
    return false;
}

/*
 * Start the Python whose symbols are global, with the standard library in `home` and nothing of the
 * environment.
 *
 * Flags rather than PyConfig, whose layout differs between versions: one front serves all of them.
 * Without its standard library Python would end the process, so the caller checks `home`.
 */
static bool start_python(const char *home, struct message *reason)
{
    static const char *const flags[] = {"Py_NoSiteFlag", "Py_IgnoreEnvironmentFlag",
                                        "Py_NoUserSiteDirectory", "Py_IsolatedFlag", "Py_UTF8Mode"};
    void (*initialize)(int), (*set_home)(const wchar_t *);
    void *(*release)(void);
    *(void **)&initialize = process_symbol("Py_InitializeEx");
    *(void **)&set_home = process_symbol("Py_SetPythonHome");
    *(void **)&release = process_symbol("PyEval_SaveThread");
    static wchar_t wide_home[PATH_SIZE];
    if (!initialize || !set_home || !release || !decode_utf8(home, wide_home, PATH_SIZE)) {
        append_text(reason, ": not a complete Python library");
        return false;
    }
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) {
        int *flag = process_symbol(flags[i]);
        if (flag)
            *flag = 1;
    }
    set_home(wide_home);
    save_locale();
    initialize(0);
    restore_locale();
    release();
    return true;
}

/* Open the library `path`, check it and start its Python; `what` names its origin in the message.
 */
static bool try_library(const char *path, const char *what, struct message *reason)
{
    append_text(reason, "; %s %s", what, path);
    void *library = library_open(path, false);
    if (!library) {
        append_text(reason, ": %s",
                    strchr(path, '/') && !file_exists(path) ? "no such file" : "cannot be loaded");
        return false;
    }
    void *get_version = library_symbol(library, "Py_GetVersion");
    int minor = get_version ? minor_version(get_version) : 0;
    char real[PATH_SIZE], home[PATH_SIZE];
    if (minor < OLDEST) {
        append_text(reason, ": not Python 3.%d or newer", OLDEST);
    } else if (!library_path(get_version, real) || !find_home(real, minor, home)) {
        append_text(reason, ": its standard library is not above it");
    } else {
        if (library_open(path, true) && start_python(home, reason))
            return true; /* stays open: Python cannot be unloaded */
    }
    library_close(library);
    return false;
}

/* The first line of the file `name` in `folder`; false if it is empty or not there. */
static bool read_line(const char *folder, const char *name, char line[PATH_SIZE])
{
    char path[PATH_SIZE + 20];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "r");
    if (!file)
        return false;
    bool found = fgets(line, PATH_SIZE, file) != NULL;
    fclose(file);
    if (found)
        line[strcspn(line, "\r\n")] = '\0';
    return found && line[0] != '\0';
}

static bool find_python(const char *resources, struct message *reason)
{
    char path[PATH_SIZE];
    /* the user's choice is the only candidate */
    if (environment_path("RLV_LANDING_LIBPYTHON", path))
        return try_library(path, "RLV_LANDING_LIBPYTHON =", reason);
    append_text(reason, "; RLV_LANDING_LIBPYTHON: not set");
    if (read_line(resources, "libpython.txt", path) &&
        try_library(path, "recorded at build:", reason))
        return true;
    /* first the version that built the FMU, which has a compiled core for it */
    for (int i = NEWEST + 1; i >= OLDEST; i--) {
        int minor = i > NEWEST ? BUILD_PYTHON_MINOR : i;
        if (i == BUILD_PYTHON_MINOR)
            continue;
        snprintf(path, sizeof path, PYTHON_LIBRARY, minor);
        if (try_library(path, "the loader's", reason))
            return true;
    }
    if (installed_python(OLDEST, NEWEST, path))
        return try_library(path, INSTALLED_PYTHON_SOURCE, reason);
    append_text(reason, "; %s none that names its library", INSTALLED_PYTHON_SOURCE);
    return false;
}

bool python_ready(const char *resources, struct message *reason)
{
    int (*is_initialized)(void);
    if (!process_symbol("Py_IsInitialized"))
        make_loaded_python_global();
    *(void **)&is_initialized = process_symbol("Py_IsInitialized");
    if (is_initialized) {
        void *get_version = process_symbol("Py_GetVersion");
        int minor = get_version ? minor_version(get_version) : 0;
        if (minor < OLDEST) {
            append_text(reason,
                        "this process has a Python older than 3.%d; the FMU needs 3.%d to 3.%d",
                        OLDEST, OLDEST, NEWEST);
            return false;
        }
        if (is_initialized())
            return true;
        char path[PATH_SIZE], home[PATH_SIZE];
        if (library_path(get_version, path) && find_home(path, minor, home))
            return start_python(home, reason);
        append_text(reason,
                    "this process has a Python 3.%d that is not started, and its standard library "
                    "is not above %s",
                    minor, path);
        return false;
    }
    struct message tried = {""};
    if (find_python(resources, &tried))
        return true;
    append_text(reason,
                "no Python library (libpython) of 3.%d to 3.%d was found for this process%s; set "
                "RLV_LANDING_LIBPYTHON to the path of one",
                OLDEST, NEWEST, tried.text);
    return false;
}

void interrupt_python(void)
{
    void (*set_interrupt)(void);
    *(void **)&set_interrupt = process_symbol("PyErr_SetInterrupt");
    if (set_interrupt)
        set_interrupt();
}
