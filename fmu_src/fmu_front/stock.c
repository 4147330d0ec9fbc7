/* pythonfmu's own binary, beside this library. */
#include "front.h"
#include "variables.h"

#include <stdio.h>
#include <string.h>

struct stock stock;
static void *library;

bool load_stock(struct message *reason)
{
    if (library)
        return true;
    char path[PATH_SIZE];
    if (!library_path(&stock, path)) {
        add(reason, "the folder of this FMU's binary cannot be found");
        return false;
    }
    char *file = strrchr(path, '/') + 1;
    snprintf(file, (size_t)(path + sizeof path - file), "%s", STOCK_BINARY);
    void *opened = library_open(path, false);
    if (!opened) {
        add(reason, "cannot load pythonfmu's binary: %s", library_error());
        return false;
    }
#define FIND(name) *(void **)&stock.name = library_symbol(opened, "fmi2" #name);
    STOCK_FUNCTIONS(FIND)
#undef FIND
#define CHECK(name) &&stock.name
    if (!(true STOCK_FUNCTIONS(CHECK))) {
        add(reason, "%s lacks FMI functions", path);
        return false;
    }
#undef CHECK
    library = opened;
    return true;
}

/* An importer that unloads the FMU unloads pythonfmu's binary with it. */
#if !defined(_WIN32)
__attribute__((destructor))
#endif
void unloaded(void)
{
    if (library)
        library_close(library);
}
