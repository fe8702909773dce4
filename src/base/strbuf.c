#include "base/strbuf.h"

#include "base/decimal.h"

#include <stdlib.h>
#include <string.h>

static void reserve(StrBuf *buf, size_t more) {
    if (buf->size + more + 1 <= buf->capacity) return;
    size_t capacity = size_max(buf->capacity * 2, buf->size + more + 64);
    char *data = realloc(buf->data, capacity);
    if (!data) abort();
    buf->data = data;
    buf->capacity = capacity;
}

void strbuf_add(StrBuf *buf, const char *text, size_t size) {
    reserve(buf, size);
    if (size) memcpy(buf->data + buf->size, text, size);
    buf->size += size;
    buf->data[buf->size] = '\0';
}

void strbuf_adds(StrBuf *buf, const char *text) { strbuf_add(buf, text, strlen(text)); }

void strbuf_vaddf(StrBuf *buf, const char *format, va_list args) {
    va_list again;
    va_copy(again, args);
    int length = decimal_vsnprintf(NULL, 0, format, args);
    if (length > 0) {
        reserve(buf, (size_t)length);
        decimal_vsnprintf(buf->data + buf->size, (size_t)length + 1, format, again);
        buf->size += (size_t)length;
    }
    va_end(again);
}

void strbuf_addf(StrBuf *buf, const char *format, ...) {
    va_list args;
    va_start(args, format);
    strbuf_vaddf(buf, format, args);
    va_end(args);
}

void strbuf_addc(StrBuf *buf, char c) { strbuf_add(buf, &c, 1); }

void strbuf_repeat(StrBuf *buf, char c, size_t count) {
    reserve(buf, count);
    memset(buf->data + buf->size, c, count);
    buf->size += count;
    buf->data[buf->size] = '\0';
}

void strbuf_add_json(StrBuf *buf, const char *text) {
    strbuf_addc(buf, '"');
    for (const unsigned char *p = (const unsigned char *)text; *p; p++) {
        if (*p == '"' || *p == '\\') strbuf_addf(buf, "\\%c", *p);
        else if (*p < 0x20) strbuf_addf(buf, "\\u%04x", *p);
        else strbuf_addc(buf, (char)*p);
    }
    strbuf_addc(buf, '"');
}

void strbuf_clear(StrBuf *buf) {
    buf->size = 0;
    if (buf->data) buf->data[0] = '\0';
}

void strbuf_free(StrBuf *buf) {
    free(buf->data);
    *buf = (StrBuf){0};
}
