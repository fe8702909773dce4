/* Elementary functions over arrays: the branch-free core for all, then the few that it is not made for. */
#include "tape/elementary.h"
#include "tape/tape_rows.h"

#define ROW_1(NAME, name)                                                                                    \
    void row_##NAME(double *restrict out, const double *restrict a, size_t lanes) {                          \
        uint64_t unusual = 0;                                                                                \
        for (size_t l = 0; l < lanes; l++) out[l] = elementary_##name##_core(a[l]);                          \
        for (size_t l = 0; l < lanes; l++) unusual |= elementary_##name##_usual(a[l]) ? 0 : 1;               \
        for (size_t l = 0; unusual && l < lanes; l++)                                                        \
            if (!elementary_##name##_usual(a[l])) out[l] = elementary_##name(a[l]);                          \
    }
#define ROW_2(NAME, name)                                                                                    \
    void row_##NAME(double *restrict out, const double *restrict a, const double *restrict b,                \
                    size_t lanes) {                                                                          \
        uint64_t unusual = 0;                                                                                \
        for (size_t l = 0; l < lanes; l++) out[l] = elementary_##name##_core(a[l], b[l]);                    \
        for (size_t l = 0; l < lanes; l++) unusual |= elementary_##name##_usual(a[l], b[l]) ? 0 : 1;         \
        for (size_t l = 0; unusual && l < lanes; l++)                                                        \
            if (!elementary_##name##_usual(a[l], b[l])) out[l] = elementary_##name(a[l], b[l]);              \
    }

ROW_1(EXP, exp)
ROW_1(LN, ln)
ROW_1(SIN, sin)
ROW_1(COS, cos)
ROW_1(TAN, tan)
ROW_1(ATAN, atan)
ROW_2(ATAN2, atan2)
