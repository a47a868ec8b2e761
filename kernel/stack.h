/* Platforms on platforms, their redundancy resolved: docs/kinematics.md, 9.1 and 9.2. */
#pragma once
#include "se3.h"

enum { MOST_SECTIONS = 6 };

struct stack_section {
    struct frame home;  /* of the platform on the section's own base */
    struct frame after; /* from the platform to the next base, or to the end */
    real range[6];          /* w of (9.2), m and rad */
};

struct stack {
    real count; /* of sections, at least 1 */
    struct stack_section sections[MOST_SECTIONS];
};

/* All sections' poses at a minimum of (9.2) for one pose of the end; 0 where the descent does not
   settle. free: the twists from home by range, six for each section but the last, from which it
   begins; written. */
int stack_sections(const struct stack *stack, const struct frame *end, real *free,
                   struct frame sections[MOST_SECTIONS]);
