#include "chain.h"

#include "vector.h"

/* Where a frame that has been displaced takes a point. */
static void moved_point(const struct frame *moved, const real point[3], real there[3])
{
    rotate3(moved->rotation, point, there);
    for (int i = 0; i < 3; i++)
        there[i] += moved->position[i];
}

/* A B. */
static void product9(const real a[9], const real b[9], real product[9])
{
    for (int row = 0; row < 9; row += 3)
        for (int column = 0; column < 3; column++)
            product[row + column] =
                a[row] * b[column] + a[row + 1] * b[3 + column] + a[row + 2] * b[6 + column];
}

/* The rotation by an angle about a unit axis: the upper left of (1.1). */
static void rotation_about(const real w[3], real angle, real rotation[9])
{
    real sine = real_sin(angle), cosine = real_cos(angle), versine = 1 - cosine;
    real x = versine * w[0], y = versine * w[1], z = versine * w[2];
    rotation[0] = cosine + x * w[0];
    rotation[1] = x * w[1] - sine * w[2];
    rotation[2] = x * w[2] + sine * w[1];
    rotation[3] = x * w[1] + sine * w[2];
    rotation[4] = cosine + y * w[1];
    rotation[5] = y * w[2] - sine * w[0];
    rotation[6] = x * w[2] - sine * w[1];
    rotation[7] = y * w[2] + sine * w[0];
    rotation[8] = cosine + z * w[2];
}

/* `moved` times E(angle) of (1.1): the axis stays, so its point tells where the origin goes. */
static void turn_on(struct frame *moved, const real axis[3], const real point[3], real angle)
{
    struct frame before = *moved;
    real turn[9], fixed[3], turned[3];
    rotation_about(axis, angle, turn);
    product9(before.rotation, turn, moved->rotation);
    moved_point(&before, point, fixed);
    rotate3(moved->rotation, point, turned);
    for (int i = 0; i < 3; i++)
        moved->position[i] = fixed[i] - turned[i];
}

static const struct frame UNMOVED = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};

void chain_displacements(const struct chain *chain, const real joints[JOINTS],
                         struct frame moved[JOINTS + 1])
{
    moved[0] = UNMOVED;
    for (int i = 0; i < JOINTS; i++) {
        moved[i + 1] = moved[i];
        turn_on(&moved[i + 1], chain->axis[i], chain->point[i], joints[i]);
    }
}

void chain_posture(const struct chain *chain, const real joints[JOINTS], posture *turned)
{
    struct frame moved = UNMOVED;
    for (int i = 0; i < JOINTS; i++) {
        rotate3(moved.rotation, chain->axis[i], turned->axis[i]);
        moved_point(&moved, chain->point[i], turned->point[i]);
        turn_on(&moved, chain->axis[i], chain->point[i], joints[i]);
    }
    product9(moved.rotation, chain->tool.rotation, turned->tool.rotation);
    moved_point(&moved, chain->tool.position, turned->tool.position);
}

void chain_jacobian(const posture *turned, real jacobian[6 * JOINTS])
{
    for (int i = 0; i < JOINTS; i++) {
        real arm[3], velocity[3];
        for (int k = 0; k < 3; k++)
            arm[k] = turned->tool.position[k] - turned->point[i][k];
        cross3(turned->axis[i], arm, velocity);
        for (int k = 0; k < 3; k++) {
            jacobian[JOINTS * k + i] = velocity[k];
            jacobian[JOINTS * (3 + k) + i] = turned->axis[i][k];
        }
    }
}
