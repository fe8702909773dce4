/* A line of text as outlines. */
#ifndef VTS_SHAPE_FONT_OUTLINE_H
#define VTS_SHAPE_FONT_OUTLINE_H

#include "shape/outline.h"

typedef struct FontGlyph {
    Outline outline; /* in units of the em, from the glyph's origin; filled where the winding is not 0 */
    double x, y;     /* of its origin, without the text's own offset */
    Point2 min, max; /* as POV-Ray counts its box */
} FontGlyph;

typedef struct FontLine {
    const FontGlyph *glyphs; /* one for each character */
    size_t count;
    bool filled_on_right; /* of the direction of its outlines */
} FontLine;

/* Sets the UTF-8 text in a font of TrueType or its relatives as POV-Ray does: the first glyph's left side at x = 0, kerning between
 * neighbours. False when the file is no font, or FreeType's module is not found. */
bool font_outline(const char *path, const char *text, Arena *arena, FontLine *out);
/* A font of the system to use instead of one that is missing, by its name ("timrom.ttf"); NULL: there is none. */
const char *font_substitute(const char *name);

#endif
