/* What vts asks of FreeType: the interface of the module vts_freetype, which is loaded when a scene has a text (font_outline.c). */
#ifndef VTS_SHAPE_FREETYPE_SHIM_H
#define VTS_SHAPE_FREETYPE_SHIM_H

#include "base/common.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

/* Changes with every change of the list; a module with another number is not used. */
enum { FREETYPE_SHIM_VERSION = 1 };

/* FreeType's functions, each under its name without FT_. */
#define FREETYPE_FUNCTIONS(X) \
    X(Done_Face) X(Done_FreeType) X(Get_Char_Index) X(Get_Kerning) X(Init_FreeType) X(Load_Glyph) X(New_Face) X(Outline_Decompose) \
    X(Outline_Get_Orientation)

typedef struct FreetypeShim {
    int version; /* FREETYPE_SHIM_VERSION */
#define FREETYPE_POINTER(name) __typeof__(&FT_##name) name;
    FREETYPE_FUNCTIONS(FREETYPE_POINTER)
#undef FREETYPE_POINTER
} FreetypeShim;

/* What the module exports. */
VTS_EXPORT const FreetypeShim *vts_freetype_shim(void);

#endif
