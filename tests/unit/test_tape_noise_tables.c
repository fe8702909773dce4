/* The tables of POV-Ray's noises follow from short descriptions (noise_pov.c, noise_gradient.c): here they are made again. */
#include "base/common.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tape/noise_gradient_tables.inc"
#include "tape/noise_pov_tables.inc"

/* POV-Ray's small generator: its state, of which the upper half gives the numbers. */
static unsigned next_number(uint32_t *state) {
    *state = *state * 1812433253u + 12345u;
    return *state >> 16 & 0x7FFF;
}

static void hashes_are_a_shuffle(void **state) {
    (void)state;
    enum { SIZE = 4096 };
    uint16_t table[SIZE];
    uint32_t random = 0;
    for (unsigned i = 0; i < SIZE; i++) table[i] = (uint16_t)i;
    for (unsigned i = SIZE; i-- > 0;) {
        unsigned k = next_number(&random) % SIZE;
        uint16_t swap = table[i];
        table[i] = table[k];
        table[k] = swap;
    }
    assert_memory_equal(table, pov_hash, sizeof table);
}

static unsigned crc16(const unsigned char *bytes, size_t count) {
    unsigned crc = 0;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) crc = crc & 1 ? crc >> 1 ^ 0xA001 : crc >> 1;
    }
    return crc;
}

static void weights_are_checksums(void **state) {
    (void)state;
    for (unsigned i = 0; i < VTS_ARRAY_COUNT(pov_weights); i++) {
        union {
            double value;
            uint64_t bits;
        } u = {.value = i * 0.12345};
        unsigned char bytes[24];
        for (unsigned k = 0; k < 24; k++) bytes[k] = (unsigned char)(u.bits >> (56 - 8 * (k % 8)));
        char text[32];
        snprintf(text, sizeof text, "%.6g", crc16(bytes, sizeof bytes) * 2 / 65535. - 1);
        assert_true(strtod(text, NULL) == pov_weights[i]);
    }
}

/* Matsumoto & Nishimura 1998. */
static void random_numbers_are_the_mersenne_twisters(void **state) {
    (void)state;
    enum { N = 624, M = 397 };
    uint32_t x[N] = {5489};
    for (uint32_t i = 1; i < N; i++) x[i] = 1812433253u * (x[i - 1] ^ x[i - 1] >> 30) + i;
    for (size_t k = 0; k < VTS_ARRAY_COUNT(pov_random); k++) {
        size_t i = k % N;
        uint32_t y = (x[i] & 0x80000000u) | (x[(i + 1) % N] & 0x7FFFFFFFu);
        x[i] = x[(i + M) % N] ^ y >> 1 ^ (y & 1 ? 0x9908B0DFu : 0);
        y = x[i];
        y ^= y >> 11;
        y ^= y << 7 & 0x9D2C5680u;
        y ^= y << 15 & 0xEFC60000u;
        y ^= y >> 18;
        assert_int_equal(y, pov_random[k]);
    }
}

static void gradients_lie_in_the_ball(void **state) {
    (void)state;
    enum { SIZE = 2048 };
    uint32_t random = 1;
    for (unsigned i = 0; i < SIZE; i++) {
        int v[3];
        double length;
        do {
            length = 0;
            for (int k = 0; k < 3; k++) {
                v[k] = (int)(next_number(&random) % (2 * SIZE)) - SIZE;
                length += (double)v[k] / SIZE * v[k] / SIZE;
            }
        } while (length > 1 || length < 1e-5);
        for (int k = 0; k < 3; k++) assert_int_equal(v[k], gradient_vectors[i][k]);
    }
    unsigned order[SIZE + 1];
    for (unsigned i = 0; i < SIZE; i++) order[i] = i;
    order[SIZE] = 0;
    for (unsigned i = SIZE; i > 0; i -= 2) {
        unsigned k = next_number(&random) % SIZE, swap = order[i];
        order[i] = order[k];
        order[k] = swap;
    }
    for (unsigned i = 0; i < SIZE; i++) assert_int_equal(order[i], gradient_order[i]);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(hashes_are_a_shuffle),
                                       cmocka_unit_test(weights_are_checksums),
                                       cmocka_unit_test(random_numbers_are_the_mersenne_twisters),
                                       cmocka_unit_test(gradients_lie_in_the_ball)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
