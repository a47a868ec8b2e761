#include "arm_inverse.h"

#include <math.h>

#define PI 3.14159265f

typedef struct {
    float s1, c1, s23, c23;
} Forearm;

/* The tool's third column and third row as the forearm sees them: Rz(q4) Rx(-q5) Rz(q6). */
static void wrist_of(const Forearm *f, const float r[9], float column[3], float row[3])
{
    column[0] = f->c1 * r[2] + f->s1 * r[5];
    float fore = -f->s1 * r[2] + f->c1 * r[5];
    column[1] = f->c23 * fore - f->s23 * r[8];
    column[2] = f->s23 * fore + f->c23 * r[8];
    for (int i = 0; i < 3; i++)
        row[i] = f->s23 * (-f->s1 * r[i] + f->c1 * r[3 + i]) + f->c23 * r[6 + i];
}

static float cosine_of_elbow(const PaperArm *arm, float square)
{
    return (square - arm->upper * arm->upper - arm->fore * arm->fore) /
           (2.0f * arm->upper * arm->fore);
}

bool arm_inverse_algebraic(const PaperArm *arm, const float centre[3], const float rotation[9],
                           float joints[6])
{
    float across = sqrtf(centre[0] * centre[0] + centre[1] * centre[1]);
    float up = centre[2];
    float c3 = cosine_of_elbow(arm, across * across + up * up);
    if (!(fabsf(c3) < 1.0f && across > 0.0f))
        return false;
    float s3 = sqrtf(1.0f - c3 * c3);
    float along = arm->upper + arm->fore * c3, aside = arm->fore * s3;
    float size = along * along + aside * aside;
    float s2 = (along * across - aside * up) / size, c2 = (along * up + aside * across) / size;
    const Forearm f = {-centre[0] / across, centre[1] / across, s2 * c3 + c2 * s3,
                       c2 * c3 - s2 * s3};
    float column[3], row[3];
    wrist_of(&f, rotation, column, row);
    joints[0] = atan2f(-centre[0], centre[1]);
    joints[1] = atan2f(s2, c2);
    joints[2] = atan2f(s3, c3);
    joints[3] = atan2f(-column[0], column[1]);
    joints[4] = atan2f(sqrtf(column[0] * column[0] + column[1] * column[1]), column[2]);
    joints[5] = atan2f(-row[0], -row[1]);
    return true;
}

bool arm_inverse_geometric(const PaperArm *arm, const float centre[3], const float rotation[9],
                           float joints[6])
{
    float across = sqrtf(centre[0] * centre[0] + centre[1] * centre[1]);
    float square = across * across + centre[2] * centre[2];
    float c3 = cosine_of_elbow(arm, square);
    if (!(fabsf(c3) < 1.0f && across > 0.0f))
        return false;
    float distance = sqrtf(square);
    float at_shoulder = (arm->upper * arm->upper + square - arm->fore * arm->fore) /
                        (2.0f * arm->upper * distance);
    joints[0] = atan2f(-centre[0], centre[1]);
    joints[1] = 0.5f * PI - atan2f(centre[2], across) - acosf(at_shoulder);
    joints[2] = PI - acosf(-c3);
    float elbow = joints[1] + joints[2];
    const Forearm f = {sinf(joints[0]), cosf(joints[0]), sinf(elbow), cosf(elbow)};
    float column[3], row[3];
    wrist_of(&f, rotation, column, row);
    joints[3] = atan2f(-column[0], column[1]);
    joints[4] = acosf(column[2]);
    joints[5] = atan2f(-row[0], -row[1]);
    return true;
}
