/* What Python calls of the arms' mathematics. */
#include "chain.h"
#include "python.h"

#include <string.h>

static Py_ssize_t call_chain_forward(real *const *a, Py_ssize_t items)
{
    Py_ssize_t lost = 0;
    for (Py_ssize_t i = 0; i < items; i++) {
        posture turned;
        chain_posture((const struct chain *)a[0], a[1] + JOINTS * i, &turned);
        memcpy(a[2] + 3 * i, turned.tool.position, sizeof turned.tool.position);
        memcpy(a[3] + 9 * i, turned.tool.rotation, sizeof turned.tool.rotation);
        const real *place = turned.tool.position;
        lost += !isfinite(place[0] + place[1] + place[2]);
    }
    return lost;
}
FUNCTION(chain_forward, {WHOLE, NUMBERS(struct chain)}, {ITEMS, JOINTS}, {WRITTEN, 3},
         {WRITTEN, 9})

/* As square matrices, four rows of four. */
static Py_ssize_t call_chain_displacements(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        struct frame moved[JOINTS + 1];
        chain_displacements((const struct chain *)a[0], a[1] + JOINTS * i, moved);
        for (int k = 0; k <= JOINTS; k++) {
            real *matrix = a[2] + 16 * ((JOINTS + 1) * i + k);
            for (int row = 0; row < 3; row++) {
                memcpy(matrix + 4 * row, moved[k].rotation + 3 * row, 3 * sizeof(real));
                matrix[4 * row + 3] = moved[k].position[row];
                matrix[12 + row] = 0;
            }
            matrix[15] = 1;
        }
    }
    return 0;
}
FUNCTION(chain_displacements, {WHOLE, NUMBERS(struct chain)}, {ITEMS, JOINTS},
         {WRITTEN, 16 * (JOINTS + 1)})

static Py_ssize_t call_chain_jacobian(real *const *a, Py_ssize_t items)
{
    for (Py_ssize_t i = 0; i < items; i++) {
        posture turned;
        chain_posture((const struct chain *)a[0], a[1] + JOINTS * i, &turned);
        chain_jacobian(&turned, a[2] + 6 * JOINTS * i);
    }
    return 0;
}
FUNCTION(chain_jacobian, {WHOLE, NUMBERS(struct chain)}, {ITEMS, JOINTS}, {WRITTEN, 6 * JOINTS})

PyMethodDef ARM_FUNCTIONS[] = {
    METHOD(chain_forward),
    METHOD(chain_displacements),
    METHOD(chain_jacobian),
    {NULL, NULL, 0, NULL},
};
