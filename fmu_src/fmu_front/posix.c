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

bool is_in_own_namespace(const void *address)
{
    Dl_info info;
    Lmid_t namespace = LM_ID_BASE;
    void *library =
        dladdr(address, &info) ? dlopen(info.dli_fname, RTLD_LAZY | RTLD_NOLOAD) : NULL;
    if (library) {
        dlinfo(library, RTLD_DI_LMID, &namespace);
        dlclose(library);
    }
    return namespace != LM_ID_BASE;
}

static int is_below(struct dl_phdr_info *info, size_t size, void *folder)
{
    (void)size;
    char *real = realpath(info->dlpi_name, NULL);
    const size_t length = strlen(folder);
    bool below = real && strncmp(real, folder, length) == 0 && real[length] == '/';
    free(real);
    return below;
}

bool library_is_loaded_below(const char *folder)
{
    char *real = realpath(folder, NULL);
    bool loaded = real && dl_iterate_phdr(is_below, real);
    free(real);
    return loaded;
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
