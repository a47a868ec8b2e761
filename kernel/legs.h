/* Six legs of one kind between base and platform: docs/kinematics.md, 1, 2, 8 and 10. */
#pragma once
#include "crank.h"
#include "screws.h"

/* Leg i closes where |P - p(q)| = d, P its end on the platform. The kinds differ in what a joint q
   moves, with c, t, e, r and d the centre, tangent, up, crank and rod of its shape:

       LINEAR   p = c,                            d = q, less what its screw adds
       CRANK    p = c + r (cos q t + sin q e)
       RAIL     p = c + r q t,                    r = 1 or -1, t towards the platform's joint */
enum leg_kind { LINEAR, CRANK, RAIL };

struct legs {
    struct crank_legs shape;
    real kind;
    struct screws screws; /* of linear legs; lead 0: none */
};

/* The joints of one pose, by (2.4), (8.1) or (10.2): `out` as cranks with the elbow out, and
   carriages behind the platform's joint along t; `in` the other way, if not null; lengths have no
   other way. NaN for a leg that does not close. Returns how many do not. */
int leg_branches(const struct legs *legs, const real position[3], const real rotation[9],
                 real out[LEGS], real *in);

/* As `out`, or where `near` (6) is not null, of both ways the joint nearest to it, a crank's modulo
   turns: 2.3. NaN, and counted, is a leg that does not close or has nothing finite to be near. */
int leg_inverse(const struct legs *legs, const real position[3], const real rotation[9],
                const real *near, real joints[LEGS]);

/* p: where rods begin, (1.1) and (10.1). */
void leg_points(const struct legs *legs, const real joints[LEGS], real points[3][LEGS]);

/* q of linear legs, and d of others. */
void leg_lengths(const struct legs *legs, const real joints[LEGS], real lengths[LEGS]);

/* J of (4.1), row i of which says how fast rod i grows with a twist while its base point stands;
   with what screws add for linear legs. Rotations are divided by `length`. */
void leg_rows(const struct legs *legs, const struct rods *rods, const real rotation[9], real length,
              real columns[6][LEGS]);

/* How fast each rod's length follows its joint, (4.1); `unit` as in struct rods. */
void leg_gains(const struct legs *legs, const real joints[LEGS], real unit[3][LEGS],
               real gains[LEGS]);

/* How much too short, and too long, each rod is to close its leg, (2.3) and 10.1; -NEVER where it
   never is. */
#define NEVER REAL(1e9) /* m; finite, so that margins to no bound are no NaN */
void leg_misfits(const struct legs *legs, const real position[3], const real rotation[9],
                 real shortfall[LEGS], real surplus[LEGS]);
