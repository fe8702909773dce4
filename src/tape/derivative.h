/* Derivatives of the smooth operations, in the arithmetic A (scalar, interval): x is the operand, y the operation's value. Every
 * arithmetic that needs them takes these. */
#ifndef VTS_TAPE_DERIVATIVE_H
#define VTS_TAPE_DERIVATIVE_H

#include "base/common.h"

#define DERIVATIVE_ONE_MINUS_SQUARE(A, C, x) A##_SUB(C(1), A##_SQR(x))

#define DERIVATIVE_SQRT(A, C, x, y)  A##_DIV(C(0.5), y)
#define DERIVATIVE_EXP(A, C, x, y)   (y)
#define DERIVATIVE_LN(A, C, x, y)    A##_DIV(C(1), x)
#define DERIVATIVE_LOG(A, C, x, y)   A##_DIV(C(0.43429448190325182765), x)
#define DERIVATIVE_SIN(A, C, x, y)   A##_COS(x)
#define DERIVATIVE_COS(A, C, x, y)   A##_NEG(A##_SIN(x))
#define DERIVATIVE_TAN(A, C, x, y)   A##_ADD(C(1), A##_SQR(y))
#define DERIVATIVE_ASIN(A, C, x, y)  A##_DIV(C(1), A##_SQRT(DERIVATIVE_ONE_MINUS_SQUARE(A, C, x)))
#define DERIVATIVE_ACOS(A, C, x, y)  A##_DIV(C(-1), A##_SQRT(DERIVATIVE_ONE_MINUS_SQUARE(A, C, x)))
#define DERIVATIVE_ATAN(A, C, x, y)  A##_DIV(C(1), A##_ADD(C(1), A##_SQR(x)))
#define DERIVATIVE_SINH(A, C, x, y)  A##_COSH(x)
#define DERIVATIVE_COSH(A, C, x, y)  A##_SINH(x)
#define DERIVATIVE_TANH(A, C, x, y)  DERIVATIVE_ONE_MINUS_SQUARE(A, C, y)
#define DERIVATIVE_ASINH(A, C, x, y) A##_DIV(C(1), A##_SQRT(A##_ADD(C(1), A##_SQR(x))))
#define DERIVATIVE_ACOSH(A, C, x, y) A##_DIV(C(1), A##_SQRT(A##_SUB(A##_SQR(x), C(1))))
#define DERIVATIVE_ATANH(A, C, x, y) A##_DIV(C(1), DERIVATIVE_ONE_MINUS_SQUARE(A, C, x))

#endif
