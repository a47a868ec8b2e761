#include <string.h>

#include "cholesky.h"
#include "stack_sum.h"

enum { MOST_STEPS = 30, MOST_CUTS = 6 };
/* A step this short, in the sections' ranges, is the last. */
#define SETTLED REAL(1e-9)
/* Sums that differ by less are equal. */
#define EQUAL REAL(1e-12)
/* Of the sections' ranges, for second slopes. */
#define DIFFERENCE REAL(1e-6)
/* From one step to the next. */
#define SHRINKING REAL(0.2)

/* The Hessian of half the sum by differences of its gradient, into the lower triangle of `matrix`.
   J'J is no substitute for it: where sections are far from home, steps by it alternate for ever. */
static void put_hessian(const struct stack *stack, const struct frame *end, const real *free,
                        const struct normal *here, real matrix[FREE][FREE])
{
    real moved[FREE];
    struct normal there;
    memcpy(moved, free, (size_t)here->size * sizeof *free);
    for (int i = 0; i < here->size; i++) {
        moved[i] = free[i] + DIFFERENCE;
        put_stack_normal(stack, end, moved, &there);
        for (int k = 0; k <= i; k++)
            matrix[i][k] = (there.gradient[k] - here->gradient[k]) / DIFFERENCE;
        moved[i] = free[i];
    }
}

/* step = -(L L')^-1 gradient. Returns its longest component. */
static real solve(int size, real L[FREE][FREE], const real gradient[FREE], real step[FREE])
{
    real longest = 0;
    for (int i = 0; i < size; i++)
        step[i] = -gradient[i];
    divide_by_factor(size, FREE, L[0], step);
    divide_by_transposed(size, FREE, L[0], step);
    for (int i = 0; i < size; i++)
        longest = fmax(longest, real_fabs(step[i]));
    return longest;
}

/* Goes along the step as far as the sum does not grow; 0 where it grows at once. */
static int advance(const struct stack *stack, const struct frame *end,
                   const struct normal *normal, const real step[FREE], real *free)
{
    real share = 1, trial[FREE];
    for (int cut = 0; cut < MOST_CUTS; cut++, share /= 3) {
        for (int k = 0; k < normal->size; k++)
            trial[k] = free[k] + share * step[k];
        if (stack_sum(stack, end, trial) <= normal->sum * (1 + EQUAL)) {
            memcpy(free, trial, (size_t)normal->size * sizeof *free);
            return 1;
        }
    }
    return 0;
}

/* A Hessian serves as long as steps shrink well with it. Returns whether the descent settled. */
static int descended(const struct stack *stack, const struct frame *end, real *free)
{
    struct normal normal;
    real L[FREE][FREE] = {{0}}, step[FREE], before = 0;
    for (int tries = 0; tries < MOST_STEPS; tries++) {
        put_stack_normal(stack, end, free, &normal);
        real longest = before > 0 ? solve(normal.size, L, normal.gradient, step) : INFINITY;
        if (!(longest <= SHRINKING * before)) {
            put_hessian(stack, end, free, &normal, L);
            if (!factorise(normal.size, FREE, L[0], 0)) {
                memcpy(L, normal.matrix, sizeof L);
                factorise(normal.size, FREE, L[0], 0); /* J'J is at least the unit matrix */
            }
            longest = solve(normal.size, L, normal.gradient, step);
        }
        if (!advance(stack, end, &normal, step, free))
            return longest < SETTLED;
        if (longest < SETTLED)
            return 1;
        before = longest;
    }
    return 0;
}

int stack_sections(const struct stack *stack, const struct frame *end, real *free,
                   struct frame sections[MOST_SECTIONS])
{
    int is_settled = stack->count == 1 || descended(stack, end, free);
    struct stack_placed p = stack_placed(stack, end, free);
    memcpy(sections, p.sections, (size_t)stack->count * sizeof *sections);
    return is_settled;
}
