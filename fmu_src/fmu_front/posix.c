/* platform.h for Linux. */
#define _GNU_SOURCE
#include "platform.h"

#include <dlfcn.h>
#include <link.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *const PYTHON_LIBRARY = "libpython3.%d.so.1.0";
const char *const STANDARD_LIBRARIES[] = {"%s/lib/python3.%d/os.py", "%s/lib64/python3.%d/os.py",
                                          NULL};
const char *const INSTALLED_PYTHON_SOURCE = "python3 on PATH:";

static const char ASK_PYTHON3_COMMAND[] =
    "python3 -I -S -c \"import os, sysconfig as s; print(os.path.join(s.get_config_var('LIBDIR'), "
    "s.get_config_var('INSTSONAME')))\" 2>/dev/null";

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

const char *library_error(void)
{
    const char *text = dlerror();
    return text ? text : "no reason given";
}

void *process_symbol(const char *name)
{
    return dlsym(RTLD_DEFAULT, name);
}

static int find_libpython(struct dl_phdr_info *info, size_t size, void *found)
{
    (void)size;
    const char *file = strrchr(info->dlpi_name, '/');
    file = file ? file + 1 : info->dlpi_name;
    /* libpython3.so only refers to the library of one version */
    if (strncmp(file, "libpython3.", 11) != 0 || strncmp(file, "libpython3.so", 13) == 0)
        return 0;
    snprintf(found, PATH_SIZE, "%s", info->dlpi_name);
    return 1;
}

void make_loaded_python_global(void)
{
    char path[PATH_SIZE] = "";
    if (dl_iterate_phdr(find_libpython, path))
        dlopen(path, RTLD_NOW | RTLD_GLOBAL | RTLD_NOLOAD);
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
    (void)oldest, (void)newest; /* the caller checks the version */
    FILE *output = popen(ASK_PYTHON3_COMMAND, "r");
    if (!output)
        return false;
    bool found = fgets(line, PATH_SIZE, output) != NULL;
    pclose(output);
    if (found)
        line[strcspn(line, "\r\n")] = '\0';
    return found && line[0] != '\0';
}

void shorten_path(char path[PATH_SIZE])
{
    (void)path;
}

bool link_folder(const char *target, char link[PATH_SIZE])
{
    char folder[] = "/tmp/rlv_landing_XXXXXX";
    if (!mkdtemp(folder))
        return false;
    snprintf(link, PATH_SIZE, "%s/resources", folder);
    if (symlink(target, link) == 0)
        return true;
    rmdir(folder);
    return false;
}

void unlink_folder(const char *link)
{
    char folder[PATH_SIZE];
    snprintf(folder, sizeof folder, "%s", link);
    unlink(folder);
    char *end = strrchr(folder, '/');
    if (end) {
        *end = '\0';
        rmdir(folder);
    }
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
