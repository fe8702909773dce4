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
void normal_rehash(Normal *normal);
void interior_rehash(Interior *interior);
void texture_rehash(Texture *texture);
void mesh_rehash(MeshData *mesh); /* without its textures */
/* Objects do not keep theirs (but groups do, when they are first asked: not from two threads at once). Shape, place and looks of the
 * object and all in it; */
Hash128 object_hash(const Object *object);
/* the geometry before the place, without looks. */
Hash128 object_shape_hash(const Object *object);
/* To be called when a group is complete: hashes it now if it is deep, so that asking later never goes far down; and finds
 * out whether it is plain. */
void object_group_settle(ObjectGroup *group);
void layer_rehash(TexelLayer *layer);
void texel_rehash(TexelDef *texel);
void surface_rehash(Surface *surface);
void wind_rehash(WindField *wind);
void skin_rehash(Skin *skin);

/* Shape and transform of an object without its looks. */
Hash128 object_geometry_hash(const Object *object);

#endif
