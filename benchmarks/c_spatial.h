/* The body in space: part of c_landing.c, which says what it is for. */

typedef struct {
    double x, y, z;
} Vector;

static inline double dot(Vector a, Vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline Vector cross(Vector a, Vector b)
{
    return (Vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline Vector sum(Vector a, double part, Vector b)
{
    return (Vector){a.x + part * b.x, a.y + part * b.y, a.z + part * b.z};
}

static inline Vector scaled(Vector a, double part)
{
    return (Vector){a.x * part, a.y * part, a.z * part};
}

/* `m` has body axes, or those of the ground, as rows. */
static inline Vector to_body(const double m[3][3], Vector v)
{
    return (Vector){m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
                    m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
                    m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

static inline Vector to_inertial(const double m[3][3], Vector v)
{
    return (Vector){m[0][0] * v.x + m[1][0] * v.y + m[2][0] * v.z,
                    m[0][1] * v.x + m[1][1] * v.y + m[2][1] * v.z,
                    m[0][2] * v.x + m[1][2] * v.y + m[2][2] * v.z};
}

static void turn_body(Landing *s, const double *y)
{
    double w = y[QW], a = y[QX], b = y[QY], c = y[QZ], k = 2.0 / (w * w + a * a + b * b + c * c);
    double rows[3][3] = {{1.0 - k * (b * b + c * c), k * (a * b + w * c), k * (a * c - w * b)},
                         {k * (a * b - w * c), 1.0 - k * (a * a + c * c), k * (b * c + w * a)},
                         {k * (a * c + w * b), k * (b * c - w * a), 1.0 - k * (a * a + b * b)}};
    memcpy(s->turn, rows, sizeof rows);
}

static Vector on_deck(Vector v, const double *u)
{
    double x = cos(u[YAW]) * v.x + sin(u[YAW]) * v.z, a = cos(u[YAW]) * v.z - sin(u[YAW]) * v.x;
    double y = cos(u[ROLL]) * v.y - sin(u[ROLL]) * a, z = sin(u[ROLL]) * v.y + cos(u[ROLL]) * a;
    return (Vector){cos(u[TILT]) * x + sin(u[TILT]) * y, cos(u[TILT]) * y - sin(u[TILT]) * x, z};
}

/* The ground's axis 1, normal and axis 2; they are kept while the deck does not turn. */
static void turn_ground(Landing *s, const double *u)
{
    const Parameters *p = &s->p;
    if (s->turned[0] == u[ROLL] && s->turned[1] == u[YAW] && s->turned[2] == u[TILT])
        return;
    Vector rows[3] = {on_deck((Vector){p->down_x, p->down_y, p->down_z}, u),
                      on_deck((Vector){p->normal_x, p->normal_y, p->normal_z}, u),
                      on_deck((Vector){p->along_x, 0.0, p->along_z}, u)};
    memcpy(s->axes, rows, sizeof rows);
    s->turned[0] = u[ROLL];
    s->turned[1] = u[YAW];
    s->turned[2] = u[TILT];
}

static Vector deck_spin(const double *u)
{
    double y = cos(u[ROLL]) * u[YAW_RATE], z = sin(u[ROLL]) * u[YAW_RATE];
    return (Vector){cos(u[TILT]) * u[ROLL_RATE] + sin(u[TILT]) * y,
                    cos(u[TILT]) * y - sin(u[TILT]) * u[ROLL_RATE], z - u[TILT_RATE]};
}

static void leg_loads(const Landing *s, const double *y, const double *q, const Group *g,
                      const double *u, Vector rolling, Loads *w)
{
    const Parameters *p = &s->p;
    double r = q[R], h = q[H], vr = q[VR], vh = q[VH];
    Strut m = strut(r - p->La, h - p->Lb, vr, vh, p->Lm0),
          x = strut(r - p->Lc, h - p->Ld, vr, vh, p->Ls0);
    double Fh = damper(m.stroke, m.rate, q[Z1], q[Z2], p, w);
    double Fa = auxiliary(x.stroke, x.rate, p, w);
    w->auxiliary_stroke = x.stroke;

    Vector spin = {y[WX], y[WY], y[WZ]};
    Vector foot = {r * g->cos - p->cg_x, h, r * g->sin - p->cg_z};
    Vector rate = {vr * g->cos, vh, vr * g->sin}, moved = sum(cross(spin, foot), 1.0, rate);
    Vector at = to_inertial(s->turn, foot), v = to_inertial(s->turn, moved);
    Vector above = {y[X] + at.x - u[SURGE], y[Y] + at.y - u[HEAVE], y[Z] + at.z - u[SWAY]};
    Vector ground = cross(rolling, above);
    ground = (Vector){ground.x + u[SURGE_RATE], ground.y + u[HEAVE_RATE], ground.z + u[SWAY_RATE]};
    Vector slip = to_body(s->axes, (Vector){y[VX] + v.x - ground.x, y[VY] + v.y - ground.y,
                                            y[VZ] + v.z - ground.z});
    double d = -to_body(s->axes, above).y, dv = -slip.y, Fn = 0.0, F[2];
    w->height = y[Y] + at.y;
    w->contact = w->contact_work = 0.0;
    if (d > 0.0) {
        double elastic = p->Kg * pow(d, p->en);
        Fn = MAX(elastic + p->Cgmax * damping_ramp(d, p) * dv, 0.0);
        w->contact = (Fn - elastic) * dv;
        w->contact_work = elastic * d;
    }
    friction(d, Fn, slip.x, slip.z, q + SX, p, w, F);
    Vector contact = to_inertial(s->axes, (Vector){F[0], Fn, F[1]});
    Vector force = to_body(s->turn, (Vector){contact.x, contact.y - p->m_d * p->g, contact.z});
    Vector bias = cross(spin, sum(moved, 1.0, rate));
    double main_r = Fh * m.er, main_h = Fh * m.eh, aux_r = Fa * x.er, aux_h = Fa * x.eh;
    w->ground = dot(contact, ground);
    w->strut_r = main_r + aux_r;
    w->strut_h = main_h + aux_h;
    w->moment = p->La * main_h - p->Lb * main_r + p->Lc * aux_h - p->Ld * aux_r;
    w->radial = g->cos * force.x + g->sin * force.z + main_r + aux_r;
    w->vertical = force.y + main_h + aux_h;
    w->tangential = g->cos * force.z - g->sin * force.x;
    w->bias[0] = g->cos * bias.x + g->sin * bias.z;
    w->bias[1] = bias.y;
    w->bias[2] = g->cos * bias.z - g->sin * bias.x;
    memcpy(w->foot, &foot, sizeof foot);
}

static Vector about_across(const Group *g, Vector at)
{
    return (Vector){g->cos * at.y, -(g->cos * at.x + g->sin * at.z), g->sin * at.y};
}

/* Acceleration of the body and of its angular velocity, body axes. */
static void acceleration(const Landing *s, Vector spin, Vector force, Vector moment, Vector *a,
                         Vector *turning)
{
    const Parameters *p = &s->p;
    Vector i_x = {p->I_x, p->I_xy, p->I_xz}, i_y = {p->I_xy, p->I_y, p->I_yz},
           i_z = {p->I_xz, p->I_yz, p->I_z}, zero = {0.0, 0.0, 0.0};
    Vector c_x = zero, c_z = zero, d_x = zero, d_z = zero, struts = zero;
    Vector momentum = {dot(i_x, spin), dot(i_y, spin), dot(i_z, spin)};
    moment = sum(moment, -1.0, cross(spin, momentum));
    for (int i = 0; i < s->groups; i++) {
        const Group *g = &s->group[i];
        const Loads *w = &s->loads[i];
        Vector c = about_across(g, (Vector){w->foot[0], w->foot[1], w->foot[2]}), d = c;
        if (p->at_joint > 0.0)
            d = about_across(g, (Vector){p->Lc * g->cos - p->cg_x, p->Ld, p->Lc * g->sin - p->cg_z});
        Vector felt = {d.x * p->m_d, d.y * p->m_d, d.z * p->m_d};
        c_x = sum(c_x, -(p->m_d * g->sin), c);
        c_z = sum(c_z, p->m_d * g->cos, c);
        d_x = sum(d_x, -g->sin, felt);
        d_z = sum(d_z, g->cos, felt);
        i_x = sum(i_x, felt.x, c);
        i_y = sum(i_y, felt.y, c);
        i_z = sum(i_z, felt.z, c);
        double bias = p->m_d * w->bias[2] - w->tangential;
        struts = sum(struts, -1.0, (Vector){w->strut_r * g->cos, w->strut_h, w->strut_r * g->sin});
        force.x += bias * g->sin;
        force.z -= bias * g->cos;
        Vector across = {-w->moment * g->sin, 0.0, w->moment * g->cos};
        moment = sum(moment, -1.0, sum(across, bias, d));
    }
    force = sum(force, 1.0, struts);
    moment = sum(moment, -1.0, cross((Vector){p->cg_x, 0.0, p->cg_z}, struts));
    Vector of_x = sum(scaled(c_x, s->xx), s->xz, c_z), of_z = sum(scaled(c_x, s->xz), s->zz, c_z);
    double free_x = s->xx * force.x + s->xz * force.z, free_z = s->xz * force.x + s->zz * force.z;
    Vector x = sum(i_x, -1.0, sum(scaled(of_x, d_x.x), d_z.x, of_z));
    Vector y = sum(i_y, -1.0, sum(scaled(of_x, d_x.y), d_z.y, of_z));
    Vector z = sum(i_z, -1.0, sum(scaled(of_x, d_x.z), d_z.z, of_z));
    Vector right = sum(moment, -1.0, sum(scaled(d_x, free_x), free_z, d_z));
    Vector by_x = cross(y, z), by_y = cross(z, x), by_z = cross(x, y);
    double part = 1.0 / dot(x, by_x);
    Vector total = sum(sum(sum(zero, right.x, by_x), right.y, by_y), right.z, by_z);
    *turning = scaled(total, part);
    *a = (Vector){free_x - dot(of_x, *turning), force.y / p->m_u, free_z - dot(of_z, *turning)};
}

static void right_hand_side(Landing *s, const double *y, const double *u, double *dy)
{
    const Parameters *p = &s->p;
    int groups = s->groups;
    turn_body(s, y);
    turn_ground(s, u);
    Vector spin = {y[WX], y[WY], y[WZ]}, rolling = deck_spin(u), a, turning;
    for (int i = 0; i < groups; i++)
        leg_loads(s, y, y + BODY + LEG * i, &s->group[i], u, rolling, &s->loads[i]);
    Vector force =
        to_body(s->turn, (Vector){u[FORCE_X], u[FORCE_Y] - p->m_u * p->g, u[FORCE_Z]});
    Vector moment = to_body(s->turn, (Vector){u[MOMENT_X], u[MOMENT_Y], u[MOMENT_Z]});
    acceleration(s, spin, force, moment, &a, &turning);
    Vector moved = to_inertial(s->turn, a);
    double rates[BODY] = {
        y[VX], y[VY], y[VZ],
        -0.5 * (y[QX] * spin.x + y[QY] * spin.y + y[QZ] * spin.z),
        0.5 * (y[QW] * spin.x + y[QY] * spin.z - y[QZ] * spin.y),
        0.5 * (y[QW] * spin.y + y[QZ] * spin.x - y[QX] * spin.z),
        0.5 * (y[QW] * spin.z + y[QX] * spin.y - y[QY] * spin.x),
        moved.x, moved.y, moved.z, turning.x, turning.y, turning.z};
    memcpy(dy, rates, sizeof rates);

    double *e = dy + BODY + LEG * groups;
    memset(e, 0, INTEGRALS * sizeof *e);
    e[W_EXTERNAL] =
        u[FORCE_X] * y[VX] + u[FORCE_Y] * y[VY] + u[FORCE_Z] * y[VZ] + dot(moment, spin);
    for (int i = 0; i < groups; i++) {
        const double *q = y + BODY + LEG * i;
        double *dq = dy + BODY + LEG * i;
        const Group *g = &s->group[i];
        const Loads *w = &s->loads[i];
        Vector foot = {w->foot[0], w->foot[1], w->foot[2]};
        Vector frame = sum(a, 1.0, cross(turning, foot));
        dq[R] = q[VR];
        dq[H] = q[VH];
        dq[VR] = w->radial / p->m_d - (g->cos * frame.x + g->sin * frame.z + w->bias[0]);
        dq[VH] = w->vertical / p->m_d - (frame.y + w->bias[1]);
        dq[Z1] = w->dz1;
        dq[Z2] = w->dz2;
        dq[SX] = w->dsx;
        dq[SZ] = w->dsz;
        if (p->at_joint > 0.0) {
            double N = p->m_d * (g->cos * frame.z - g->sin * frame.x + w->bias[2]) - w->tangential;
            Vector joint = {p->Lc * g->cos - p->cg_x, p->Ld, p->Lc * g->sin - p->cg_z};
            Vector arm = cross(spin, sum(foot, -1.0, joint));
            e[W_TRANSVERSE] += N * (g->cos * arm.z - g->sin * arm.x);
        }
        e[E_ORIFICE] += w->orifice;
        e[E_SEAL] += w->seal;
        e[E_STOP] += w->stop;
        e[E_AUXILIARY] += w->auxiliary;
        e[E_CONTACT] += w->contact;
        e[E_FRICTION] += w->friction;
        e[W_GROUND] += w->ground;
    }
}

static void slope(Landing *s, double t, const double *y, double *dy)
{
    double u[INPUTS], dt = t - s->t_input;
    for (int i = 0; i < INPUTS; i++)
        u[i] = s->u[i] + s->u_rate[i] * dt;
    for (int i = SURGE; i < INPUTS; i += 2)
        u[i] = s->u[i] + (s->u[i + 1] + 0.5 * s->u_rate[i + 1] * dt) * dt;
    right_hand_side(s, y, u, dy);
    s->rhs_calls += 1.0;
}

/* As the symmetric body's. */
static double energy(const Landing *s, const double *y, double *dissipated)
{
    const Parameters *p = &s->p;
    const double *e = y + BODY + LEG * s->groups;
    Vector w = {y[WX], y[WY], y[WZ]};
    Vector momentum = {p->I_x * w.x + p->I_xy * w.y + p->I_xz * w.z,
                       p->I_xy * w.x + p->I_y * w.y + p->I_yz * w.z,
                       p->I_xz * w.x + p->I_yz * w.y + p->I_z * w.z};
    Vector velocity = to_body(s->turn, (Vector){y[VX], y[VY], y[VZ]});
    double twice = p->m_u * dot(velocity, velocity) + dot(w, momentum);
    double height = p->m_u * y[Y], held = 0.0;
    for (int i = 0; i < s->groups; i++) {
        const double *q = y + BODY + LEG * i;
        const Group *g = &s->group[i];
        Vector foot = {q[R] * g->cos - p->cg_x, q[H], q[R] * g->sin - p->cg_z};
        Vector v = sum(velocity, 1.0, cross(w, foot));
        v = sum(v, 1.0, (Vector){q[VR] * g->cos, q[VH], q[VR] * g->sin});
        twice += p->m_d * dot(v, v);
        height += p->m_d * s->loads[i].height;
        held += s->loads[i].held + springs(q, &s->loads[i], p);
    }
    *dissipated =
        e[E_ORIFICE] + e[E_SEAL] + e[E_STOP] + e[E_AUXILIARY] + e[E_CONTACT] + e[E_FRICTION];
    double supplied = e[W_EXTERNAL] + e[W_GROUND] + e[W_TRANSVERSE];
    return 0.5 * twice + p->g * height + held + *dissipated - supplied;
}

static void normalise(double *y)
{
    double size = sqrt(y[QW] * y[QW] + y[QX] * y[QX] + y[QY] * y[QY] + y[QZ] * y[QZ]);
    for (int i = QW; i <= QZ; i++)
        y[i] /= size;
}

/* The inverse of the mass that an acceleration along the body's x, z moves; the ground's axes. */
static void prepare(Landing *s)
{
    double x = s->p.m_u, z = s->p.m_u, both = 0.0;
    for (int i = 0; i < s->groups; i++) {
        const Group *g = &s->group[i];
        x += s->p.m_d * g->sin * g->sin;
        z += s->p.m_d * g->cos * g->cos;
        both -= s->p.m_d * g->sin * g->cos;
    }
    double determinant = x * z - both * both;
    s->xx = z / determinant;
    s->xz = -both / determinant;
    s->zz = x / determinant;
    s->turned[0] = 1e300;  /* no angle of a deck */
}
