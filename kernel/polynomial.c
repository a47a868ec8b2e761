#include "polynomial.h"

#include "subproblems.h"

/* A complex number; of length one, a turn. */
typedef struct turn complex_number;

static complex_number reciprocal(complex_number z)
{
    real square = z.cosine * z.cosine + z.sine * z.sine;
    return (complex_number){z.cosine / square, -z.sine / square};
}

/* z^8 times the series, for exp(i q3) = z: a polynomial of degree 16. */
static void polynomial_of(const struct series *series, complex_number polynomial[ROOTS + 1])
{
    polynomial[DEGREE] = (complex_number){series->cosines[0], 0};
    for (int k = 1; k <= DEGREE; k++) {
        polynomial[DEGREE + k] = (complex_number){series->cosines[k] / 2, -series->sines[k] / 2};
        polynomial[DEGREE - k] = (complex_number){series->cosines[k] / 2, series->sines[k] / 2};
    }
}

/* Newton's step p/p' at z. */
static complex_number newton_step(const complex_number polynomial[ROOTS + 1], complex_number z,
                                  complex_number *derivative)
{
    complex_number value = polynomial[ROOTS], slope = {0, 0};
    for (int k = ROOTS - 1; k >= 0; k--) {
        slope = turn_on(slope, z);
        slope.cosine += value.cosine;
        slope.sine += value.sine;
        value = turn_on(value, z);
        value.cosine += polynomial[k].cosine;
        value.sine += polynomial[k].sine;
    }
    *derivative = slope;
    return turn_on(value, reciprocal(slope));
}

static real size_of(complex_number z)
{
    return real_sqrt(z.cosine * z.cosine + z.sine * z.sine);
}

/* How far the errors of the coefficients may have moved a root. */
static real blur(const complex_number polynomial[ROOTS + 1], real error, complex_number root)
{
    complex_number slope;
    newton_step(polynomial, root, &slope);
    return error / size_of(slope);
}

/* All roots at once (Aberth 1973): Newton's steps, each kept away from the other roots. */
static void all_roots(const complex_number polynomial[ROOTS + 1], complex_number roots[ROOTS])
{
    enum { MOST_STEPS = 30 };
    const real arrived = REAL(1e-10);
    int is_there[ROOTS] = {0};
    for (int k = 0; k < ROOTS; k++)
        roots[k] = turn_by(REAL(0.1) + REAL_TURN * (real)k / ROOTS);
    for (int step = 0, moving = 1; moving && step < MOST_STEPS; step++) {
        moving = 0;
        for (int k = 0; k < ROOTS; k++) {
            if (is_there[k])
                continue;
            complex_number slope, newton = newton_step(polynomial, roots[k], &slope), sum = {0, 0};
            for (int j = 0; j < ROOTS; j++)
                if (j != k) {
                    complex_number away = reciprocal(
                        (complex_number){roots[k].cosine - roots[j].cosine,
                                         roots[k].sine - roots[j].sine});
                    sum.cosine += away.cosine;
                    sum.sine += away.sine;
                }
            sum = turn_on(newton, sum);
            sum = turn_on(newton, reciprocal((complex_number){1 - sum.cosine, -sum.sine}));
            if (!isfinite(sum.cosine + sum.sine))
                continue;
            roots[k].cosine -= sum.cosine;
            roots[k].sine -= sum.sine;
            is_there[k] = real_fabs(sum.cosine) + real_fabs(sum.sine) < arrived;
            moving |= !is_there[k];
        }
    }
}

static real distance(complex_number a, complex_number b)
{
    return size_of((complex_number){a.cosine - b.cosine, a.sine - b.sine});
}

int series_roots(const struct series *series, real angles[ROOTS], real rooms[ROOTS],
                 int *are_certain)
{
    const real certain = REAL(1e-4), aside = REAL(0.1);
    const real nearly = REAL(0.05), rounding = REAL(1e-4);
    complex_number polynomial[ROOTS + 1], roots[ROOTS];
    int count = 0;
    polynomial_of(series, polynomial);
    real error = (ROOTS + 1) * series->error;
    for (int k = 0; k <= ROOTS; k++)
        error += 10 * REAL_EPSILON * size_of(polynomial[k]);
    all_roots(polynomial, roots);
    *are_certain = 1;
    for (int k = 0; k < ROOTS; k++) {
        real size = size_of(roots[k]), moved = blur(polynomial, error, roots[k]);
        /* Roots beside the circle are pairs z, 1/z*: one is enough. */
        if (!(size > 1 - nearly && size < 1 + rounding)) {
            *are_certain &= moved < aside * real_fabs(1 - size);
            continue;
        }
        rooms[count] = 1;
        for (int j = 0; j < ROOTS; j++)
            if (j != k && distance(roots[j], roots[k]) < rooms[count])
                rooms[count] = distance(roots[j], roots[k]);
        *are_certain &= moved < certain * rooms[count];
        angles[count++] = turn_angle(roots[k]);
    }
    return count;
}
