/* The point of a polyhedron nearest to another: docs/workspace.md, (2.1). */
#pragma once
#include <stddef.h>

#include "real.h"

/* Multipliers m_i >= 0 so that y = target + sum m_i normal_i is the point nearest to `target` with
   normal_i y + slack_i >= 0 for all i: Lawson and Hanson, Solving Least Squares Problems, 23.
   Returns 0 where there is no such point, or none is found. */
int least_distance(const real target[6], const real (*normals)[6], const real *slack,
                   ptrdiff_t count, real *multipliers);
