#define _POSIX_C_SOURCE 200809L /* uselocale */
#include "base/decimal.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>

/* The locale of the calling thread alone is changed, and changed back: a host program may have set any, and its threads their own. */
typedef struct CLocale {
    locale_t own, before;
} CLocale;

/* Where there is no memory for it the host's stays. */
static CLocale c_locale_begin(void) {
    CLocale l = {.own = newlocale(LC_ALL_MASK, "C", (locale_t)0)};
    if (l.own) l.before = uselocale(l.own);
    return l;
}

static void c_locale_end(CLocale l) {
    if (!l.own) return;
    uselocale(l.before);
    freelocale(l.own);
}

double decimal_strtod(const char *text, char **end) {
    const CLocale l = c_locale_begin();
    double value = strtod(text, end);
    c_locale_end(l);
    return value;
}

int decimal_vsnprintf(char *out, size_t size, const char *format, va_list args) {
    const CLocale l = c_locale_begin();
    int length = vsnprintf(out, size, format, args);
    c_locale_end(l);
    return length;
}
