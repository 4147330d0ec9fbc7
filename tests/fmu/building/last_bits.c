/* The mathematical functions that the compiled core calls, each result off by its last bit, up or
 * down in turn. For LD_PRELOAD. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <math.h>

static double off(double value)
{
    static unsigned calls;
    return isfinite(value) && value != 0.0 ? nextafter(value, calls++ & 1 ? HUGE_VAL : -HUGE_VAL)
                                           : value;
}

#define ONE(name) \
    double name(double x) \
    { \
        double (*found)(double); \
        *(void **)&found = dlsym(RTLD_NEXT, #name); \
        return off(found(x)); \
    }
#define TWO(name) \
    double name(double x, double y) \
    { \
        double (*found)(double, double); \
        *(void **)&found = dlsym(RTLD_NEXT, #name); \
        return off(found(x, y)); \
    }

ONE(asin)
ONE(exp)
ONE(expm1)
ONE(log)
ONE(tanh)
TWO(atan2)
TWO(pow)

void sincos(double x, double *sine, double *cosine)
{
    void (*found)(double, double *, double *);
    *(void **)&found = dlsym(RTLD_NEXT, "sincos");
    found(x, sine, cosine);
    *sine = off(*sine);
    *cosine = off(*cosine);
}
