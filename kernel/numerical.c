#include "numerical.h"

#include "matrix6.h"
#include "se3.h"

/* Radians of the joints that count as beside the known ones. */
#define BESIDE REAL(0.05)
/* Metres and radians from the known pose, farther than which such joints do not lead. */
#define FARTHEST REAL(0.3)
#define CONVERGED REAL(1e-12)
#define ARRIVED REAL(1e-11)
/* Damping at the target, where equations may be singular, and the most, far from it. */
#define LEAST_DAMPING REAL(1e-12)
#define MOST_DAMPING REAL(0.1)
/* A start whose error is still more than this part of what it was ten steps ago is given up. */
#define STALLED REAL(0.9)
enum { NEARBY_STEPS = 4, DAMPED_STEPS = 12, LOOK_BACK = 10 };

static real largest(const real a[JOINTS], const real b[JOINTS])
{
    real most = 0;
    for (int i = 0; i < JOINTS; i++)
        if (!(real_fabs(a[i] - b[i]) <= most))
            most = real_fabs(a[i] - b[i]);
    return most;
}

static real square_distance(const real a[JOINTS], const real b[JOINTS])
{
    real sum = 0;
    for (int i = 0; i < JOINTS; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

static int newton_nearby(const struct chain *chain, const struct frame *pose,
                         const real near[JOINTS], real joints[JOINTS])
{
    static const real NOTHING[6] = {0};
    for (int i = 0; i < JOINTS; i++)
        joints[i] = near[i];
    for (int step = 0; step < NEARBY_STEPS; step++) {
        real error[6], jacobian[6][JOINTS];
        posture here;
        chain_posture(chain, joints, &here);
        se3_twist(&here.tool, pose, error);
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
        se3_twist(&here.tool, pose, error);
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
        real damping = square / 2 < MOST_DAMPING ? square / 2 : MOST_DAMPING;
        damped6(jacobian, damping + LEAST_DAMPING, error, change);
        for (int i = 0; i < JOINTS; i++)
            joints[i] += change[i];
    }
}

static void scaled_jacobian(const struct chain *chain, real length, const real joints[JOINTS],
                            real jacobian[6][JOINTS])
{
    posture here;
    chain_posture(chain, joints, &here);
    chain_jacobian(&here, jacobian);
    scale_jacobian(length, jacobian);
}

/* Along the lost direction v the error is sigma t + c t^2/2: zero here, and again at -2 sigma/c.
   c = u . J'(v) v by central differences of J, u the direction of the twist that is lost. */
void beyond_fold(const struct chain *chain, real length, const real joints[JOINTS],
                 real beyond[JOINTS])
{
    const real h = REAL(1e-3); /* rad */
    struct svd6 parts;
    real jacobian[6][JOINTS], c = 0;
    scaled_jacobian(chain, length, joints, jacobian);
    svd6(jacobian, &parts);
    for (int side = -1; side <= 1; side += 2) {
        for (int i = 0; i < JOINTS; i++)
            beyond[i] = joints[i] + (real)side * h * parts.right[5][i];
        scaled_jacobian(chain, length, beyond, jacobian);
        for (int i = 0; i < 6; i++)
            c += parts.left[i][5] * dot6(jacobian[i], parts.right[5]) * (real)side / (2 * h);
    }
    real along = -2 * parts.sigma[5] / c;
    for (int i = 0; i < JOINTS; i++)
        beyond[i] = joints[i] + along * parts.right[5][i];
}

int continue_nearby(const struct chain *chain, real length, const struct frame *pose,
                    const real near[JOINTS], real joints[JOINTS])
{
    real other[JOINTS];
    if (newton_nearby(chain, pose, near, joints))
        return 1;
    for (int i = 0; i < JOINTS; i++)
        joints[i] = near[i];
    if (!(descend_joints(chain, pose, length, DAMPED_STEPS, joints) < ARRIVED)
        || !(largest(joints, near) <= BESIDE))
        return 0;
    beyond_fold(chain, length, joints, other);
    int is_nearer = descend_joints(chain, pose, length, DAMPED_STEPS, other) < ARRIVED
                    && square_distance(other, near) < square_distance(joints, near);
    for (int i = 0; is_nearer && i < JOINTS; i++)
        joints[i] = other[i];
    return 1;
}
