/* The number type of the mathematics: double on a computer, float where KERNEL_FLOAT is set. */
#pragma once
#include <float.h>
#include <math.h>

#ifdef KERNEL_FLOAT
typedef float real;
#define REAL(number) number##f
#define REAL_EPSILON FLT_EPSILON
#define real_sqrt sqrtf
#define real_fabs fabsf
#define real_sin sinf
#define real_cos cosf
#define real_acos acosf
#define real_asin asinf
#define real_atan2 atan2f
#define real_rint rintf
#define real_floor floorf
#else
typedef double real;
#define REAL(number) number
#define REAL_EPSILON DBL_EPSILON
#define real_sqrt sqrt
#define real_fabs fabs
#define real_sin sin
#define real_cos cos
#define real_acos acos
#define real_asin asin
#define real_atan2 atan2
#define real_rint rint
#define real_floor floor
#endif

#define REAL_PI REAL(3.14159265358979323846)
#define REAL_TURN REAL(6.28318530717958647693)
