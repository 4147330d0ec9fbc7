/* What platform.h has for macOS and not for Linux. */
#include "platform.h"

#include <dlfcn.h>
#include <mach-o/dyld.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const PYTHON_LIBRARY = "libpython3.%d.dylib";
const char *const STANDARD_LIBRARIES[] = {"%s/lib/python3.%d/encodings/utf_8.py", NULL};
const char *const INSTALLED_PYTHON_SOURCE = "python.org's, Homebrew's, or that of python3 on PATH:";
/* python.org's, Homebrew's on Apple silicon and on Intel */
static const char *const FRAMEWORKS[] = {
    "/Library/Frameworks/Python.framework/Versions/3.%d/Python",
    "/opt/homebrew/opt/python@3.%d/Frameworks/Python.framework/Versions/3.%d/Python",
    "/usr/local/opt/python@3.%d/Frameworks/Python.framework/Versions/3.%d/Python",
};

/*
 * installed_python tries these before the python3 on PATH: without developer tools,
 * /usr/bin/python3 is a program that offers to install them.
 */
bool usual_python(int oldest, int newest, char path[PATH_SIZE])
{
    for (int minor = newest; minor >= oldest; minor--)
        for (size_t i = 0; i < sizeof FRAMEWORKS / sizeof *FRAMEWORKS; i++) {
            snprintf(path, PATH_SIZE, FRAMEWORKS[i], minor, minor);
            if (file_exists(path))
                return true;
        }
    return false;
}

/* True if it is the library of one Python 3, be it in a framework or not. */
static bool is_libpython(const char *path)
{
    const char *file = strrchr(path, '/');
    file = file ? file + 1 : path;
    return strncmp(file, "libpython3.", 11) == 0 ||
           (strcmp(file, "Python") == 0 && strstr(path, "/Python.framework/Versions/3."));
}

void make_loaded_python_global(void)
{
    for (uint32_t i = 0; i < _dyld_image_count(); i++) {
        const char *path = _dyld_get_image_name(i);
        if (path && is_libpython(path)) {
            dlopen(path, RTLD_NOW | RTLD_GLOBAL | RTLD_NOLOAD);
            return;
        }
    }
}

bool is_in_own_namespace(const void *address)
{
    (void)address; /* macOS has none */
    return false;
}

bool library_is_loaded_below(const char *folder)
{
    char *below = realpath(folder, NULL);
    bool loaded = false;
    const size_t length = below ? strlen(below) : 0;
    for (uint32_t i = 0; below && !loaded && i < _dyld_image_count(); i++) {
        const char *path = _dyld_get_image_name(i);
        char *real = path ? realpath(path, NULL) : NULL;
        loaded = real && strncmp(real, below, length) == 0 && real[length] == '/';
        free(real);
    }
    free(below);
    return loaded;
}
