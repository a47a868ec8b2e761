#include "subproblems.h"

/* Relative overshoot that counts as rounding: 1e-9 of a 1 m reach is a nanometre. */
#define SLACK REAL(1e-9)
/* Product of the sines of two vectors' angles to an axis, below which they lie on it. */
#define ON_AXIS REAL(1e-15)

static struct turn direction(real cosine, real sine)
{
    real square = cosine * cosine + sine * sine, inverse = 1 / real_sqrt(square);
    return square > 0 ? (struct turn){cosine * inverse, sine * inverse} : (struct turn){1, 0};
}

struct turn facing(const real k[3], const real vector[3], const real target[3], struct turn free)
{
    real across[3];
    cross3(k, vector, across);
    real sine = dot3(target, across);
    real cosine = dot3(target, vector) - dot3(target, k) * dot3(vector, k);
    real sizes = dot3(vector, vector) * dot3(target, target);
    if (sine * sine + cosine * cosine <= ON_AXIS * ON_AXIS * sizes)
        return free;
    return direction(cosine, sine);
}

int projections(const real k[3], const real vector[3], const real onto[3], real value,
                struct turn free, struct turn both[2])
{
    real across[3];
    cross3(k, vector, across);
    real along = dot3(onto, k) * dot3(vector, k);
    real a = dot3(onto, vector) - along, b = dot3(onto, across), c = value - along;
    real radius = real_sqrt(a * a + b * b);
    real slack = SLACK * real_sqrt(dot3(onto, onto) * dot3(vector, vector)) + ON_AXIS;
    if (radius < slack && real_fabs(c) < slack) {
        both[0] = both[1] = free;
        return 1;
    }
    if (!(real_fabs(c) <= radius + slack))
        return 0;
    real below = (radius - c) * (radius + c);
    struct turn middle = direction(a, b), half = direction(c, below > 0 ? real_sqrt(below) : 0);
    both[0] = turn_on(middle, half);
    both[1] = turn_on(middle, turn_back(half));
    return 1;
}

int distances(const real k[3], const real vector[3], const real point[3], real square,
              struct turn free, struct turn both[2])
{
    real value = (dot3(vector, vector) + dot3(point, point) - square) / 2;
    return projections(k, vector, point, value, free, both);
}

void perpendicular(const real k[3], real across[3])
{
    int least = 0;
    for (int i = 1; i < 3; i++)
        if (real_fabs(k[i]) < real_fabs(k[least]))
            least = i;
    real other[3] = {least == 0, least == 1, least == 2};
    cross3(k, other, across);
    real size = real_sqrt(dot3(across, across));
    for (int i = 0; i < 3; i++)
        across[i] /= size;
}
