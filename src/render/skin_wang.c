/* Families laid by wang.h. */
#include "render/compile.h"
#include "base/random.h"
#include "render/wang_border.h"

#include <string.h>

/* Texels taken apart, so that skins share what they are made of. */
typedef struct WangKept {
    const TexelDef *def;
    WangParts parts;
    struct WangKept *next;
} WangKept;

static const WangParts *parts_of(const TexelDef *def, CompiledScene *compiled) {
    for (const WangKept *kept = compiled->wang; kept; kept = kept->next)
        if (kept->def == def) return &kept->parts;
    WangKept *kept = arena_new(compiled->arena, WangKept);
    *kept = (WangKept){def, wang_split(def, compiled->arena), compiled->wang};
    compiled->wang = kept;
    return &kept->parts;
}

/* In how many ways what lies on a grid may be turned: by quarters if tiles are square and nothing of what it is hangs on the axes, as what crosses
 * the border along one does. `rotate` of the jitter, if given, limits it, and `mirror` must then be asked for. */
static int turns_of(const TexelDef *const *defs, size_t count, int grid, const InstanceJitter *jitter) {
    int most = jitter->turned ? jitter->rotate >= 360 ? 4 : jitter->rotate >= 180 ? 2 : 1 : 4;
    bool quarters = grid == 0 || grid == 3;
    for (size_t i = 0; i < count; i++) {
        Vec3 size = vec3_sub(defs[i]->bounds.max, defs[i]->bounds.min);
        const unsigned both = TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z;
        quarters &= fabs(size.x - size.z) <= 1e-6 * fmax(size.x, size.z) && (defs[i]->cyclic & both) == both;
    }
    return int_min(most, quarters ? 4 : 2);
}

typedef struct Family {
    const TexelDef *const *defs;
    size_t count;
    const WangParts **parts;
} Family;

static void place_grid(CompiledSkin *skin, size_t index, const Family *family, int grid, CompiledScene *compiled) {
    const TexelDef **whole = arena_new_array(compiled->arena, const TexelDef *, family->count);
    size_t count = 0;
    for (size_t i = 0; i < family->count; i++)
        if (family->parts[i]->whole[grid]) whole[count++] = family->parts[i]->whole[grid];
    if (!count) return;
    PlacedTexel *placed = skin_place_family(skin, index, whole, count, compiled);
    placed->blanks = family->count - placed->family_size;
    placed->cyclic = false;
    placed->turns = turns_of(family->defs, family->count, grid, &skin->def->jitter.instance);
    placed->flips = placed->jitter.mirror || !placed->jitter.turned;
    placed->shift_u = grid & 1 ? 0.5 : 0, placed->shift_v = grid & 2 ? 0.5 : 0;
    placed->reach = grid ? 1 : 0;
    placed->seed = random_hash(placed->seed, (uint64_t)grid + 1, 0, 0);
}

static void place_rest(CompiledSkin *skin, size_t index, const Family *family, CompiledScene *compiled, DiagList *diags) {
    const TexelDef **rest = arena_new_array(compiled->arena, const TexelDef *, family->count);
    size_t count = 0;
    for (size_t i = 0; i < family->count; i++)
        if (family->parts[i]->rest) rest[count++] = family->parts[i]->rest;
    if (!count) return;
    PlacedTexel *placed = skin_place_family(skin, index, rest, count, compiled);
    bool tinted = placed->jitter.present && placed->jitter.tinted;
    placed->blanks = family->count - placed->family_size;
    placed->alike = family->count == 1 && placed->density >= 1 && !tinted;
    placed->turns = 1;
    if (family->count > 1) placed->borders = wang_borders(rest, count, family->count, skin->def, compiled, diags);
}

/* What keeps the family from being taken apart, in a warning. */
static bool fits_wang(Span span, const TexelDef *const *defs, size_t count, DiagList *diags) {
    const unsigned across = TEXEL_CYCLIC_X | TEXEL_CYCLIC_Z;
    for (size_t i = 0; i < count; i++) {
        if (!(defs[i]->cyclic & across)) {
            Diagnostic *d = diag_warning(diags, span, "'tiling wang' does nothing for '%s', which is not cyclic", defs[i]->name);
            if (d) diag_hint(diags, d, "what does not reach over its border is varied by 'jitter { instance { … } }'");
            return false;
        }
        if ((defs[i]->cyclic ^ defs[0]->cyclic) & across) {
            diag_warning(diags, span, "'tiling wang' does nothing here: '%s' and '%s' are not cyclic along the same axes", defs[0]->name, defs[i]->name);
            return false;
        }
    }
    return true;
}

bool skin_place_wang(CompiledSkin *skin, size_t index, const TexelDef *const *defs, size_t count, CompiledScene *compiled, DiagList *diags) {
    if (!fits_wang(skin->def->texels[index].span, defs, count, diags)) return false;
    Family family = {defs, count, arena_new_array(compiled->arena, const WangParts *, count)};
    for (size_t i = 0; i < count; i++) family.parts[i] = parts_of(defs[i], compiled);
    for (int grid = 0; grid < WANG_GRIDS; grid++) place_grid(skin, index, &family, grid, compiled);
    place_rest(skin, index, &family, compiled, diags);
    return true;
}
