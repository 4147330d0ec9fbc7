/* pythonfmu's binary, which lies beside this library. */
#include "front.h"
#include "variables.h"

#include <stdio.h>
#include <string.h>

struct pythonfmu pythonfmu;
static void *library;

bool load_pythonfmu(struct message *reason)
{
    if (library)
        return true;
    char path[PATH_SIZE];
    if (!library_path(&pythonfmu, path)) {
        append_text(reason, "the folder of this FMU's binary cannot be found");
        return false;
    }
    char *file = strrchr(path, '/') + 1;
    snprintf(file, (size_t)(path + sizeof path - file), "%s", PYTHONFMU_BINARY);
    void *opened = library_open(path, false);
    if (!opened) {
        append_text(reason, "cannot load pythonfmu's binary: %s", library_error());
        return false;
    }
#define FIND(name) *(void **)&pythonfmu.name = library_symbol(opened, "fmi2" #name);
    PYTHONFMU_FUNCTIONS(FIND)
#undef FIND
#define CHECK(name) &&pythonfmu.name
    if (!(true PYTHONFMU_FUNCTIONS(CHECK))) {
        append_text(reason, "%s lacks FMI functions", path);
        return false;
    }
#undef CHECK
    library = opened;
    return true;
}

/* Unload pythonfmu's binary with this library. */
#if !defined(_WIN32)
__attribute__((destructor))
#endif
void on_unload(void)
{
    if (library)
        library_close(library);
}
