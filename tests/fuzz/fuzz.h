/* The entry that libFuzzer calls. */
#ifndef VTS_TESTS_FUZZ_H
#define VTS_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#endif
