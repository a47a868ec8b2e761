/* A platform's limits about one place, and distances from it: docs/workspace.md, 1 and 2. */
#pragma once
#include "descent.h"
#include "se3.h"

enum { BOUNDS = 2 * VALUES };

/* The limits about a place, in metres: normal[i] step + slack[i] >= 0; row[i] says which margin it
   is. Those that stand still or have no value are left out. */
struct model {
    real goal[6]; /* the step to the target */
    int count, row[BOUNDS];
    real steepness[BOUNDS], slack[BOUNDS], normal[BOUNDS][6];
};

struct frame displaced(const struct descent *d, struct frame from, const real step[6]);

/* The step (6) from a place to a pose, in metres. */
void put_offset(const struct descent *d, const struct frame *from, const struct frame *to,
                real offset[6]);

/* How far inside the ranges values are, from below, then from above; NaN where there is none. */
void put_margins(const struct descent *d, const struct frame *place, real margins[BOUNDS]);

/* By differences in all six directions, to one side where the other has no value. */
void put_model(const struct descent *d, const struct frame *place, struct model *model);
