/* many BINARY RESOURCES GUID COUNT STATE: makes, initialises, steps and frees COUNT instances one
 * after the other; with STATE 1 each also takes and frees a state. Prints how much memory [bytes]
 * the process has taken for each of them, the first hundred left out. */
#include "host.h"

#include <unistd.h>

static long resident(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%*s %ld", &pages) != 1)
        exit(2);
    fclose(file);
    return pages * sysconf(_SC_PAGESIZE);
}

int main(int argc, char **argv)
{
    if (argc != 6)
        return 2;
    load(argv[1]);
    int count = atoi(argv[4]);
    long before = 0;
    for (int i = 0; i < count; i++) {
        if (i == 100)
            before = resident();
        fmi2Component c = instantiate("one of many", argv[2], argv[3]);
        fmi2FMUstate state = NULL;
        if (!c)
            return 1;
        initialise(c);
        must(fmi2.DoStep(c, 0.0, 1e-3, fmi2True), "step");
        if (atoi(argv[5])) {
            must(fmi2.GetFMUstate(c, &state), "get state");
            must(fmi2.SetFMUstate(c, state), "set state");
            must(fmi2.FreeFMUstate(c, &state), "free state");
        }
        must(fmi2.Terminate(c), "terminate");
        fmi2.FreeInstance(c);
    }
    printf("%ld\n", (resident() - before) / (count - 100));
    return 0;
}
