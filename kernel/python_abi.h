/* As much of Python's stable ABI as `python.c` uses, and of a numpy array, declared here so that
   building needs no headers of theirs: https://docs.python.org/3/c-api/stable.html and
   numpy/ndarraytypes.h. The layouts are those of 64-bit CPython 3.10 and later, and of numpy since
   1.7. */
#pragma once
#include <stddef.h>

typedef ptrdiff_t Py_ssize_t;
typedef struct PyObject PyObject;

struct PyObject {
    Py_ssize_t reference_count;
    PyObject *type;
};

/* PyArrayObject_fields and the beginning of PyArray_Descr. */
struct ndarray {
    PyObject object;
    void *data;
    int dimensions;
    Py_ssize_t *shape, *strides;
    PyObject *base;
    const struct array_type {
        PyObject object;
        PyObject *scalar;
        char kind, letter, byte_order;
    } *type;
    int flags;
};

enum { ARRAY_IS_DENSE = 0x101 /* C-contiguous and aligned */, ARRAY_IS_WRITABLE = 0x400 };
/* Bytes in the other order than this computer's; its own is '=', or named. */
enum { BYTES_ARE_SWAPPED = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? '>' : '<' };

typedef struct {
    void *buf;
    PyObject *obj;
    Py_ssize_t len, itemsize;
    int readonly, ndim;
    char *format;
    Py_ssize_t *shape, *strides, *suboffsets;
    void *internal;
} Py_buffer;

typedef struct {
    const char *name;
    PyObject *(*call)(PyObject *self, PyObject *const *arguments, Py_ssize_t count);
    int flags;
    const char *doc;
} PyMethodDef;

typedef struct {
    Py_ssize_t reference_count;
    void *type, *init;
    Py_ssize_t index;
    PyObject *copy;
    const char *name, *doc;
    Py_ssize_t size;
    PyMethodDef *methods;
    void *slots, *traverse, *clear, *free;
} PyModuleDef;

enum { METH_FASTCALL = 0x80, PyBUF_WRITABLE = 1, PyBUF_FORMAT = 4, PyBUF_C_CONTIGUOUS = 0x38 };
enum { ABI_VERSION = 1013 };

extern PyObject _Py_NoneStruct;
extern PyObject *PyExc_TypeError, *PyExc_ValueError;

PyObject *PyModule_Create2(PyModuleDef *definition, int version);
int PyModule_AddObjectRef(PyObject *module, const char *name, PyObject *value);
PyObject *PyCFunction_NewEx(PyMethodDef *method, PyObject *self, PyObject *module);
PyObject *PyCapsule_New(void *pointer, const char *name, void *destructor);
void *PyCapsule_GetPointer(PyObject *capsule, const char *name);
PyObject *PyImport_ImportModule(const char *name);
PyObject *PyObject_GetAttrString(PyObject *object, const char *name);
PyObject *PyLong_FromSsize_t(Py_ssize_t number);
PyObject *PyErr_Format(PyObject *exception, const char *format, ...);
int PyObject_GetBuffer(PyObject *exporter, Py_buffer *view, int flags);
void PyBuffer_Release(Py_buffer *view);
void *PyEval_SaveThread(void);
void PyEval_RestoreThread(void *state);
