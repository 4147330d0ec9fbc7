/* threads BINARY RESOURCES GUID THREADS INSTANCES FIRST COUNT: each thread makes instances and
 * lands them in turns, all threads at once. Prints the reals FIRST .. FIRST + COUNT - 1 of each
 * instance after 120 steps of 1 ms. */
#include "host.h"

#include <pthread.h>

enum { STEPS = 120, MOST = 64 };

static struct {
    const char *resources, *guid;
    int instances, first, count;
} job;
static pthread_barrier_t together;

static void *work(void *results)
{
    fmi2Component made[MOST];
    fmi2ValueReference vr[MOST];
    double *values = results;
    for (int i = 0; i < job.count; i++)
        vr[i] = (fmi2ValueReference)(job.first + i);
    pthread_barrier_wait(&together);
    for (int i = 0; i < job.instances; i++) {
        if (!(made[i] = instantiate("thread", job.resources, job.guid)))
            exit(1);
        initialise(made[i]);
    }
    for (int k = 0; k < STEPS; k++)
        for (int i = 0; i < job.instances; i++)
            must(fmi2.DoStep(made[i], k * 1e-3, 1e-3, fmi2True), "step");
    for (int i = 0; i < job.instances; i++) {
        must(fmi2.GetReal(made[i], vr, (size_t)job.count, values + i * job.count), "get");
        if (i % 2)
            must(fmi2.Terminate(made[i]), "terminate");
    }
    for (int i = job.instances; i--;)
        fmi2.FreeInstance(made[i]);
    return NULL;
}

int main(int argc, char **argv)
{
    if (argc != 8)
        return 2;
    load(argv[1]);
    job.resources = argv[2];
    job.guid = argv[3];
    int threads = atoi(argv[4]);
    job.instances = atoi(argv[5]);
    job.first = atoi(argv[6]);
    job.count = atoi(argv[7]);
    if (threads > MOST || job.instances > MOST || job.count > MOST)
        return 2;
    size_t each = (size_t)(job.instances * job.count);
    double *results = calloc((size_t)threads * each, sizeof *results);
    pthread_t started[MOST];
    pthread_barrier_init(&together, NULL, (unsigned)threads);
    for (int i = 0; i < threads; i++)
        pthread_create(&started[i], NULL, work, results + (size_t)i * each);
    for (int i = 0; i < threads; i++)
        pthread_join(started[i], NULL);
    for (int i = 0; i < threads * job.instances; i++) {
        for (int j = 0; j < job.count; j++)
            printf("%a ", results[i * job.count + j]);
        printf("\n");
    }
    free(results);
    return 0;
}
