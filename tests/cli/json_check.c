/* json_check [KEY…]: status 0 when standard input is one JSON value (RFC 8259) and each KEY occurs in it as a name. */
#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { LARGEST_INPUT = 1 << 22, DEEPEST = 64 };

/* The text that is still to be read; at "" the end. */
typedef struct Cursor {
    const char *at;
} Cursor;

static void skip_space(Cursor *c) { c->at += strspn(c->at, " \t\r\n"); }

static bool take(Cursor *c, const char *word) {
    size_t size = strlen(word);
    if (strncmp(c->at, word, size) != 0) return false;
    c->at += size;
    return true;
}

static bool take_string(Cursor *c) {
    if (!take(c, "\"")) return false;
    while (*c->at && *c->at != '"') {
        if ((unsigned char)*c->at < 0x20) return false;
        if (*c->at++ != '\\') continue;
        if (!*c->at || !strchr("\"\\/bfnrtu", *c->at)) return false;
        if (*c->at++ != 'u') continue;
        for (int i = 0; i < 4; i++)
            if (!isxdigit((unsigned char)*c->at++)) return false;
    }
    return take(c, "\"");
}

static bool take_digits(Cursor *c) {
    size_t count = strspn(c->at, "0123456789");
    c->at += count;
    return count > 0;
}

static bool take_number(Cursor *c) {
    take(c, "-");
    if (!take(c, "0") && !take_digits(c)) return false;
    if (take(c, ".") && !take_digits(c)) return false;
    if (!take(c, "e") && !take(c, "E")) return true;
    if (!take(c, "+")) take(c, "-");
    return take_digits(c);
}

static bool take_value(Cursor *c, int depth);

static bool take_members(Cursor *c, bool named, const char *end, int depth) {
    skip_space(c);
    if (take(c, end)) return true;
    do {
        skip_space(c);
        if (named) {
            if (!take_string(c)) return false;
            skip_space(c);
            if (!take(c, ":")) return false;
        }
        if (!take_value(c, depth)) return false;
    } while (take(c, ","));
    return take(c, end);
}

static bool take_value(Cursor *c, int depth) {
    if (depth > DEEPEST) return false;
    skip_space(c);
    bool valid = *c->at == '"'  ? take_string(c)
                 : take(c, "{") ? take_members(c, true, "}", depth + 1)
                 : take(c, "[") ? take_members(c, false, "]", depth + 1)
                                : take(c, "true") || take(c, "false") || take(c, "null") || take_number(c);
    skip_space(c);
    return valid;
}

static char text[LARGEST_INPUT];

int main(int argc, char **argv) {
    size_t size = fread(text, 1, sizeof text - 1, stdin);
    Cursor cursor = {text};
    if (strlen(text) != size || !take_value(&cursor, 0) || *cursor.at) {
        fprintf(stderr, "no JSON from byte %zu on: %.40s\n", (size_t)(cursor.at - text), cursor.at);
        return 1;
    }
    for (int i = 1; i < argc; i++) {
        char name[80];
        snprintf(name, sizeof name, "\"%s\":", argv[i]);
        if (strstr(text, name)) continue;
        fprintf(stderr, "no member \"%s\"\n", argv[i]);
        return 1;
    }
    return 0;
}
