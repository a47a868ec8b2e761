#include "kinematics.h"

#include <math.h>

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

void kinematics_turned(const float rpy[3], const float start[9], float rotation[9])
{
    float turn[9];
    kinematics_rotation(rpy, turn);
    for (uint8_t i = 0; i < 9; i++) {
        const float *row = turn + i / 3 * 3, *column = start + i % 3;
        rotation[i] = row[0] * column[0] + row[1] * column[3] + row[2] * column[6];
    }
}

bool kinematics_cranks(const CrankHexapod *hexapod, const float position[3],
                       const float rotation[9], float cranks[LEGS])
{
    return crank_elbows(&hexapod->legs, position, rotation, cranks, 0) == 0;
}

bool kinematics_is_within_limits(const CrankHexapod *hexapod, const float position[3],
                                 const float cranks[LEGS])
{
    if (!(position[2] >= hexapod->minimum_height))
        return false;
    for (uint8_t i = 0; i < LEGS; i++)
        if (!(cranks[i] >= hexapod->crank_lowest[i] && cranks[i] <= hexapod->crank_highest[i]))
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
