/* Words that are set from outside in every block of a name: `volume.rays` = "20000" is as if the last words of every volume { … } were
 * `rays 20000`, whatever it says itself. */
#ifndef VTS_EVAL_BLOCK_SETTING_H
#define VTS_EVAL_BLOCK_SETTING_H

#include "eval/block.h"

typedef struct BlockSetting {
    const char *block, *word;
    const BlockItem *items; /* the word with its arguments, and the words that follow it */
    size_t count;
    bool *used;             /* the caller's: set when a block has taken it */
} BlockSetting;

/* Whether a name is BLOCK.WORD. */
bool block_setting_is_name(const char *name);
/* `value`: numbers, quotients of two numbers, names, between blanks; on, yes, true are 1, off, no, false 0. NULL or what is wrong, a static text. */
const char *block_setting_check(const char *name, const char *value);
/* What passed block_setting_check(), in `arena`. */
BlockSetting block_setting_make(Arena *arena, Interner *names, const char *name, const char *value);

#endif
