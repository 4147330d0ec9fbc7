/* many BINARY RESOURCES GUID COUNT WHAT: does something COUNT times and prints how much memory [bytes]
 * the process has taken for each time. The first fifth is left out, the rest is measured in four
 * parts, and the least of them is printed: a leak grows in each part, an arena of Python's begins in
 * one. WHAT is `instance`: makes,
 * initialises, steps and frees an instance; `state`: the same, and takes and frees a state;
 * `message`: a step that is refused with a logged message. */
#include "host.h"

#include <limits.h>
#include <unistd.h>

static void drop_log(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status,
                     fmi2String category, fmi2String message, ...)
{
    (void)environment, (void)name, (void)status, (void)category, (void)message;
}

static const fmi2CallbackFunctions QUIET = {drop_log, calloc, free, NULL, NULL};

static long resident(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%*s %ld", &pages) != 1)
        exit(2);
    fclose(file);
    return pages * sysconf(_SC_PAGESIZE);
}

/* The memory now, and the least growth since the one before, if this ends a measured part. */
static void measure(int ended, long *before, long *least)
{
    long now = resident();
    if (ended && now - *before < *least)
        *least = now - *before;
    *before = now;
}

static fmi2Component made(char **argv)
{
    fmi2Component c = fmi2.Instantiate("one of many", fmi2CoSimulation, argv[3], argv[2], &QUIET,
                                       fmi2False, fmi2True);
    if (!c) {
        printf("no instance\n");
        exit(1);
    }
    initialise(c);
    return c;
}

int main(int argc, char **argv)
{
    if (argc != 6)
        return 2;
    load(argv[1]);
    int count = atoi(argv[4]), part = count / 5;
    if (part < 1)
        return 2;
    long before = 0, least = LONG_MAX;
    fmi2Component one = strcmp(argv[5], "message") ? NULL : made(argv);
    for (int i = 0; i < 5 * part; i++) {
        if (i % part == 0)
            measure(i > part, &before, &least);
        if (one) {
            if (fmi2.DoStep(one, 5.0, 1e-3, fmi2True) < fmi2Discard)
                return 3;
            continue;
        }
        fmi2Component c = made(argv);
        fmi2FMUstate state = NULL;
        must(fmi2.DoStep(c, 0.0, 1e-3, fmi2True), "step");
        if (strcmp(argv[5], "state") == 0) {
            must(fmi2.GetFMUstate(c, &state), "get state");
            must(fmi2.SetFMUstate(c, state), "set state");
            must(fmi2.FreeFMUstate(c, &state), "free state");
        }
        must(fmi2.Terminate(c), "terminate");
        fmi2.FreeInstance(c);
    }
    measure(1, &before, &least);
    printf("%.1f\n", (double)least / part);
    return 0;
}
