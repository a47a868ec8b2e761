/* Platforms on platforms, their redundancy resolved: docs/kinematics.md, 9. */
#ifndef KERNEL_STACK_H
#define KERNEL_STACK_H

#include "limits.h"

enum { MOST_SECTIONS = 6 };

struct placement {
    real position[3], rotation[9];
};

struct stack_section {
    struct platform platform;
    struct placement home;  /* of the platform on the section's own base */
    struct placement after; /* from the platform to the next base, or to the end */
    real range[6];          /* w of (9.2), m and rad */
    real bound[2][VALUES];  /* least, most */
    real margin[2][VALUES]; /* at home, m0 of (9.3); 0 where no limit is felt */
};

struct stack {
    real count;     /* of sections, at least 1 */
    real spare;     /* of each margin at home, below which a limit is felt */
    real stiffness; /* k of (9.3) */
    struct stack_section sections[MOST_SECTIONS];
};

/* Where descents begin: given, else at home; at home; or for a row of ends each where the one before
   came to: that row ends at the first that does not settle. */
enum stack_start { GIVEN, FROM_HOME, ALONG };

/* All sections' poses at a local minimum of (9.3) for one pose of the end; 0 where the descent does
   not settle. free: the twists from home by range, six for each section but the last, from which it
   begins; written. From home, it first leaves the limits out. */
int stack_sections(const struct stack *stack, const struct placement *end, enum stack_start start,
                   real *free, struct placement sections[MOST_SECTIONS]);

#endif
