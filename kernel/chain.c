#include "chain.h"

#include "vector.h"

#include <string.h>

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

/* The rotation of the link before each joint, and where the joint's point is; last, the tool's. */
static void turn_links(const struct chain *chain, const real joints[JOINTS],
                       struct frame links[JOINTS + 1])
{
    links[0] = (struct frame){.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    memcpy(links[0].position, chain->point[0], sizeof links[0].position);
    for (int i = 0; i < JOINTS; i++) {
        const real *next = i + 1 < JOINTS ? chain->point[i + 1] : chain->tool.position;
        real turn[9], length[3];
        rotation_about(chain->axis[i], joints[i], turn);
        product9(links[i].rotation, turn, links[i + 1].rotation);
        minus3(next, chain->point[i], length);
        rotate3(links[i + 1].rotation, length, links[i + 1].position);
        for (int k = 0; k < 3; k++)
            links[i + 1].position[k] += links[i].position[k];
    }
}

void chain_displacements(const struct chain *chain, const real joints[JOINTS],
                         struct frame moved[JOINTS + 1])
{
    turn_links(chain, joints, moved);
    for (int i = 0; i <= JOINTS; i++) {
        real turned[3];
        rotate3(moved[i].rotation, i < JOINTS ? chain->point[i] : chain->tool.position, turned);
        for (int k = 0; k < 3; k++)
            moved[i].position[k] -= turned[k];
    }
}

void displacement(const struct chain *chain, const struct frame *pose, struct frame *moved)
{
    struct frame home = inverted(&chain->tool);
    *moved = composed(pose, &home);
}

void chain_posture(const struct chain *chain, const real joints[JOINTS], posture *turned)
{
    struct frame links[JOINTS + 1];
    turn_links(chain, joints, links);
    for (int i = 0; i < JOINTS; i++) {
        rotate3(links[i].rotation, chain->axis[i], turned->axis[i]);
        memcpy(turned->point[i], links[i].position, sizeof links[i].position);
    }
    turned->tool = links[JOINTS];
    product9(links[JOINTS].rotation, chain->tool.rotation, turned->tool.rotation);
}

void chain_jacobian(const posture *turned, real jacobian[6][JOINTS])
{
    for (int i = 0; i < JOINTS; i++) {
        real arm[3], velocity[3];
        minus3(turned->tool.position, turned->point[i], arm);
        cross3(turned->axis[i], arm, velocity);
        for (int k = 0; k < 3; k++) {
            jacobian[k][i] = velocity[k];
            jacobian[3 + k][i] = turned->axis[i][k];
        }
    }
}

void scale_jacobian(real length, real jacobian[6][JOINTS])
{
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < JOINTS; i++)
            jacobian[k][i] /= length;
}
