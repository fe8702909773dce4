/* UTF-8 as texts from anywhere may or may not hold it. */
#ifndef VTS_BASE_UTF8_H
#define VTS_BASE_UTF8_H

#include <stddef.h>

/* Bytes of the character that `text` begins with: 1 to 4, or 0 when the bytes are no character (RFC 3629: neither overlong, nor a
 * surrogate, nor past U+10FFFF) or end within it. */
size_t utf8_size(const char *text, size_t size);

#endif
