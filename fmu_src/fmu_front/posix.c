/* platform.h for Linux and macOS; linux.c and macos.c have what differs between them. */
#define _GNU_SOURCE
#include "platform.h"

#include <dlfcn.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char ASK_PYTHON3_COMMAND[] =
    "python3 -I -S -c \"import os, sysconfig as s; v = s.get_config_var; "
    "print(os.path.join(v('PYTHONFRAMEWORKPREFIX') or v('LIBDIR'), v('INSTSONAME')))\" 2>/dev/null";

static char *locale_name;

void *library_open(const char *path, bool global)
{
    return dlopen(path, RTLD_NOW | (global ? RTLD_GLOBAL : RTLD_LOCAL));
}

void library_close(void *library)
{
    dlclose(library);
}

void *library_symbol(void *library, const char *name)
{
    return dlsym(library, name);
}

void *process_symbol(const char *name)
{
    return dlsym(RTLD_DEFAULT, name);
}

bool library_path(const void *address, char path[PATH_SIZE])
{
    Dl_info info;
    if (!dladdr(address, &info) || !info.dli_fname)
        return false;
    char *real = realpath(info.dli_fname, NULL);
    if (!real)
        return false;
    bool fits = snprintf(path, PATH_SIZE, "%s", real) < PATH_SIZE;
    free(real);
    return fits;
}

bool file_exists(const char *path)
{
    return access(path, R_OK) == 0;
}

bool environment_path(const char *name, char value[PATH_SIZE])
{
    const char *text = getenv(name);
    return text && *text && snprintf(value, PATH_SIZE, "%s", text) < PATH_SIZE;
}

bool installed_python(int oldest, int newest, char line[PATH_SIZE])
{
    if (usual_python(oldest, newest, line))
        return true;
    /* the caller checks the version */
    FILE *output = popen(ASK_PYTHON3_COMMAND, "r");
    if (!output)
        return false;
    bool found = fgets(line, PATH_SIZE, output) != NULL;
    pclose(output);
    if (found)
        line[strcspn(line, "\r\n")] = '\0';
    return found && line[0] != '\0';
}

/*
 * The lock of standard error: a recursive lock that all copies of this library share, and that
 * other code holds only for the time of a write.
 */
void lock_process(void)
{
    flockfile(stderr);
}

void unlock_process(void)
{
    funlockfile(stderr);
}

const char *stream_that_is_a_directory(void)
{
    static const char *const names[] = {"standard input", "standard output", "standard error"};
    for (int i = 0; i < 3; i++) {
        struct stat status;
        if (fstat(i, &status) == 0 && S_ISDIR(status.st_mode))
            return names[i];
    }
    return NULL;
}

void save_locale(void)
{
    const char *name = setlocale(LC_CTYPE, NULL);
    locale_name = name ? strdup(name) : NULL;
}

void restore_locale(void)
{
    if (locale_name)
        setlocale(LC_CTYPE, locale_name);
    free(locale_name);
    locale_name = NULL;
}
