/* What differs between operating systems: shared libraries, folders, a lock. posix.c has it for Linux, windows.c for Windows. */
#ifndef PLATFORM_H
#define PLATFORM_H

#include <stdbool.h>
#include <stddef.h>

#define PATH_SIZE 4096

/* Shared libraries. A library opened for all lets libraries that are opened later see its symbols. */
void *library_open(const char *path, bool for_all);
void library_close(void *library);
void *library_symbol(void *library, const char *name);
/* Why the last library_open failed. */
const char *library_error(void);
/* A symbol of the program or of any library that is open for all; NULL if there is none. */
void *process_symbol(const char *name);
/* Open for all the libpython that some part of the program has loaded for itself alone, if there is one. */
void share_loaded_python(void);
/* Write the real path of the library that holds `address`; false if it has none. */
bool library_path(const void *address, char path[PATH_SIZE]);

bool file_exists(const char *path);
/* The value of an environment variable that is a path; false if it is not set or empty. */
bool environment(const char *name, char value[PATH_SIZE]);
/* The libpython of a Python 3.<oldest> to 3.<newest> that is installed where no loader looks; false if there is none. */
bool installed_python(int oldest, int newest, char path[PATH_SIZE]);
/* Replace a path by the short name that the system keeps for it, if it does. */
void shorten(char path[PATH_SIZE]);
/* Make a link to the folder `target`, or a copy, under a plain name in the temporary folder; write where. false and errno if it fails. */
bool link_folder(const char *target, char link[PATH_SIZE]);
/* Remove what link_folder made. */
void unlink_folder(const char *link);

/* Called when this library is unloaded; on Windows not at the end of the process, when other libraries may be gone. */
void unloaded(void);

/* One lock of the whole process, also for another copy of this library. Never held while waiting for Python. */
void lock(void);
void unlock(void);

/* The character set of the program, kept over the start of Python, which would change it. */
void keep_locale(void);
void restore_locale(void);

/* The name under which the loader knows libpython 3.<minor>; files of the standard library below a Python's home, by home and minor. */
extern const char *const PYTHON_LIBRARY;
extern const char *const STANDARD_LIBRARIES[];
/* Where installed_python looks. */
extern const char *const LAST_RESORT;

#endif
