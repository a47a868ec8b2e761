/* Six revolute joints in a row: docs/arm-kinematics.md, 1. */
#pragma once
#include "se3.h"

enum { JOINTS = 6 };

/* At zero angles, in base axes: unit axes, a point of each axis, the tool. Metres. */
struct chain {
    real axis[JOINTS][3];
    real point[JOINTS][3];
    struct frame tool;
};

/* The same with the joints turned. */
typedef struct chain posture;

/* How far each link has moved, base first: E1, E1 E2, ... of (1.2). */
void chain_displacements(const struct chain *chain, const real joints[JOINTS],
                         struct frame moved[JOINTS + 1]);

/* D = T M^-1 of (6.1): how far the pose displaces what the last joint carries. */
void displacement(const struct chain *chain, const struct frame *pose, struct frame *moved);

/* Axes, points and tool where the joints take them: (1.2). */
void chain_posture(const struct chain *chain, const real joints[JOINTS], posture *turned);

/* The tool's twist (v, w) in base axes for unit joint rates, six rows of six: (1.3). */
void chain_jacobian(const posture *turned, real jacobian[6][JOINTS]);

/* Divides the metres of a Jacobian by a length. */
void scale_jacobian(real length, real jacobian[6][JOINTS]);
