/* The kernel as the Python module manipulator._kernel. */
#include "python.h"

#include <stdint.h>

enum { RELEASE_FROM = 64 /* items from which on other threads may run */ };

static const PyObject *numpy_ndarray;

/* The arguments of a call: their numbers, and the buffers to be released after it. */
struct opened {
    real *arrays[MOST_ARRAYS];
    int held;
    Py_buffer buffers[MOST_ARRAYS];
};

/* Whether it is a plain array of numpy's of the right kind: one is read without the buffer
   protocol, which for four arrays takes twice as long as six legs' inverse. */
static int is_plain(const struct ndarray *array, int is_written)
{
    const int flags = is_written ? ARRAY_IS_DENSE | ARRAY_IS_WRITABLE : ARRAY_IS_DENSE;
    return array->object.type == numpy_ndarray && (array->flags & flags) == flags
           && array->type->letter == 'd' && array->type->byte_order != BYTES_ARE_SWAPPED;
}

/* The array's length in bytes; -1 where it is of no use. What is no plain array is asked for its
   buffer, which says what is wrong with it. */
static Py_ssize_t open_array(const struct function *f, int index, PyObject *object,
                             struct opened *to)
{
    const struct ndarray *array = (const struct ndarray *)object;
    const int is_written = f->arrays[index].kind == WRITTEN;
    if (is_plain(array, is_written)) {
        Py_ssize_t length = (Py_ssize_t)sizeof(real);
        for (int k = 0; k < array->dimensions; k++)
            length *= array->shape[k];
        to->arrays[index] = array->data;
        return length;
    }
    Py_buffer *buffer = &to->buffers[to->held];
    if (PyObject_GetBuffer(object, buffer,
                           PyBUF_C_CONTIGUOUS | PyBUF_FORMAT | (is_written ? PyBUF_WRITABLE : 0)))
        return -1;
    to->held++;
    to->arrays[index] = buffer->buf;
    if (buffer->format[0] == 'd' && buffer->format[1] == 0
        && (uintptr_t)buffer->buf % sizeof(real) == 0)
        return buffer->len;
    PyErr_Format(PyExc_TypeError, "%s: array %d holds '%s', not aligned float64", f->method.name,
                 index + 1, buffer->format);
    return -1;
}

/* Whether the array has as many numbers as items need; the first array of items says how many. */
static int fits(const struct function *f, int index, Py_ssize_t length, Py_ssize_t *items)
{
    Py_ssize_t needed = f->arrays[index].numbers, size = (Py_ssize_t)sizeof(real);
    if (f->arrays[index].kind != WHOLE) {
        if (*items < 0) /* part of one needs all of it; a division takes longer than all the rest */
            *items = length == needed * size ? 1 : (length / size + needed - 1) / needed;
        needed *= *items;
    }
    if (length == needed * size)
        return 1;
    PyErr_Format(PyExc_ValueError, "%s: array %d has %zd numbers, needs %zd", f->method.name,
                 index + 1, length / size, needed);
    return 0;
}

static Py_ssize_t call(const struct function *f, real **arrays, Py_ssize_t items)
{
    Py_ssize_t sum = 0;
    if (f->all)
        return f->all(arrays, items);
    for (Py_ssize_t i = 0; i < items; i++) {
        sum += f->each(arrays);
        for (int k = 0; i + 1 < items && k < MOST_ARRAYS && f->arrays[k].kind != END; k++)
            if (f->arrays[k].kind != WHOLE && arrays[k])
                arrays[k] += f->arrays[k].numbers;
    }
    return sum;
}

static PyObject *run(const struct function *f, real **arrays, Py_ssize_t items)
{
    if (items < RELEASE_FROM)
        return PyLong_FromSsize_t(call(f, arrays, items));
    void *state = PyEval_SaveThread();
    Py_ssize_t result = call(f, arrays, items);
    PyEval_RestoreThread(state);
    return PyLong_FromSsize_t(result);
}

PyObject *python_call(PyObject *row, PyObject *const *arguments, Py_ssize_t count)
{
    const struct function *f = PyCapsule_GetPointer(row, NULL);
    struct opened opened;
    Py_ssize_t items = -1;
    PyObject *result = NULL;
    int wanted = 0, is_good = 1;
    while (wanted < MOST_ARRAYS && f->arrays[wanted].kind != END)
        wanted++;
    if (count != wanted)
        return PyErr_Format(PyExc_TypeError, "%s takes %d arrays, not %zd", f->method.name, wanted,
                            count);
    opened.held = 0;
    for (int k = 0; is_good && k < wanted; k++) {
        opened.arrays[k] = NULL;
        if (f->arrays[k].kind == OPTIONAL && arguments[k] == &_Py_NoneStruct)
            continue;
        Py_ssize_t length = open_array(f, k, arguments[k], &opened);
        is_good = length >= 0 && fits(f, k, length, &items);
    }
    if (is_good)
        result = run(f, opened.arrays, items);
    while (opened.held > 0)
        PyBuffer_Release(&opened.buffers[--opened.held]);
    return result;
}

/* Adds a table's functions, each bound to its row. */
static int add_functions(PyObject *module, struct function *rows)
{
    for (struct function *f = rows; f->method.name; f++) {
        PyObject *row = PyCapsule_New(f, NULL, NULL);
        PyObject *function = row ? PyCFunction_NewEx(&f->method, row, NULL) : NULL;
        if (!function || PyModule_AddObjectRef(module, f->method.name, function) < 0)
            return -1;
    }
    return 0;
}

static PyModuleDef MODULE = {.reference_count = 1, .name = "manipulator._kernel", .size = -1};

__attribute__((visibility("default"))) PyObject *PyInit__kernel(void);
PyObject *PyInit__kernel(void)
{
    PyObject *module = PyModule_Create2(&MODULE, ABI_VERSION);
    PyObject *numpy = PyImport_ImportModule("numpy");
    if (numpy)
        numpy_ndarray = PyObject_GetAttrString(numpy, "ndarray");
    if (!module || !numpy_ndarray || add_functions(module, PLATFORM_FUNCTIONS) < 0
        || add_functions(module, ARM_FUNCTIONS) < 0)
        return NULL; /* the process will not use it: it does not start */
    return module;
}
