#include "terrain/text_scan.h"

#include "base/decimal.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r') || c == '\0'; }

static bool refill(TextScan *scan) {
    memmove(scan->buffer, scan->buffer + scan->at, scan->size - scan->at);
    scan->size -= scan->at;
    scan->at = 0;
    size_t got = fread(scan->buffer + scan->size, 1, SCAN_BUFFER - scan->size, scan->file);
    scan->size += got;
    return got > 0;
}

const char *text_scan_peek(TextScan *scan, size_t *size) {
    for (;;) {
        while (scan->at < scan->size && is_blank(scan->buffer[scan->at])) scan->at++;
        if (scan->at < scan->size) break;
        if (!refill(scan)) return NULL;
    }
    if (scan->size - scan->at < SCAN_LONGEST_WORD) refill(scan);
    size_t end = scan->at, most = size_min(scan->size, scan->at + SCAN_LONGEST_WORD);
    while (end < most && !is_blank(scan->buffer[end])) end++;
    *size = end - scan->at;
    return scan->buffer + scan->at;
}

/* Any number, slowly. */
static bool slow_number(const char *word, size_t size, double *out) {
    char copy[64], *end;
    if (size == 0 || size >= sizeof copy) return false;
    memcpy(copy, word, size);
    copy[size] = '\0';
    const char *unsigned_part = copy + (copy[0] == '-' || copy[0] == '+');
    if (strncasecmp(unsigned_part, "nan", 3) == 0 || strncmp(unsigned_part, "1.#", 3) == 0) {
        *out = (double)NAN;
        return true;
    }
    for (char *c = copy; *c; c++) *c = *c == ',' ? '.' : *c == 'd' || *c == 'D' ? 'e' : *c;
    *out = decimal_strtod(copy, &end);
    return *end == '\0' && end > copy && !strpbrk(copy, "xX");
}

/* Up to 15 digits without exponent are a whole number and a power of ten that doubles hold exactly: one division rounds correctly. */
bool text_number(const char *word, size_t size, double *out) {
    static const double powers[] = {1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
    size_t i = size && (word[0] == '-' || word[0] == '+') ? 1 : 0;
    int digits = 0, after_point = -1;
    uint64_t whole = 0;
    for (; i < size && digits <= 15; i++) {
        if (word[i] >= '0' && word[i] <= '9') {
            whole = whole * 10 + (uint64_t)(word[i] - '0');
            digits++;
            if (after_point >= 0) after_point++;
        } else if ((word[i] == '.' || word[i] == ',') && after_point < 0) {
            after_point = 0;
        } else {
            return slow_number(word, size, out);
        }
    }
    if (i < size || digits == 0 || digits > 15) return slow_number(word, size, out);
    double value = (double)whole / powers[int_max(after_point, 0)];
    *out = word[0] == '-' ? -value : value;
    return true;
}
