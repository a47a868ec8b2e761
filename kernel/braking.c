#include "braking.h"

#include <string.h>

#include "se3.h"
#include "vector.h"

/* One tick of braking from n takes to exactly n - 1, so that a path once checked stays the same. */
#define ROUNDING REAL(1e-9)

/* In how many ticks a twist comes to rest, at least 1. */
static real braking_ticks(const struct jog_bounds *bounds, const real twist[6])
{
    real linear = real_sqrt(dot3(twist, twist)) / bounds->acceleration;
    real angular = real_sqrt(dot3(twist + 3, twist + 3)) / bounds->angular_acceleration;
    return ceil(fmax(fmax(linear, angular) / bounds->tick - ROUNDING, 1));
}

/* The platform's pose in the base frame. */
static struct frame platform_at(const struct jog_frame *frame, const struct frame *pivot)
{
    real arm[3];
    struct frame pose = composed(&frame->work, pivot);
    rotate3(pose.rotation, frame->pivot, arm);
    minus3(pose.position, arm, pose.position);
    return pose;
}

/* The joint that is the furthest above a bound, if any: what it is, by its bound. */
struct excess {
    real most;
    int joint;
};

static void note(struct excess *excess, real value, real bound, int joint)
{
    real part = real_fabs(value) / bound;
    if (part > excess->most) {
        excess->most = part;
        excess->joint = joint;
    }
}

static void judge(struct braking_path *path, const struct excess *speed,
                  const struct excess *acceleration)
{
    const struct excess *worst = speed->most > 1 ? speed : acceleration;
    if (path->obstacle != NOTHING || !(worst->most > 1))
        return;
    path->obstacle = worst == speed ? A_SPEED : AN_ACCELERATION;
    path->joint = worst->joint;
}

struct braking_path braking_path(const struct jogged *machine, const struct jog_state *from,
                                 const real twist[6])
{
    const struct jog_bounds *bounds = machine->bounds;
    real joints[LEGS], rates[LEGS], gone = 0, ticks = braking_ticks(bounds, twist);
    struct excess speed = {1, 0}, acceleration = {1, 0};
    struct braking_path path = {.obstacle = NOTHING};
    memcpy(joints, from->joints, sizeof joints);
    memcpy(rates, from->rates, sizeof rates);
    for (int tick = 0; tick <= ticks; tick++) {
        struct braking_path at = {.obstacle = A_LIMIT, .pose = from->pose};
        real step[6];
        gone += bounds->tick * (1 - tick / ticks);
        for (int k = 0; k < 6; k++)
            step[k] = gone * twist[k];
        se3_move(step, &at.pose);
        struct frame pose = platform_at(machine->frame, &at.pose);
        leg_inverse(&machine->platform->legs, pose.position, pose.rotation, from->joints,
                    at.joints);
        for (int i = 0; i < LEGS; i++) {
            real rate = (at.joints[i] - joints[i]) / bounds->tick;
            note(&speed, rate, bounds->joint_speed[i], i);
            note(&acceleration, (rate - rates[i]) / bounds->tick, bounds->joint_acceleration[i], i);
            joints[i] = at.joints[i];
            rates[i] = rate;
        }
        if (!keeps_limits(machine->platform, machine->ranges, pose.position, pose.rotation,
                          at.joints))
            return at;
        if (tick == 0) {
            at.obstacle = NOTHING;
            path = at;
        }
    }
    judge(&path, &speed, &acceleration);
    return path;
}
