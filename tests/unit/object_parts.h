/* Parts of objects that tests build by hand; they live as long as the block that they stand in. */
#ifndef TESTS_UNIT_OBJECT_PARTS_H
#define TESTS_UNIT_OBJECT_PARTS_H

#include "scene/scene.h"

#define PLACE(transform)       (&(const Affine){(transform).linear, (transform).offset})
#define GROUP(children, size)  (&(const ObjectGroup){.items = (children), .count = (size)})

#endif
