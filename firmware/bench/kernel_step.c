#include "kernel_step.h"

#include "../../kernel/chain.c"
#include "../../kernel/matrix6.c"
#include "../../kernel/se3.c"

#define DAMPING 1e-4f

void kernel_step(const struct chain *chain, float length, float joints[JOINTS],
                 const float twist[6], float dt)
{
    posture here = {.tool = {{0}, {0}}};
    float jacobian[6][JOINTS], scaled[6], rates[JOINTS];
    chain_posture(chain, joints, &here);
    chain_jacobian(&here, jacobian);
    scale_jacobian(length, jacobian);
    for (int k = 0; k < 6; k++)
        scaled[k] = k < 3 ? twist[k] / length : twist[k];
    damped6(jacobian, DAMPING, scaled, rates);
    for (int i = 0; i < JOINTS; i++)
        joints[i] += rates[i] * dt;
}
