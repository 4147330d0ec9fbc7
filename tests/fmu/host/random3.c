/* random3 BINARY RESOURCES TOKEN SEED CALLS TIME: makes so many CALLS of FMI 3.0 at random, in any order
 * and with arguments of all kinds, on three instances; TIME is the value reference of `time`. Then
 * resets one and lands it. Prints how many calls had each status. */
#include "host3.h"

#include <math.h>

enum { INSTANCES = 3 };

static unsigned long long seed;
static fmi3Instance made[INSTANCES];
static fmi3FMUState states[INSTANCES + 1]; /* the last stays NULL */
static const char *resources, *token;
static unsigned time_reference;

static unsigned below(unsigned n)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (unsigned)(seed >> 33) % n;
}

static double number(void)
{
    static const double odd[] = {0.0, -1.0, 1e-3, 5e-3, NAN, INFINITY, 1e300, 1e-300, 0.3};
    return odd[below(sizeof odd / sizeof *odd)];
}

static fmi3ValueReference reference(void)
{
    return below(4) ? below(time_reference + 1) : below(2) ? time_reference + 1 : 4294967295u;
}

static void update(fmi3InstanceEnvironment environment, double time, bool set, bool get,
                   bool finished, bool can_return, bool *early, double *early_time)
{
    (void)set, (void)get, (void)finished, (void)can_return;
    fmi3ValueReference vr = reference();
    double value = number();
    fmi3.SetFloat64(*(fmi3Instance *)environment, &vr, 1, &value, 1);
    fmi3.Terminate(*(fmi3Instance *)environment);
    fmi3.FreeInstance(*(fmi3Instance *)environment);
    *early = below(2);
    *early_time = time + number();
}

static void make(int i)
{
    made[i] = fmi3.InstantiateCoSimulation("random", token, resources, false, false, below(2),
                                           below(2), NULL, 0, &made[i], NULL,
                                           below(2) ? update : NULL);
    if (!made[i])
        exit(1);
}

static fmi3Status call(int i)
{
    fmi3Instance c = below(20) ? made[i] : NULL;
    fmi3ValueReference vr[] = {reference(), reference()};
    size_t n = below(3), n_values = n + (below(3) ? 0 : below(8));
    double values[16];
    int32_t integers[16], orders[] = {1, 1};
    bool flags[16], event, ends, early, again, nominals;
    const char *texts[16] = {"2-2", "1-2-1"};
    fmi3Byte bytes[64] = {0};
    size_t size = sizeof bytes;
    static double time;
    for (int k = 0; k < 16; k++)
        values[k] = number();
    switch (below(22)) {
    case 0: return fmi3.EnterInitializationMode(c, below(2), number(), number(), below(2), 1.0);
    case 1:
    case 2: return fmi3.ExitInitializationMode(c);
    case 3: return fmi3.EnterEventMode(c);
    case 4:
        return fmi3.UpdateDiscreteStates(c, &again, below(9) ? &ends : NULL, &nominals, &event,
                                         &early, values);
    case 5:
    case 6: return fmi3.EnterStepMode(c);
    case 7: return below(4) ? fmi3OK : fmi3.Terminate(c);
    case 8: time = 0.0; return below(2) ? fmi3OK : fmi3.Reset(c);
    case 9: return fmi3.GetFloat64(c, vr, n, values, n_values);
    case 10: return fmi3.SetFloat64(c, vr, n, values, n_values);
    case 11: return fmi3.GetInt32(c, vr, n, integers, n_values);
    case 12: return fmi3.GetBoolean(c, vr, n, flags, n_values);
    case 13: return fmi3.GetString(c, vr, n, texts, n_values);
    case 14: return fmi3.SetString(c, vr, n, texts, n_values);
    case 15: return fmi3.GetFMUState(c, &states[i]);
    case 16: return fmi3.SetFMUState(c, states[below(INSTANCES + 1)]);
    case 17: return fmi3.FreeFMUState(c, &states[i]);
    case 18: return fmi3.SerializeFMUState(c, states[i], bytes, size);
    case 19: return fmi3.DeserializeFMUState(c, bytes, size, &states[INSTANCES]);
    case 20: return fmi3.GetOutputDerivatives(c, vr, n, orders, values, n_values);
    default:
        return fmi3.DoStep(c, below(4) ? time : number(), below(2) ? 5e-3 : number(), true, &event,
                           &ends, &early, &time);
    }
}

int main(int argc, char **argv)
{
    if (argc != 7)
        return 2;
    freopen("/dev/null", "w", stderr); /* errors that no callback takes */
    load(argv[1]);
    resources = argv[2];
    token = argv[3];
    seed = strtoull(argv[4], NULL, 10);
    time_reference = (unsigned)atoi(argv[6]);
    int counts[5] = {0}, calls = atoi(argv[5]), events = 0;
    for (int i = 0; i < INSTANCES; i++)
        make(i);
    for (int k = 0; k < calls; k++) {
        int i = (int)below(INSTANCES);
        counts[call(i)]++;
        if (below(100) == 0) {
            fmi3.FreeInstance(made[i]);
            states[i] = NULL;
            make(i);
        }
    }
    printf("%d %d %d %d %d\n", counts[0], counts[1], counts[2], counts[3], counts[4]);
    for (int i = 0; i < INSTANCES; i++)
        fmi3.FreeInstance(made[i]);
    fmi3Instance last = instantiate(resources, token, true);
    initialise(last);
    leave_event_mode(last);
    for (double time = 0.0; time < 0.1;)
        time = step(last, time, 0.1, &events);
    printf("%d events\n", events);
    fmi3.FreeInstance(last);
    return 0;
}
