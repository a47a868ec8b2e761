/* The kernel as the Python module manipulator._kernel. */
#include "python.h"

enum { RELEASE_FROM = 64 /* items from which on other threads may run */ };

static int open_array(const struct function *f, int index, PyObject *object, Py_buffer *view)
{
    int flags = PyBUF_C_CONTIGUOUS | PyBUF_FORMAT;
    if (f->arrays[index].kind == WRITTEN)
        flags |= PyBUF_WRITABLE;
    if (PyObject_GetBuffer(object, view, flags) < 0)
        return -1;
    if (view->format[0] == 'd' && view->format[1] == 0)
        return 0;
    PyErr_Format(PyExc_TypeError, "%s: array %d holds '%s', not float64", f->name, index + 1,
                 view->format);
    PyBuffer_Release(view);
    return -1;
}

/* Whether the array has as many numbers as items need; the first array of items says how many. */
static int fits(const struct function *f, int index, Py_ssize_t length, Py_ssize_t *items)
{
    Py_ssize_t needed = f->arrays[index].numbers, size = (Py_ssize_t)sizeof(real);
    if (f->arrays[index].kind != WHOLE) {
        if (*items < 0) /* a division takes longer than all the rest */
            *items = length == needed * size ? 1 : length / (needed * size);
        needed *= *items;
    }
    if (length == needed * size)
        return 1;
    PyErr_Format(PyExc_ValueError, "%s: array %d has %zd numbers, needs %zd", f->name, index + 1,
                 length / size, needed);
    return 0;
}

static Py_ssize_t run(const struct function *f, real *const *arrays, Py_ssize_t items)
{
    if (items < RELEASE_FROM)
        return f->call(arrays, items);
    void *state = PyEval_SaveThread();
    Py_ssize_t result = f->call(arrays, items);
    PyEval_RestoreThread(state);
    return result;
}

PyObject *python_call(const struct function *f, PyObject *const *arguments, Py_ssize_t count)
{
    Py_buffer views[MOST_ARRAYS];
    real *arrays[MOST_ARRAYS] = {NULL};
    Py_ssize_t items = -1;
    PyObject *result = NULL;
    int wanted = 0, opened = 0;
    while (wanted < MOST_ARRAYS && f->arrays[wanted].kind != END)
        wanted++;
    if (count != wanted)
        return PyErr_Format(PyExc_TypeError, "%s takes %d arrays, not %zd", f->name, wanted, count);
    for (; opened < wanted; opened++) {
        views[opened].obj = NULL;
        if (f->arrays[opened].kind == OPTIONAL && arguments[opened] == &_Py_NoneStruct)
            continue;
        if (open_array(f, opened, arguments[opened], &views[opened]) < 0)
            goto release;
        arrays[opened] = views[opened].buf;
        if (!fits(f, opened, views[opened].len, &items)) {
            opened++;
            goto release;
        }
    }
    result = PyLong_FromSsize_t(run(f, arrays, items));
release:
    while (opened-- > 0)
        if (views[opened].obj)
            PyBuffer_Release(&views[opened]);
    return result;
}

static PyModuleDef MODULE = {
    .reference_count = 1, .name = "manipulator._kernel", .size = -1, .methods = PLATFORM_FUNCTIONS};

__attribute__((visibility("default"))) PyObject *PyInit__kernel(void);
PyObject *PyInit__kernel(void)
{
    PyObject *module = PyModule_Create2(&MODULE, ABI_VERSION);
    if (module && PyModule_AddFunctions(module, ARM_FUNCTIONS) < 0)
        return NULL; /* the process will not use it: it does not start */
    return module;
}
