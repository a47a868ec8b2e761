/* The kernel's functions as Python calls them: each takes float64 arrays, and no others.

   Every function is a row of a table: its name, what it calls, and how many numbers each of its
   arrays has for one item. All arrays are C-contiguous, and are not copied. The number of items is
   that of the first array of items; all others must fit it. What does not fit never reaches the
   mathematics. Tables are in platform_functions.c and arm_functions.c. */
#ifndef KERNEL_PYTHON_H
#define KERNEL_PYTHON_H

#include "python_abi.h"
#include "real.h"

enum { MOST_ARRAYS = 12 };

/* What an array is. WHOLE: as many numbers, once for all items; ITEMS: so many for each item.
   OPTIONAL: so many for each item, or None. WRITTEN: so many for each item, a result. */
enum array_kind { END, WHOLE, ITEMS, OPTIONAL, WRITTEN };

struct array {
    enum array_kind kind;
    Py_ssize_t numbers;
};

typedef Py_ssize_t kernel_call(real *const *arrays, Py_ssize_t items);

struct function {
    const char *name;
    kernel_call *call;
    struct array arrays[MOST_ARRAYS];
};

PyObject *python_call(const struct function *function, PyObject *const *arguments, Py_ssize_t count);

/* Makes py_NAME of call_NAME and its arrays; METHOD(NAME) is its row in a table of methods. */
#define FUNCTION(name, ...)                                                                       \
    static const struct function function_##name = {#name, call_##name, {__VA_ARGS__}};           \
    static PyObject *py_##name(PyObject *module, PyObject *const *arguments, Py_ssize_t count)    \
    {                                                                                             \
        (void)module;                                                                             \
        return python_call(&function_##name, arguments, count);                                   \
    }
#define METHOD(name) {#name, py_##name, METH_FASTCALL, NULL}

#define NUMBERS(type) ((Py_ssize_t)(sizeof(type) / sizeof(real)))

extern PyMethodDef PLATFORM_FUNCTIONS[], ARM_FUNCTIONS[];

#endif
