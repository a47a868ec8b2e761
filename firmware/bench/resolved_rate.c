#include "resolved_rate.h"

#include <math.h>

/* Determinants below this fraction of their size are taken for zero. */
#define SINGULAR 1e-4f

typedef struct {
    float s1, c1, s2, c2, s23, c23, s4, c4, s5, c5, s6, c6;
} Angles;

static Angles angles_of(const float q[6])
{
    return (Angles){
        .s1 = sinf(q[0]), .c1 = cosf(q[0]), .s2 = sinf(q[1]), .c2 = cosf(q[1]),
        .s23 = sinf(q[1] + q[2]), .c23 = cosf(q[1] + q[2]), .s4 = sinf(q[3]), .c4 = cosf(q[3]),
        .s5 = sinf(q[4]), .c5 = cosf(q[4]), .s6 = sinf(q[5]), .c6 = cosf(q[5]),
    };
}

static float determinant(const float a[3], const float b[3], const float c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* x with x[0]·a + x[1]·b + x[2]·c = wanted, by Cramer's rule. */
static bool solve(const float a[3], const float b[3], const float c[3], const float wanted[3],
                  float size, float x[3])
{
    float whole = determinant(a, b, c);
    if (!(fabsf(whole) > SINGULAR * size))
        return false;
    x[0] = determinant(wanted, b, c) / whole;
    x[1] = determinant(a, wanted, c) / whole;
    x[2] = determinant(a, b, wanted) / whole;
    return true;
}

/* Eq. (1) differentiated: columns of q1', q2', q3' in the wrist centre's velocity. */
static bool solve_position(const PaperArm *arm, const Angles *t, const float velocity[3],
                           float rates[3])
{
    float across = arm->upper * t->s2 + arm->fore * t->s23;
    float along = arm->upper * t->c2 + arm->fore * t->c23;
    float down = arm->fore * t->s23;
    float forth = arm->fore * t->c23;
    const float of_1[3] = {-t->c1 * across, -t->s1 * across, 0};
    const float of_2[3] = {-t->s1 * along, t->c1 * along, -across};
    const float of_3[3] = {-t->s1 * forth, t->c1 * forth, -down};
    float size = arm->upper * arm->fore * (arm->upper + arm->fore);
    return solve(of_1, of_2, of_3, velocity, size, rates);
}

/* a_x' = a_z' = n_z' = 0: the rates of q4, q5, q6 that undo what q1, q2, q3 do. */
static bool solve_orientation(const Angles *t, const float position_rates[3], float rates[3])
{
    float wrist = t->s23 * t->c4 * t->c5 + t->c23 * t->s5;
    const float of_1[3] = {
        t->s1 * t->s4 * t->s5 - t->c1 * (t->c23 * t->c4 * t->s5 + t->s23 * t->c5), 0, 0};
    const float of_23[3] = {
        t->s1 * (t->s23 * t->c4 * t->s5 - t->c23 * t->c5),
        -t->c23 * t->c4 * t->s5 - t->s23 * t->c5,
        -t->c23 * t->s4 * t->s6 + t->c6 * (t->c23 * t->c4 * t->c5 - t->s23 * t->s5)};
    const float of_4[3] = {(t->s1 * t->c23 * t->s4 - t->c1 * t->c4) * t->s5,
                           t->s23 * t->s4 * t->s5,
                           -t->s23 * (t->c4 * t->s6 + t->s4 * t->c5 * t->c6)};
    const float of_5[3] = {
        -(t->c1 * t->s4 + t->s1 * t->c23 * t->c4) * t->c5 + t->s1 * t->s23 * t->s5,
        -t->s23 * t->c4 * t->c5 - t->c23 * t->s5,
        t->c6 * (t->c23 * t->c5 - t->s23 * t->c4 * t->s5)};
    const float of_6[3] = {0, 0, -t->s23 * t->s4 * t->c6 - t->s6 * wrist};
    float wanted[3];
    for (int i = 0; i < 3; i++)
        wanted[i] = -of_1[i] * position_rates[0] - of_23[i] * (position_rates[1] + position_rates[2]);
    return solve(of_4, of_5, of_6, wanted, 1.0f, rates);
}

bool resolved_rate_step(const PaperArm *arm, float joints[6], const float velocity[3], float dt)
{
    Angles t = angles_of(joints);
    float rates[6];
    if (!solve_position(arm, &t, velocity, rates) || !solve_orientation(&t, rates, rates + 3))
        return false;
    for (int i = 0; i < 6; i++)
        joints[i] += rates[i] * dt;
    return true;
}
