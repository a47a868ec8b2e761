#include "line_keeping.h"

#include "vector.h"

/* Part of a twist that may be missing in a direction that is being lost. */
#define LET_GO REAL(0.003)
/* 1/s: the gain with which a tool off its line is pulled back, */
#define PULL REAL(10.0)
/* by no more than this part of the twist: a tool that stands is not moved. */
#define MOST_PULL REAL(0.2)
/* The singular value below which a direction is lost: no rates drive the tool along it. */
#define LOST REAL(1e-6)
/* Part of the largest below which another number is rounding. */
#define NOISE REAL(1e-9)

static real largest(const real a[6])
{
    real most = 0;
    for (int k = 0; k < 6; k++)
        most = real_fabs(a[k]) > most ? real_fabs(a[k]) : most;
    return most;
}

/* v' M: for U the parts along the left singular vectors, for V' a sum of the right ones. */
static void times6(const real vector[6], const real matrix[6][6], real product[6])
{
    for (int k = 0; k < 6; k++) {
        product[k] = 0;
        for (int i = 0; i < 6; i++)
            product[k] += vector[i] * matrix[i][k];
    }
}

/* Rounding set to zero, or a joint at its stop would hold the arm for nothing. */
static void remove_noise(real rates[JOINTS])
{
    real least = NOISE * largest(rates);
    for (int i = 0; i < JOINTS; i++)
        if (real_fabs(rates[i]) < least)
            rates[i] = 0;
}

void decompose(const struct chain *chain, real length, const real joints[JOINTS],
               struct decomposed *at)
{
    posture turned;
    chain_posture(chain, joints, &turned);
    chain_jacobian(&turned, at->jacobian);
    scale_jacobian(length, at->jacobian);
    svd6(at->jacobian, &at->svd);
}

void turning(const struct decomposed *at, const real rates[JOINTS], real acceleration[6])
{
    real before[3] = {0, 0, 0}; /* the angular velocity of the link before the joint */
    for (int k = 0; k < 6; k++)
        acceleration[k] = 0;
    for (int i = 0; i < JOINTS; i++) {
        real velocity[3] = {0}, turn[3] = {0}, both[3] = {0}, linear[3], angular[3];
        for (int k = 0; k < 3; k++) {
            velocity[k] = at->jacobian[k][i] * rates[i];
            turn[k] = at->jacobian[3 + k][i] * rates[i];
            both[k] = 2 * before[k] + turn[k];
        }
        cross3(both, velocity, linear);
        cross3(before, turn, angular);
        for (int k = 0; k < 3; k++) {
            acceleration[k] += linear[k];
            acceleration[3 + k] += angular[k];
            before[k] += turn[k];
        }
    }
}

/* For the twist's parts along the left singular vectors; those of 0 may have been let go of. */
static void rates_of(const struct decomposed *at, const real parts[6], int may_let_go,
                     struct line *line)
{
    real inverse[6], acceleration[6], bends[6], most = largest(parts);
    line->is_lost = 0;
    for (int k = 0; k < 6; k++) {
        real sigma = at->svd.sigma[k];
        inverse[k] = sigma < LOST ? 0 : 1 / sigma;
        if (sigma < LOST && real_fabs(parts[k]) > NOISE * most)
            line->is_lost = 1;
        line->along[k] = parts[k] * inverse[k];
    }
    times6(line->along, at->svd.right, line->rates);
    remove_noise(line->rates);
    turning(at, line->rates, acceleration);
    times6(acceleration, at->svd.left, bends);
    for (int k = 0; k < 6; k++) {
        bends[k] *= may_let_go && parts[k] == 0 ? 0 : -inverse[k];
        if (line->is_lost > 0)
            line->along[k] = parts[k] / (at->svd.sigma[k] > LOST ? at->svd.sigma[k] : LOST);
    }
    times6(bends, at->svd.right, line->bend);
}

/* The way back to the line, as a twist. */
static void pull(const real off_line[6], const real twist[6], real back[6])
{
    real off = size6(off_line);
    real most = MOST_PULL * size6(twist);
    real gain = off * PULL > most ? most / off : PULL;
    for (int k = 0; k < 6; k++)
        back[k] = gain * off_line[k];
}

void line_rates(const struct decomposed *at, real onset, const real twist[6], const real *off_line,
                struct line *line)
{
    real parts[6], back[6], back_parts[6];
    const real *sigma = at->svd.sigma;
    int is_near = sigma[5] < onset;
    times6(twist, at->svd.left, parts);
    if (off_line) {
        pull(off_line, twist, back);
        times6(back, at->svd.left, back_parts);
        real size = size6(twist);
        for (int k = 0; k < 6; k++) {
            /* The pull never turns a lost direction around: the way back must stay open. */
            if (!(sigma[k] < onset && back_parts[k] * parts[k] < 0))
                parts[k] += back_parts[k];
            if (sigma[k] < onset) {
                real let_go = LET_GO * size * (1 - sigma[k] / onset);
                real kept = real_fabs(parts[k]) - let_go;
                parts[k] = kept <= 0 ? 0 : parts[k] < 0 ? -kept : kept;
            }
        }
    }
    rates_of(at, parts, off_line && is_near, line);
}

void damped_rates(const struct decomposed *at, real onset, const real twist[6],
                  real rates[JOINTS])
{
    real parts[6];
    times6(twist, at->svd.left, parts);
    for (int k = 0; k < 6; k++) {
        real sigma = at->svd.sigma[k], sum = onset * onset + sigma * sigma;
        parts[k] *= sigma < onset ? 4 * sigma * onset * onset / (sum * sum) : 1 / sigma;
    }
    times6(parts, at->svd.right, rates);
    remove_noise(rates);
}

real part_driven(const struct decomposed *at, const real twist[6], const real rates[JOINTS],
                 real missed[6], real moving[6])
{
    real size = dot6(twist, twist);
    for (int k = 0; k < 6; k++)
        moving[k] = dot6(at->jacobian[k], rates);
    real part = size > 0 ? dot6(moving, twist) / size : 0;
    for (int k = 0; k < 6; k++)
        missed[k] = size > 0 ? part * twist[k] - moving[k] : 0;
    return part < 1 ? part : 1;
}
