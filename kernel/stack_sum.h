/* The sum (9.2) that a stack makes least, and its slopes: docs/kinematics.md, 9.2. */
#pragma once
#include "stack.h"

enum { FREE = 6 * (MOST_SECTIONS - 1) };

/* Sections on their own bases, and where these stand. */
struct stack_placed {
    struct frame sections[MOST_SECTIONS], bases[MOST_SECTIONS];
};

/* The sum of squares (9.2) as Gauss and Newton take it: J'J, J'r and r'r. */
struct normal {
    int size;
    real matrix[FREE][FREE], gradient[FREE], sum;
};

/* All sections, the last of which closes the gap. free: as for `stack_sections`. */
struct stack_placed stack_placed(const struct stack *stack, const struct frame *end,
                                 const real *free);

real stack_sum(const struct stack *stack, const struct frame *end, const real *free);

void put_stack_normal(const struct stack *stack, const struct frame *end, const real *free,
                      struct normal *normal);
