#include "newton.h"

#include "matrix6.h"
#include "rods.h"
#include "se3.h"

/* Rods left 1e-11 m apart leave the pose within 1e-11 m / sigma, and that by the characteristic
   length in rad: 3e-8 mm and 5e-10 rad for sigma = 0.3 and 70 mm. */
#define TOLERANCE REAL(1e-11)
#define LARGEST_TURN REAL(0.6)
enum { MOST_ITERATIONS = 30 };

/* J, not scaled, and by how much each rod must grow. */
static void linearised(const struct newton_problem *problem, const struct frame *pose,
                       real jacobian[6][6], real error[LEGS])
{
    real columns[6][LEGS];
    struct rods rods = rods_of(problem->base, problem->end, pose->position, pose->rotation);
    real extra[LEGS] = {0};
    leg_columns(&rods, 1, columns);
    if (problem->screws) {
        screw_lengths(problem->screws, &rods, pose->rotation, extra);
        add_screw_columns(problem->screws, &rods, pose->rotation, 1, columns);
    }
    for (int i = 0; i < LEGS; i++) {
        error[i] = problem->length[i] - extra[i] - rods.length[i];
        for (int k = 0; k < 6; k++)
            jacobian[i][k] = columns[k][i];
    }
}

/* Steps that would turn by more than 0.6 rad are shortened as a whole; 0 for one without end. */
static int shortened(real step[6])
{
    real angle = real_sqrt(step[3] * step[3] + step[4] * step[4] + step[5] * step[5]);
    if (!(angle < INFINITY))
        return 0;
    for (int k = 0; angle > LARGEST_TURN && k < 6; k++)
        step[k] *= LARGEST_TURN / angle;
    return 1;
}

static enum newton_end judged(const struct newton_rules *rules, real side, real jacobian[6][6],
                              struct newton_report *report)
{
    real scaled[6][6], nothing[6] = {0};
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++)
            scaled[i][k] = jacobian[i][k] / (k < 3 ? 1 : rules->length);
    report->sigma = smallest_singular_value(scaled);
    if (!(report->sigma >= rules->margin))
        return BELOW_MARGIN;
    return side * eliminate6(jacobian, nothing) <= 0 ? BEYOND : FOUND;
}

struct newton_report newton(const struct newton_problem *problem, const struct newton_rules *rules,
                            struct frame *pose)
{
    struct newton_report report = {.end = NOT_FOUND};
    real side = rules->side, jacobian[6][6], step[6];
    for (int k = 0; k <= MOST_ITERATIONS; k++) {
        linearised(problem, pose, jacobian, step);
        real square = 0;
        report.residual = 0;
        for (int i = 0; i < LEGS; i++) {
            square += step[i] * step[i];
            report.residual = fmax(report.residual, real_fabs(step[i]));
        }
        report.miss = real_sqrt(square);
        report.iterations = k;
        if (report.miss < TOLERANCE) {
            report.end = judged(rules, side, jacobian, &report);
            return report;
        }
        real determinant = eliminate6(jacobian, step);
        if (determinant == 0 || !shortened(step)) {
            report.end = SINGULAR;
            return report;
        }
        side = side == side ? side : determinant;
        se3_move(step, pose);
    }
    return report;
}
