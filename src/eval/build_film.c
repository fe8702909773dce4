/* animation { frames 240 fps 24 clock 0, 1 cyclic on shutter 0.5 } */
#include "eval/build_parts.h"

static void read_frames(Reader *reader, const Word *word, void *target) {
    Film *film = target;
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &film->frames)) return;
    if (film->frames < 1 || film->frames > FILM_MOST_FRAMES)
        reader_error(reader, word->arguments[0].span, "'frames' must be from 1 to %d, found %d", FILM_MOST_FRAMES, film->frames);
}

static void read_clock(Reader *reader, const Word *word, void *target) {
    Film *film = target;
    if (!word_arguments(reader, word, 2, 2)) return;
    if (word_float(reader, word, 0, &film->first_clock)) word_float(reader, word, 1, &film->last_clock);
}

static void read_shutter(Reader *reader, const Word *word, void *target) {
    Film *film = target;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, &film->shutter)) return;
    if (!(film->shutter >= 0 && film->shutter <= 1))
        reader_error(reader, word->arguments[0].span, "'shutter' must be from 0 to 1, found %g", film->shutter);
}

bool film_read(BuildContext *context, const EvalBlock *block, Film *out) {
    static const WordRule rules[] = {
        {"frames", WORD_CUSTOM, 0, read_frames, true},
        {"fps", WORD_POSITIVE, offsetof(Film, fps), NULL, true},
        {"clock", WORD_CUSTOM, 0, read_clock, true},
        {"cyclic", WORD_FLAG, offsetof(Film, cyclic), NULL, true},
        {"shutter", WORD_CUSTOM, 0, read_shutter, true},
    };
    *out = (Film){.span = block->word_span, .frames = 1, .fps = 24, .last_clock = 1};
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), out);
    return reader_run(&reader);
}
