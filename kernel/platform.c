#include "platform.h"

#include "rods.h"

static int is_bent_as_at_home(const struct platform *platform, real base[3][LEGS],
                              const real joints[LEGS], const real position[3],
                              const real rotation[9])
{
    struct rods rods = rods_of(base, platform->legs.end, position, rotation);
    real gains[LEGS];
    crank_gains(&platform->legs, joints, rods.unit, gains);
    int is_bent = 1;
    for (int i = 0; i < LEGS; i++)
        is_bent &= platform->legs.crank[i] == 0 || gains[i] * platform->home_gain[i] > 0;
    return is_bent;
}

struct newton_report platform_forward(const struct platform *platform,
                                      const struct newton_rules *rules, const real joints[LEGS],
                                      real position[3], real rotation[9])
{
    struct newton_problem problem;
    base_points(&platform->legs, joints, problem.base);
    for (int i = 0; i < LEGS; i++) {
        problem.length[i] = platform->legs.crank[i] == 0 ? joints[i] : platform->legs.rod[i];
        for (int k = 0; k < 3; k++)
            problem.end[k][i] = platform->legs.end[k][i];
    }
    struct newton_report report = newton(&problem, rules, position, rotation);
    if (report.end == FOUND && rules->side == rules->side &&
        !is_bent_as_at_home(platform, problem.base, joints, position, rotation))
        report.end = BENT;
    return report;
}
