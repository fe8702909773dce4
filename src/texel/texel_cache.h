/* Built voxels kept by what they were built from: in memory from one frame to the next, and in a folder from one run to the
 * next. Several programs may use one folder: files are written under another name and renamed, and readers believe nothing
 * (texel_file.h). A file that is broken or something else is as good as none, and is written anew. */
#ifndef VTS_TEXEL_TEXEL_CACHE_H
#define VTS_TEXEL_TEXEL_CACHE_H

#include "texel/texel_file.h"
#include "texel/texel_sky.h"

typedef struct TexelCache TexelCache;

/* `folder` (copied; NULL: memory only) is made when the first file is written. NULL when memory is short. One thread at a time. */
TexelCache *texel_cache_create(const char *folder, MemoryBudget *memory);
void texel_cache_destroy(TexelCache *cache);

/* The key of a layer's voxels at a resolution: all that they depend on, and not how they look. */
Hash128 texel_layer_key(const TexelDef *def, const TexelLayer *layer, int resolution, TexelFiltering filtering);

/* The voxels with this key, for one owner more; NULL when they are not there. */
VoxelLayer *texel_cache_find(TexelCache *cache, Hash128 key, const TexelDef *def, int resolution);
/* Keeps the voxels in memory until texel_cache_trim(), and writes them to the folder if there is one; false with a line of text
 * in `error` when that fails. */
bool texel_cache_add(TexelCache *cache, Hash128 key, const TexelDef *def, int resolution, VoxelLayer *voxels,
                     StrBuf *error);

/* The texel in a file, which the cache owns until texel_cache_trim(); NULL with a status and a line of text in `error`. */
const TexelFile *texel_cache_open(TexelCache *cache, const char *path, TexelFileStatus *status,
                                  StrBuf *error);
/* The texel that was opened with this content, or NULL. */
const TexelFile *texel_cache_opened(TexelCache *cache, Hash128 content);

/* What a texel sees of the sky, kept in memory until texel_cache_trim(). The key is made of those of its layers and of all else that it
 * depends on. The second takes `sky` over if it returns true; false when memory is short. */
TexelSky *texel_cache_find_sky(TexelCache *cache, Hash128 key);
bool texel_cache_add_sky(TexelCache *cache, Hash128 key, TexelSky *sky);

/* What is added or found from now on comes back in a while: it is kept until so many more such things were added after its last use, though
 * frames go by without it. 0: what is not used is let go. */
void texel_cache_patience(TexelCache *cache, uint64_t patience);

/* Lets go in memory what was neither found nor added since the last time; all of it. */
void texel_cache_trim(TexelCache *cache);
void texel_cache_clear(TexelCache *cache);

#endif
