/* Of text what extent.c asks. */
#ifndef VTS_SHAPE_SOLID_TEXT_H
#define VTS_SHAPE_SOLID_TEXT_H

#include "base/vec.h"

/* Around the boxes of all letters, blanks too; `data` is what the kind prepared, or NULL. */
Box3 solid_text_extent(const void *data);

#endif
