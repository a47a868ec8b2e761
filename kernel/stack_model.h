/* The sum (9.3) of docs/kinematics.md that a stack makes least. free: the twists from home by range,
   six for each section but the last. */
#ifndef KERNEL_STACK_MODEL_H
#define KERNEL_STACK_MODEL_H

#include "stack.h"

enum { SIZE = 6 * (MOST_SECTIONS - 1) };

/* The sum of squares (9.3) as Gauss and Newton take it: J'J, J'r and r'r. */
struct normal {
    int size;
    real matrix[SIZE][SIZE], gradient[SIZE], cost;
};

/* All sections, the last closing the gap; bases are where they stand. */
void stack_place(const struct stack *stack, const struct placement *end, const real *free,
                 struct placement sections[MOST_SECTIONS], struct placement bases[MOST_SECTIONS]);

real stack_cost(const struct stack *stack, const struct placement *end, const real *free);

void put_stack_normal(const struct stack *stack, const struct placement *end, const real *free,
                      struct normal *normal);

#endif
