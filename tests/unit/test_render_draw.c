/* Numbers that samples are drawn by: how evenly they lie. */
#include "render/draw.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { NET = 64, NETS = 40 };

/* One in each of so many boxes, whichever 64 in turn are taken. */
static void three_numbers_lie_evenly(void **state) {
    (void)state;
    for (uint32_t net = 0; net < NETS; net++) {
        int boxes[NET] = {0}, squares[3][NET] = {{0}};
        for (uint32_t i = 0; i < NET; i++) {
            double at[3];
            draw_three(net * NET + i, net % 4, at);
            for (int k = 0; k < 3; k++) {
                assert_true(at[k] >= 0 && at[k] < 1);
                squares[k][(int)(8 * at[k]) * 8 + (int)(8 * at[(k + 1) % 3])]++;
            }
            boxes[((int)(4 * at[0]) * 4 + (int)(4 * at[1])) * 4 + (int)(4 * at[2])]++;
        }
        for (int i = 0; i < NET; i++) {
            assert_int_equal(boxes[i], 1);
            for (int k = 0; k < 3; k++) assert_int_equal(squares[k][i], 1);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(three_numbers_lie_evenly)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
