/* What one step of each kinematics costs: a program of its own, for the simulated chip.
 *
 * It writes to a register before and after; the simulator notes the cycles.
 */
#include <avr/io.h>
#include <math.h>

#include "arm_inverse.h"
#include "kernel_step.h"
#include "kinematics.h"
#include "resolved_rate.h"
#include "target.h"

enum {
    NOTHING = 1,
    INVERSE = 2,
    ARM_STEP = 3,
    SINE = 4,
    ALGEBRAIC = 5,
    GEOMETRIC = 6,
    KERNEL_STEP = 7,
    DONE = 0xFF
};

#define MARK(what) (GPIOR0 = (what))

static volatile float anything;

static void inverse(float x, float angle)
{
    const float position[3] = {x, 0.002f, MACHINE.hexapod.home_position[2]};
    const float rpy[3] = {angle, -angle, 0.05f};
    float rotation[9], cranks[LEGS];
    MARK(INVERSE);
    kinematics_rotation(rpy, rotation);
    bool closes = kinematics_cranks(&MACHINE.hexapod, position, rotation, cranks);
    MARK(INVERSE);
    anything = closes ? cranks[5] : 0;
}

static void arm_step(float q)
{
    const PaperArm arm = {0.4f, 0.4f};
    const float velocity[3] = {0.1f, -0.05f, 0.02f};
    float joints[6] = {q, 0.4f + q, 1.2f, 0.3f, 0.9f - q, 0.2f};
    MARK(ARM_STEP);
    bool is_regular = resolved_rate_step(&arm, joints, velocity, 0.02f);
    MARK(ARM_STEP);
    anything = is_regular ? joints[5] : 0;
}

/* The same arm as any other, by its axes and points at zero angles. */
static void any_arm_step(float q)
{
    static const struct chain CHAIN = {
        .axis = {{0, 0, 1}, {-1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, 1}},
        .point = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0.4f}, {0, 0, 0.8f}, {0, 0, 0.8f}, {0, 0, 0.8f}},
        .tool = {{0, 0, 0.8f}, {1, 0, 0, 0, 1, 0, 0, 0, 1}},
    };
    const float twist[6] = {0.1f, -0.05f, 0.02f, 0, 0, 0};
    float joints[6] = {q, 0.4f + q, 1.2f, 0.3f, 0.9f - q, 0.2f};
    MARK(KERNEL_STEP);
    kernel_step(&CHAIN, 0.4f, joints, twist, 0.02f);
    MARK(KERNEL_STEP);
    anything = joints[5];
}

static void arm_inverse(float x)
{
    const PaperArm arm = {0.4f, 0.4f};
    const float centre[3] = {x - 0.1f, 0.45f, 0.2f + x};
    const float rotation[9] = {0.36f, 0.48f, 0.8f, -0.8f, 0.6f, 0.0f, -0.48f, -0.64f, 0.6f};
    float joints[6];
    MARK(ALGEBRAIC);
    bool reaches = arm_inverse_algebraic(&arm, centre, rotation, joints);
    MARK(ALGEBRAIC);
    anything = reaches ? joints[5] : 0;
    MARK(GEOMETRIC);
    reaches = arm_inverse_geometric(&arm, centre, rotation, joints);
    MARK(GEOMETRIC);
    anything = reaches ? joints[5] : 0;
}

int main(void)
{
    for (int k = 0; k < 20; k++) {
        anything = 0.01f * k;
        MARK(NOTHING);
        MARK(NOTHING);
        float value = anything;
        MARK(SINE);
        value = sinf(value + 0.3f);
        MARK(SINE);
        anything = value;
        inverse(0.0003f * k, 0.004f * k);
        arm_step(0.02f * k);
        any_arm_step(0.02f * k);
        arm_inverse(0.01f * k);
    }
    MARK(DONE);
    for (;;)
        continue;
}
