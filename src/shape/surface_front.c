#include "shape/surface_front.h"

/* Votes of one connected part about its front as wound; the first that is not near zero decides. */
typedef struct FrontVote {
    bool open;
    Vec3 origin;     /* some point of the part: volumes are measured from here */
    double area;     /* of all cells */
    double size;     /* largest distance from origin */
    double heights;  /* area times given height vectors */
    double extent;   /* area times their lengths */
    double volume;   /* signed */
    double directed; /* area that agrees with given normals, minus the rest */
    Vec3 sum;        /* of the area vectors: zero for closed parts */
    Vec3 center;     /* area times middle, from origin */
} FrontVote;

static const double NEARLY_CLOSED = 0.25;

static Vec3 corner_of(const SurfaceDraft *draft, const DraftCell *cell, int i) {
    return draft->vertices.items[cell->vertex[i]].position;
}

/* Area times unit normal; for a patch that of its boundary. */
static Vec3 area_vector(const SurfaceDraft *draft, const DraftCell *cell) {
    Vec3 a = corner_of(draft, cell, 0), b = corner_of(draft, cell, 1), c = corner_of(draft, cell, 2);
    if (cell->corner_count == 4) {
        return vec3_scale(vec3_cross(vec3_sub(c, a), vec3_sub(corner_of(draft, cell, 3), b)), 0.5);
    }
    return vec3_scale(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)), 0.5);
}

static Vec3 mean_height(const SurfaceDraft *draft, const DraftCell *cell) {
    Vec3 sum = vec3_splat(0);
    for (int i = 0; i < cell->corner_count; i++) {
        const Vec3 *height = draft->vertices.items[cell->vertex[i]].height;
        if (height) sum = vec3_madd(sum, *height, 1.0 / cell->corner_count);
    }
    return sum;
}

static void count_vote(const SurfaceDraft *draft, const DraftCell *cell, bool turned, FrontVote *vote) {
    Vec3 area = area_vector(draft, cell), height = mean_height(draft, cell), middle = vec3_splat(0);
    double amount = vec3_length(area);
    if (turned) area = vec3_negate(area);
    for (int i = 0; i < cell->corner_count; i++) {
        Vec3 p = vec3_sub(corner_of(draft, cell, i), vote->origin);
        middle = vec3_madd(middle, p, 1.0 / cell->corner_count);
        vote->size = double_max(vote->size, vec3_length(p));
    }
    vote->area += amount;
    vote->heights += vec3_dot(area, height);
    vote->extent += amount * vec3_length(height);
    vote->volume += vec3_dot(area, middle) / 3;
    vote->sum = vec3_add(vote->sum, area);
    vote->center = vec3_madd(vote->center, middle, amount);
    if (cell->directed) vote->directed += turned ? -amount : amount;
}

static bool looks_back(const FrontVote *vote) {
    const double nothing = 1e-6;
    if (fabs(vote->heights) > nothing * vote->extent) return vote->heights < 0;
    if (!vote->open && fabs(vote->volume) > nothing * vote->area * vote->size) return vote->volume < 0;
    if (fabs(vote->directed) > nothing * vote->area) return vote->directed < 0;
    /* A ball with holes is nearly closed: its area vectors nearly cancel, and the volume seen from its middle tells the outside. */
    if (vote->open && vec3_length(vote->sum) < NEARLY_CLOSED * vote->area) {
        double volume = vote->volume - vec3_dot(vote->sum, vec3_scale(vote->center, 1 / vote->area)) / 3;
        if (fabs(volume) > nothing * vote->area * vote->size) return volume < 0;
    }
    return vote->sum.y < -nothing * vote->area;
}

static void cut(const JoinedCells *joined, uint32_t cell, int edge) {
    SurfaceNeighbour *here = &joined->neighbours[cell][edge];
    joined->neighbours[here->cell][here->edge].cell = -1;
    here->cell = -1;
}

/* Walks over the part that holds `first`, turning cells as their neighbours are; lists the part's cells in `queue`. */
static size_t walk_part(const JoinedCells *joined, uint32_t first, bool *reached, bool *turned,
                        uint32_t *queue) {
    size_t count = 0;
    queue[count++] = first;
    reached[first] = true;
    for (size_t i = 0; i < count; i++) {
        uint32_t cell = queue[i];
        for (int e = 0; e < joined->draft->cells[cell].corner_count; e++) {
            int32_t next = joined->neighbours[cell][e].cell;
            if (next < 0) continue;
            bool turn = turned[cell] != joined->same_way[cell][e];
            if (reached[next] && turned[next] != turn) cut(joined, cell, e);
            if (reached[next]) continue;
            reached[next] = true;
            turned[next] = turn;
            queue[count++] = (uint32_t)next;
        }
    }
    return count;
}

static bool is_open(const JoinedCells *joined, uint32_t cell) {
    const DraftCell *c = &joined->draft->cells[cell];
    for (int e = 0; e < c->corner_count; e++) {
        bool collapsed = joined->place[c->vertex[e]] == joined->place[c->vertex[(e + 1) % c->corner_count]];
        if (!collapsed && joined->neighbours[cell][e].cell < 0) return true;
    }
    return false;
}

void surface_front_choose(const JoinedCells *joined, Arena *scratch, bool *turned) {
    const SurfaceDraft *draft = joined->draft;
    bool *reached = arena_new_array(scratch, bool, draft->cell_count);
    uint32_t *queue = arena_new_array(scratch, uint32_t, draft->cell_count);
    for (uint32_t first = 0; first < draft->cell_count; first++) {
        if (reached[first]) continue;
        size_t count = walk_part(joined, first, reached, turned, queue);
        FrontVote vote = {.origin = corner_of(draft, &draft->cells[first], 0)};
        for (size_t i = 0; i < count; i++) {
            count_vote(draft, &draft->cells[queue[i]], turned[queue[i]], &vote);
            vote.open = vote.open || is_open(joined, queue[i]);
        }
        bool back = looks_back(&vote);
        for (size_t i = 0; i < count; i++) turned[queue[i]] = turned[queue[i]] != back;
    }
}
