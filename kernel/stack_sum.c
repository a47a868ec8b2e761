#include "stack_sum.h"

#include <string.h>

#include "vector.h"

#define SMALL_ANGLE REAL(1e-4)

/* J with the angular velocity J w' in the fixed frame of exp(w). */
static void left_jacobian(const real w[3], real J[9])
{
    real angle = real_sqrt(dot3(w, w)), square = angle * angle, first = REAL(0.5), second = 1;
    if (angle < SMALL_ANGLE) {
        first -= square / 24;
        second = second / 6 - square / 120;
    } else {
        first = (1 - real_cos(angle)) / square;
        second = (angle - real_sin(angle)) / (square * angle);
    }
    const real k[9] = {0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0};
    real kk[9];
    product9(k, k, kk);
    for (int i = 0; i < 9; i++)
        J[i] = first * k[i] + second * kk[i] + (i % 4 == 0);
}

/* Of a matrix that is a rotation's left Jacobian, below a whole turn. */
static void inverse3(const real m[9], real inverse[9])
{
    real rows[3][3];
    cross3(m + 3, m + 6, rows[0]);
    cross3(m + 6, m, rows[1]);
    cross3(m, m + 3, rows[2]);
    real determinant = dot3(m, rows[0]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            inverse[3 * i + k] = rows[k][i] / determinant;
}

struct stack_placed stack_placed(const struct stack *stack, const struct frame *end,
                                 const real *free)
{
    struct stack_placed p;
    int last = (int)stack->count - 1;
    p.bases[0] = (struct frame){{0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    for (int i = 0; i < last; i++) {
        const struct stack_section *section = &stack->sections[i];
        real twist[6];
        for (int k = 0; k < 6; k++)
            twist[k] = free[6 * i + k] * section->range[k];
        p.sections[i] = section->home;
        se3_move(twist, &p.sections[i]);
        struct frame top = composed(&p.sections[i], &section->after);
        p.bases[i + 1] = composed(&p.bases[i], &top);
    }
    struct frame below = inverted(&p.bases[last]);
    struct frame after = inverted(&stack->sections[last].after);
    struct frame top = composed(end, &after);
    p.sections[last] = composed(&below, &top);
    return p;
}

/* The last section's twist from home, by its range. */
static void put_last(const struct stack *stack, const struct stack_placed *p, real away[6])
{
    int last = (int)stack->count - 1;
    const struct stack_section *section = &stack->sections[last];
    se3_twist(&section->home, &p->sections[last], away);
    for (int k = 0; k < 6; k++)
        away[k] /= section->range[k];
}

real stack_sum(const struct stack *stack, const struct frame *end, const real *free)
{
    struct stack_placed p = stack_placed(stack, end, free);
    real away[6], sum = 0;
    put_last(stack, &p, away);
    for (int k = 0; k < 6 * ((int)stack->count - 1); k++)
        sum += free[k] * free[k];
    for (int k = 0; k < 6; k++)
        sum += away[k] * away[k];
    return sum;
}

/* How the last section's platform moves on its base, in the base's axes, as a free twist of section
   i carries that base; the platform stands still with the end: (9.3). */
static void put_carried(const struct stack *stack, const struct stack_placed *p, int i,
                        const real *free, real carried[6][FREE])
{
    int last = (int)stack->count - 1;
    const real *range = stack->sections[i].range;
    struct frame below = inverted(&p->bases[last]);
    struct frame tip = composed(&p->bases[last], &p->sections[last]);
    struct frame top = composed(&p->bases[i], &p->sections[i]);
    real w[3], J[9], arm[3], turned[9];
    for (int k = 0; k < 3; k++) {
        w[k] = free[6 * i + 3 + k] * range[3 + k];
        arm[k] = tip.position[k] - top.position[k];
    }
    left_jacobian(w, J);
    product9(below.rotation, p->bases[i].rotation, turned);
    rotate3(below.rotation, arm, w);
    for (int c = 0; c < 3; c++) {
        real axis[3] = {J[c] * range[3 + c], J[3 + c] * range[3 + c], J[6 + c] * range[3 + c]};
        real turn[3], swept[3];
        rotate3(turned, axis, turn);
        cross3(turn, w, swept);
        for (int k = 0; k < 3; k++) {
            carried[k][6 * i + c] = -turned[3 * k + c] * range[c];
            carried[3 + k][6 * i + c] = 0;
            carried[k][6 * i + 3 + c] = -swept[k];
            carried[3 + k][6 * i + 3 + c] = -turn[k];
        }
    }
}

static void add_row(struct normal *normal, const real *row, real residual)
{
    for (int i = 0; i < normal->size; i++) {
        normal->gradient[i] += row[i] * residual;
        for (int k = 0; k <= i; k++)
            normal->matrix[i][k] += row[i] * row[k];
    }
    normal->sum += residual * residual;
}

void put_stack_normal(const struct stack *stack, const struct frame *end, const real *free,
                      struct normal *normal)
{
    struct stack_placed p = stack_placed(stack, end, free);
    int last = (int)stack->count - 1;
    const real *range = stack->sections[last].range;
    real carried[6][FREE], away[6], w[3], J[9], inverse[9], row[FREE];
    memset(normal, 0, sizeof *normal);
    normal->size = 6 * last;
    for (int i = 0; i < last; i++)
        put_carried(stack, &p, i, free, carried);
    for (int i = 0; i < normal->size; i++) {
        normal->matrix[i][i] = 1;
        normal->gradient[i] = free[i];
        normal->sum += free[i] * free[i];
    }
    put_last(stack, &p, away);
    for (int k = 0; k < 3; k++)
        w[k] = away[3 + k] * range[3 + k];
    left_jacobian(w, J);
    inverse3(J, inverse);
    for (int k = 0; k < 6; k++) {
        const real *turn = inverse + 3 * (k % 3);
        for (int i = 0; i < normal->size; i++)
            row[i] = (k < 3 ? carried[k][i]
                            : turn[0] * carried[3][i] + turn[1] * carried[4][i] +
                                  turn[2] * carried[5][i]) /
                     range[k];
        add_row(normal, row, away[k]);
    }
}
