#include "scene/scene.h"

/* A map evaluates the two entries around a value, `average` all of them. */
static double work_of_entries(const Pigment *pigment) {
    double sum = 0, most = 0;
    for (size_t i = 0; i < pigment->entry_count; i++) {
        const Pigment *entry = pigment->entries[i].pigment;
        if (!entry) continue;
        sum += entry->work;
        most = double_max(most, entry->work);
    }
    return pigment->kind == PATTERN_AVERAGE ? sum : double_min(sum, 2 * most);
}

int pavement_count(int sides, int tiles) {
    static const int counts[][PAVEMENT_MOST_TILES] = {[3] = {1, 1, 1, 3, 4, 12}, [4] = {1, 1, 2, 5, 12, 35}, [6] = {1, 1, 3, 7, 22, 0}};
    return sides >= 3 && sides <= 6 && tiles >= 1 && tiles <= PAVEMENT_MOST_TILES ? counts[sides][tiles - 1] : 0;
}

void pigment_measure(Pigment *pigment) {
    int inner = 0;
    for (size_t i = 0; i < pigment->entry_count; i++)
        if (pigment->entries[i].pigment) inner = int_max(inner, pigment->entries[i].pigment->depth);
    double work = 1 + work_of_entries(pigment);
    if (pigment->source) {
        inner = int_max(inner, pigment->source->depth);
        work += pigment->source->work;
    }
    if (pigment->function) {
        inner = int_max(inner, tape_depth(pigment->function));
        work += tape_work(pigment->function);
    }
    pigment->depth = inner + 1;
    pigment->work = work;
}
