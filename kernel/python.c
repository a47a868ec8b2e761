/* The kernel as the Python module manipulator._kernel. */
#include "python.h"

enum { RELEASE_FROM = 64 /* items from which on other threads may run */ };

static const PyObject *numpy_ndarray;

/* What a plain array of numpy's holds, without the buffer protocol: for four arrays this takes twice
   as long as six legs' inverse. 0 for what is not a plain array of the right kind. */
static int open_plain(const PyObject *object, int is_written, Py_buffer *view)
{
    const struct ndarray *array = (const struct ndarray *)object;
    const int flags = is_written ? ARRAY_IS_DENSE | ARRAY_IS_WRITABLE : ARRAY_IS_DENSE;
    if (object->type != numpy_ndarray || (array->flags & flags) != flags
        || array->type->letter != 'd' || array->type->byte_order != '=')
        return 0;
    view->buf = array->data;
    view->len = (Py_ssize_t)sizeof(real);
    for (int k = 0; k < array->dimensions; k++)
        view->len *= array->shape[k];
    return 1;
}

/* Anything else is asked for its buffer, which says what is wrong with it. */
static int open_array(const struct function *f, int index, PyObject *object, Py_buffer *view)
{
    const int is_written = f->arrays[index].kind == WRITTEN;
    view->obj = NULL;
    if (open_plain(object, is_written, view))
        return 0;
    if (PyObject_GetBuffer(object, view,
                           PyBUF_C_CONTIGUOUS | PyBUF_FORMAT | (is_written ? PyBUF_WRITABLE : 0)))
        return -1;
    if (view->format[0] == 'd' && view->format[1] == 0)
        return 0;
    PyErr_Format(PyExc_TypeError, "%s: array %d holds '%s', not float64", f->method.name, index + 1,
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
        for (int k = 0; i + 1 < items && k < MOST_ARRAYS; k++)
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
    Py_buffer views[MOST_ARRAYS];
    real *arrays[MOST_ARRAYS] = {NULL};
    Py_ssize_t items = -1;
    PyObject *result = NULL;
    int wanted = 0, opened = 0, is_good = 1;
    while (wanted < MOST_ARRAYS && f->arrays[wanted].kind != END)
        wanted++;
    if (count != wanted)
        return PyErr_Format(PyExc_TypeError, "%s takes %d arrays, not %zd", f->method.name, wanted,
                            count);
    for (int k = 0; is_good && k < wanted; k++) {
        if (f->arrays[k].kind == OPTIONAL && arguments[k] == &_Py_NoneStruct)
            continue;
        is_good = open_array(f, k, arguments[k], &views[opened]) == 0;
        if (is_good) {
            arrays[k] = views[opened].buf;
            is_good = fits(f, k, views[opened++].len, &items);
        }
    }
    if (is_good)
        result = run(f, arrays, items);
    while (opened-- > 0)
        if (views[opened].obj)
            PyBuffer_Release(&views[opened]);
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
