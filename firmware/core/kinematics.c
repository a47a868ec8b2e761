#include "kinematics.h"

#include <math.h>

#define PI 3.14159265f

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void kinematics_rotation(const float rpy[3], float rotation[9])
{
    float sr = sinf(rpy[0]), cr = cosf(rpy[0]);
    float sp = sinf(rpy[1]), cp = cosf(rpy[1]);
    float sy = sinf(rpy[2]), cy = cosf(rpy[2]);
    rotation[0] = cy * cp;
    rotation[1] = cy * sp * sr - sy * cr;
    rotation[2] = cy * sp * cr + sy * sr;
    rotation[3] = sy * cp;
    rotation[4] = sy * sp * sr + cy * cr;
    rotation[5] = sy * sp * cr - cy * sr;
    rotation[6] = -sp;
    rotation[7] = cp * sr;
    rotation[8] = cp * cr;
}

/* The gap from crank axis to platform joint, in the coordinates of its own leg. */
static void gap_of(const CrankLeg *leg, const float position[3], const float rotation[9],
                   float gap[3])
{
    float way[3];
    for (uint8_t i = 0; i < 3; i++)
        way[i] = dot(rotation + 3 * i, leg->platform) + position[i] - leg->centre[i];
    gap[0] = dot(way, leg->normal);
    gap[1] = dot(way, leg->tangent);
    gap[2] = dot(way, leg->up);
}

static float within_half_a_turn(float angle, float centre)
{
    while (angle > centre + PI)
        angle -= 2 * PI;
    while (angle < centre - PI)
        angle += 2 * PI;
    return angle;
}

bool kinematics_cranks(const CrankHexapod *hexapod, const float position[3],
                       const float rotation[9], float cranks[LEGS])
{
    for (uint8_t i = 0; i < LEGS; i++) {
        const CrankLeg *leg = &hexapod->legs[i];
        float gap[3];
        gap_of(leg, position, rotation, gap);
        float in_plane = gap[1] * gap[1] + gap[2] * gap[2];
        /* (r - d)(r + d), not r^2 - d^2: the difference keeps its digits. */
        float numerator = in_plane + gap[0] * gap[0];
        numerator += (leg->crank - leg->rod) * (leg->crank + leg->rod);
        float cosine = numerator / (2 * leg->crank * sqrtf(in_plane));
        if (!(fabsf(cosine) <= 1.0f)) /* not a number: refused too */
            return false;
        float angle = atan2f(gap[2], gap[1]) + acosf(cosine);
        cranks[i] = within_half_a_turn(angle, hexapod->crank_centre);
    }
    return true;
}

bool kinematics_is_within_limits(const CrankHexapod *hexapod, const float position[3],
                                 const float cranks[LEGS])
{
    if (!(position[2] >= hexapod->minimum_height))
        return false;
    for (uint8_t i = 0; i < LEGS; i++)
        if (!(cranks[i] >= hexapod->crank_lowest && cranks[i] <= hexapod->crank_highest))
            return false;
    return true;
}

void kinematics_counts(const CrankHexapod *hexapod, const float cranks[LEGS], float *counts)
{
    for (uint8_t i = 0; i < LEGS; i++) {
        const CrankServo *servo = &hexapod->servos[i];
        counts[servo->channel] = servo->centre_count + servo->scale * (cranks[i] - servo->centre);
    }
}
