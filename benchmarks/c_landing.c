/* The landing written by hand in C: the same model, the same exponential method, the same step
 * control as the core's.
 *
 * For benchmarks alone: it shows how far the compiled core is from what a C compiler makes of the
 * model. The formulas are in the order of the core's, so both take the same steps and their numbers
 * differ in the last digits only. The body is in c_planar.h, and with -DSPACE, in c_spatial.h. The
 * core documents the formulas. `c_landing.py` compiles this file with
 * -DPARAMETERS=..., the names of the model's numbers in the order in which it passes them.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifdef SPACE
enum { X, Y, Z, QW, QX, QY, QZ, VX, VY, VZ, WX, WY, WZ, BODY };
enum {
    FORCE_X, FORCE_Y, FORCE_Z, MOMENT_X, MOMENT_Y, MOMENT_Z,
    SURGE, SURGE_RATE, HEAVE, HEAVE_RATE, SWAY, SWAY_RATE,
    ROLL, ROLL_RATE, YAW, YAW_RATE, TILT, TILT_RATE, INPUTS
};
enum { MAX_GROUPS = 8 };
#else
enum { X, Y, PITCH, VX, VY, PITCH_RATE, BODY };
enum { FORCE_X, FORCE_Y, MOMENT, HEAVE, HEAVE_RATE, TILT, TILT_RATE, INPUTS };
enum { MAX_GROUPS = 4 };
#endif
enum { R, H, VR, VH, Z1, Z2, SX, SZ, LEG };
enum {
    E_ORIFICE,
    E_SEAL,
    E_STOP,
    E_AUXILIARY,
    E_CONTACT,
    E_FRICTION,
    W_EXTERNAL,
    W_GROUND,
    W_TRANSVERSE,
    INTEGRALS
};
enum { MAX_STATES = BODY + LEG * MAX_GROUPS + INTEGRALS };

#define MIN(a, b) ((a) < (b) ? (a) : (b))
#define MAX(a, b) ((a) > (b) ? (a) : (b))

typedef struct {
    double PARAMETERS;
} Parameters;

typedef struct {
    double sin, cos, count;
} Group;

/* Effect of one leg group on the body and on its own states. */
typedef struct {
    double radial, vertical, tangential, body_x, body_y, body_moment;
    double dz1, dz2, dsx, dsz, decay1, decay2;
    double orifice, seal, stop, auxiliary, contact, friction, ground;
    double mass, mass1, mass2, stroke, rate, auxiliary_stroke, held;
    double auxiliary_work, contact_work;
#ifdef SPACE
    double foot[3], bias[3], height, strut_r, strut_h, moment;
#endif
} Loads;

/* Of one leg group: decay rates of its chambers' pressure difference, the driven rates of the
 * stages, the weights of a step. */
typedef struct {
    double a1, a2, driven[5];
    double a21, a31, a32, a41, a43, b1, b23, b4;
} Stiff;

typedef struct {
    Parameters p;
    Group group[MAX_GROUPS];
    Loads loads[MAX_GROUPS];
    Stiff stiff[MAX_GROUPS];
    int groups, n;
    double rtol, t, t_old, t_input, h, error_old;
    double steps, rejected, rhs_calls;
    double start_energy, dissipated, balance, most_balance;
    int cut; /* whether slopes of the interpolant written last were cut by a part that counts */
    double u[INPUTS], u_rate[INPUTS];
#ifdef SPACE
    double turned[3], axes[3][3], turn[3][3], xx, xz, zz;
#endif
    double scale[MAX_STATES], relative[MAX_STATES];
    double y[MAX_STATES], y_new[MAX_STATES], y_stage[MAX_STATES], deviation[MAX_STATES];
    double k1[MAX_STATES], k2[MAX_STATES], k3[MAX_STATES], k4[MAX_STATES], k5[MAX_STATES];
    double dense[4][MAX_STATES];
} Landing;

typedef struct {
    double P, slope, v, dv, h;
} Fluid;

static Fluid fluid(double z, const Parameters *p)
{
    Fluid f = {.slope = 1.0};
    double base = z;
    if (z < 10.0) {
        base = 10.0;
        f.slope = exp(MAX((z - 10.0) / 10.0, -150.0));
    }
    f.P = base * f.slope;
    double a = 1.0 + p->kB * (f.P - p->Pa) / p->B0;
    double liquid = (1.0 - p->x_air) * exp(-log(a) / p->kB);
    double air = p->x_air * exp(log(p->Pa / f.P) / p->n_air);
    f.v = liquid + air;
    f.dv = -liquid * f.slope / (a * p->B0) - air / (p->n_air * base);
    f.h = p->B0 / (p->kB - 1.0) * (a * liquid - (1.0 - p->x_air)) +
          p->n_air / (p->n_air - 1.0) * (f.P * air - p->x_air * p->Pa);
    return f;
}

typedef struct {
    double V, area;
} Chamber;

static Chamber chamber(double V0, double area, double travel)
{
    double V = V0 + area * travel, past = V - 0.05 * V0;
    if (past >= 0.0)
        return (Chamber){V, area};
    double dead = 0.025 * V0, displaced = 0.05 * V0 - dead, part = exp(past / displaced);
    return (Chamber){dead + displaced * part, area * part};
}

static double seal_friction(double v, double p1, double p2, const Parameters *p)
{
    double ratio = v / p->v_str;
    double level =
        p->Fc + p->kp * 0.5 * (fabs(p1 - p->Pa) + fabs(p2 - p->Pa)) + p->Fs * exp(-ratio * ratio);
    return level * tanh(v / p->v_sm);
}

static double stop_force(double s, double v, const Parameters *p, double *power)
{
    *power = 0.0;
    if (s < 0.0) {
        double force = -p->K_stop * s * (1.0 - p->c_stop * v);
        if (force < 0.0)
            force = 0.0;
        *power = -(force + p->K_stop * s) * v;
        return -force;
    }
    if (s > p->s_max) {
        double e = s - p->s_max;
        double force = p->K_stop * e * (1.0 + p->c_stop * v);
        if (force < 0.0)
            force = 0.0;
        *power = (force - p->K_stop * e) * v;
        return force;
    }
    return 0.0;
}

/* Main strut: force, positive in compression; chambers' rates and powers go to `w`. */
static double damper(double s, double v, double z1, double z2, const Parameters *p, Loads *w)
{
    Fluid f1 = fluid(z1, p), f2 = fluid(z2, p);
    Chamber upper = chamber(p->V10, p->A1, s), lower = chamber(p->V20, p->A2, -s);
    double density1 = 1.0 / f1.v, density2 = 1.0 / f2.v, ratio = 0.5 * (density1 + density2);
    double dP = f2.P - f1.P;
    double area = (dP > 0.0 ? p->CdAo_c : p->CdAo_r) * sqrt(2.0 / (p->rho0 * ratio));
    double square = dP * dP + p->dP_lam * p->dP_lam, root = sqrt(sqrt(square));
    double Q = area * dP / root;
    double evens = area * (square - 0.5 * dP * dP) / (square * root);
    double slope = ratio * evens * MAX(f1.slope, f2.slope);
    double stiffness1 = -f1.v / f1.dv / upper.V;
    double stiffness2 = -f2.v / f2.dv / lower.V;
    double seal = seal_friction(v, f1.P, f2.P, p);
    double stop = stop_force(s, v, p, &w->stop);
    double m1 = upper.V * density1, m2 = lower.V * density2;
    w->dz1 = stiffness1 * (ratio * f1.v * Q - upper.area * v);
    w->dz2 = stiffness2 * (lower.area * v - ratio * f2.v * Q);
    w->decay1 = stiffness1 * f1.v * slope;
    w->decay2 = stiffness2 * f2.v * slope;
    w->orifice = ratio * Q * (f2.h - f1.h);
    w->seal = seal * v;
    w->mass = p->rho0 * (m1 + m2);
    w->mass1 = -p->rho0 * m1 * density1 * f1.dv;
    w->mass2 = -p->rho0 * m2 * density2 * f2.dv;
    w->stroke = s;
    w->rate = v;
    w->held = upper.V * (f1.h * density1 - (f1.P - p->Pa)) +
              lower.V * (f2.h * density2 - (f2.P - p->Pa));
    return (f2.P - p->Pa) * lower.area - (f1.P - p->Pa) * upper.area + seal + stop;
}

/* Elongation of the spring where the joint has moved `x` past an end of its play; its slope. */
static double bearing(double x, const Parameters *p, double *slope)
{
    double eps = 0.03 * (p->g_t + p->g_c), root = sqrt(x * x + eps * eps);
    double u = x > 0.0 ? 0.5 * (x + root) : 0.5 * eps * eps / (root - x);
    *slope = u / root;
    return u;
}

static double auxiliary(double s, double v, const Parameters *p, Loads *w)
{
    if (p->g_t + p->g_c > 0.0) {
        double slope_t, slope_c;
        double u_t = bearing(-s - p->g_t, p, &slope_t), u_c = bearing(s - p->g_c, p, &slope_c);
        double pushes = pow(u_c, p->ek), pulls = pow(u_t, p->ek);
        double spring = p->Ka * (pushes * slope_c - pulls * slope_t) - p->F_0;
        double bears = MIN(1.0, slope_t + slope_c);
        double damping = p->Ca * (p->c_play + (1.0 - p->c_play) * bears);
        w->auxiliary = damping * v * v;
        w->auxiliary_work = p->Ka * (pushes * u_c + pulls * u_t);
        return spring + p->k_play * s + damping * v;
    }
    double spring = p->Ka * pow(fabs(s), p->ek);
    w->auxiliary_work = spring * fabs(s);
    if (s < 0.0)
        spring = -spring;
    w->auxiliary = p->Ca * v * v;
    return spring + p->Ca * v;
}

static double damping_ramp(double d, const Parameters *p)
{
    double q = d / p->d_ramp;
    if (q >= 1.0)
        return 1.0;
    if (q <= 0.0)
        return 0.0;
    return q * q * (3.0 - 2.0 * q);
}

/* Friction on a footpad: the displacement's rates and the lost power go to `w`, forces to `F`. */
static void friction(double d, double Fn, double v1, double v2, const double *s,
                     const Parameters *p, Loads *w, double *F)
{
    double square = s[0] * s[0] + s[1] * s[1], size = sqrt(square);
    F[0] = F[1] = 0.0;
    if (d <= 0.0) {
        w->dsx = -s[0] / p->tau_sr;
        w->dsz = -s[1] / p->tau_sr;
        w->friction = p->K_t * square / p->tau_sr;
        return;
    }
    double limit = p->mu * Fn * (1.0 + p->ar * exp(-sqrt(v1 * v1 + v2 * v2) / p->b_strib)) / p->K_t;
    if (size < limit) {
        double part = size / limit, damping = p->Cr * damping_ramp(d, p) * (1.0 - part * part);
        F[0] = -p->K_t * s[0] - damping * v1;
        F[1] = -p->K_t * s[1] - damping * v2;
        w->dsx = v1;
        w->dsz = v2;
        w->friction = damping * (v1 * v1 + v2 * v2);
        return;
    }
    w->dsx = w->dsz = w->friction = 0.0;
    if (size <= 0.0) return;
    double n1 = s[0] / size, n2 = s[1] / size, vn = v1 * n1 + v2 * n2, past = size - limit;
    double back = past > p->zone ? (past - p->zone) / p->tau_sr : 0.0;
    w->friction = p->K_t * size * back;
    if (vn > 0.0) {
        double q = past / p->zone, share = q >= 1.0 ? 1.0 : q <= 0.0 ? 0.0 : q * q * (3.0 - 2.0 * q);
        w->friction += p->K_t * limit * vn * share;
        back += vn * (1.0 - (1.0 - share) * limit / size);
    } else {
        w->friction -= p->K_t * past * vn;
    }
    double force = p->K_t * limit;
    F[0] = -force * n1;
    F[1] = -force * n2;
    w->dsx = v1 - n1 * back;
    w->dsz = v2 - n2 * back;
}

typedef struct {
    double stroke, rate, er, eh;
} Strut;

static Strut strut(double dr, double dh, double vr, double vh, double length)
{
    double now = sqrt(dr * dr + dh * dh), er = dr / now, eh = dh / now;
    return (Strut){length - now, -(vr * er + vh * eh), er, eh};
}

/* Energy that a leg's springs hold beside its liquid. */
static double springs(const double *q, const Loads *w, const Parameters *p)
{
    double s = w->auxiliary_stroke, held = w->auxiliary_work / (p->ek + 1.0);
    if (p->g_t + p->g_c > 0.0)
        held = MAX(0.0, held - p->U_0 - p->F_0 * s) + 0.5 * p->k_play * s * s;
    double past = w->stroke < 0.0 ? w->stroke : MAX(w->stroke - p->s_max, 0.0);
    held += 0.5 * p->K_stop * past * past;
    held += w->contact_work / (p->en + 1.0);
    return held + 0.5 * p->K_t * (q[SX] * q[SX] + q[SZ] * q[SZ]);
}

/* The body: its legs' loads, the right-hand side, and the energy. */
#ifdef SPACE
#include "c_spatial.h"
#else
#include "c_planar.h"
#endif

static double phi1(double z)
{
    return z > 0.0 ? -expm1(-z) / z : 1.0;
}

static double phi2(double z, double f1)
{
    if (z > 0.1)
        return (1.0 - f1) / z;
    double tail = 1.0 / 720.0 -
                  z * (1.0 / 5040.0 - z * (1.0 / 40320.0 - z * (1.0 / 362880.0 - z / 3628800.0)));
    return 0.5 - z * (1.0 / 6.0 - z * (1.0 / 24.0 - z * (1.0 / 120.0 - z * tail)));
}

static double phi3(double z, double f2)
{
    if (z > 0.1)
        return (0.5 - f2) / z;
    double tail =
        1.0 / 5040.0 -
        z * (1.0 / 40320.0 - z * (1.0 / 362880.0 - z * (1.0 / 3628800.0 - z / 39916800.0)));
    return 1.0 / 6.0 - z * (1.0 / 24.0 - z * (1.0 / 120.0 - z * (1.0 / 720.0 - z * tail)));
}

static void freeze_linear_part(Landing *s)
{
    for (int g = 0; g < s->groups; g++) {
        const double *k = s->k1 + BODY + LEG * g;
        s->stiff[g].a1 = s->loads[g].decay1;
        s->stiff[g].a2 = s->loads[g].decay2;
        s->stiff[g].driven[0] = k[Z2] - k[Z1];
    }
}

static void phi_weights(Stiff *c, double h)
{
    double z = h * (c->a1 + c->a2), f1 = phi1(0.5 * z), f2 = phi2(0.5 * z, f1), f3;
    c->a21 = 0.5 * f1;
    c->a31 = 0.5 * f1 - f2;
    c->a32 = f2;
    f1 = phi1(z);
    f2 = phi2(z, f1);
    f3 = phi3(z, f2);
    c->a41 = f1 - 2.0 * f2;
    c->a43 = 2.0 * f2;
    c->b1 = f1 - 3.0 * f2 + 4.0 * f3;
    c->b23 = 2.0 * f2 - 4.0 * f3;
    c->b4 = 4.0 * f3 - f2;
}

/* The right-hand side at a stage, and of it the driven rate of each leg's Z2 - Z1. */
static void nonlinear_rate(Landing *s, double t, int number, const double *state, double *k)
{
    slope(s, t, state, k);
    for (int g = 0; g < s->groups; g++) {
        int j = BODY + LEG * g;
        Stiff *c = &s->stiff[g];
        double growth = state[j + Z2] - state[j + Z1] - (s->y[j + Z2] - s->y[j + Z1]);
        c->driven[number] = k[j + Z2] - k[j + Z1] + (c->a1 + c->a2) * growth;
    }
}

static void replace_linear_growth(const Stiff *c, double *q, double growth, double plain)
{
    double shift = (plain - growth) / (c->a1 + c->a2);
    q[Z1] += c->a1 * shift;
    q[Z2] -= c->a2 * shift;
}

static void try_step(Landing *s, double h)
{
    int n = s->n, m = n - INTEGRALS, groups = s->groups;
    double t = s->t, half = 0.5 * h;
    double *restrict y = s->y, *restrict z = s->y_stage, *restrict e = s->deviation,
                     *restrict end = s->y_new;
    double *restrict k1 = s->k1, *restrict k2 = s->k2, *restrict k3 = s->k3, *restrict k4 = s->k4,
                     *restrict k5 = s->k5;
    for (int g = 0; g < groups; g++)
        phi_weights(&s->stiff[g], h);

    for (int i = 0; i < m; i++)
        z[i] = y[i] + half * k1[i];
    for (int g = 0, j = BODY; g < groups; g++, j += LEG) {
        const Stiff *c = &s->stiff[g];
        replace_linear_growth(c, z + j, h * (c->a21 * c->driven[0]),
                              half * (k1[j + Z2] - k1[j + Z1]));
    }
    nonlinear_rate(s, t + half, 1, z, k2);
    for (int i = 0; i < m; i++)
        z[i] = y[i] + half * k2[i];
    for (int g = 0, j = BODY; g < groups; g++, j += LEG) {
        const Stiff *c = &s->stiff[g];
        replace_linear_growth(c, z + j, h * (c->a31 * c->driven[0] + c->a32 * c->driven[1]),
                              half * (k2[j + Z2] - k2[j + Z1]));
    }
    nonlinear_rate(s, t + half, 2, z, k3);
    for (int i = 0; i < m; i++)
        z[i] = y[i] + h * k3[i];
    for (int g = 0, j = BODY; g < groups; g++, j += LEG) {
        const Stiff *c = &s->stiff[g];
        replace_linear_growth(c, z + j, h * (c->a41 * c->driven[0] + c->a43 * c->driven[2]),
                              h * (k3[j + Z2] - k3[j + Z1]));
    }
    nonlinear_rate(s, t + h, 3, z, k4);
    for (int i = 0; i < n; i++)
        end[i] = y[i] + h * (1.0 / 6.0 * (k1[i] + k4[i]) + 1.0 / 3.0 * (k2[i] + k3[i]));
    for (int g = 0, j = BODY; g < groups; g++, j += LEG) {
        const Stiff *c = &s->stiff[g];
        double growth = h * (c->b1 * c->driven[0] + c->b23 * (c->driven[1] + c->driven[2]) +
                             c->b4 * c->driven[3]);
        replace_linear_growth(c, end + j, growth,
                              (end[j + Z2] - end[j + Z1]) - (y[j + Z2] - y[j + Z1]));
    }
#ifdef SPACE
    normalise(end);
#endif
    nonlinear_rate(s, t + h, 4, end, k5);
    for (int i = 0; i < m; i++)
        e[i] = h * (1.0 / 6.0) * (k4[i] - k5[i]);
    for (int g = 0, j = BODY; g < groups; g++, j += LEG) {
        const Stiff *c = &s->stiff[g];
        replace_linear_growth(c, e + j, h * c->b4 * (c->driven[3] - c->driven[4]),
                              e[j + Z2] - e[j + Z1]);
    }
    for (int i = 0; i < m; i++)
        if (s->relative[i] == 0.0)
            e[i] = fabs(e[i]) + 0.3 * h * (1.0 / 6.0) * fabs(k1[i] - k2[i] - k3[i] + k4[i]);
}

static double error(const Landing *s)
{
    double total = 0.0;
    int m = s->n - INTEGRALS;
    for (int i = 0; i < m; i++) {
        double limit = s->rtol * s->scale[i];
        if (s->relative[i] > 0.0) {
            const Loads *w = &s->loads[(i - BODY) / LEG];
            double slope = (i - BODY) % LEG == Z1 ? w->mass1 : w->mass2;
            limit = s->rtol * (s->scale[i] + MAX(fabs(s->y[i]), fabs(s->y_new[i])));
            limit = MIN(limit, 1e-4 * w->mass / slope);
        }
        double e = s->deviation[i] / limit;
        total += e * e;
    }
    return sqrt(total / m);
}

/* Move both chambers' states alike until 7.99e-7 parts of the leg's excess of liquid are left. */
static void take_off_excess(double *q, const Loads *found, const Parameters *p)
{
    Loads w = *found;
    double z1 = q[Z1], z2 = q[Z2], moved = 0.0, low = -1e15, high = 1e15, reach = 1e3;
    double aim = p->fill * (w.mass > p->fill ? 1.0 + 7.99e-7 : 1.0 - 7.99e-7);
    for (int k = 0; k < 60; k++) {
        double excess = w.mass - aim;
        if (excess > 0.0)
            high = moved;
        else
            low = moved;
        double newton = moved - excess / (w.mass1 + w.mass2);
        double tried = MIN(MAX(newton, moved - reach), moved + reach);
        if (fabs(excess) < 1e-12 * p->fill || tried == moved)
            break;
        if (tried <= low || tried >= high)
            tried = 0.5 * (low + high);
        moved = tried;
        reach *= 2.0;
        damper(found->stroke, found->rate, z1 + moved, z2 + moved, p, &w);
    }
    q[Z1] = z1 + moved;
    q[Z2] = z2 + moved;
}

/* Growth of the energy balance within `h`, in parts of what may be. */
static double lost(const Landing *s, double balance, double h)
{
    const Parameters *p = &s->p;
    double was = fabs(s->balance), legs = 0.0;
    for (int i = 0; i < s->groups; i++)
        legs += s->group[i].count;
    double rounding = 4e-15 * legs * p->B0 * (p->V10 + p->V20);
    double growth = fabs(balance) - MIN(MAX(MAX(was, rounding), s->most_balance), was + rounding);
    if (growth <= 0.0)
        return 0.0;
    double turned = MAX(0.1 * s->scale[s->n - 1], s->dissipated);
    double most = 4e-5 * turned + rounding;
    return growth / (0.25 * MAX(most - was, 0.0) + 2e-5 * h * turned);
}

/* Bring a state where the right-hand side was worked out last back to the liquid's mass, at time
 * `t`; how far it was away, in parts of what a step may be. */
static double conserve(Landing *s, double t, double *y, double *dy)
{
    double farthest = 0.0;
    for (int g = 0; g < s->groups; g++) {
        double excess = fabs(s->loads[g].mass / s->p.fill - 1.0);
        if (excess > 8e-7) {
            take_off_excess(y + BODY + LEG * g, &s->loads[g], &s->p);
            farthest = MAX(farthest, excess);
        }
    }
    if (farthest > 0.0)
        slope(s, t, y, dy);
    return farthest / 1e-5;
}

/* Write the interpolant of the step just computed. What is dissipated rises throughout. */
static void write_dense(Landing *s, double h)
{
    int first = s->n - INTEGRALS;
    s->cut = 0;
    for (int i = 0; i < s->n; i++) {
        double change = s->y_new[i] - s->y[i], early = h * s->k1[i], late = h * s->k5[i];
        s->dense[0][i] = s->y[i];
        s->dense[1][i] = change;
        s->dense[2][i] = early - change;
        s->dense[3][i] = change - late - s->dense[2][i];
        if (i < first || i > first + E_FRICTION)
            continue;
        double low = MIN(MAX(early, 0.0), 3.0 * change), high = MIN(MAX(late, 0.0), 3.0 * change);
        if (low != early || high != late) {
            if (fabs(low - early) + fabs(high - late) > 1e-8 * s->scale[i])
                s->cut = 1;
            s->dense[2][i] = low - change;
            s->dense[3][i] = 2.0 * change - high - low;
        }
    }
}

/* Whether the interpolant of the step just computed leaves its ends far behind at a quarter. */
static int bulges(const Landing *s)
{
    for (int i = 0; i < s->n; i++) {
        if (s->relative[i] == 0.0)
            continue;
        double change = s->dense[1][i], bend = s->dense[2][i], last = s->dense[3][i];
        double out = 0.1875 * MAX(fabs(bend + 0.25 * last), fabs(bend + 0.75 * last));
        if (out > fabs(change) + 0.002 * (fabs(s->y[i]) + fabs(s->y_new[i])))
            return 1;
    }
    return 0;
}

/* The state at a part of the step just computed. */
static void inside(const Landing *s, double part, double *y)
{
    double rest = 1.0 - part;
    for (int i = 0; i < s->n; i++)
        y[i] = s->dense[0][i] +
               part * (s->dense[1][i] + rest * (s->dense[2][i] + part * s->dense[3][i]));
}

/* What is lost at the quarters of a step, on its interpolant, where it bulges, its slopes were cut,
 * or the tolerance is loose. */
static double lost_inside(Landing *s, double h)
{
    double most = 0.0, *y = s->y_stage, dissipated, dy[MAX_STATES];
    if (s->rtol <= 1e-4 && !s->cut && !bulges(s))
        return 0.0;
    for (double part = 0.25; part < 1.0; part += 0.25) {
        inside(s, part, y);
        slope(s, s->t + part * h, y, dy);
        conserve(s, s->t + part * h, y, dy);
        most = MAX(most, lost(s, energy(s, y, &dissipated) - s->start_energy, part * h));
    }
    slope(s, s->t + h, s->y_new, s->k5);
    return most;
}

/* What the step just computed has lost before it is brought back or by that, in units of what it may
 * lose. */
static double judged(Landing *s, double h, double *balance, double *dissipated)
{
    for (int i = s->n - INTEGRALS; i <= s->n - INTEGRALS + E_FRICTION; i++)
        s->y_new[i] = MAX(s->y_new[i], s->y[i]);
    *balance = energy(s, s->y_new, dissipated) - s->start_energy;
    double most = lost(s, *balance, h), away = conserve(s, s->t + h, s->y_new, s->k5);
    if (away > 0.0) {
        *balance = energy(s, s->y_new, dissipated) - s->start_energy;
        most = MAX(most, lost(s, *balance, h));
    }
    write_dense(s, h);
    if (h < 1e-10)
        return 0.0;
    most = MAX(most, away);
    return most <= 1.0 ? lost_inside(s, h) : most;
}

static void accept(Landing *s, double h)
{
    int n = s->n;
    for (int i = 0; i < n; i++) {
        s->y[i] = s->y_new[i];
        s->k1[i] = s->k5[i];
    }
    s->t_old = s->t;
    s->t += h;
    s->steps += 1.0;
    freeze_linear_part(s);
}

/* A landing from the state `y` at time 0, under inputs `u` that go on at `u_rate`, until `release`.
 * NULL without memory. */
Landing *landing(const double *parameters, int groups, const double *group, const double *y,
                 const double *scale, const double *relative, double rtol, const double *u,
                 const double *u_rate)
{
    Landing *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    s->groups = groups;
    s->n = BODY + LEG * groups + INTEGRALS;
    size_t size = (size_t)s->n * sizeof(double);
    memcpy(&s->p, parameters, sizeof s->p);
    memcpy(s->group, group, (size_t)groups * sizeof *s->group);
    memcpy(s->y, y, size);
    memcpy(s->dense[0], y, size);
    memcpy(s->scale, scale, size);
    memcpy(s->relative, relative, size);
    memcpy(s->u, u, sizeof s->u);
    memcpy(s->u_rate, u_rate, sizeof s->u_rate);
#ifdef SPACE
    prepare(s);
#endif
    s->rtol = rtol;
    s->h = 1e-5;
    s->error_old = 1e-4;
    slope(s, 0.0, s->y, s->k1);
    s->start_energy = energy(s, s->y, &s->dissipated);
    freeze_linear_part(s);
    return s;
}

/* Steps until `t_end` is reached; 0 if the step size has collapsed. */
int advance(Landing *s, double t_end)
{
    const double exponent = 0.25 - 0.75 * 0.04;
    while (s->t < t_end) {
        double h = s->h;
        if (h < 1e-16)
            return 0;
        try_step(s, h);
        double e = error(s), balance = 0.0, dissipated = 0.0;
        if (e <= 1.0 && judged(s, h, &balance, &dissipated) > 1.0) {
            s->rejected += 1.0;
            s->h = 0.5 * h;
        } else if (e <= 1.0) {
            accept(s, h);
            s->balance = balance;
            s->most_balance = MAX(s->most_balance, fabs(balance));
            s->dissipated = dissipated;
            e = MAX(e, 1e-10);
            double factor = 0.9 * pow(s->error_old, 0.04) / pow(e, exponent);
            s->h = h * MIN(MAX(factor, 0.2), 5.0);
            s->h = MIN(s->h, 2e-3);
            s->error_old = MAX(e, 1e-4);
        } else {
            s->rejected += 1.0;
            s->h = h * (e < 1e10 ? MAX(0.9 / pow(e, exponent), 0.2) : 0.2);
        }
    }
    return 1;
}

/* The state at time `t` inside the last step. */
void interpolate(const Landing *s, double t, double *y)
{
    double span = s->t - s->t_old;
    inside(s, span > 0.0 ? (t - s->t_old) / span : 0.0, y);
}

/* The right-hand side for CVODE, on vectors without the energy integrals; `array` is its
 * N_VGetArrayPointer. */
typedef struct {
    Landing *landing;
    double *(*array)(void *vector);
} Bridge;

int slope_for_cvode(double t, void *y, void *dy, void *bridge)
{
    Bridge *b = bridge;
    double all[MAX_STATES];
    slope(b->landing, t, b->array(y), all);
    memcpy(b->array(dy), all, (size_t)(b->landing->n - INTEGRALS) * sizeof *all);
    return 0;
}

/* Steps, rejected steps, right-hand sides. */
void counts(const Landing *s, double *three)
{
    three[0] = s->steps;
    three[1] = s->rejected;
    three[2] = s->rhs_calls;
}

void release(Landing *s)
{
    free(s);
}
