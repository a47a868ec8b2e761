#include "stack_model.h"

#include <string.h>

enum { MOST_STEPS = 60, MOST_STEPS_NEAR = 30, MOST_CUTS = 10 };
/* A step this short, in the sections' ranges, is the last; so is a longer one that does not make
   the cost fall. Costs that differ by less are equal. */
#define SETTLED REAL(3e-6)
#define ALMOST_SETTLED REAL(3e-5)
/* A step that is still as long after the most steps is tolerated: the end is met all the same. */
#define TOLERATED REAL(3e-4)
#define EQUAL REAL(1e-12)
/* Of a step to the one before it, between which it is lengthened. */
#define LEAST_RATIO REAL(0.3)
#define MOST_RATIO REAL(0.97)

/* step = -(J'J)^-1 J'r by Cholesky; the matrix is at least the unit matrix. */
static void solve(struct normal *normal, real step[SIZE])
{
    int size = normal->size;
    real(*L)[SIZE] = normal->matrix;
    for (int i = 0; i < size; i++)
        for (int k = 0; k <= i; k++) {
            real sum = L[i][k];
            for (int j = 0; j < k; j++)
                sum -= L[i][j] * L[k][j];
            L[i][k] = i == k ? real_sqrt(sum) : sum / L[k][k];
        }
    for (int i = 0; i < size; i++) {
        step[i] = -normal->gradient[i];
        for (int j = 0; j < i; j++)
            step[i] -= L[i][j] * step[j];
        step[i] /= L[i][i];
    }
    for (int i = size - 1; i >= 0; i--) {
        for (int j = i + 1; j < size; j++)
            step[i] -= L[j][i] * step[j];
        step[i] /= L[i][i];
    }
}

static real longest_of(const real *step, int size)
{
    real longest = 0;
    for (int k = 0; k < size; k++)
        longest = fmax(longest, real_fabs(step[k]));
    return longest;
}

/* By how much a step is worth lengthening that follows another in the same direction, as steps do
   that converge linearly: the sum of the geometric series. */
static real lengthening(int size, const real step[SIZE], const real before[SIZE])
{
    real along = 0, square = 0;
    for (int k = 0; k < size; k++) {
        along += step[k] * before[k];
        square += before[k] * before[k];
    }
    real ratio = square > 0 ? along / square : 0;
    return ratio > LEAST_RATIO && ratio < MOST_RATIO ? 1 / (1 - ratio) : 1;
}

static real tried(const struct stack *stack, const struct placement *end, int size, real share,
                  const real step[SIZE], const real *free, real trial[SIZE])
{
    for (int k = 0; k < size; k++)
        trial[k] = free[k] + share * step[k];
    return stack_cost(stack, end, trial);
}

/* Goes along the step as far as the cost falls, at first `longer` than it; whether that was the
   last. */
static int advance(const struct stack *stack, const struct placement *end, real before, int size,
                   const real step[SIZE], real longer, real *free)
{
    real share = 1, longest = longest_of(step, size), trial[SIZE], far[SIZE];
    real least = before * (1 + EQUAL);
    for (int cut = 0; cut < MOST_CUTS; cut++, share /= 3) {
        real found = tried(stack, end, size, share, step, free, trial);
        if (!(found <= least))
            continue;
        int is_longer =
            longer > 1 && cut == 0 && tried(stack, end, size, longer, step, free, far) < found;
        memcpy(free, is_longer ? far : trial, (size_t)size * sizeof *free);
        return longest < SETTLED;
    }
    return longest < ALMOST_SETTLED;
}

/* Whether the descent came to its end. */
static int descended(const struct stack *stack, const struct placement *end, int most, real *free)
{
    struct normal normal;
    real step[SIZE] = {0}, last[SIZE];
    for (int tries = 0; tries < most; tries++) {
        memcpy(last, step, sizeof last);
        put_stack_normal(stack, end, free, &normal);
        solve(&normal, step);
        real longer = lengthening(normal.size, step, last);
        if (advance(stack, end, normal.cost, normal.size, step, longer, free))
            return 1;
        if (longer > 1)
            memset(step, 0, sizeof step);
    }
    put_stack_normal(stack, end, free, &normal);
    solve(&normal, step);
    real longest = longest_of(step, normal.size);
    return advance(stack, end, normal.cost, normal.size, step, 1, free) || longest < TOLERATED;
}

/* From home, at first without the limits. */
static int descended_from_home(const struct stack *stack, const struct placement *end, real *free)
{
    struct stack unlimited = *stack;
    unlimited.stiffness = 0;
    memset(free, 0, 6 * ((size_t)stack->count - 1) * sizeof *free);
    descended(&unlimited, end, MOST_STEPS, free);
    return descended(stack, end, MOST_STEPS, free);
}

int stack_sections(const struct stack *stack, const struct placement *end, enum stack_start start,
                   real *free, struct placement sections[MOST_SECTIONS])
{
    struct placement bases[MOST_SECTIONS];
    int is_settled = stack->count == 1;
    if (!is_settled && start != FROM_HOME)
        is_settled = descended(stack, end, MOST_STEPS_NEAR, free);
    if (!is_settled && start != ALONG)
        is_settled = descended_from_home(stack, end, free);
    stack_place(stack, end, free, sections, bases);
    return is_settled;
}
