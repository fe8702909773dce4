/* Numbers in texts where a host program's locale has decimal commas: they are read and written with points all the same. */
#include "../comma_locale.h"

#include "base/decimal.h"
#include "base/random.h"
#include "base/strbuf.h"

#include <errno.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void numbers_are_as_in_the_locale_c(void **state) {
    (void)state;
    RandomStream r = {5};
    char comma[64];
    snprintf(comma, sizeof comma, "%s", setlocale(LC_ALL, NULL));
    for (int i = 0; i < 20000; i++) {
        char text[64], *end;
        double value = ldexp(random_next_unit(&r) - 0.5, (int)(random_next_unit(&r) * 400) - 200);
        StrBuf written = {0};
        setlocale(LC_ALL, "C");
        snprintf(text, sizeof text, "%.17g;", value);
        setlocale(LC_ALL, comma);
        strbuf_addf(&written, "%.17g;", value);
        assert_string_equal(written.data, text);
        assert_true(decimal_strtod(text, &end) == value && *end == ';');
        strbuf_free(&written);
    }
    errno = 0;
    assert_true(isinf(decimal_strtod("1e999", NULL)) && errno == ERANGE);
}

int main(void) {
    CommaLocale locale;
    comma_locale_begin(&locale);
    const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_are_as_in_the_locale_c)};
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    comma_locale_end(&locale);
    return failed;
}
