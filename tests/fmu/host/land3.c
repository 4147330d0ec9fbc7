/* land3 BINARY RESOURCES TOKEN THREADS INSTANCES REFERENCE: lands INSTANCES of FMI 3.0 in each of so many
 * THREADS, all at once, for 0.4 s in steps of 1 ms that end early at events; every second one through
 * a serialised state into another instance. Prints for each the events, and the four elements of the
 * array with the value REFERENCE. */
#include "host3.h"

#include <pthread.h>

enum { STEPS = 400, MOST = 16, LEGS = 4 };

static struct {
    const char *resources, *token;
    int instances;
    fmi3ValueReference reference;
} job;

struct landing {
    double values[LEGS];
    int events;
};

/* Another instance in the state of `c`, which is freed. */
static fmi3Instance moved(fmi3Instance c)
{
    fmi3Instance other = instantiate(job.resources, job.token, true);
    fmi3FMUState state = NULL, copy = NULL;
    size_t size;
    must(fmi3.GetFMUState(c, &state), "get state");
    must(fmi3.SerializedFMUStateSize(c, state, &size), "size");
    fmi3Byte *bytes = malloc(size);
    must(fmi3.SerializeFMUState(c, state, bytes, size), "serialise");
    must(fmi3.FreeFMUState(c, &state), "free state");
    fmi3.FreeInstance(c);
    must(fmi3.DeserializeFMUState(other, bytes, size, &copy), "deserialise");
    must(fmi3.SetFMUState(other, copy), "set state");
    must(fmi3.FreeFMUState(other, &copy), "free state");
    free(bytes);
    return other;
}

static void *work(void *results)
{
    fmi3Instance made[MOST];
    struct landing *landings = results;
    for (int i = 0; i < job.instances; i++) {
        made[i] = instantiate(job.resources, job.token, true);
        initialise(made[i]);
        leave_event_mode(made[i]);
    }
    for (int k = 0; k < STEPS; k++)
        for (int i = 0; i < job.instances; i++) {
            if (k == STEPS / 2 && i % 2)
                made[i] = moved(made[i]);
            double goal = (k + 1) * 1e-3;
            for (double time = k * 1e-3; time < goal;)
                time = step(made[i], time, goal, &landings[i].events);
        }
    for (int i = job.instances; i--;) {
        must(fmi3.GetFloat64(made[i], &job.reference, 1, landings[i].values, LEGS), "get");
        must(fmi3.Terminate(made[i]), "terminate");
        fmi3.FreeInstance(made[i]);
    }
    return NULL;
}

int main(int argc, char **argv)
{
    if (argc != 7)
        return 2;
    load(argv[1]);
    job.resources = argv[2];
    job.token = argv[3];
    int threads = atoi(argv[4]);
    job.instances = atoi(argv[5]);
    job.reference = (fmi3ValueReference)atoi(argv[6]);
    if (threads > MOST || job.instances > MOST)
        return 2;
    static struct landing results[MOST][MOST];
    pthread_t started[MOST];
    for (int i = 0; i < threads; i++)
        pthread_create(&started[i], NULL, work, results[i]);
    for (int i = 0; i < threads; i++)
        pthread_join(started[i], NULL);
    for (int i = 0; i < threads; i++)
        for (int j = 0; j < job.instances; j++) {
            printf("%d", results[i][j].events);
            for (int leg = 0; leg < LEGS; leg++)
                printf(" %a", results[i][j].values[leg]);
            printf("\n");
        }
    return 0;
}
