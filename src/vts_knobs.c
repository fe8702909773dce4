/* Settings from outside: --set KNOB=VALUE, over the scene's global_settings. */
#include "vts_session.h"

#include "base/decimal.h"
#include "eval/block_setting.h"
#include "scene/knobs.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A knob with a number in [least, most], or above `least` where `open`. */
typedef struct NumberKnob {
    const char *name, *wanted;
    size_t offset; /* of a double in GlobalSettings, an int where `whole` */
    double least, most;
    bool whole, open;
} NumberKnob;
static const NumberKnob number_knobs[] = {
    {"max_error", "a number in (0, 1], such as 1/255", offsetof(GlobalSettings, max_error), 0, 1, false, true},
    {"samples", "a whole number, 1 to 256", offsetof(GlobalSettings, samples), 1, 256, true, false},
    {"shadow_aperture", "a number, 1 to 1000", offsetof(GlobalSettings, shadow_aperture), 1, 1000, false, false},
};

static const NumberKnob *find_number_knob(const char *name) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(number_knobs); i++)
        if (strcmp(number_knobs[i].name, name) == 0) return &number_knobs[i];
    return NULL;
}

static bool parse_number(const char *text, double *out, const char **end) {
    char *stop;
    errno = 0;
    *out = decimal_strtod(text, &stop);
    *end = stop;
    return stop != text && errno == 0 && isfinite(*out);
}

/* A number or a quotient of two. */
static bool parse_quotient(const char *text, double *out) {
    const char *end;
    double divisor = 1;
    if (!parse_number(text, out, &end)) return false;
    if (*end == '/' && (!parse_number(end + 1, &divisor, &end) || divisor == 0)) return false;
    *out /= divisor;
    return *end == '\0';
}

static void refuse_name(const char *name, StrBuf *why) {
    const char *names[NAMED_KNOB_COUNT + VTS_ARRAY_COUNT(number_knobs)];
    size_t count = 0;
    for (size_t i = 0; i < NAMED_KNOB_COUNT; i++) names[count++] = named_knobs[i].name;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(number_knobs); i++) names[count++] = number_knobs[i].name;
    const char *best = closest_word(name, names, count);
    strbuf_addf(why, "there is no knob '%s'", name);
    if (best) {
        strbuf_addf(why, " (did you mean '%s'?)", best);
        return;
    }
    for (size_t i = 0; i < count; i++) strbuf_addf(why, "%s%s", i ? ", " : "; there are ", names[i]);
}

static bool set_name(const NamedKnob *knob, const char *text, GlobalSettings *settings, StrBuf *why) {
    const char *value = named_knob_value(knob, text);
    if (value) {
        named_knob_set(knob, settings, value);
        return true;
    }
    size_t count = 0;
    while (knob->values[count]) count++;
    const char *best = closest_word(text, knob->values, count);
    strbuf_addf(why, "'%s' has no value '%s'", knob->name, text);
    if (best) strbuf_addf(why, " (did you mean '%s'?)", best);
    for (size_t i = 0; i < count && !best; i++) strbuf_addf(why, "%s%s", i ? ", " : ": it is one of ", knob->values[i]);
    return false;
}

static bool set_number(const NumberKnob *knob, const char *text, GlobalSettings *settings, StrBuf *why) {
    double number;
    bool valid = parse_quotient(text, &number) && number <= knob->most && (knob->open ? number > knob->least : number >= knob->least) &&
                 (!knob->whole || number == floor(number));
    if (!valid) {
        strbuf_addf(why, "'%s' cannot be '%s': it is %s", knob->name, text, knob->wanted);
        return false;
    }
    int whole = (int)number;
    char *field = (char *)settings + knob->offset;
    if (knob->whole) memcpy(field, &whole, sizeof whole);
    else memcpy(field, &number, sizeof number);
    return true;
}

/* A word of blocks is read when the scene is. */
static bool check_block_setting(const char *name, const char *value, StrBuf *why) {
    const char *wrong = block_setting_check(name, value);
    if (wrong) strbuf_addf(why, "'%s' cannot be '%s': %s", name, value, wrong);
    return !wrong;
}

bool knob_set(const char *name, const char *value, GlobalSettings *settings, StrBuf *why) {
    if (strchr(name, '.')) return check_block_setting(name, value, why);
    const NamedKnob *named = named_knob_find(name);
    const NumberKnob *number = named ? NULL : find_number_knob(name);
    if (named) return set_name(named, value, settings, why);
    if (number) return set_number(number, value, settings, why);
    refuse_name(name, why);
    return false;
}

VtsStatus vts_setting_check(const char *knob, const char *value, char *error, size_t error_size) {
    GlobalSettings settings = global_settings_default();
    StrBuf why = {0};
    bool valid = knob_set(knob, value, &settings, &why);
    if (error && error_size) snprintf(error, error_size, "%s", valid || !why.data ? "" : why.data);
    strbuf_free(&why);
    return valid ? VTS_OK : VTS_ERROR_USAGE;
}

const char *const *vts_setting_values(const char *knob) {
    const NamedKnob *named = named_knob_find(knob);
    return named ? named->values : NULL;
}
