/* 128-bit content hash: equal content, equal hash. Not cryptographic. */
#ifndef VTS_BASE_HASH_H
#define VTS_BASE_HASH_H

#include "base/common.h"

typedef struct Hash128 {
    uint64_t lo, hi;
} Hash128;

/* A hash under construction; start with hash_begin(kind). */
static inline Hash128 hash_begin(uint64_t kind) { return (Hash128){0x243F6A8885A308D3u ^ kind, 0x13198A2E03707344u + kind}; }
void hash_add(Hash128 *hash, const void *data, size_t size);
static inline void hash_add_u64(Hash128 *hash, uint64_t value) { hash_add(hash, &value, sizeof value); }
/* -0 and +0 hash alike. */
static inline void hash_add_double(Hash128 *hash, double value) {
    value += 0.0;
    hash_add(hash, &value, sizeof value);
}
static inline void hash_add_hash(Hash128 *hash, Hash128 other) { hash_add(hash, &other, sizeof other); }
static inline bool hash_equal(Hash128 a, Hash128 b) { return a.lo == b.lo && a.hi == b.hi; }

#endif
