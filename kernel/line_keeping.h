/* Joint rates that keep the tool on its line: docs/arm-kinematics.md, 8. */
#pragma once
#include "chain.h"
#include "matrix6.h"

/* The Jacobian with its metres divided by the arm's length, J = U S V': 8.1. Twists are scaled
   alike. */
struct decomposed {
    real jacobian[6][JOINTS];
    struct svd6 svd;
};

void decompose(const struct chain *chain, real length, const real joints[JOINTS],
               struct decomposed *at);

/* The tool's acceleration at constant joint rates, the J' q' of 8.1: (8.2). */
void turning(const struct decomposed *at, const real rates[JOINTS], real acceleration[6]);

/* What a twist needs of the joints: see `LineRates` in arm_control/line_keeping.py. */
struct line {
    real rates[JOINTS];
    real bend[JOINTS];
    real along[JOINTS];
    real is_lost;
};

/* Undamped rates for a twist and, where `off_line` is not null, back to its line: 8.1 and 8.2. */
void line_rates(const struct decomposed *at, real onset, const real twist[6], const real *off_line,
                struct line *line);

/* Rates whose gain is bounded to 1.3/onset: (8.1). */
void damped_rates(const struct decomposed *at, real onset, const real twist[6],
                  real rates[JOINTS]);

/* The tool's twist at these rates; the part of `twist` that it has, and what of it was missed: 8.2.
   */
real part_driven(const struct decomposed *at, const real twist[6], const real rates[JOINTS],
                 real missed[6], real moving[6]);
