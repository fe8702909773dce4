/* A locale with decimal commas, as a host program may have set: what C's own functions then write and read is no number of a scene. */
#ifndef VTS_TESTS_COMMA_LOCALE_H
#define VTS_TESTS_COMMA_LOCALE_H

#include <locale.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

/* Made in a folder of this process where the system has none. */
typedef struct CommaLocale {
    char folder[32];
} CommaLocale;

static inline bool comma_locale_set(CommaLocale *l) {
    static const char *const names[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "es_ES.UTF-8", "it_IT.UTF-8", "pl_PL.UTF-8", "ru_RU.UTF-8"};
    char command[128];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (setlocale(LC_ALL, names[i])) return true;
    if (!mkdtemp(l->folder)) return false;
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 >/dev/null 2>&1", l->folder);
    if (system(command) != 0 || setenv("LOCPATH", l->folder, 1) != 0) return false;
    return setlocale(LC_ALL, "de_DE.UTF-8") != NULL;
}

static inline void comma_locale_begin(CommaLocale *l) {
    *l = (CommaLocale){"/tmp/vts-locale-XXXXXX"};
    if (!comma_locale_set(l)) printf("no locale with decimal commas is here: what follows is tested with points\n");
    else printf("one and a half is %.1f\n", 1.5);
}

static inline void comma_locale_end(const CommaLocale *l) {
    char command[64];
    setlocale(LC_ALL, "C");
    snprintf(command, sizeof command, "rm -rf %s", l->folder);
    if (system(command) != 0) printf("%s is left\n", l->folder);
}

#endif
