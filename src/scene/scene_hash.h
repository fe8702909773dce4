/* Content hashes of the scene graph's nodes. Each function computes the hash of a finished node from its fields (and from the
 * hashes of the nodes below it) and stores it in the node. Spans, names and inert notes do not count. */
#ifndef VTS_SCENE_SCENE_HASH_H
#define VTS_SCENE_SCENE_HASH_H

#include "scene/scene.h"

void hash_add_vec3(Hash128 *hash, Vec3 v);
void hash_add_color(Hash128 *hash, Color c);
void hash_add_transform(Hash128 *hash, const Transform *t);

void pigment_rehash(Pigment *pigment);
void finish_rehash(Finish *finish);
void texture_rehash(Texture *texture);
void mesh_rehash(MeshData *mesh); /* without its textures */
/* `hash` and `shape_hash`. */
void object_rehash(Object *object);
void layer_rehash(TexelLayer *layer);
void texel_rehash(TexelDef *texel);
void surface_rehash(Surface *surface);
void skin_rehash(Skin *skin);

/* Shape and transform of an object without its looks. */
Hash128 object_geometry_hash(const Object *object);

#endif
