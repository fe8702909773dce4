/* A growing text on the heap. */
#ifndef VTS_BASE_STRBUF_H
#define VTS_BASE_STRBUF_H

#include "base/common.h"

#include <stdarg.h>

typedef struct StrBuf {
    char *data; /* NUL-terminated once anything was added; else NULL */
    size_t size, capacity;
} StrBuf;

/* {0} is an empty StrBuf. Memory exhaustion aborts: texts are small. */
void strbuf_add(StrBuf *buf, const char *text, size_t size);
void strbuf_adds(StrBuf *buf, const char *text);
void strbuf_addf(StrBuf *buf, const char *format, ...) VTS_PRINTF(2, 3);
void strbuf_vaddf(StrBuf *buf, const char *format, va_list args) VTS_PRINTF(2, 0);
void strbuf_addc(StrBuf *buf, char c);
void strbuf_repeat(StrBuf *buf, char c, size_t count);
/* The text as a JSON string with its quotes. */
void strbuf_add_json(StrBuf *buf, const char *text);
void strbuf_clear(StrBuf *buf);
void strbuf_free(StrBuf *buf);

#endif
