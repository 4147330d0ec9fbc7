/* instantiate_windows BINARY RESOURCES GUID: loads an FMU's binary for Windows and makes an
 * instance; prints version and log. Ends with 1 if there is no instance. */
#include "fmi2FunctionTypes.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <windows.h>

static void print_log(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                      fmi2String category, fmi2String message, ...)
{
    (void)environment;
    printf("log %d %s %s: ", status, category, name);
    va_list arguments;
    va_start(arguments, message);
    vprintf(message, arguments);
    va_end(arguments);
    printf("\n");
}

int main(int argc, char **argv)
{
    HMODULE library = argc == 4 ? LoadLibraryA(argv[1]) : NULL;
    if (!library) {
        printf("no library: error %lu\n", GetLastError());
        return 2;
    }
    fmi2GetVersionTYPE *version = (fmi2GetVersionTYPE *)GetProcAddress(library, "fmi2GetVersion");
    fmi2InstantiateTYPE *make = (fmi2InstantiateTYPE *)GetProcAddress(library, "fmi2Instantiate");
    if (!version || !make)
        return 3;
    static const fmi2CallbackFunctions callbacks = {print_log, calloc, free, NULL, NULL};
    printf("version %s\n", version());
    return !make("host", fmi2CoSimulation, argv[3], argv[2], &callbacks, fmi2False, fmi2True);
}
