/* Distances of segments to segments and boxes: docs/kinematics.md, 11. */
#include "capsules.h"

#include <math.h>

#include "vector.h"

enum { SECTIONS = 45 /* of a golden section: what is left is 4e-10 of the segment */ };

static const real GOLDEN = (real)0.6180339887498949;
static const real PARALLEL = (real)1e-12; /* sine squared below which lines count as parallel */

static void point_on(const real segment[6], real share, real point[3])
{
    for (int i = 0; i < 3; i++)
        point[i] = segment[i] + share * (segment[3 + i] - segment[i]);
}

static real gap(const real a[3], const real b[3])
{
    real vector[3];
    minus3(b, a, vector);
    return real_sqrt(dot3(vector, vector));
}

static real clamped(real share)
{
    return share < 0 ? 0 : share > 1 ? 1 : share;
}

static real point_distance(const real point[3], const real segment[6])
{
    real along[3], to_point[3], foot[3];
    minus3(segment + 3, segment, along);
    minus3(point, segment, to_point);
    real square = dot3(along, along);
    point_on(segment, square > 0 ? clamped(dot3(to_point, along) / square) : 0, foot);
    return gap(point, foot);
}

/* Between the lines where they come nearest within both segments, (11.1); else infinite. */
static real crossing_distance(const real first[6], const real second[6])
{
    real u[3], v[3], w[3], a[3], b[3];
    minus3(first + 3, first, u);
    minus3(second + 3, second, v);
    minus3(first, second, w);
    real uu = dot3(u, u), uv = dot3(u, v), vv = dot3(v, v), uw = dot3(u, w), vw = dot3(v, w);
    real determinant = uu * vv - uv * uv;
    if (!(determinant > PARALLEL * uu * vv))
        return (real)INFINITY;
    real s = (uv * vw - vv * uw) / determinant, t = (uu * vw - uv * uw) / determinant;
    if (s < 0 || s > 1 || t < 0 || t > 1)
        return (real)INFINITY;
    point_on(first, s, a);
    point_on(second, t, b);
    return gap(a, b);
}

static int is_known(const real segment[6])
{
    real sum = 0;
    for (int i = 0; i < 6; i++)
        sum += segment[i];
    return isfinite(sum);
}

real segment_distance(const real first[6], const real second[6])
{
    if (!is_known(first) || !is_known(second))
        return (real)NAN;
    const real found[] = {
        point_distance(first, second),      point_distance(first + 3, second),
        point_distance(second, first),      point_distance(second + 3, first),
        crossing_distance(first, second),
    };
    real least = found[0];
    for (int i = 1; i < 5; i++)
        least = found[i] < least ? found[i] : least;
    return least;
}

/* Of a point from a box, minus its depth within: a convex function of the point. */
static real outside(const real point[3], const struct box *box)
{
    real squares = 0, most = -(real)INFINITY;
    for (int i = 0; i < 3; i++) {
        real below = box->low[i] - point[i], above = point[i] - box->high[i];
        real beyond = below > above ? below : above;
        most = beyond > most ? beyond : most;
        squares += beyond > 0 ? beyond * beyond : 0;
    }
    return most > 0 ? real_sqrt(squares) : most;
}

static real outside_at(const real segment[6], real share, const struct box *box)
{
    real point[3];
    point_on(segment, share, point);
    return outside(point, box);
}

/* The least of a convex function along the segment. */
static real least_outside(const real segment[6], const struct box *box)
{
    real low = 0, high = 1, left = 1 - GOLDEN, right = GOLDEN;
    real at_left = outside_at(segment, left, box), at_right = outside_at(segment, right, box);
    for (int i = 0; i < SECTIONS; i++) {
        if (at_left < at_right) {
            high = right, right = left, at_right = at_left;
            left = high - GOLDEN * (high - low);
            at_left = outside_at(segment, left, box);
        } else {
            low = left, left = right, at_left = at_right;
            right = low + GOLDEN * (high - low);
            at_right = outside_at(segment, right, box);
        }
    }
    real ends[] = {outside(segment, box), outside(segment + 3, box)};
    real end = ends[0] < ends[1] ? ends[0] : ends[1];
    return at_left < end ? at_left : end;
}

/* Of a segment within a box: its ends are nearest to the sides. */
static real room_inside(const real segment[6], const struct box *box)
{
    real room = (real)INFINITY;
    for (int i = 0; i < 6; i++) {
        real up = segment[i] - box->low[i % 3], down = box->high[i % 3] - segment[i];
        real less = up < down ? up : down;
        room = less < room ? less : room;
    }
    return room;
}

real box_clearance(const real segment[6], const struct box *box)
{
    if (!is_known(segment))
        return (real)NAN;
    return box->side > 0 ? room_inside(segment, box) : least_outside(segment, box);
}
