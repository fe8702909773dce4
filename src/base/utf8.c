#include "base/utf8.h"

size_t utf8_size(const char *text, size_t size) {
    const unsigned char *c = (const unsigned char *)text;
    if (size == 0) return 0;
    if (c[0] < 0x80) return 1;
    size_t length = c[0] < 0xC2 ? 0 : c[0] < 0xE0 ? 2 : c[0] < 0xF0 ? 3 : c[0] < 0xF5 ? 4 : 0;
    if (length == 0 || length > size) return 0;
    for (size_t i = 1; i < length; i++)
        if ((c[i] & 0xC0u) != 0x80u) return 0;
    unsigned low = c[0] == 0xE0   ? 0xA0
                   : c[0] == 0xF0 ? 0x90
                                  : 0x80,
             high = c[0] == 0xED   ? 0x9F
                    : c[0] == 0xF4 ? 0x8F
                                   : 0xBF;
    return c[1] >= low && c[1] <= high ? length : 0;
}
