#include "scene/lamp.h"

#include "base/decimal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- reading ---- */

typedef struct LampReader {
    const SourceFile *file;
    DiagList *diags;
    uint32_t at;
    uint32_t last; /* where the last number or word begins */
} LampReader;

static Span span_from(const LampReader *r, uint32_t begin, uint32_t end) { return (Span){r->file->id, begin, end}; }
static Span span_of_last(const LampReader *r) { return span_from(r, r->last, r->at); }

/* Numbers stand apart by blanks, ends of lines or commas, as many in a line as their writers liked. */
static bool is_between(char c) { return c == ' ' || c == ',' || (c >= '\t' && c <= '\r'); }

/* `what` is said of it, where it is missing, none, or not within [low, high]. */
static bool take_number(LampReader *r, const char *what, double low, double high, double *out) {
    const char *text = r->file->text;
    char word[64], *end;
    while (r->at < r->file->size && is_between(text[r->at])) r->at++;
    r->last = r->at;
    while (r->at < r->file->size && !is_between(text[r->at])) r->at++;
    uint32_t size = r->at - r->last;
    if (size == 0) {
        diag_error(r->diags, span_from(r, r->file->size, r->file->size), "the table of the lamp ends before %s", what);
        return false;
    }
    memcpy(word, text + r->last, size < sizeof word ? size : 0);
    word[size < sizeof word ? size : 0] = '\0';
    *out = decimal_strtod(word, &end);
    bool plain = end > word && *end == '\0' && !strpbrk(word, "xXnN"); /* hexadecimal, nan and inf are C's numbers, not the format's */
    if (!plain) {
        diag_error(r->diags, span_of_last(r), "%s is no number", what);
        return false;
    }
    if (*out >= low && *out <= high) return true;
    diag_error(r->diags, span_of_last(r), "%s lies between %g and %g, found %g", what, low, high, *out);
    return false;
}

static bool take_count(LampReader *r, const char *what, double low, double high, int *out) {
    double number;
    if (!take_number(r, what, low, high, &number)) return false;
    *out = (int)number;
    if (number == *out) return true;
    diag_error(r->diags, span_of_last(r), "%s is a whole number, found %g", what, number);
    return false;
}

/* Numbers that make no difference. */
static bool skip_numbers(LampReader *r, const char *const *whats, size_t count, double low) {
    double number;
    for (size_t i = 0; i < count; i++)
        if (!take_number(r, whats[i], low, 1e30, &number)) return false;
    return true;
}

/* A file's label ends where a line begins with TILT=; what comes before may be anything. */
static bool find_tilt(LampReader *r) {
    const char *text = r->file->text;
    for (const char *line = text, *end; line; line = end ? end + 1 : NULL) {
        end = strchr(line, '\n');
        if (strncmp(line, "TILT=", 5) != 0) continue;
        r->at = (uint32_t)(line - text) + 5;
        return true;
    }
    diag_error(r->diags, span_from(r, 0, 0), "no line begins with TILT=: this is no table of a lamp as IESNA LM-63 defines it");
    return false;
}

/* TILT=NONE, or TILT=INCLUDE and how much dimmer the lamp's bulb is in other positions. */
static bool skip_tilt(LampReader *r) {
    const char *word = r->file->text + r->at;
    size_t size = strcspn(word, " \t\r\n");
    double number;
    int count;
    r->last = r->at;
    r->at += (uint32_t)size;
    if (size == 4 && memcmp(word, "NONE", 4) == 0) return true;
    if (size != 7 || memcmp(word, "INCLUDE", 7) != 0) {
        diag_error(r->diags, span_of_last(r), "TILT is NONE or INCLUDE: a further file is not read");
        return false;
    }
    if (!take_count(r, "the position of the bulb", 1, 3, &count) || !take_count(r, "the number of tilts", 1, LAMP_MOST_ANGLES, &count)) return false;
    for (int i = 0; i < 2 * count; i++)
        if (!take_number(r, i < count ? "an angle of tilt" : "a factor of tilt", 0, i < count ? 180 : 1e30, &number)) return false;
    return true;
}

static bool take_angles(LampReader *r, const char *what, int count, const double **out, Arena *arena) {
    double *angles = arena_new_array(arena, double, (size_t)count);
    for (int i = 0; i < count; i++) {
        if (!take_number(r, what, 0, 360, &angles[i])) return false;
        if (i == 0 || angles[i] > angles[i - 1]) continue;
        diag_error(r->diags, span_of_last(r), "%s %g does not lie above the one before, %g", what, angles[i], angles[i - 1]);
        return false;
    }
    *out = angles;
    return true;
}

static bool check_heights(LampReader *r, const LampTable *lamp) {
    double first = lamp->heights[0], last = lamp->heights[lamp->height_count - 1];
    if ((first == 0 && (last == 90 || last == 180)) || (first == 90 && last == 180)) return true;
    diag_error(r->diags, span_of_last(r), "vertical angles go from 0 to 90, from 90 to 180 or from 0 to 180, found %g to %g", first, last);
    return false;
}

/* What is not measured follows by symmetry. */
static bool take_symmetry(LampReader *r, LampTable *lamp) {
    double first = lamp->turns[0], last = lamp->turns[lamp->turn_count - 1];
    bool quarter = first == 0 && last == 90, half = (first == 0 && last == 180) || (first == 90 && last == 270), whole = first == 0 && last > 180;
    lamp->period = lamp->turn_count == 1 ? 0 : quarter ? 180 : 360;
    lamp->mirrored = quarter || half;
    if (lamp->turn_count == 1 ? first == 0 : quarter || half || whole) return true;
    diag_error(r->diags, span_of_last(r), "horizontal angles are 0 alone, or go from 0 to 90, 180 or up to 360, or from 90 to 270, found %g to %g", first, last);
    return false;
}

/* Of the brightest direction 1. */
static bool take_light(LampReader *r, LampTable *lamp, Arena *arena) {
    size_t count = (size_t)lamp->height_count * (size_t)lamp->turn_count;
    double *light = arena_new_array(arena, double, count), most = 0;
    for (size_t i = 0; i < count; i++) {
        if (!take_number(r, "a candela value", 0, 1e30, &light[i])) return false;
        most = fmax(most, light[i]);
    }
    if (!(most > 0)) {
        diag_error(r->diags, span_of_last(r), "all candela values are 0: this lamp does not shine");
        return false;
    }
    for (size_t i = 0; i < count; i++) light[i] /= most;
    lamp->light = light;
    return true;
}

/* One number between two others takes two bytes: files that promise more than they hold cost no memory. */
static bool check_counts(LampReader *r, const LampTable *lamp) {
    double promised = (double)lamp->height_count * lamp->turn_count + lamp->height_count + lamp->turn_count;
    if (2 * promised <= r->file->size - r->at + 1.) return true;
    diag_error(r->diags, span_from(r, r->file->size, r->file->size), "the table of the lamp ends too soon: %d vertical and %d horizontal angles are %.0f numbers",
               lamp->height_count, lamp->turn_count, promised);
    return false;
}

static bool take_type(LampReader *r) {
    int type, units;
    if (!take_count(r, "the photometric type", 1, 3, &type)) return false;
    if (type == 1) return take_count(r, "the type of units", 1, 2, &units);
    diag_error(r->diags, span_of_last(r), "the lamp's photometric type is %s: only type C is read", type == 2 ? "B" : "A");
    return false;
}

static bool take_table(LampReader *r, LampTable *lamp, Arena *arena) {
    static const char *const sizes[] = {"the lamp's width", "the lamp's length", "the lamp's height"};
    static const char *const powers[] = {"the ballast factor", "the ballast-lamp factor", "the input watts"};
    int bulbs;
    double lumens, multiplier;
    return find_tilt(r) && skip_tilt(r) && take_count(r, "the number of bulbs", 1, 1e6, &bulbs) && take_number(r, "the lumens of a bulb", -1, 1e30, &lumens) &&
           take_number(r, "the candela multiplier", 1e-30, 1e30, &multiplier) && take_count(r, "the number of vertical angles", 2, LAMP_MOST_ANGLES, &lamp->height_count) &&
           take_count(r, "the number of horizontal angles", 1, LAMP_MOST_ANGLES, &lamp->turn_count) && take_type(r) &&
           skip_numbers(r, sizes, VTS_ARRAY_COUNT(sizes), -1e30) /* of round lamps they are negative */ && skip_numbers(r, powers, VTS_ARRAY_COUNT(powers), 0) &&
           check_counts(r, lamp) && take_angles(r, "a vertical angle", lamp->height_count, &lamp->heights, arena) && check_heights(r, lamp) &&
           take_angles(r, "a horizontal angle", lamp->turn_count, &lamp->turns, arena) && take_symmetry(r, lamp) && take_light(r, lamp, arena);
}

const LampTable *lamp_read(const SourceFile *file, DiagList *diags, Arena *arena) {
    LampReader reader = {.file = file, .diags = diags};
    LampTable *lamp = arena_new(arena, LampTable);
    *lamp = (LampTable){0};
    if (!take_table(&reader, lamp, arena)) return NULL;
    size_t heights = (size_t)lamp->height_count, turns = (size_t)lamp->turn_count;
    lamp->hash = hash_begin(heights);
    hash_add(&lamp->hash, lamp->heights, heights * sizeof(double));
    hash_add(&lamp->hash, lamp->turns, turns * sizeof(double));
    hash_add(&lamp->hash, lamp->light, heights * turns * sizeof(double));
    return lamp;
}

/* ---- asking ---- */

/* The last angle that is not above, though not the very last. */
static int interval_of(const double *angles, int count, double angle) {
    int low = 0, high = count - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (angles[middle] <= angle) low = middle;
        else high = middle;
    }
    return low;
}

static double row_light(const LampTable *lamp, int turn, double height) {
    const double *light = lamp->light + (size_t)turn * (size_t)lamp->height_count;
    int i = interval_of(lamp->heights, lamp->height_count, height);
    double share = (height - lamp->heights[i]) / (lamp->heights[i + 1] - lamp->heights[i]);
    return light[i] + (light[i + 1] - light[i]) * share;
}

double lamp_light(const LampTable *lamp, double height, double turn) {
    if (height < lamp->heights[0] || height > lamp->heights[lamp->height_count - 1]) return 0;
    if (lamp->period == 0) return row_light(lamp, 0, height);
    double first = lamp->turns[0], last = lamp->turns[lamp->turn_count - 1], from = fmod(turn - first, lamp->period);
    if (from < 0) from += lamp->period;
    if (lamp->mirrored && from > lamp->period / 2) from = lamp->period - from;
    double at = first + from;
    int i = interval_of(lamp->turns, lamp->turn_count, at), next = i + 1;
    double low = lamp->turns[i], high = lamp->turns[next];
    if (at > last) i = lamp->turn_count - 1, next = 0, low = last, high = first + lamp->period; /* of a table that stops short of its beginning */
    double here = row_light(lamp, i, height);
    return here + (row_light(lamp, next, height) - here) * ((at - low) / (high - low));
}
