cdef class Model:
    cdef public int n_groups
    cdef public double[::1] sin_g, cos_g, count, share_x
    cdef public double m_u, I_u, m_d, H, at_joint
    cdef public double La, Lb, Lm0, A1, A2, V10, V20, P0, Pa, rho0, x_air, n_air, B0, kB
    cdef public double CdAo_c, CdAo_r, dP_lam, Fc, kp, Fs, v_str, v_sm, s_max, K_stop, c_stop
    cdef public double Lc, Ld, Ls0, Ka, ek, Ca
    cdef public double alpha, Kg, en, Cgmax, d_ramp, mu, s_r0, ar, b_strib, Cr, v_dir, tau_sr, g
