/* What Python calls of the platforms' mathematics. */
#include "crank.h"
#include "python.h"

static Py_ssize_t call_crank_inverse(real *const *a, Py_ssize_t items)
{
    Py_ssize_t open = 0;
    for (Py_ssize_t i = 0; i < items; i++)
        open += crank_inverse((const struct crank_legs *)a[0], a[1] + 3 * i, a[2] + 9 * i,
                              a[3] ? a[3] + LEGS * i : NULL, a[4] + LEGS * i);
    return open;
}
FUNCTION(crank_inverse, {WHOLE, NUMBERS(struct crank_legs)}, {ITEMS, 3}, {ITEMS, 9},
         {OPTIONAL, LEGS}, {WRITTEN, LEGS})

PyMethodDef PLATFORM_FUNCTIONS[] = {
    METHOD(crank_inverse),
    {NULL, NULL, 0, NULL},
};
