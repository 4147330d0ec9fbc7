/* many BINARY RESOURCES GUID COUNT WHAT: does something COUNT times and prints how much memory [bytes]
 * the process has taken for each time, the first tenth left out. WHAT is `instance`: makes,
 * initialises, steps and frees an instance; `state`: the same, and takes and frees a state;
 * `message`: a step that is refused with a logged message. */
#include "host.h"

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
    int count = atoi(argv[4]), skipped = count / 10;
    long before = 0;
    fmi2Component one = strcmp(argv[5], "message") ? NULL : made(argv);
    for (int i = 0; i < count; i++) {
        if (i == skipped)
            before = resident();
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
    printf("%.1f\n", (double)(resident() - before) / (count - skipped));
    return 0;
}
