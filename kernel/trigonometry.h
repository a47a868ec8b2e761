/* For (1.1) and (2.4) of docs/kinematics.md, angles of many legs at once: no branch, no call, so
   that the compiler works on several legs at a time. On the board, whose floats it does one by one,
   they are the library's. */
#pragma once
#include "real.h"

/* Added to a large number, x loses all digits below one. For |x| < 0.25 / REAL_EPSILON. */
static inline real nearest_integer(real x)
{
    const real large = REAL(1.5) / REAL_EPSILON;
    return (x + large) - large;
}

/* The angle less whole turns, within half a turn of `centre`. */
static inline real within_half_a_turn(real angle, real centre)
{
    return angle - REAL_TURN * nearest_integer((angle - centre) * (1 / REAL_TURN));
}

#define MOST_ANGLE REAL(1e5)

#ifdef KERNEL_FLOAT

#define angle_of atan2f

static inline void sine_and_cosine(real angle, real *sine, real *cosine)
{
    *sine = real_sin(angle);
    *cosine = real_cos(angle);
}

#else

/* atan2(y, x) to 5e-16; NaN where both are 0. The polynomials of this file meet their functions
   at Chebyshev's nodes. */
static inline real angle_of(real y, real x)
{
    real across = real_fabs(y), along = real_fabs(x);
    real least = across < along ? across : along;
    real most = across < along ? along : across;
    /* atan(t) = pi/4 + atan((t - 1) / (t + 1)) leaves arguments up to tan(pi/8). */
    int is_steep = least > 0.41421356237309503 * most;
    real t = (is_steep ? least - most : least) / (is_steep ? least + most : most);
    real s = t * t, s2 = s * s, s4 = s2 * s2;
    real p = ((-0.3333333333333333 + s * 0.1999999999999552) +
              s2 * (-0.14285714284666542 + s * 0.11111111015256361)) +
             s4 * (((-0.09090904578123903 + s * 0.07692183190826087) +
                    s2 * (-0.06664511447381948 + s * 0.0585814891280221)) +
                   s4 * ((-0.0508544973794026 + s * 0.03923165829558719) +
                         s2 * -0.01917688711906226));
    real angle = (is_steep ? REAL_PI / 4 : 0) + (t + t * s * p);
    angle = across > along ? REAL_PI / 2 - angle : angle;
    angle = x < 0 ? REAL_PI - angle : angle;
    return y < 0 ? -angle : angle;
}

/* The sine and cosine of an angle up to MOST_ANGLE, to 3e-16. */
static inline void sine_and_cosine(real angle, real *sine, real *cosine)
{
    real quarters = nearest_integer(angle * (2 / REAL_PI));
    real x = angle - quarters * 1.57079632673412561417; /* pi/2 in three parts: Cody and Waite */
    x -= quarters * 6.07710050630396597660e-11;
    x -= quarters * 2.02226624879595063154e-21;
    real s = x * x, s2 = s * s, s4 = s2 * s2;
    real near_sine = x + x * s * (((-0.16666666666666666 + s * 0.008333333333330948) +
                                   s2 * (-0.00019841269836758574 + s * 2.755731610255244e-06)) +
                                  s4 * (-2.5051131845003624e-08 + s * 1.5918129294866608e-10));
    real near_cosine =
        1 - s / 2 + s2 * (((0.041666666666666664 + s * -0.0013888888888887398) +
                           s2 * (2.480158729876569e-05 + s * -2.7557317271729793e-07)) +
                          s4 * (2.08761462684032e-09 + s * -1.1382632425521717e-11));
    real quarter = quarters - 4 * nearest_integer(quarters / 4); /* -2 to 2 */
    int is_odd = real_fabs(quarter) == 1;
    real across = is_odd ? near_cosine : near_sine, along = is_odd ? near_sine : near_cosine;
    *sine = quarter == 1 || quarter == 0 ? across : -across;
    *cosine = quarter == -1 || quarter == 0 ? along : -along;
}

#endif
