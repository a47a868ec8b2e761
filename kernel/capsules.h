/* How far apart the parts of a machine are, and how far from what stands around it.

   A part is a capsule, all points within a radius of a segment; here are the distances of the
   segments, from which the radii are subtracted: docs/kinematics.md, 11. */
#pragma once
#include "real.h"

/* A box with edges along the axes: side is +1 for one to stay in, -1 for one to stay out of. */
struct box {
    real side;
    real low[3], high[3];
};

/* Between two segments, each given by its ends; NaN where one of them is. */
real segment_distance(const real first[6], const real second[6]);

/* How far a segment may move in any direction before it breaks the rule of the box; where it is
   broken, minus how far it must move. NaN where the segment is. */
real box_clearance(const real segment[6], const struct box *box);
