#include "platform.h"

#include <string.h>

#include "rods.h"

static int is_bent_as_at_home(const struct platform *platform, real base[3][LEGS],
                              const real joints[LEGS], const struct frame *pose)
{
    struct rods rods = rods_of(base, platform->legs.shape.end, pose->position,
                               pose->rotation);
    real gains[LEGS];
    leg_gains(&platform->legs, joints, rods.unit, gains);
    int is_bent = 1;
    for (int i = 0; i < LEGS; i++)
        is_bent &= gains[i] * platform->home_gain[i] > 0;
    return is_bent;
}

struct newton_report platform_forward(const struct platform *platform,
                                      const struct newton_rules *rules, const real joints[LEGS],
                                      struct frame *pose)
{
    struct newton_problem problem;
    leg_points(&platform->legs, joints, problem.base);
    leg_lengths(&platform->legs, joints, problem.length);
    problem.screws = platform->legs.screws.lead != 0 ? &platform->legs.screws : NULL;
    memcpy(problem.end, platform->legs.shape.end, sizeof problem.end);
    struct newton_report report = newton(&problem, rules, pose);
    if (report.end == FOUND && rules->side == rules->side &&
        !is_bent_as_at_home(platform, problem.base, joints, pose))
        report.end = BENT;
    return report;
}
