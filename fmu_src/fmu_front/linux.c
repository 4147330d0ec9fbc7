/* What platform.h has for Linux and not for macOS. */
#define _GNU_SOURCE
#include "platform.h"

#include <dlfcn.h>
#include <link.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const PYTHON_LIBRARY = "libpython3.%d.so.1.0";
const char *const STANDARD_LIBRARIES[] = {"%s/lib/python3.%d/encodings/utf_8.py",
                                          "%s/lib64/python3.%d/encodings/utf_8.py", NULL};
const char *const INSTALLED_PYTHON_SOURCE = "python3 on PATH:";

bool usual_python(int oldest, int newest, char path[PATH_SIZE])
{
    (void)oldest, (void)newest, (void)path; /* the loader searches all usual places by itself */
    return false;
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
