/* floats BINARY RESOURCES GUID INPUT OUTPUT [sse]: a host whose floating-point operations trap, round upward
 * and flush small numbers to 0. It sets INPUT to NaN, prints the status of the step that follows,
 * sets it to 0, lands for 0.2 s, and prints OUTPUT and whether its own settings are as before.
 * With sse they are those of the SSE alone, as many compilers' options set them. */
#define _GNU_SOURCE
#include "host.h"

#include <fenv.h>
#include <math.h>

#ifdef __x86_64__
#include <xmmintrin.h>
enum { FLUSH = 0x8040, EXCEPTIONS = 0x3f, UPWARD = 0x4000, TRAPPED = 0x680 };
static void flush(void)
{
    _mm_setcsr(_mm_getcsr() | FLUSH);
}
static void trap_sse(void)
{
    _mm_setcsr((_mm_getcsr() | UPWARD) & ~(unsigned)TRAPPED);
}
static unsigned settings(void)
{
    return _mm_getcsr() & ~(unsigned)EXCEPTIONS;
}
#else
static void flush(void)
{
}
static void trap_sse(void)
{
}
static unsigned settings(void)
{
    return (unsigned)fegetround();
}
#endif

int main(int argc, char **argv)
{
    if (argc != 6 && argc != 7)
        return 2;
    load(argv[1]);
    flush();
    if (argc == 7) {
        trap_sse();
    } else {
        fesetround(FE_UPWARD);
        feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    }
    const unsigned before = settings();
    fmi2Component c = instantiate("floats", argv[2], argv[3]);
    if (!c)
        return 1;
    initialise(c);
    const fmi2ValueReference input = (unsigned)atoi(argv[4]), output = (unsigned)atoi(argv[5]);
    fmi2Real value = NAN;
    must(fmi2.SetReal(c, &input, 1, &value), "set");
    printf("%d\n", fmi2.DoStep(c, 0.0, 1e-3, fmi2True));
    value = 0.0;
    must(fmi2.SetReal(c, &input, 1, &value), "set");
    printf("%d\n", fmi2.DoStep(c, NAN, 1e-3, fmi2True));
    for (int k = 0; k < 200; k++)
        must(fmi2.DoStep(c, k / 1000.0, 1.0 / 1000.0, fmi2True), "step");
    must(fmi2.GetReal(c, &output, 1, &value), "get");
    fmi2.FreeInstance(c);
    const int kept = settings() == before;
    fedisableexcept(FE_ALL_EXCEPT);
    fesetround(FE_TONEAREST);
    printf("%a %d\n", value, kept);
    return 0;
}
