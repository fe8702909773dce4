#include "cli/option_value.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { LARGEST_SIDE = 65536 };

/* Like strtol, but without leading space, and false past the range. */
static bool leading_int(const char **text, int smallest, int largest, int *out) {
    if (!isdigit((unsigned char)**text) && **text != '-') return false;
    char *end;
    errno = 0;
    long value = strtol(*text, &end, 10);
    if (end == *text || errno != 0 || value < smallest || value > largest) return false;
    *text = end;
    *out = (int)value;
    return true;
}

bool option_int(const char *text, int smallest, int largest, int *out) {
    return leading_int(&text, smallest, largest, out) && !*text;
}

bool option_unsigned(const char *text, unsigned long long *out) {
    if (!isdigit((unsigned char)*text)) return false;
    char *end;
    errno = 0;
    *out = strtoull(text, &end, 0);
    return errno == 0 && !*end;
}

static bool leading_double(const char **text, double *out) {
    if (!**text || isspace((unsigned char)**text)) return false;
    char *end;
    *out = strtod(*text, &end);
    if (end == *text || !isfinite(*out)) return false;
    *text = end;
    return true;
}

bool option_double(const char *text, double *out) { return leading_double(&text, out) && !*text; }

bool option_quotient(const char *text, double *out) {
    double divisor = 1;
    if (!leading_double(&text, out)) return false;
    if (*text == '/') {
        text++;
        if (!leading_double(&text, &divisor) || divisor == 0) return false;
    }
    *out /= divisor;
    return !*text;
}

bool option_size(const char *text, int *width, int *height) {
    if (!leading_int(&text, 1, LARGEST_SIDE, width)) return false;
    if (*text != 'x' && *text != 'X') return false;
    text++;
    return leading_int(&text, 1, LARGEST_SIDE, height) && !*text;
}

bool option_region(const char *text, int region[4]) {
    for (int i = 0; i < 4; i++) {
        if (i > 0 && *text++ != ',') return false;
        if (!leading_int(&text, 0, LARGEST_SIDE, &region[i])) return false;
    }
    return !*text && region[0] < region[2] && region[1] < region[3];
}

bool option_bytes(const char *text, size_t *out) {
    static const char units[] = "KMGT";
    double value;
    if (!leading_double(&text, &value) || value <= 0) return false;
    const char *unit = *text ? strchr(units, toupper((unsigned char)*text)) : NULL;
    if (unit) {
        value = ldexp(value, 10 * (int)(unit - units + 1));
        text++;
        if (*text == 'B' || *text == 'b') text++;
    }
    if (*text || value >= (double)(SIZE_MAX / 2)) return false;
    *out = (size_t)value;
    return *out > 0;
}

int option_word(const char *text, const char *const *words) {
    for (int i = 0; words[i]; i++)
        if (strcasecmp(text, words[i]) == 0) return i;
    return -1;
}

bool option_truth(const char *text, bool *out) {
    static const char *const words[] = {"on", "yes", "true", "1", "off", "no", "false", "0", NULL};
    int found = option_word(text, words);
    *out = found < 4;
    return found >= 0;
}
