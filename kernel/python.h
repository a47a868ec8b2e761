/* The kernel's functions as Python calls them: each takes float64 arrays, and no others.

   Every function is a row of a table: its name, what it calls, and what its arrays hold. All arrays
   are C-contiguous, and are not copied. The number of items is that of the first array of items;
   all others must fit it. What does not fit never reaches the mathematics. Tables are in
   platform_functions.c and arm_functions.c. */
#pragma once
#include <string.h>

#include "python_abi.h"
#include "vector.h"

enum { MOST_ARRAYS = 12 };

/* WHOLE: so many numbers, once for all items; ITEM: so many for each item. OPTIONAL: so many for
   each item, or None, which arrives as a null pointer. WRITTEN: so many for each item, a result. */
enum array_kind { END, WHOLE, ITEM, OPTIONAL, WRITTEN };

struct array {
    enum array_kind kind;
    Py_ssize_t numbers;
};

/* `each` is called for one item after the other with that item's arrays, and what it returns is
   added up; `all` once, with the arrays' beginnings. */
struct function {
    PyMethodDef method;
    Py_ssize_t (*each)(real *const *a);
    Py_ssize_t (*all)(real *const *a, Py_ssize_t items);
    struct array arrays[MOST_ARRAYS];
};

/* Rows of a table, by the names of functions each_NAME and all_NAME. */
#define EACH(name, ...) {METHOD(name), each_##name, 0, {__VA_ARGS__}}
#define ALL(name, ...) {METHOD(name), 0, all_##name, {__VA_ARGS__}}
#define METHOD(name) {#name, python_call, METH_FASTCALL, NULL}

/* Arrays by the type of what they hold. */
#define NUMBERS(type) ((Py_ssize_t)(sizeof(type) / sizeof(real)))
#define ONCE(type) {WHOLE, NUMBERS(type)}
#define IN(type) {ITEM, NUMBERS(type)}
#define MAYBE(type) {OPTIONAL, NUMBERS(type)}
#define OUT(type) {WRITTEN, NUMBERS(type)}

/* each_NAME where one call is all; what DO calls adds nothing. */
#define DO(name, ...)                                                                             \
    static Py_ssize_t each_##name(real *const *a)                                                 \
    {                                                                                             \
        __VA_ARGS__;                                                                              \
        return 0;                                                                                 \
    }
#define SUM(name, ...)                                                                            \
    static Py_ssize_t each_##name(real *const *a)                                                 \
    {                                                                                             \
        return __VA_ARGS__;                                                                       \
    }

/* An array that holds structs, or rows of n numbers. */
#define AS(type, k) ((type *)a[k])
#define ROWS(n, k) ((real(*)[n])a[k])

/* A pose of two arrays, its position and its rotation. */
#define POSE(k) ((struct frame[1]){pose_of(a + (k))})

static inline struct frame pose_of(real *const pose[2])
{
    struct frame frame;
    memcpy(frame.position, pose[0], sizeof frame.position);
    memcpy(frame.rotation, pose[1], sizeof frame.rotation);
    return frame;
}

static inline void put_pose(const struct frame *pose, real position[3], real rotation[9])
{
    memcpy(position, pose->position, sizeof pose->position);
    memcpy(rotation, pose->rotation, sizeof pose->rotation);
}

/* Each ends with a row without a name. */
extern struct function PLATFORM_FUNCTIONS[], ARM_FUNCTIONS[];

PyObject *python_call(PyObject *row, PyObject *const *arguments, Py_ssize_t count);
