#include "stack_model.h"

#include <string.h>

#include "se3.h"
#include "vector.h"

/* Of a section's range, by which it is moved for the slopes of its margins. */
#define DIFFERENCE REAL(1e-6)
#define SMALL_ANGLE REAL(1e-4)

struct lacks {
    real of[2][VALUES];
};

static void multiply(const real a[9], const real b[9], real product[9])
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            product[3 * i + k] =
                a[3 * i] * b[k] + a[3 * i + 1] * b[3 + k] + a[3 * i + 2] * b[6 + k];
}

static struct placement composed(const struct placement *a, const struct placement *b)
{
    struct placement c;
    rotate3(a->rotation, b->position, c.position);
    for (int k = 0; k < 3; k++)
        c.position[k] += a->position[k];
    multiply(a->rotation, b->rotation, c.rotation);
    return c;
}

static struct placement inverted(const struct placement *a)
{
    struct placement b;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            b.rotation[3 * i + k] = a->rotation[3 * k + i];
    rotate3(b.rotation, a->position, b.position);
    for (int k = 0; k < 3; k++)
        b.position[k] = -b.position[k];
    return b;
}

static struct placement moved(const struct placement *from, const real twist[6])
{
    struct placement to = *from;
    se3_move(twist, to.position, to.rotation);
    return to;
}

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
    multiply(k, k, kk);
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

void stack_place(const struct stack *stack, const struct placement *end, const real *free,
                 struct placement sections[MOST_SECTIONS], struct placement bases[MOST_SECTIONS])
{
    int last = (int)stack->count - 1;
    bases[0] = (struct placement){{0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    for (int i = 0; i < last; i++) {
        const struct stack_section *section = &stack->sections[i];
        real twist[6];
        for (int k = 0; k < 6; k++)
            twist[k] = free[6 * i + k] * section->range[k];
        sections[i] = moved(&section->home, twist);
        struct placement top = composed(&sections[i], &section->after);
        bases[i + 1] = composed(&bases[i], &top);
    }
    struct placement below = inverted(&bases[last]), after = inverted(&stack->sections[last].after);
    struct placement top = composed(end, &after);
    sections[last] = composed(&below, &top);
}

/* What lacks in each margin, by that at home and weighed; 0 for a value that does not exist. */
static real lacks_at(const struct stack *stack, int index, const struct placement *at,
                     struct lacks *lacks)
{
    const struct stack_section *section = &stack->sections[index];
    real joints[LEGS], values[VALUES], sum = 0, weight = real_sqrt(stack->stiffness);
    if (weight == 0)
        return 0;
    if (section->platform.legs.crank[0] > 0)
        crank_inverse(&section->platform.legs, at->position, at->rotation, NULL, joints);
    else
        linear_inverse(&section->platform.legs, at->position, at->rotation, joints);
    limited_values(&section->platform, at->position, at->rotation, joints, values);
    for (int end = 0; end < 2; end++)
        for (int k = 0; k < VALUES; k++) {
            real home = section->margin[end][k], lack = 0;
            if (home > 0) {
                real left = end ? section->bound[1][k] - values[k]
                                : values[k] - section->bound[0][k];
                lack = stack->spare - left / home;
            }
            lacks->of[end][k] = lack > 0 ? weight * lack : 0;
            sum += lacks->of[end][k] * lacks->of[end][k];
        }
    return sum;
}

/* The last section's twist from home, by its range. */
static void relative(const struct stack_section *section, const struct placement *at, real twist[6])
{
    const struct placement *home = &section->home;
    se3_twist(home->position, home->rotation, at->position, at->rotation, twist);
    for (int k = 0; k < 6; k++)
        twist[k] /= section->range[k];
}

real stack_cost(const struct stack *stack, const struct placement *end, const real *free)
{
    struct placement sections[MOST_SECTIONS], bases[MOST_SECTIONS];
    struct lacks lacks;
    int last = (int)stack->count - 1;
    real away[6], sum = 0;
    stack_place(stack, end, free, sections, bases);
    relative(&stack->sections[last], &sections[last], away);
    for (int k = 0; k < 6 * last; k++)
        sum += free[k] * free[k];
    for (int k = 0; k < 6; k++)
        sum += away[k] * away[k];
    for (int i = 0; i <= last; i++)
        sum += lacks_at(stack, i, &sections[i], &lacks);
    return sum;
}

/* How the twists of every section's pose, in its own base's axes, follow the free twists. The last
   section's base is carried by those before, its platform stands still with the end. */
static void put_slopes(const struct stack *stack, const struct placement *end, const real *free,
                       const struct placement *sections, const struct placement *bases,
                       real slopes[MOST_SECTIONS][6][SIZE])
{
    int last = (int)stack->count - 1;
    struct placement below = inverted(&bases[last]), after = inverted(&stack->sections[last].after);
    struct placement tip = composed(end, &after);
    memset(slopes, 0, sizeof(real[MOST_SECTIONS][6][SIZE]));
    for (int i = 0; i < last; i++) {
        const real *range = stack->sections[i].range;
        struct placement top = composed(&bases[i], &sections[i]);
        real w[3], J[9], arm[3];
        for (int k = 0; k < 3; k++) {
            w[k] = free[6 * i + 3 + k] * range[3 + k];
            arm[k] = tip.position[k] - top.position[k];
        }
        left_jacobian(w, J);
        for (int c = 0; c < 3; c++) {
            real along[3] = {0}, turn[3], in_base[3], swept[3];
            int v = 6 * i + c, o = v + 3;
            slopes[i][c][v] = along[c] = range[c];
            for (int k = 0; k < 3; k++)
                slopes[i][3 + k][o] = turn[k] = J[3 * k + c] * range[3 + c];
            rotate3(bases[i].rotation, along, in_base);
            rotate3(below.rotation, in_base, swept);
            for (int k = 0; k < 3; k++)
                slopes[last][k][v] = -swept[k];
            rotate3(bases[i].rotation, turn, in_base);
            cross3(in_base, arm, along);
            rotate3(below.rotation, along, swept);
            rotate3(below.rotation, in_base, turn);
            for (int k = 0; k < 3; k++) {
                slopes[last][k][o] = -swept[k];
                slopes[last][3 + k][o] = -turn[k];
            }
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
    normal->cost += residual * residual;
}

/* row = slope (6) times how the section's twist follows the free twists (6, SIZE). */
static void chain(const real slope[6], const real moves[6][SIZE], int size, real row[SIZE])
{
    for (int i = 0; i < size; i++) {
        row[i] = 0;
        for (int k = 0; k < 6; k++)
            row[i] += slope[k] * moves[k][i];
    }
}

static void add_last(const struct stack_section *section, const struct placement *at,
                     const real moves[6][SIZE], struct normal *normal)
{
    real away[6], w[3], J[9], inverse[9], row[SIZE];
    relative(section, at, away);
    for (int k = 0; k < 3; k++)
        w[k] = away[3 + k] * section->range[3 + k];
    left_jacobian(w, J);
    inverse3(J, inverse);
    for (int k = 0; k < 6; k++) {
        real slope[6] = {0};
        if (k < 3)
            slope[k] = 1 / section->range[k];
        else
            for (int c = 0; c < 3; c++)
                slope[3 + c] = inverse[3 * (k - 3) + c] / section->range[k];
        chain(slope, moves, normal->size, row);
        add_row(normal, row, away[k]);
    }
}

static void add_lacks(const struct stack *stack, int index, const struct placement *at,
                      const real moves[6][SIZE], struct normal *normal)
{
    struct lacks here, ahead[6];
    const real *range = stack->sections[index].range;
    if (lacks_at(stack, index, at, &here) == 0)
        return;
    for (int k = 0; k < 6; k++) {
        real twist[6] = {0};
        twist[k] = DIFFERENCE * range[k];
        struct placement there = moved(at, twist);
        lacks_at(stack, index, &there, &ahead[k]);
    }
    for (int j = 0; j < 2 * VALUES; j++) {
        real slope[6], row[SIZE], lack = here.of[0][j];
        if (lack == 0)
            continue;
        for (int k = 0; k < 6; k++)
            slope[k] = (ahead[k].of[0][j] - lack) / (DIFFERENCE * range[k]);
        chain(slope, moves, normal->size, row);
        add_row(normal, row, lack);
    }
}

void put_stack_normal(const struct stack *stack, const struct placement *end, const real *free,
                      struct normal *normal)
{
    struct placement sections[MOST_SECTIONS], bases[MOST_SECTIONS];
    real slopes[MOST_SECTIONS][6][SIZE];
    int last = (int)stack->count - 1;
    memset(normal, 0, sizeof *normal);
    normal->size = 6 * last;
    stack_place(stack, end, free, sections, bases);
    put_slopes(stack, end, free, sections, bases, slopes);
    for (int i = 0; i < normal->size; i++) {
        normal->matrix[i][i] += 1;
        normal->gradient[i] += free[i];
        normal->cost += free[i] * free[i];
    }
    add_last(&stack->sections[last], &sections[last], slopes[last], normal);
    for (int i = 0; i <= last; i++)
        add_lacks(stack, i, &sections[i], slopes[i], normal);
}
