/* Displacements: docs/kinematics.md, 3.1. A twist is v, then the rotation vector, both base axes.
   */
#pragma once
#include "vector.h"

/* a b: from b's frame, through a's. */
struct frame composed(const struct frame *a, const struct frame *b);
struct frame inverted(const struct frame *a);

/* A point of the inner frame in the outer one. */
void moved_point(const struct frame *moved, const real point[3], real there[3]);

/* Rodrigues' formula: the rotation by |w| about w. */
void rotation_exp(const real w[3], real rotation[9]);

/* The unit quaternion x, y, z, w of a matrix, w not negative; a quaternion's matrix. */
void quaternion_of(const real rotation[9], real q[4]);
void rotation_of(const real q[4], real rotation[9]);

/* The rotation vector of a matrix, at most pi long. */
void rotation_log(const real rotation[9], real w[3]);

/* p + v and exp(w) R, (3.2): origin and orientation advance each on its own. */
void se3_move(const real twist[6], struct frame *pose);

/* The twist that moves one pose to another. */
void se3_twist(const struct frame *from, const struct frame *to, real twist[6]);
