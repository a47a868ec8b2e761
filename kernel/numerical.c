#include "numerical.h"

#include "matrix6.h"
#include "se3.h"

/* Radians of the joints that count as beside the known ones. */
#define BESIDE REAL(0.05)
/* Metres and radians from the known pose, farther than which such joints do not lead. */
#define FARTHEST REAL(0.3)
#define CONVERGED REAL(1e-12)
#define ARRIVED REAL(1e-11)
/* A start whose error is still more than this part of what it was ten steps ago is given up. */
#define STALLED REAL(0.9)
enum { NEARBY_STEPS = 4, LOOK_BACK = 10 };

void twist_to_pose(const struct frame *here, const struct frame *pose, real twist[6])
{
    se3_twist(here->position, here->rotation, pose->position, pose->rotation, twist);
}

static real largest(const real a[JOINTS], const real b[JOINTS])
{
    real most = 0;
    for (int i = 0; i < JOINTS; i++)
        if (!(real_fabs(a[i] - b[i]) <= most))
            most = real_fabs(a[i] - b[i]);
    return most;
}

int continue_nearby(const struct chain *chain, const struct frame *pose, const real near[JOINTS],
                    real joints[JOINTS])
{
    static const real NOTHING[6] = {0};
    for (int i = 0; i < JOINTS; i++)
        joints[i] = near[i];
    for (int step = 0; step < NEARBY_STEPS; step++) {
        real error[6], jacobian[6][JOINTS];
        posture here;
        chain_posture(chain, joints, &here);
        twist_to_pose(&here.tool, pose, error);
        real away = largest(error, NOTHING);
        if (away < CONVERGED)
            return 1;
        chain_jacobian(&here, jacobian);
        if (!(away <= FARTHEST) || eliminate6(jacobian, error) == 0)
            return 0;
        for (int i = 0; i < JOINTS; i++)
            joints[i] += error[i]; /* solved for the joints by now */
        if (!(largest(joints, near) <= BESIDE))
            return 0;
    }
    return 0;
}

real descend_joints(const struct chain *chain, const struct frame *pose, real length, int steps,
             real joints[JOINTS])
{
    real last = (real)INFINITY;
    for (int step = 0;; step++) {
        real error[6], jacobian[6][JOINTS], change[JOINTS], square = 0;
        posture here;
        chain_posture(chain, joints, &here);
        twist_to_pose(&here.tool, pose, error);
        for (int i = 0; i < 6; i++) {
            error[i] /= i < 3 ? length : 1;
            square += error[i] * error[i];
        }
        real size = real_sqrt(square);
        int has_stalled = step > 0 && step % LOOK_BACK == 0 && !(size < STALLED * last);
        if (!(size >= ARRIVED) || step == steps || has_stalled)
            return size;
        if (step % LOOK_BACK == 0)
            last = size;
        chain_jacobian(&here, jacobian);
        scale_jacobian(length, jacobian);
        real damping = square / 2 < REAL(0.1) ? square / 2 : REAL(0.1);
        damped6(jacobian, damping + CONVERGED, error, change);
        for (int i = 0; i < JOINTS; i++)
            joints[i] += change[i];
    }
}
