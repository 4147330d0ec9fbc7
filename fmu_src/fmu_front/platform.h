/*
 * Functions that differ between operating systems: shared libraries, folders, a lock.
 *
 * posix.c has them for Linux and macOS, together with linux.c or macos.c; windows.c for Windows.
 * Paths are UTF-8 and use /.
 */
#ifndef PLATFORM_H
#define PLATFORM_H

#include <stdbool.h>
#include <stddef.h>

#define PATH_SIZE 4096

/* Open a shared library; if `global`, libraries that are opened later see its symbols. */
void *library_open(const char *path, bool global);
void library_close(void *library);
void *library_symbol(void *library, const char *name);
/* A symbol of the program or of any global library; NULL if there is none. */
void *process_symbol(const char *name);
/* Make a libpython global that the program has loaded without global symbols, if there is one. */
void make_loaded_python_global(void);
/* Write the real path of the library that holds `address`. Returns false if it has none. */
bool library_path(const void *address, char path[PATH_SIZE]);

/*
 * True if the library that holds `address` was loaded to a namespace of its own (dlmopen).
 *
 * Python cannot be shared with such a library, nor started a second time in it.
 */
bool is_in_own_namespace(const void *address);

/* True if the process has loaded a library from below the folder. */
bool library_is_loaded_below(const char *folder);

bool file_exists(const char *path);
/* Write the path in an environment variable. Returns false if it is not set or empty. */
bool environment_path(const char *name, char value[PATH_SIZE]);
/*
 * Write the libpython of an installed Python 3.<oldest> to 3.<newest> that the loader does not
 * find.
 *
 * Returns false if there is none.
 */
bool installed_python(int oldest, int newest, char path[PATH_SIZE]);
#ifndef _WIN32
/* The same for the folders where this system usually has it; installed_python calls this first. */
bool usual_python(int oldest, int newest, char path[PATH_SIZE]);
#endif
/*
 * One recursive lock for the whole process, other copies of this library included.
 *
 * It is never held while waiting for Python's lock.
 */
void lock_process(void);
void unlock_process(void);

/*
 * The name of a standard stream that is a directory; NULL if none is.
 *
 * Python would end the process when it starts with such a stream. It starts without streams.
 */
const char *stream_that_is_a_directory(void);

/* Save and restore the program's LC_CTYPE, which the start of Python changes. */
void save_locale(void);
void restore_locale(void);

/* Format of libpython's name for the loader; argument: minor version. */
extern const char *const PYTHON_LIBRARY;
/* Formats of a file of the home that Python needs to start; arguments: home, minor version. NULL ends. */
extern const char *const STANDARD_LIBRARIES[];
/* The place where installed_python looks, for messages. */
extern const char *const INSTALLED_PYTHON_SOURCE;

#endif
