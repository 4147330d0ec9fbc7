/* land BINARY RESOURCES GUID STEPS EVERY FIRST COUNT: lands in steps of 1 ms and prints the reals
 * FIRST .. FIRST + COUNT - 1 every EVERY steps, and at last which core it has used. RESOURCES may
 * be NULL. */
#include "host.h"

/* True if the process has loaded the compiled core. */
static int has_compiled_core(void)
{
    char line[8192];
    int found = 0;
    FILE *maps = fopen("/proc/self/maps", "r");
    while (maps && fgets(line, sizeof line, maps))
        found |= strstr(line, "/compiled.abi3.so") != NULL;
    if (maps)
        fclose(maps);
    return found;
}

int main(int argc, char **argv)
{
    if (argc != 8)
        return 2;
    void *library = load(argv[1]);
    fmi2Component c = instantiate("land", strcmp(argv[2], "NULL") ? argv[2] : NULL, argv[3]);
    if (!c)
        return 1;
    initialise(c);
    int steps = atoi(argv[4]), every = atoi(argv[5]), first = atoi(argv[6]), count = atoi(argv[7]);
    fmi2ValueReference *vr = calloc((size_t)count, sizeof *vr);
    fmi2Real *values = calloc((size_t)count, sizeof *values);
    for (int i = 0; i < count; i++)
        vr[i] = (fmi2ValueReference)(first + i);
    for (int k = 0; k < steps; k++) {
        must(fmi2.DoStep(c, k * 1e-3, 1e-3, fmi2True), "step");
        if ((k + 1) % every)
            continue;
        must(fmi2.GetReal(c, vr, (size_t)count, values), "get");
        printf("at %d", k + 1);
        for (int i = 0; i < count; i++)
            printf(" %a", values[i]);
        printf("\n");
    }
    printf("%s\n", has_compiled_core() ? "compiled core" : "pure core");
    must(fmi2.Terminate(c), "terminate");
    fmi2.FreeInstance(c);
    free(vr);
    free(values);
    dlclose(library);
    return 0;
}
