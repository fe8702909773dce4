/* Operations over arrays whose best loop is not that over the reference arithmetic; equal to it bit for bit. One function for
 * each TAPE_OP_ROW of tape_ops.def: row_NAME(out, operands…, lanes). Arrays must not overlap. */
#ifndef VTS_TAPE_TAPE_ROWS_H
#define VTS_TAPE_TAPE_ROWS_H

#include <stddef.h>

typedef void TapeRow1(double *restrict out, const double *restrict a, size_t lanes);
typedef void TapeRow2(double *restrict out, const double *restrict a, const double *restrict b, size_t lanes);
typedef void TapeRow3(double *restrict out, const double *restrict a, const double *restrict b,
                      const double *restrict c, size_t lanes);

/* ---- tape_rows_elementary.c ---- */
TapeRow1 row_EXP, row_LN, row_SIN, row_COS, row_TAN, row_ATAN;
TapeRow2 row_ATAN2;

/* ---- noise.c, noise_pov.c ---- */
TapeRow3 row_PERLIN, row_POV_NOISE;

#endif
