#include "base/module.h"

#include <dlfcn.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

static bool is_loaded(const char *library) {
    void *handle = dlopen(library, RTLD_LAZY | RTLD_NOLOAD);
    if (handle) dlclose(handle);
    return handle != NULL;
}

/* Of a list with holes and with what is nowhere, the one that is there is loaded, and stays. */
static void test_loads_what_is_there(void **state) {
    (void)state;
    char path[MODULE_PATH_SIZE];
    bool found = false;
    for (int place = 0; place < MODULE_PLACES && !found; place++) found = module_place(place, "libvts_freetype.so", path);
    assert_true(found);
    assert_false(is_loaded(path));
    StrBuf list = {0};
    strbuf_addf(&list, ":libvts_is_nowhere.so::%s:", path);
    module_load_apart(list.data);
    strbuf_free(&list);
    assert_true(is_loaded(path));
}

static void test_nothing_to_load(void **state) {
    (void)state;
    module_load_apart(NULL);
    module_load_apart("");
    StrBuf endless = {0};
    for (int i = 0; i < MODULE_PATH_SIZE; i++) strbuf_adds(&endless, "x");
    module_load_apart(endless.data);
    assert_false(is_loaded(endless.data));
    strbuf_free(&endless);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_loads_what_is_there),
        cmocka_unit_test(test_nothing_to_load),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
