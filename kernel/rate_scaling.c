#include "rate_scaling.h"

/* Radians from its stop at which a joint stands there: 0.006 deg, finer than any of our drives. */
#define AT_STOP REAL(1e-4)
#define STANDING REAL(1e-9) /* rad/s */
#define STRAIGHT REAL(1e-12) /* rad/s^2 */
/* Radians or rad/s that hold nothing back. */
#define FAR REAL(1e12)
/* Of a joint's acceleration, what following a straight line at constant speed may take; the rest
   is left for braking on it. */
#define BEND_SHARE REAL(0.25)
/* Of a joint's braking, what is counted on where the line takes most of it. */
#define BRAKING_LEFT REAL(0.1)

static real least_of(real a, real b)
{
    return a < b ? a : b;
}

static real most_of(real a, real b)
{
    return a > b ? a : b;
}

static real size_of(real rate)
{
    return most_of(real_fabs(rate), STANDING);
}

/* The index of the smallest number. */
static int first_least(const real numbers[JOINTS])
{
    int first = 0;
    for (int i = 1; i < JOINTS; i++)
        if (numbers[i] < numbers[first])
            first = i;
    return first;
}

/* Radians to the end that the joint's rate leads to; negative beyond. */
static real room(const struct joint_limits *limits, const real joints[JOINTS], int i, real rate)
{
    return rate > 0 ? limits->ranges.high[i] - joints[i] : joints[i] - limits->ranges.low[i];
}

/* From what part of its rate each joint can stand before its stop, all braking together: with
   deceleration a and room r, v dt + v^2/(2a) <= r. All fall by the same part of themselves, as
   fast as the one that brakes worst; what its line bends towards the stop, a joint has to brake as
   well. Joints that stand may be anywhere. */
static void braking_parts(const struct joint_limits *limits, const real joints[JOINTS],
                          const real rates[JOINTS], const real bend[JOINTS], real dt,
                          real slowing, real parts[JOINTS])
{
    real fall = slowing;
    for (int i = 0; i < JOINTS; i++)
        fall = least_of(fall, (limits->acceleration[i] - real_fabs(bend[i])) / size_of(rates[i]));
    for (int i = 0; i < JOINTS; i++) {
        real size = size_of(rates[i]), most = fall * size, r = room(limits, joints, i, rates[i]);
        real bent = rates[i] * bend[i] > 0 ? real_fabs(bend[i]) : 0;
        real a = most_of(most - bent, BRAKING_LEFT * most), slowed = a * dt;
        if (r <= AT_STOP)
            r = 0;
        parts[i] = size > STANDING ? (real_sqrt(slowed * slowed + 2 * a * r) - slowed) / size
                                   : FAR / size;
    }
}

struct rate_scale scale_rates(const struct joint_limits *limits, const real joints[JOINTS],
                              const real rates[JOINTS], const real bend[JOINTS], real dt,
                              real slowing)
{
    real driven[JOINTS], bent[JOINTS], braked[JOINTS], bending[JOINTS];
    for (int i = 0; i < JOINTS; i++) {
        driven[i] = limits->speed[i] / size_of(rates[i]);
        bent[i] = real_sqrt(BEND_SHARE * limits->acceleration[i]
                            / most_of(real_fabs(bend[i]), STRAIGHT));
    }
    int fastest = first_least(driven), easiest = first_least(bent);
    real cruise = least_of(1, least_of(driven[fastest], bent[easiest]));
    for (int i = 0; i < JOINTS; i++)
        bending[i] = cruise * cruise * bend[i];
    braking_parts(limits, joints, rates, bending, dt, slowing, braked);
    int gentlest = first_least(braked);
    if (cruise >= 1 && braked[gentlest] >= 1)
        return (struct rate_scale){1, HELD_BY_NONE, 0};
    if (braked[gentlest] < cruise)
        return (struct rate_scale){braked[gentlest], HELD_BY_STOP, (real)(gentlest + 1)};
    if (bent[easiest] < driven[fastest])
        return (struct rate_scale){bent[easiest], HELD_BY_ACCELERATION, (real)(easiest + 1)};
    return (struct rate_scale){driven[fastest], HELD_BY_SPEED, (real)(fastest + 1)};
}

/* A multiple of `rates`, the nearest to `part`, wherever the accelerations reach one; else all
   joints go the same part of the way. */
static void choose_rates(const struct joint_limits *limits, const real before[JOINTS], real part,
                         const real rates[JOINTS], real dt, real chosen[JOINTS])
{
    real least = -(real)INFINITY, most = (real)INFINITY, slowest = 1;
    int is_reached = 1;
    for (int i = 0; i < JOINTS; i++) {
        real size = real_fabs(rates[i]), gain = limits->acceleration[i] * dt;
        slowest = most_of(slowest, real_fabs(part * rates[i] - before[i]) / gain);
        if (size < STANDING) {
            is_reached &= real_fabs(before[i]) <= gain;
            continue;
        }
        real now = (rates[i] > 0 ? before[i] : -before[i]) / size;
        least = most_of(least, now - gain / size);
        most = least_of(most, now + gain / size);
    }
    real multiple = least_of(most_of(part, least), most);
    is_reached &= least <= most && most >= 0;
    for (int i = 0; i < JOINTS; i++) {
        chosen[i] = multiple * rates[i];
        is_reached &= real_fabs(chosen[i]) <= limits->speed[i] + STANDING;
    }
    for (int i = 0; i < JOINTS && !is_reached; i++)
        chosen[i] = before[i] + (part * rates[i] - before[i]) / slowest;
}

void follow_rates(const struct joint_limits *limits, real part, const real rates[JOINTS], real dt,
                  real before[JOINTS], real joints[JOINTS])
{
    real chosen[JOINTS], shorter = 1;
    choose_rates(limits, before, part, rates, dt, chosen);
    for (int i = 0; i < JOINTS; i++) {
        if (real_fabs(chosen[i]) < STANDING)
            chosen[i] = 0;
        else
            shorter = least_of(shorter, most_of(room(limits, joints, i, chosen[i]), 0)
                                            / real_fabs(chosen[i]) / dt);
    }
    for (int i = 0; i < JOINTS; i++) {
        before[i] = shorter * chosen[i];
        /* Only rounding is cut off: what stops do is in the rates. */
        real low = least_of(limits->ranges.low[i], joints[i]);
        real high = most_of(limits->ranges.high[i], joints[i]);
        joints[i] = least_of(most_of(joints[i] + dt * before[i], low), high);
    }
}
