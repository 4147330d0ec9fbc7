/* Finds and starts the Python of this process. */
#include "python.h"
#include "variables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* Set up Python as isolated as start_python says, by the interface of Python 3.14 and later. */
static bool start_by_config(const char *home, struct message *reason)
{
    static const struct {
        const char *name;
        int64_t value;
    } options[] = {{"isolated", 1},         {"use_environment", 0},
                   {"site_import", 0},      {"user_site_directory", 0},
                   {"utf8_mode", 1},        {"install_signal_handlers", 0},
                   {"configure_locale", 0}, {"parse_argv", 0}};
    void *(*create)(void), (*release)(void *);
    int (*set_int)(void *, const char *, int64_t), (*set_text)(void *, const char *, const char *);
    int (*start)(void *), (*get_error)(void *, const char **);
    *(void **)&create = process_symbol("PyInitConfig_Create");
    *(void **)&release = process_symbol("PyInitConfig_Free");
    *(void **)&set_int = process_symbol("PyInitConfig_SetInt");
    *(void **)&set_text = process_symbol("PyInitConfig_SetStr");
    *(void **)&start = process_symbol("Py_InitializeFromInitConfig");
    *(void **)&get_error = process_symbol("PyInitConfig_GetError");
    void *config = release && set_int && set_text && start && get_error ? create() : NULL;
    if (!config) {
        append_text(reason, ": not a complete Python library");
        return false;
    }
    bool set = set_text(config, "home", home) == 0;
    for (size_t i = 0; set && i < sizeof options / sizeof *options; i++)
        set = set_int(config, options[i].name, options[i].value) == 0;
    bool started = set && start(config) == 0;
    const char *error = NULL;
    if (!started && get_error(config, &error))
        append_text(reason, ": it does not start: %s", error);
    release(config);
    return started;
}

/*
 * The same by the flags of Python 3.10 to 3.13.
 *
 * Flags rather than PyConfig, whose layout differs between versions: one front serves all of them.
 */
static bool start_by_flags(const char *home, struct message *reason)
{
    static const char *const flags[] = {"Py_NoSiteFlag", "Py_IgnoreEnvironmentFlag",
                                        "Py_NoUserSiteDirectory", "Py_IsolatedFlag", "Py_UTF8Mode"};
    void (*initialize)(int), (*set_home)(const wchar_t *);
    *(void **)&initialize = process_symbol("Py_InitializeEx");
    *(void **)&set_home = process_symbol("Py_SetPythonHome");
    static wchar_t wide_home[PATH_SIZE];
    if (!initialize || !set_home || !decode_utf8(home, wide_home, PATH_SIZE)) {
        append_text(reason, ": not a complete Python library");
        return false;
    }
    int *found[sizeof flags / sizeof *flags];
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++)
        if (!(found[i] = process_symbol(flags[i]))) {
            append_text(reason, ": it has no %s, so it cannot be kept from the environment",
                        flags[i]);
            return false;
        }
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++)
        *found[i] = 1;
    set_home(wide_home);
    initialize(0);
    return true;
}

/*
 * Start the Python whose symbols are global, with the standard library in `home` and nothing of the
 * environment.
 *
 * Without its standard library Python would end the process, so the caller checks `home`.
 */
static bool start_python(const char *home, struct message *reason)
{
    struct floats floats;
    floats_take(&floats);
    save_locale();
    bool started = process_symbol("PyInitConfig_Create") ? start_by_config(home, reason)
                                                         : start_by_flags(home, reason);
    restore_locale();
    if (started)
        py.PyEval_SaveThread();
    floats_give_back(&floats);
    return started;
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
    int minor = get_version ? python_minor_version(get_version) : 0;
    char real[PATH_SIZE], home[PATH_SIZE];
    if (minor < OLDEST_PYTHON) {
        append_text(reason, ": not Python 3.%d or newer", OLDEST_PYTHON);
    } else if (!library_path(get_version, real) || !find_home(real, minor, home)) {
        append_text(reason, ": its standard library is not above it");
    } else {
        if (library_open(path, true) && python_find_functions(reason) && start_python(home, reason))
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
    for (int i = NEWEST_PYTHON + 1; i >= OLDEST_PYTHON; i--) {
        int minor = i > NEWEST_PYTHON ? BUILD_PYTHON_MINOR : i;
        if (i == BUILD_PYTHON_MINOR)
            continue;
        snprintf(path, sizeof path, PYTHON_LIBRARY, minor);
        if (try_library(path, "the loader's", reason))
            return true;
    }
    if (installed_python(OLDEST_PYTHON, NEWEST_PYTHON, path))
        return try_library(path, INSTALLED_PYTHON_SOURCE, reason);
    append_text(reason, "; %s none that names its library", INSTALLED_PYTHON_SOURCE);
    return false;
}

static bool has_streams_for_python(struct message *reason)
{
    const char *name = stream_that_is_a_directory();
    if (name)
        append_text(reason,
                    "%s%s of this process is a directory, with which Python does not start; "
                    "redirect it to a file or /dev/null",
                    *reason->text ? "; " : "", name);
    return !name;
}

/* Start the Python that the process has in it. */
static bool start_own_python(int minor, struct message *reason)
{
    char path[PATH_SIZE] = "", home[PATH_SIZE];
    void *get_version = process_symbol("Py_GetVersion");
    if (library_path(get_version, path) && find_home(path, minor, home))
        return start_python(home, reason);
    append_text(reason, ", which is not started, and its standard library is not above %s", path);
    return false;
}

bool python_ready(const char *resources, struct message *reason)
{
    if (!process_symbol("Py_IsInitialized"))
        make_loaded_python_global();
    void *get_version = process_symbol("Py_GetVersion");
    if (get_version) {
        int minor = python_minor_version(get_version);
        append_text(reason, "this process has a Python 3.%d", minor);
        if (minor < OLDEST_PYTHON) {
            append_text(reason, " or older; the FMU needs 3.%d to 3.%d", OLDEST_PYTHON,
                        NEWEST_PYTHON);
            return false;
        }
        return python_find_functions(reason) &&
               (py.Py_IsInitialized() ||
                (has_streams_for_python(reason) && start_own_python(minor, reason)));
    }
    struct message tried = {""};
    if (!has_streams_for_python(reason))
        return false;
    if (find_python(resources, &tried))
        return true;
    append_text(reason,
                "no Python library (libpython) of 3.%d to 3.%d was found for this process%s; set "
                "RLV_LANDING_LIBPYTHON to the path of one",
                OLDEST_PYTHON, NEWEST_PYTHON, tried.text);
    return false;
}
