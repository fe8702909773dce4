#include "texel/texel_cache.h"

#include "scene/scene_hash.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* One built layer, what a texel sees of the sky, or a whole file, whose key is its content. */
typedef enum EntryKind { ENTRY_VOXELS, ENTRY_SKY, ENTRY_FILE } EntryKind;
typedef struct CacheEntry {
    Hash128 key;
    EntryKind kind;
    VoxelLayer *voxels;
    TexelSky *sky;
    TexelFile file;
    bool used; /* since the last trim */
    uint64_t patience, seen; /* texel_cache_patience(), and how many patient ones had been added when it was last used */
    struct CacheEntry *next;
} CacheEntry;

/* A scene has few texels: a list is enough. */
struct TexelCache {
    CacheEntry *entries;
    MemoryBudget *memory;
    char *folder; /* NULL: memory only */
    uint64_t patience, added; /* what is asked for now; entries that were added with any */
};

TexelCache *texel_cache_create(const char *folder, MemoryBudget *memory) {
    TexelCache *cache = calloc(1, sizeof *cache);
    if (!cache) return NULL;
    cache->memory = memory;
    if (!folder) return cache;
    cache->folder = malloc(strlen(folder) + 1);
    if (cache->folder) {
        memcpy(cache->folder, folder, strlen(folder) + 1);
        return cache;
    }
    free(cache);
    return NULL;
}

static void drop(CacheEntry **place) {
    CacheEntry *entry = *place;
    *place = entry->next;
    voxel_layer_destroy(entry->voxels);
    if (entry->sky) texel_sky_destroy(entry->sky);
    texel_file_release(&entry->file);
    free(entry);
}

void texel_cache_clear(TexelCache *cache) {
    while (cache->entries) drop(&cache->entries);
}

void texel_cache_destroy(TexelCache *cache) {
    if (!cache) return;
    texel_cache_clear(cache);
    free(cache->folder);
    free(cache);
}

void texel_cache_patience(TexelCache *cache, uint64_t patience) { cache->patience = patience; }

void texel_cache_trim(TexelCache *cache) {
    for (CacheEntry **place = &cache->entries; *place;) {
        CacheEntry *entry = *place;
        bool used = entry->used || (entry->patience && cache->added - entry->seen <= entry->patience);
        entry->used = false;
        if (used)
            place = &(*place)->next;
        else
            drop(place);
    }
}

/* ---- keys ---- */

enum { KIND_BUILT = 0x62756c74 };

Hash128 texel_layer_key(const TexelDef *def, const TexelLayer *layer, int resolution, TexelFiltering filtering) {
    Hash128 key = hash_begin(KIND_BUILT);
    hash_add(&key, VTS_VERSION, sizeof VTS_VERSION);
    hash_add_u64(&key, TEXEL_BUILDER_VERSION);
    hash_add_vec3(&key, def->bounds.min);
    hash_add_vec3(&key, def->bounds.max);
    hash_add_u64(&key, def->cyclic);
    hash_add_u64(&key, (uint64_t)resolution);
    hash_add_u64(&key, (uint64_t)filtering);
    hash_add_hash(&key, layer->hash);
    return key;
}

/* ---- memory ---- */

static CacheEntry *add_entry(TexelCache *cache, Hash128 key, EntryKind kind) {
    CacheEntry *entry = calloc(1, sizeof *entry);
    if (!entry) return NULL;
    if (cache->patience) cache->added++;
    *entry = (CacheEntry){.key = key, .kind = kind, .used = true, .patience = cache->patience, .seen = cache->added, .next = cache->entries};
    return cache->entries = entry;
}

static CacheEntry *find_entry(TexelCache *cache, Hash128 key, EntryKind kind) {
    for (CacheEntry *e = cache->entries; e; e = e->next) {
        if (!hash_equal(e->key, key) || e->kind != kind) continue;
        e->used = true;
        e->patience = cache->patience, e->seen = cache->added;
        return e;
    }
    return NULL;
}

/* Short of memory it is not kept, which only costs time. */
static void keep(TexelCache *cache, Hash128 key, VoxelLayer *voxels) {
    CacheEntry *entry = add_entry(cache, key, ENTRY_VOXELS);
    if (entry) entry->voxels = voxel_layer_share(voxels);
}

TexelSky *texel_cache_find_sky(TexelCache *cache, Hash128 key) {
    const CacheEntry *entry = find_entry(cache, key, ENTRY_SKY);
    return entry ? entry->sky : NULL;
}

bool texel_cache_add_sky(TexelCache *cache, Hash128 key, TexelSky *sky) {
    CacheEntry *entry = add_entry(cache, key, ENTRY_SKY);
    if (entry) entry->sky = sky;
    return entry != NULL;
}

const TexelFile *texel_cache_opened(TexelCache *cache, Hash128 content) {
    const CacheEntry *entry = find_entry(cache, content, ENTRY_FILE);
    return entry ? &entry->file : NULL;
}

const TexelFile *texel_cache_open(TexelCache *cache, const char *path, TexelFileStatus *status,
                                  StrBuf *error) {
    TexelFile file;
    *status = texel_file_load(path, cache->memory, &file, error);
    if (*status != TEXEL_FILE_OK) return NULL;
    CacheEntry *entry = find_entry(cache, file.content, ENTRY_FILE);
    if (!entry && (entry = add_entry(cache, file.content, ENTRY_FILE))) {
        entry->file = file;
        return &entry->file;
    }
    texel_file_release(&file);
    if (!entry) *status = TEXEL_FILE_NO_MEMORY;
    return entry ? &entry->file : NULL;
}

/* ---- the folder ---- */

static void path_of(const TexelCache *cache, Hash128 key, StrBuf *path) {
    strbuf_addf(path, "%s/%016llx%016llx.vtx", cache->folder, (unsigned long long)key.hi,
                (unsigned long long)key.lo);
}

static bool same_vector(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

static bool is_as_asked(const TexelFile *file, Hash128 key, const TexelDef *def, int resolution) {
    return hash_equal(file->key, key) && file->layer_count == 1 && file->built == resolution &&
           file->cyclic == def->cyclic && same_vector(file->bounds.min, def->bounds.min) &&
           same_vector(file->bounds.max, def->bounds.max);
}

static bool is_plain_file(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode);
}

static VoxelLayer *find_in_folder(TexelCache *cache, Hash128 key, const TexelDef *def, int resolution) {
    StrBuf path = {0};
    TexelFile file = {0};
    VoxelLayer *voxels = NULL;
    path_of(cache, key, &path);
    if (is_plain_file(path.data) && texel_file_load(path.data, cache->memory, &file, NULL) == TEXEL_FILE_OK &&
        is_as_asked(&file, key, def, resolution))
        voxels = voxel_layer_share(file.layers[0].voxels);
    texel_file_release(&file);
    strbuf_free(&path);
    return voxels;
}

VoxelLayer *texel_cache_find(TexelCache *cache, Hash128 key, const TexelDef *def, int resolution) {
    const CacheEntry *entry = find_entry(cache, key, ENTRY_VOXELS);
    if (entry) return voxel_layer_share(entry->voxels);
    if (!cache->folder) return NULL;
    VoxelLayer *voxels = find_in_folder(cache, key, def, resolution);
    if (voxels) keep(cache, key, voxels);
    return voxels;
}

bool texel_cache_add(TexelCache *cache, Hash128 key, const TexelDef *def, int resolution, VoxelLayer *voxels,
                     StrBuf *error) {
    keep(cache, key, voxels);
    if (!cache->folder) return true;
    StrBuf path = {0};
    path_of(cache, key, &path);
    mkdir(cache->folder, 0777); /* when it fails, so does writing, which says why */
    TexelFileLayer layer = {.voxels = voxels};
    TexelFile file = {.name = (char *)(uintptr_t)def->name,
                      .bounds = def->bounds,
                      .asked = def->resolution,
                      .built = resolution,
                      .cyclic = def->cyclic,
                      .key = key,
                      .layers = &layer,
                      .layer_count = 1};
    bool ok = texel_file_save(&file, path.data, error);
    strbuf_free(&path);
    return ok;
}
