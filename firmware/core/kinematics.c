#include "kinematics.h"

#if HAS_KINEMATICS

#include <math.h>

#define PI 3.14159265f

typedef struct {
    float centre[3];   /* of the crank, base frame */
    float normal[3];   /* tangent x up */
    float tangent[3];  /* where the crank's angle is 0 */
    float up[3];       /* where it is a right angle */
    float platform[3]; /* where the rod ends, platform frame */
    float crank;       /* lengths */
    float rod;
} Leg;

typedef struct {
    uint8_t channel;
    float centre;       /* rad */
    float centre_count; /* pulse there */
    float scale;        /* counts a radian, signed */
} Servo;

static const Leg LEG[LEGS] = LEG_GEOMETRY;
static const Servo SERVO[LEGS] = SERVO_CALIBRATION;

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
static void gap_of(const Leg *leg, const float position[3], const float rotation[9], float gap[3])
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

bool kinematics_cranks(const float position[3], const float rotation[9], float cranks[LEGS])
{
    for (uint8_t i = 0; i < LEGS; i++) {
        const Leg *leg = &LEG[i];
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
        cranks[i] = within_half_a_turn(angle, CRANK_CENTRE_RAD);
    }
    return true;
}

bool kinematics_is_within_limits(const float position[3], const float cranks[LEGS])
{
    if (!(position[2] >= MINIMUM_HEIGHT_M))
        return false;
    for (uint8_t i = 0; i < LEGS; i++)
        if (!(cranks[i] >= CRANK_LOWEST_RAD && cranks[i] <= CRANK_HIGHEST_RAD))
            return false;
    return true;
}

void kinematics_counts(const float cranks[LEGS], float counts[LEGS])
{
    for (uint8_t i = 0; i < LEGS; i++) {
        const Servo *servo = &SERVO[i];
        counts[servo->channel] = servo->centre_count + servo->scale * (cranks[i] - servo->centre);
    }
}

#endif
