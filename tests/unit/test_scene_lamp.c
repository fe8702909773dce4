/* Tables of lamps: all symmetries against the numbers they were made from, and files that are broken in every way. */
#include "scene/lamp.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct Texts {
    Arena arena;
    SourceSet sources;
    DiagList diags;
} Texts;

static void begin(Texts *t) {
    arena_init(&t->arena, NULL, 0);
    source_set_init(&t->sources, &t->arena);
    diag_init(&t->diags, &t->arena, &t->sources);
}

static const LampTable *read_text(Texts *t, const char *text, size_t size) { return lamp_read(source_add_text(&t->sources, "lamp.ies", text, size), &t->diags, &t->arena); }

/* Of one file; NULL after an error, whose message has `complaint` in it. */
static void refuse(const char *text, uint32_t line, const char *complaint) {
    Texts t;
    begin(&t);
    if (read_text(&t, text, strlen(text))) fail_msg("read: %s", text);
    assert_int_equal(t.diags.error_count, 1);
    const Diagnostic *d = t.diags.first;
    if (!strstr(d->message, complaint)) fail_msg("'%s', not '%s'", d->message, complaint);
    SourcePlace place = source_locate(&t.sources, d->span);
    if (place.line != line) fail_msg("'%s' in line %u, not %u", d->message, place.line, line);
    arena_destroy(&t.arena);
}

static const LampTable *accept(Texts *t, const char *text) {
    begin(t);
    const LampTable *lamp = read_text(t, text, strlen(text));
    for (const Diagnostic *d = t->diags.first; d; d = d->next) fail_msg("%s", d->message);
    assert_non_null(lamp);
    return lamp;
}

static void near(double a, double b) {
    if (!(fabs(a - b) <= 1e-12)) fail_msg("%.15g is not %.15g", a, b);
}

#define HEAD "IESNA:LM-63-1995\n[TEST] invented\n"

/* Whatever the year of the format, the ends of its lines, and what scales all of it. */
static void all_years_are_read(void **state) {
    (void)state;
    static const char *const texts[] = {
        "an old file has any label\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 100\n0 45 90\n0\n400 100 0\n",
        "IESNA91\r\n[TEST] x\r\nTILT=NONE\r\n1 -1 2.5 3 1 1 1 -1 -1 0\r\n0.9 1 100\r\n0 45 90\r\n0\r\n400 100 0\r\n",
        "\nIESNA:LM-63-2002\nTILT=INCLUDE\n1\n3\n0 90 180\n1 0.8 0.9\n1, 1000, 1, 3, 1, 1, 2, 0, 0, 0 1 1 100\n0, 45, 90, 0, 4e2, 1.0E+2, 0",
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(texts); i++) {
        Texts t;
        const LampTable *lamp = accept(&t, texts[i]);
        near(lamp_light(lamp, 0, 33), 1);
        near(lamp_light(lamp, 22.5, -100), 0.625);
        near(lamp_light(lamp, 45, 1000), 0.25);
        near(lamp_light(lamp, 67.5, 0), 0.125);
        near(lamp_light(lamp, 91, 0), 0);
        near(lamp_light(lamp, 180, 0), 0);
        arena_destroy(&t.arena);
    }
}

typedef struct Sweep {
    const char *turns;
    int count;
    double asked[6], folded[6]; /* the light at the first is that measured at the second */
} Sweep;

/* The light of turn T and height H is measured as (T + 1) (H + 30): linear between the angles, so interpolation gives it exactly. */
static void symmetries_are_unfolded(void **state) {
    (void)state;
    static const Sweep sweeps[] = {
        {"0 30 90", 3, {10, 90, 100, 170, 190, 350}, {10, 90, 80, 10, 10, 10}},
        {"0 50 180", 3, {10, 120, 190, 270, 359, -30}, {10, 120, 170, 90, 1, 30}},
        {"90 100 270", 3, {90, 200, 270, 280, 0, 89}, {90, 200, 270, 260, 180, 91}},
        {"0 100 200 360", 4, {0, 50, 120, 250, 359, -1}, {0, 50, 120, 250, 359, 359}},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(sweeps); i++) {
        char text[1024];
        const Sweep *s = &sweeps[i];
        int n = snprintf(text, sizeof text, HEAD "TILT=NONE\n1 1 1 3 %d 1 2 0 0 0 1 1 1\n90 120 180\n%s\n", s->count, s->turns), at = 0;
        double last = 0;
        for (const char *turn = s->turns; *turn; turn += at, turn += strspn(turn, " ")) {
            last = strtod(turn, NULL);
            at = (int)strcspn(turn, " ");
            n += snprintf(text + n, sizeof text - (size_t)n, "%g %g %g\n", (last + 1) * 120, (last + 1) * 150, (last + 1) * 210);
        }
        Texts t;
        const LampTable *lamp = accept(&t, text);
        for (int k = 0; k < 6; k++) {
            near(lamp_light(lamp, 100, s->asked[k]), (s->folded[k] + 1) * 130 / ((last + 1) * 210));
            near(lamp_light(lamp, 170, s->asked[k]), (s->folded[k] + 1) * 200 / ((last + 1) * 210));
            near(lamp_light(lamp, 89.9, s->asked[k]), 0);
        }
        arena_destroy(&t.arena);
    }
}

/* From 0 to 270 degrees the last quarter leads back to the beginning. */
static void sweeps_that_stop_short_are_closed(void **state) {
    (void)state;
    Texts t;
    const LampTable *lamp = accept(&t, HEAD "TILT=NONE\n1 1 1 2 4 1 2 0 0 0 1 1 1\n0 180\n0 90 180 270\n8 8 2 2 4 4 6 6");
    near(lamp_light(lamp, 77, 270), 0.75);
    near(lamp_light(lamp, 77, 315), 0.875);
    near(lamp_light(lamp, 77, -45), 0.875);
    near(lamp_light(lamp, 77, 360), 1);
    near(lamp_light(lamp, 77, 45), 0.625);
    arena_destroy(&t.arena);
}

#define REST " 1 2 0 0 0 1 1 1\n"
static void broken_files_are_refused(void **state) {
    (void)state;
    static const struct { const char *text; uint32_t line; const char *complaint; } cases[] = {
        {"", 1, "no line begins with TILT="},
        {"hello\n world TILT=NONE\n", 1, "no line begins with TILT="},
        {"\n\n\n", 1, "no line begins with TILT="},
        {HEAD "TILT=other.tlt\n", 3, "a further file is not read"},
        {HEAD "TILT=", 3, "a further file is not read"},
        {HEAD "TILT=INCLUDE\n1\n-2\n", 5, "the number of tilts lies between 1 and 10000, found -2"},
        {HEAD "TILT=INCLUDE\n1\n2\n0 x\n", 6, "an angle of tilt is no number"},
        {HEAD "TILT=NONE\n", 4, "ends before the number of bulbs"},
        {HEAD "TILT=NONE\n1 1 0 2 1" REST, 4, "the candela multiplier lies between"},
        {HEAD "TILT=NONE\n1 1 nan 2 1" REST, 4, "the candela multiplier is no number"},
        {HEAD "TILT=NONE\n1 1 1e999 2 1" REST, 4, "the candela multiplier lies between"},
        {HEAD "TILT=NONE\n1 1 -1 2 1" REST, 4, "the candela multiplier lies between"},
        {HEAD "TILT=NONE\n1 1 0x10 2 1" REST, 4, "the candela multiplier is no number"},
        {HEAD "TILT=NONE\n1 1 1 2.5 1" REST, 4, "the number of vertical angles is a whole number"},
        {HEAD "TILT=NONE\n1 1 1 1 1" REST, 4, "the number of vertical angles lies between 2 and 10000"},
        {HEAD "TILT=NONE\n1 1 1 4000000 1" REST, 4, "the number of vertical angles lies between 2 and 10000"},
        {HEAD "TILT=NONE\n1 1 1 10000 10000" REST "0 90", 5, "10000 vertical and 10000 horizontal angles are 100020000 numbers"},
        {HEAD "TILT=NONE\n1 1 1 2 1 2 2 0 0 0 1 1 1\n", 4, "type is B"},
        {HEAD "TILT=NONE\n1 1 1 2 1 3 2 0 0 0 1 1 1\n", 4, "type is A"},
        {HEAD "TILT=NONE\n1 1 1 2 1 7 2 0 0 0 1 1 1\n", 4, "the photometric type lies between 1 and 3"},
        {HEAD "TILT=NONE\n1 1 1 2 1" REST "0 80\n0\n1 1", 5, "found 0 to 80"},
        {HEAD "TILT=NONE\n1 1 1 3 1" REST "0 90 45\n0\n1 1 1", 5, "45 does not lie above the one before, 90"},
        {HEAD "TILT=NONE\n1 1 1 3 1" REST "0 0 90\n0\n1 1 1", 5, "0 does not lie above the one before, 0"},
        {HEAD "TILT=NONE\n1 1 1 2 1" REST "0 90\n15\n1 1", 6, "found 15 to 15"},
        {HEAD "TILT=NONE\n1 1 1 2 2" REST "0 90\n0 45\n1 1 1 1", 6, "found 0 to 45"},
        {HEAD "TILT=NONE\n1 1 1 2 2" REST "0 90\n0 400\n1 1 1 1", 6, "a horizontal angle lies between 0 and 360, found 400"},
        {HEAD "TILT=NONE\n1 1 1 2 1" REST "0 90\n0\n1 -1", 7, "a candela value lies between"},
        {HEAD "TILT=NONE\n1 1 1 2 1" REST "0 90\n0\n1 inf", 7, "a candela value is no number"},
        {HEAD "TILT=NONE\n1 1 1 2 1" REST "0 90\n0\n1", 7, "ends before a candela value"},
        {HEAD "TILT=NONE\n1 1 1 2 1" REST "0 90\n0\n1      ", 7, "ends before a candela value"},
        {HEAD "TILT=NONE\n1 1 1 2 1" REST "0 90\n0\n0 0", 7, "all candela values are 0"},
    };
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) refuse(cases[i].text, cases[i].line, cases[i].complaint);
}

/* Whatever bytes of a good file are lost or changed: it is read, and then shines between 0 and 1, or it is refused with one error. */
static void no_bytes_do_harm(void **state) {
    (void)state;
    static const char good[] = HEAD "TILT=INCLUDE\n1 2 0 90 1 0.5\n1 900 1 3 2 1 2 0 0 0 1 1 60\n0 45 90\n0 180\n10 20 0\n5 1e1 2\n";
    static const char bytes[] = "0 9-.e,\nTx\xff";
    for (size_t at = 0; at < sizeof good - 1; at++)
        for (size_t k = 0; k < sizeof bytes; k++) { /* the last of which cuts the file off */
            char text[sizeof good];
            Texts t;
            memcpy(text, good, sizeof good);
            text[at] = bytes[k];
            begin(&t);
            const LampTable *lamp = read_text(&t, text, strlen(text));
            assert_int_equal(t.diags.error_count, lamp ? 0 : 1);
            for (int i = 0; lamp && i < 60; i++) {
                double light = lamp_light(lamp, 3 * i, 13 * i - 200);
                assert_true(light >= 0 && light <= 1);
            }
            arena_destroy(&t.arena);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_years_are_read),
        cmocka_unit_test(symmetries_are_unfolded),
        cmocka_unit_test(sweeps_that_stop_short_are_closed),
        cmocka_unit_test(broken_files_are_refused),
        cmocka_unit_test(no_bytes_do_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
