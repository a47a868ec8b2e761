#include "se3.h"

#include <string.h>

/* Below, in rad, sin(x) / x is 1 to the last digit. */
#define SMALL_ANGLE REAL(1e-6)

void moved_point(const struct frame *moved, const real point[3], real there[3])
{
    rotate3(moved->rotation, point, there);
    for (int i = 0; i < 3; i++)
        there[i] += moved->position[i];
}

struct frame composed(const struct frame *a, const struct frame *b)
{
    struct frame both = {{0}, {0}};
    moved_point(a, b->position, both.position);
    product9(a->rotation, b->rotation, both.rotation);
    return both;
}

struct frame inverted(const struct frame *a)
{
    struct frame back;
    for (int i = 0; i < 9; i++)
        back.rotation[i] = a->rotation[3 * (i % 3) + i / 3];
    rotate3(back.rotation, a->position, back.position);
    for (int i = 0; i < 3; i++)
        back.position[i] = -back.position[i];
    return back;
}

/* I + s [v] + c [v] [v]. */
static void rodrigues(const real v[3], real s, real c, real rotation[9])
{
    real x = v[0], y = v[1], z = v[2];
    rotation[0] = 1 - c * (y * y + z * z);
    rotation[1] = c * x * y - s * z;
    rotation[2] = c * x * z + s * y;
    rotation[3] = c * x * y + s * z;
    rotation[4] = 1 - c * (x * x + z * z);
    rotation[5] = c * y * z - s * x;
    rotation[6] = c * x * z - s * y;
    rotation[7] = c * y * z + s * x;
    rotation[8] = 1 - c * (x * x + y * y);
}

void rotation_exp(const real w[3], real rotation[9])
{
    real angle = real_sqrt(dot3(w, w)), s = 1, c = REAL(0.5);
    if (!(angle < SMALL_ANGLE)) {
        real half = real_sin(angle / 2) / angle;
        s = real_sin(angle) / angle;
        c = 2 * half * half;
    }
    rodrigues(w, s, c, rotation);
}

void rotation_of(const real q[4], real rotation[9])
{
    real c = 2 / (dot3(q, q) + q[3] * q[3]);
    rodrigues(q, c * q[3], c, rotation);
}

/* The longest of the rows of 4 q q' = I + ..., each of which is the unit quaternion x, y, z, w
   times a factor: so that none of its digits are lost (Shepperd 1978). */
void quaternion_of(const real r[9], real q[4])
{
    real trace = r[0] + r[4] + r[8], diagonal[4] = {r[0], r[4], r[8], trace};
    int longest = 0;
    for (int i = 1; i < 4; i++)
        longest = diagonal[i] > diagonal[longest] ? i : longest;
    const real rows[4][4] = {
        {1 + 2 * r[0] - trace, r[1] + r[3], r[2] + r[6], r[7] - r[5]},
        {r[1] + r[3], 1 + 2 * r[4] - trace, r[5] + r[7], r[2] - r[6]},
        {r[2] + r[6], r[5] + r[7], 1 + 2 * r[8] - trace, r[3] - r[1]},
        {r[7] - r[5], r[2] - r[6], r[3] - r[1], 1 + trace},
    };
    const real *row = rows[longest];
    real length = real_sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2] + row[3] * row[3]);
    for (int i = 0; i < 4; i++)
        q[i] = row[i] / (row[3] < 0 ? -length : length);
}

void rotation_log(const real rotation[9], real w[3])
{
    real q[4];
    quaternion_of(rotation, q);
    real sine = real_sqrt(dot3(q, q));
    real scale = sine < SMALL_ANGLE ? 2 : 2 * real_atan2(sine, q[3]) / sine;
    for (int i = 0; i < 3; i++)
        w[i] = scale * q[i];
}

void se3_move(const real twist[6], struct frame *pose)
{
    real turn[9], before[9];
    rotation_exp(twist + 3, turn);
    memcpy(before, pose->rotation, sizeof before);
    product9(turn, before, pose->rotation);
    for (int i = 0; i < 3; i++)
        pose->position[i] += twist[i];
}

void se3_twist(const struct frame *from, const struct frame *to, real twist[6])
{
    real turn[9];
    minus3(to->position, from->position, twist);
    product9_back(to->rotation, from->rotation, turn);
    rotation_log(turn, twist + 3);
}
