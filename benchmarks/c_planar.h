/* The symmetric body: part of c_landing.c, which says what it is for. */
typedef struct {
    double sin_p, cos_p, sin_a, cos_a;
} Angles;

static void leg_loads(const double *y, const double *q, const Group *g, Angles a, const double *u,
                      const Parameters *p, Loads *w)
{
    double r = q[R], h = q[H], vr = q[VR], vh = q[VH], rate = y[PITCH_RATE];
    Strut m = strut(r - p->La, h - p->Lb, vr, vh, p->Lm0),
          x = strut(r - p->Lc, h - p->Ld, vr, vh, p->Ls0);
    double Fh = damper(m.stroke, m.rate, q[Z1], q[Z2], p, w);
    double Fa = auxiliary(x.stroke, x.rate, p, w);
    w->auxiliary_stroke = x.stroke;

    double bx = r * g->cos, vbx = vr * g->cos + rate * h, vby = vh - rate * bx;
    double foot_x = y[X] + bx * a.cos_p + h * a.sin_p, foot_y = y[Y] - bx * a.sin_p + h * a.cos_p;
    double foot_vx = y[VX] + vbx * a.cos_p + vby * a.sin_p,
           foot_vy = y[VY] - vbx * a.sin_p + vby * a.cos_p;
    double lifted = foot_y - u[HEAVE];
    double ground_x = u[TILT_RATE] * lifted, ground_y = u[HEAVE_RATE] - u[TILT_RATE] * foot_x;
    double rx = foot_vx - ground_x, ry = foot_vy - ground_y;
    double d = -(foot_x * a.sin_a + lifted * a.cos_a), dv = -(rx * a.sin_a + ry * a.cos_a);
    double slip_x = rx * a.cos_a - ry * a.sin_a, slip_z = vr * g->sin;

    double Fn = 0.0;
    w->contact = w->contact_work = 0.0;
    if (d > 0.0) {
        double elastic = p->Kg * pow(d, p->en);
        Fn = elastic + p->Cgmax * damping_ramp(d, p) * dv;
        if (Fn < 0.0)
            Fn = 0.0;
        w->contact = (Fn - elastic) * dv;
        w->contact_work = elastic * d;
    }
    double F[2];
    friction(d, Fn, slip_x, slip_z, q + SX, p, w, F);
    double Fx = F[0], Fz = F[1];

    double Cx = Fx * a.cos_a + Fn * a.sin_a, Cy = Fn * a.cos_a - Fx * a.sin_a,
           weight = p->m_d * p->g;
    double body_x = Cx * a.cos_p - (Cy - weight) * a.sin_p,
           body_y = Cx * a.sin_p + (Cy - weight) * a.cos_p;
    double main_r = Fh * m.er, main_h = Fh * m.eh, aux_r = Fa * x.er, aux_h = Fa * x.eh;
    w->ground = Cx * ground_x + Cy * ground_y;
    w->radial = body_x * g->cos + Fz * g->sin + main_r + aux_r;
    w->vertical = body_y + main_h + aux_h;
    w->tangential = Fz * g->cos - body_x * g->sin;
    w->body_x = -(main_r + aux_r) * g->cos;
    w->body_y = -(main_h + aux_h);
    w->body_moment = g->cos * (p->La * main_h - p->Lb * main_r + p->Lc * aux_h - p->Ld * aux_r);
}

static void right_hand_side(Landing *s, const double *y, const double *u, double *dy)
{
    const Parameters *p = &s->p;
    int groups = s->groups;
    Angles a = {sin(y[PITCH]), cos(y[PITCH]), sin(p->alpha + u[TILT]), cos(p->alpha + u[TILT])};
    double rate = y[PITCH_RATE], fx = u[FORCE_X], fy = u[FORCE_Y] - p->m_u * p->g;
    double force_x = fx * a.cos_p - fy * a.sin_p, force_y = fx * a.sin_p + fy * a.cos_p,
           moment = u[MOMENT];
    double m11 = p->m_u, m12 = 0.0, m21 = 0.0, m22 = p->I_u;
    for (int i = 0; i < groups; i++) {
        const double *q = y + BODY + LEG * i;
        const Group *g = &s->group[i];
        Loads *w = &s->loads[i];
        leg_loads(y, q, g, a, u, p, w);
        double n = g->count, yn = q[H] + p->at_joint * (p->Ld - q[H]),
               mass = n * p->m_d * g->sin * g->sin;
        m11 += mass;
        m12 += mass * q[H];
        m21 += mass * yn;
        m22 += mass * yn * q[H];
        double bias =
            n * g->sin *
            (w->tangential + p->m_d * g->sin * (2.0 * rate * q[VH] - rate * rate * q[R] * g->cos));
        force_x += n * w->body_x - bias;
        force_y += n * w->body_y;
        moment += n * w->body_moment - bias * yn;
    }
    double determinant = m11 * m22 - m12 * m21;
    double ax = (force_x * m22 - moment * m12) / determinant, ay = force_y / p->m_u;
    double pitch_acc = (m11 * moment - m21 * force_x) / determinant;
    dy[X] = y[VX];
    dy[Y] = y[VY];
    dy[PITCH] = rate;
    dy[VX] = ax * a.cos_p + ay * a.sin_p;
    dy[VY] = ay * a.cos_p - ax * a.sin_p;
    dy[PITCH_RATE] = pitch_acc;

    double *e = dy + BODY + LEG * groups;
    memset(e, 0, INTEGRALS * sizeof *e);
    e[W_EXTERNAL] = u[FORCE_X] * y[VX] + u[FORCE_Y] * y[VY] + u[MOMENT] * rate;
    for (int i = 0; i < groups; i++) {
        const double *q = y + BODY + LEG * i;
        double *dq = dy + BODY + LEG * i;
        const Group *g = &s->group[i];
        const Loads *w = &s->loads[i];
        double n = g->count, bx = q[R] * g->cos, yn = q[H] + p->at_joint * (p->Ld - q[H]);
        double frame_x = ax + pitch_acc * q[H] - rate * rate * bx + 2.0 * rate * q[VH];
        double frame_y = ay - pitch_acc * bx - rate * rate * q[H] - 2.0 * rate * q[VR] * g->cos;
        dq[R] = q[VR];
        dq[H] = q[VH];
        dq[VR] = w->radial / p->m_d - frame_x * g->cos;
        dq[VH] = w->vertical / p->m_d - frame_y;
        dq[Z1] = w->dz1;
        dq[Z2] = w->dz2;
        dq[SX] = w->dsx;
        dq[SZ] = w->dsz;
        double N = -p->m_d * g->sin * frame_x - w->tangential;
        e[W_TRANSVERSE] += n * (-N * g->sin * rate * (q[H] - yn));
        e[E_ORIFICE] += n * w->orifice;
        e[E_SEAL] += n * w->seal;
        e[E_STOP] += n * w->stop;
        e[E_AUXILIARY] += n * w->auxiliary;
        e[E_CONTACT] += n * w->contact;
        e[E_FRICTION] += n * w->friction;
        e[W_GROUND] += n * w->ground;
    }
}

static void slope(Landing *s, double t, const double *y, double *dy)
{
    double u[INPUTS], dt = t - s->t_input;
    for (int i = 0; i < INPUTS; i++)
        u[i] = s->u[i] + s->u_rate[i] * dt;
    u[HEAVE] = s->u[HEAVE] + (s->u[HEAVE_RATE] + 0.5 * s->u_rate[HEAVE_RATE] * dt) * dt;
    u[TILT] = s->u[TILT] + (s->u[TILT_RATE] + 0.5 * s->u_rate[TILT_RATE] * dt) * dt;
    right_hand_side(s, y, u, dy);
    s->rhs_calls += 1.0;
}

/* Mechanical energy and what was dissipated, less what was supplied, at a state where the right-hand
 * side was worked out last; of that, what was dissipated. */
static double energy(const Landing *s, const double *y, double *dissipated)
{
    const Parameters *p = &s->p;
    const double *e = y + BODY + LEG * s->groups;
    double sin_p = sin(y[PITCH]), cos_p = cos(y[PITCH]), rate = y[PITCH_RATE];
    double vx = y[VX] * cos_p - y[VY] * sin_p, vy = y[VX] * sin_p + y[VY] * cos_p;
    double twice = p->m_u * (y[VX] * y[VX] + y[VY] * y[VY]) + p->I_u * rate * rate;
    double height = p->m_u * y[Y], held = 0.0;
    for (int i = 0; i < s->groups; i++) {
        const double *q = y + BODY + LEG * i;
        const Group *g = &s->group[i];
        double fx = vx + q[VR] * g->cos + rate * q[H], fy = vy + q[VH] - rate * q[R] * g->cos;
        double fz = q[VR] * g->sin, feet = g->count * p->m_d;
        twice += feet * (fx * fx + fy * fy + fz * fz);
        height += feet * (y[Y] - q[R] * g->cos * sin_p + q[H] * cos_p);
        held += g->count * (s->loads[i].held + springs(q, &s->loads[i], p));
    }
    *dissipated =
        e[E_ORIFICE] + e[E_SEAL] + e[E_STOP] + e[E_AUXILIARY] + e[E_CONTACT] + e[E_FRICTION];
    double supplied = e[W_EXTERNAL] + e[W_GROUND] + e[W_TRANSVERSE];
    return 0.5 * twice + p->g * height + held + *dissipated - supplied;
}
