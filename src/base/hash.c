#include "base/hash.h"

#include "base/random.h"

#include <string.h>

static void add_word(Hash128 *h, uint64_t word) {
    h->lo = random_mix(h->lo ^ word);
    h->hi = random_mix(h->hi + (word << 32 | word >> 32)) ^ h->lo;
}

void hash_add(Hash128 *hash, const void *data, size_t size) {
    const unsigned char *bytes = data;
    uint64_t word;
    size_t rest = size;
    for (; rest >= 8; rest -= 8, bytes += 8) {
        memcpy(&word, bytes, 8);
        add_word(hash, word);
    }
    word = 0;
    if (rest) memcpy(&word, bytes, rest);
    add_word(hash, word ^ (uint64_t)size << 56); /* the length too, so that concatenations differ */
}
